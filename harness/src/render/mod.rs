//! A scene to a picture: the gem recipe over tiles, supersampled, then the display recipe.

mod camera;
pub mod file;
mod pipeline;

use crate::cookbook;
use crate::gpu::{Gpu, GpuError};
use crate::scene::Scene;
use crate::scene::environment_map::EnvironmentMap;
use pipeline::Pipelines;

/// Largest width and height of a picture in pixels.
pub const LARGEST_SIDE: u32 = 8192;
/// Side of a tile in pixels; with its samples it stays within every device's texture limit.
const TILE: u32 = 512;
/// Samples along each side of a pixel.
const SAMPLES: u32 = 4;

/// How much of the light's way is followed: a step of the ladder from cheap to exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rung {
    /// Reflection at the surface alone (the paper's Fig. 2).
    Surface,
    /// Proxy geometry with one internal hit (the paper's Fig. 1).
    ProxyOne,
}

/// Every rung with its name on the command line, from cheap to exact.
pub const RUNGS: [(&str, Rung); 2] = [("surface", Rung::Surface), ("proxy-1", Rung::ProxyOne)];

/// The light around the scene.
#[derive(Clone, Debug)]
pub enum Environment {
    /// The procedural studio of `wgsl/environment.wgsl`.
    Studio,
    /// A latitude-longitude image.
    Map(EnvironmentMap),
}

/// What to render.
#[derive(Clone, Debug)]
pub struct Settings {
    /// In pixels, 1 to [`LARGEST_SIDE`].
    pub width: u32,
    /// In pixels, 1 to [`LARGEST_SIDE`].
    pub height: u32,
    /// How much of the light's way is followed.
    pub rung: Rung,
    /// The proxy's centre by the paper's eq. (4) instead of the stable form.
    pub paper_centre: bool,
    /// The light around the scene.
    pub environment: Environment,
    /// Radiance is multiplied by this before the tone curve.
    pub exposure: f32,
}

impl Settings {
    /// The paper's rung in the studio.
    pub fn of_size(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            rung: Rung::ProxyOne,
            paper_centre: false,
            environment: Environment::Studio,
            exposure: 1.0,
        }
    }
}

/// A rendered picture, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// Linear radiance and coverage.
    pub linear: Vec<[f32; 4]>,
    /// sRGB, opaque.
    pub encoded: Vec<[u8; 4]>,
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// Width or height out of range.
    #[error("size {width}x{height} is out of range; each side must be 1 to {largest} pixels on this device")]
    Size {
        /// What was asked for.
        width: u32,
        /// What was asked for.
        height: u32,
        /// What is possible.
        largest: u32,
    },
    /// A mesh or an environment map that this device cannot hold.
    #[error("{what} needs {bytes} bytes in one buffer, and this device offers {limit}; use a smaller one")]
    TooLarge {
        /// Which.
        what: String,
        /// How large it is.
        bytes: u64,
        /// What is possible.
        limit: u64,
    },
    /// The recipe is not valid WGSL.
    #[error("{0}")]
    Recipe(#[from] crate::dispatch::DispatchError),
    /// The device refused.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// Renders `scene` with the cookbook's recipe.
pub fn render(gpu: &Gpu, scene: &Scene, settings: &Settings) -> Result<Picture, RenderError> {
    let source = cookbook::recipe_source("gem");
    render_with(gpu, scene, settings, &source, &mut |_, _| {})
}

/// Renders `scene` with another text of the gem recipe, and says after each tile how many of how many are done.
pub fn render_with(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    source: &str,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Picture, RenderError> {
    let (width, height) = (settings.width, settings.height);
    let largest = LARGEST_SIDE.min(gpu.device.limits().max_texture_dimension_2d);
    if !(1..=largest).contains(&width) || !(1..=largest).contains(&height) {
        return Err(RenderError::Size { width, height, largest });
    }
    let pipelines = Pipelines::new(gpu, source, settings)?;
    let stones = pipelines.upload(scene)?;
    let pixels = width as usize * height as usize;
    let mut picture = Picture { width, height, linear: vec![[0.0; 4]; pixels], encoded: vec![[0; 4]; pixels] };
    let (columns, rows) = (width.div_ceil(TILE), height.div_ceil(TILE));
    let total = u64::from(columns) * u64::from(rows);
    for row in 0..rows {
        for column in 0..columns {
            let tile = Tile {
                left: column * TILE,
                top: row * TILE,
                width: TILE.min(width - column * TILE),
                height: TILE.min(height - row * TILE),
            };
            pipelines.tile(&scene.camera, &scene.bounds(), &stones, settings, tile, &mut picture)?;
            progress(u64::from(row) * u64::from(columns) + u64::from(column) + 1, total);
        }
    }
    Ok(picture)
}

/// A rectangle of the picture in pixels.
#[derive(Clone, Copy, Debug)]
struct Tile {
    left: u32,
    top: u32,
    width: u32,
    height: u32,
}
