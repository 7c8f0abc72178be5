//! `--quality`: a rung for each technique, chosen from its ladder.

pub use super::chosen::{Chosen, Measured};
use crate::{Geometry, Rung, Spectrum};
use lapidary_scene::solver::{Diffusion, Method, Paths, Reflectance, Stencil};
use std::fmt;

/// How much time a body's technique may take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// The cheapest rung that shows the body itself.
    Fast,
    /// More expensive, if the difference is visible.
    #[default]
    Good,
    /// For still pictures.
    Best,
}

impl Quality {
    /// All qualities, from cheap to expensive.
    pub const ALL: [Self; 3] = [Self::Fast, Self::Good, Self::Best];

    /// Returns the name used by `--quality`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Good => "good",
            Self::Best => "best",
        }
    }
}

impl fmt::Display for Quality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A way to draw a body, chosen by its material and shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Technique {
    /// Closed, convex, clear body: rays meet its facets, by a map of them.
    Convex,
    /// Any other clear body: rays meet its triangles through a hierarchy.
    Concave,
    /// Scattering near the surface, by its curvature.
    Cdrf,
    /// Light through a scattering body.
    Translucent,
    /// The same by paths of least cost, on request.
    OpticalPath,
    /// The same by diffusion at any quality, on request.
    Diffusion,
    /// No light inside the body.
    Opaque,
    /// Clear body without an inside.
    ThinWall,
    /// Clear body whose light goes through others, or comes from bodies around it.
    Among,
}

/// The rungs of each technique by quality, in the order of [`Quality::ALL`]. A better quality has
/// the same rung as the one before it if nothing more expensive cuts the error by a tenth.
const RUNGS: [(Technique, [Rung; 3]); 9] = [
    (
        Technique::Convex,
        [
            inside(Geometry::Walk, 4, Spectrum::One),
            inside(Geometry::Walk, 8, Spectrum::Tracker),
            inside(Geometry::Walk, 16, Spectrum::Tracker),
        ],
    ),
    (
        Technique::Concave,
        [
            inside(Geometry::Bvh, 4, Spectrum::Tracker),
            inside(Geometry::Bvh, 8, Spectrum::Tracker),
            inside(Geometry::Bvh, 8, Spectrum::Tracker),
        ],
    ),
    (
        Technique::Cdrf,
        // The drift costs what the cheap closed form costs, and is the nearest to the walks.
        [Rung::Diffuse(Reflectance::Drift); 3],
    ),
    (Technique::Translucent, [paths(32, Method::Godunov), diffusion(64), diffusion(128)]),
    (
        Technique::OpticalPath,
        [paths(32, Method::Tiled(Stencil::Corners)), paths(64, Method::Godunov), paths(128, Method::Godunov)],
    ),
    (Technique::Diffusion, [diffusion(32), diffusion(64), diffusion(128)]),
    (Technique::Opaque, [Rung::Diffuse(Reflectance::Lambert); 3]),
    (Technique::ThinWall, [Rung::Surface; 3]),
    (
        Technique::Among,
        [
            inside(Geometry::Scene, 8, Spectrum::One),
            inside(Geometry::Scene, 16, Spectrum::Separate(3)),
            inside(Geometry::Scene, 32, Spectrum::Separate(3)),
        ],
    ),
];

const fn inside(geometry: Geometry, hits: u32, spectrum: Spectrum) -> Rung {
    Rung::Inside { geometry, hits, spectrum }
}

const fn diffusion(cells: u32) -> Rung {
    Rung::Diffusion(Diffusion::of(cells))
}

const fn paths(cells: u32, method: Method) -> Rung {
    Rung::OpticalPath(Paths { cells, method })
}

impl Technique {
    /// All techniques, those with a ladder first.
    pub const ALL: [Self; 9] = [
        Self::Convex,
        Self::Concave,
        Self::Cdrf,
        Self::Translucent,
        Self::OpticalPath,
        Self::Diffusion,
        Self::Opaque,
        Self::ThinWall,
        Self::Among,
    ];

    /// Returns what it draws, in a few words.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Convex => "clear and convex",
            Self::Concave => "clear, of any shape",
            Self::Cdrf => "scattering near the surface",
            Self::Translucent => "light through a body",
            Self::OpticalPath => "light through a body, by paths",
            Self::Diffusion => "light through a body, by diffusion",
            Self::Opaque => "opaque",
            Self::ThinWall => "thin wall",
            Self::Among => "clear, among other bodies",
        }
    }

    /// Returns the technique's rung for a quality.
    #[must_use]
    pub fn rung(self, quality: Quality) -> Rung {
        RUNGS[self as usize].1[quality as usize]
    }
}

/// Formats an error with two decimals; small errors in scientific notation with one digit.
pub fn figure(error: f64) -> String {
    if error == 0.0 || error >= 0.0095 { format!("{error:.2}") } else { format!("{error:.0e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_each_technique_in_its_place() {
        assert_eq!(RUNGS.map(|(technique, _)| technique), Technique::ALL);
        for (place, technique) in Technique::ALL.into_iter().enumerate() {
            assert_eq!(technique as usize, place);
        }
    }
}
