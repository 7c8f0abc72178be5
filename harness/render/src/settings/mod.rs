//! Settings of a picture, and the options of each technique that draws it.

mod surface;

use lapidary_plan::{Effects, Outside, Quality, Request, Rung, Scattering};
use lapidary_reference::random_walk::mesh;
use lapidary_reference::spectral;
use lapidary_scene::{Camera, Environment, SAMPLES};
pub use surface::{Curvature, DiffuseOptions, ShadowForm};

/// Largest number of samples along each side of a pixel.
pub const MOST_SAMPLES: u32 = 8;

/// Default number of walks from each pixel.
pub const WALKS: u32 = 256;

/// Default share of a body's reduced extinction that applies along a light path. Scattering removes
/// light from the path, but much of it continues close to the path. Fitted to random walks:
/// docs/optical_path_shading.md.
pub const EXTINCTION_SCALE: f32 = 0.18;

/// Settings of a picture. Bodies of several techniques may appear in one picture, so the options of
/// each technique are included.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Width in pixels, 1 to [`LARGEST_SIDE`](lapidary_scene::LARGEST_SIDE).
    pub width: u32,
    /// Height in pixels, 1 to [`LARGEST_SIDE`](lapidary_scene::LARGEST_SIDE).
    pub height: u32,
    /// Samples along each side of a pixel, 1 to [`MOST_SAMPLES`].
    pub samples: u32,
    /// The light around the scene.
    pub environment: Environment,
    /// Factor applied to radiance before the tone curve.
    pub exposure: f32,
    /// Whether the displayed picture has the backdrop behind bodies; otherwise it has straight alpha.
    pub backdrop: bool,
    /// Rung that draws the bodies; `ByMaterial` chooses one for each.
    pub rung: Rung,
    /// Bodies with a rung of their own, by name.
    pub rungs: Vec<(String, Rung)>,
    /// Time that a technique may take; used only if `rung` is `ByMaterial`.
    pub quality: Quality,
    /// Effects that are left out even if a material requires them.
    pub without: Effects,
    /// Technique for all scattering bodies, whatever their thickness; used only if `rung` is
    /// `ByMaterial`. `None` lets the material decide.
    pub scattering: Option<Scattering>,
    /// Whether lights cast shadows on bodies that are drawn by their surface alone.
    pub shadows: bool,
    /// Whether scattering bodies follow the law of a half space under a named rung too.
    pub half_space: bool,
    /// Whether clear bodies under a named rung show lights.
    pub lights: bool,
    /// Options for clear stones.
    pub gem: GemOptions,
    /// Options for scattering bodies drawn by their curvature.
    pub diffuse: DiffuseOptions,
    /// Options for scattering bodies that transmit light.
    pub optical_path: OpticalPathOptions,
    /// Options for bodies through which light diffuses.
    pub diffusion: DiffusionOptions,
    /// Options for the reference of clear stones.
    pub reference: ReferenceOptions,
    /// Options for the reference of scattering bodies.
    pub walks: WalkOptions,
}

/// Options of the gem recipes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GemOptions {
    /// Whether the proxy's centre follows the paper's eq. (4) instead of the stable form.
    pub paper_centre: bool,
    /// Factor of the paper's eq. (12), above 0; 1 as printed.
    pub dispersion_strength: f32,
    /// Whether the energy that a ray still carries at its last hit is taken from the environment
    /// along the ray; dropped otherwise.
    pub rest_from_environment: bool,
    /// Whether a ray ends at the first facet where any of it can leave, with all of it.
    pub end_at_first_exit: bool,
    /// Longest path of a ray inside a stone, in units of length; `None` for no limit.
    pub distance_limit: Option<f32>,
    /// Whether a ray inside a stone ends when its contribution can no longer be seen; `None` lets
    /// [`limits_throughput`](crate::restraint::limits_throughput) decide.
    pub limit_throughput: Option<bool>,
    /// Whether to draw with a geometry buffer and a lighting pass instead of in a single pass.
    pub deferred: bool,
    /// Whether each sample takes shares of its neighbours where an edge of a facet, seen through
    /// others, crosses it; not together with `deferred`.
    pub footprint: bool,
    /// What light that leaves a stone meets before the environment; `None` lets the quality decide.
    pub outside: Option<Outside>,
    /// How far bodies of the picture reach behind their front, in units of length, above 0; `None`
    /// derives it from the bodies.
    pub thickness: Option<f32>,
    /// Steps of a ray over the picture, at least 1.
    pub screen_steps: u32,
}

