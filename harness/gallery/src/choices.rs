//! The rungs that the qualities choose, as the planner has them, and those that serve a GPU better, with their figures
//! on two devices.

mod page;
mod sixty;

use super::ladder::{CPU, KINDS, Kind, OnGpu};
use lapidary_plan::ladder::{SAME_TIME, Step};
use lapidary_plan::{Quality, Rung};
pub use page::page;
use serde::Serialize;
use sixty::shown;

/// Label of the rung that errs least among those that the GPU draws faster than that of `fast`.
const ON_A_GPU: &str = "fast, on a GPU";

/// Label of the rung that errs least among those that hold 60 frames a second on the GPU.
pub const IN_A_SIXTIETH: &str = "60 frames a second, on the measured GPU";

/// What the errors of a measure are, in words.
const GLOSSES: [(&str, &str); 3] = [
    ("FLIP", "the visible difference from the spectral reference, from 0 to 1"),
    (
        "distance from walks",
        "the root mean squared difference of linear radiance from random walks, after the best exposure, as a share of theirs",
    ),
    ("nats of error", "the error of the optical depth along the path; one nat is a factor of e in the light"),
];

/// A rung to choose, and what for.
#[derive(Clone, Debug, Serialize)]
pub struct Choice {
    /// Name of the ladder.
    pub ladder: &'static str,
    /// The qualities that choose it, the default's among them, and what else it is for.
    pub qualities: Vec<For>,
    /// Whether it is what one gets without a choice.
    pub is_default: bool,
    /// The rung.
    pub rung: String,
    /// The mean error over the ladder's views.
    pub error: String,
    /// Mean milliseconds of the views on lavapipe.
    pub ms: String,
    /// Milliseconds on the GPU; `None` if the rung was not measured there.
    pub gpu: Option<String>,
    /// What was measured there instead: rungs of the same search with as many hits, or with the same colours.
    pub relatives: Vec<Timed>,
    /// Whether it holds 60 frames a second there, in a word or two; `None` if no such frame was measured.
    pub sixty: Option<String>,
}

impl Choice {
    /// Whether the rung is for what a label says.
    #[must_use]
    pub fn serves(&self, label: &str) -> bool {
        self.qualities.iter().any(|purpose| purpose.name == label)
    }
}

/// What a rung is for.
#[derive(Clone, Debug, Serialize)]
pub struct For {
    /// A quality, or where a rung serves better than a quality's.
    pub name: &'static str,
    /// Whether it is the quality without a choice.
    pub is_default: bool,
}

/// A rung with its time.
#[derive(Clone, Debug, Serialize)]
pub struct Timed {
    /// The rung.
    pub rung: String,
    /// Milliseconds.
    pub ms: String,
}

/// What a ladder's figures are of.
#[derive(Clone, Debug, Serialize)]
pub struct Heading {
    /// What the ladder is of.
    pub title: &'static str,
    /// What the errors are.
    pub measure: &'static str,
    /// The same in words.
    pub gloss: &'static str,
    /// The views over which errors are averaged.
    pub views: Vec<String>,
    /// The GPU.
    pub gpu: String,
    /// The size of the pictures that it drew.
    pub gpu_size: String,
    /// The other device.
    pub cpu: &'static str,
    /// The size of its pictures.
    pub cpu_size: String,
    /// The size of the frames that a stone fills; `None` if the ladder's bodies are no stones.
    pub filled_size: Option<String>,
}

/// Returns the choices of every ladder.
pub fn all() -> Vec<Choice> {
    KINDS.iter().flat_map(of_kind).collect()
}

/// Returns what the figures of a ladder are of.
pub fn heading(kind: &Kind) -> Heading {
    let on_gpu = OnGpu::of(kind);
    let (_, views) = kind.measured(&on_gpu.report);
    let measure = kind.technique.ladder().map_or("", |ladder| ladder.measure);
    Heading {
        title: kind.title,
        measure,
        gloss: gloss(measure),
        views: views.iter().map(|view| (*view).to_owned()).collect(),
        gpu: on_gpu.name(),
        gpu_size: on_gpu.size(kind),
        cpu: CPU,
        cpu_size: kind.size(&on_gpu.report),
        filled_size: sixty::is_of_stones(kind).then(|| on_gpu.report.size()),
    }
}

