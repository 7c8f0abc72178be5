//! What a body is made of, as far as glTF says it, and a little further.

use glam::Vec3;

/// What a body is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// The material's name, or `default`.
    pub name: String,
    /// Base colour factor, linear RGB, each 0 to 1: what light that crosses the surface is multiplied by.
    pub base_color: Vec3,
    /// Refractive index relative to air at the helium d line, 587.6 nm, at least 1.
    pub ior: f32,
    /// How the refractive index depends on the wavelength.
    pub dispersion: Dispersion,
    /// What is left of white light after `attenuation_distance` inside, linear RGB, each above 0 and at most 1.
    pub attenuation_color: Vec3,
    /// In world units, above 0; infinite where the body absorbs nothing.
    pub attenuation_distance: f32,
}

/// How a refractive index depends on the wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Dispersion {
    /// Not at all.
    None,
    /// By glTF's `KHR_materials_dispersion`: 20 / V_d, above 0, with the index at the d line beside it.
    Abbe(f32),
    /// By a measured Sellmeier equation, which gives the index at the d line too.
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

impl Material {
    /// glTF's default material: white, with refractive index 1.5, without dispersion or absorption.
    #[must_use]
    pub fn standard() -> Self {
        Self {
            name: "default".to_owned(),
            base_color: Vec3::ONE,
            ior: 1.5,
            dispersion: Dispersion::None,
            attenuation_color: Vec3::ONE,
            attenuation_distance: f32::INFINITY,
        }
    }
}

impl Material {
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
            Dispersion::Abbe(dispersion) => {
                lapidary_dispersion::oracle::abbe(f64::from(self.ior), f64::from(dispersion), wavelength)
            }
            Dispersion::Sellmeier(mineral) => lapidary_dispersion::oracle::sellmeier(mineral.sellmeier(), wavelength),
        }
    }
}
