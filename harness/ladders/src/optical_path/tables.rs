//! The tables and plots of the ladder of optical paths.

use super::frames::{SLOW, SLOW_ROUNDS};
use super::rungs::{CELLS, FINEST, GREY, GROWING, LAMBERT_SHADOWED, REFERENCE, RGB, RUNGS, STAGED, UNSCALED, USUAL};
use super::views::{BALL, BLACK, COMPARED, DEEPEST, WALKED};
use crate::plot::{self, Axis, COLORS, Dot, Plot, Series};
use crate::quality;
use crate::report::{Report, dominated};
use crate::table::{Goal, Table, bytes, figure, marked};
use lapidary_plan::Technique;
use lapidary_render::Stage;

/// Checks that a report is the whole ladder, timed.
pub(super) fn whole(report: &Report) -> Result<(), String> {
    let timed = |rung: &str| {
        let has = |view: &&str, kind: &str| report.ms(rung, view, kind).is_some();
        COMPARED.iter().all(|view| has(view, GREY)) && WALKED.iter().all(|view| has(view, RGB))
    };
    match RUNGS.into_iter().chain([UNSCALED]).find(|rung| *rung != REFERENCE && !timed(rung)) {
        Some(rung) => Err(format!("the report has no time of `{rung}`; only the whole ladder, timed, fills a page")),
        None => Ok(()),
    }
}

pub(super) fn tables(report: &Report) -> Vec<Table> {
    vec![
        ladder(report),
        walks(report),
        quality::table("optical_path_quality", report, &[Technique::OpticalPath]),
        stages(report),
        growth(report),
        goals(report),
    ]
}

/// Shows a frame's time, with a star if it had fewer rounds than the others.
fn shown_ms(report: &Report, rung: &str, view: &str, kind: &str) -> String {
    let few = report.row(rung, view, &format!("rounds of {kind}")).is_some();
    report.ms(rung, view, kind).map_or("-".to_owned(), |ms| format!("{ms:.1}{}", if few { "*" } else { "" }))
}

