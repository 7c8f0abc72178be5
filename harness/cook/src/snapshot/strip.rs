//! Translucent stone in motion: frames side by side, each with its own voxels, maps, seeds and
//! costs. Nothing is kept from one frame to the next.

use super::SnapshotError;
use super::frames::{halved, side_by_side};
use glam::{DVec2, Vec3};
use lapidary_gpu::Gpu;
use lapidary_plan::{Effect, Effects, Rung};
use lapidary_render as render;
use lapidary_render::{Picture, Settings};
use lapidary_scene::deform::{merging, twisting};
use lapidary_scene::solver::{Method, Paths};
use lapidary_scene::{Bounds, Light, Object, Scene, SceneError};
use std::f32::consts::PI;

/// Name of the picture's files.
pub const NAME: &str = "strip";
/// Title in the gallery.
pub const TITLE: &str = "Marble in motion";
/// Description in the gallery.
pub const PARAGRAPH: &str = "Four rows of marble, each frame computed from nothing. The light goes round the bunny, and comes through its ears from behind; the \
    camera goes round the figure; the figure twists by a quarter of a turn to either side; two drops meet, and light goes through \
    the bridge between them.";
/// Number of frames in a row, and number of rows.
pub const FRAMES: [u32; 2] = [5, 4];
/// Width and height of a frame in pixels.
pub const SIDE: u32 = 128;

/// Returns the scenes, row by row.
///
/// # Errors
/// Returns an error if a built-in scene does not load.
pub fn scenes() -> Result<Vec<Scene>, SceneError> {
    let (bunny, figure) = (Scene::named("bunny")?, Scene::named("figure")?);
    let mut scenes = Vec::new();
    for azimuth in [-100.0, -140.0, 180.0, 140.0, 100.0] {
        scenes.push(Scene { lights: vec![sun(azimuth, 0.25)], ..bunny.clone() });
    }
    for azimuth in [-80.0, -35.0, 10.0, 55.0, 100.0] {
        scenes.push(Scene { lights: vec![sun(-150.0, 0.3)], ..figure.clone() }.seen_from(80.0, azimuth));
    }
    let still = &figure.objects[0];
    let bounds = Bounds::of(still.mesh.positions.iter().copied());
    let axis = DVec2::new(bounds.centre().x.into(), bounds.centre().z.into());
    let heights = [bounds.min.y, bounds.max.y].map(f64::from);
    for time in [0.75, 0.875, 0.0, 0.125, 0.25] {
        let mesh = twisting(&still.mesh, axis, heights, time);
        let objects = vec![Object { mesh, ..still.clone() }];
        scenes.push(Scene { objects, lights: vec![sun(-150.0, 0.3)], ..figure.clone() });
    }
    let drops = |time: f64| Object { name: "drops".to_owned(), mesh: merging(time), ..bunny.objects[0].clone() };
    let apart = Scene { objects: vec![drops(0.0)], ..bunny.clone() }.seen_from(75.0, 20.0);
    for time in [0.0, 0.25, 0.45, 0.7, 1.0] {
        scenes.push(Scene { objects: vec![drops(time)], lights: vec![sun(-150.0, 0.4)], ..apart.clone() });
    }
    Ok(scenes)
}

/// Returns a sun at `azimuth` degrees from +z towards +x and at `height` above the horizon.
fn sun(azimuth: f32, height: f32) -> Light {
    let (x, z) = azimuth.to_radians().sin_cos();
    Light::Directional { toward: Vec3::new(x, height, z).normalize(), irradiance: Vec3::splat(1.4 * PI) }
}

/// Returns the settings of each frame.
#[must_use]
pub fn settings() -> Settings {
    Settings {
        rung: Rung::OpticalPath(Paths { cells: 64, method: Method::Godunov }),
        without: Effects::of(&[Effect::Environment]),
        exposure: 1.5,
        ..Settings::of_size(SIDE, SIDE)
    }
}

/// Renders the strip: encoded, and at half that size for its linear radiance.
///
/// # Errors
/// Returns an error if a scene does not load or if the device fails.
pub fn render(gpu: &Gpu) -> Result<[Picture; 2], SnapshotError> {
    let settings = settings();
    let frames = scenes()?.iter().map(|scene| render::render(gpu, scene, &settings)).collect::<Result<Vec<_>, _>>()?;
    let seen = side_by_side(&frames, FRAMES[0]);
    let half = halved(&seen);
    Ok([seen, half])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_a_scene_for_each_frame() {
        assert_eq!(scenes().expect("they load").len() as u32, FRAMES[0] * FRAMES[1]);
    }
}
