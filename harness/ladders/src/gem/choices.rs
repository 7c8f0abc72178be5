//! What the end of a ray costs: what happens to its remainder, and where it ends.

use super::error::Errors;
use super::seen::{SAMPLES, Watched};
use super::views;
use crate::error::CostError;
use crate::report::{Report, Row};
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_render as render;
use lapidary_render::{GemOptions, Settings};

/// Distance limits in radii of the stone.
const LIMITS: [f32; 4] = [2.0, 4.0, 8.0, 16.0];

/// Adds the errors of some rungs in every view, by the way a ray ends; the way follows the rung's
/// name.
pub(super) fn measure(gpu: &Gpu, watched: &[Watched], report: &mut Report) -> Result<(), CostError> {
    for name in ["proxy-1+tracker", "walk-8+tracker"] {
        let Ok(rung) = name.parse::<Rung>() else { continue };
        for Watched { view, scene, reference, .. } in watched {
            let side = views::SIDE;
            let usual = Settings { rung, samples: SAMPLES, ..Settings::of_size(side, side) };
            let with = |gem: GemOptions| Settings { gem, ..usual.clone() };
            let dropped = GemOptions { rest_from_environment: false, ..usual.gem };
            let mut ways = vec![
                ("rest from the environment".to_owned(), usual.clone()),
                ("rest dropped".to_owned(), with(dropped)),
                ("ended at the first exit".to_owned(), with(GemOptions { end_at_first_exit: true, ..usual.gem })),
            ];
            if rung.hits() > 1 {
                let radius = scene.bounds().radius();
                ways.extend(LIMITS.map(|limit| {
                    let gem = GemOptions { distance_limit: Some(limit * radius), ..usual.gem };
                    (format!("ended after {limit} radii"), with(gem))
                }));
            }
            for (way, settings) in ways {
                let picture = render::render_means(gpu, scene, &settings)?;
                let Errors { flip, rmse, energy } = Errors::between(&picture, reference);
                for (measure, value) in [("flip", flip), ("rmse", rmse), ("energy", energy)] {
                    report.rows.push(Row::new(&format!("{name}, {way}"), view.name, measure, value, ""));
                }
            }
        }
    }
    Ok(())
}
