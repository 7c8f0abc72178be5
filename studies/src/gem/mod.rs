//! What the gem ladder rests on: the proxy at small sizes, time by the number of facets, total reflection by how the
//! proxy's mesh is made, and where a frame's time goes.

mod growth;
mod measure;
mod profile;
pub mod proxy_sizes;
mod reflection;
pub(crate) mod tables;

pub use measure::measure;
pub use profile::profile;

use lapidary_ladders::Ladder;
use lapidary_ladders::gem::LADDER as ALONE;

/// The ladder with its studies.
pub const LADDER: Ladder =
    Ladder { name: ALONE.name, tables: tables::tables, plots: tables::plots, whole: ALONE.whole };
