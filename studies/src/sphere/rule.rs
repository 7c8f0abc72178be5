//! Rules for the width: how it depends on the radius, and what a single width times radius costs.

use super::fitted::Fitted;
use super::form::Form;
use super::names::{CHOICES, LAWS, of_albedo, range, rung};
use lapidary_ladders::Row;
use lapidary_ladders::cdrf::sphere_fit::{ScaleKind, best_sigma};
use lapidary_reference::random_walk::Profile;

/// Range of radii that the laws are fitted to: larger spheres are so close to Lambert's law that
/// the width hardly matters.
pub const LAW_RADII: [f64; 2] = [2.0, 20.0];
/// Ranges of radii, each with its own choice of width times radius.
pub const RANGES: [[f64; 2]; 3] = [[2.0, 5.0], [5.0, 20.0], [20.0, 100.0]];
/// The forms that have a width.
const WIDE: [Form; 2] = [Form::Circular, Form::Spherical];

/// A law sigma R = factor R^exponent: the least-squares line through the logarithms of the best
/// widths with free scales.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// The form whose width the law gives.
    pub form: Form,
    /// Single-scattering albedo; `None` if the law is for all albedos.
    pub albedo: Option<f64>,
    /// sigma R at a radius of one, in mean free paths.
    pub factor: f64,
    /// Exponent of the radius; 0 if sigma = sigma_0 / R held.
    pub exponent: f64,
    /// Largest relative error of the law's width.
    pub worst: f64,
}

impl Law {
    /// Returns the law's rows.
    pub(super) fn rows(&self, suffix: &str) -> [Row; LAWS.len()] {
        let values = [self.factor, self.exponent, self.worst];
        let rung = format!("{}{suffix}", self.form.name());
        std::array::from_fn(|k| Row::new(&rung, &of_albedo(self.albedo), LAWS[k], values[k], ""))
    }

    /// Returns the width in radians for a radius in mean free paths.
    pub fn sigma(&self, radius: f64) -> f64 {
        self.factor * radius.powf(self.exponent - 1.0)
    }
}

/// One width times radius for a range of radii. Residuals are root mean squares over the range's
/// spheres.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Single-scattering albedo.
    pub albedo: f64,
    /// The fitted reflectance function.
    pub form: Form,
    /// Whether each sphere has its own best-fit scale.
    pub kind: ScaleKind,
    /// The smallest and the largest radius in mean free paths.
    pub radii: [f64; 2],
    /// Width times radius with the smallest residual, in mean free paths.
    pub sigma0: f64,
    /// Residual with `sigma0`.
    pub residual: f64,
    /// Residual with the law for all albedos; `None` if there is no law.
    pub law: Option<f64>,
    /// Residual with each sphere's own best width.
    pub best: f64,
    /// Residual with a width of zero.
    pub lambert: f64,
}

impl Choice {
    /// Returns the choice's rows.
    pub(super) fn rows(&self) -> [Row; CHOICES.len()] {
        let values = [Some(self.sigma0), Some(self.residual), self.law, Some(self.best), Some(self.lambert)];
        let (rung, view) = (rung(self.form, self.kind), range(self.albedo, self.radii));
        std::array::from_fn(|k| Row::new(&rung, &view, CHOICES[k], values[k], ""))
    }
}

/// Returns each form's laws: for all albedos together, and for each one.
pub(super) fn laws(albedos: &[f64], fits: &[Fitted]) -> Vec<Law> {
    let kinds = std::iter::once(None).chain(albedos.iter().copied().map(Some));
    let each = kinds.flat_map(|albedo| WIDE.map(|form| (form, albedo)));
    each.filter_map(|(form, albedo)| law(form, albedo, fits)).collect()
}

fn law(form: Form, albedo: Option<f64>, fits: &[Fitted]) -> Option<Law> {
    let [low, high] = LAW_RADII;
    let of_law = |fitted: &&Fitted| {
        fitted.form == form
            && fitted.kind == ScaleKind::Free
            && albedo.is_none_or(|albedo| fitted.albedo == albedo)
            && (low..=high).contains(&fitted.radius)
            && fitted.fit.sigma > 0.0
    };
    let points: Vec<[f64; 2]> =
        fits.iter().filter(of_law).map(|fitted| [fitted.radius.ln(), fitted.sigma_radius().ln()]).collect();
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
    let middle = [mean(0), mean(1)];
    let moment =
        |axis: usize| points.iter().map(|point| (point[0] - middle[0]) * (point[axis] - middle[axis])).sum::<f64>();
    let spread = moment(0);
    // A law needs at least two radii: with one the spread is 0, with none it is not a number.
    if spread.is_nan() || spread < 1e-9 {
        return None;
    }
    let exponent = moment(1) / spread;
    let factor = (middle[1] - exponent * middle[0]).exp();
    let off = |[radius, width]: &[f64; 2]| (factor.ln() + exponent * radius - width).exp_m1().abs();
    let worst = points.iter().map(off).fold(0.0, f64::max);
    Some(Law { form, albedo, factor, exponent, worst })
}

