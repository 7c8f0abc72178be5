//! Materials: those of glTF, with a few extensions.

use super::{Medium, Solver};
use glam::Vec3;
use lapidary_dispersion::{channels, oracle as dispersion};

/// Optical properties of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name of the material, or `default`.
    pub name: String,
    /// Base colour factor, linear RGB, each 0 to 1. Light that crosses the surface is multiplied by
    /// it.
    pub base_color: Vec3,
    /// Refractive index relative to air at the helium d line, 587.6 nm, from 1 to
    /// [`LARGEST_INDEX`](Self::LARGEST_INDEX).
    pub ior: f32,
    /// How the refractive index depends on the wavelength.
    pub dispersion: Dispersion,
    /// Colour of white light after `attenuation_distance` inside, linear RGB, each 0 to 1. A 0,
    /// which glTF allows, has no finite extinction, so code that takes the logarithm must clamp it
    /// first.
    pub attenuation_color: Vec3,
    /// Distance in world units, above 0 and not subnormal; infinite if the body absorbs nothing.
    pub attenuation_distance: f32,
    /// Fraction of the light at the surface that passes straight through it, 0 (opaque) to 1
    /// (clear): `KHR_materials_transmission`.
    pub transmission: f32,
    /// Fraction that passes through it diffusely, 0 to 1: `KHR_materials_diffuse_transmission`.
    pub diffuse_transmission: f32,
    /// Colour that the diffusely transmitted light is multiplied by, linear RGB, each 0 to 1.
    pub diffuse_transmission_color: Vec3,
    /// Thickness of the body beneath the surface, in world units, at least 0:
    /// `KHR_materials_volume`. 0 is a thin wall, without an interior that would refract or absorb
    /// light.
    pub thickness: f32,
    /// Roughness of the surface, 0 (a mirror) to 1, as in glTF: its square is the width of the
    /// distribution of microfacet slopes.
    pub roughness: f32,
    /// Whether both sides of the surface are meant to be seen, as glTF's `doubleSided`. A solid
    /// shows only one.
    pub double_sided: bool,
    /// Width coefficient of the curvature-dependent reflectance function: the Gaussian's width in
    /// radians is this times the curvature. In world units, for red, green and blue, at least 0 and
    /// finite. `None` if the material does not define it.
    pub sigma0: Option<Vec3>,
    /// How the inside scatters light; `None` if the material does not define it.
    pub medium: Option<Medium>,
    /// Technique that draws the body; `None` if the material does not define it. Only a scattering
    /// body has one.
    pub solver: Option<Solver>,
}

/// How a refractive index depends on the wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Dispersion {
    /// No dispersion.
    None,
    /// glTF's `KHR_materials_dispersion`: 20 / V_d, above 0, together with the index at the d line.
    Abbe(f32),
    /// A measured Sellmeier equation, which also gives the index at the d line: the material's
    /// `ior` is then [`Mineral::index`].
    Sellmeier(Mineral),
}

/// A material with a known Sellmeier equation.
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
    /// All minerals, each once.
    pub const ALL: [Self; 5] = [Self::Diamond, Self::Corundum, Self::Quartz, Self::CrownGlass, Self::CubicZirconia];

    /// Returns its name in `extras.lapidary.sellmeier` of a glTF file.
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

    /// Returns the mineral with this [`Mineral::name`], or `None` if there is none.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|mineral| mineral.name() == name)
    }

    /// Returns the refractive index from its Sellmeier equation at the helium d line, 587.5618 nm,
    /// to five decimals.
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

    /// Returns its Sellmeier equation.
    const fn sellmeier(self) -> dispersion::DispersionSellmeier {
        match self {
            Self::Diamond => dispersion::DISPERSION_DIAMOND,
            Self::Corundum => dispersion::DISPERSION_CORUNDUM,
            Self::Quartz => dispersion::DISPERSION_QUARTZ,
            Self::CrownGlass => dispersion::DISPERSION_CROWN_GLASS,
            Self::CubicZirconia => dispersion::DISPERSION_CUBIC_ZIRCONIA,
        }
    }

    /// Returns its Abbe number V_d = (n_d - 1)/(n_F - n_C) from the same equation: the only part of
    /// the equation that reaches a reader that knows just `KHR_materials_dispersion`.
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
    /// Returns glTF's default material: white, opaque, refractive index 1.5, no dispersion or
    /// absorption.
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

    /// Largest refractive index; the formulas are tested up to it. Germanium reaches it in the
    /// infrared, and no visibly clear material comes near.
    pub const LARGEST_INDEX: f32 = 4.0;

    /// Returns which field is invalid and what to do, or `None` if the material is valid.
    #[must_use]
    pub fn problem(&self) -> Option<&'static str> {
        // Written so that NaN fails every check.
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
    /// Whether the inside scatters light, as given by `sigma0` or by a medium.
    #[must_use]
    pub fn scatters(&self) -> bool {
        self.sigma0.is_some() || self.medium.is_some()
    }

    /// Whether light passes straight through, unscattered.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        self.transmission > 0.0 && !self.scatters()
    }

    /// Whether no light enters: neither clear nor scattering.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        !self.is_clear() && !self.scatters()
    }

    /// Whether light is absorbed on its way through the body.
    #[must_use]
    pub fn absorbs(&self) -> bool {
        self.attenuation_color != Vec3::ONE && self.attenuation_distance.is_finite()
    }

    /// Returns the refractive indices at the wavelengths that represent the three channels.
    #[must_use]
    pub fn channel_indices(&self) -> Vec3 {
        channels::of(|wavelength| self.index_at(wavelength))
    }

    /// Returns the refractive index at a wavelength in nanometres.
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
