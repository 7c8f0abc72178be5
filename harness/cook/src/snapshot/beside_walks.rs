//! Translucent stone compared with random walks, and the difference.

use super::frames::{halved, side_by_side};
use super::shots::LIGHTS_ALONE;
use super::{EXR_SIDE, SnapshotError, WalkedReference};
use crate::exposure::best_exposure;
use lapidary_gpu::Gpu;
use lapidary_plan::{Effect, Effects, Rung};
use lapidary_render as render;
use lapidary_render::{Picture, Settings};
use lapidary_scene::Scene;

/// Name of the picture's files.
pub const NAME: &str = "beside_walks";
/// Title in the gallery.
pub const TITLE: &str = "Translucent stone beside random walks";
/// Description in the gallery.
pub const PARAGRAPH: &str = "Lambert's law with the shadows that bodies cast, light along the cheapest ways, random walks, and what is between these two: the absolute difference of the linear radiance, shown \
    as bright as the pictures. Both sides of a comparison have the one exposure that brings them nearest. Thin parts glow, thick ones are dark.";
/// The rungs shown before the walks; the difference of the last one is shown after them.
pub const RUNGS: [&str; 2] = ["lambert-shadowed", "godunov-128"];
/// Number of pictures in a row.
pub const COLUMNS: u32 = 4;

/// Renders a row for each scene: encoded, and at half that size for its linear radiance.
///
/// # Errors
/// Returns an error if a reference or a scene does not load or if the device fails.
pub fn render(gpu: &Gpu) -> Result<[Picture; 2], SnapshotError> {
    let mut frames = Vec::new();
    for reference in WalkedReference::of("optical_path") {
        let walks = reference.picture(gpu)?;
        let scene = Scene::named(reference.scene)?;
        for rung in RUNGS {
            frames.push(exposed(gpu, &scene, &settings(rung), &walks)?);
        }
        let paths = &frames[frames.len() - 1];
        let difference = difference(gpu, paths, &walks)?;
        frames.extend([walks, difference]);
    }
    let seen = side_by_side(&frames, COLUMNS);
    let half = halved(&seen);
    Ok([seen, half])
}

/// Returns the settings of a rung, limited to the effects that the walks account for.
///
/// # Panics
/// If no rung has the name `rung`; the names are compiled in.
#[must_use]
pub fn settings(rung: &str) -> Settings {
    Settings {
        rung: rung.parse::<Rung>().unwrap_or_else(|error| panic!("{rung}: {error}")),
        without: Effects::of(&[Effect::Environment]).and(Effects::SHEEN),
        exposure: LIGHTS_ALONE,
        ..Settings::of_size(EXR_SIDE, EXR_SIDE)
    }
}

/// Renders the picture and multiplies it by the exposure that brings it closest to `truth`.
fn exposed(gpu: &Gpu, scene: &Scene, settings: &Settings, truth: &Picture) -> Result<Picture, SnapshotError> {
    let mut picture = render::render(gpu, scene, settings)?;
    let exposure = best_exposure(&picture.linear, &truth.linear) as f32;
    picture.linear.iter_mut().flat_map(|pixel| &mut pixel[..3]).for_each(|value| *value *= exposure);
    render::encode(gpu, settings, &mut picture)?;
    Ok(picture)
}

fn difference(gpu: &Gpu, one: &Picture, other: &Picture) -> Result<Picture, SnapshotError> {
    let apart = |(one, other): (&[f32; 4], &[f32; 4])| {
        let [red, green, blue] = [0, 1, 2].map(|channel| (one[channel] - other[channel]).abs());
        [red, green, blue, one[3].max(other[3])]
    };
    let linear = one.linear.iter().zip(&other.linear).map(apart).collect();
    let mut picture = Picture { linear, notes: Vec::new(), ..one.clone() };
    render::encode(gpu, &settings(RUNGS[0]), &mut picture)?;
    Ok(picture)
}
