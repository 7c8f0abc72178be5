//! Scattering media and their density distributions.

use glam::{UVec3, Vec3};
use lapidary_veins::{self as veins, VeinsPattern};
use std::sync::Arc;

/// A scattering medium. Coefficients are those at density 1, per unit of length, for red, green and
/// blue, at least 0 and finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Medium {
    /// Scattering coefficient. If `anisotropy` is 0, it is the reduced one, corrected for forward
    /// scattering by similarity theory.
    pub scattering: Vec3,
    /// Absorption coefficient.
    pub absorption: Vec3,
    /// Mean cosine of a scattering event, g of Henyey and Greenstein, with magnitude at most
    /// [`MOST_ANISOTROPY`](Self::MOST_ANISOTROPY); 0 for isotropic scattering.
    pub anisotropy: f32,
    /// Density, by which the coefficients are multiplied.
    pub density: Density,
}

/// Spatial distribution of density.
#[derive(Debug, Clone, PartialEq)]
pub enum Density {
    /// 1 everywhere.
    Uniform,
    /// Veined stone, in world space.
    Veins(VeinsPattern),
    /// Measured or simulated densities on a grid.
    Grid(Arc<DensityGrid>),
}

/// Densities at the centres of a box's cells, linearly interpolated between them; beyond the
/// outermost centres the nearest counts.
#[derive(Debug, Clone, PartialEq)]
pub struct DensityGrid {
    least: Vec3,
    greatest: Vec3,
    size: UVec3,
    /// Densities, x fastest, z slowest.
    densities: Vec<f32>,
    least_density: f32,
    most: f32,
}

impl DensityGrid {
    /// Returns a grid of `size` cells over the box from `least` to `greatest`; x varies fastest, z
    /// slowest. `None` if the box is empty or not finite, the number of densities does not match,
    /// or a density is negative or not finite.
    #[must_use]
    pub fn new(least: Vec3, greatest: Vec3, size: UVec3, densities: Vec<f32>) -> Option<Self> {
        let count = size.as_u64vec3().element_product();
        let sound = (least.is_finite() && greatest.is_finite() && least.cmplt(greatest).all())
            && (count > 0 && count == densities.len() as u64)
            && densities.iter().all(|density| density.is_finite() && *density >= 0.0);
        let most = densities.iter().fold(0.0, |most: f32, density| most.max(*density));
        let least_density = densities.iter().fold(f32::MAX, |least: f32, density| least.min(*density));
        sound.then_some(Self { least, greatest, size, densities, least_density, most })
    }

    /// Returns the box's smallest and largest coordinates.
    #[must_use]
    pub fn bounds(&self) -> [Vec3; 2] {
        [self.least, self.greatest]
    }

    /// Returns the number of cells along each axis.
    #[must_use]
    pub fn size(&self) -> UVec3 {
        self.size
    }

    /// Returns the density of each cell, x fastest, z slowest.
    #[must_use]
    pub fn densities(&self) -> &[f32] {
        &self.densities
    }

    fn at(&self, position: Vec3) -> f32 {
        let cells = self.size.as_vec3();
        let place = (position - self.least) / (self.greatest - self.least) * cells - 0.5;
        let place = place.clamp(Vec3::ZERO, cells - 1.0);
        let lower = place.floor();
        let (weight, lower) = (place - lower, lower.as_uvec3());
        let upper = (lower + 1).min(self.size - 1);
        let cell = |x: u32, y: u32, z: u32| {
            self.densities[((z as usize * self.size.y as usize) + y as usize) * self.size.x as usize + x as usize]
        };
        let along_x = |y: u32, z: u32| cell(lower.x, y, z) * (1.0 - weight.x) + cell(upper.x, y, z) * weight.x;
        let along_y = |z: u32| along_x(lower.y, z) * (1.0 - weight.y) + along_x(upper.y, z) * weight.y;
        along_y(lower.z) * (1.0 - weight.z) + along_y(upper.z) * weight.z
    }
}

impl Density {
    /// Returns the density at a point, from 0 to [`most`](Self::most).
    #[must_use]
    pub fn at(&self, position: Vec3) -> f32 {
        let density = match self {
            Self::Uniform => return 1.0,
            Self::Veins(pattern) => veins::density(position, *pattern),
            Self::Grid(grid) => grid.at(position),
        };
        // Interpolation may round past its ends.
        density.min(self.most())
    }

    /// Returns an upper bound of the density.
    #[must_use]
    pub fn most(&self) -> f32 {
        match self {
            Self::Uniform => 1.0,
            Self::Veins(pattern) => pattern.least.max(pattern.greatest),
            Self::Grid(grid) => grid.most,
        }
    }

    /// Returns a lower bound of the density.
    #[must_use]
    pub fn least(&self) -> f32 {
        match self {
            Self::Uniform => 1.0,
            Self::Veins(pattern) => pattern.least.min(pattern.greatest),
            Self::Grid(grid) => grid.least_density,
        }
    }

    fn is_sound(&self) -> bool {
        let Self::Veins(VeinsPattern { frequency, width, least, greatest, octaves, .. }) = *self else {
            return true;
        };
        let is_density = |density: f32| (0.0..=Self::MOST).contains(&density);
        (f32::MIN_POSITIVE..=f32::MAX).contains(&frequency)
            && (veins::VEINS_NARROWEST..=4.0).contains(&width)
            && is_density(least)
            && is_density(greatest)
            && octaves <= veins::VEINS_MOST_OCTAVES
    }

