//! Rays that end once the light they carry is too faint to be seen.

use super::rungs::SCENES;
use lapidary_assay::extremum::larger;
use lapidary_gpu::Gpu;
use lapidary_ladders::gem::views;
use lapidary_ladders::timing::{self, Timed};
use lapidary_ladders::{CostError, Options, Progress, Report, Row};
use lapidary_plan::Rung;
use lapidary_render as render;
use lapidary_render::pixel::{Shading, Stone, Viewer};
use lapidary_render::restraint::LEAST_DIFFERENCE;
use lapidary_render::{GemOptions, RenderError, Settings};
use lapidary_scene::Scene;

/// Width and height of the compared pictures in pixels.
const SIDE: u32 = 256;
/// Width and height of the coarse picture whose pixels are used to count facets.
const COUNTED: [u32; 2] = [96, 54];
/// The early exit from a loop in the recipes' source, and its replacement that runs the loop to its
/// end.
const BREAK: [&str; 2] = ["(LIMIT_THROUGHPUT || END_AT_FIRST_EXIT) && !ray.followed", "false"];

/// The way of a rung with the limit and early exits from the loops.
pub(super) const LIMITED: &str = "limited";
/// The way of a rung with the limit and loops that run to their end.
pub(super) const NO_BREAK: &str = "limited without break";

/// Returns the number of facets that a ray searches for, computed with the mirror and averaged over
/// the rays of all pixels that show the scene's single stone, in a picture of the settings' size.
///
/// # Errors
///
/// Returns an error if the rung cannot draw the stone.
pub fn facets(scene: &Scene, settings: &Settings) -> Result<f64, RenderError> {
    let viewer = Viewer::new(scene, settings.width, settings.height);
    let (mut rays, mut facets) = (0, 0);
    if let [object] = &scene.objects[..] {
        let shading = Shading::new(&object.material, settings);
        let stone = Stone::new(object, settings)?;
        for (line, column) in (0..settings.height).flat_map(|line| (0..settings.width).map(move |x| (line, x))) {
            let (x, y) = (f64::from(column) + 0.5, f64::from(line) + 0.5);
            let Some(seen) = viewer.see(&object.mesh, x, y) else { continue };
            let pixel = shading.pixel(&stone, seen, scene.camera.eye);
            rays += pixel.rays.len();
            facets += pixel.rays.iter().map(Vec::len).sum::<usize>();
        }
    }
    Ok(facets as f64 / rays as f64)
}

fn settings(rung: Rung, limited: bool, [width, height]: [u32; 2]) -> Settings {
    let gem = GemOptions { limit_throughput: Some(limited), ..GemOptions::default() };
    Settings { rung, samples: 1, gem, ..Settings::of_size(width, height) }
}

/// Returns the largest difference in units of the bound, the largest encoded difference, and the
/// fraction of covered pixels whose encoded values differ.
fn differences(gpu: &Gpu, scene: &Scene, rung: Rung) -> Result<(f64, u8, f64), CostError> {
    let picture = |limited| render::render(gpu, scene, &settings(rung, limited, [SIDE; 2]));
    let (one, other) = (picture(false)?, picture(true)?);
    let (mut largest, mut largest_encoded, mut changed, mut covered) = (0.0, 0, 0, 0);
    let encoded = one.encoded.iter().zip(&other.encoded);
    for ((a, b), (seen_a, seen_b)) in one.linear.iter().zip(&other.linear).zip(encoded) {
        largest = (0..3).map(|k| f64::from((a[k] - b[k]).abs())).fold(largest, larger);
        let steps = (0..3).map(|k| seen_a[k].abs_diff(seen_b[k])).fold(0, u8::max);
        largest_encoded = largest_encoded.max(steps);
        covered += usize::from(a[3] > 0.0);
        changed += usize::from(steps > 0);
    }
    Ok((largest / LEAST_DIFFERENCE, largest_encoded, changed as f64 / covered as f64))
}

/// Adds all scenes and rungs, timed in one run: the facets that a ray searches for, averaged over the
/// covered pixels of the timed frame; the largest difference of radiance times exposure in the
/// scene's own picture, in units of the bound; the same in 8-bit steps; and the fraction of its
/// covered pixels that differ by at least one.
pub(super) fn measure(
    gpu: &Gpu,
    options: &Options,
    report: &mut Report,
    progress: Progress<'_>,
) -> Result<(), CostError> {
    let mut scenes = Vec::new();
    for name in SCENES {
        let scene = Scene::named(name)?;
        scenes.push((name, views::filled(&scene), scene));
    }
    let pairs: Vec<_> = scenes.iter().flat_map(|scene| options.rungs.iter().map(move |&rung| (scene, rung))).collect();
    let timed: Vec<Timed<'_>> = pairs
        .iter()
        .flat_map(|((_, filled, _), rung)| {
            let source = lapidary_wgsl::recipe_source(rung.recipe());
            let through = source.replace(BREAK[0], BREAK[1]);
            // All variants of a comparison are timed on the same pixels.
            [(false, source.clone()), (true, source), (true, through)].map(|(limited, source)| Timed {
                source: Some(source),
                ..Timed::new(filled, settings(*rung, limited, options.frame))
            })
        })
        .collect();
    let timings = timing::time(gpu, &timed, options.rounds.max(1), &mut |done, total| progress("timing", done, total))?;
    for ((&((name, filled, scene), rung), timings), done) in pairs.iter().zip(timings.chunks_exact(3)).zip(1..) {
        let counted = |limited| facets(filled, &settings(rung, limited, COUNTED));
        let (largest, steps, changed) = differences(gpu, scene, rung)?;
        let [unlimited, limited, no_break] = [0, 1, 2].map(|way: usize| timings[way].map(|timing| timing.ms));
        let (label, with) = (rung.to_string(), |way: &str| format!("{rung}, {way}"));
        let row = |rung: &str, measure: &str, value: f64| Row::new(rung, name, measure, value, "");
        report.rows.extend([
            row(&label, "facets", counted(false)?).timed(unlimited),
            row(&with(LIMITED), "facets", counted(true)?).timed(limited),
            row(&with(LIMITED), "share of the bound", largest).timed(limited),
            row(&with(LIMITED), "steps", steps.into()),
            row(&with(LIMITED), "changed", changed),
            row(&with(NO_BREAK), "share of the bound", largest).timed(no_break),
        ]);
        progress("comparing", done, pairs.len() as u64);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_recipe_has_the_break_that_is_taken_out() {
        for rung in crate::restraint::RUNGS {
            let rung: Rung = rung.parse().expect(rung);
            assert_eq!(lapidary_wgsl::recipe_source(rung.recipe()).matches(BREAK[0]).count(), 4, "{rung}");
        }
    }
}
