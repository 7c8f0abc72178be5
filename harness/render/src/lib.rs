//! A scene to a picture: the rung's recipe over tiles, supersampled, then the display recipe; or the reference.
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

mod camera;
pub mod cdrf;
pub mod compute;
mod deferred;
mod device;
mod diffusion;
mod display;
mod environment;
mod error;
pub mod file;
mod frame;
mod gem;
mod harmonics;
mod light_views;
mod lighting;
mod optical_path;
mod pass;
pub mod pixel;
pub mod plan;
mod record;
mod reflectance;
mod reflective_shadow_map;
pub mod restraint;
pub mod shader;
mod shadows;
pub mod solver;
mod stone;
pub mod texture_diffusion;
mod translucent;
mod variant;
pub mod voxel_grid;
pub mod voxelization;

use deferred::DeferredPass;
use display::DisplayPass;
pub use error::RenderError;
pub use frame::{Frame, FrameTime};
use lapidary_gpu::Gpu;
use lapidary_plan::{Decisions, Effect, Effects, Note, Quality, Request, Rung, Scattering};
use lapidary_reference::random_walk::mesh;
use lapidary_reference::random_walk::mesh::Rendering as Walked;
use lapidary_reference::spectral::{self, Lost, Rendering, Window};
use lapidary_scene::solver::Reflectance;
use lapidary_scene::{Environment, LARGEST_SIDE, SAMPLES, Scene};
use lighting::Lighting;
pub use optical_path::Stage;
use pass::{Before, DEPTH_FORMAT, SAMPLE_FORMAT, ScenePass, SceneTarget};
pub use reflectance::Curvature;
use shadows::Shadows;
use std::borrow::Cow;
use std::sync::Mutex;
pub use stone::geometry_bytes;
pub(crate) use stone::{GemMaterial, GemWavelength, wavelengths};
use variant::Part;
pub(crate) use variant::names as object_names;

/// Largest side of a tile in pixels.
const TILE: u32 = 512;
/// Largest side of a tile in samples: far within every device's texture limit, and 80 MiB of colour and depth.
const TILE_SAMPLES: u32 = 2048;
/// The most samples along each side of a pixel.
pub const MOST_SAMPLES: u32 = 8;

/// Walks from each pixel, where nothing else is asked for.
pub const WALKS: u32 = 256;

/// The share of a body's extinction that light loses along its way, where nothing else is asked for: scattering takes light from the way, but
/// much of it goes on beside it. Fitted to random walks: docs/optical_path_shading.md.
pub const EXTINCTION_SCALE: f32 = 0.18;

/// What to render.
#[derive(Clone, Debug)]
pub struct Settings {
    /// In pixels, 1 to [`LARGEST_SIDE`].
    pub width: u32,
    /// In pixels, 1 to [`LARGEST_SIDE`].
    pub height: u32,
    /// Samples along each side of a pixel, 1 to [`MOST_SAMPLES`].
    pub samples: u32,
    /// How much of the light's way is followed.
    pub rung: Rung,
    /// Where that is each material's own: how much time it may take.
    pub quality: Quality,
    /// The proxy's centre by the paper's eq. (4) instead of the stable form.
    pub paper_centre: bool,
    /// Factor of the paper's eq. (12); 1 as printed.
    pub dispersion_strength: f32,
    /// What is left out though a material calls for it.
    pub without: Effects,
    /// How bodies that scatter light are drawn whatever their thickness, where the rung is each material's own.
    pub scattering: Option<Scattering>,
    /// Whether lights cast shadows on what is drawn by its surface alone.
    pub shadows: bool,
    /// What a ray still carries at the last hit comes from the environment along it; dropped otherwise.
    pub rest_from_environment: bool,
    /// In units of length: a ray ends that has travelled farther inside.
    pub distance_limit: Option<f32>,
    /// A ray inside a stone ends when what it carries can no longer be seen; where nothing is said, by [`restraint::limits_throughput`].
    pub limit_throughput: Option<bool>,
    /// By a geometry buffer and a lighting pass instead of in one.
    pub deferred: bool,
    /// The environment's light is summed for each vertex, not for each pixel.
    pub environment_at_vertices: bool,
    /// Which curvature spreads the light of what scatters it.
    pub curvature: Curvature,
    /// What light loses along its way through a body is this times its extinction and twice that of diffused light.
    pub extinction_scale: f32,
    /// The light around the scene.
    pub environment: Environment,
    /// Radiance is multiplied by this before the tone curve.
    pub exposure: f32,
    /// Wavelengths that the reference follows, from 400 to 700 nm.
    pub wavelengths: usize,
    /// The share of a camera ray's energy that the reference need not follow.
    pub energy_bound: f64,
    /// Walks for each pixel that the reference of what scatters light follows.
    pub walks: u32,
    /// Where those set out.
    pub walks_from: mesh::Origin,
    /// What surfaces do to them.
    pub boundary: mesh::Boundary,
    /// Another seed gives other walks.
    pub seed: u64,
}

