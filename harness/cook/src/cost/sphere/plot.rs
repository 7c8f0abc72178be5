//! The spheres as plots: the width against the radius, and exitance against the angle from the
//! light.

use super::Form;
use super::{ALBEDOS, RADII as ALL_RADII, ScaleKind, SphereReport};
use crate::cost::CostError;
use crate::cost::drawing::{COLORS, Drawn, GREY, LIGHT, Root, captioned, legend, line, span, ticks, written};
use lapidary_cdrf as cdrf;
use lapidary_reference::random_walk::BINS;
use plotters::prelude::*;

/// Albedo of the spheres whose profiles are drawn.
const ALBEDO: f64 = 0.99;
/// Radii of the spheres whose profiles are drawn, in mean free paths.
const RADII: [f64; 3] = [2.0, 10.0, 50.0];
/// Labels on the axis of widths times radii.
const WIDTHS: [f64; 12] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 15.0, 20.0, 30.0, 50.0];

/// Returns a plot of width times radius against the radius as SVG, with a line for each albedo. The
/// lines would be level if sigma = sigma_0 kappa held.
///
/// # Errors
///
/// Returns an error if the report has no widths or if plotters fails.
pub fn sigma(report: &SphereReport) -> Result<String, CostError> {
    written(|root| draw_sigma(root, report))
}

/// Returns a plot of exitance against the angle from the light as SVG, together with the best
/// circular form with a free scale and Lambert's law.
///
/// # Errors
///
/// Returns an error if the report lacks one of the spheres or if plotters fails.
pub fn profile(report: &SphereReport) -> Result<String, CostError> {
    written(|root| draw_profile(root, report))
}

/// Radius, and width times radius, both in mean free paths.
type Point = (f64, f64);

fn draw_sigma(root: &Root<'_>, report: &SphereReport) -> Drawn {
    // A zero cannot be shown on a logarithmic axis.
    let visible = |&(radius, width): &Point| radius > 0.0 && width > 0.0;
    let lines = ALBEDOS.map(|albedo| -> Vec<Point> {
        let rows = report.best(albedo, Form::Circular, ScaleKind::Free);
        rows.map(|row| (row.radius, row.sigma_radius)).filter(visible).collect()
    });
    let points: Vec<Point> = lines.concat();
    if points.is_empty() {
        return Err("the report has no widths".into());
    }
    let across = span(points.iter().map(|point| point.0), 1.15);
    let up = span(points.iter().map(|point| point.1), 1.15);
    let caption = "Best width times radius: level lines, were σ = σ₀κ true";
    let mut chart = captioned(root, caption).build_cartesian_2d(
        across.clone().log_scale().with_key_points(ticks(&ALL_RADII, &across)),
        up.clone().log_scale().with_key_points(ticks(&WIDTHS, &up)),
    )?;
    chart
        .configure_mesh()
        .x_desc("radius in mean free paths")
        .y_desc("σR in mean free paths, the circular form with a free scale")
        .x_label_formatter(&|radius| format!("{radius:.0}"))
        .y_label_formatter(&|width| format!("{width:.0}"))
        .light_line_style(LIGHT)
        .label_style(("sans-serif", 13))
        .draw()?;
    if let Some(law) = report.laws.iter().find(|law| law.form == Form::Circular && law.albedo.is_none()) {
        let law_line = law.radii.map(|radius| (radius, radius * law.sigma(radius)));
        chart
            .draw_series(LineSeries::new(law_line, GREY.stroke_width(6)))?
            .label(format!("σR = {:.2} R^{:.2}", law.factor, law.exponent))
            .legend(line(GREY, 6));
    }
    for ((albedo, points), color) in ALBEDOS.into_iter().zip(lines).zip(COLORS) {
        chart.draw_series(points.iter().map(|&at| Circle::new(at, 4, color.filled())))?;
        chart
            .draw_series(LineSeries::new(points, color.stroke_width(2)))?
            .label(format!("albedo {albedo}"))
            .legend(line(color, 2));
    }
    legend(&mut chart, SeriesLabelPosition::UpperLeft)
}

