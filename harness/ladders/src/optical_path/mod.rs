//! The ladder of optical paths: solver, stencil and grid size. Each rung has errors against a
//! closed form, the finest grid and random walks, and the times of the same pictures.

mod frames;
mod measure;
mod measured;
mod rungs;
mod tables;
mod views;
mod walks;

pub use measure::run;
pub(crate) use measured::Measured;
pub use rungs::{MEASURES, RUNGS, options};
pub(crate) use views::settings;
pub use views::{COMPARED, VIEWS, WALKED};
pub(crate) use walks::Walks;

use crate::ladder::Ladder;

/// The ladder.
pub const LADDER: Ladder =
    Ladder { name: rungs::NAME, tables: tables::tables, plots: tables::plots, whole: tables::whole };

#[cfg(test)]
mod tests;
