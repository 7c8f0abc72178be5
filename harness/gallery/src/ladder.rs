//! The ladders' plots and tables, in the page's own colours, and the pictures of their rungs, any two of which can be
//! compared.
//!
//! Errors and times are those of the committed ladders ([`lapidary_plan::ladder`]), by which defaults are chosen; a
//! second plot has a GPU's times.

mod axis;
mod kind;
mod on_gpu;
mod pictures;
mod plot;
#[cfg(test)]
mod tests;

pub use kind::{KINDS, Kind};
pub use on_gpu::{OnGpu, SIXTIETH};
pub use pictures::{LadderPictures, REFERENCE, RungPicture, pictures};

use super::templates::{self, Markup};
use lapidary_ladders::{CostError, Report};
use lapidary_plan::Quality;
use lapidary_plan::ladder::{Ladder, Step};
use lapidary_render::{RenderError, file::FileError};
use lapidary_snapshots::SnapshotError;
use plot::{Drawing, Point};
use serde::Serialize;
use std::path::PathBuf;

/// The device of the committed ladders.
pub const CPU: &str = "lavapipe on 2 CPU cores";

/// Why the ladders could not be shown.
#[derive(Debug, thiserror::Error)]
pub enum LadderError {
    /// A committed report or reference is missing or damaged.
    #[error(transparent)]
    Cost(#[from] CostError),
    /// A committed reference is damaged.
    #[error(transparent)]
    Reference(#[from] SnapshotError),
    /// A picture could not be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A picture could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A folder could not be made.
    #[error("{}: cannot be made: {error}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The system's error.
        error: std::io::Error,
    },
}

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

/// The rungs by their times on one device.
#[derive(Serialize)]
struct Plot<'a> {
    /// The device in short, and the size of the pictures that it drew.
    device: String,
    size: String,
    /// The device in full.
    adapter: &'a str,
    /// What was timed, and over what is averaged.
    measured: String,
    drawings: Vec<Drawing>,
    /// By number; those without a rung are left out.
    series: Vec<Option<Series>>,
    /// Defaults that another rung beats here, a sentence each.
    beaten: Vec<String>,
    /// Whether the pictures are those that a live page times.
    is_live: bool,
}

/// A series of the legend.
#[derive(Serialize)]
struct Series {
    name: &'static str,
    mark: &'static str,
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
            plots: plots(kind, report, href),
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
                    qualities: qualities(kind, &step.rung).join(", "),
                    front: is_front(&front, step),
                    paper: kind.paper.contains(&step.rung.as_str()),
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
            let qualities = qualities(kind, &picture.rung).join(", ");
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

/// Returns the qualities that choose a rung.
fn qualities(kind: &Kind, rung: &str) -> Vec<&'static str> {
    let chosen = Quality::ALL.into_iter().filter(|quality| kind.technique.rung(*quality).to_string() == rung);
    chosen.map(Quality::name).collect()
}

/// Returns the plots of a ladder: by the committed times, and by those of the GPU.
fn plots<'a>(kind: &Kind, report: &'a Report, href: impl Fn(&str) -> Option<String>) -> Vec<Plot<'a>> {
    let drawings = |ladder: &Ladder, steps: &[&Step], limit: Option<f64>| {
        let front = ladder.front();
        let points: Vec<Point> = steps.iter().map(|step| point(kind, &front, step, href(&step.rung))).collect();
        plot::drawings(&points, limit)
    };
    let series = |steps: &[&Step]| {
        let all = kind.series.iter().zip(plot::MARKS).enumerate();
        all.map(|(at, ((_, name), mark))| {
            let is_there = steps.iter().any(|step| kind.series_of(&step.rung) == at);
            is_there.then_some(Series { name, mark })
        })
        .collect()
    };
    let (Some(ladder), on_gpu) = (kind.ladder(), OnGpu::of(kind)) else { return Vec::new() };
    let committed = Plot {
        device: CPU.to_owned(),
        size: kind.size(report),
        adapter: &report.adapter,
        measured: measured(kind, report),
        drawings: drawings(ladder, &kind.steps(), None),
        beaten: Vec::new(),
        series: series(&kind.steps()),
        is_live: true,
    };
    let there = on_gpu.ladder(ladder);
    let mut steps: Vec<&Step> = kind.steps().into_iter().filter_map(|step| there.step(&step.rung)).collect();
    steps.sort_by(|a, b| a.ms.total_cmp(&b.ms));
    let filled = format!(
        "frames of {} pixels that a brilliant fills, one sample each, the least of {} rounds; errors are those of the other plot",
        on_gpu.report.size(),
        on_gpu.report.setting("rounds")
    );
    let other = Plot {
        device: on_gpu.name(),
        size: on_gpu.size(kind),
        adapter: &on_gpu.report.adapter,
        measured: if on_gpu.fills { filled } else { measured(kind, &on_gpu.report) },
        drawings: drawings(&there, &steps, on_gpu.fills.then_some(SIXTIETH)),
        beaten: beaten(kind, &there),
        series: series(&steps),
        is_live: !on_gpu.fills,
    };
    vec![committed, other]
}

/// Says which defaults another rung beats by these times.
fn beaten(kind: &Kind, ladder: &Ladder) -> Vec<String> {
    let of = |quality: Quality| {
        let step = ladder.step(&kind.technique.rung(quality).to_string())?;
        let better = ladder.steps.iter().filter(|other| other.ms < step.ms && other.error < step.error);
        let best = better.min_by(|a, b| a.error.total_cmp(&b.error))?;
        Some(format!("{} is faster here than {quality}’s {}, and errs less.", best.rung, step.rung))
    };
    Quality::ALL.into_iter().filter_map(of).collect()
}

/// Says what was timed, and over what is averaged.
fn measured(kind: &Kind, report: &Report) -> String {
    let (side, views) = kind.measured(report);
    let (rounds, count) = (report.setting("rounds"), views.len());
    let views = views.join(", ");
    format!(
        "pictures of {side} × {side} pixels, one sample each, the least of {rounds} rounds; means over {count} views: {views}"
    )
}

fn is_front(front: &[&Step], step: &Step) -> bool {
    front.iter().any(|other| other.rung == step.rung)
}

fn point(kind: &Kind, front: &[&Step], step: &Step, href: Option<String>) -> Point {
    let qualities = qualities(kind, &step.rung);
    let default =
        if qualities.is_empty() { String::new() } else { format!(", default of {}", qualities.join(" and ")) };
    Point {
        rung: step.rung.clone(),
        ms: four_digits(step.ms),
        error: four_digits(step.error),
        series: kind.series_of(&step.rung) + 1,
        front: is_front(front, step),
        title: format!("{}: {} {}, {:.1} ms{default}", step.rung, kind.error, figure(step.error), step.ms),
        qualities,
        paper: kind.paper.contains(&step.rung.as_str()),
        href,
    }
}

/// Returns a value with four digits, so that pages stay small.
fn four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Shows an error with three digits.
fn figure(error: f64) -> String {
    if error >= 10.0 {
        format!("{error:.1}")
    } else if error >= 1.0 {
        format!("{error:.2}")
    } else {
        format!("{error:.3}")
    }
}
