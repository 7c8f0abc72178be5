//! Simulates spheres, and fits forms, laws and rules to them.

use super::fitted::Fitted;
use super::form::Form;
use super::names::{ALBEDOS, ALL_LIGHT, RADII, UNITS, rung};
use super::rule;
use lapidary_ladders::cdrf::sphere_fit::ScaleKind;
use lapidary_ladders::cdrf::spheres::{NAME, WALKS, view};
use lapidary_ladders::report::distinct;
use lapidary_ladders::{Progress, Report, Row};
use lapidary_reference::random_walk::{BINS, Profile, half_space, profile};

/// Simulates spheres of all [`RADII`] and [`ALBEDOS`] and fits them.
pub fn run(walks: u64, seed: u64, progress: Progress<'_>) -> Report {
    let total = (ALBEDOS.len() * RADII.len()) as u64;
    let mut profiles = Vec::new();
    for albedo in ALBEDOS {
        for radius in RADII {
            let number = profiles.len() as u64;
            progress("walking", number, total);
            // Each sphere has its own seed, so that the noise of different spheres is independent.
            profiles.push(profile(radius, albedo, walks, seed.wrapping_add(number)));
        }
    }
    progress("fitting", total, total);
    report(walks, seed, &profiles)
}

/// Fits the profiles from random walks: forms to each sphere, laws for the width to all, and one
/// width times radius to ranges of radii.
pub fn report(walks: u64, seed: u64, profiles: &[Profile]) -> Report {
    let settings = [("walks", walks), ("seed", seed)];
    let mut report = Report::new(NAME, "random walks on the CPU".to_owned(), &settings);
    for profile in profiles {
        let view = view(profile.albedo, profile.radius);
        for bin in 0..BINS {
            let row = |measure: &str, value: f64| Row::new(WALKS, &view, &format!("{measure} {bin}"), value, "");
            report.rows.push(row("exitance", profile.exitance[bin]));
            report.rows.push(row("standard error", profile.standard_error[bin]));
        }
    }
    let albedos = distinct(profiles.iter().map(|profile| profile.albedo));
    for (suffix, unscattered) in [("", false), (ALL_LIGHT, true)] {
        let seen = |profile: &Profile| if unscattered { profile.with_unscattered() } else { profile.clone() };
        let fitted: Vec<Fitted> = profiles.iter().flat_map(|profile| Fitted::all(&seen(profile))).collect();
        report.rows.extend(fitted.iter().flat_map(|fitted| fitted.rows(suffix)));
        let laws = rule::laws(&albedos, &fitted);
        report.rows.extend(laws.iter().flat_map(|law| law.rows(suffix)));
        if !unscattered {
            let choices = albedos.iter().flat_map(|&albedo| rule::choices(albedo, profiles, &fitted, &laws));
            report.rows.extend(choices.flat_map(|choice| choice.rows()));
        }
    }
    report.rows.extend(albedos.iter().flat_map(|&albedo| limit(albedo)));
    report
}

