//! The ladder as a plot of the largest error against the time of the lit part, both logarithmic.

use super::{BLUR, CdrfReport, CurvatureSource, Part, RungReport, SPHERICAL};
use crate::cost::CostError;
use crate::cost::drawing::{
    self, COLORS, Drawn, GREY, LIGHT, Label, Root, captioned, disc, legend, line, span, stairs, ticks, written,
};
use plotters::prelude::*;

/// Labels on the axis of times, in milliseconds.
const TIMES: [f64; 14] = [1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10000.0];

struct Point<'a> {
    rung: &'a RungReport,
    source: CurvatureSource,
    ms: f64,
    error: f64,
    /// Whether no other rung is both faster, with curvature from the same source, and no worse.
    front: bool,
}

impl Point<'_> {
    /// Returns a colour by the rung's method: no curvature, table, closed form, or another
    /// function.
    fn color(&self) -> RGBColor {
        match self.rung.rung.as_str() {
            SPHERICAL => COLORS[3],
            name if name.starts_with("table") => COLORS[1],
            _ if self.rung.frames.iter().any(|frame| frame.curvature.is_some()) => COLORS[2],
            _ => COLORS[0],
        }
    }
}

fn points(report: &CdrfReport, source: CurvatureSource) -> Vec<Point<'_>> {
    let all: Vec<(&RungReport, f64, f64)> = report
        .rungs
        .iter()
        .filter_map(|rung| Some((rung, rung.ms(Part::Lit, source)?, rung.distance?.largest)))
        .filter(|(_, ms, error)| *ms > 0.0 && *error > 0.0)
        .collect();
    all.iter()
        .map(|&(rung, ms, error)| Point {
            rung,
            source,
            ms,
            error,
            // The spherical form approximates another function, so it is not on the common line.
            front: rung.rung != SPHERICAL && !all.iter().any(|&(_, other_ms, other)| other_ms < ms && other <= error),
        })
        .collect()
}

/// Returns the plot as SVG.
///
/// # Errors
///
/// Returns an error if the report has no times or if plotters fails.
pub fn svg(report: &CdrfReport) -> Result<String, CostError> {
    written(|root| draw(root, report))
}

fn draw(root: &Root<'_>, report: &CdrfReport) -> Drawn {
    let series = CurvatureSource::ALL.map(|source| points(report, source));
    let all = || series.iter().flatten();
    if all().next().is_none() {
        return Err("no rung was timed".into());
    }
    let blur = report.rung(BLUR).and_then(|rung| rung.ms(Part::Lit, CurvatureSource::Screen));
    let times: Vec<f64> = all().map(|point| point.ms).chain(blur).collect();
    let across = span(times.into_iter(), 1.3);
    let up = span(all().map(|point| point.error), 3.0);
    let [width, height] = report.frame;
    let caption = format!("Reflectance ladder: largest error against time, {width}x{height}, {}", report.adapter);
    let mut chart = captioned(root, caption).build_cartesian_2d(
        across.clone().log_scale().with_key_points(ticks(&TIMES, &across)),
        up.clone().log_scale(),
    )?;
    chart
        .configure_mesh()
        .x_desc("milliseconds a frame filled by the lit body (least of interleaved rounds)")
        .y_desc("largest error against the convolution")
        .x_label_formatter(&|ms| format!("{ms:.0}"))
        .y_label_formatter(&|error| format!("{error:.0e}"))
        .light_line_style(LIGHT)
        .label_style(("sans-serif", 13))
        .draw()?;

    for (points, (name, thick)) in series.iter().zip([("the screen (discs)", 3), ("vertices (rings)", 1)]) {
        let front = points.iter().filter(|point| point.front).map(|point| (point.ms, point.error)).collect();
        chart
            .draw_series(LineSeries::new(stairs(front), GREY.stroke_width(thick)))?
            .label(format!("nothing faster is better, with curvature from {name}"))
            .legend(line(GREY, thick));
    }
    if let Some(ms) = blur {
        let color = COLORS[4];
        chart
            .draw_series(LineSeries::new([(ms, up.start), (ms, up.end)], color.stroke_width(2)))?
            .label("time of the texture's blur")
            .legend(line(color, 2));
    }
    // A disc if curvature comes from the screen, a ring if it comes from vertices.
    for point in all() {
        let (at, color) = ((point.ms, point.error), point.color());
        match point.source {
            CurvatureSource::Screen => chart.draw_series([Circle::new(at, 6, color.filled())])?,
            CurvatureSource::Vertex => chart.draw_series([Circle::new(at, 6, color.stroke_width(2))])?,
        };
    }
    for (name, color) in [
        ("Lambert's law", COLORS[0]),
        ("lookup tables", COLORS[1]),
        ("closed forms and the integral", COLORS[2]),
        ("the spherical form, from its own definition", COLORS[3]),
    ] {
        if let Some(point) = all().find(|point| point.color() == color) {
            chart
                .draw_series([Circle::new((point.ms, point.error), 1, color.filled())])?
                .label(name)
                .legend(disc(color));
        }
    }
    let places: Vec<(i32, i32)> = all().map(|point| chart.backend_coord(&(point.ms, point.error))).collect();
    // One label for both points of a rung.
    let [screen, _] = &series;
    let labels: Vec<Label<'_>> =
        screen.iter().zip(&places).map(|(point, &at)| Label { name: &point.rung.rung, at, front: true }).collect();
    drawing::draw(root, &labels, &places)?;
    legend(&mut chart, SeriesLabelPosition::UpperRight)
}
