//! What restraint saves: work that is skipped because a pixel or a tile does not need it, compared
//! with doing all of it.

mod limit;
mod measure;
mod rungs;
mod tables;
mod tiles;
mod variants;

pub use limit::facets;
pub use measure::run;
pub use rungs::{RUNGS, SCENES, options};

use lapidary_ladders::Ladder;

/// The study.
pub const LADDER: Ladder =
    Ladder { name: rungs::NAME, tables: tables::tables, plots: |_| Vec::new(), whole: tables::whole };
