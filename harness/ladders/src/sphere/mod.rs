//! The translucent sphere: how close the curvature-dependent reflectance comes to random walks, and
//! with which width.

mod fit;
mod rule;
mod tables;

pub use fit::{Fit, Form};

use super::report::distinct;
use super::{Ladder, Progress, Report, Row};
use lapidary_reference::random_walk::{BINS, Profile, half_space, profile};

/// The ladder.
pub const LADDER: Ladder =
    Ladder { name: "sphere", tables: tables::tables, plots: tables::plots, whole: tables::whole };
/// Single-scattering albedos.
pub const ALBEDOS: [f64; 4] = [0.8, 0.9, 0.99, 1.0];
/// Radii in mean free paths.
pub const RADII: [f64; 10] = [2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0, 100.0];
/// The reflectance functions, the plain cosine first.
pub const FORMS: [Form; 3] = [Form::Lambert, Form::Circular, Form::Spherical];
/// The units of [`FITS`].
const UNITS: [&str; 5] = ["rad", "mean free paths", "mean free paths", "", ""];
/// The measures of a fit: the width in radians; the width times the radius in mean free paths, which
/// would be one number for an albedo if the paper's rule held; its standard error from the
/// statistics of the walks; the factor of the function; and the RMS difference over the sphere's
/// surface, divided by the irradiance of a surface that faces the light.
const FITS: [&str; 5] = ["sigma", "sigma R", "error of sigma R", "scale", "residual"];
/// The measures of a [`rule::Law`].
const LAWS: [&str; 3] = ["factor", "exponent", "worst"];
/// The measures of a [`rule::Choice`].
const CHOICES: [&str; 5] = ["sigma0", "one sigma0", "by the law", "own best", "lambert"];
/// Name of the walks themselves, whose measures are exitance and standard error by interval.
const WALKS: &str = "random walks";
/// Suffix of a rung that is fitted to all light, including unscattered light.
const ALL_LIGHT: &str = ", all light";

/// The factor of a reflectance function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScaleKind {
    /// The best-fit factor: a separate exposure for each sphere.
    Free,
    /// The diffuse albedo of the half space, which can be measured on a flat sample and is the
    /// limit for large spheres.
    Fixed,
}

impl ScaleKind {
    /// Both kinds.
    pub const ALL: [Self; 2] = [Self::Free, Self::Fixed];

    /// Returns the fixed factor for a single-scattering albedo; `None` if the factor is free.
    pub(super) fn of(self, albedo: f64) -> Option<f64> {
        (self == Self::Fixed).then(|| half_space::diffuse_albedo(albedo))
    }
}

/// Returns the name of a fitted form.
pub fn rung(form: Form, kind: ScaleKind) -> String {
    format!("{}, scale {}", form.name(), if kind == ScaleKind::Free { "free" } else { "fixed" })
}

/// Returns the name of a sphere; an infinite radius is the half space.
pub fn view(albedo: f64, radius: f64) -> String {
    format!("albedo {albedo}, R = {radius}")
}

/// Returns the name of a law's albedo; `None` is all of them.
fn of_albedo(albedo: Option<f64>) -> String {
    albedo.map_or("all albedos".to_owned(), |albedo| format!("albedo {albedo}"))
}

/// Returns the name of a range of radii.
fn range(albedo: f64, [low, high]: [f64; 2]) -> String {
    format!("albedo {albedo}, R = {low} to {high}")
}

/// The best fit of a form to a sphere.
#[derive(Clone, Debug)]
struct Fitted {
    albedo: f64,
    radius: f64,
    form: Form,
    kind: ScaleKind,
    fit: Fit,
    /// Standard error of the width times the radius; `None` if the walks do not determine a width.
    error: Option<f64>,
}