impl Settings {
    /// The paper's rung in the studio.
    pub fn of_size(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            samples: SAMPLES,
            rung: Rung::PAPER,
            quality: Quality::default(),
            paper_centre: false,
            dispersion_strength: 1.0,
            without: Effects::NONE,
            scattering: None,
            shadows: false,
            rest_from_environment: true,
            distance_limit: None,
            limit_throughput: None,
            deferred: false,
            environment_at_vertices: true,
            curvature: Curvature::Mean,
            extinction_scale: EXTINCTION_SCALE,
            environment: Environment::Studio,
            exposure: 1.0,
            wavelengths: spectral::WAVELENGTHS,
            energy_bound: spectral::ENERGY_BOUND,
            walks: WALKS,
            walks_from: mesh::Origin::Eye,
            boundary: mesh::Boundary::Matched,
            seed: 1,
        }
    }
}

impl Settings {
    /// What of this a plan is made by.
    #[must_use]
    pub fn request(&self) -> Request<'_> {
        Request {
            size: [self.width, self.height],
            rung: self.rung,
            quality: self.quality,
            without: self.without,
            scattering: self.scattering,
            shadows: self.shadows,
            environment: &self.environment,
            exposure: self.exposure,
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
    /// sRGB, opaque: the mean of the tone-mapped samples, where there are samples.
    pub encoded: Vec<[u8; 4]>,
    /// What the reference of clear stones did not follow; none of another rung.
    pub lost: Option<Lost>,
    /// How good the reference of what scatters light is; none of another rung.
    pub walked: Option<WalkedPicture>,
    /// What is not as it should be.
    pub notes: Vec<Note>,
}

/// How good a picture by random walks is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WalkedPicture {
    /// The root mean square of the pixels' standard errors over the mean brightness, where there is a body.
    pub error: f64,
    /// Samples that met a body.
    pub walks: u64,
    /// Walks that slipped through a surface by rounding, and were followed no further.
    pub lost: u64,
}

/// Renders `scene` with the cookbook's recipe.
pub fn render(gpu: &Gpu, scene: &Scene, settings: &Settings) -> Result<Picture, RenderError> {
    render_reporting(gpu, scene, settings, &mut |_, _| {})
}

