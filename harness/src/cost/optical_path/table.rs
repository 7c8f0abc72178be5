//! The ladder as text.

use super::frames::{SLOW, SLOW_ROUNDS};
use super::views::{BLACK, DEEPEST};
use super::{FINEST, OpticalPathReport, PathTiming, RungReport, VIEWS};
use crate::render::Stage;
use std::fmt::Write as _;

/// Where there is no figure.
pub(super) const NONE: &str = "-";

pub(super) fn text(report: &OpticalPathReport) -> String {
    let mut text = format!("{}\n", report.adapter);
    errors(&mut text, report);
    times(&mut text, report);
    let [width, height] = report.frame;
    let _ = writeln!(
        text,
        "\nnats, luminance: root mean squares of the errors of cost, and of e to the minus cost, over the pixels where the true cost is below \
         {DEEPEST}\nnats; black counts as {BLACK}. ball: from the closed form. bunny, dragon: from {FINEST}. walks: luminance from the committed \
         picture by\nrandom walks, of its root mean square, after the best exposure; of the reference, its own standard error.\nms: least of {} \
         interleaved rounds for {width}x{height} pixels of the bunny, one sample a pixel; * over {} s a frame, least of {SLOW_ROUNDS} rounds. \
         grey: one\nextinction for all channels; rgb: three solves. voxels to shade: the grey frame's stages, each submitted and waited for by \
         itself.\nupdates: tiles, or for untiled solvers voxels, taken up; + more were left. memory: maps, voxels, costs and solver, grey. \
         dominated:\nanother rung's grey frame is faster, and errs no more in any view.",
        report.rounds,
        SLOW.as_secs()
    );
    text
}

/// A figure with so many decimals.
pub(super) fn decimals(value: Option<f64>, count: usize) -> String {
    value.map_or(NONE.to_owned(), |value| format!("{value:.count$}"))
}

/// Milliseconds, with a star where the rung had fewer rounds than the others.
pub(super) fn milliseconds(report: &OpticalPathReport, timing: Option<&PathTiming>) -> String {
    timing.map_or(NONE.to_owned(), |timing| {
        format!("{:.1}{}", timing.ms, if timing.rounds < report.rounds { "*" } else { "" })
    })
}

/// Milliseconds of each stage.
pub(super) fn stages(rung: &RungReport) -> [String; Stage::ALL.len()] {
    let times = rung.grey.as_ref().and_then(|timing| timing.stages);
    std::array::from_fn(|stage| decimals(times.map(|times| times[stage]), 1))
}

/// Passes, and what they took up.
pub(super) fn solved(rung: &RungReport) -> [String; 2] {
    rung.solved.map_or([NONE, NONE].map(str::to_owned), |solved| {
        [solved.passes.to_string(), format!("{}{}", solved.updates, if solved.active > 0 { "+" } else { "" })]
    })
}

fn errors(text: &mut String, report: &OpticalPathReport) {
    let _ = write!(text, "{:18}", "rung");
    for view in VIEWS {
        let _ = write!(text, " | {:>11} {:>9} {:>6}", format!("{view}: nats"), "luminance", "walks");
    }
    text.push('\n');
    for rung in &report.rungs {
        let _ = write!(text, "{:18}", rung.rung);
        for view in VIEWS {
            let distance = rung.distance(view);
            let [nats, luminance] = [distance.nats, distance.luminance].map(|error| decimals(error, 4));
            let _ = write!(text, " | {nats:>11} {luminance:>9} {:>6}", decimals(distance.walks, 3));
        }
        text.push_str(if rung.dominated { "  dominated\n" } else { "\n" });
    }
}

fn times(text: &mut String, report: &OpticalPathReport) {
    let _ = write!(text, "\n{:18} {:>9} {:>9} {:>7} {:>9}", "rung", "grey ms", "rgb ms", "passes", "updates");
    for stage in Stage::ALL {
        let _ = write!(text, " {:>8}", stage.name());
    }
    let _ = writeln!(text, " {:>10}", "memory");
    for rung in &report.rungs {
        let [passes, updates] = solved(rung);
        let [grey, rgb] = [&rung.grey, &rung.rgb].map(|timing| milliseconds(report, timing.as_ref()));
        let _ = write!(text, "{:18} {grey:>9} {rgb:>9} {passes:>7} {updates:>9}", rung.rung);
        for time in stages(rung) {
            let _ = write!(text, " {time:>8}");
        }
        let _ = writeln!(text, " {:>10}", rung.bytes);
    }
}
