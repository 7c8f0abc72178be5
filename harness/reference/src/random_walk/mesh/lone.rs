//! One scattering body by itself, as a tracer of other bodies asks for it.

use super::boundary::Boundary;
use super::walk::{Beginnings, Matter, Ray};
use super::{WalkError, matter};
use crate::spectral::Scatterer;
use glam::DVec3;
use lapidary_scene::{Environment, Lacking, Object, Scene};
use rand::rngs::Xoshiro256PlusPlus;
use std::fmt;

/// A body without a boundary, lit by the lights and the environment of its scene as if nothing else were there.
pub struct Lone<'scene>(Matter<'scene>);

impl fmt::Debug for Lone<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Lone")
    }
}

impl<'scene> Lone<'scene> {
    /// Prepares the scattering bodies of a scene, by their numbers.
    ///
    /// # Errors
    /// Returns a [`WalkError`] if light cannot be followed through a body.
    pub fn all(scene: &Scene, environment: Option<&'scene Environment>) -> Result<Vec<Option<Self>>, WalkError> {
        let lone = |object: &Object| {
            let alone = Scene {
                name: scene.name.clone(),
                objects: vec![object.clone()],
                lights: scene.lights.clone(),
                light_radii: scene.light_radii.clone(),
                environment: scene.environment,
                camera: scene.camera,
                lacking: Lacking::default(),
            };
            // Walks from the eye alone miss light that a boundary reflects inside before it scatters.
            matter(&alone, Boundary::Matched, environment).map(Self)
        };
        let scatters = |object: &Object| object.material.scatters();
        scene.objects.iter().map(|object| scatters(object).then(|| lone(object)).transpose()).collect()
    }
}

impl Scatterer for Lone<'_> {
    fn sent(&self, origin: DVec3, direction: DVec3, random: &mut Xoshiro256PlusPlus) -> Option<DVec3> {
        let hit = self.0.enter(origin, direction)?;
        Some(self.0.walk(Ray { position: origin, direction }, hit, Beginnings::All, random).radiance)
    }
}
