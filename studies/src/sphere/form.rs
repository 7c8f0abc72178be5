//! Reflectance functions, fitted to the exitance of a sphere.

use lapidary_cdrf as cdrf;
use lapidary_ladders::cdrf::sphere_fit::Fit;
use lapidary_reference::random_walk::{BINS, Profile};

/// A reflectance function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The clamped cosine itself, independent of the width.
    Lambert,
    /// The paper's form: convolved on the circle.
    Circular,
    /// Diffused over the sphere, which adds no light.
    Spherical,
}

impl Form {
    /// Returns the form's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lambert => "lambert",
            Self::Circular => "circular",
            Self::Spherical => "spherical",
        }
    }

    fn value(self, cosine: f64, sigma: f64) -> f64 {
        // The mirror is accurate enough: its error, 1.5e-6, is a thousandth of a fit's residual. It
        // also has to be fast, since a fit evaluates tens of thousands of values.
        let function = match self {
            Self::Lambert => return cosine.max(0.0),
            Self::Circular => cdrf::accurate,
            Self::Spherical => cdrf::spherical,
        };
        f64::from(function(cosine as f32, sigma as f32))
    }

    /// Returns the form with width `sigma` and factor `scale`, fitted to a sphere; `None` is the best-fit factor.
    pub fn fit(self, profile: &Profile, sigma: f64, scale: Option<f64>) -> Fit {
        Fit::of(profile, |cosine, sigma| self.value(cosine, sigma), sigma, scale)
    }

    /// Returns the form with the best-fit width; the scale is as in [`Form::fit`].
    pub fn best_fit(self, profile: &Profile, scale: Option<f64>) -> Fit {
        if self == Self::Lambert {
            return self.fit(profile, 0.0, scale);
        }
        Fit::best_of(profile, |cosine, sigma| self.value(cosine, sigma), scale)
    }

    /// Returns the standard error of a best fit's width due to the profile's statistics; `None`
    /// if the profile does not determine a width.
    ///
    /// At the best fit the gradient of the sum of squares F vanishes, so that the change of its
    /// parameters p with a value y of the profile follows from the implicit function theorem: dp/dy
    /// = -(d²F/dp²)⁻¹ d²F/dp dy. The misfit's part of the second derivatives is kept, since the
    /// forms do not match the profile exactly. Counts of walks are multinomial; the covariances
    /// between intervals, -p q per walk, are neglected. With a free scale the variance is exactly
    /// that of counts without the factors 1 - p of coin tosses, and no interval holds more than a
    /// tenth of the walks, so the error is underestimated by at most a twentieth.
    pub fn sigma_error(self, fit: &Fit, profile: &Profile, scale: Option<f64>) -> Option<f64> {
        let values = |sigma: f64| -> [f64; BINS] {
            std::array::from_fn(|bin| Profile::mean(bin, |cosine| self.value(cosine, sigma)))
        };
        // The mirror's rounding, 1e-7, divided by the square of the step is well below the second
        // derivative.
        let step = (0.05 * fit.sigma).max(2e-3);
        if fit.sigma <= step {
            return None;
        }
        let [below, middle, above] = [fit.sigma - step, fit.sigma, fit.sigma + step].map(values);
        let slope = |bin: usize| (above[bin] - below[bin]) / (2.0 * step);
        let bend = |bin: usize| (above[bin] - 2.0 * middle[bin] + below[bin]) / (step * step);
        let misfit = |bin: usize| profile.exitance[bin] - fit.scale * middle[bin];
        let sum = |term: &dyn Fn(usize) -> f64| (0..BINS).map(|bin| Profile::share(bin) * term(bin)).sum::<f64>();
        let width = sum(&|bin| (fit.scale * slope(bin)).powi(2) - misfit(bin) * fit.scale * bend(bin));
        let mixed = sum(&|bin| (fit.scale * middle[bin] - misfit(bin)) * slope(bin));
        let squared = sum(&|bin| middle[bin] * middle[bin]);
        // For the width alone, or for width and scale.
        let determinant = if scale.is_some() { width } else { width * squared - mixed * mixed };
        if determinant.is_nan() || determinant <= 0.0 {
            return None;
        }
        let response = |bin: usize| {
            let by_width = fit.scale * slope(bin);
            let along = if scale.is_some() { by_width } else { squared * by_width - mixed * middle[bin] };
            Profile::share(bin) * along / determinant
        };
        Some((0..BINS).map(|bin| (response(bin) * profile.standard_error[bin]).powi(2)).sum::<f64>().sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_cdrf::oracle;
    use lapidary_reference::random_walk::{half_space, profile};

    /// A reflectance as a function of cosine and width.
    type Reflectance = fn(f64, f64) -> f64;

    /// Returns the profile of a known function, the oracle's, which differs from the function that
    /// is fitted.
    fn known(function: Reflectance, sigma: f64, scale: f64) -> Profile {
        let exitance = std::array::from_fn(|bin| scale * Profile::mean(bin, |cosine| function(cosine, sigma)));
        Profile { radius: 1.0, albedo: 0.9, exitance, standard_error: [0.0; BINS] }
    }

    #[test]
    fn a_profile_that_is_a_reflectance_function_gives_its_parameters_back() {
        let forms: [(Form, Reflectance); 2] =
            [(Form::Circular, oracle::accurate), (Form::Spherical, oracle::spherical)];
        for (form, function) in forms {
            for sigma in [0.05, 0.3, 1.0] {
                let profile = known(function, sigma, 0.7);
                for scale in [None, Some(0.7)] {
                    let found = form.best_fit(&profile, scale);
                    assert!((found.sigma / sigma - 1.0).abs() < 1e-3, "{form:?} {sigma}: {found:?}");
                    assert!((found.scale - 0.7).abs() < 1e-4 && found.residual < 3e-6, "{form:?} {sigma}: {found:?}");
                }
                // The wrong scale or the wrong form leaves a residual.
                assert!(form.best_fit(&profile, Some(0.5)).residual > 1e-2);
                let other = if form == Form::Circular { Form::Spherical } else { Form::Circular };
                assert!(other.best_fit(&profile, Some(0.7)).residual > 1e-4);
            }
        }
    }

    /// The widths from walks with different seeds scatter as their standard errors predict.
    #[test]
    fn widths_are_spread_as_their_errors_say() {
        for (radius, albedo, unscattered) in [(2.0, 0.9, false), (2.0, 0.9, true), (10.0, 0.99, false)] {
            for scale in [None, Some(half_space::diffuse_albedo(albedo))] {
                let mut widths = Vec::new();
                let mut errors = Vec::new();
                for seed in 0..48 {
                    let walked = profile(radius, albedo, 20_000, 1000 + seed);
                    let profile = if unscattered { walked.with_unscattered() } else { walked };
                    let fit = Form::Circular.best_fit(&profile, scale);
                    widths.push(fit.sigma);
                    errors.push(Form::Circular.sigma_error(&fit, &profile, scale).expect("a width"));
                }
                let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
                let middle = mean(&widths);
                let spread = (widths.iter().map(|width| (width - middle).powi(2)).sum::<f64>() / 47.0).sqrt();
                let ratio = spread / mean(&errors);
                println!(
                    "{radius} {albedo} {unscattered} {scale:?}: {middle:.4}, spread {spread:.5}, {ratio:.2} of the error"
                );
                // A standard deviation from 48 values is accurate to a tenth: 1 / sqrt(2 x 47). An
                // error that is wrong by a factor of two is at least four deviations off.
                assert!((0.6..1.4).contains(&ratio), "{radius} {albedo} {scale:?}: {ratio}");
            }
        }
        // Pure noise determines no width.
        let flat = Profile { radius: 1.0, albedo: 0.9, exitance: [0.0; BINS], standard_error: [0.1; BINS] };
        let fit = Fit { sigma: 0.5, scale: 0.0, residual: 0.0 };
        assert_eq!(Form::Circular.sigma_error(&fit, &flat, None), None);
    }

    #[test]
    fn no_width_at_all_is_found_too() {
        let lambert = known(|cosine, _| cosine.max(0.0), 0.0, 0.4);
        for form in [Form::Circular, Form::Spherical] {
            let found = form.best_fit(&lambert, Some(0.4));
            assert!(found.sigma < 1e-3 && found.residual < 1e-6, "{form:?}: {found:?}");
        }
        let found = Form::Lambert.best_fit(&lambert, None);
        assert!((found.scale - 0.4).abs() < 1e-12 && found.residual < 1e-12, "{found:?}");
    }

    /// A free scale never increases the residual, nor does a free width.
    #[test]
    fn freedom_never_harms() {
        for (radius, albedo) in [(2.0, 0.8), (5.0, 1.0), (20.0, 0.99)] {
            let profile = profile(radius, albedo, 50_000, 11);
            let fixed = Some(half_space::diffuse_albedo(albedo));
            for scale in [None, fixed] {
                let lambert = Form::Lambert.best_fit(&profile, scale).residual;
                for form in [Form::Circular, Form::Spherical] {
                    let found = form.best_fit(&profile, scale).residual;
                    assert!(found <= lambert, "{radius} {albedo} {form:?} {scale:?}: {found}, {lambert}");
                }
            }
            for form in [Form::Lambert, Form::Circular, Form::Spherical] {
                let [free, fixed] = [None, fixed].map(|scale| form.best_fit(&profile, scale).residual);
                assert!(free <= fixed + 1e-9, "{radius} {albedo} {form:?}: {free}, {fixed}");
            }
        }
    }
}
