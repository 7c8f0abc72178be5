//! Renders a scene to a picture: the rung's recipe over tiles, supersampled, then the display
//! recipe; or the reference.
//!
//! ```no_run
//! use lapidary_gpu::{AdapterChoice, Gpu};
//! use lapidary_plan::Rung;
//! use lapidary_render::{Settings, render};
//! use lapidary_scene::Scene;
//!
//! let gpu = Gpu::shared(&AdapterChoice::from_environment())?;
//! let settings = Settings { rung: Rung::ByMaterial, ..Settings::of_size(640, 480) };
//! let picture = render(gpu, &Scene::open("brilliant")?, &settings)?;
//! println!("{} x {} pixels, sRGB in `picture.encoded`", picture.width, picture.height);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod blur;
mod bodies;
mod camera;
pub mod cdrf;
mod colored_shadow;
mod deferred;
mod density;
mod diffusion;
mod display;
mod drawing;
mod environment;
mod error;
pub mod file;
mod footprint;
pub mod frame;
mod gem;
mod layers;
mod light_maps;
mod light_views;
mod lighting;
mod mesh_buffers;
mod optical_path;
mod pass;
pub mod pixel;
pub mod plan;
mod reflectance;
mod reflective_shadow_map;
pub mod restraint;
mod scattering_law;
mod screen;
mod settings;
mod shadows;
pub mod solver;
mod stage;
mod stone;
pub mod texture_diffusion;
mod textures;
mod timer;
mod translucent;
mod variant;
pub mod voxel_grid;
pub mod voxelization;
mod walk;

use display::{Display, ENCODED};
use drawing::{Drawing, Texts};
pub use error::RenderError;
use frame::{Executor, Frame};
pub use frame::{compute, shader};
use lapidary_gpu::Gpu;
use lapidary_plan::{Decisions, Effect, Note, Rung};
use lapidary_reference::random_walk::mesh;
use lapidary_reference::random_walk::mesh::Rendering as Walked;
use lapidary_reference::spectral::{self, Lost, Rendering, Window};
use lapidary_scene::solver::Reflectance;
use lapidary_scene::{Environment, LARGEST_SIDE, Material, Object, Scene};
pub use reflectance::{Curvature, ShadowForm};
pub use settings::{
    DiffuseOptions, DiffusionOptions, EXTINCTION_SCALE, GemOptions, OpticalPathOptions, ReferenceOptions, SCREEN_STEPS,
    Settings, WALKS, WalkOptions,
};
pub use stage::Stage;
use std::sync::Mutex;
pub use stone::geometry_bytes;
pub(crate) use stone::{GemMaterial, GemWavelength, wavelengths};
pub use timer::{FrameTime, FrameTimer};
pub(crate) use variant::names as object_names;

/// Largest side of a tile in pixels.
const TILE: u32 = 512;
/// Largest side of a tile in samples: well within every device's texture limit, and 80 MiB of
/// colour and depth.
const TILE_SAMPLES: u32 = 2048;
/// Largest number of samples along each side of a pixel.
pub const MOST_SAMPLES: u32 = 8;

/// A rendered picture, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Linear radiance and coverage.
    pub linear: Vec<[f32; 4]>,
    /// sRGB, opaque: the mean of the tone-mapped samples, if there are samples.
    pub encoded: Vec<[u8; 4]>,
    /// Energy that the reference of clear stones did not follow; `None` if it did not render the
    /// picture.
    pub lost: Option<Lost>,
    /// Quality of the reference of scattering bodies; `None` if it did not render the picture.
    pub walked: Option<WalkedPicture>,
    /// Warnings.
    pub notes: Vec<Note>,
}

/// Quality of a picture rendered by random walks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WalkedPicture {
    /// Root mean square of the pixels' standard errors, relative to the mean brightness, both over
    /// pixels that show a body.
    pub error: f64,
    /// Number of samples that met a body.
    pub walks: u64,
    /// Number of walks that slipped through a surface by rounding and were dropped.
    pub lost: u64,
}

/// Renders `scene` with the cookbook's recipe.
pub fn render(gpu: &Gpu, scene: &Scene, settings: &Settings) -> Result<Picture, RenderError> {
    render_reporting(gpu, scene, settings, &mut |_, _| {})
}

