//! What a user asks for of a picture, as far as decisions depend on it.

use crate::{Effects, Outside, Quality, Rung};
use lapidary_scene::{Environment, Object};

/// A technique that the user forces for all scattering bodies, whatever their thickness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scattering {
    /// Scattering near the surface, by its curvature.
    Cdrf,
    /// Light paths through the body.
    OpticalPath,
    /// Diffusion through the body.
    Diffusion,
}

/// The settings of a picture that decisions depend on.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The rung that draws the objects; `ByMaterial` chooses one for each.
    pub rung: Rung,
    /// Objects with a rung of their own, by name.
    pub rungs: &'a [(String, Rung)],
    /// Time that a technique may take; used only for objects whose rung is `ByMaterial`.
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
    /// Whether facets' edges inside clear stones are smoothed from one sample per pixel.
    pub footprint: bool,
    /// What light that leaves a clear stone meets; `None` lets the quality decide.
    pub outside: Option<Outside>,
    /// The light around the scene.
    pub environment: &'a Environment,
    /// Factor applied to radiance before the tone curve.
    pub exposure: f32,
}

impl Request<'_> {
    /// Returns a request for `size` in pixels that chooses a rung for each material, in the studio.
    #[must_use]
    pub fn of_size(size: [u32; 2]) -> Self {
        Self {
            size,
            rung: Rung::ByMaterial,
            rungs: &[],
            quality: Quality::default(),
            without: Effects::NONE,
            scattering: None,
            shadows: false,
            half_space: false,
            lights: false,
            footprint: false,
            outside: None,
            environment: &Environment::Studio,
            exposure: 1.0,
        }
    }

    /// Returns the rung that is asked for an object.
    #[must_use]
    pub fn rung_of(&self, object: &Object) -> Rung {
        self.rungs.iter().find(|(name, _)| *name == object.name).map_or(self.rung, |(_, rung)| *rung)
    }
}
