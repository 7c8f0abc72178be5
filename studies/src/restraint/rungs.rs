//! The rungs and scenes whose restraint is measured.

use lapidary_ladders::Options;

/// The study's name.
pub(super) const NAME: &str = "restraint";
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