/// Renders `scene` like [`render`], and calls `progress` with the number of steps done and in
/// total.
pub fn render_reporting(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<Picture, RenderError> {
    render_from(gpu, scene, settings, Texts::default(), progress)
}

/// Renders `scene` and displays its mean radiance instead of its samples.
///
/// Committed references are displayed this way, because only their means are stored. If two
/// pictures are compared as displayed, both must be displayed alike.
pub fn render_means(gpu: &Gpu, scene: &Scene, settings: &Settings) -> Result<Picture, RenderError> {
    let mut picture = render(gpu, scene, settings)?;
    encode(gpu, settings, &mut picture)?;
    Ok(picture)
}

/// Renders `scene` with another source text for the rung's recipe.
pub fn render_with(gpu: &Gpu, scene: &Scene, settings: &Settings, source: &str) -> Result<Picture, RenderError> {
    render_from(gpu, scene, settings, Texts { rung: Some(source), composite: None }, &mut |_, _| {})
}

/// Returns everything that is created and run on a device to draw `scene`; empty for the reference.
///
/// `gpu` computes the tables; if it is `None`, they are left out.
///
/// # Errors
/// If the scene cannot be drawn with these settings.
pub fn frame(gpu: Option<&Gpu>, scene: &Scene, settings: &Settings) -> Result<Frame, RenderError> {
    check_size(settings)?;
    if settings.rung == Rung::Reference {
        return Ok(Frame::default());
    }
    Ok(Drawing::new(gpu, scene, settings, Texts::default())?.frame)
}

/// Rejects sizes that no device supports, and numbers of samples out of range.
fn check_size(settings: &Settings) -> Result<(), RenderError> {
    let (width, height) = (settings.width, settings.height);
    let largest = LARGEST_SIDE.min(wgpu::Limits::default().max_texture_dimension_2d);
    if !(1..=largest).contains(&width) || !(1..=largest).contains(&height) {
        return Err(RenderError::Size { width, height, largest });
    }
    if !(1..=MOST_SAMPLES).contains(&settings.samples) {
        return Err(RenderError::Samples(settings.samples));
    }
    Ok(())
}

/// Renders `scene` with other source texts.
fn render_from(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    texts: Texts<'_>,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<Picture, RenderError> {
    check_size(settings)?;
    let (width, height) = (settings.width, settings.height);
    let pixels = width as usize * height as usize;
    let (linear, encoded) = (vec![[0.0; 4]; pixels], vec![[0; 4]; pixels]);
    let mut picture = Picture { width, height, linear, encoded, lost: None, walked: None, notes: Vec::new() };
    if settings.rung == Rung::Reference {
        let scene = &*drawing::apart(scene, settings);
        if scatters(scene) {
            let Walked { linear, standard_error, walks, lost, .. } = walk(scene, settings, progress)?;
            picture.walked = Some(WalkedPicture { error: mean_error(&linear, &standard_error), walks, lost });
            picture.linear = linear;
            // A walk's radiance is an estimate that is right only in the mean; the tone curve
            // applied to single estimates would be too dark.
            encode(gpu, settings, &mut picture)?;
        } else {
            follow(gpu, scene, settings, &mut picture, progress)?;
        }
        return Ok(picture);
    }
    let Drawing { frame, pass } = Drawing::new(Some(gpu), scene, settings, texts)?;
    let executor = Executor::new(gpu, frame)?;
    let tiles = Tile::all(width, height, settings.samples).count() as u64;
    let mut done = 0;
    executor.run(|read, texels| {
        picture.take(read, texels);
        // The last read of a tile.
        if read.picture == ENCODED {
            done += 1;
            progress(done, tiles);
        }
    })?;
    let of_paths = pass.paths().map(|paths| paths.notes(&executor));
    let of_diffusions = pass.diffusions().map(|diffusions| diffusions.notes(&executor));
    picture.notes = of_paths.chain(of_diffusions).collect::<Result<Vec<_>, _>>()?.concat();
    Ok(picture)
}

/// Returns the overrides of the gem recipes for a scene's first object.
pub fn gem_constants(scene: &Scene, settings: &Settings) -> Vec<(&'static str, f64)> {
    let decisions = scene.objects.first().map(|object| Decisions::of(object, scene, &settings.request()));
    decisions.map_or_else(Vec::new, |decisions| gem::constants(&decisions, decisions.rung, settings))
}

/// Returns the overrides of the recipe `cdrf_shading` for a scene's first object.
pub fn translucent_constants(scene: &Scene, settings: &Settings, reflectance: Reflectance) -> Vec<(&'static str, f64)> {
    let decisions = scene.objects.first().map(|object| Decisions::of(object, scene, &settings.request()));
    decisions.map_or_else(Vec::new, |decisions| translucent::constants(&decisions, settings, reflectance))
}

/// Returns whether any body of `scene` scatters light.
pub fn scatters(scene: &Scene) -> bool {
    scene.objects.iter().any(|object| object.material.scatters())
}

/// Renders `scene` by random walks.
fn walk(
    scene: &Scene,
    settings: &Settings,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<Walked, RenderError> {
    let of_walks = mesh::Settings {
        width: settings.width,
        height: settings.height,
        samples_per_pixel: settings.walks.walks,
        origin: settings.walks.from,
        seed: settings.walks.seed,
        environment: (!settings.without.has(Effect::Environment)).then_some(&settings.environment),
        boundary: settings.walks.boundary,
    };
    Ok(mesh::render(scene, &of_walks, &from_any_thread(progress))?)
}

/// Wraps a progress callback so that several threads may call it.
fn from_any_thread(progress: &mut (dyn FnMut(u64, u64) + Send)) -> impl Fn(u64, u64) + Sync {
    let progress = Mutex::new(progress);
    move |done, total| {
        if let Ok(mut progress) = progress.lock() {
            progress(done, total);
        }
    }
}

/// Returns the root mean square of the standard errors of covered pixels, relative to their mean
/// brightness.
fn mean_error(linear: &[[f32; 4]], standard_error: &[[f32; 3]]) -> f64 {
    let covered = || linear.iter().zip(standard_error).filter(|(pixel, _)| pixel[3] > 0.0);
    let squares: f64 = covered().flat_map(|(_, error)| error).map(|error| f64::from(*error).powi(2)).sum();
    let sum: f64 = covered().flat_map(|(pixel, _)| &pixel[..3]).map(|value| f64::from(*value)).sum();
    let count = 3.0 * covered().count() as f64;
    if sum > 0.0 { (squares / count).sqrt() / (sum / count) } else { 0.0 }
}

/// Fills `picture` with the reference of `scene`, with the settings' size, samples and environment.
/// Its samples are displayed like those of any rung.
fn follow(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    picture: &mut Picture,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<(), RenderError> {
    // What is opaque is drawn matte. The rule of the effect `reflection` says whether it also reflects.
    let reflects = |Material { ior, roughness, .. }: &Material| *ior != 1.0 && *roughness == 0.0;
    let polished = |object: &&Object| object.material.is_opaque() && reflects(&object.material);
    if let Some(opaque) = scene.objects.iter().find(polished) {
        return Err(RenderError::OpaqueReference { object: opaque.name.clone() });
    }
    let (width, height) = (settings.width, settings.height);
    let rows: u64 = Tile::all(width, height, settings.samples).map(|tile| u64::from(tile.height)).sum();
    let (mut done, mut covered, mut lost) = (0u64, 0.0, Lost::default());
    let display = Display::new(gpu, settings)?;
    for tile in &display.tiles {
        let Tile { left, top, width, height } = tile.0;
        let of_reference = spectral::Settings {
            window: Some(Window { left, top, width, height }),
            samples: settings.samples,
            wavelengths: settings.reference.wavelengths,
            energy_bound: settings.reference.energy_bound,
            environment: &settings.environment,
            lit_by_environment: !settings.without.has(Effect::Environment),
            ..spectral::Settings::of_size(settings.width, settings.height)
        };
        let mut of_all = |of_tile: u64, _: u64| progress(done + of_tile, rows);
        let (Rendering { linear, lost: of_tile, .. }, samples) =
            spectral::render_samples(scene, &of_reference, &from_any_thread(&mut of_all))?;
        done += u64::from(height);
        let share: f64 = linear.iter().map(|pixel| f64::from(pixel[3])).sum();
        covered += share;
        lost = Lost { max: lost.max.max(of_tile.max), mean: lost.mean + share * of_tile.mean };
        display.show(tile, &samples, picture)?;
        // Replaces the device's means, which are f32.
        for (row, means) in (top..).zip(linear.chunks_exact(width as usize)) {
            let start = (row * picture.width + left) as usize;
            picture.linear[start..start + means.len()].copy_from_slice(means);
        }
    }
    picture.lost = Some(Lost { mean: if covered > 0.0 { lost.mean / covered } else { 0.0 }, ..lost });
    Ok(())
}

/// Fills `encoded` from `linear`: the display recipe applied to means, with one sample per pixel.
pub fn encode(gpu: &Gpu, settings: &Settings, picture: &mut Picture) -> Result<(), RenderError> {
    let settings = Settings { width: picture.width, height: picture.height, samples: 1, ..settings.clone() };
    let display = Display::new(gpu, &settings)?;
    for tile in &display.tiles {
        let Tile { left, top, width, height } = tile.0;
        let rows = (top..top + height).map(|row| (row * picture.width + left) as usize);
        let means: Vec<[f32; 4]> =
            rows.flat_map(|start| &picture.linear[start..start + width as usize]).copied().collect();
        display.show(tile, &means, picture)?;
    }
    Ok(())
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
    /// Returns the largest side of a tile in pixels for `samples` along each side of a pixel.
    fn side(samples: u32) -> u32 {
        TILE.min(TILE_SAMPLES / samples)
    }

    /// Returns the tiles of a picture, row by row.
    fn all(width: u32, height: u32, samples: u32) -> impl Iterator<Item = Self> {
        let side = Self::side(samples);
        let lefts = move || (0..width).step_by(side as usize);
        (0..height).step_by(side as usize).flat_map(move |top| {
            lefts().map(move |left| Self { left, top, width: side.min(width - left), height: side.min(height - top) })
        })
    }
}
