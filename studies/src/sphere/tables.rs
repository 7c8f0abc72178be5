//! The spheres' tables and plots.

use super::form::Form;
use super::names::{ALBEDOS, ALL_LIGHT, CHOICES, FORMS, RADII, of_albedo, range, rung};
use super::rule::{LAW_RADII, RANGES};
use lapidary_cdrf as cdrf;
use lapidary_ladders::Report;
use lapidary_ladders::cdrf::sphere_fit::ScaleKind;
use lapidary_ladders::cdrf::spheres::{WALKS, profiles, view};
use lapidary_ladders::plot::{Axis, COLORS, GREY, Plot, Series};
use lapidary_ladders::table::{Table, figure};
use lapidary_reference::random_walk::BINS;

/// The radii shown in the table of residuals, in mean free paths.
const SHOWN: [f64; 6] = [2.0, 5.0, 10.0, 20.0, 50.0, 100.0];
/// The forms that have a width.
const WIDE: [Form; 2] = [Form::Circular, Form::Spherical];

/// Checks that a report has all spheres and their fits.
pub(super) fn whole(report: &Report) -> Result<(), String> {
    for (albedo, radius) in ALBEDOS.into_iter().flat_map(|albedo| RADII.map(|radius| (albedo, radius))) {
        let fitted = |form| {
            ScaleKind::ALL.iter().all(|kind| report.value(&rung(form, *kind), &view(albedo, radius), "sigma").is_some())
        };
        if !FORMS.into_iter().all(fitted) {
            return Err(format!(
                "the report has no fits of a sphere of albedo {albedo} and radius {radius}; only all spheres fill a page"
            ));
        }
    }
    Ok(())
}

pub(super) fn tables(report: &Report) -> Vec<Table> {
    let circular = rung(Form::Circular, ScaleKind::Free);
    vec![
        walks(report),
        widths(report, "sphere_widths", "of scattered light", &circular),
        widths(
            report,
            "sphere_widths_with_unscattered",
            "of all light, unscattered light included",
            &format!("{circular}{ALL_LIGHT}"),
        ),
        residuals(report),
        albedos(report),
        laws(report),
        choices(report),
        fits(report),
    ]
}

fn walks(report: &Report) -> Table {
    let most = profiles(report).iter().map(|profile| profile.noise()).fold(0.0, f64::max);
    let title = "Spheres in parallel light, index-matched, scattering to all sides alike";
    Table::of("sphere_walks", title, [0; 0]).note(format!(
        "{} walks each, seed {}; chance alone leaves a residual of at most {most:.4}.",
        report.setting("walks"),
        report.setting("seed")
    ))
}

/// Returns the heading of a column for a radius.
fn heading(index: usize, radius: f64) -> String {
    if index == 0 { format!("R = {radius}") } else { radius.to_string() }
}

/// Shows the widths times radii of a rung.
fn widths(report: &Report, name: &'static str, what: &str, rung: &str) -> Table {
    let value = |albedo: f64, radius: f64, measure: &str| report.value(rung, &view(albedo, radius), measure);
    let drift = |albedo: f64, to: f64| {
        let radii = RADII.into_iter().filter(|radius| *radius <= to);
        let found: Vec<f64> = radii.filter_map(|radius| value(albedo, radius, "sigma R")).collect();
        let (least, most) =
            found.iter().fold((f64::INFINITY, 0.0), |(a, b), &width| (f64::min(a, width), f64::max(b, width)));
        format!("{:.1}", most / least)
    };
    let title = format!("σR in mean free paths by the circular form, scale free, {what}");
    let mut lines = Table::of(name, &title, ALBEDOS).column("albedo", f64::to_string);
    for (index, radius) in RADII.into_iter().enumerate() {
        lines = lines.column(heading(index, radius), |&albedo| {
            let width = figure(value(albedo, radius, "sigma R"), 3);
            value(albedo, radius, "error of sigma R").map_or(width.clone(), |error| format!("{width} ± {error:.3}"))
        });
    }
    lines
        .column("largest over least, to 20", |&albedo| drift(albedo, 20.0))
        .column("to 100", |&albedo| drift(albedo, 100.0))
        .note("")
}

fn residuals(report: &Report) -> Table {
    let keys: Vec<(f64, Form)> = ALBEDOS.into_iter().flat_map(|albedo| FORMS.map(|form| (albedo, form))).collect();
    let title =
        "Residuals, scale free / fixed: RMS over the sphere, over the irradiance of a surface that faces the light";
    let mut lines = Table::of("sphere_residuals", title, keys)
        .column("albedo", |(albedo, _)| albedo.to_string())
        .column("form", |(_, form)| form.name().to_owned());
    let value = |form, kind, albedo, radius| report.value(&rung(form, kind), &view(albedo, radius), "residual");
    for (index, radius) in SHOWN.into_iter().enumerate() {
        lines = lines.column(heading(index, radius), |&(albedo, form)| {
            ScaleKind::ALL.map(|kind| figure(value(form, kind, albedo, radius), 3)).join(" / ")
        });
    }
    lines
        .column("∞", |&(albedo, form)| {
            let limit = value(form, ScaleKind::Free, albedo, f64::INFINITY);
            limit.map_or_else(String::new, |limit| figure(Some(limit), 3))
        })
        .note("")
}

