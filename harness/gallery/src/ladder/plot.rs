//! A ladder's plots on its page: by the committed times, and by those of the GPU. `lapidary_ladders::plot` draws them,
//! and `assets/ladder.css` gives them the page's colours.

use super::super::templates::Markup;
use super::figures::figure;
use super::kind::Kind;
use super::on_gpu::{OnGpu, SIXTIETH};
use lapidary_ladders::Report;
use lapidary_ladders::plot::{self, Axis, COLORS, Format, GREY, Link, Marker, Point};
use lapidary_plan::Quality;
use lapidary_plan::ladder::{Ladder, Step};
use serde::Serialize;

/// The device of the committed ladders.
pub const CPU: &str = "lavapipe on 2 CPU cores";

/// The drawings for wide columns and for phones: name, width and height, and what there is room for.
const FORMATS: [(&str, [f64; 2], Format); 2] = [
    ("wide", [960.0, 540.0], Format { area: [58.0, 34.0, 946.0, 484.0], labels: true }),
    ("narrow", [380.0, 460.0], Format { area: [42.0, 34.0, 372.0, 402.0], labels: false }),
];

/// The markers by series.
const MARKERS: [Marker; 6] =
    [Marker::Disc, Marker::Square, Marker::Triangle, Marker::Diamond, Marker::Cross, Marker::Tip];

/// The rungs by their times on one device.
#[derive(Serialize)]
pub(super) struct Plot<'a> {
    /// The device in short, and the size of the pictures that it drew.
    device: String,
    size: String,
    /// The device in full.
    adapter: &'a str,
    /// What was timed, and over what is averaged.
    measured: String,
    /// How many rungs there are.
    rungs: usize,
    drawings: Vec<Drawing>,
    /// By number; those without a rung are left out.
    series: Vec<Option<Series>>,
    /// Defaults that another rung beats here, a sentence each.
    beaten: Vec<String>,
    /// Whether the pictures are those that a live page times.
    is_live: bool,
}

/// A drawing for columns of some width.
#[derive(Serialize)]
struct Drawing {
    name: &'static str,
    width: f64,
    height: f64,
    /// Attributes for the script that adds points.
    data: Markup,
    markup: Markup,
}

/// A series of the legend.
#[derive(Serialize)]
struct Series {
    name: &'static str,
    mark: &'static str,
}

/// Returns the plots of a ladder: by the committed times, and by those of the GPU.
pub(super) fn plots<'a>(kind: &Kind, report: &'a Report, href: impl Fn(&str) -> Option<String>) -> Vec<Plot<'a>> {
    let (Some(ladder), on_gpu) = (kind.ladder(), OnGpu::of(kind)) else { return Vec::new() };
    let steps = kind.steps();
    let committed = Plot {
        device: CPU.to_owned(),
        size: kind.size(report),
        adapter: &report.adapter,
        measured: measured(kind, report),
        rungs: steps.len(),
        drawings: drawings(kind, ladder, &steps, None, &href),
        beaten: Vec::new(),
        series: series(kind, &steps),
        is_live: true,
    };
    let there = on_gpu.ladder(ladder);
    let mut steps: Vec<&Step> = steps.into_iter().filter_map(|step| there.step(&step.rung)).collect();
    steps.sort_by(|a, b| a.ms.total_cmp(&b.ms));
    let filled = format!(
        "frames of {} pixels that a brilliant fills, one sample each, the least of {} rounds; errors are those of the other plot",
        on_gpu.report.size(),
        on_gpu.report.setting("rounds")
    );
    let limit = on_gpu.fills.then_some((SIXTIETH, "60 frames a second"));
    let other = Plot {
        device: on_gpu.name(),
        size: on_gpu.size(kind),
        adapter: &on_gpu.report.adapter,
        measured: if on_gpu.fills { filled } else { measured(kind, &on_gpu.report) },
        rungs: steps.len(),
        drawings: drawings(kind, &there, &steps, limit, &href),
        beaten: beaten(kind, &there),
        series: series(kind, &steps),
        is_live: !on_gpu.fills,
    };
    vec![committed, other]
}

/// Draws steps, which come by increasing time, with a line at a limit of the milliseconds.
fn drawings(
    kind: &Kind,
    ladder: &Ladder,
    steps: &[&Step],
    limit: Option<(f64, &'static str)>,
    href: &dyn Fn(&str) -> Option<String>,
) -> Vec<Drawing> {
    let front = ladder.front();
    let is_front = |step: &&&Step| front.iter().any(|other| other.rung == step.rung);
    let best = steps.iter().filter(is_front).map(|step| (step.ms, step.error));
    let mut series = vec![plot::Series { stairs: true, ..plot::Series::line("", GREY, 2, best) }];
    // A series a rung: the keyboard goes to them by time.
    series.extend(steps.iter().map(|step| {
        let index = kind.series_of(&step.rung) % MARKERS.len();
        let points = vec![point(kind, step, is_front(&step), MARKERS[index], href(&step.rung))];
        plot::Series { points, ..plot::Series::line("", COLORS[index], 0, []) }
    }));
    let x = Axis { limit, ..Axis::log("milliseconds a picture") };
    let plot = plot::Plot { file: "", caption: String::new(), x, y: Axis::log(kind.error), series };
    let drawn = |(name, [width, height], format): (&'static str, [f64; 2], Format)| {
        let plot::Drawing { markup, data } = plot.drawing(&format);
        Drawing { name, width, height, data: Markup(data), markup: Markup(markup) }
    };
    FORMATS.map(drawn).into()
}

fn point(kind: &Kind, step: &Step, front: bool, marker: Marker, href: Option<String>) -> Point {
    let rung = step.rung.clone();
    let (qualities, paper) = (kind.qualities(&rung), kind.is_of_paper(&rung));
    let default =
        if qualities.is_empty() { String::new() } else { format!(", default of {}", qualities.join(" and ")) };
    let named = if paper { format!("{rung} (the paper)") } else { rung.clone() };
    let label = match qualities.as_slice() {
        [] if front || paper => named,
        [] => String::new(),
        qualities => format!("{}: {named}", qualities.join(", ")),
    };
    let attributes = vec![("data-rung", rung.clone()), ("data-ladder", kind.name.to_owned())];
    Point {
        at: (step.ms, step.error),
        marker,
        label,
        front,
        chosen: !qualities.is_empty(),
        early: paper,
        title: format!("{rung}: {} {}, {:.1} ms{default}", kind.error, figure(step.error), step.ms),
        link: href.map(|href| Link { href, attributes }),
    }
}

/// Returns the series of the legend.
fn series(kind: &Kind, steps: &[&Step]) -> Vec<Option<Series>> {
    let all = kind.series.iter().zip(MARKERS).enumerate();
    all.map(|(index, ((_, name), marker))| {
        let is_there = steps.iter().any(|step| kind.series_of(&step.rung) == index);
        is_there.then_some(Series { name, mark: marker.path() })
    })
    .collect()
}

/// Says which defaults another rung beats by these times.
fn beaten(kind: &Kind, ladder: &Ladder) -> Vec<String> {
    let sentence_of = |quality: Quality| {
        let step = ladder.step(&kind.technique.rung(quality).to_string())?;
        let better = ladder.steps.iter().filter(|other| other.ms < step.ms && other.error < step.error);
        let best = better.min_by(|a, b| a.error.total_cmp(&b.error))?;
        Some(format!("{} is faster here than {quality}’s {}, and errs less.", best.rung, step.rung))
    };
    Quality::ALL.into_iter().filter_map(sentence_of).collect()
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