/// Returns the rungs than which another one's grey bunny is faster, and whose costs err no less in
/// any view where both have an error.
fn beaten<'r>(report: &'r Report, rungs: &[&'r str]) -> Vec<&'r str> {
    dominated(rungs, |other, rung| {
        let ms = |rung: &str| report.ms(rung, STAGED, GREY);
        let nats = |rung: &str, view: &str| report.value(rung, view, "nats");
        let errors: Vec<(f64, f64)> =
            COMPARED.iter().filter_map(|view| nats(other, view).zip(nats(rung, view))).collect();
        let faster = ms(other).zip(ms(rung)).is_some_and(|(other, ms)| other < ms);
        faster && !errors.is_empty() && errors.iter().all(|(other, error)| other <= error)
    })
}

/// Says what the times are of.
fn note(report: &Report, what: &str) -> String {
    format!(
        "Milliseconds for pictures of {} pixels, {what}: {}. `*` over {} s a frame, the least of {SLOW_ROUNDS}.",
        report.size(),
        report.run(),
        SLOW.as_secs()
    )
}

fn ladder(report: &Report) -> Table {
    // Random walks have no costs.
    let rungs: Vec<&str> = report.rungs("nats").into_iter().filter(|rung| *rung != REFERENCE).collect();
    let dominated = beaten(report, &rungs);
    let title = "Optical paths: RMS errors of the cost in nats, and of luminance";
    let mut lines = Table::of("optical_path_ladder", title, rungs).column("rung", |rung| (*rung).to_owned());
    for view in COMPARED {
        let value = |rung: &str, measure: &str| report.value(rung, view, measure);
        lines = lines
            .column(format!("{view}: nats, luminance"), |rung| match value(rung, "nats") {
                None => "-".to_owned(),
                nats => format!("{}, {}", figure(nats, 3), figure(value(rung, "luminance"), 4)),
            })
            .column("ms", |rung| shown_ms(report, rung, view, GREY));
    }
    let memory = |rung: &str| report.row(rung, STAGED, GREY).and_then(|row| row.bytes);
    lines.column("memory", |rung| bytes(memory(rung))).column("", |rung| marked(rung, &dominated)).note(format!(
        "{} Errors are over the pixels where the true cost is below {DEEPEST} nats; black counts as {BLACK}. `{BALL}`: \
         from the closed form; the others: from `{FINEST}`. `{UNSCALED}`: the whole extinction for a cost. Memory: \
         maps, voxels, costs and solver. Dominated: another rung's bunny is faster, and errs no more in any view.",
        note(report, "of one extinction for all channels, one sample a pixel")
    ))
}

fn walks(report: &Report) -> Table {
    let mut lines = Table::of("optical_path_walks", "Beside random walks", report.rungs("walks"))
        .column("rung", |rung| (*rung).to_owned());
    for view in WALKED {
        lines = lines
            .column(format!("{view}, from walks"), |rung| figure(report.value(rung, view, "walks"), 3))
            .column("ms", |rung| shown_ms(report, rung, view, RGB));
    }
    lines.note(format!(
        "{} From walks: luminance from the committed picture, over its root mean square, after the best exposure; two \
         by two pixels are compared with one of it. Of the reference: its own standard error.",
        note(report, "in the colours that `cook plan` gives them, three channels, one sample a pixel")
    ))
}

fn stages(report: &Report) -> Table {
    let rungs: Vec<&str> =
        report.rungs(GREY).into_iter().filter(|rung| report.ms(rung, STAGED, GREY).is_some()).collect();
    let count = |rung: &str, measure: &str| figure(report.value(rung, STAGED, measure), 0);
    let left = |rung: &str| report.value(rung, STAGED, "active").is_some_and(|active| active > 0.0);
    let mut lines = Table::of("optical_path_stages", "The bunny, stage by stage", rungs)
        .column("rung", |rung| (*rung).to_owned())
        .column("passes", |rung| count(rung, "passes"))
        .column("updates", |rung| format!("{}{}", count(rung, "updates"), if left(rung) { "+" } else { "" }));
    for stage in Stage::ALL.map(Stage::name) {
        lines = lines.column(stage, |rung| figure(report.value(rung, STAGED, stage), 1));
    }
    lines.column("frame", |rung| shown_ms(report, rung, STAGED, GREY)).note(format!(
        "{} Each stage is submitted and waited for by itself. Updates: tiles, or for untiled solvers voxels; `+` if \
         more were left.",
        note(report, "of the bunny with one extinction for all channels")
    ))
}

/// Returns the times of the solver and of the whole frame, for the grey bunny on a grid.
fn solve_and_frame(report: &Report, solver: &str, cells: u32) -> Option<[f64; 2]> {
    let rung = format!("{solver}-{cells}");
    Some([report.value(&rung, STAGED, Stage::Solve.name())?, report.ms(&rung, STAGED, GREY)?])
}

fn growth(report: &Report) -> Table {
    let mut lines = Table::of("optical_path_growth", "Time against the grid", GROWING)
        .column("solver: solve, frame, ms", |solver| (*solver).to_owned());
    for cells in CELLS {
        lines = lines.column(format!("{cells}³"), |solver| match solve_and_frame(report, solver, cells) {
            Some([solve, frame]) => format!("{solve:.1}, {frame:.1}"),
            None => "-".to_owned(),
        });
    }
    // From 64 cells on, because the fixed cost of each pass dominates on smaller grids.
    let power = |solver: &str| {
        let timed = |cells: &u32| Some((f64::from(*cells), solve_and_frame(report, solver, *cells)?[0]));
        let (last, slow) = CELLS.iter().filter_map(timed).next_back()?;
        let (first, fast) = timed(&64)?;
        (last > first).then(|| (slow / fast).ln() / (last / first).ln())
    };
    lines
        .column("the solve grows with the cells along an edge to the power of", |solver| {
            power(solver).map_or("-".to_owned(), |power| format!("{power:.1}, from 64"))
        })
        .note("")
}

fn goals(report: &Report) -> Table {
    let mut goals = Vec::new();
    for view in ["bunny", "dragon"] {
        goals.extend(report.ms(USUAL, view, RGB).map(|ms| {
            let goal = format!(
                "10 frames a second in the colours that `cook plan` gives it, three channels, by `{USUAL}`, {view}"
            );
            Goal::new(goal, format!("{:.1}: {ms:.1} ms", 1000.0 / ms), ms <= 100.0)
        }));
    }
    let times = |solver: &str| solve_and_frame(report, solver, 128);
    if let Some((slow, fast)) = times("ping-pong-26").zip(times("tiled-26")) {
        let [solve, frame] = [0, 1].map(|part| slow[part] / fast[part]);
        let goal = "a frame by tiles at least 3 times as fast as by ping-pong at 128³, 26 neighbours";
        goals.push(Goal::new(goal, format!("{frame:.1} times; the solve alone {solve:.1}"), frame >= 3.0));
    }
    goals.extend(report.value(USUAL, BALL, "nats").map(|nats| {
        let goal = format!("on the ball `{USUAL}` within 0.1 nats, root mean square");
        Goal::new(goal, format!("{nats:.3}"), nats <= 0.1)
    }));
    for view in WALKED {
        let walks = |rung: &str| report.value(rung, view, "walks");
        goals.extend(walks(USUAL).zip(walks(LAMBERT_SHADOWED)).map(|(paths, lambert)| {
            let goal =
                format!("from random walks `{USUAL}` at most half as far as Lambert's law with shadows cast, {view}");
            let measured = format!("{paths:.3} and {lambert:.3}: {:.2} times", paths / lambert);
            Goal::new(goal, measured, paths <= 0.5 * lambert)
        }));
    }
    Goal::table("optical_path_goals", goals)
}

/// The groups of rungs in the plots: the start of their names, and a name for the legend.
const GROUPS: [(&str, &str); 5] = [
    ("lambert", "Lambert's law, no way through, and with shadows"),
    ("ping-pong", "ping-pong"),
    ("tiled", "tiles"),
    ("godunov", "the Eikonal equation by tiles"),
    ("paper", "the paper's solver"),
];

fn group(rung: &str) -> usize {
    GROUPS.iter().position(|(start, _)| rung.starts_with(start)).unwrap_or(0)
}

pub(super) fn plots(report: &Report) -> Vec<Plot> {
    let rungs = report.rungs("nats");
    let dot = |rung| Dot::new(rung, report.ms(rung, BALL, GREY), report.value(rung, BALL, "nats"), group(rung));
    let dots: Vec<Dot<'_>> = rungs.iter().copied().filter_map(dot).collect();
    let mut lines = Vec::new();
    for solver in GROWING {
        for (part, what, width) in [(1, "the frame", 3), (0, "the solve", 1)] {
            let point = |cells: u32| Some((f64::from(cells), solve_and_frame(report, solver, cells)?[part]));
            let name = format!("{solver}, {what}");
            lines.push(Series::line(&name, COLORS[group(solver)], width, CELLS.into_iter().filter_map(point)).dotted());
        }
    }
    lines.retain(|series| !series.points.is_empty());
    vec![
        Plot {
            file: "optical_path_error.svg",
            caption: format!("Optical paths: error against time, {}, {}", report.size(), report.adapter),
            x: Axis::log("milliseconds a frame of the ball, one channel (least of interleaved rounds)"),
            y: Axis::log("root mean square error on the ball, nats"),
            series: plot::ladder(&dots, &GROUPS.map(|(_, name)| name), ("nothing faster is better", 2), 1.0),
        },
        Plot {
            file: "optical_path_growth.svg",
            caption: format!("Optical paths: time against the grid, {}", report.adapter),
            x: Axis::log("voxels along an edge of the grid").with_ticks(CELLS.map(f64::from)),
            y: Axis::log("milliseconds for the bunny, one channel (least of interleaved rounds)"),
            series: lines,
        },
    ]
}