fn albedos(report: &Report) -> Table {
    let spheres = profiles(report);
    let title = "Share of the light on a sphere that it gives back, scattered";
    let mut lines = Table::of("sphere_albedos", title, ALBEDOS).column("albedo", f64::to_string);
    for (index, radius) in RADII.into_iter().enumerate() {
        lines = lines.column(heading(index, radius), |&albedo| {
            let sphere = spheres.iter().find(|sphere| (sphere.albedo, sphere.radius) == (albedo, radius));
            figure(sphere.map(|sphere| sphere.whole()), 3)
        });
    }
    let half_space = |albedo: f64| report.value(WALKS, &view(albedo, f64::INFINITY), "diffuse albedo");
    lines.column("half space", |&albedo| figure(half_space(albedo), 3)).note("")
}

fn laws(report: &Report) -> Table {
    let albedos = || std::iter::once(None).chain(ALBEDOS.map(Some));
    let keys: Vec<(Form, Option<f64>)> =
        WIDE.into_iter().flat_map(|form| albedos().map(move |albedo| (form, albedo))).collect();
    let [low, high] = LAW_RADII;
    let title = format!("σR = a R^b, scale free, for radii of {low} to {high} mean free paths");
    let mut lines = Table::of("sphere_laws", &title, keys)
        .column("form", |(form, _)| form.name().to_owned())
        .column("albedo", |(_, albedo)| albedo.map_or("all".to_owned(), |albedo| albedo.to_string()));
    for (suffix, heading) in [("", "a, mean free paths"), (ALL_LIGHT, "of all light: a")] {
        let value = |(form, albedo): &(Form, Option<f64>), measure: &str| {
            report.value(&format!("{}{suffix}", form.name()), &of_albedo(*albedo), measure)
        };
        lines = lines
            .column(heading, |key| figure(value(key, "factor"), 2))
            .column("b", |key| figure(value(key, "exponent"), 2))
            .column("largest error of σ", |key| format!("{} %", figure(value(key, "worst").map(|w| 100.0 * w), 0)));
    }
    lines.note("")
}

fn choices(report: &Report) -> Table {
    let keys: Vec<(f64, [f64; 2])> =
        ALBEDOS.into_iter().flat_map(|albedo| RANGES.map(|radii| (albedo, radii))).collect();
    let both = |&(albedo, radii): &(f64, [f64; 2]), measure: &str, decimals: usize| {
        let shown = ScaleKind::ALL
            .map(|kind| figure(report.value(&rung(Form::Circular, kind), &range(albedo, radii), measure), decimals));
        shown.join(" / ")
    };
    let [sigma0, one, law, best, lambert] = CHOICES;
    Table::of("sphere_choices", "One σ₀ for a range of radii, scale free / fixed: RMS residuals over its spheres", keys)
        .column("albedo", |(albedo, _)| albedo.to_string())
        .column("radii", |(_, [low, high])| format!("{low} to {high}"))
        .column("σ₀", |key| both(key, sigma0, 1))
        .column("Lambert", |key| both(key, lambert, 3))
        .column("σ₀κ", |key| both(key, one, 3))
        .column("the law", |key| both(key, law, 3))
        .column("each sphere's own best", |key| both(key, best, 3))
        .note("")
}

/// Shows every fit.
fn fits(report: &Report) -> Table {
    let spheres: Vec<(f64, f64)> = profiles(report).iter().map(|sphere| (sphere.albedo, sphere.radius)).collect();
    let keys: Vec<(ScaleKind, f64, f64)> =
        ScaleKind::ALL.into_iter().flat_map(|kind| spheres.iter().map(move |&(a, r)| (kind, a, r))).collect();
    let mut lines = Table::of("sphere_fits", "Every fit to scattered light", keys)
        .column("scale", |(kind, ..)| if *kind == ScaleKind::Free { "free" } else { "fixed" }.to_owned())
        .column("albedo", |(_, albedo, _)| albedo.to_string())
        .column("radius", |(.., radius)| radius.to_string());
    for form in FORMS {
        let value = |&(kind, albedo, radius): &(ScaleKind, f64, f64), measure: &str| {
            figure(report.value(&rung(form, kind), &view(albedo, radius), measure), 4)
        };
        if form != Form::Lambert {
            lines = lines
                .column(format!("{}: sigma", form.name()), |key| value(key, "sigma"))
                .column("sigma R", |key| value(key, "sigma R"));
        }
        let heading = if form == Form::Lambert { "lambert: scale" } else { "scale" };
        lines = lines.column(heading, |key| value(key, "scale")).column("residual", |key| value(key, "residual"));
    }
    lines.note(
        "Radius and sigma R in mean free paths, sigma in radians; sigma R would be one number for an albedo if \
         sigma = sigma_0 kappa held.",
    )
}

