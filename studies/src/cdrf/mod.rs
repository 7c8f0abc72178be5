//! What the reflectance leaves of the distance from random walks: by the law of a half space, by shadows, and for a head.

mod head;
mod law;
mod measure;
pub(crate) mod tables;

pub use measure::measure;

use lapidary_ladders::Ladder;
use lapidary_ladders::cdrf::LADDER as ALONE;

/// The ladder with its studies.
pub const LADDER: Ladder = Ladder { name: ALONE.name, tables: tables::tables, plots: ALONE.plots, whole: ALONE.whole };