/// Returns the choices for an albedo, for each range that contains spheres.
pub(super) fn choices(albedo: f64, profiles: &[Profile], fits: &[Fitted], laws: &[Law]) -> Vec<Choice> {
    let mut found = Vec::new();
    for radii @ [low, high] in RANGES {
        let inside = |radius: f64| (low..=high).contains(&radius);
        let spheres: Vec<&Profile> =
            profiles.iter().filter(|profile| profile.albedo == albedo && inside(profile.radius)).collect();
        if spheres.is_empty() {
            continue;
        }
        let mean = |squares: f64| (squares / spheres.len() as f64).sqrt();
        for kind in ScaleKind::ALL {
            let scale = kind.of(albedo);
            for form in WIDE {
                let with = |sigma: &dyn Fn(f64) -> f64| {
                    let residual = |sphere: &&Profile| form.fit(sphere, sigma(sphere.radius), scale).residual;
                    mean(spheres.iter().map(|sphere| residual(sphere).powi(2)).sum())
                };
                let mean_of = |form| {
                    let same =
                        |fit: &&Fitted| (fit.albedo, fit.form, fit.kind) == (albedo, form, kind) && inside(fit.radius);
                    mean(fits.iter().filter(same).map(|fitted| fitted.fit.residual.powi(2)).sum())
                };
                // Searched for as the width at the centre of the range.
                let middle = (low * high).sqrt();
                let sigma0 = middle * best_sigma(|sigma| with(&|radius| sigma * middle / radius));
                let law = laws.iter().find(|law| law.form == form && law.albedo.is_none());
                found.push(Choice {
                    albedo,
                    form,
                    kind,
                    radii,
                    sigma0,
                    residual: with(&|radius| sigma0 / radius),
                    law: law.map(|law| with(&|radius| law.sigma(radius))),
                    best: mean_of(form),
                    lambert: mean_of(Form::Lambert),
                });
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_ladders::cdrf::sphere_fit::Fit;

    /// Returns fits whose widths follow a law, except one.
    fn fits(factor: f64, exponent: f64, off: f64) -> Vec<Fitted> {
        let fitted = |radius: f64| {
            let law = factor * f64::powf(radius, exponent - 1.0);
            // The law does not apply to a large sphere.
            let sigma = if radius > 20.0 { 3.0 * law } else { law };
            let (form, kind) = (Form::Circular, ScaleKind::Free);
            Fitted { albedo: 0.9, radius, form, kind, fit: Fit { sigma, scale: 1.0, residual: 0.0 }, error: None }
        };
        let mut fits: Vec<Fitted> = [2.0, 5.0, 12.0, 20.0, 50.0].map(fitted).to_vec();
        fits[1].fit.sigma *= 1.0 + off;
        fits
    }

    #[test]
    fn a_law_is_found_again() {
        let found = laws(&[0.9], &fits(1.7, 0.4, 0.0));
        assert_eq!(found.len(), 2, "one for all albedos, one for its own: {found:?}");
        for law in &found {
            assert!((law.factor - 1.7).abs() < 1e-9 && (law.exponent - 0.4).abs() < 1e-9, "{law:?}");
            assert!(law.worst < 1e-9 && (law.sigma(4.0) * 4.0 / (1.7 * 4f64.powf(0.4)) - 1.0).abs() < 1e-9, "{law:?}");
        }
        let rough = &laws(&[0.9], &fits(1.7, 0.4, 0.1))[0];
        assert!((0.05..0.1).contains(&rough.worst), "{rough:?}");
        assert!(laws(&[0.9], &fits(1.7, 0.4, 0.0)[..1]).is_empty() && laws(&[0.9], &[]).is_empty());
    }

    /// Spheres that obey sigma = sigma_0 / R are fitted without loss.
    #[test]
    fn a_rule_that_is_true_costs_nothing() {
        let sphere = |radius: f64| {
            let exitance = std::array::from_fn(|bin| {
                0.6 * Profile::mean(bin, |cosine| lapidary_cdrf::oracle::accurate(cosine, 3.0 / radius))
            });
            Profile { radius, albedo: 0.9, exitance, standard_error: exitance }
        };
        let spheres = [5.0, 10.0, 20.0].map(sphere);
        let fits: Vec<Fitted> = spheres.iter().flat_map(Fitted::all).collect();
        let found = choices(0.9, &spheres, &fits, &[]);
        // The first range contains only the radius 5, the last one only 20.
        assert_eq!(found.len(), 3 * 4);
        for choice in found.iter().filter(|choice| choice.radii == [5.0, 20.0]) {
            assert!(choice.best <= choice.residual + 1e-9 && choice.residual < choice.lambert, "{choice:?}");
            if choice.form == Form::Circular && choice.kind == ScaleKind::Free {
                assert!((choice.sigma0 - 3.0).abs() < 3e-3 && choice.residual < 1e-5, "{choice:?}");
            } else {
                assert!(choice.residual > 1e-4, "{choice:?}");
            }
        }
    }
}
