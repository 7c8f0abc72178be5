//! Translucent stone in motion: frames side by side, each with its own voxels, maps, seeds and
//! costs. Nothing is kept from one frame to the next.

use super::error::SnapshotError;
use super::frames::{halved, side_by_side};
use crate::motion::Motion;
use lapidary_gpu::Gpu;
use lapidary_plan::{Effect, Effects, Rung};
use lapidary_render as render;
use lapidary_render::{Picture, Settings};
use lapidary_scene::solver::{Method, Paths};
use lapidary_scene::{Scene, SceneError};

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

/// Times of a row's frames.
const TIMES: [[f64; 5]; 4] = [
    [0.0, 0.25, 0.5, 0.75, 1.0],
    [0.0, 0.25, 0.5, 0.75, 1.0],
    [0.0, 0.25, 0.5, 0.75, 1.0],
    [0.0, 0.25, 0.45, 0.7, 1.0],
];

/// Returns the scenes, row by row: a row for each motion.
///
/// # Errors
/// Returns an error if a built-in scene does not load.
pub fn scenes() -> Result<Vec<Scene>, SceneError> {
    let row = |(motion, times): (Motion, [f64; 5])| times.map(|time| motion.scene(time));
    Motion::ALL.into_iter().zip(TIMES).flat_map(row).collect()
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
