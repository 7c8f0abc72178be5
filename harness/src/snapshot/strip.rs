//! Translucent stone in motion: frames side by side, each with voxels, maps, seeds and costs of its own. Nothing is kept from one to the next.

use super::SnapshotError;
use crate::gpu::Gpu;
use crate::optical_path::Method;
use crate::render::{self, Paths, Picture, Rung, Settings};
use crate::scene::deform::{merging, twisting};
use crate::scene::{Bounds, Light, Object, Scene, SceneError};
use glam::{DVec2, Vec3};
use std::f32::consts::PI;

/// Its file's name.
pub const NAME: &str = "strip";
/// What the gallery calls it.
pub const TITLE: &str = "Marble in motion";
/// What it shows.
pub const PARAGRAPH: &str = "Four rows of marble, each frame computed from nothing. The light goes round the bunny, and comes through its ears from behind; the \
    camera goes round the figure; the figure twists by a quarter of a turn to either side; two drops meet, and light goes through \
    the bridge between them.";
/// Frames beside one another, and rows of them.
pub const FRAMES: [u32; 2] = [5, 4];
/// Side of a frame in pixels.
pub const SIDE: u32 = 128;

/// The scenes, row by row.
///
/// # Errors
/// Where a built-in scene does not load.
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

/// From `azimuth` degrees off +z towards +x, so high above the horizon.
fn sun(azimuth: f32, height: f32) -> Light {
    let (x, z) = azimuth.to_radians().sin_cos();
    Light::Directional { toward: Vec3::new(x, height, z).normalize(), irradiance: Vec3::splat(1.4 * PI) }
}

/// How each frame is rendered.
#[must_use]
pub fn settings() -> Settings {
    Settings {
        rung: Rung::OpticalPath(Paths { cells: 64, method: Method::Godunov }),
        light_from_environment: false,
        // Half of what is usual, for bodies as small in the picture as these.
        extinction_scale: 0.5 * render::EXTINCTION_SCALE,
        exposure: 1.5,
        ..Settings::of_size(SIDE, SIDE)
    }
}

/// Renders it: as it is seen, and at half that size for its linear radiance.
///
/// # Errors
/// Where a scene does not load, or the device refuses.
pub fn render(gpu: &Gpu) -> Result<[Picture; 2], SnapshotError> {
    let settings = settings();
    let frames = scenes()?.iter().map(|scene| render::render(gpu, scene, &settings)).collect::<Result<Vec<_>, _>>()?;
    let seen = side_by_side(&frames);
    let half = halved(&seen);
    Ok([seen, half])
}

/// Frames of [`SIDE`] pixels in their rows.
fn side_by_side(frames: &[Picture]) -> Picture {
    let [width, height] = FRAMES.map(|count| count * SIDE);
    let pixel = |index: u32| {
        let (column, row) = (index % width, index / width);
        let frame = &frames[(row / SIDE * FRAMES[0] + column / SIDE) as usize];
        (frame, (row % SIDE * SIDE + column % SIDE) as usize)
    };
    Picture {
        width,
        height,
        linear: (0..width * height).map(pixel).map(|(frame, place)| frame.linear[place]).collect(),
        encoded: (0..width * height).map(pixel).map(|(frame, place)| frame.encoded[place]).collect(),
        lost: None,
        walked: None,
        notes: frames.iter().flat_map(|frame| frame.notes.clone()).collect(),
    }
}

/// The mean of each two by two pixels, linear alone.
fn halved(picture: &Picture) -> Picture {
    let [width, height] = [picture.width / 2, picture.height / 2];
    let mean = |index: u32| {
        let first = (index / width * 2 * picture.width + index % width * 2) as usize;
        let below = first + picture.width as usize;
        let four = [first, first + 1, below, below + 1].map(|place| picture.linear[place]);
        std::array::from_fn(|channel| 0.25 * four.iter().map(|pixel| pixel[channel]).sum::<f32>())
    };
    let linear: Vec<[f32; 4]> = (0..width * height).map(mean).collect();
    let encoded = vec![[0; 4]; linear.len()];
    Picture { width, height, linear, encoded, lost: None, walked: None, notes: Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(number: u32) -> Picture {
        let pixels = (SIDE * SIDE) as usize;
        let linear = vec![[number as f32, 0.0, 0.0, 1.0]; pixels];
        let encoded = vec![[number as u8, 0, 0, 255]; pixels];
        Picture { width: SIDE, height: SIDE, linear, encoded, lost: None, walked: None, notes: Vec::new() }
    }

    #[test]
    fn frames_lie_in_rows() {
        let frames: Vec<Picture> = (0..FRAMES[0] * FRAMES[1]).map(frame).collect();
        let mut strip = side_by_side(&frames);
        assert_eq!((strip.width, strip.height), (640, 512));
        for (column, row, number) in [(0, 0, 0), (127, 127, 0), (128, 0, 1), (639, 0, 4), (0, 128, 5), (639, 511, 19)] {
            let place = row * 640 + column;
            assert_eq!((strip.encoded[place][0], strip.linear[place][0]), (number, f32::from(number)));
        }
        strip.linear[641][0] = 4.0;
        let half = halved(&strip);
        assert_eq!((half.width, half.height, half.linear.len()), (320, 256, 320 * 256));
        assert_eq!((half.linear[0][0], half.linear[64][0], half.linear[320 * 64][0]), (1.0, 1.0, 5.0));
    }

    #[test]
    fn there_is_a_scene_for_each_frame() {
        assert_eq!(scenes().expect("they load").len() as u32, FRAMES[0] * FRAMES[1]);
    }
}
