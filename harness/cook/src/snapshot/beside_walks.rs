//! Translucent stone beside the random walks through it, and the difference.

use super::frames::{halved, side_by_side};
use super::shots::LIGHTS_ALONE;
use super::{EXR_SIDE, SnapshotError, WalkedReference};
use crate::exposure::best_exposure;
use lapidary_gpu::Gpu;
use lapidary_plan::{Effect, Effects, Rung};
use lapidary_render as render;
use lapidary_render::{Picture, Settings};
use lapidary_scene::Scene;

/// Its file's name.
pub const NAME: &str = "beside_walks";
/// What the gallery calls it.
pub const TITLE: &str = "Translucent stone beside random walks";
/// What it shows.
pub const PARAGRAPH: &str = "Lambert's law with the shadows that bodies cast, light along the cheapest ways, random walks, and what is between these two: the absolute difference of the linear radiance, shown \
    as bright as the pictures. Both sides of a comparison have the one exposure that brings them nearest. Thin parts glow, thick ones are dark.";
/// The rungs that are shown before the walks, the last one's difference after them.
pub const RUNGS: [&str; 2] = ["lambert-shadowed", "godunov-128"];
/// Pictures in a row.
pub const COLUMNS: u32 = 4;

/// A row for each scene: as it is seen, and at half that size for its linear radiance.
///
/// # Errors
/// Where a reference or a scene does not load, or the device refuses.
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

/// How a rung is rendered: what walks know of, and no more.
///
/// # Panics
/// Where `rung` is none: the names are compiled in.
#[must_use]
pub fn settings(rung: &str) -> Settings {
    Settings {
        rung: rung.parse::<Rung>().unwrap_or_else(|error| panic!("{rung}: {error}")),
        without: Effects::of(&[Effect::Environment]).and(Effects::SHEEN),
        exposure: LIGHTS_ALONE,
        ..Settings::of_size(EXR_SIDE, EXR_SIDE)
    }
}

/// The picture times the exposure that brings it nearest to `truth`.
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
