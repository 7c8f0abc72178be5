//! The rungs that the qualities choose, as the planner has them.

use super::ladder::{KINDS, Kind};
use lapidary_plan::Quality;
use serde::Serialize;

/// The rung of a quality.
#[derive(Clone, Debug, Serialize)]
pub struct Choice {
    /// Name of the ladder.
    pub ladder: &'static str,
    /// What the ladder is of.
    pub title: &'static str,
    /// `fast`, `good` or `best`.
    pub quality: &'static str,
    /// The rung.
    pub rung: String,
    /// What the error is.
    pub measure: &'static str,
    /// The mean error over the ladder's views.
    pub error: String,
    /// Milliseconds on the adapter of the record.
    pub ms: String,
    /// Times the time of `fast`.
    pub times: String,
}

/// Returns the choices of every ladder.
pub fn all() -> Vec<Choice> {
    KINDS.iter().flat_map(|kind| Quality::ALL.into_iter().filter_map(|quality| choice(kind, quality))).collect()
}

fn choice(kind: &'static Kind, quality: Quality) -> Option<Choice> {
    let ladder = kind.technique.ladder()?;
    let rung = kind.technique.rung(quality).to_string();
    let step = ladder.step(&rung)?;
    let fast = ladder.step(&kind.technique.rung(Quality::Fast).to_string())?;
    Some(Choice {
        ladder: kind.name,
        title: kind.title,
        quality: quality.name(),
        rung,
        measure: ladder.measure,
        error: format!("{:.2}", step.error),
        ms: format!("{:.1}", step.ms),
        times: format!("{:.1}", step.ms / fast.ms),
    })
}
