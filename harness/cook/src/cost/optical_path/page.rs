//! The ladder's tables for the pages of `docs/`.

use super::frames::{SLOW, SLOW_ROUNDS};
use super::table::{NONE, decimals, milliseconds, solved, stages};
use super::views::BALL;
use super::{
    CELLS, COMPARED, GROWING, LAMBERT_SHADOWED, OpticalPathReport, REFERENCE, RUNGS, RungReport, UNSCALED, USUAL,
    WALKED,
};
use crate::cost::page::{Table, Tables, bytes, header, judged, row};
use crate::cost::quality;
use lapidary_plan::Technique;
use lapidary_render::Stage;
use std::fmt::Write as _;

impl Tables for OpticalPathReport {
    const TABLES: &'static [Table<Self>] = &[
        ("optical_path_ladder", ladder),
        ("optical_path_walks", walks),
        ("optical_path_quality", |report| quality::table(report, &[Technique::OpticalPath])),
        ("optical_path_stages", times),
        ("optical_path_growth", growth),
        ("optical_path_goals", goals),
    ];

    fn whole(&self) -> Result<(), String> {
        let is_timed = |rung: &RungReport| {
            COMPARED.iter().all(|view| rung.grey(view).is_some()) && WALKED.iter().all(|view| rung.rgb(view).is_some())
        };
        let timed = |name: &str| self.rung(name).is_some_and(is_timed);
        match RUNGS.into_iter().chain([UNSCALED]).find(|name| *name != REFERENCE && !timed(name)) {
            Some(name) => {
                Err(format!("the report has no time of `{name}`; only the whole ladder, timed, fills a page"))
            }
            None => Ok(()),
        }
    }
}

fn ladder(report: &OpticalPathReport) -> String {
    let mut columns = vec!["rung".to_owned()];
    columns.extend(COMPARED.iter().flat_map(|view| [format!("{view}: nats, luminance"), "ms".to_owned()]));
    columns.extend(["memory", ""].map(str::to_owned));
    let mut table = header(&columns.iter().map(String::as_str).collect::<Vec<_>>());
    // Random walks have no costs.
    for rung in report.rungs.iter().filter(|rung| rung.rung != REFERENCE) {
        let mut cells = vec![rung.rung.clone()];
        for view in COMPARED {
            let distance = rung.distance(view);
            let figures = distance.nats.zip(distance.luminance);
            cells.push(figures.map_or(NONE.to_owned(), |(nats, luminance)| format!("{nats:.3}, {luminance:.4}")));
            cells.push(milliseconds(report, rung.grey(view)));
        }
        cells.extend([bytes(rung.bytes), if rung.dominated { "dominated" } else { "" }.to_owned()]);
        row(&mut table, &cells);
    }
    note(&mut table, report, "of one extinction for all channels, one sample a pixel");
    table
}

fn walks(report: &OpticalPathReport) -> String {
    let mut columns = vec!["rung".to_owned()];
    columns.extend(WALKED.iter().flat_map(|view| [format!("{view}, from walks"), "ms".to_owned()]));
    let mut table = header(&columns.iter().map(String::as_str).collect::<Vec<_>>());
    for rung in &report.rungs {
        let mut cells = vec![rung.rung.clone()];
        for view in WALKED {
            cells.extend([decimals(rung.distance(view).walks, 3), milliseconds(report, rung.rgb(view))]);
        }
        row(&mut table, &cells);
    }
    note(&mut table, report, "in the colours that `cook plan` gives them, three channels, one sample a pixel");
    table
}

/// Appends a note on what the times are of.
fn note(table: &mut String, report: &OpticalPathReport, what: &str) {
    let [width, height] = report.frame;
    let _ = writeln!(
        table,
        "\nMilliseconds for pictures of {width} × {height} pixels, {what}: the least of {} interleaved rounds, on {}. * over {} s a frame, the least \
         of {SLOW_ROUNDS}.",
        report.rounds,
        report.adapter,
        SLOW.as_secs()
    );
}

