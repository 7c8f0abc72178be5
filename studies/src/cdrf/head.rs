//! A head of skin that is the same everywhere, drawn in the ways that one would use, beside random walks.

use lapidary_gpu::Gpu;
use lapidary_ladders::cdrf::scenes::{self, SIDE, add_timed};
use lapidary_ladders::table::{Table, figure};
use lapidary_ladders::timing::Timed;
use lapidary_ladders::{CostError, Report, Row};
use lapidary_render as render;
use lapidary_render::Settings;
use lapidary_scene::Scene;
use lapidary_scene::solver::Reflectance;
use lapidary_snapshots::WalkedReference;
use lapidary_snapshots::exposure::{distance, exposed_distance};
use lapidary_snapshots::frames::halved;

/// Name of the scene.
const SCENE: &str = "skin_head";
/// The ways: name, reflectance, and whether the law of a half space is on. All have shadows.
const WAYS: [(&str, Reflectance, bool); 4] = [
    ("`lambert-shadowed`", Reflectance::LambertShadowed, false),
    ("`blur --with shadow`", Reflectance::Blur, false),
    ("`cheap --with shadow`", Reflectance::Cheap, false),
    ("`drift --with half_space,shadow`", Reflectance::Drift, true),
];
/// The measures: distance after the best exposure and as it is.
const MEASURES: [&str; 2] = ["head", "head, exposure 1"];

/// Adds each way's picture: its distances from the walks, and its time.
///
/// # Errors
/// Returns an error if the committed picture is missing or damaged, or if the device fails.
pub(super) fn measure(
    gpu: &Gpu,
    rounds: u32,
    report: &mut Report,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(), CostError> {
    let Some(reference) = WalkedReference::of_scene(SCENE) else { return Ok(()) };
    let (truth, scene) = (reference.picture(gpu)?.linear, Scene::named(SCENE)?);
    let (mut rows, mut timed) = (Vec::new(), Vec::new());
    for (name, reflectance, half_space) in WAYS {
        let settings = Settings { half_space, ..scenes::settings(reflectance, true) };
        let picture = halved(&render::render(gpu, &scene, &settings)?).linear;
        let values = [exposed_distance(&picture, &truth), distance(&picture, &truth)];
        let row = |(measure, value)| Row::new(name, SCENE, measure, Some(value), "");
        rows.push(MEASURES.into_iter().zip(values).map(row).collect());
        timed.push(Timed::new(&scene, settings));
    }
    add_timed(gpu, (rows, &timed), rounds, report, progress)
}

/// Shows the distances and times.
pub(super) fn table(report: &Report) -> Table {
    let value = |way: &str, measure: &str| figure(report.value(way, SCENE, measure), 3);
    Table::of("cdrf_head", "A head, beside random walks", report.rungs(MEASURES[0]))
        .column("rung", |way| (*way).to_owned())
        .column("from walks, best exposure", |way| value(way, MEASURES[0]))
        .column("exposure 1", |way| value(way, MEASURES[1]))
        .column("ms", |way| figure(report.ms(way, SCENE, MEASURES[0]), 1))
        .note(format!(
            "The scene `{SCENE}`: skin that is the same everywhere, by the lights alone, index-matched, without highlights. \
             Pictures of {SIDE} × {SIDE} pixels, one sample each; milliseconds, {}.",
            report.run()
        ))
}
