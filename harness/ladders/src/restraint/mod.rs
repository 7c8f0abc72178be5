//! What restraint saves: work that is skipped because a pixel or a tile does not need it, compared
//! with doing all of it.

mod limit;
mod tables;
mod tiles;
mod variants;

pub use limit::facets;

use super::{CostError, Ladder, Options, Progress, Report};
use lapidary_gpu::Gpu;

/// The ladder.
pub const LADDER: Ladder =
    Ladder { name: "restraint", tables: tables::tables, plots: |_| Vec::new(), whole: tables::whole };
/// The rungs whose rays end once they carry too little light: few hits and many, with each
/// geometry.
pub const RUNGS: [&str; 9] =
    ["proxy-4", "proxy-8", "walk-8", "walk-16", "walk-64", "convex-8", "convex-16", "convex-64", "bvh-16"];
/// The scenes: a stone with total reflection, an absorbing one, and one with few facets.
pub const SCENES: [&str; 3] = ["brilliant", "ruby", "prism"];

/// Returns what to measure by default; there is at least one round.
pub fn options() -> Options {
    Options { rounds: 5, frame: [480, 270], rungs: RUNGS.iter().filter_map(|name| name.parse().ok()).collect() }
}

/// Measures all kinds of restraint. A rung's name is followed by the way of work; values are
/// differences from the result without restraint, and amounts of work.
///
/// # Errors
///
/// Returns an error if a scene cannot be made or if the device fails.
pub fn run(gpu: &Gpu, options: &Options, progress: Progress<'_>) -> Result<Report, CostError> {
    let [width, height] = options.frame;
    let settings = [("width", width), ("height", height), ("rounds", options.rounds)];
    let mut report = Report::new(LADDER.name, gpu.describe(), &settings.map(|(name, value)| (name, value.into())));
    limit::measure(gpu, options, &mut report, progress)?;
    tiles::measure(gpu, options.rounds, &mut report, &mut |done, total| progress("solving by tiles", done, total))?;
    variants::measure(gpu, options, &mut report, &mut |done, total| progress("drawing stones", done, total))?;
    Ok(report)
}