/// Albedo of the spheres whose profiles are drawn.
const ALBEDO: f64 = 0.99;
/// Radii of the spheres whose profiles are drawn, in mean free paths.
const DRAWN: [f64; 3] = [2.0, 10.0, 50.0];

pub(super) fn plots(report: &Report) -> Vec<Plot> {
    vec![sigma(report), profile(report)]
}

/// Plots the width times radius against the radius, with a line for each albedo. The lines would be
/// level if sigma = sigma_0 kappa held.
fn sigma(report: &Report) -> Plot {
    let mut series = Vec::new();
    let law = |measure: &str| report.value(Form::Circular.name(), &of_albedo(None), measure);
    if let Some((factor, exponent)) = law("factor").zip(law("exponent")) {
        let line = LAW_RADII.map(|radius| (radius, factor * radius.powf(exponent)));
        series.push(Series::line(&format!("σR = {factor:.2} R^{exponent:.2}"), GREY, 6, line));
    }
    let circular = rung(Form::Circular, ScaleKind::Free);
    for (albedo, color) in ALBEDOS.into_iter().zip(COLORS) {
        let point_at = |radius: f64| Some((radius, report.value(&circular, &view(albedo, radius), "sigma R")?));
        // A zero cannot be shown on a logarithmic axis.
        let points = RADII.into_iter().filter_map(point_at).filter(|(_, width)| *width > 0.0);
        series.push(Series::line(&format!("albedo {albedo}"), color, 2, points).dotted());
    }
    series.retain(|series| !series.points.is_empty());
    Plot {
        file: "sphere_sigma.svg",
        caption: "Best width times radius: level lines, were σ = σ₀κ true".to_owned(),
        x: Axis::log("radius in mean free paths").with_ticks(RADII),
        y: Axis::log("σR in mean free paths, the circular form with a free scale")
            .with_ticks([2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 15.0, 20.0]),
        series,
    }
}

/// Plots exitance against the angle from the light, with the best circular form with a free scale and
/// Lambert's law.
fn profile(report: &Report) -> Plot {
    let curve = |value: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
        (0..=360).map(|half| 0.5 * f64::from(half)).map(|angle| (angle, value(angle.to_radians().cos()))).collect()
    };
    let mut series = Vec::new();
    if let Some(albedo) = report.value(WALKS, &view(ALBEDO, f64::INFINITY), "diffuse albedo") {
        let lambert = curve(&|cosine| albedo * cosine.max(0.0));
        series.push(Series::line("Lambert, the half space's albedo", GREY, 2, lambert));
    }
    let spheres = profiles(report);
    let spheres = DRAWN
        .iter()
        .filter_map(|radius| spheres.iter().find(|sphere| (sphere.albedo, sphere.radius) == (ALBEDO, *radius)));
    for (sphere, &color) in spheres.zip(&COLORS[1..]) {
        let fit = |measure: &str| {
            let view = view(sphere.albedo, sphere.radius);
            report.value(&rung(Form::Circular, ScaleKind::Free), &view, measure).unwrap_or(f64::NAN)
        };
        let [sigma, scale, residual] = ["sigma", "scale", "residual"].map(fit);
        let best = curve(&|cosine| scale * f64::from(cdrf::accurate(cosine as f32, sigma as f32)));
        let name = format!("R = {}: σ = {sigma:.3}, residual {residual:.3}", sphere.radius);
        series.push(Series::line(&name, color, 1, best));
        let angle = |bin: usize| 180.0 * (bin as f64 + 0.5) / BINS as f64;
        let points = (0..BINS).map(|bin| (angle(bin), sphere.exitance[bin]));
        series.push(Series::line("", color, 0, points).dotted());
        for bin in 0..BINS {
            let (value, error) = (sphere.exitance[bin], sphere.standard_error[bin]);
            series.push(Series::line("", color, 2, [value - error, value + error].map(|end| (angle(bin), end))));
        }
    }
    Plot {
        file: "sphere_profile.svg",
        caption: format!("Spheres of albedo {ALBEDO}: random walks and the best of the reflectance function"),
        x: Axis::linear("angle between the normal and the light, degrees", (0.0, 180.0)),
        y: Axis::linear("exitance over the irradiance square to the light", (0.0, 0.9)),
        series,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_reference::random_walk;

    #[test]
    fn plots_show_every_line() {
        let sphere = |albedo| DRAWN.map(|radius| random_walk::profile(radius, albedo, 2000, 1)).to_vec();
        let report = crate::sphere::report(2000, 1, &[sphere(ALBEDO), sphere(1.0)].concat());
        let [sigma, profile] = [sigma(&report), profile(&report)].map(|plot| plot.svg());
        for part in ["albedo 0.99", "albedo 1", "R^", "mean free paths"] {
            assert!(sigma.contains(part), "{part}");
        }
        for part in ["R = 2:", "R = 10:", "R = 50:", "Lambert"] {
            assert!(profile.contains(part), "{part}");
        }
        assert!(plots(&Report::default()).iter().all(Plot::is_empty));
        assert!(whole(&report).expect_err("a part").contains("albedo 0.8 and radius 2"));
    }
}
