//! The gem ladder: each rung's picture of several stones against the spectral reference, and its
//! time.

mod choices;
mod dispersion;
mod error;
pub mod growth;
mod measure;
mod options;
mod rungs;
mod seen;
mod tables;
pub mod views;

pub use error::Errors;
pub use measure::run;
pub use options::Options;
pub use rungs::{FILLED, MEASURES, RUNGS};
pub use seen::{SAMPLES, change};

use crate::ladder::Ladder;

/// The ladder.
pub const LADDER: Ladder =
    Ladder { name: rungs::NAME, tables: tables::tables, plots: tables::plots, whole: tables::whole };
