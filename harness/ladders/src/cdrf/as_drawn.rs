//! Each reflectance as a default draws it, with the law of a half space and with shadows, beside random walks: by this
//! `--quality` is judged.

use super::scenes::{SCENES, add_timed, settings};
use crate::error::CostError;
use crate::report::{Report, Row};
use crate::timing::Timed;
use lapidary_gpu::Gpu;
use lapidary_render as render;
use lapidary_render::Settings;
use lapidary_scene::Scene;
use lapidary_scene::solver::Reflectance;
use lapidary_snapshots::WalkedReference;
use lapidary_snapshots::exposure::exposed_distance;
use lapidary_snapshots::frames::halved;

/// The reflectances of which one could be a default.
const REFLECTANCES: [Reflectance; 6] = [
    Reflectance::Lambert,
    Reflectance::Wrap,
    Reflectance::Cheap,
    Reflectance::Accurate,
    Reflectance::Power,
    Reflectance::Drift,
];
/// The measure: distance after the best exposure.
const AS_DRAWN: &str = "as drawn";

/// Adds each scene's pictures: their distances from the walks, and their times.
///
/// # Errors
/// Returns an error if a committed picture is missing or damaged, or if the device fails.
pub(super) fn measure(
    gpu: &Gpu,
    rounds: u32,
    report: &mut Report,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(), CostError> {
    let scenes: Vec<(&str, Scene)> =
        SCENES.into_iter().map(|name| Ok((name, Scene::named(name)?))).collect::<Result<_, CostError>>()?;
    let (mut rows, mut timed) = (Vec::new(), Vec::new());
    for (name, scene) in &scenes {
        let walked = WalkedReference::of_scene(name).map(|reference| reference.picture(gpu)).transpose()?;
        let truth = walked.map_or_else(Vec::new, |picture| picture.linear);
        for reflectance in REFLECTANCES {
            let settings = Settings { half_space: true, ..settings(reflectance, true) };
            let picture = halved(&render::render(gpu, scene, &settings)?).linear;
            let distance = exposed_distance(&picture, &truth);
            rows.push(vec![Row::new(reflectance.name(), name, AS_DRAWN, distance, "")]);
            timed.push(Timed::new(scene, settings));
        }
    }
    add_timed(gpu, (rows, &timed), rounds, report, progress)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_gpu::AdapterChoice;
    use lapidary_plan::Technique;
    use lapidary_plan::ladder::Ladder;

    /// The committed report has these rows from the study of the law, which draws the same pictures.
    #[test]
    fn pictures_as_drawn_are_the_committed_ones() {
        let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
        let mut report = Report::default();
        measure(gpu, 0, &mut report, &mut |_, _| {}).expect("measured");
        let committed = Ladder::committed(Technique::Cdrf).expect("a ladder");
        assert_eq!(committed.steps.len(), REFLECTANCES.len());
        for reflectance in REFLECTANCES {
            let rung = reflectance.name();
            let found: Vec<f64> = SCENES.iter().filter_map(|scene| report.value(rung, scene, AS_DRAWN)).collect();
            let mean = found.iter().sum::<f64>() / found.len() as f64;
            let step = committed.step(rung).expect(rung);
            assert!((mean / step.error - 1.0).abs() < 1e-3, "{rung}: {mean} {}", step.error);
        }
    }
}