/// The same, saying how many of how many steps are done.
pub fn render_reporting(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<Picture, RenderError> {
    render_from(gpu, scene, settings, (None, &lapidary_wgsl::recipe_source(deferred::COMPOSITE)), progress)
}

/// Renders `scene`, and shows its mean radiance in place of its samples': as a committed reference is shown, of which only means are kept. Pictures that
/// are compared as they are seen are both shown alike.
pub fn render_means(gpu: &Gpu, scene: &Scene, settings: &Settings) -> Result<Picture, RenderError> {
    let mut picture = render(gpu, scene, settings)?;
    encode(gpu, settings, &mut picture)?;
    Ok(picture)
}

/// Renders `scene` with another text of the rung's recipe.
pub fn render_with(gpu: &Gpu, scene: &Scene, settings: &Settings, source: &str) -> Result<Picture, RenderError> {
    let composite = lapidary_wgsl::recipe_source(deferred::COMPOSITE);
    render_from(gpu, scene, settings, (Some(source), &composite), &mut |_, _| {})
}

/// The same with both texts: of the rung's recipe, where it is another than the cookbook's, and of the lighting pass.
fn render_from(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    (source, composite): (Option<&str>, &str),
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<Picture, RenderError> {
    let (width, height) = (settings.width, settings.height);
    let largest = LARGEST_SIDE.min(gpu.device.limits().max_texture_dimension_2d);
    if !(1..=largest).contains(&width) || !(1..=largest).contains(&height) {
        return Err(RenderError::Size { width, height, largest });
    }
    if !(1..=MOST_SAMPLES).contains(&settings.samples) {
        return Err(RenderError::Samples(settings.samples));
    }
    let pixels = width as usize * height as usize;
    let (linear, encoded) = (vec![[0.0; 4]; pixels], vec![[0; 4]; pixels]);
    let mut picture = Picture { width, height, linear, encoded, lost: None, walked: None, notes: Vec::new() };
    if settings.rung == Rung::Reference {
        if scatters(scene) {
            let Walked { linear, standard_error, walks, lost, .. } = walk(scene, settings, progress)?;
            picture.walked = Some(WalkedPicture { error: mean_error(&linear, &standard_error), walks, lost });
            picture.linear = linear;
            // A walk's radiance is a guess that is right in the mean alone; a tone curve of guesses would be too dark.
            encode(gpu, settings, &mut picture)?;
        } else {
            follow(gpu, scene, settings, &mut picture, progress)?;
        }
        return Ok(picture);
    }
    let display = DisplayPass::new(gpu, settings.samples, [width, height])?;
    let lighting = Lighting::new(gpu, scene, settings);
    let deferred = settings.deferred.then(|| DeferredPass::new(gpu, &lighting, settings, composite)).transpose()?;
    let pass = scene_pass(gpu, &lighting, scene, settings, source)?;
    let depth = gpu.guarded("allocating a tile", |device| {
        let size = [width, height].map(|side| settings.samples * side.min(Tile::side(settings.samples)));
        device::view(&device::target(device, "depth", size, DEPTH_FORMAT, wgpu::TextureUsages::empty()))
    })?;
    let tiles: Vec<Tile> = Tile::all(width, height, settings.samples).collect();
    for (done, tile) in (1..).zip(&tiles) {
        let clip_from_world = camera::clip_from_world(scene, width, height, *tile);
        let eye = scene.camera.eye;
        let size = [tile.width * settings.samples, tile.height * settings.samples];
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if done == 1 {
            pass.prepare(&mut encoder)?;
        }
        let encoder = gpu.guarded("rendering a tile", |_| {
            if let Some(deferred) = &deferred {
                deferred.draw(&mut encoder, &pass, clip_from_world, eye, display.samples(), size);
            } else {
                let target = SceneTarget { colors: vec![display.samples()], depth: &depth, keep_depth: false, size };
                pass.draw(&mut encoder, &pass.view(clip_from_world, eye), &target);
            }
            encoder
        })?;
        display.finish(encoder, *tile, settings, &mut picture)?;
        progress(done, tiles.len() as u64);
    }
    picture.notes = pass.notes()?;
    Ok(picture)
}

/// Everything that draws the scene's objects, each by its rung; `source` is another text of the recipe where they all have one.
fn scene_pass<'gpu>(
    gpu: &'gpu Gpu,
    lighting: &Lighting<'_>,
    scene: &Scene,
    settings: &Settings,
    source: Option<&str>,
) -> Result<ScenePass<'gpu>, RenderError> {
    let mut all = ScenePass::empty(gpu);
    let parts = Part::all(scene, settings);
    let shadows = Shadows::of(gpu, &scene.lights, &parts)?;
    for part in &parts {
        let composed = || Cow::Owned(lapidary_wgsl::recipe_source(part.rung.recipe()));
        let source = &*source.map_or_else(composed, Cow::Borrowed);
        let deferred = &[deferred::GEOMETRY_FORMAT; deferred::TARGETS][..];
        let forward = &[SAMPLE_FORMAT][..];
        all.append(match part.rung {
            Rung::Diffuse(_) | Rung::OpticalPath(_) if settings.deferred => {
                return Err(RenderError::NotDeferred { object: part.objects[0].object.name.clone(), rung: part.rung });
            }
            Rung::Diffuse(reflectance) => {
                translucent::pass(gpu, (lighting, shadows.as_ref()), part, reflectance, source)?
            }
            Rung::OpticalPath(paths) => optical_path::pass(gpu, lighting, part, paths, source)?,
            _ if settings.deferred => gem::pass(gpu, lighting, part, source, ("gem_deferred_fragment", deferred))?,
            _ => gem::pass(gpu, lighting, part, source, ("gem_fragment", forward))?,
        });
    }
    // What is blurred in a texture is shadowed there: the maps come first.
    all.before.splice(0..0, shadows.map(Before::Shadows));
    Ok(all)
}

/// The overrides of the gem recipes for a scene's first object.
pub fn gem_constants(scene: &Scene, settings: &Settings) -> Vec<(&'static str, f64)> {
    let decisions = scene.objects.first().map(|object| Decisions::of(object, scene, &settings.request()));
    decisions.map_or_else(Vec::new, |decisions| gem::constants(&decisions, decisions.rung, settings))
}

/// The same of the recipe `cdrf_shading`.
pub fn translucent_constants(scene: &Scene, settings: &Settings, reflectance: Reflectance) -> Vec<(&'static str, f64)> {
    let decisions = scene.objects.first().map(|object| Decisions::of(object, scene, &settings.request()));
    decisions.map_or_else(Vec::new, |decisions| translucent::constants(&decisions, settings, reflectance))
}

/// Whether a body of `scene` scatters light.
pub fn scatters(scene: &Scene) -> bool {
    scene.objects.iter().any(|object| object.material.scatters())
}

