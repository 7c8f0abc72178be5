//! The spheres as text.

use super::Form;
use super::{FORMS, Row, ScaleKind, SphereReport};
use std::fmt::Write as _;

/// Returns a form's name.
pub(super) fn name(form: Form) -> &'static str {
    match form {
        Form::Lambert => "lambert",
        Form::Circular => "circular",
        Form::Spherical => "spherical",
    }
}

/// Formats width times radius with its standard error.
pub(super) fn width(row: &Row) -> String {
    let width = row.sigma_radius;
    row.sigma_radius_error.map_or_else(|| format!("{width:.3}"), |error| format!("{width:.3} ± {error:.3}"))
}

fn kind_name(kind: ScaleKind) -> &'static str {
    match kind {
        ScaleKind::Free => "free",
        ScaleKind::Fixed => "fixed",
    }
}

pub(super) fn text(report: &SphereReport) -> String {
    let mut text = format!(
        "Spheres in parallel light, index-matched, scattering to all sides alike: {} random walks each, seed {}\n",
        report.walks, report.seed
    );
    fits(&mut text, report);
    spheres(&mut text, report);
    rules(&mut text, report);
    unscattered(&mut text, report);
    text
}

fn fits(text: &mut String, report: &SphereReport) {
    for kind in ScaleKind::ALL {
        let what = match kind {
            ScaleKind::Free => "Scale free: each sphere has what brings a form nearest",
            ScaleKind::Fixed => "Scale fixed: the half space's diffuse albedo",
        };
        let _ = write!(text, "\n{what}\n{:6} {:>6} {:>8} {:>8}", "albedo", "radius", "lambert", "scale");
        for form in &FORMS[1..] {
            let _ =
                write!(text, " | {:9} {:>7} {:>7} {:>8} {:>8}", name(*form), "sigma", "sigma R", "scale", "residual");
        }
        text.push('\n');
        for lambert in report.rows.iter().filter(|row| row.form == Form::Lambert && row.scale_kind == kind) {
            let _ = write!(
                text,
                "{:6} {:>6} {:>8.4} {:>8.4}",
                lambert.albedo, lambert.radius, lambert.residual, lambert.scale
            );
            for form in &FORMS[1..] {
                if let Some(row) = report.row(lambert.albedo, lambert.radius, *form, kind) {
                    let _ = write!(
                        text,
                        " | {:9} {:>7.4} {:>7.3} {:>8.4} {:>8.4}",
                        "", row.sigma, row.sigma_radius, row.scale, row.residual
                    );
                }
            }
            text.push('\n');
        }
    }
    let _ = writeln!(
        text,
        "\nradius and sigma R in mean free paths, sigma in radians; sigma R would be one number for an albedo, were sigma = sigma_0 \
         kappa true.\nresidual: RMS over the sphere, over the irradiance of a surface that faces the light; lambert: that of the \
         clamped cosine, and its scale."
    );
}

fn spheres(text: &mut String, report: &SphereReport) {
    let _ = writeln!(
        text,
        "\nWhat spheres give back of the light on them, scattered; noise: what chance alone adds to a residual\n\
         {:6} {:>6} {:>8} {:>10} {:>8}",
        "albedo", "radius", "share", "half space", "noise"
    );
    for profile in &report.profiles {
        let limit = report.limits.iter().find(|limit| limit.albedo == profile.albedo);
        let _ = writeln!(
            text,
            "{:6} {:>6} {:>8.4} {:>10.4} {:>8.4}",
            profile.albedo,
            profile.radius,
            profile.whole(),
            limit.map_or(f64::NAN, |limit| limit.diffuse_albedo),
            profile.noise()
        );
    }
    let _ = writeln!(
        text,
        "\nInfinite radius, scale free\n{:6} {:>8} {:>8} {:>8}",
        "albedo", "lambert", "sigma", "residual"
    );
    for limit in &report.limits {
        let _ =
            writeln!(text, "{:6} {:>8.4} {:>8.4} {:>8.4}", limit.albedo, limit.lambert, limit.sigma, limit.residual);
    }
}

fn unscattered(text: &mut String, report: &SphereReport) {
    let _ = writeln!(
        text,
        "\nsigma R by the circular form, scale free, with the walks' standard errors: of scattered light, and of all, what went straight through \
         with it\n{:6} {:>6} {:>18} {:>18}",
        "albedo", "radius", "scattered", "all light"
    );
    let free = |row: &&Row| row.form == Form::Circular && row.scale_kind == ScaleKind::Free;
    let all = report.rows_with_unscattered.iter().filter(free);
    for (scattered, all) in report.rows.iter().filter(free).zip(all) {
        let _ = writeln!(
            text,
            "{:6} {:>6} {:>18} {:>18}",
            scattered.albedo,
            scattered.radius,
            width(scattered),
            width(all)
        );
    }
    for law in &report.laws_with_unscattered {
        let albedo = law.albedo.map_or("all".to_owned(), |albedo| albedo.to_string());
        let [low, high] = law.radii;
        let _ = writeln!(
            text,
            "all light, {albedo:4} {:9} {low}-{high}: sigma R = {:.3} R^{:.3}, {:.1}% off at worst",
            name(law.form),
            law.factor,
            law.exponent,
            100.0 * law.worst
        );
    }
}

fn rules(text: &mut String, report: &SphereReport) {
    let _ = writeln!(
        text,
        "\nsigma R = a R^b, scale free; worst: by how much a width is off\n{:6} {:9} {:>8} {:>6} {:>6} {:>6}",
        "albedo", "form", "radii", "a", "b", "worst"
    );
    for law in &report.laws {
        let albedo = law.albedo.map_or("all".to_owned(), |albedo| albedo.to_string());
        let [low, high] = law.radii;
        let _ = writeln!(
            text,
            "{albedo:6} {:9} {:>8} {:>6.3} {:>6.3} {:>5.1}%",
            name(law.form),
            format!("{low}-{high}"),
            law.factor,
            law.exponent,
            100.0 * law.worst
        );
    }
    let _ = writeln!(
        text,
        "\nOne sigma_0 for a range of radii: residuals in the root mean square over its spheres\n\
         {:6} {:9} {:5} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}",
        "albedo", "form", "scale", "radii", "sigma_0", "residual", "law", "own best", "lambert"
    );
    for choice in &report.choices {
        let [low, high] = choice.radii;
        let _ = writeln!(
            text,
            "{:6} {:9} {:5} {:>8} {:>8.3} {:>8.4} {:>8} {:>8.4} {:>8.4}",
            choice.albedo,
            name(choice.form),
            kind_name(choice.scale_kind),
            format!("{low}-{high}"),
            choice.sigma0,
            choice.residual,
            choice.law.map_or("-".to_owned(), |law| format!("{law:.4}")),
            choice.best,
            choice.lambert
        );
    }
}
