//! What is asked of a picture, and the options of each technique that draws it.

use crate::Curvature;
use lapidary_plan::{Effects, Quality, Request, Rung, Scattering};
use lapidary_reference::random_walk::mesh;
use lapidary_reference::spectral;
use lapidary_scene::{Environment, SAMPLES};

/// Walks from each pixel, where nothing else is asked for.
pub const WALKS: u32 = 256;

/// The share of a body's extinction that light loses along its way, where nothing else is asked for: scattering takes light from the way, but
/// much of it goes on beside it. Fitted to random walks: docs/optical_path_shading.md.
pub const EXTINCTION_SCALE: f32 = 0.18;

/// What to render. Bodies of several techniques may stand in one picture, so it carries the options of each.
#[derive(Clone, Debug)]
pub struct Settings {
    /// In pixels, 1 to [`LARGEST_SIDE`](lapidary_scene::LARGEST_SIDE).
    pub width: u32,
    /// In pixels, 1 to [`LARGEST_SIDE`](lapidary_scene::LARGEST_SIDE).
    pub height: u32,
    /// Samples along each side of a pixel, 1 to [`MOST_SAMPLES`](crate::MOST_SAMPLES).
    pub samples: u32,
    /// The light around the scene.
    pub environment: Environment,
    /// Factor on radiance before the tone curve.
    pub exposure: f32,
    /// How bodies are drawn.
    pub rung: Rung,
    /// Where that is each material's own: how much time it may take.
    pub quality: Quality,
    /// What is left out though a material calls for it.
    pub without: Effects,
    /// How scattering bodies are drawn whatever their thickness, where the rung is each material's own.
    pub scattering: Option<Scattering>,
    /// Whether lights cast shadows on what is drawn by its surface alone.
    pub shadows: bool,
    /// Of clear stones.
    pub gem: GemOptions,
    /// Of scattering bodies that are drawn by their curvature.
    pub diffuse: DiffuseOptions,
    /// Of scattering bodies that light comes through.
    pub optical_path: OpticalPathOptions,
    /// Of the reference of clear stones.
    pub reference: ReferenceOptions,
    /// Of the reference of scattering bodies.
    pub walks: WalkOptions,
}

/// Options of the gem recipes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GemOptions {
    /// The proxy's centre by the paper's eq. (4) instead of the stable form.
    pub paper_centre: bool,
    /// Factor of the paper's eq. (12), above 0; 1 as printed.
    pub dispersion_strength: f32,
    /// Whether what a ray still carries at its last hit comes from the environment along it; dropped otherwise.
    pub rest_from_environment: bool,
    /// The longest way of a ray inside, in units of length.
    pub distance_limit: Option<f32>,
    /// Whether a ray inside ends when what it carries can no longer be seen; by
    /// [`limits_throughput`](crate::restraint::limits_throughput) where there is none.
    pub limit_throughput: Option<bool>,
    /// By a geometry buffer and a lighting pass instead of in one.
    pub deferred: bool,
}

impl Default for GemOptions {
    fn default() -> Self {
        Self {
            paper_centre: false,
            dispersion_strength: 1.0,
            rest_from_environment: true,
            distance_limit: None,
            limit_throughput: None,
            deferred: false,
        }
    }
}

/// Options of the recipe `cdrf_shading`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DiffuseOptions {
    /// Which curvature spreads the light.
    pub curvature: Curvature,
    /// Whether the environment's light is summed for each vertex; for each pixel otherwise.
    pub environment_at_vertices: bool,
}

impl Default for DiffuseOptions {
    fn default() -> Self {
        Self { curvature: Curvature::Mean, environment_at_vertices: true }
    }
}

/// Options of the recipe `optical_path_shading`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpticalPathOptions {
    /// What light loses along its way through a body is this times its extinction and twice that of diffused light; above 0.
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
    /// Wavelengths that it follows, from 400 to 700 nm.
    pub wavelengths: usize,
    /// The share of a camera ray's energy that it need not follow.
    pub energy_bound: f64,
}

impl Default for ReferenceOptions {
    fn default() -> Self {
        Self { wavelengths: spectral::WAVELENGTHS, energy_bound: spectral::ENERGY_BOUND }
    }
}

/// Options of the reference of scattering bodies: random walks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WalkOptions {
    /// Walks for each pixel.
    pub walks: u32,
    /// Where they set out.
    pub from: mesh::Origin,
    /// What surfaces do to them.
    pub boundary: mesh::Boundary,
    /// Another seed gives other walks.
    pub seed: u64,
}

impl Default for WalkOptions {
    fn default() -> Self {
        Self { walks: WALKS, from: mesh::Origin::Eye, boundary: mesh::Boundary::Matched, seed: 1 }
    }
}

impl Settings {
    /// The paper's rung in the studio.
    pub fn of_size(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            samples: SAMPLES,
            environment: Environment::Studio,
            exposure: 1.0,
            rung: Rung::PAPER,
            quality: Quality::default(),
            without: Effects::NONE,
            scattering: None,
            shadows: false,
            gem: GemOptions::default(),
            diffuse: DiffuseOptions::default(),
            optical_path: OpticalPathOptions::default(),
            reference: ReferenceOptions::default(),
            walks: WalkOptions::default(),
        }
    }

    /// The part of this that a plan is made by.
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
