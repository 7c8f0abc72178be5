//! The reflectance ladder's tables and its plot.

use super::rungs::{ANALYTIC, BLUR, CIRCULAR, LAMBERT, PAPER, RUNGS, SCREEN, SPHERICAL, TABLE, VIEWS};
use super::scenes::{self, SCENES, SIDE};
use crate::plot::{self, Axis, COLORS, Dot, Marker, Plot, Series};
use crate::quality;
use crate::report::{Report, TIME, all_pairs, dominated};
use crate::table::{Goal, Table, beyond, bytes, figure, marked, scientific, sum};
use lapidary_plan::Technique;

/// Checks that a report is the whole ladder, timed.
pub(super) fn whole(report: &Report) -> Result<(), String> {
    report.all_timed(RUNGS, &VIEWS)?;
    let mut walked = report.rows.iter().filter(|row| row.measure == "walks").peekable();
    if walked.peek().is_none() || walked.any(|row| row.ms.is_none()) {
        return Err("the report has no times of pictures beside random walks; measure it anew".to_owned());
    }
    Ok(())
}

pub(super) fn tables(report: &Report) -> Vec<Table> {
    vec![
        errors(report),
        ladder(report),
        quality::table("cdrf_quality", report, &[Technique::Cdrf]),
        times(report, "cdrf_lit", "The lit part alone: skin_bunny fills the frame, under one light", &VIEWS[..2]),
        times(
            report,
            "cdrf_whole",
            "A whole frame: skin_bunny before a backdrop, in the studio and under one light, tone-mapped and encoded",
            &VIEWS[2..],
        ),
        walked(report),
        goals(report),
        paper(report),
    ]
}

/// Compares functions and tables by their errors alone.
fn errors(report: &Report) -> Table {
    let function = |rung: &'static str| (format!("`cdrf_{rung}`"), rung, SCREEN);
    let tables = report.rows.iter().filter(|row| row.view == TABLE && row.measure == "largest");
    let mut lines: Vec<(String, &str, &str)> = [LAMBERT, "wrap"].map(function).into();
    lines.extend(tables.map(|row| (row.rung.clone(), row.rung.as_str(), TABLE)));
    lines.extend(ANALYTIC.map(function));
    lines.retain(|(_, rung, view)| report.value(rung, view, "largest").is_some());
    Table::of("cdrf_errors", "Functions and lookup tables", lines)
        .column("rung", |(name, ..)| name.clone())
        .column("largest error", |(_, rung, view)| scientific(report.value(rung, view, "largest")))
        .column("mean error", |(_, rung, view)| scientific(report.value(rung, view, "rms")))
        .note("")
}

/// Whether the errors of two rungs are comparable: the spherical form has a different definition.
fn are_comparable(one: &str, other: &str) -> bool {
    (one == SPHERICAL) == (other == SPHERICAL)
}

/// Returns the rungs than which another one's lit part is faster with curvature from either source,
/// and whose errors are no smaller.
fn beaten(report: &Report) -> Vec<&str> {
    dominated(&report.rungs(TIME), |other, rung| {
        let times = VIEWS[..2].iter().map(|view| (report.ms(other, view, TIME), report.ms(rung, view, TIME)));
        let error = |rung: &str, measure: &str| report.value(rung, SCREEN, measure);
        let errors = ["largest", "rms"].map(|measure| (error(other, measure), error(rung, measure)));
        are_comparable(other, rung)
            && all_pairs(times, |other, ms| other < ms)
            && all_pairs(errors, |other, error| other <= error)
    })
}

fn ladder(report: &Report) -> Table {
    let rungs = report.rungs(TIME);
    let dominated = beaten(report);
    let value = |rung: &str, measure: &str| report.value(rung, SCREEN, measure);
    let residuals = |rung: &str| {
        let [free, fixed] = ["scale free", "scale fixed"].map(|measure| figure(value(rung, measure), 4));
        if value(rung, "scale free").is_none() { "-".to_owned() } else { format!("{free} / {fixed}") }
    };
    let fragment = |rung: &str, view: &str| Some(report.row(rung, view, TIME)?.instructions.get(1)?.to_string());
    let counts = |rung: &str| {
        let mut counts: Vec<String> = VIEWS[..2].iter().filter_map(|view| fragment(rung, view)).collect();
        counts.dedup();
        counts.join(", ")
    };
    let [largest, rms] = ["largest", "rms"].map(|measure| scientific(report.value(SPHERICAL, CIRCULAR, measure)));
    Table::of("cdrf_ladder", "Reflectance ladder", rungs)
        .column("rung", |rung| (*rung).to_owned())
        .column("largest error", |rung| scientific(value(rung, "largest")))
        .column("RMS error", |rung| scientific(value(rung, "rms")))
        .column("from random walks, scale free / fixed", |rung| residuals(rung))
        .column("textures", |rung| bytes(report.row(rung, SCREEN, TIME).and_then(|row| row.bytes)))
        .column("mesh", |rung| bytes(report.row(rung, "mesh", "vertex data").and_then(|row| row.bytes)))
        .column("fragment shader, lit: screen, vertex", |rung| counts(rung))
        .column("", |rung| marked(rung, &dominated))
        .note(format!(
            "From the convolution on the circle `spherical` is {largest} at most and {rms} in the mean: it is another \
             function, and its errors above are those from its own definition. Random walks: {} spheres, each with the \
             width that fits it best. The timed mesh has {} vertices. Textures: bytes for one material; mesh: bytes \
             besides positions, normals and indices. Dominated: in the lit part another rung is faster with curvature \
             from either source, and errs no more.",
            report.setting("spheres"),
            report.setting("vertices")
        ))
}

