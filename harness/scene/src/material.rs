//! What a body is made of, as far as glTF says it, and a little further.

use super::{Medium, Solver};
use glam::Vec3;
use lapidary_dispersion::oracle as dispersion;

/// What a body is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// The material's name, or `default`.
    pub name: String,
    /// Base colour factor, linear RGB, each 0 to 1: what light that crosses the surface is multiplied by.
    pub base_color: Vec3,
    /// Refractive index relative to air at the helium d line, 587.6 nm, from 1 to [`LARGEST_INDEX`](Self::LARGEST_INDEX).
    pub ior: f32,
    /// How the refractive index depends on the wavelength.
    pub dispersion: Dispersion,
    /// What is left of white light after `attenuation_distance` inside, linear RGB, each 0 to 1. A 0, which
    /// glTF allows, has no finite extinction: whoever takes its logarithm clamps it first.
    pub attenuation_color: Vec3,
    /// In world units, above 0 and no subnormal number; infinite where the body absorbs nothing.
    pub attenuation_distance: f32,
    /// The share of the light at the surface that goes straight through it, 0 (opaque) to 1 (clear): `KHR_materials_transmission`.
    pub transmission: f32,
    /// The share that goes through it to all sides alike, 0 to 1: `KHR_materials_diffuse_transmission`.
    pub diffuse_transmission: f32,
    /// What that light is multiplied by, linear RGB, each 0 to 1.
    pub diffuse_transmission_color: Vec3,
    /// Of the body beneath the surface, in world units, at least 0: `KHR_materials_volume`. 0 is a thin wall, without an inside that
    /// would bend or absorb light.
    pub thickness: f32,
    /// Of the surface, 0 (a mirror) to 1, as glTF has it: its square is the width of the microfacets' slopes.
    pub roughness: f32,
    /// Whether both sides of its surface are meant to be seen, as glTF's `doubleSided` has it. Of a solid only one can be.
    pub double_sided: bool,
    /// Of the curvature-dependent reflectance function: the Gaussian's width in radians is this times the curvature. In world units,
    /// for red, green and blue, at least 0 and finite. `None` where the material does not say.
    pub sigma0: Option<Vec3>,
    /// How the inside scatters light; `None` where the material does not say.
    pub medium: Option<Medium>,
    /// By what the body is drawn; `None` where the material does not say. Only a body that scatters light has one.
    pub solver: Option<Solver>,
}

/// How a refractive index depends on the wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Dispersion {
    /// Not at all.
    None,
    /// By glTF's `KHR_materials_dispersion`: 20 / V_d, above 0, with the index at the d line beside it.
    Abbe(f32),
    /// By a measured Sellmeier equation, which gives the index at the d line too: the material's `ior` is then
    /// [`Mineral::index`].
    Sellmeier(Mineral),
}

/// A material whose Sellmeier equation is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mineral {
    /// Diamond (Peter 1923).
    Diamond,
    /// Corundum's ordinary ray: ruby and sapphire (Malitson).
    Corundum,
    /// Quartz's ordinary ray (Ghosh).
    Quartz,
    /// Schott's crown glass N-BK7.
    CrownGlass,
    /// Cubic zirconia (Wood).
    CubicZirconia,
}

impl Mineral {
    /// Every mineral, each once.
    pub const ALL: [Self; 5] = [Self::Diamond, Self::Corundum, Self::Quartz, Self::CrownGlass, Self::CubicZirconia];

    /// What `extras.lapidary.sellmeier` calls it in a glTF file.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Diamond => "diamond",
            Self::Corundum => "corundum",
            Self::Quartz => "quartz",
            Self::CrownGlass => "crown_glass",
            Self::CubicZirconia => "cubic_zirconia",
        }
    }

    /// The mineral with this [`Mineral::name`].
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|mineral| mineral.name() == name)
    }

    /// The refractive index that its Sellmeier equation gives at the helium d line, 587.5618 nm, to five
    /// decimals.
    #[must_use]
    pub const fn index(self) -> f32 {
        match self {
            Self::Diamond => 2.41749,
            Self::Corundum => 1.76817,
            Self::Quartz => 1.54428,
            Self::CrownGlass => 1.51680,
            Self::CubicZirconia => 2.15877,
        }
    }

    /// Its Sellmeier equation.
    const fn sellmeier(self) -> dispersion::DispersionSellmeier {
        match self {
            Self::Diamond => dispersion::DISPERSION_DIAMOND,
            Self::Corundum => dispersion::DISPERSION_CORUNDUM,
            Self::Quartz => dispersion::DISPERSION_QUARTZ,
            Self::CrownGlass => dispersion::DISPERSION_CROWN_GLASS,
            Self::CubicZirconia => dispersion::DISPERSION_CUBIC_ZIRCONIA,
        }
    }

    /// Its Abbe number V_d = (n_d - 1)/(n_F - n_C) by the same equation: what is left of the equation where a
    /// reader knows `KHR_materials_dispersion` alone.
    #[must_use]
    pub const fn abbe_number(self) -> f32 {
        match self {
            Self::Diamond => 55.3,
            Self::Corundum => 72.3,
            Self::Quartz => 69.7,
            Self::CrownGlass => 64.2,
            Self::CubicZirconia => 33.5,
        }
    }
}

