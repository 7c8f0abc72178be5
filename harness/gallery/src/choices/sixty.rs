//! What holds 60 frames a second on the one GPU that was measured.

use super::super::ladder::{KINDS, Kind, OnGpu, SIXTIETH};
use lapidary_plan::{Geometry, Quality, Rung};

/// Whether a ladder is of clear stones, whose frames were measured at the size of a screen.
pub fn is_of_stones(kind: &Kind) -> bool {
    kind.report == "gem"
}

/// Returns the milliseconds of a frame that a brilliant fills; `None` if that was not measured.
pub fn filled(rung: &str) -> Option<f64> {
    KINDS.iter().map(OnGpu::of).find(|on_gpu| on_gpu.fills)?.ms(rung)
}

/// Says whether a rung of stones holds 60 frames a second, with the time if the ladder's own is of smaller pictures;
/// `None` if no such frame was measured.
pub fn holds(kind: &Kind, rung: &str) -> Option<String> {
    let ms = filled(rung).filter(|_| is_of_stones(kind))?;
    let word = if ms <= SIXTIETH { "yes" } else { "no" };
    Some(if OnGpu::of(kind).fills { word.to_owned() } else { format!("{word}, {} ms", shown(ms)) })
}

/// Whether a rung searches a stone by map or by hierarchy.
fn is_searched(rung: &str) -> bool {
    matches!(rung.parse(), Ok(Rung::Inside { geometry: Geometry::Walk | Geometry::Bvh, .. }))
}

/// Returns the rung by map or by hierarchy that errs least among those that hold 60 frames a second where a stone fills
/// the picture; `None` where such frames were not measured, or where even `fast` takes longer.
pub fn nearest(kind: &Kind) -> Option<Rung> {
    let (on_gpu, ladder) = (OnGpu::of(kind), kind.technique.ladder()?);
    let holds = |rung: &str| on_gpu.ms(rung).is_some_and(|ms| ms <= SIXTIETH);
    if !on_gpu.fills || !holds(&kind.technique.rung(Quality::Fast).to_string()) {
        return None;
    }
    let holding = ladder.steps.iter().filter(|step| is_searched(&step.rung) && holds(&step.rung));
    holding.min_by(|a, b| a.error.total_cmp(&b.error))?.rung.parse().ok()
}

/// Writes milliseconds.
pub fn shown(ms: f64) -> String {
    format!("{ms:.1}")
}
