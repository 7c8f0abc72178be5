//! The ladder of the curvature-dependent reflectance: each rung's error against the convolution and
//! against random walks through spheres, and its time compared with Lambert's law and a blur in
//! texture space.

mod as_drawn;
pub mod error;
mod frames;
mod measure;
mod rungs;
pub mod scenes;
mod shader;
pub mod sphere_fit;
pub mod spheres;
mod tables;

pub use measure::run;
pub use rungs::{CIRCULAR, MEASURES, RUNGS, SCREEN, SPHERICAL, TABLE, VIEWS, options};

use crate::ladder::Ladder;

/// The ladder.
pub const LADDER: Ladder =
    Ladder { name: rungs::NAME, tables: tables::tables, plots: tables::plots, whole: tables::whole };

#[cfg(test)]
mod tests;