/// Returns the time of a rung divided by that of another one in a view.
fn ratio(report: &Report, slow: &str, fast: &str, view: &str) -> Option<f64> {
    Some(report.ms(slow, view, TIME)? / report.ms(fast, view, TIME)?)
}

/// Describes a view's source of curvature.
fn source(view: &str) -> &'static str {
    if view.ends_with("screen") { "curvature from the screen" } else { "curvature from vertices" }
}

fn times(report: &Report, name: &'static str, title: &str, views: &[&str]) -> Table {
    let mut lines = Table::of(name, title, report.rungs(TIME)).column("rung", |rung| (*rung).to_owned());
    let short = ["curvature from the screen, ms", "from vertices, ms"];
    for (view, heading) in views.iter().zip(short) {
        lines = lines
            .column(heading, |rung| report.shown_ms(rung, view))
            .column("over Lambert", |rung| beyond(ratio(report, rung, LAMBERT, view)))
            .column("blur ÷ it", |rung| figure(ratio(report, BLUR, rung, view), 1))
            .column("SPIR-V", |rung| {
                report.row(rung, view, TIME).map_or_else(String::new, |row| sum(&row.instructions))
            });
    }
    lines.note(format!(
        "Milliseconds for {} pixels, {}. `*` timed on 1/16 of the pixels and scaled. `lambert` and `blur` know no \
         curvature, and were timed once. SPIR-V: instructions of vertex and fragment shader; the blur has other \
         shaders besides.",
        report.size(),
        report.run()
    ))
}

/// Shows whole pictures compared with random walks.
fn walked(report: &Report) -> Table {
    let rungs = report.rungs("walks");
    let lines: Vec<(&str, bool)> = rungs.iter().flat_map(|rung| [(*rung, false), (*rung, true)]).collect();
    let mut table = Table::of("cdrf_scenes", "Whole pictures beside random walks", lines)
        .column("rung", |(rung, _)| (*rung).to_owned())
        .column("shadows", |(_, shadows)| if *shadows { "cast" } else { "none" }.to_owned());
    for name in SCENES {
        let row = |(rung, shadows): &(&str, bool)| report.row(rung, &scenes::view(name, *shadows), "walks");
        table = table
            .column(format!("{name}, from walks"), |line| figure(row(line).and_then(|row| row.value), 3))
            .column("ms", |line| figure(row(line).and_then(|row| row.ms), 1));
    }
    table.note(format!(
        "Pictures of {SIDE} × {SIDE} pixels, one sample each, curvature from vertices, by the lights alone; two by two \
         pixels are compared with one of the walks', after the best exposure, over the walks' root mean square. \
         Milliseconds for the same pictures, {}.",
        report.run()
    ))
}

/// Returns how many times closer to the convolution a rung is than the paper's table, by the measure
/// in which it gains less.
fn nearer(report: &Report, rung: &str) -> Option<f64> {
    let gain = |measure: &str| Some(report.value(PAPER, SCREEN, measure)? / report.value(rung, SCREEN, measure)?);
    Some(gain("largest")?.min(gain("rms")?))
}

