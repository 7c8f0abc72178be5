//! The generated part of `docs/choosing.md`: the choices of every ladder, and what holds 60 frames a second.

use super::super::ladder::{KINDS, Kind, OnGpu, SIXTIETH};
use super::super::templates;
use super::sixty::{filled, is_of_stones, nearest, shown};
use super::{Choice, Heading, all, heading, of_kind};
use lapidary_plan::{Quality, Rung, Technique};
use serde::Serialize;

/// A ladder's choices, for the page.
#[derive(Serialize)]
struct Group {
    heading: Heading,
    choices: Vec<Choice>,
}

/// What holds 60 frames a second.
#[derive(Clone, Debug, Serialize)]
struct Sixty {
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

/// Returns the generated part of `docs/choosing.md`.
pub fn page() -> String {
    #[derive(Serialize)]
    struct Values {
        groups: Vec<Group>,
        sixty: Sixty,
        unmeasured: Vec<Choice>,
    }
    let groups = KINDS.iter().map(|kind| Group { heading: heading(kind), choices: of_kind(kind) }).collect();
    let unmeasured = all().into_iter().filter(|choice| choice.gpu.is_none()).collect();
    templates::render("choices.md", Values { groups, sixty: sixty(), unmeasured }).0 + "\n"
}

/// Returns the nearest rung that holds 60 frames a second, and the default beside it.
///
/// # Panics
/// If no rung does, or if the ladder of stones is gone, which a test finds.
fn sixty() -> Sixty {
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
        let row = choices.iter().position(|choice| choice.rung == sixty.nearest.rung).expect("a row of the table");
        assert_eq!(choices[row].sixty.as_deref(), Some("yes"), "{choices:?}");
        // Rows stand by error, the greatest first.
        assert!(choices[row + 1..].iter().all(|choice| choice.sixty.as_deref() != Some("yes")), "{choices:?}");
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
