//! The spheres' tables for the pages of `docs/`.

use super::Form;
use super::{ALBEDOS, Choice, FORMS, Law, RADII, Row, ScaleKind, SphereReport, table};
use crate::cost::page::{Table, Tables, header, row};

/// The radii shown in the table of residuals, in mean free paths.
const SHOWN: [f64; 6] = [2.0, 5.0, 10.0, 20.0, 50.0, 100.0];

impl Tables for SphereReport {
    const TABLES: &'static [Table<Self>] = &[
        ("sphere_walks", walks),
        ("sphere_widths", |report| widths(&|albedo| report.best(albedo, Form::Circular, ScaleKind::Free).collect())),
        ("sphere_widths_with_unscattered", |report| {
            widths(&|albedo| report.best_with_unscattered(albedo, Form::Circular, ScaleKind::Free).collect())
        }),
        ("sphere_residuals", residuals),
        ("sphere_albedos", albedos),
        ("sphere_laws", laws),
        ("sphere_choices", choices),
    ];

    fn whole(&self) -> Result<(), String> {
        for albedo in ALBEDOS {
            for radius in RADII {
                let fitted = FORMS
                    .into_iter()
                    .all(|form| ScaleKind::ALL.iter().all(|kind| self.row(albedo, radius, form, *kind).is_some()));
                if self.profile(albedo, radius).is_none() || !fitted {
                    return Err(format!(
                        "the report has no sphere of albedo {albedo} and radius {radius}, or not its fits; only all \
                         spheres fill a page"
                    ));
                }
            }
        }
        Ok(())
    }
}

/// Returns a header with a column per radius between the first and the last columns.
fn radii(first: &[&str], radii: &[f64], last: &[&str]) -> String {
    let mut columns: Vec<String> = first.iter().map(|&name| name.to_owned()).collect();
    columns.extend(radii.iter().enumerate().map(|(k, r)| if k == 0 { format!("R = {r}") } else { r.to_string() }));
    columns.extend(last.iter().map(|&name| name.to_owned()));
    header(&columns.iter().map(String::as_str).collect::<Vec<_>>())
}

fn walks(report: &SphereReport) -> String {
    let noises = report.profiles.iter().map(|profile| profile.noise());
    let most = noises.fold(0.0, f64::max);
    format!("{} walks each; chance alone leaves a residual of at most {most:.4}.\n", report.walks)
}

/// Returns the widths times radii from the rows of each albedo.
fn widths<'a>(rows: &dyn Fn(f64) -> Vec<&'a Row>) -> String {
    let mut table = radii(&["albedo"], &RADII, &["largest over least, to 20", "to 100"]);
    for albedo in ALBEDOS {
        let found = rows(albedo);
        let drift = |to: f64| {
            let inside = found.iter().filter(|row| row.radius <= to).map(|row| row.sigma_radius);
            inside.clone().fold(0.0, f64::max) / inside.fold(f64::INFINITY, f64::min)
        };
        let mut cells = vec![albedo.to_string()];
        cells.extend(found.iter().map(|row| table::width(row)));
        cells.extend([20.0, 100.0].map(|to| format!("{:.1}", drift(to))));
        row(&mut table, &cells);
    }
    table
}

fn residuals(report: &SphereReport) -> String {
    let mut table = radii(&["albedo", "form"], &SHOWN, &["∞"]);
    for albedo in ALBEDOS {
        let limit = report.limits.iter().find(|limit| limit.albedo == albedo);
        for form in FORMS {
            let mut cells = vec![albedo.to_string(), table::name(form).to_owned()];
            cells.extend(SHOWN.map(|radius| {
                let shown = ScaleKind::ALL.map(|kind| {
                    let row = report.row(albedo, radius, form, kind);
                    row.map_or("-".to_owned(), |row| format!("{:.3}", row.residual))
                });
                shown.join(" / ")
            }));
            cells.push(match (form, limit) {
                (Form::Lambert, Some(limit)) => format!("{:.3}", limit.lambert),
                (Form::Circular, Some(limit)) => format!("{:.3}", limit.residual),
                _ => String::new(),
            });
            row(&mut table, &cells);
        }
    }
    table
}

fn albedos(report: &SphereReport) -> String {
    let mut table = radii(&["albedo"], &RADII, &["half space"]);
    for albedo in ALBEDOS {
        let mut cells = vec![albedo.to_string()];
        cells.extend(RADII.map(|radius| {
            report.profile(albedo, radius).map_or("-".to_owned(), |profile| format!("{:.3}", profile.whole()))
        }));
        let limit = report.limits.iter().find(|limit| limit.albedo == albedo);
        cells.push(limit.map_or("-".to_owned(), |limit| format!("{:.3}", limit.diffuse_albedo)));
        row(&mut table, &cells);
    }
    table
}

fn laws(report: &SphereReport) -> String {
    let columns = [
        "form",
        "albedo",
        "a, mean free paths",
        "b",
        "largest error of σ",
        "of all light: a",
        "b",
        "largest error of σ",
    ];
    let mut table = header(&columns);
    for form in [Form::Circular, Form::Spherical] {
        for law in report.laws.iter().filter(|law| law.form == form) {
            let mut cells =
                vec![table::name(form).to_owned(), law.albedo.map_or("all".to_owned(), |albedo| albedo.to_string())];
            let same = |other: &&Law| (other.form, other.albedo) == (law.form, law.albedo);
            for law in [Some(law), report.laws_with_unscattered.iter().find(same)] {
                cells.extend(law.map_or(["-"; 3].map(str::to_owned), |law| {
                    let Law { factor, exponent, worst, .. } = law;
                    [format!("{factor:.2}"), format!("{exponent:.2}"), format!("{:.0} %", 100.0 * worst)]
                }));
            }
            row(&mut table, &cells);
        }
    }
    table
}

fn choices(report: &SphereReport) -> String {
    let columns = ["albedo", "radii", "σ₀", "Lambert", "σ₀κ", "the law", "each sphere's own best"];
    let mut table = header(&columns);
    for free in report.choices.iter().filter(|choice| choice.form == Form::Circular) {
        if free.scale_kind != ScaleKind::Free {
            continue;
        }
        let same = |choice: &&Choice| {
            (choice.albedo, choice.form, choice.radii) == (free.albedo, free.form, free.radii)
                && choice.scale_kind == ScaleKind::Fixed
        };
        let fixed = report.choices.iter().find(same);
        let both = |shown: &dyn Fn(&Choice) -> String| {
            fixed.map_or(shown(free), |fixed| format!("{} / {}", shown(free), shown(fixed)))
        };
        let [low, high] = free.radii;
        let cells = [
            free.albedo.to_string(),
            format!("{low} to {high}"),
            both(&|choice| format!("{:.1}", choice.sigma0)),
            both(&|choice| format!("{:.3}", choice.lambert)),
            both(&|choice| format!("{:.3}", choice.residual)),
            both(&|choice| choice.law.map_or("-".to_owned(), |law| format!("{law:.3}"))),
            both(&|choice| format!("{:.3}", choice.best)),
        ];
        row(&mut table, &cells);
    }
    table
}
