//! `--quality`: a rung for each technique, chosen from its ladder.

use super::ladder::Ladder;
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
}

/// The rungs of each technique by quality, in the order of [`Quality::ALL`]. A better quality has
/// the same rung as the one before it if nothing more expensive cuts the error by a tenth.
const RUNGS: [(Technique, [Rung; 3]); 8] = [
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
    pub const ALL: [Self; 8] = [
        Self::Convex,
        Self::Concave,
        Self::Cdrf,
        Self::Translucent,
        Self::OpticalPath,
        Self::Diffusion,
        Self::Opaque,
        Self::ThinWall,
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
        }
    }

    /// Returns the technique's rung for a quality.
    #[must_use]
    pub fn rung(self, quality: Quality) -> Rung {
        RUNGS[self as usize].1[quality as usize]
    }

    /// Returns the committed ladder; `None` for a technique with a single rung.
    #[must_use]
    pub fn ladder(self) -> Option<&'static Ladder> {
        Ladder::committed(self)
    }
}

/// A rung chosen by technique and quality.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chosen {
    /// Technique of the body.
    pub technique: Technique,
    /// Requested quality.
    pub quality: Quality,
}

impl Chosen {
    /// Returns the rung that the quality selects.
    #[must_use]
    pub fn rung(self) -> Rung {
        self.technique.rung(self.quality)
    }

    /// Returns the rung's error in its committed ladder, and its time as a multiple of the time of
    /// [`Quality::Fast`]. `None` if the ladder lacks either rung, or there is no ladder.
    #[must_use]
    pub fn measured(self) -> Option<Measured> {
        let ladder = self.technique.ladder()?;
        let step = |quality| ladder.step(&self.technique.rung(quality).to_string());
        let (own, fast) = (step(self.quality)?, step(Quality::Fast)?);
        Some(Measured { error: own.error, worst: own.worst, measure: ladder.measure, times_fast: own.ms / fast.ms })
    }
}

/// Error and relative cost of a chosen rung.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Mean error over the ladder's views.
    pub error: f64,
    /// Largest error of any view.
    pub worst: f64,
    /// Name of the error measure.
    pub measure: &'static str,
    /// Time as a multiple of the time of [`Quality::Fast`].
    pub times_fast: f64,
}

impl fmt::Display for Chosen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quality, .. } = self;
        let Some(Measured { error, worst, measure, times_fast }) = self.measured() else {
            return write!(f, "quality {quality}: the technique's only rung");
        };
        write!(f, "quality {quality}: {measure} {}", figure(error))?;
        if worst != error {
            write!(f, " in the mean over the ladder's views, {} in the worst", figure(worst))?;
        }
        if *quality == Quality::Fast { Ok(()) } else { write!(f, "; {times_fast:.1} times the time of fast") }
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

    #[test]
    fn a_choice_says_its_error_and_its_time() {
        let chosen = |technique, quality| Chosen { technique, quality }.to_string();
        let good = chosen(Technique::Convex, Quality::Good);
        assert!(good.starts_with("quality good: FLIP 0.") && good.contains(" times the time of fast"), "{good}");
        let fast = chosen(Technique::OpticalPath, Quality::Fast);
        assert!(fast.contains("nats") && !fast.contains("time"), "{fast}");
        assert_eq!(chosen(Technique::Opaque, Quality::Best), "quality best: the technique's only rung");
    }
}