/// What random walks see of `scene`.
fn walk(
    scene: &Scene,
    settings: &Settings,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<Walked, RenderError> {
    let of_walks = mesh::Settings {
        width: settings.width,
        height: settings.height,
        samples_per_pixel: settings.walks,
        origin: settings.walks_from,
        seed: settings.seed,
        environment: (!settings.without.has(Effect::Environment)).then_some(&settings.environment),
        boundary: settings.boundary,
    };
    Ok(mesh::render(scene, &of_walks, &from_any_thread(progress))?)
}

/// A progress that several threads may tell.
fn from_any_thread(progress: &mut (dyn FnMut(u64, u64) + Send)) -> impl Fn(u64, u64) + Sync {
    let progress = Mutex::new(progress);
    move |done, total| {
        if let Ok(mut progress) = progress.lock() {
            progress(done, total);
        }
    }
}

/// The root mean square of the standard errors of what is covered, over its mean brightness.
fn mean_error(linear: &[[f32; 4]], standard_error: &[[f32; 3]]) -> f64 {
    let covered = || linear.iter().zip(standard_error).filter(|(pixel, _)| pixel[3] > 0.0);
    let squares: f64 = covered().flat_map(|(_, error)| error).map(|error| f64::from(*error).powi(2)).sum();
    let sum: f64 = covered().flat_map(|(pixel, _)| &pixel[..3]).map(|value| f64::from(*value)).sum();
    let count = 3.0 * covered().count() as f64;
    if sum > 0.0 { (squares / count).sqrt() / (sum / count) } else { 0.0 }
}

/// Fills `picture` with what the reference sees of `scene`, by the settings' size, samples and environment. Its samples are shown as a rung's are.
fn follow(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    picture: &mut Picture,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<(), RenderError> {
    if let Some(opaque) = scene.objects.iter().find(|object| !object.material.is_clear()) {
        return Err(RenderError::OpaqueReference { object: opaque.name.clone() });
    }
    let (width, height) = (settings.width, settings.height);
    let display = DisplayPass::new(gpu, settings.samples, [width, height])?;
    let tiles: Vec<Tile> = Tile::all(width, height, settings.samples).collect();
    let rows: u64 = tiles.iter().map(|tile| u64::from(tile.height)).sum();
    let (mut done, mut covered, mut lost) = (0u64, 0.0, Lost::default());
    for tile in tiles {
        let Tile { left, top, width, height } = tile;
        let of_reference = spectral::Settings {
            window: Some(Window { left, top, width, height }),
            samples: settings.samples,
            wavelengths: settings.wavelengths,
            energy_bound: settings.energy_bound,
            environment: &settings.environment,
            ..spectral::Settings::of_size(settings.width, settings.height)
        };
        let mut of_all = |of_tile: u64, _: u64| progress(done + of_tile, rows);
        let (Rendering { linear, lost: of_tile, .. }, samples) =
            spectral::render_samples(scene, &of_reference, &from_any_thread(&mut of_all))?;
        done += u64::from(height);
        display.write(tile, &samples);
        let encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        display.finish(encoder, tile, settings, picture)?;
        // In place of the device's means, which are of f32.
        for (row, means) in (top..).zip(linear.chunks_exact(width as usize)) {
            let start = (row * picture.width + left) as usize;
            picture.linear[start..start + means.len()].copy_from_slice(means);
        }
        let share: f64 = linear.iter().map(|pixel| f64::from(pixel[3])).sum();
        covered += share;
        lost = Lost { max: lost.max.max(of_tile.max), mean: lost.mean + share * of_tile.mean };
    }
    picture.lost = Some(Lost { mean: if covered > 0.0 { lost.mean / covered } else { 0.0 }, ..lost });
    Ok(())
}

/// Fills in `encoded` from `linear`, as the display recipe shows means: of one sample a pixel.
pub fn encode(gpu: &Gpu, settings: &Settings, picture: &mut Picture) -> Result<(), RenderError> {
    let display = DisplayPass::new(gpu, 1, [picture.width, picture.height])?;
    for tile in Tile::all(picture.width, picture.height, 1) {
        let rows = (tile.top..tile.top + tile.height).map(|row| (row * picture.width + tile.left) as usize);
        let means: Vec<[f32; 4]> =
            rows.flat_map(|start| &picture.linear[start..start + tile.width as usize]).copied().collect();
        display.write(tile, &means);
        let encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        display.finish(encoder, tile, settings, picture)?;
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
    /// The largest side in pixels of a tile with so many samples along each side of a pixel.
    fn side(samples: u32) -> u32 {
        TILE.min(TILE_SAMPLES / samples)
    }

    /// The tiles of a picture, row by row.
    fn all(width: u32, height: u32, samples: u32) -> impl Iterator<Item = Self> {
        let side = Self::side(samples);
        let lefts = move || (0..width).step_by(side as usize);
        (0..height).step_by(side as usize).flat_map(move |top| {
            lefts().map(move |left| Self { left, top, width: side.min(width - left), height: side.min(height - top) })
        })
    }
}
