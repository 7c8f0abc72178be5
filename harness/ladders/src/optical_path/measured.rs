//! What a row of the ladder is drawn with.

use lapidary_plan::Rung;
use lapidary_scene::solver::{Method, Paths};

/// The settings that a row of the ladder is drawn with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Measured {
    pub(crate) rung: Rung,
    /// Whether the cost is the full extinction.
    pub(crate) unscaled: bool,
}

impl Measured {
    /// Returns each rung; one with the paper's solver is followed by its unscaled version, which is
    /// the paper's own form.
    pub(super) fn all(rungs: &[Rung]) -> Vec<Self> {
        let is_papers = |rung: Rung| matches!(rung, Rung::OpticalPath(Paths { method: Method::Paper, .. }));
        let versions_of = |&rung: &Rung| {
            let ways = [false, true].into_iter().filter(move |unscaled| !unscaled || is_papers(rung));
            ways.map(move |unscaled| Self { rung, unscaled })
        };
        rungs.iter().flat_map(versions_of).collect()
    }

    pub(super) fn name(self) -> String {
        format!("{}{}", self.rung, if self.unscaled { "-unscaled" } else { "" })
    }
}
