//! The rungs that the qualities choose, as the planner has them, with their figures on two devices.

use super::ladder::{KINDS, Kind};
use crate::cost::{Report, Table};
use lapidary_plan::Quality;
use lapidary_plan::ladder::Ladder;
use serde::Serialize;
use std::collections::BTreeMap;

/// The reports of a GPU, by the ladder's report.
const GPU: [(&str, &str); 4] = [
    ("gem", include_str!("../../../../docs/measurements/nvidia_h200/gem.json")),
    ("cdrf", include_str!("../../../../docs/measurements/nvidia_h200/cdrf.json")),
    ("optical_path", include_str!("../../../../docs/measurements/nvidia_h200/optical_path.json")),
    ("translucent", include_str!("../../../../docs/measurements/nvidia_h200/translucent.json")),
];

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
    /// Mean milliseconds of the views on lavapipe.
    pub ms: String,
    /// The same on a GPU; of a stone, a frame of 1920 by 1080 pixels that it fills.
    pub gpu: String,
    /// Times the time of `fast`.
    pub times: String,
}

/// Returns the choices of every ladder.
pub fn all() -> Vec<Choice> {
    let of_kind = |kind: &'static Kind| {
        let on_gpu = times_on_gpu(kind);
        Quality::ALL.into_iter().filter_map(move |quality| choice(kind, quality, &on_gpu))
    };
    KINDS.iter().flat_map(of_kind).collect()
}

/// Returns the milliseconds that rungs of a ladder take on the GPU; those of a stone are of a frame of 1920 by 1080
/// pixels that it fills.
fn times_on_gpu(kind: &Kind) -> BTreeMap<String, f64> {
    let Some((_, record)) = GPU.iter().find(|(report, _)| *report == kind.report) else { return BTreeMap::new() };
    if kind.report != "gem" {
        let steps = Ladder::of_record(kind.technique, record).map(|ladder| ladder.steps).unwrap_or_default();
        return steps.into_iter().map(|step| (step.rung, step.ms)).collect();
    }
    let report: Report = serde_json::from_str(record).unwrap_or_default();
    let filled = report.rows.into_iter().filter(|row| row.view == "filled" && row.measure == "time");
    filled.filter_map(|row| Some((row.rung, row.ms?))).collect()
}

fn choice(kind: &'static Kind, quality: Quality, on_gpu: &BTreeMap<String, f64>) -> Option<Choice> {
    let ladder = kind.technique.ladder()?;
    let rung = kind.technique.rung(quality).to_string();
    let step = ladder.step(&rung)?;
    let fast = ladder.step(&kind.technique.rung(Quality::Fast).to_string())?;
    Some(Choice {
        ladder: kind.name,
        title: kind.title,
        quality: quality.name(),
        measure: ladder.measure,
        error: format!("{:.2}", step.error),
        ms: format!("{:.1}", step.ms),
        gpu: on_gpu.get(&rung).map_or_else(|| "not measured".to_owned(), |ms| format!("{ms:.1}")),
        times: format!("{:.1}", step.ms / fast.ms),
        rung,
    })
}

/// What the times are of.
pub const NOTE: &str = "The GPU is an NVIDIA H200: stones fill a frame of 1920 × 1080, the others are 512 × 512, one sample a pixel. \
    The CPU runs lavapipe, with stones of 256 × 256 pixels. Errors and those times are means over each ladder's views.";

/// Returns the choices as the table of `docs/choosing.md`.
pub fn table() -> Table {
    Table::of("choices", "", all())
        .column("bodies", |choice| choice.title.to_owned())
        .column("`--quality`", |choice| choice.quality.to_owned())
        .column("rung", |choice| format!("`{}`", choice.rung))
        .column("error", |choice| format!("{} {}", choice.measure, choice.error))
        .column("ms, a GPU", |choice| choice.gpu.clone())
        .column("ms, two CPU cores", |choice| choice.ms.clone())
        .column("× fast", |choice| choice.times.clone())
        .note(NOTE)
}
