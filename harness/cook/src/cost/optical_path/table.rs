//! The ladder as text.

use super::frames::{SLOW, SLOW_ROUNDS};
use super::views::{BLACK, DEEPEST};
use super::{COMPARED, FINEST, OpticalPathReport, PathTiming, RungReport, UNSCALED, WALKED};
use lapidary_render::Stage;
use std::fmt::Write as _;

/// Placeholder for a missing figure.
pub(super) const NONE: &str = "-";

pub(super) fn text(report: &OpticalPathReport) -> String {
    let mut text = format!("{}\n", report.adapter);
    errors(&mut text, report);
    times(&mut text, report);
    let [width, height] = report.frame;
    let _ = writeln!(
        text,
        "\nEvery error stands beside the time of the very picture: {width}x{height} pixels, one sample a pixel; least of {} interleaved rounds, * over \
         {} s a frame, least\nof {SLOW_ROUNDS}. nats, luminance: root mean squares of the errors of cost, and of e to the minus cost, over the pixels where \
         the true cost is below {DEEPEST}\nnats; black counts as {BLACK}. ball: from the closed form. bunny, dragon: from {FINEST}. grey: one extinction for \
         all channels. walks: luminance from\nthe committed picture by random walks, of its root mean square, after the best exposure, four pixels of the \
         timed picture making one of it;\nof the reference, its own standard error. rgb: in the scene's own colours, three solves. {UNSCALED}: the \
         whole extinction for a cost.\nvoxels to shade: the grey bunny's stages, each submitted and waited for by itself. updates: tiles, or for untiled \
         solvers voxels, taken\nup; + more were left. memory: maps, voxels, costs and solver, grey. dominated: another rung's grey bunny is faster, and \
         errs no more in any view.",
        report.rounds,
        SLOW.as_secs()
    );
    text
}

/// Formats a figure with `count` decimals.
pub(super) fn decimals(value: Option<f64>, count: usize) -> String {
    value.map_or(NONE.to_owned(), |value| format!("{value:.count$}"))
}

/// Formats milliseconds, with a star if the rung had fewer rounds than the others.
pub(super) fn milliseconds(report: &OpticalPathReport, timing: Option<&PathTiming>) -> String {
    timing.map_or(NONE.to_owned(), |timing| {
        format!("{:.1}{}", timing.ms, if timing.rounds < report.rounds { "*" } else { "" })
    })
}

/// Formats the milliseconds of each stage.
pub(super) fn stages(rung: &RungReport) -> [String; Stage::ALL.len()] {
    let times = rung.grey("bunny").and_then(|timing| timing.stages);
    std::array::from_fn(|stage| decimals(times.map(|times| times[stage]), 1))
}

/// Formats the number of passes and of updates.
pub(super) fn solved(rung: &RungReport) -> [String; 2] {
    rung.solved.map_or([NONE, NONE].map(str::to_owned), |solved| {
        [solved.passes.to_string(), format!("{}{}", solved.updates, if solved.active > 0 { "+" } else { "" })]
    })
}

fn errors(text: &mut String, report: &OpticalPathReport) {
    let _ = write!(text, "{:18}", "rung");
    for view in COMPARED {
        let _ = write!(text, " | {:>12} {:>9} {:>9}", format!("{view}: nats"), "luminance", "grey ms");
    }
    text.push('\n');
    for rung in &report.rungs {
        let _ = write!(text, "{:18}", rung.rung);
        for view in COMPARED {
            let distance = rung.distance(view);
            let [nats, luminance] = [distance.nats, distance.luminance].map(|error| decimals(error, 4));
            let _ = write!(text, " | {nats:>12} {luminance:>9} {:>9}", milliseconds(report, rung.grey(view)));
        }
        text.push_str(if rung.dominated { "  dominated\n" } else { "\n" });
    }
    let _ = write!(text, "\n{:18}", "rung");
    for view in WALKED {
        let _ = write!(text, " | {:>16} {:>9}", format!("{view}: walks"), "rgb ms");
    }
    text.push('\n');
    for rung in &report.rungs {
        let _ = write!(text, "{:18}", rung.rung);
        for view in WALKED {
            let walks = decimals(rung.distance(view).walks, 3);
            let _ = write!(text, " | {walks:>16} {:>9}", milliseconds(report, rung.rgb(view)));
        }
        text.push('\n');
    }
}

fn times(text: &mut String, report: &OpticalPathReport) {
    let _ = write!(text, "\n{:18} {:>9} {:>7} {:>9}", "bunny, grey", "ms", "passes", "updates");
    for stage in Stage::ALL {
        let _ = write!(text, " {:>8}", stage.name());
    }
    let _ = writeln!(text, " {:>10}", "memory");
    for rung in &report.rungs {
        let [passes, updates] = solved(rung);
        let grey = milliseconds(report, rung.grey("bunny"));
        let _ = write!(text, "{:18} {grey:>9} {passes:>7} {updates:>9}", rung.rung);
        for time in stages(rung) {
            let _ = write!(text, " {time:>8}");
        }
        let _ = writeln!(text, " {:>10}", rung.bytes);
    }
}