/// Returns the limit of an infinite radius, where nothing is left to blur, from the closed form. The
/// best-fit width is not 0, although nothing is blurred: a half space does not follow Lambert's law.
fn limit(albedo: f64) -> [Row; 4] {
    let profile = half_space::profile(albedo);
    let [lambert, circular] = [Form::Lambert, Form::Circular].map(|form| form.best_fit(&profile, None));
    let row =
        |form, measure, value| Row::new(&rung(form, ScaleKind::Free), &view(albedo, f64::INFINITY), measure, value, "");
    [
        Row::new(WALKS, &view(albedo, f64::INFINITY), "diffuse albedo", profile.whole(), ""),
        row(Form::Lambert, "residual", lambert.residual),
        Row { unit: UNITS[0].to_owned(), ..row(Form::Circular, "sigma", circular.sigma) },
        row(Form::Circular, "residual", circular.residual),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::LADDER;
    use crate::sphere::names::FORMS;
    use lapidary_ladders::cdrf::spheres::profiles;

    const SMALL: [f64; 5] = [2.0, 5.0, 10.0, 20.0, 50.0];

    fn report() -> Report {
        let profiles = SMALL.map(|radius| profile(radius, 0.99, 20_000, radius as u64));
        super::report(20_000, 1, &profiles)
    }

    /// Returns a measure of all spheres.
    fn values(report: &Report, rung: &str, measure: &str) -> Vec<f64> {
        SMALL.iter().filter_map(|&radius| report.value(rung, &view(0.99, radius), measure)).collect()
    }

    #[test]
    fn every_sphere_has_each_form_and_scale_once() {
        let report = report();
        for (form, kind) in FORMS.into_iter().flat_map(|form| ScaleKind::ALL.map(|kind| (form, kind))) {
            let column = |measure: &str| values(&report, &rung(form, kind), measure);
            let (scales, widths) = (column("scale"), column("sigma R"));
            assert!(scales.len() == SMALL.len() && widths.len() == SMALL.len(), "{form:?} {kind:?}");
            for ((scale, width), (sigma, radius)) in scales.iter().zip(widths).zip(column("sigma").iter().zip(SMALL)) {
                assert_eq!(width, sigma * radius);
                // Chandrasekhar's diffuse albedo for this single-scattering albedo.
                assert_eq!((scale - 0.794564).abs() < 6e-7, kind == ScaleKind::Fixed, "{form:?} {scale}");
            }
        }
    }

    #[test]
    fn more_freedom_leaves_less_over() {
        let report = report();
        let residuals = |form, kind| values(&report, &rung(form, kind), "residual");
        for form in FORMS {
            let (free, fixed) = (residuals(form, ScaleKind::Free), residuals(form, ScaleKind::Fixed));
            assert!(free.iter().zip(&fixed).all(|(free, fixed)| *free <= fixed + 1e-9), "{form:?} {free:?} {fixed:?}");
            for kind in ScaleKind::ALL {
                let (found, lambert) = (residuals(form, kind), residuals(Form::Lambert, kind));
                assert!(found.iter().zip(&lambert).all(|(found, lambert)| found <= lambert), "{form:?} {kind:?}");
            }
        }
        // For a small sphere the width improves the fit a lot.
        let [found, lambert] = [Form::Circular, Form::Lambert].map(|form| residuals(form, ScaleKind::Free)[0]);
        assert!(5.0 * found < lambert, "{found} {lambert}");
    }

    #[test]
    fn the_spheres_of_a_report_survive_its_json() {
        let report = report();
        let again = Report::from_json(LADDER.name, &report.json().expect("JSON")).expect("a report");
        assert_eq!(LADDER.text(&again), LADDER.text(&report));
        let found = profiles(&again);
        assert_eq!(found.iter().map(|profile| profile.radius).collect::<Vec<_>>(), SMALL);
        for (found, radius) in found.iter().zip(SMALL) {
            let walked = profile(radius, 0.99, 20_000, radius as u64);
            for bin in 0..BINS {
                assert!((found.exitance[bin] - walked.exitance[bin]).abs() < 1e-15);
                assert!((found.standard_error[bin] - walked.standard_error[bin]).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_sphere_with_a_missing_interval_is_not_taken_for_another() {
        let mut report = report();
        let place = report.rows.iter().position(|row| row.measure == "exitance 7").expect("a row");
        report.rows.remove(place);
        let radii: Vec<f64> = profiles(&report).iter().map(|profile| profile.radius).collect();
        assert_eq!(radii, SMALL[1..]);
    }

    /// With unscattered light a small sphere needs a wider function; a large one, through which no
    /// light passes unscattered, does not.
    #[test]
    fn what_goes_straight_through_widens_small_spheres_alone() {
        let report = report();
        let circular = rung(Form::Circular, ScaleKind::Free);
        let scattered = values(&report, &circular, "sigma R");
        let all = values(&report, &(circular + ALL_LIGHT), "sigma R");
        assert_eq!((scattered.len(), all.len()), (5, 5));
        assert!(all[0] > 1.1 * scattered[0] && (all[4] / scattered[4] - 1.0).abs() < 0.02, "{scattered:?} {all:?}");
    }

    /// If sigma = sigma_0 / R held, sigma R would be the same for all radii of a material. It is
    /// not.
    #[test]
    fn the_best_width_is_not_inverse_to_the_radius() {
        let report = report();
        let column = |measure: &str| values(&report, &rung(Form::Circular, ScaleKind::Free), measure);
        // Smaller spheres are wider: that much is true.
        assert!(column("sigma").windows(2).all(|pair| pair[0] > pair[1]), "{:?}", column("sigma"));
        let widths = column("sigma R");
        assert!(widths.windows(2).all(|pair| pair[0] < pair[1]), "{widths:?}");
        assert!((2.2..2.9).contains(&(widths[4] / widths[0])), "{widths:?}");
    }
}