fn goals(report: &Report) -> Table {
    let mut goals = Vec::new();
    for (lit, whole) in VIEWS[..2].iter().zip(&VIEWS[2..]) {
        let speedup = |view: &str, slow: &str, fast: &str| ratio(report, slow, fast, view);
        // The fastest rung without a table that is close enough; the other goals apply to it too.
        let near = |rung: &&'static str| {
            let times = nearer(report, rung).filter(|times| *times >= 100.0)?;
            Some((*rung, times, speedup(lit, PAPER, rung)?))
        };
        let Some((best, times, faster)) = ANALYTIC.iter().filter_map(near).max_by(|a, b| a.2.total_cmp(&b.2)) else {
            continue;
        };
        let with = source(lit);
        goals.push(Goal::new(
            format!(
                "a rung without a table, faster than `{PAPER}` and at least 100 times as near to the convolution; {with}"
            ),
            format!("`{best}`: {faster:.2} times as fast, {times:.0} times as near"),
            faster > 1.0,
        ));
        goals.extend(speedup(whole, best, LAMBERT).map(|over| {
            let goal = format!("its whole frame within 25 % of Lambert's; {with}");
            Goal::new(goal, format!("`{best}`: {}", beyond(Some(over))), over <= 1.25)
        }));
        for (view, what) in [(lit, "its lit part"), (whole, "its whole frame")] {
            goals.extend(speedup(view, BLUR, best).map(|faster| {
                let goal = format!("{what} at least 10 times as fast as by the texture's blur; {with}");
                Goal::new(goal, format!("`{best}`: {faster:.1} times"), faster >= 10.0)
            }));
        }
    }
    Goal::table("cdrf_goals", goals)
}

/// Compares the costs with the paper's, which are of a PlayStation 3's GPU alone.
fn paper(report: &Report) -> Table {
    type Figure = fn(&Report, &str, &str) -> String;
    let figures: [(&str, &str, Figure); 2] = [
        ("over Lambert", "+5.5 %", |report, rung, view| beyond(ratio(report, rung, LAMBERT, view))),
        ("times as fast as a blur in a texture of 1024 × 1024", "4.8", |report, rung, view| {
            figure(ratio(report, BLUR, rung, view), 1)
        }),
    ];
    let views = || std::iter::once(None).chain(VIEWS.map(Some));
    let lines: Vec<_> = figures.into_iter().flat_map(|quantity| views().map(move |view| (quantity, view))).collect();
    let mut table = Table::of("cdrf_paper", "The paper's figures: PlayStation 3, the GPU's part alone", lines).column(
        "",
        |((what, ..), view)| match view {
            None => format!("{what}, the paper's"),
            Some(view) => {
                let part = if view.starts_with("lit") { "lit part" } else { "whole frame" };
                format!("{what}, {part}, {}", source(view))
            }
        },
    );
    for rung in [PAPER, "cheap", "accurate"] {
        table = table.column(format!("`{rung}`"), |((_, papers, value_of), view)| match view {
            Some(view) => value_of(report, rung, view),
            None => if rung == PAPER { papers } else { "-" }.to_owned(),
        });
    }
    table.note("")
}

/// Plots the largest error against the time of the lit part.
pub(super) fn plots(report: &Report) -> Vec<Plot> {
    let groups = [
        "Lambert's law",
        "lookup tables",
        "closed forms and the integral",
        "the spherical form, from its own definition",
    ];
    let mut series: Vec<Series> = Vec::new();
    for (view, (front, width, marker)) in VIEWS.iter().zip([
        ("nothing faster is better, with curvature from the screen (discs)", 3, Marker::Disc),
        ("nothing faster is better, with curvature from vertices (rings)", 1, Marker::Ring),
    ]) {
        let dot = |rung: &'static str| {
            let group = match rung {
                LAMBERT => 0,
                SPHERICAL => 3,
                _ if rung.starts_with("table") => 1,
                _ => 2,
            };
            let dot = Dot::new(rung, report.ms(rung, view, TIME), report.value(rung, view, "largest"), group)?;
            Some(Dot { marker, compared: rung != SPHERICAL, ..dot })
        };
        let dots: Vec<Dot<'_>> = RUNGS.into_iter().filter_map(dot).collect();
        let mut added = plot::ladder(&dots, &groups, (front, width), 1.0);
        for series in added[1..].iter_mut().filter(|_| marker == Marker::Ring) {
            // One label for both points of a rung, and one name in the legend.
            series.name.clear();
            series.points.iter_mut().for_each(|point| point.label.clear());
        }
        series.append(&mut added);
    }
    for point in series.iter_mut().flat_map(|series| &mut series.points) {
        point.front = true;
    }
    if let Some(ms) = report.ms(BLUR, SCREEN, TIME).filter(|ms| *ms > 0.0) {
        let errors = series.iter().flat_map(|series| &series.points).map(|point| point.at.1);
        let (low, high) = errors.fold((f64::INFINITY, 0.0), |(a, b), error| (f64::min(a, error), f64::max(b, error)));
        if low <= high {
            series.push(Series::line("time of the texture's blur", COLORS[4], 2, [(ms, low), (ms, high)]));
        }
    }
    vec![Plot {
        file: "cdrf.svg",
        caption: format!("Reflectance ladder: largest error against time, {}, {}", report.size(), report.adapter),
        x: Axis::log("milliseconds a frame filled by the lit body (least of interleaved rounds)"),
        y: Axis::log("largest error against the convolution"),
        series,
    }]
}