impl Material {
    /// glTF's default material: white, opaque, with refractive index 1.5, without dispersion or absorption.
    #[must_use]
    pub fn standard() -> Self {
        Self {
            name: "default".to_owned(),
            base_color: Vec3::ONE,
            ior: 1.5,
            dispersion: Dispersion::None,
            attenuation_color: Vec3::ONE,
            attenuation_distance: f32::INFINITY,
            transmission: 0.0,
            diffuse_transmission: 0.0,
            diffuse_transmission_color: Vec3::ONE,
            thickness: 0.0,
            roughness: 1.0,
            double_sided: false,
            sigma0: None,
            medium: None,
            solver: None,
        }
    }

    /// The formulas are tested up to it; germanium in the infrared has it, and nothing clear to the eye comes near.
    pub const LARGEST_INDEX: f32 = 4.0;

    /// Which of its fields' promises is broken, and what to do; nothing for a sound material.
    #[must_use]
    pub fn problem(&self) -> Option<&'static str> {
        // Written so that NaN breaks every promise.
        let is_color = |color: Vec3| color.to_array().iter().all(|part| (0.0..=1.0).contains(part));
        let is_length = |length: Vec3| length.is_finite() && length.cmpge(Vec3::ZERO).all();
        let disperses = match self.dispersion {
            Dispersion::None => true,
            Dispersion::Abbe(dispersion) => dispersion > 0.0 && dispersion.is_finite(),
            Dispersion::Sellmeier(mineral) => self.ior == mineral.index(),
        };
        if !is_color(self.base_color) {
            Some("its material's base colour has a part outside 0 to 1; mend it")
        } else if !(1.0..=Self::LARGEST_INDEX).contains(&self.ior) {
            Some("its material's refractive index is not between 1 and 4; mend it")
        } else if !disperses {
            Some(
                "its material's dispersion is not finite and above 0, or its refractive index is not the one of \
                 its Sellmeier equation; mend it",
            )
        } else if !is_color(self.attenuation_color) {
            Some("its material's attenuation colour has a part outside 0 to 1; mend it")
        } else if !(f32::MIN_POSITIVE..).contains(&self.attenuation_distance) {
            Some("its material's attenuation distance is not above 0; mend it")
        } else if ![self.transmission, self.diffuse_transmission].iter().all(|share| (0.0..=1.0).contains(share)) {
            Some("its material's transmission is not between 0 and 1; mend it")
        } else if !is_color(self.diffuse_transmission_color) {
            Some("its material's colour of diffuse transmission has a part outside 0 to 1; mend it")
        } else if !(0.0..=f32::MAX).contains(&self.thickness) {
            Some("its material's thickness is not finite and at least 0; mend it")
        } else if !(0.0..=1.0).contains(&self.roughness) {
            Some("its material's roughness is not between 0 and 1; mend it")
        } else if !self.sigma0.is_none_or(is_length) {
            Some("its material's sigma0 is not finite and at least 0; mend it")
        } else if self.solver.is_some() && !self.scatters() {
            Some("its material has a solver, but does not scatter light; remove the solver")
        } else {
            self.medium.as_ref().and_then(Medium::problem)
        }
    }
}

impl Material {
    /// Whether the inside scatters light, by a width or by a medium.
    #[must_use]
    pub fn scatters(&self) -> bool {
        self.sigma0.is_some() || self.medium.is_some()
    }

    /// Whether light goes straight through, unscattered.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        self.transmission > 0.0 && !self.scatters()
    }

    /// Whether light is absorbed on its way through the body.
    #[must_use]
    pub fn absorbs(&self) -> bool {
        self.attenuation_color != Vec3::ONE && self.attenuation_distance.is_finite()
    }

    /// The refractive index at a wavelength in nanometres.
    #[must_use]
    pub fn index_at(&self, wavelength: f64) -> f64 {
        match self.dispersion {
            Dispersion::None => f64::from(self.ior),
            Dispersion::Abbe(abbe) => dispersion::abbe(f64::from(self.ior), f64::from(abbe), wavelength),
            Dispersion::Sellmeier(mineral) => dispersion::sellmeier(mineral.sellmeier(), wavelength),
        }
    }
}

#[cfg(test)]
mod tests;
