//! The gem ladder as a plot of error against time, both logarithmic.

use super::drawing::{
    self, COLORS, Drawn, GREY, LIGHT, Label, Root, captioned, disc, legend, line, span, stairs, written,
};
use super::{ALIKE, CostError, MEASURES, Report, RungReport};
use lapidary_plan::{Geometry, Rung, Spectrum};
use plotters::prelude::*;

struct Point<'a> {
    name: &'a str,
    rung: Option<Rung>,
    ms: f64,
    error: f64,
    /// Whether no other point is both faster and no worse, as in [`Report::mark_dominated`].
    front: bool,
}

fn points(report: &Report, measure: usize) -> Vec<Point<'_>> {
    let all: Vec<(&RungReport, f64, f64)> =
        report.rungs.iter().filter_map(|rung| Some((rung, rung.view_ms()?, rung.mean(measure)))).collect();
    all.iter()
        .map(|&(rung, ms, error)| Point {
            name: &rung.rung,
            rung: rung.rung.trim_end_matches("-fitted").parse().ok(),
            ms,
            error,
            front: !all.iter().any(|&(_, other_ms, other)| other_ms < ms && other <= ALIKE * error),
        })
        .collect()
}

fn color(rung: Option<Rung>) -> RGBColor {
    match rung {
        Some(Rung::Inside { geometry, .. }) => match geometry {
            Geometry::Proxy => COLORS[1],
            Geometry::Convex => COLORS[2],
            Geometry::Bvh => COLORS[3],
            Geometry::Triangles => COLORS[4],
        },
        _ => COLORS[0],
    }
}

/// Returns the plot as SVG, for the measure with that name.
pub fn svg(report: &Report, measure: &str) -> Result<String, CostError> {
    let number = MEASURES.iter().position(|name| *name == measure).unwrap_or(0);
    let points = points(report, number);
    if points.is_empty() {
        return Err(CostError::Plot("no rung was timed".to_owned()));
    }
    written(|root| draw(root, report, MEASURES[number], &points))
}

fn draw(root: &Root<'_>, report: &Report, measure: &str, points: &[Point<'_>]) -> Drawn {
    let Report { side, samples, adapter, .. } = report;
    let caption =
        format!("Gem ladder: error ({measure}) against time, {side}x{side}, samples a pixel: {samples}, {adapter}");
    let mut chart = captioned(root, caption).build_cartesian_2d(
        span(points.iter().map(|point| point.ms), 1.5).log_scale(),
        span(points.iter().map(|point| point.error), 1.3).log_scale(),
    )?;
    chart
        .configure_mesh()
        .x_desc("milliseconds a view (least of interleaved rounds, mean over the views)")
        .y_desc(format!("mean {measure} against the spectral reference"))
        .x_label_formatter(&|ms| if *ms >= 1.0 { format!("{ms:.0}") } else { format!("{ms:.2}") })
        .y_label_formatter(&|error| format!("{error:.3}"))
        .light_line_style(LIGHT)
        .label_style(("sans-serif", 13))
        .draw()?;

    // The rungs worth choosing: no faster rung has a smaller error.
    let front = points.iter().filter(|point| point.front).map(|point| (point.ms, point.error)).collect();
    chart
        .draw_series(LineSeries::new(stairs(front), GREY.stroke_width(2)))?
        .label("nothing faster is better")
        .legend(line(GREY, 2));

    for (name, geometry) in [
        ("surface alone", None),
        ("proxy geometry", Some(Geometry::Proxy)),
        ("convex planes", Some(Geometry::Convex)),
        ("BVH", Some(Geometry::Bvh)),
        ("all triangles", Some(Geometry::Triangles)),
    ] {
        let of_series = |point: &&Point<'_>| match (point.rung, geometry) {
            (Some(Rung::Inside { geometry, .. }), Some(wanted)) => geometry == wanted,
            (Some(Rung::Surface), None) => true,
            _ => false,
        };
        let series: Vec<&Point<'_>> = points.iter().filter(of_series).collect();
        let Some(first) = series.first() else { continue };
        let color = color(first.rung);
        // A disc if colours are not tracked, a ring for the paper's tracker, a triangle for the
        // exact tracker, and a cross for separate wavelengths.
        for point in &series {
            let at = (point.ms, point.error);
            let size = if point.front { 7 } else { 4 };
            match point.rung.map(Rung::spectrum) {
                Some(Spectrum::Paper) => chart.draw_series([Circle::new(at, size, color.stroke_width(2))])?,
                Some(Spectrum::Tracker) => chart.draw_series([TriangleMarker::new(at, size + 1, color.filled())])?,
                Some(Spectrum::Separate(_)) => chart.draw_series([Cross::new(at, size, color.stroke_width(2))])?,
                _ => chart.draw_series([Circle::new(at, size, color.filled())])?,
            };
        }
        chart.draw_series([Circle::new((first.ms, first.error), 1, color.filled())])?.label(name).legend(disc(color));
    }
    let places: Vec<(i32, i32)> = points.iter().map(|point| chart.backend_coord(&(point.ms, point.error))).collect();
    let labels: Vec<Label<'_>> =
        points.iter().zip(&places).map(|(point, &at)| Label { name: point.name, at, front: point.front }).collect();
    drawing::draw(root, &labels, &places)?;
    legend(&mut chart, SeriesLabelPosition::LowerLeft)
}