    /// Largest density of veins.
    pub const MOST: f32 = 1000.0;
}

impl Medium {
    /// Largest magnitude of the anisotropy, forwards or backwards.
    pub const MOST_ANISOTROPY: f32 = 0.99;

    /// Largest extinction, per unit of length: three times its square is finite in single
    /// precision.
    pub const MOST_EXTINCTION: f32 = 1e18;

    /// Returns a medium of uniform density that scatters isotropically.
    #[must_use]
    pub const fn isotropic(scattering: Vec3, absorption: Vec3) -> Self {
        Self { scattering, absorption, anisotropy: 0.0, density: Density::Uniform }
    }

    /// Returns the scattering coefficient corrected for forward scattering by similarity theory.
    #[must_use]
    pub fn reduced_scattering(&self) -> Vec3 {
        self.scattering * (1.0 - self.anisotropy)
    }

    /// Returns the sum of reduced scattering and absorption: the reciprocal of the transport mean
    /// free path.
    #[must_use]
    pub fn transport_extinction(&self) -> Vec3 {
        self.reduced_scattering() + self.absorption
    }

    /// Returns which field is invalid and what to do, or `None` if the medium is valid.
    pub(super) fn problem(&self) -> Option<&'static str> {
        let is_length = |length: Vec3| length.is_finite() && length.cmpge(Vec3::ZERO).all();
        if !is_length(self.scattering) || !is_length(self.absorption) {
            Some("its material's scattering or absorption is not finite and at least 0; mend it")
        } else if (self.scattering + self.absorption).max_element() > Self::MOST_EXTINCTION {
            Some("its material's scattering and absorption together are above 1e18; mend them")
        } else if !(-Self::MOST_ANISOTROPY..=Self::MOST_ANISOTROPY).contains(&self.anisotropy) {
            Some("its material's anisotropy is not between -0.99 and 0.99; mend it")
        } else if !self.density.is_sound() {
            Some("its material's veins are out of range; mend them as docs/scene_files.md says")
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(densities: Vec<f32>) -> Option<DensityGrid> {
        DensityGrid::new(Vec3::ZERO, Vec3::new(2.0, 2.0, 4.0), UVec3::new(2, 1, 2), densities)
    }

    #[test]
    fn a_grid_is_its_cells_at_their_middles_and_lies_between_them() {
        let density = Density::Grid(Arc::new(grid(vec![1.0, 2.0, 3.0, 8.0]).expect("sound")));
        let sampled = |x: f32, z: f32| density.at(Vec3::new(x, 0.3, z));
        assert_eq!([sampled(0.5, 1.0), sampled(1.5, 1.0), sampled(0.5, 3.0), sampled(1.5, 3.0)], [1.0, 2.0, 3.0, 8.0]);
        assert_eq!([sampled(1.0, 1.0), sampled(0.5, 2.0), sampled(1.0, 2.0)], [1.5, 2.0, 3.5]);
        assert_eq!([sampled(-9.0, -9.0), sampled(9.0, 9.0)], [1.0, 8.0]);
        assert_eq!((density.least(), density.most()), (1.0, 8.0));
    }

    #[test]
    fn a_grid_that_is_none_is_refused() {
        assert!(grid(vec![1.0; 4]).is_some());
        assert!(grid(vec![1.0; 3]).is_none());
        assert!(grid(vec![1.0, f32::NAN, 0.0, 0.0]).is_none() && grid(vec![1.0, -0.1, 0.0, 0.0]).is_none());
        assert!(DensityGrid::new(Vec3::ONE, Vec3::ONE, UVec3::ONE, vec![1.0]).is_none());
        assert!(DensityGrid::new(Vec3::ZERO, Vec3::ONE, UVec3::ZERO, Vec::new()).is_none());
        assert!(DensityGrid::new(Vec3::ZERO, Vec3::INFINITY, UVec3::ONE, vec![1.0]).is_none());
    }

    #[test]
    fn what_a_medium_cannot_be() {
        let good = Medium::isotropic(Vec3::ONE, Vec3::ZERO);
        assert_eq!(good.problem(), None);
        for anisotropy in [f32::NAN, 1.0, -1.0] {
            assert!(Medium { anisotropy, ..good.clone() }.problem().expect("broken").contains("anisotropy"));
        }
        let pattern = VeinsPattern { frequency: 1.0, width: 0.2, least: 0.5, greatest: 2.0, octaves: 3, seed: 1 };
        let with = |pattern| Medium { density: Density::Veins(pattern), ..good.clone() }.problem();
        assert_eq!(with(pattern), None);
        for bad in [
            VeinsPattern { frequency: 0.0, ..pattern },
            VeinsPattern { frequency: f32::INFINITY, ..pattern },
            VeinsPattern { width: 0.0, ..pattern },
            VeinsPattern { least: -0.1, ..pattern },
            VeinsPattern { greatest: f32::NAN, ..pattern },
            VeinsPattern { octaves: 9, ..pattern },
        ] {
            assert!(with(bad).expect("broken").contains("veins"), "{bad:?}");
        }
    }
}
