//! What holds 60 frames a second on the one GPU that was measured.

use super::super::ladder::{KINDS, Kind, OnGpu, SIXTIETH};
use super::{heading, of_kind, shown};
use lapidary_plan::{Geometry, Quality, Rung, Technique};
use serde::Serialize;

/// Which rungs hold it, for the page.
#[derive(Clone, Debug, Serialize)]
pub struct Sixty {
    /// The GPU and its driver.
    adapter: String,
    /// Size of a frame that a stone fills.
    size: String,
    /// Milliseconds that a frame has.
    least: String,
    /// The rungs of stones, by time.
    held: Vec<Held>,
    /// The one nearest to the reference that holds.
    nearest: Held,
    /// The default, if it was measured.
    default: Option<Held>,
    /// The size of scattering bodies' pictures, and the longest mean time of a rung to choose for them.
    small: String,
    longest: String,
}

/// A rung of stones, and whether it holds.
#[derive(Clone, Debug, Serialize)]
struct Held {
    rung: String,
    error: String,
    ms: String,
    any_shape: bool,
    holds: bool,
}

/// Returns the geometry of a rung that searches a stone by map or by hierarchy; `None` for the others.
fn searched(rung: &str) -> Option<Geometry> {
    match rung.parse() {
        Ok(Rung::Inside { geometry: geometry @ (Geometry::Walk | Geometry::Bvh), .. }) => Some(geometry),
        _ => None,
    }
}

/// Returns the rung by map or by hierarchy that errs least among those that hold 60 frames a second where a stone fills
/// the picture; `None` where such frames were not measured, or where even `fast` takes longer.
pub fn nearest(kind: &Kind) -> Option<Rung> {
    let (on_gpu, ladder) = (OnGpu::of(kind), kind.technique.ladder()?);
    let holds = |rung: &str| on_gpu.ms(rung).is_some_and(|ms| ms <= SIXTIETH);
    if !on_gpu.fills || !holds(&kind.technique.rung(Quality::Fast).to_string()) {
        return None;
    }
    let holding = ladder.steps.iter().filter(|step| searched(&step.rung).is_some() && holds(&step.rung));
    holding.min_by(|a, b| a.error.total_cmp(&b.error))?.rung.parse().ok()
}

/// Returns which rungs by map and by hierarchy hold 60 frames a second, with their errors on the same stones.
///
/// # Panics
/// If no rung does, or if the ladder of stones is gone, which a test finds.
pub fn sixty() -> Sixty {
    let stones = KINDS.iter().find(|kind| kind.technique == Technique::Convex).expect("the ladder of convex stones");
    let (on_gpu, ladder) = (OnGpu::of(stones), stones.technique.ladder().expect("a committed ladder"));
    let row = |(rung, ms): &(String, f64)| Some((searched(rung)?, rung.clone(), ladder.step(rung)?.error, *ms));
    let mut rows: Vec<_> = on_gpu.times.iter().filter_map(row).collect();
    rows.sort_by(|a, b| a.3.total_cmp(&b.3));
    let held = |(geometry, rung, error, ms): &(Geometry, String, f64, f64)| Held {
        rung: rung.clone(),
        error: format!("{error:.2}"),
        ms: shown(*ms),
        any_shape: *geometry == Geometry::Bvh,
        holds: *ms <= SIXTIETH,
    };
    let best = nearest(stones).expect("a rung that holds").to_string();
    let nearest = rows.iter().find(|row| row.1 == best).expect("it was timed");
    let default = stones.technique.rung(Quality::default()).to_string();
    let scattering = || KINDS.iter().filter(|kind| kind.report != "gem");
    let longest = |kind: &'static Kind| {
        of_kind(kind).into_iter().filter_map(|choice| OnGpu::of(kind).ms(&choice.rung)).fold(0.0, f64::max)
    };
    Sixty {
        adapter: on_gpu.report.adapter.clone(),
        size: on_gpu.report.size(),
        least: shown(SIXTIETH),
        nearest: held(nearest),
        default: rows.iter().find(|row| row.1 == default).map(held),
        small: scattering().map(|kind| heading(kind).gpu_size).next().unwrap_or_default(),
        longest: shown(scattering().map(longest).fold(0.0, f64::max)),
        held: rows.iter().map(held).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_holds_stands_before_what_does_not_and_the_default_is_among_them() {
        let sixty = sixty();
        let held = &sixty.held;
        assert!(held.iter().any(|of| of.holds) && held.iter().any(|of| !of.holds), "{held:?}");
        assert!(held.is_sorted_by_key(|of| !of.holds), "{held:?}");
        let default = sixty.default.expect("the record has its frame");
        assert!(held.iter().any(|of| of.rung == default.rung) && sixty.nearest.holds, "{default:?}");
    }

    #[test]
    fn scattering_bodies_were_measured_at_one_size() {
        let sizes: Vec<String> =
            KINDS.iter().filter(|kind| kind.report != "gem").map(|kind| heading(kind).gpu_size).collect();
        assert!(sizes.len() > 1 && sizes.iter().all(|size| *size == sizes[0]), "{sizes:?}");
    }
}