/// Default number of steps of a ray over the picture.
pub const SCREEN_STEPS: u32 = 8;

impl Default for GemOptions {
    fn default() -> Self {
        Self {
            paper_centre: false,
            dispersion_strength: 1.0,
            rest_from_environment: true,
            end_at_first_exit: false,
            distance_limit: None,
            limit_throughput: None,
            deferred: false,
            footprint: false,
            outside: None,
            thickness: None,
            screen_steps: SCREEN_STEPS,
        }
    }
}

/// Options of the recipe `diffusion_solve`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DiffusionOptions {
    /// Least number of multigrid cycles of a frame.
    pub cycles: u32,
    /// Largest number, if more than a thousandth of the equations is left after fewer; no more if it is not above `cycles`.
    pub most_cycles: u32,
    /// Whether a frame begins with the fluence of the one before, instead of with none.
    pub warm: bool,
    /// Whether a frame also measures what is left of the equations, which is then among the picture's notes.
    pub residual: bool,
}

impl Default for DiffusionOptions {
    fn default() -> Self {
        Self { cycles: 2, most_cycles: 8, warm: false, residual: false }
    }
}

/// Options of the recipe `optical_path_shading`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpticalPathOptions {
    /// Scale of the extinction along a path, above 0. The extinction is this scale times the sum of
    /// the body's extinction and twice the extinction of diffused light.
    pub extinction_scale: f32,
}

impl Default for OpticalPathOptions {
    fn default() -> Self {
        Self { extinction_scale: EXTINCTION_SCALE }
    }
}

/// Options of the reference of clear stones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceOptions {
    /// Number of wavelengths followed, from 400 to 700 nm.
    pub wavelengths: usize,
    /// Share of a camera ray's energy that may be left unfollowed.
    pub energy_bound: f64,
}

impl Default for ReferenceOptions {
    fn default() -> Self {
        Self { wavelengths: spectral::WAVELENGTHS, energy_bound: spectral::ENERGY_BOUND }
    }
}

/// Options of the reference of scattering bodies, which uses random walks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WalkOptions {
    /// Number of walks for each pixel.
    pub walks: u32,
    /// Starting point of the walks.
    pub from: mesh::Origin,
    /// Effect of surfaces on the walks.
    pub boundary: mesh::Boundary,
    /// Random seed; another seed gives other walks.
    pub seed: u64,
}

impl Default for WalkOptions {
    fn default() -> Self {
        Self { walks: WALKS, from: mesh::Origin::Eye, boundary: mesh::Boundary::Matched, seed: 1 }
    }
}

impl Settings {
    /// Returns the angle between the rays of neighbouring samples, in radians.
    pub(crate) fn footprint_of(&self, camera: &Camera) -> f32 {
        let rows = (self.height * self.samples) as f32;
        2.0 * (0.5 * camera.vertical_fov).tan() / rows
    }

    /// Returns settings for the paper's rung in the studio, at this size in pixels.
    pub fn of_size(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            samples: SAMPLES,
            environment: Environment::Studio,
            exposure: 1.0,
            backdrop: true,
            rung: Rung::PAPER,
            rungs: Vec::new(),
            quality: Quality::default(),
            without: Effects::NONE,
            scattering: None,
            shadows: false,
            half_space: false,
            lights: false,
            gem: GemOptions::default(),
            diffuse: DiffuseOptions::default(),
            optical_path: OpticalPathOptions::default(),
            diffusion: DiffusionOptions::default(),
            reference: ReferenceOptions::default(),
            walks: WalkOptions::default(),
        }
    }

    /// Returns the part of the settings that a plan depends on.
    #[must_use]
    pub fn request(&self) -> Request<'_> {
        Request {
            size: [self.width, self.height],
            rung: self.rung,
            rungs: &self.rungs,
            quality: self.quality,
            without: self.without,
            scattering: self.scattering,
            shadows: self.shadows,
            half_space: self.half_space,
            lights: self.lights,
            footprint: self.gem.footprint,
            outside: self.gem.outside,
            environment: &self.environment,
            exposure: self.exposure,
        }
    }
}
