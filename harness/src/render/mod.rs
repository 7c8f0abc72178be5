//! A scene to a picture: the rung's gem recipe over tiles, supersampled, then the display recipe; or the reference.

mod camera;
mod deferred;
mod device;
mod display;
mod environment;
pub mod file;
mod frame;
mod gem;
mod rung;
mod stone;
pub mod texture_diffusion;

use crate::cookbook;
use crate::gpu::{Gpu, GpuError};
use crate::reference::{self, Lost, Rendering};
use crate::scene::Scene;
use crate::scene::environment_map::EnvironmentMap;
use deferred::DeferredPass;
use display::DisplayPass;
pub use frame::{Frame, FrameTime};
pub(crate) use gem::constants;
use gem::{DEPTH_FORMAT, GemPass, GemTarget, SAMPLE_FORMAT};
pub use rung::{GRAMMAR, Geometry, MOST_HITS, MOST_WAVELENGTHS, NAMES, Rung, Spectrum};
use std::sync::Mutex;
pub(crate) use stone::{geometry_bytes, material as material_uniform, wavelengths as wavelength_table};

/// Largest width and height of a picture in pixels.
pub const LARGEST_SIDE: u32 = 8192;
/// Side of a tile in pixels; with its samples it stays within every device's texture limit.
const TILE: u32 = 512;
/// Samples along each side of a pixel, where nothing else is asked for.
pub const SAMPLES: u32 = 4;

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
    /// Samples along each side of a pixel, 1 to 4.
    pub samples: u32,
    /// How much of the light's way is followed.
    pub rung: Rung,
    /// The proxy's centre by the paper's eq. (4) instead of the stable form.
    pub paper_centre: bool,
    /// Factor of the paper's eq. (12); 1 as printed.
    pub dispersion_strength: f32,
    /// Light is absorbed inside where the material says so.
    pub absorption: bool,
    /// What a ray still carries at the last hit comes from the environment along it; dropped otherwise.
    pub rest_from_environment: bool,
    /// In units of length: a ray ends that has travelled farther inside.
    pub distance_limit: Option<f32>,
    /// By a geometry buffer and a lighting pass instead of in one.
    pub deferred: bool,
    /// The light around the scene.
    pub environment: Environment,
    /// Radiance is multiplied by this before the tone curve.
    pub exposure: f32,
    /// Wavelengths that the reference follows, from 400 to 700 nm.
    pub wavelengths: usize,
    /// The share of a camera ray's energy that the reference need not follow.
    pub energy_bound: f64,
}

