//! Walks from one end, and where in a picture they start.

use super::walk::Beginnings;
use glam::DVec2;
use rand::RngExt as _;
use rand::rngs::Xoshiro256PlusPlus;

/// Starting point of walks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Origin {
    /// From the eye, with a number of walks for each pixel.
    #[default]
    Eye,
    /// From the lights: less noise for the same time, least in the brightest pixels. Only for the
    /// scene's own lights.
    Lights,
}

impl Origin {
    /// All origins.
    pub const ALL: [Self; 2] = [Self::Eye, Self::Lights];

    /// Returns the usual name in the field.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Eye => "eye",
            Self::Lights => "lights",
        }
    }

    pub(super) fn other(self) -> Self {
        match self {
            Self::Eye => Self::Lights,
            Self::Lights => Self::Eye,
        }
    }
}

/// Walks from one end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pass {
    pub(super) origin: Origin,
    /// Which of them count.
    pub(super) beginnings: Beginnings,
    pub(super) seed: u64,
}

/// Samples a point of the unit square for one of `samples` samples: the largest square number of
/// them get one cell of a grid each, the rest lie anywhere.
pub(super) fn stratum(sample: u64, samples: u64, random: &mut Xoshiro256PlusPlus) -> DVec2 {
    let place = DVec2::new(random.random(), random.random());
    let side = samples.isqrt();
    if sample >= side * side {
        return place;
    }
    (DVec2::new((sample % side) as f64, (sample / side) as f64) + place) / side as f64
}
