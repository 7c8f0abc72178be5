//! The ladders' plots and tables, in the page's own colours, and the pictures of their rungs, any two of which can be
//! compared.
//!
//! Errors and times are those of the committed ladders ([`lapidary_plan::ladder`]), by which defaults are chosen; a
//! second plot has a GPU's times.

mod error;
mod figures;
mod kind;
mod on_gpu;
mod pictures;
mod plot;
#[cfg(test)]
mod tests;

pub use error::LadderError;
pub use kind::{KINDS, Kind};
pub use on_gpu::{OnGpu, SIXTIETH};
pub use pictures::{LadderPictures, REFERENCE, RungPicture, pictures};
pub use plot::CPU;

use super::templates::{self, Markup};
use figures::figure;
use lapidary_ladders::Report;
use lapidary_plan::Quality;
use lapidary_plan::ladder::{Ladder, Step};
use plot::Plot;
use serde::Serialize;

/// What the template shows of a ladder.
#[derive(Serialize)]
struct Shown<'a> {
    name: &'a str,
    title: &'a str,
    paragraph: &'a str,
    /// What the error axis shows.
    error: &'a str,
    /// By the committed ladder's times, and by those of the GPU.
    plots: Vec<Plot<'a>>,
    /// The report's file, and the command that measures it again.
    report: &'a str,
    rows: Vec<Row<'a>>,
    /// Whether the table has a column of frames that the stone fills.
    filled: bool,
    compare: Option<Compare<'a>>,
}

/// A line of the table.
#[derive(Serialize)]
struct Row<'a> {
    rung: &'a str,
    error: String,
    worst: String,
    ms: String,
    /// Milliseconds of a frame of 1920 by 1080 pixels that the stone fills; empty if that was not measured.
    filled: String,
    /// Milliseconds on the GPU; empty if that was not measured.
    gpu: String,
    qualities: String,
    front: bool,
    paper: bool,
    href: Option<String>,
}

/// The pictures to compare, and which two are shown at first.
#[derive(Serialize)]
struct Compare<'a> {
    scene: &'a str,
    left: String,
    right: String,
    pictures: Vec<Compared<'a>>,
}

#[derive(Serialize)]
struct Compared<'a> {
    picture: &'a RungPicture,
    href: String,
    /// The picture to subtract.
    exact: Option<String>,
    alt: String,
    /// Its error and its time, in words; empty for the reference and what the ladder did not measure.
    figures: String,
    /// The option's text.
    choice: String,
    /// Whether it is on the front, a default, the paper's or the reference.
    chosen: bool,
}

/// Returns a ladder's plot, its table, and the slider between any two of its pictures. `root` leads from the page to
/// the site's folder, and is empty or ends in `/`. Without pictures there is no slider, and points lead nowhere.
///
/// # Errors
/// Returns an error if the committed report is missing or damaged.
pub fn section(kind: &Kind, pictures: &[RungPicture], root: &str) -> Result<Markup, LadderError> {
    let report = kind.report()?;
    Ok(templates::render("ladder.html", Shown::of(kind, &report, pictures, root)))
}

impl<'a> Shown<'a> {
    fn of(kind: &'a Kind, report: &'a Report, pictures: &'a [RungPicture], root: &str) -> Self {
        let steps = kind.steps();
        let href = |rung: &str| {
            let picture = pictures.iter().find(|picture| picture.rung == rung)?;
            Some(format!("{root}{}", picture.file))
        };
        let on_gpu = OnGpu::of(kind);
        let front = kind.ladder().map(Ladder::front).unwrap_or_default();
        let filled = |rung: &str| report.ms(rung, "filled", "time").filter(|_| kind.name == "convex");
        Self {
            name: kind.name,
            title: kind.title,
            paragraph: kind.paragraph,
            error: kind.error,
            plots: plot::plots(kind, report, href),
            report: kind.report,
            filled: steps.iter().any(|step| filled(&step.rung).is_some()),
            rows: steps
                .iter()
                .map(|step| Row {
                    rung: &step.rung,
                    error: figure(step.error),
                    worst: figure(step.worst),
                    ms: format!("{:.1}", step.ms),
                    filled: filled(&step.rung).map_or_else(String::new, |ms| format!("{ms:.0}")),
                    gpu: on_gpu.ms(&step.rung).map_or_else(String::new, |ms| format!("{ms:.1}")),
                    qualities: kind.qualities(&step.rung).join(", "),
                    front: front.iter().any(|other| other.rung == step.rung),
                    paper: kind.is_of_paper(&step.rung),
                    href: href(&step.rung),
                })
                .collect(),
            compare: Compare::of(kind, &steps, pictures, root),
        }
    }
}

impl<'a> Compare<'a> {
    fn of(kind: &'a Kind, steps: &[&Step], pictures: &'a [RungPicture], root: &str) -> Option<Self> {
        let has = |rung: &str| pictures.iter().any(|picture| picture.rung == rung);
        let fast = kind.technique.rung(Quality::Fast).to_string();
        // The paper's rung, if the ladder measured it, beside what is chosen if nothing is asked for.
        let measured = |rung: &str| has(rung) && steps.iter().any(|step| step.rung == rung);
        let paper = kind.paper.iter().map(|rung| (*rung).to_owned()).find(|rung| measured(rung));
        let other = if has(REFERENCE) { REFERENCE.to_owned() } else { fast };
        let left = paper.unwrap_or(other);
        let right = kind.technique.rung(Quality::Good).to_string();
        let pair = [left, right].map(|rung| {
            if has(&rung) { rung } else { pictures.first().map_or_else(String::new, |first| first.rung.clone()) }
        });
        let [left, right] = pair;
        let compared = |picture: &'a RungPicture| {
            let step = steps.iter().find(|step| step.rung == picture.rung);
            let unmeasured = if picture.rung == REFERENCE { "" } else { "not measured in this ladder" };
            let figures = step.map_or_else(
                || unmeasured.to_owned(),
                |step| format!("{} {}, {:.1} ms by {CPU}", kind.error, figure(step.error), step.ms),
            );
            let qualities = kind.qualities(&picture.rung).join(", ");
            Compared {
                picture,
                href: format!("{root}{}", picture.file),
                exact: picture.exact.as_ref().map(|file| format!("{root}{file}")),
                alt: format!("{} drawn by {}", kind.scene(), picture.rung),
                figures,
                choice: if qualities.is_empty() {
                    picture.rung.clone()
                } else {
                    format!("{} ({qualities})", picture.rung)
                },
                chosen: picture.rung == REFERENCE || pictures::is_chosen(kind, &picture.rung),
            }
        };
        let pictures: Vec<Compared<'_>> = pictures.iter().map(compared).collect();
        (!pictures.is_empty()).then(|| Self { scene: kind.scene(), left, right, pictures })
    }
}