impl Settings {
    /// The paper's rung in the studio.
    pub fn of_size(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            samples: SAMPLES,
            rung: Rung::PAPER,
            paper_centre: false,
            dispersion_strength: 1.0,
            absorption: true,
            rest_from_environment: true,
            distance_limit: None,
            deferred: false,
            environment: Environment::Studio,
            exposure: 1.0,
            wavelengths: reference::WAVELENGTHS,
            energy_bound: reference::ENERGY_BOUND,
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
    /// What the reference did not follow; none of another rung.
    pub lost: Option<Lost>,
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
    /// An exact rung for convex stones, and a stone that is not.
    #[error("object `{object}` is not convex, which the convex rungs need; use a bvh rung")]
    NotConvex {
        /// Its name.
        object: String,
    },
    /// A rung whose loops a driver would end before they are done.
    #[error(
        "rung `{rung}` may take {steps} turns of its loops for one pixel, and lavapipe ends them silently after {limit}; \
         take fewer hits or wavelengths, or another adapter"
    )]
    TooManySteps {
        /// Which.
        rung: Rung,
        /// How many.
        steps: u64,
        /// What the driver allows.
        limit: u64,
    },
    /// The reference refuses.
    #[error(transparent)]
    Reference(#[from] reference::ReferenceError),
    /// The recipe is not valid WGSL.
    #[error("{0}")]
    Recipe(#[from] crate::dispatch::DispatchError),
    /// The device refused.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// Renders `scene` with the cookbook's recipe.
pub fn render(gpu: &Gpu, scene: &Scene, settings: &Settings) -> Result<Picture, RenderError> {
    let source = cookbook::recipe_source(settings.rung.recipe());
    render_with(gpu, scene, settings, &source, &mut |_, _| {})
}

/// Renders `scene` with another text of the rung's recipe, and says how many of how many steps are done.
pub fn render_with(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    source: &str,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<Picture, RenderError> {
    render_from(gpu, scene, settings, [source, &cookbook::recipe_source(deferred::COMPOSITE)], progress)
}

/// The same with both texts: of the rung's recipe, and of the lighting pass.
fn render_from(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    [source, composite]: [&str; 2],
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<Picture, RenderError> {
    let (width, height) = (settings.width, settings.height);
    let largest = LARGEST_SIDE.min(gpu.device.limits().max_texture_dimension_2d);
    if !(1..=largest).contains(&width) || !(1..=largest).contains(&height) {
        return Err(RenderError::Size { width, height, largest });
    }
    let pixels = width as usize * height as usize;
    let (linear, encoded) = (vec![[0.0; 4]; pixels], vec![[0; 4]; pixels]);
    let mut picture = Picture { width, height, linear, encoded, lost: None };
    if settings.rung == Rung::Reference {
        let Rendering { linear, lost, .. } = follow(scene, settings, progress)?;
        (picture.linear, picture.lost) = (linear, Some(lost));
        encode(gpu, settings, &mut picture)?;
        return Ok(picture);
    }
    let display = DisplayPass::new(gpu, settings.samples)?;
    let deferred = settings.deferred.then(|| DeferredPass::new(gpu, settings, composite)).transpose()?;
    let (fragment, formats): (&str, &[_]) = match deferred {
        Some(_) => ("gem_deferred_fragment", &[deferred::GEOMETRY_FORMAT; deferred::TARGETS]),
        None => ("gem_fragment", &[SAMPLE_FORMAT]),
    };
    let gem = GemPass::new(gpu, scene, settings, source, fragment, formats)?;
    let depth = gpu.guarded("allocating a tile", |device| {
        let size = [TILE * settings.samples; 2];
        device::view(&device::target(device, size, DEPTH_FORMAT, wgpu::TextureUsages::empty()))
    })?;
    let tiles: Vec<Tile> = Tile::all(width, height).collect();
    for (done, tile) in (1..).zip(&tiles) {
        let clip_from_world = camera::clip_from_world(&scene.camera, &scene.bounds(), width, height, *tile);
        let eye = scene.camera.eye;
        let size = [tile.width * settings.samples, tile.height * settings.samples];
        let encoder = gpu.guarded("rendering a tile", |device| {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            if let Some(deferred) = &deferred {
                deferred.draw(&mut encoder, &gem, clip_from_world, eye, display.samples(), size);
            } else {
                let target = GemTarget { colors: vec![display.samples()], depth: &depth, keep_depth: false, size };
                gem.draw(&mut encoder, &gem.view(clip_from_world, eye), &target);
            }
            encoder
        })?;
        display.finish(encoder, *tile, settings, &mut picture)?;
        progress(done, tiles.len() as u64);
    }
    Ok(picture)
}

/// What the reference sees of `scene`, by the settings' size, samples and environment.
fn follow(
    scene: &Scene,
    settings: &Settings,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<Rendering, RenderError> {
    let of_reference = reference::Settings {
        samples: settings.samples,
        wavelengths: settings.wavelengths,
        energy_bound: settings.energy_bound,
        environment: &settings.environment,
        ..reference::Settings::of_size(settings.width, settings.height)
    };
    let progress = Mutex::new(progress);
    let tell = |done, total| {
        if let Ok(mut progress) = progress.lock() {
            progress(done, total);
        }
    };
    Ok(reference::render(scene, &of_reference, &tell)?)
}

/// Fills in `encoded` from `linear`, as the display recipe shows it.
pub(crate) fn encode(gpu: &Gpu, settings: &Settings, picture: &mut Picture) -> Result<(), RenderError> {
    let display = DisplayPass::new(gpu, 1)?;
    for tile in Tile::all(picture.width, picture.height) {
        display.write(tile, picture);
        let encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        display.finish(encoder, tile, settings, picture)?;
    }
    Ok(())
}

/// Clip space of a whole picture of `scene`. Depth runs from 0 near to 1 far.
pub fn clip_from_world(scene: &Scene, width: u32, height: u32) -> glam::Mat4 {
    camera::clip_from_world(&scene.camera, &scene.bounds(), width, height, Tile::whole([width, height]))
}

/// A rectangle of the picture in pixels.
#[derive(Clone, Copy, Debug)]
struct Tile {
    left: u32,
    top: u32,
    width: u32,
    height: u32,
}

impl Tile {
    /// A whole picture.
    fn whole([width, height]: [u32; 2]) -> Self {
        Self { left: 0, top: 0, width, height }
    }

    /// The tiles of a picture, row by row.
    fn all(width: u32, height: u32) -> impl Iterator<Item = Self> {
        let lefts = move || (0..width).step_by(TILE as usize);
        (0..height).step_by(TILE as usize).flat_map(move |top| {
            lefts().map(move |left| Self { left, top, width: TILE.min(width - left), height: TILE.min(height - top) })
        })
    }
}
