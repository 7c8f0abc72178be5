//! Minerals whose dispersion is measured.

use lapidary_dispersion::oracle as dispersion;

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
    pub(super) const fn sellmeier(self) -> dispersion::DispersionSellmeier {
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