fn draw_profile(root: &Root<'_>, report: &SphereReport) -> Drawn {
    let mut spheres = Vec::new();
    for radius in RADII {
        let sphere = report.profile(ALBEDO, radius).zip(report.row(ALBEDO, radius, Form::Circular, ScaleKind::Free));
        spheres.push(sphere.ok_or_else(|| format!("the report has no sphere of albedo {ALBEDO} and radius {radius}"))?);
    }
    let caption = format!("Spheres of albedo {ALBEDO}: random walks and the best of the reflectance function");
    let mut chart = captioned(root, caption).build_cartesian_2d(0.0..180.0, 0.0..0.9)?;
    chart
        .configure_mesh()
        .x_desc("angle between the normal and the light, degrees")
        .y_desc("exitance over the irradiance square to the light")
        .x_labels(13)
        .x_label_formatter(&|angle| format!("{angle:.0}"))
        .y_label_formatter(&|value| format!("{value:.1}"))
        .light_line_style(LIGHT)
        .label_style(("sans-serif", 13))
        .draw()?;
    let curve = |value: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
        (0..=360).map(|half| 0.5 * f64::from(half)).map(|angle| (angle, value(angle.to_radians().cos()))).collect()
    };
    if let Some(limit) = report.limits.iter().find(|limit| limit.albedo == ALBEDO) {
        let lambert = curve(&|cosine| limit.diffuse_albedo * cosine.max(0.0));
        chart
            .draw_series(LineSeries::new(lambert, GREY.stroke_width(2)))?
            .label("Lambert, the half space's albedo")
            .legend(line(GREY, 2));
    }
    for ((profile, row), color) in spheres.into_iter().zip(&COLORS[1..]) {
        let color = *color;
        let best = curve(&|cosine| row.scale * f64::from(cdrf::accurate(cosine as f32, row.sigma as f32)));
        chart
            .draw_series(LineSeries::new(best, color.stroke_width(1)))?
            .label(format!("R = {}: σ = {:.3}, residual {:.3}", row.radius, row.sigma, row.residual))
            .legend(line(color, 2));
        let points: Vec<(f64, f64, f64)> = (0..BINS)
            .map(|bin| {
                let angle = 180.0 * (bin as f64 + 0.5) / BINS as f64;
                (angle, profile.exitance[bin], profile.standard_error[bin])
            })
            .collect();
        chart.draw_series(points.iter().map(|&(angle, value, _)| Circle::new((angle, value), 3, color.filled())))?;
        chart.draw_series(points.iter().map(|&(angle, value, error)| {
            PathElement::new([(angle, value - error), (angle, value + error)], color.stroke_width(2))
        }))?;
    }
    legend(&mut chart, SeriesLabelPosition::UpperRight)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_reference::random_walk;

    #[test]
    fn plots_show_every_line() {
        let sphere = |albedo| RADII.map(|radius| random_walk::profile(radius, albedo, 2000, 1)).to_vec();
        let report = SphereReport::of(2000, 1, [sphere(ALBEDO), sphere(1.0)].concat());
        let svg = sigma(&report).expect("drawn");
        for part in ["albedo 0.99", "albedo 1", "R^", "mean free paths"] {
            assert!(svg.contains(part), "{part}");
        }
        let svg = profile(&report).expect("drawn");
        for part in ["R = 2:", "R = 10:", "R = 50:", "Lambert"] {
            assert!(svg.contains(part), "{part}");
        }
    }

    #[test]
    fn what_is_not_there_is_not_drawn() {
        let empty = SphereReport::of(1, 1, Vec::new());
        assert!(sigma(&empty).expect_err("nothing").to_string().contains("no widths"));
        assert!(profile(&empty).expect_err("nothing").to_string().contains("radius 2"));
    }
}