/// Returns a ladder's choices by error, the greatest first: a rung for each quality, equal ones together, what is
/// better on the GPU, and what holds 60 frames a second there if no quality chooses it.
fn of_kind(kind: &'static Kind) -> Vec<Choice> {
    let Some(ladder) = kind.technique.ladder() else { return Vec::new() };
    let on_gpu = OnGpu::of(kind);
    let mut chosen: Vec<(Rung, Vec<Quality>)> = Vec::new();
    for quality in Quality::ALL {
        let rung = kind.technique.rung(quality);
        match chosen.iter_mut().find(|(other, _)| *other == rung) {
            Some((_, qualities)) => qualities.push(quality),
            None => chosen.push((rung, vec![quality])),
        }
    }
    let choice = |rung: Rung, qualities: Vec<For>| {
        let name = rung.to_string();
        let step = ladder.step(&name)?;
        let gpu = on_gpu.ms(&name).map(shown);
        Some(Choice {
            ladder: kind.name,
            is_default: qualities.iter().any(|purpose| purpose.is_default),
            qualities,
            error: format!("{:.2}", step.error),
            ms: shown(step.ms),
            relatives: if gpu.is_none() { on_gpu.relatives(rung).map(timed).collect() } else { Vec::new() },
            gpu,
            sixty: sixty::holds(kind, &name),
            rung: name,
        })
    };
    let purpose_of = |quality: &Quality| For { name: quality.name(), is_default: *quality == Quality::default() };
    let mut choices: Vec<Choice> = chosen
        .iter()
        .filter_map(|(rung, qualities)| choice(*rung, qualities.iter().map(purpose_of).collect()))
        .collect();
    let fast = kind.technique.rung(Quality::Fast);
    for (name, rung) in [(ON_A_GPU, better_on_gpu(kind, on_gpu, fast)), (IN_A_SIXTIETH, sixty::nearest(kind))] {
        let Some(rung) = rung.filter(|rung| chosen.iter().all(|(taken, _)| taken != rung)) else { continue };
        let label = For { name, is_default: false };
        match choices.iter_mut().find(|choice| choice.rung == rung.to_string()) {
            Some(choice) => choice.qualities.push(label),
            None => choices.extend(choice(rung, vec![label])),
        }
    }
    let error = |choice: &Choice| ladder.step(&choice.rung).map_or(0.0, |step| step.error);
    choices.sort_by(|a, b| error(b).total_cmp(&error(a)));
    choices
}

/// Returns the rung nearest to the truth among those that the GPU draws faster than this one; `None` if this one is.
fn better_on_gpu(kind: &Kind, on_gpu: &OnGpu, rung: Rung) -> Option<Rung> {
    let (name, ladder) = (rung.to_string(), kind.technique.ladder()?);
    let (most, error) = (on_gpu.ms(&name)?, ladder.step(&name)?.error);
    let nearer = |other: &&Step| {
        let is_faster = on_gpu.ms(&other.rung).is_some_and(|ms| (1.0 + SAME_TIME) * ms < most);
        is_faster && other.error < error
    };
    let nearest = ladder.steps.iter().filter(nearer).min_by(|a, b| a.error.total_cmp(&b.error))?;
    nearest.rung.parse().ok()
}

fn gloss(measure: &str) -> &'static str {
    GLOSSES.iter().find(|(glossed, _)| *glossed == measure).map_or("", |(_, gloss)| gloss)
}

fn timed((rung, ms): &(String, f64)) -> Timed {
    Timed { rung: rung.clone(), ms: shown(*ms) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn each_quality_of_each_ladder_is_in_one_choice_and_each_rung_too() {
        let all = all();
        for kind in &KINDS {
            let choices: Vec<&Choice> = all.iter().filter(|choice| choice.ladder == kind.name).collect();
            let rungs: BTreeSet<&str> = choices.iter().map(|choice| choice.rung.as_str()).collect();
            assert_eq!(rungs.len(), choices.len(), "{}: a rung stands there twice", kind.name);
            for quality in Quality::ALL {
                let rung = kind.technique.rung(quality).to_string();
                let choice = choices.iter().find(|choice| choice.rung == rung).expect("the quality's rung");
                assert!(choice.qualities.iter().any(|purpose| purpose.name == quality.name()), "{choice:?}");
                assert!(quality != Quality::default() || choice.is_default, "{choice:?}");
            }
            assert_eq!(choices.iter().filter(|choice| choice.is_default).count(), 1, "{}", kind.name);
        }
    }

    #[test]
    fn what_is_better_on_the_gpu_stands_below_fast() {
        let all = all();
        let names_of = |choice: &Choice| choice.qualities.iter().map(|purpose| purpose.name).collect::<Vec<_>>();
        let below = |pair: &[Choice]| {
            let [name] = names_of(&pair[1])[..] else { return None };
            let other = [ON_A_GPU, IN_A_SIXTIETH].contains(&name);
            other.then(|| (names_of(&pair[0]), pair[0].rung.clone(), name, pair[1].rung.clone()))
        };
        let found: Vec<_> = all.windows(2).filter_map(below).collect();
        let expected = [("walk-4", IN_A_SIXTIETH, "walk-8"), ("godunov-32", ON_A_GPU, "diffusion-32")];
        assert_eq!(found, expected.map(|(above, name, rung)| (vec!["fast"], above.to_owned(), name, rung.to_owned())));
    }

    #[test]
    fn both_devices_measured_the_same_views_at_the_same_size() {
        for kind in &KINDS {
            let (on_gpu, report) = (OnGpu::of(kind), kind.report().expect("committed"));
            assert_eq!(kind.measured(&on_gpu.report), kind.measured(&report), "{}", kind.name);
            let heading = heading(kind);
            assert!(!heading.gloss.is_empty() && !heading.gpu.is_empty() && !heading.views.is_empty(), "{heading:?}");
        }
    }

    #[test]
    fn what_the_gpu_did_not_draw_is_in_no_frame_of_its_record_and_names_what_is() {
        for choice in all().iter().filter(|choice| choice.gpu.is_none()) {
            let kind = Kind::named(choice.ladder).expect("there");
            let rows = &OnGpu::of(kind).report.rows;
            let of_frame = |row: &&lapidary_ladders::Row| row.view == "filled" || kind.report != "gem";
            let drawn = rows.iter().filter(of_frame).find(|row| row.rung == choice.rung && row.ms.is_some());
            assert!(drawn.is_none(), "{choice:?}: {drawn:?}");
            assert!(!choice.relatives.is_empty(), "{choice:?}");
        }
    }
}
