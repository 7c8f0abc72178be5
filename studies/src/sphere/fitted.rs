//! The best fits of all forms to a sphere.

use super::form::Form;
use super::names::{FITS, FORMS, UNITS, rung};
use lapidary_ladders::Row;
use lapidary_ladders::cdrf::sphere_fit::{Fit, ScaleKind};
use lapidary_ladders::cdrf::spheres::view;
use lapidary_reference::random_walk::Profile;

/// The best fit of a form to a sphere.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub(super) albedo: f64,
    pub(super) radius: f64,
    pub(super) form: Form,
    pub(super) kind: ScaleKind,
    pub(super) fit: Fit,
    /// Standard error of the width times the radius; `None` if the walks do not determine a width.
    pub(super) error: Option<f64>,
}

impl Fitted {
    /// Returns the best fits of all forms and kinds of scale.
    pub(super) fn all(profile: &Profile) -> Vec<Self> {
        let &Profile { albedo, radius, .. } = profile;
        let fit_of = |kind: ScaleKind, form: Form| {
            let fixed = kind.of(albedo);
            let fit = form.best_fit(profile, fixed);
            let error = form.sigma_error(&fit, profile, fixed).map(|error| error * radius);
            Self { albedo, radius, form, kind, fit, error }
        };
        ScaleKind::ALL.into_iter().flat_map(|kind| FORMS.map(|form| fit_of(kind, form))).collect()
    }

    /// Returns the width times the radius in mean free paths.
    pub(super) fn sigma_radius(&self) -> f64 {
        self.fit.sigma * self.radius
    }

    pub(super) fn rows(&self, suffix: &str) -> [Row; FITS.len()] {
        let Fit { sigma, scale, residual } = self.fit;
        let values = [Some(sigma), Some(self.sigma_radius()), self.error, Some(scale), Some(residual)];
        let rung = rung(self.form, self.kind) + suffix;
        std::array::from_fn(|k| Row::new(&rung, &view(self.albedo, self.radius), FITS[k], values[k], UNITS[k]))
    }
}