fn times(report: &OpticalPathReport) -> String {
    let mut columns = vec!["rung", "passes", "updates"];
    columns.extend(Stage::ALL.map(Stage::name));
    columns.push("frame");
    let mut table = header(&columns);
    for rung in report.rungs.iter().filter(|rung| rung.grey("bunny").is_some()) {
        let mut cells = vec![rung.rung.clone()];
        cells.extend(solved(rung));
        cells.extend(stages(rung));
        cells.push(milliseconds(report, rung.grey("bunny")));
        row(&mut table, &cells);
    }
    note(&mut table, report, "of the bunny with one extinction for all channels");
    table
}

/// Returns the times of the solver and of the whole frame, for a grey frame.
pub(super) fn solve_and_frame(rung: &RungReport) -> Option<[f64; 2]> {
    let timing = rung.grey("bunny")?;
    let solve = Stage::ALL.iter().position(|stage| *stage == Stage::Solve)?;
    Some([timing.stages?[solve], timing.ms])
}

fn growth(report: &OpticalPathReport) -> String {
    let mut columns = vec!["solver: solve, frame, ms".to_owned()];
    columns.extend(CELLS.map(|cells| format!("{cells}³")));
    columns.push("the solve grows with the cells along an edge to the power of".to_owned());
    let mut table = header(&columns.iter().map(String::as_str).collect::<Vec<_>>());
    for solver in GROWING {
        let found = CELLS.map(|cells| report.rung(&format!("{solver}-{cells}")).and_then(solve_and_frame));
        let mut cells = vec![solver.to_owned()];
        cells.extend(
            found.map(|times| times.map_or(NONE.to_owned(), |[solve, frame]| format!("{solve:.1}, {frame:.1}"))),
        );
        let timed: Vec<(u32, [f64; 2])> =
            CELLS.into_iter().zip(found).filter_map(|(cells, times)| Some((cells, times?))).collect();
        // From 64 cells on, because the fixed cost of each pass dominates on smaller grids.
        let power = timed.iter().find(|(cells, _)| *cells == 64).zip(timed.last()).and_then(|(first, last)| {
            let cells = f64::from(last.0) / f64::from(first.0);
            (cells > 1.0).then(|| (last.1[0] / first.1[0]).ln() / cells.ln())
        });
        cells.push(power.map_or(NONE.to_owned(), |power| format!("{power:.1}, from 64")));
        row(&mut table, &cells);
    }
    table
}

fn goals(report: &OpticalPathReport) -> String {
    let mut table = header(&["goal", "measured", ""]);
    for view in ["bunny", "dragon"] {
        if let Some(ms) = report.rung(USUAL).and_then(|rung| Some(rung.rgb(view)?.ms)) {
            let goal = format!(
                "10 frames a second in the colours that `cook plan` gives it, three channels, by `{USUAL}`, {view}"
            );
            judged(&mut table, &goal, format!("{:.1}: {ms:.1} ms", 1000.0 / ms), ms <= 100.0);
        }
    }
    let times = |name: &str| report.rung(name).and_then(solve_and_frame);
    if let Some((slow, fast)) = times("ping-pong-26-128").zip(times("tiled-26-128")) {
        let [solve, frame] = [0, 1].map(|part| slow[part] / fast[part]);
        judged(
            &mut table,
            "a frame by tiles at least 3 times as fast as by ping-pong at 128³, 26 neighbours",
            format!("{frame:.1} times; the solve alone {solve:.1}"),
            frame >= 3.0,
        );
    }
    if let Some(nats) = report.rung(USUAL).and_then(|rung| rung.distance(BALL).nats) {
        judged(
            &mut table,
            &format!("on the ball `{USUAL}` within 0.1 nats, root mean square"),
            format!("{nats:.3}"),
            nats <= 0.1,
        );
    }
    for view in WALKED {
        let goal =
            format!("from random walks `{USUAL}` at most half as far as Lambert's law with shadows cast, {view}");
        let walks = |name: &str| report.rung(name).and_then(|rung| rung.distance(view).walks);
        match walks(USUAL).zip(walks(LAMBERT_SHADOWED)) {
            Some((ways, lambert)) => judged(
                &mut table,
                &goal,
                format!("{ways:.3} and {lambert:.3}: {:.2} times", ways / lambert),
                ways <= 0.5 * lambert,
            ),
            None => row(&mut table, &[goal, "no picture by random walks is committed".to_owned(), "open".to_owned()]),
        }
    }
    table
}
