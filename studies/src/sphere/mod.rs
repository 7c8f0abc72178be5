//! The translucent sphere: how close the curvature-dependent reflectance comes to random walks, and
//! with which width.

mod fitted;
mod form;
mod measure;
mod names;
mod rule;
mod tables;

pub use form::Form;
pub use measure::{report, run};
pub use names::{ALBEDOS, FORMS, RADII, rung};

use lapidary_ladders::Ladder;
use lapidary_ladders::cdrf::spheres::NAME;

/// The study.
pub const LADDER: Ladder = Ladder { name: NAME, tables: tables::tables, plots: tables::plots, whole: tables::whole };

#[cfg(test)]
mod tests;
