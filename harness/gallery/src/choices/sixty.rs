//! What holds 60 frames a second on the one GPU that was measured.

use super::super::ladder::{KINDS, Kind, OnGpu, SIXTIETH};
use super::{heading, of_kind, shown};
use lapidary_plan::{Geometry, Quality, Rung, Technique};
use serde::Serialize;

/// What holds it, for the page.
#[derive(Clone, Debug, Serialize)]
pub struct Sixty {
    /// The GPU and its driver.
    adapter: String,
    /// Size of a frame that a stone fills.
    size: String,
    /// Milliseconds that a frame has.
    least: String,
    /// The rung nearest to the reference that holds.
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
    ms: String,
    holds: bool,
}

/// Whether a ladder is of clear stones, whose frames were measured at the size of a screen.
pub fn is_of_stones(kind: &Kind) -> bool {
    kind.report == "gem"
}

/// Returns the milliseconds of a frame that a brilliant fills; `None` if that was not measured.
fn filled(rung: &str) -> Option<f64> {
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

/// Returns the nearest rung that holds 60 frames a second, and the default beside it.
///
/// # Panics
/// If no rung does, or if the ladder of stones is gone, which a test finds.
pub fn sixty() -> Sixty {
    let stones = KINDS.iter().find(|kind| kind.technique == Technique::Convex).expect("the ladder of convex stones");
    let report = &OnGpu::of(stones).report;
    let held = |rung: Rung| {
        let ms = filled(&rung.to_string())?;
        Some(Held { rung: rung.to_string(), ms: shown(ms), holds: ms <= SIXTIETH })
    };
    let scattering = || KINDS.iter().filter(|kind| !is_of_stones(kind));
    let longest = |kind: &'static Kind| {
        of_kind(kind).into_iter().filter_map(|choice| OnGpu::of(kind).ms(&choice.rung)).fold(0.0, f64::max)
    };
    Sixty {
        adapter: report.adapter.clone(),
        size: report.size(),
        least: shown(SIXTIETH),
        nearest: nearest(stones).and_then(held).expect("a rung that holds"),
        default: held(stones.technique.rung(Quality::default())),
        small: scattering().map(|kind| heading(kind).gpu_size).next().unwrap_or_default(),
        longest: shown(scattering().map(longest).fold(0.0, f64::max)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_holds_and_no_choice_that_errs_less_does() {
        let sixty = sixty();
        assert!(sixty.nearest.holds, "{sixty:?}");
        let stones = Kind::named("convex").expect("there");
        let choices = of_kind(stones);
        let at = choices.iter().position(|choice| choice.rung == sixty.nearest.rung).expect("a row of the table");
        assert_eq!(choices[at].sixty.as_deref(), Some("yes"), "{choices:?}");
        // Rows stand by error, the greatest first.
        assert!(choices[at + 1..].iter().all(|choice| choice.sixty.as_deref() != Some("yes")), "{choices:?}");
        let default = sixty.default.expect("the record has its frame");
        assert!(choices.iter().any(|choice| choice.rung == default.rung && choice.is_default), "{default:?}");
    }

    #[test]
    fn a_screen_was_measured_for_stones_alone() {
        for kind in &KINDS {
            let known: Vec<Option<String>> = of_kind(kind).into_iter().map(|choice| choice.sixty).collect();
            assert_eq!(known.iter().any(Option::is_some), is_of_stones(kind), "{}: {known:?}", kind.name);
            assert_eq!(heading(kind).filled_size.is_some(), is_of_stones(kind), "{}", kind.name);
        }
    }

    #[test]
    fn scattering_bodies_were_measured_at_one_size() {
        let sizes: Vec<String> =
            KINDS.iter().filter(|kind| !is_of_stones(kind)).map(|kind| heading(kind).gpu_size).collect();
        assert!(sizes.len() > 1 && sizes.iter().all(|size| *size == sizes[0]), "{sizes:?}");
    }
}
