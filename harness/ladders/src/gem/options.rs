//! What to measure of the gem ladder.

use super::rungs::RUNGS;
use super::views::{CONCAVE, VIEWS, View};
use lapidary_plan::Rung;

/// What to measure, and how thoroughly.
#[derive(Clone, Debug)]
pub struct Options {
    /// Rounds of timing; 0 skips timing.
    pub rounds: u32,
    /// Width and height of the timed frame in pixels.
    pub frame: [u32; 2],
    /// The views to compare all rungs in.
    pub views: Vec<View>,
    /// Additional views for rungs that draw bodies of any shape.
    pub concave: Vec<View>,
    /// The rungs to measure.
    pub rungs: Vec<Rung>,
}

impl Default for Options {
    fn default() -> Self {
        let rungs = RUNGS.iter().filter_map(|name| name.parse().ok()).collect();
        Self { rounds: 7, frame: [1920, 1080], views: VIEWS.to_vec(), concave: CONCAVE.to_vec(), rungs }
    }
}
