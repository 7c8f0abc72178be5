//! Media and their boundaries, besides the coefficients.

use super::super::boundary::Boundary;
use crate::random_walk::isotropic;
use glam::{DVec2, DVec3};
use lapidary_random_walk::oracle;
use lapidary_scene::{Density, Object};
use rand::RngExt as _;
use rand::rngs::Xoshiro256PlusPlus;
use std::f64::consts::{PI, TAU};

/// Properties of a medium besides its coefficients.
#[derive(Clone, Debug)]
pub(super) struct Structure {
    anisotropy: f64,
    pub(super) density: Density,
    /// Least and greatest density.
    pub(super) least: f64,
    pub(super) most: f64,
    /// Refractive index relative to the surroundings of all bodies; 1 if the boundary is matched.
    index: f64,
}

impl Structure {
    /// Returns `None` if the object has no medium.
    pub(super) fn new(object: &Object, boundary: Boundary) -> Option<Self> {
        let medium = object.material.medium.as_ref()?;
        Some(Self {
            anisotropy: medium.anisotropy.into(),
            density: medium.density.clone(),
            least: medium.density.least().into(),
            most: medium.density.most().into(),
            index: match boundary {
                Boundary::Matched => 1.0,
                Boundary::Dielectric => object.material.ior.into(),
            },
        })
    }

    /// Refractive index relative to the surroundings of all bodies.
    pub(super) fn index(&self) -> f64 {
        self.index
    }

    /// Whether light crosses the boundary unchanged.
    pub(super) fn is_matched(&self) -> bool {
        self.index == 1.0
    }

    /// Density divided by the greatest density.
    pub(super) fn share(&self, position: DVec3) -> f64 {
        if self.most > 0.0 { f64::from(self.density.at(position.as_vec3())) / self.most } else { 0.0 }
    }

    /// Samples a direction after a scattering.
    pub(super) fn scattered(&self, direction: DVec3, random: &mut Xoshiro256PlusPlus) -> DVec3 {
        if self.anisotropy == 0.0 {
            return isotropic(random);
        }
        let DVec2 { x: cosine, y: sine } = oracle::deflection(random.random(), self.anisotropy);
        let (across, along) = (TAU * random.random::<f64>()).sin_cos();
        let (a, b) = direction.any_orthonormal_pair();
        (cosine * direction + sine * (along * a + across * b)).normalize()
    }

    /// Phase function for light deflected by an angle of this cosine.
    pub(super) fn phase(&self, cosine: f64) -> f64 {
        if self.anisotropy == 0.0 { 0.25 / PI } else { oracle::phase(cosine, self.anisotropy) }
    }

    /// Refracts or reflects a direction at the boundary, whose `normal` is on the side that it
    /// comes from; returns whether it crosses to the other side.
    pub(super) fn crosses(
        &self,
        direction: &mut DVec3,
        normal: DVec3,
        index: f64,
        random: &mut Xoshiro256PlusPlus,
    ) -> bool {
        if self.is_matched() {
            return true;
        }
        let crossing = oracle::boundary(*direction, normal, index, random.random());
        *direction = crossing.direction.normalize();
        crossing.crosses
    }
}
