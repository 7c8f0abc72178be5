//! Functions fitted to the exitance of spheres, and what they leave: the residual of the convolution itself, and what a
//! rung's errors add to it.

use lapidary_assay::golden_section::golden_section;
use lapidary_reference::random_walk::{BINS, Profile, half_space};
use rayon::prelude::*;
use std::convert::Infallible;

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
    pub fn of(self, albedo: f64) -> Option<f64> {
        (self == Self::Fixed).then(|| half_space::diffuse_albedo(albedo))
    }
}

/// A reflectance function fitted to a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Width in radians.
    pub sigma: f64,
    /// Factor of the function.
    pub scale: f64,
    /// RMS difference over the sphere's surface, divided by the irradiance of a surface that faces
    /// the light.
    pub residual: f64,
}

impl Fit {
    /// Returns a function of cosine and width with width `sigma` and factor `scale`; `None` is the best-fit factor.
    pub fn of(profile: &Profile, function: impl Fn(f64, f64) -> f64, sigma: f64, scale: Option<f64>) -> Self {
        let values: [f64; BINS] = std::array::from_fn(|bin| Profile::mean(bin, |cosine| function(cosine, sigma)));
        let sum = |term: &dyn Fn(usize) -> f64| (0..BINS).map(|bin| Profile::share(bin) * term(bin)).sum::<f64>();
        let scale = scale
            .unwrap_or_else(|| sum(&|bin| values[bin] * profile.exitance[bin]) / sum(&|bin| values[bin] * values[bin]));
        let residual = sum(&|bin| (profile.exitance[bin] - scale * values[bin]).powi(2)).sqrt();
        Self { sigma, scale, residual }
    }

    /// Returns a function of cosine and width with the best-fit width; the scale is as in [`Fit::of`].
    pub fn best_of(profile: &Profile, function: impl Fn(f64, f64) -> f64, scale: Option<f64>) -> Self {
        let sigma = best_sigma(|sigma| Self::of(profile, &function, sigma, scale).residual);
        Self::of(profile, function, sigma, scale)
    }
}

/// Returns the width between 0 and 10 rad that minimises `value`: the best point of a grid that
/// starts at 0.01, each point a twentieth above the last, refined by golden-section search.
pub fn best_sigma(value: impl Fn(f64) -> f64) -> f64 {
    let grid = |k: i32| if k < 0 { 0.0 } else { 0.01 * 1.05f64.powi(k) };
    let values: Vec<f64> = (0..142).map(|k| value(grid(k))).collect();
    let best = (0..142).min_by(|&a, &b| values[a as usize].total_cmp(&values[b as usize])).unwrap_or_default();
    let Ok(sigma) = golden_section::<Infallible>([grid(best - 1), grid(best + 1)], 30, |sigma| Ok(value(sigma)));
    sigma
}

/// Returns the residuals of `function` against the spheres, with the best-fit scale and with the
/// diffuse albedo of the half space as the scale.
///
/// They are root mean squares over the spheres of each one's RMS over its surface, with its best-fit
/// width of the function; the unit is the irradiance of a surface that faces the light.
pub fn residuals(spheres: &[Profile], function: &(dyn Fn(f32, f32) -> f32 + Sync)) -> [f64; 2] {
    ScaleKind::ALL.map(|kind| {
        let squares = spheres.par_iter().map(|profile| {
            let function = |cosine: f64, sigma: f64| f64::from(function(cosine as f32, sigma as f32));
            Fit::best_of(profile, function, kind.of(profile.albedo)).residual.powi(2)
        });
        // Summed in order, so that every run gives the same digits.
        let squares: Vec<f64> = squares.collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_cdrf::{self as mirror, oracle};

    /// The oracle's function, which differs from the mirror's that is fitted, gives its parameters back.
    #[test]
    fn a_profile_that_is_a_function_gives_its_parameters_back() {
        for sigma in [0.05, 0.3, 1.0] {
            let exitance =
                std::array::from_fn(|bin| 0.7 * Profile::mean(bin, |cosine| oracle::accurate(cosine, sigma)));
            let profile = Profile { radius: 1.0, albedo: 0.9, exitance, standard_error: [0.0; BINS] };
            let function = |cosine: f64, sigma: f64| f64::from(mirror::accurate(cosine as f32, sigma as f32));
            for scale in [None, Some(0.7)] {
                let found = Fit::best_of(&profile, function, scale);
                assert!((found.sigma / sigma - 1.0).abs() < 1e-3, "{sigma}: {found:?}");
                assert!((found.scale - 0.7).abs() < 1e-4 && found.residual < 3e-6, "{sigma}: {found:?}");
            }
            let [free, _] = residuals(&[profile], &mirror::accurate);
            assert!(free < 3e-6, "{free}");
        }
    }
}
