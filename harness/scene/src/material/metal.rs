//! Metals whose reflectance is measured.

use crate::{Material, spectrum};
use glam::{DVec3, Vec3};

mod measured;

use measured::Constants;

/// Roughness of polished metal, chosen by eye: what it reflects is sharp but for its smallest details.
const POLISHED: f32 = 0.1;

/// A metal with known optical constants, or an alloy of such.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Metal {
    /// Fine gold (Johnson and Christy 1972).
    Gold,
    /// Gold of 18 carats, 3N of ISO 8654: 75 % gold, 12.5 % silver, 12.5 % copper.
    YellowGold,
    /// Gold of 18 carats, 5N of ISO 8654: 75 % gold, 4.5 % silver, 20.5 % copper.
    RoseGold,
    /// White gold as it is sold: plated with rhodium (Weaver, Olson and Lynch 1977).
    WhiteGold,
    /// Silver (Johnson and Christy 1972).
    Silver,
    /// Platinum (Tselin and others 2024).
    Platinum,
    /// Copper (Johnson and Christy 1972).
    Copper,
    /// Stainless steel, austenitic, close to 316 (Karlsson and Ribbing 1982).
    Steel,
}

/// Atoms of gold, silver and copper in a gram of an alloy, in proportion, from its shares by weight.
fn atoms(gold: f64, silver: f64, copper: f64) -> [(f64, Constants); 3] {
    let parts = [gold / 196.967, silver / 107.868, copper / 63.546];
    let all: f64 = parts.iter().sum();
    let [gold, silver, copper] = parts.map(|part| part / all);
    [(gold, measured::GOLD), (silver, measured::SILVER), (copper, measured::COPPER)]
}

impl Metal {
    /// All metals, each once.
    pub const ALL: [Self; 8] = [
        Self::Gold,
        Self::YellowGold,
        Self::RoseGold,
        Self::WhiteGold,
        Self::Silver,
        Self::Platinum,
        Self::Copper,
        Self::Steel,
    ];

    /// Returns its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gold => "gold",
            Self::YellowGold => "yellow_gold",
            Self::RoseGold => "rose_gold",
            Self::WhiteGold => "white_gold",
            Self::Silver => "silver",
            Self::Platinum => "platinum",
            Self::Copper => "copper",
            Self::Steel => "steel",
        }
    }

    /// Returns the share of light that a smooth surface reflects, at a wavelength in nm from 400 to 700 and a cosine of
    /// incidence in [0, 1].
    ///
    /// Of the coloured alloys no n and k were found: theirs is the mean over their parts, by the number of atoms.
    #[must_use]
    pub fn reflectance(self, nanometres: f64, cosine: f64) -> f64 {
        let of = |constants: Constants| measured::reflectance(constants, nanometres, cosine);
        let mixed = |parts: [(f64, Constants); 3]| parts.into_iter().map(|(share, part)| share * of(part)).sum();
        match self {
            Self::Gold => of(measured::GOLD),
            Self::YellowGold => mixed(atoms(0.75, 0.125, 0.125)),
            Self::RoseGold => mixed(atoms(0.75, 0.045, 0.205)),
            Self::WhiteGold => of(measured::RHODIUM),
            Self::Silver => of(measured::SILVER),
            Self::Platinum => of(measured::PLATINUM),
            Self::Copper => of(measured::COPPER),
            Self::Steel => of(measured::STEEL),
        }
    }

    /// Returns the colour of daylight reflected at this cosine of incidence, linear RGB. It may leave 0 to 1: no three
    /// primaries have the colour of copper or fine gold.
    #[must_use]
    pub fn reflected(self, cosine: f64) -> DVec3 {
        let reflected = |at: spectrum::Wavelength| at.weights * DVec3::splat(self.reflectance(at.nanometres, cosine));
        spectrum::weights(61).into_iter().map(reflected).sum()
    }

    /// Returns the base colour of the metal: the colour that it reflects head on, each part between 0 and 1.
    #[must_use]
    pub fn base_color(self) -> Vec3 {
        self.reflected(1.0).as_vec3().clamp(Vec3::ZERO, Vec3::ONE)
    }

    /// Returns the material of the polished metal.
    #[must_use]
    pub fn material(self) -> Material {
        Material {
            name: self.name().to_owned(),
            base_color: self.base_color(),
            metallic: 1.0,
            roughness: POLISHED,
            ..Material::standard()
        }
    }
}

#[cfg(test)]
mod tests;
