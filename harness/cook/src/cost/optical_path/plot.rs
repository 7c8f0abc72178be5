//! The ladder as plots: error against time, and time against grid size, all logarithmic.

use super::page::solve_and_frame;
use super::views::BALL;
use super::{CELLS, GROWING, OpticalPathReport, RungReport};
use crate::cost::CostError;
use crate::cost::drawing::{
    self, COLORS, Drawn, GREY, LIGHT, Label, Root, captioned, disc, legend, line, span, stairs, ticks, written,
};
use plotters::prelude::*;

/// Labels on the axes of times, in milliseconds.
const TIMES: [f64; 14] =
    [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10000.0, 20000.0];
/// Labels on the axis of errors.
const ERRORS: [f64; 10] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0];

/// Returns a colour by the rung's solver.
fn color(rung: &str) -> RGBColor {
    match rung {
        name if name.starts_with("tiled") => COLORS[2],
        name if name.starts_with("godunov") => COLORS[3],
        name if name.starts_with("ping-pong") => COLORS[1],
        name if name.starts_with("paper") => COLORS[4],
        _ => COLORS[0],
    }
}

/// A timed rung in a view.
struct Point<'a> {
    rung: &'a RungReport,
    at: (f64, f64),
    /// Whether no other rung is both faster and no worse.
    front: bool,
}

fn points<'a>(report: &'a OpticalPathReport, view: &str) -> Vec<Point<'a>> {
    let found = |rung: &'a RungReport| Some((rung, (rung.grey(view)?.ms, rung.distance(view).nats?)));
    let all: Vec<_> =
        report.rungs.iter().filter_map(found).filter(|(_, (ms, error))| *ms > 0.0 && *error > 0.0).collect();
    let beaten = |(ms, error): (f64, f64)| all.iter().any(|(_, other)| other.0 < ms && other.1 <= error);
    all.iter().map(|&(rung, at)| Point { rung, at, front: !beaten(at) }).collect()
}

/// Returns a plot of error against time as SVG.
///
/// # Errors
///
/// Returns an error if the report has no times or if plotters fails.
pub fn error(report: &OpticalPathReport) -> Result<String, CostError> {
    written(|root| draw_error(root, report))
}

/// Returns a plot of time against grid size as SVG.
///
/// # Errors
///
/// Returns an error if the report has no times of the solvers on any of the grids or if plotters
/// fails.
pub fn growth(report: &OpticalPathReport) -> Result<String, CostError> {
    written(|root| draw_growth(root, report))
}

/// Whether [`growth`] has anything to draw.
pub fn has_growth(report: &OpticalPathReport) -> bool {
    GROWING.iter().any(|solver| !line_of(report, solver).is_empty())
}

fn draw_error(root: &Root<'_>, report: &OpticalPathReport) -> Drawn {
    let points = points(report, BALL);
    if points.is_empty() {
        return Err("no rung was timed".into());
    }
    let across = span(points.iter().map(|point| point.at.0), 1.5);
    let up = span(points.iter().map(|point| point.at.1), 1.5);
    let [width, height] = report.frame;
    let caption = format!("Ways of light through stone: error against time, {width}x{height}, {}", report.adapter);
    let mut chart = captioned(root, caption).build_cartesian_2d(
        across.clone().log_scale().with_key_points(ticks(&TIMES, &across)),
        up.clone().log_scale().with_key_points(ticks(&ERRORS, &up)),
    )?;
    chart
        .configure_mesh()
        .x_desc("milliseconds a frame of the ball, one channel (least of interleaved rounds)")
        .y_desc("root mean square error on the ball, nats")
        .x_label_formatter(&|ms| format!("{ms:.0}"))
        .y_label_formatter(&|error| format!("{error}"))
        .light_line_style(LIGHT)
        .label_style(("sans-serif", 13))
        .draw()?;
    let front = points.iter().filter(|point| point.front).map(|point| point.at).collect();
    chart
        .draw_series(LineSeries::new(stairs(front), GREY.stroke_width(2)))?
        .label("nothing faster is better")
        .legend(line(GREY, 2));
    for point in &points {
        chart.draw_series([Circle::new(point.at, 6, color(&point.rung.rung).filled())])?;
    }
    for (name, start) in [
        ("Lambert's law, no way through, and with shadows", "lambert"),
        ("the paper's solver", "paper"),
        ("ping-pong", "ping-pong"),
        ("tiles", "tiled"),
        ("the Eikonal equation by tiles", "godunov"),
    ] {
        if let Some(point) = points.iter().find(|point| point.rung.rung.starts_with(start)) {
            let color = color(start);
            chart.draw_series([Circle::new(point.at, 1, color.filled())])?.label(name).legend(disc(color));
        }
    }
    let places: Vec<(i32, i32)> = points.iter().map(|point| chart.backend_coord(&point.at)).collect();
    let labels: Vec<Label<'_>> = points
        .iter()
        .zip(&places)
        .map(|(point, &at)| Label { name: &point.rung.rung, at, front: point.front })
        .collect();
    drawing::draw(root, &labels, &places)?;
    legend(&mut chart, SeriesLabelPosition::UpperRight)
}

/// Returns the number of cells, and the milliseconds of the solve and of the frame.
fn line_of(report: &OpticalPathReport, solver: &str) -> Vec<(f64, [f64; 2])> {
    let found = |cells: u32| Some((f64::from(cells), solve_and_frame(report.rung(&format!("{solver}-{cells}"))?)?));
    CELLS.into_iter().filter_map(found).collect()
}

fn draw_growth(root: &Root<'_>, report: &OpticalPathReport) -> Drawn {
    let lines = GROWING.map(|solver| (solver, line_of(report, solver)));
    let times = lines.iter().flat_map(|(_, points)| points.iter().flat_map(|(_, times)| *times));
    if times.clone().next().is_none() {
        return Err("no solver was timed".into());
    }
    let up = span(times, 1.5);
    let across = 14.0..300.0;
    let caption = format!("Ways of light through stone: time against the grid, {}", report.adapter);
    let mut chart = captioned(root, caption).build_cartesian_2d(
        across.log_scale().with_key_points(CELLS.map(f64::from).to_vec()),
        up.clone().log_scale().with_key_points(ticks(&TIMES, &up)),
    )?;
    chart
        .configure_mesh()
        .x_desc("voxels along an edge of the grid")
        .y_desc("milliseconds for the bunny, one channel (least of interleaved rounds)")
        .x_label_formatter(&|cells| format!("{cells:.0}"))
        .y_label_formatter(&|ms| format!("{ms:.0}"))
        .light_line_style(LIGHT)
        .label_style(("sans-serif", 13))
        .draw()?;
    for (solver, points) in lines.iter().filter(|(_, points)| !points.is_empty()) {
        let color = color(solver);
        for (part, what, width) in [(1, "the frame", 3), (0, "the solve", 1)] {
            let at: Vec<(f64, f64)> = points.iter().map(|(cells, times)| (*cells, times[part])).collect();
            chart.draw_series(at.iter().map(|&at| Circle::new(at, 3 + width as i32 / 2, color.filled())))?;
            chart
                .draw_series(LineSeries::new(at, color.stroke_width(width)))?
                .label(format!("{solver}, {what}"))
                .legend(line(color, width));
        }
    }
    legend(&mut chart, SeriesLabelPosition::UpperLeft)
}
