//! The spheres, and the names of what is fitted and measured.

use super::form::Form;
use lapidary_ladders::cdrf::sphere_fit::ScaleKind;

/// Single-scattering albedos.
pub const ALBEDOS: [f64; 4] = [0.8, 0.9, 0.99, 1.0];
/// Radii in mean free paths.
pub const RADII: [f64; 10] = [2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0, 100.0];
/// The reflectance functions, the plain cosine first.
pub const FORMS: [Form; 3] = [Form::Lambert, Form::Circular, Form::Spherical];
/// The units of [`FITS`].
pub(super) const UNITS: [&str; 5] = ["rad", "mean free paths", "mean free paths", "", ""];
/// The measures of a fit: the width in radians; the width times the radius in mean free paths, which
/// would be one number for an albedo if the paper's rule held; its standard error from the
/// statistics of the walks; the factor of the function; and the RMS difference over the sphere's
/// surface, divided by the irradiance of a surface that faces the light.
pub(super) const FITS: [&str; 5] = ["sigma", "sigma R", "error of sigma R", "scale", "residual"];
/// The measures of a [`Law`](super::rule::Law).
pub(super) const LAWS: [&str; 3] = ["factor", "exponent", "worst"];
/// The measures of a [`Choice`](super::rule::Choice).
pub(super) const CHOICES: [&str; 5] = ["sigma0", "one sigma0", "by the law", "own best", "lambert"];
/// Suffix of a rung that is fitted to all light, including unscattered light.
pub(super) const ALL_LIGHT: &str = ", all light";

/// Returns the name of a fitted form.
pub fn rung(form: Form, kind: ScaleKind) -> String {
    format!("{}, scale {}", form.name(), if kind == ScaleKind::Free { "free" } else { "fixed" })
}

/// Returns the name of a law's albedo; `None` is all of them.
pub(super) fn of_albedo(albedo: Option<f64>) -> String {
    albedo.map_or("all albedos".to_owned(), |albedo| format!("albedo {albedo}"))
}

/// Returns the name of a range of radii.
pub(super) fn range(albedo: f64, [low, high]: [f64; 2]) -> String {
    format!("albedo {albedo}, R = {low} to {high}")
}