impl Fitted {
    /// Returns the best fits of all forms and kinds of scale.
    fn all(profile: &Profile) -> Vec<Self> {
        let &Profile { albedo, radius, .. } = profile;
        let of = |kind: ScaleKind, form: Form| {
            let fixed = kind.of(albedo);
            let fit = Fit::best(profile, form, fixed);
            let error = fit.sigma_error(profile, form, fixed).map(|error| error * radius);
            Self { albedo, radius, form, kind, fit, error }
        };
        ScaleKind::ALL.into_iter().flat_map(|kind| FORMS.map(|form| of(kind, form))).collect()
    }

    /// Returns the width times the radius in mean free paths.
    fn sigma_radius(&self) -> f64 {
        self.fit.sigma * self.radius
    }

    fn rows(&self, suffix: &str) -> [Row; FITS.len()] {
        let Fit { sigma, scale, residual } = self.fit;
        let values = [Some(sigma), Some(self.sigma_radius()), self.error, Some(scale), Some(residual)];
        let rung = rung(self.form, self.kind) + suffix;
        std::array::from_fn(|k| Row::new(&rung, &view(self.albedo, self.radius), FITS[k], values[k], UNITS[k]))
    }
}

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
    let mut report = Report::new(LADDER.name, "random walks on the CPU".to_owned(), &settings);
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
    let [lambert, circular] = [Form::Lambert, Form::Circular].map(|form| Fit::best(&profile, form, None));
    let row =
        |form, measure, value| Row::new(&rung(form, ScaleKind::Free), &view(albedo, f64::INFINITY), measure, value, "");
    [
        Row::new(WALKS, &view(albedo, f64::INFINITY), "diffuse albedo", profile.whole(), ""),
        row(Form::Lambert, "residual", lambert.residual),
        Row { unit: UNITS[0].to_owned(), ..row(Form::Circular, "sigma", circular.sigma) },
        row(Form::Circular, "residual", circular.residual),
    ]
}

/// Returns the spheres of a report that have a value for each interval.
pub fn profiles(report: &Report) -> Vec<Profile> {
    let views = distinct(report.rows.iter().filter(|row| row.rung == WALKS).map(|row| row.view.as_str()));
    let values = |view: &str, measure: &str| -> Option<[f64; BINS]> {
        let own = report.rows.iter().filter(|row| row.rung == WALKS && row.view == view);
        let found: Vec<&Row> = own.filter(|row| row.measure.starts_with(measure)).collect();
        let value = |bin: usize| found.iter().find(|row| row.measure == format!("{measure} {bin}"))?.value;
        let values: Option<Vec<f64>> = (0..BINS).map(value).collect();
        values?.try_into().ok()
    };
    let profile = |view: &str| {
        let (albedo, radius) = view.strip_prefix("albedo ")?.split_once(", R = ")?;
        let (albedo, radius) = (albedo.parse().ok()?, radius.parse().ok()?);
        let (exitance, standard_error) = (values(view, "exitance")?, values(view, "standard error")?);
        Some(Profile { albedo, radius, exitance, standard_error })
    };
    views.into_iter().filter_map(profile).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let of = |measure: &str| values(&report, &rung(form, kind), measure);
            let (scales, widths) = (of("scale"), of("sigma R"));
            assert!(scales.len() == SMALL.len() && widths.len() == SMALL.len(), "{form:?} {kind:?}");
            for ((scale, width), (sigma, radius)) in scales.iter().zip(widths).zip(of("sigma").iter().zip(SMALL)) {
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
        let at = report.rows.iter().position(|row| row.measure == "exitance 7").expect("a row");
        report.rows.remove(at);
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
        let of = |measure: &str| values(&report, &rung(Form::Circular, ScaleKind::Free), measure);
        // Smaller spheres are wider: that much is true.
        assert!(of("sigma").windows(2).all(|pair| pair[0] > pair[1]), "{:?}", of("sigma"));
        let widths = of("sigma R");
        assert!(widths.windows(2).all(|pair| pair[0] < pair[1]), "{widths:?}");
        assert!((2.2..2.9).contains(&(widths[4] / widths[0])), "{widths:?}");
    }
}
