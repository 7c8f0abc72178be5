//! What the end of a ray costs: what happens to its remainder, and where it ends.

use super::seen::{SAMPLES, Watched};
use super::{CostError, Errors};
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_render as render;
use lapidary_render::{GemOptions, Settings};
use serde::{Deserialize, Serialize};

/// One way to end a ray, with its errors.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Choice {
    /// The rung.
    pub rung: String,
    /// How a ray ends.
    pub choice: String,
    /// The view's name.
    pub view: String,
    /// Errors against the reference.
    pub errors: Errors,
}

impl Choice {
    /// Returns rung, choice, and the means over the views of FLIP, RMSE and signed energy, in the
    /// order of measurement.
    pub(super) fn means(choices: &[Self]) -> Vec<(&str, &str, [f64; 3])> {
        let mut keys: Vec<(&str, &str)> = choices.iter().map(|c| (c.rung.as_str(), c.choice.as_str())).collect();
        let mut seen = Vec::new();
        keys.retain(|key| {
            let new = !seen.contains(key);
            seen.push(*key);
            new
        });
        let of = |(rung, choice): (&str, &str)| {
            let same: Vec<&Errors> =
                choices.iter().filter(|c| c.rung == rung && c.choice == choice).map(|c| &c.errors).collect();
            let mean = |value: fn(&Errors) -> f64| same.iter().map(|e| value(e)).sum::<f64>() / same.len() as f64;
            [mean(|e| e.flip), mean(|e| e.rmse), mean(|e| e.energy)]
        };
        keys.into_iter().map(|key| (key.0, key.1, of(key))).collect()
    }
}

/// Distance limits in radii of the stone.
const LIMITS: [f32; 4] = [2.0, 4.0, 8.0, 16.0];

/// Measures the ways to end a ray for some rungs, in every view.
pub(super) fn measure(gpu: &Gpu, watched: &[Watched]) -> Result<Vec<Choice>, CostError> {
    let mut found = Vec::new();
    for name in ["proxy-1+tracker", "convex-8+tracker"] {
        let Ok(rung) = name.parse::<Rung>() else { continue };
        for Watched { view, scene, reference, .. } in watched {
            let settings =
                Settings { rung, samples: SAMPLES, ..Settings::of_size(super::views::SIDE, super::views::SIDE) };
            let mut ways = vec![
                ("rest from the environment".to_owned(), settings.clone()),
                (
                    "rest dropped".to_owned(),
                    Settings { gem: GemOptions { rest_from_environment: false, ..settings.gem }, ..settings.clone() },
                ),
            ];
            if rung.hits() > 1 {
                let radius = scene.bounds().radius();
                ways.extend(LIMITS.map(|limit| {
                    let settings = Settings {
                        gem: GemOptions { distance_limit: Some(limit * radius), ..settings.gem },
                        ..settings.clone()
                    };
                    (format!("ended after {limit} radii"), settings)
                }));
            }
            for (choice, settings) in ways {
                let errors = Errors::between(&render::render_means(gpu, scene, &settings)?, reference);
                found.push(Choice { rung: name.to_owned(), choice, view: view.name.to_owned(), errors });
            }
        }
    }
    Ok(found)
}
