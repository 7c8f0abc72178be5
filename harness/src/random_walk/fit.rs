//! Is sigma = sigma_0 kappa true? The curvature-dependent reflectance function fitted to what a sphere really shows.

use super::{BINS, Profile};
use crate::golden_section::golden_section;
use lapidary_cdrf::oracle as cdrf;
use std::convert::Infallible;
use std::f64::consts::PI;

/// The reflectance function that comes nearest to a sphere's profile.
#[derive(Clone, Copy, Debug)]
pub struct Fit {
    /// Its width, in radians.
    pub sigma: f64,
    /// What it is multiplied by: the albedo of the whole sphere.
    pub scale: f64,
    /// RMS of the difference over the sphere's surface, over the irradiance of a surface that faces the light.
    pub residual: f64,
}

/// The function at the middle of each interval. Intervals are 5 degrees wide, over which the mean of a function as smooth as a fit's is its
/// value at the middle to 1e-3.
fn values(sigma: f64) -> [f64; BINS] {
    std::array::from_fn(|bin| cdrf::accurate((PI * (bin as f64 + 0.5) / BINS as f64).cos(), sigma))
}

fn at(profile: &Profile, sigma: f64) -> Fit {
    let values = values(sigma);
    let areas: [f64; BINS] = std::array::from_fn(|bin| {
        let [greater, less] = Profile::cosines(bin);
        0.5 * (greater - less)
    });
    let sum = |term: &dyn Fn(usize) -> f64| (0..BINS).map(|bin| areas[bin] * term(bin)).sum::<f64>();
    let scale = sum(&|bin| values[bin] * profile.exitance[bin]) / sum(&|bin| values[bin] * values[bin]);
    let residual = sum(&|bin| (profile.exitance[bin] - scale * values[bin]).powi(2)).sqrt();
    Fit { sigma, scale, residual }
}

/// The best of a grid from 0.01 to 10 rad, a twentieth apart, and golden sections about it.
pub fn fit(profile: &Profile) -> Fit {
    let grid = |k: i32| 0.01 * 1.05f64.powi(k);
    let best = (0..142).min_by(|&a, &b| at(profile, grid(a)).residual.total_cmp(&at(profile, grid(b)).residual));
    let best = best.unwrap_or_default();
    let Ok(sigma) =
        golden_section::<Infallible>([grid(best - 1), grid(best + 1)], 30, |sigma| Ok(at(profile, sigma).residual));
    at(profile, sigma)
}

#[cfg(test)]
mod tests {
    use super::super::profile;
    use super::*;

    #[test]
    fn a_profile_that_is_a_reflectance_function_gives_its_width_back() {
        for sigma in [0.05, 0.3, 1.0] {
            let exitance = values(sigma).map(|value| 0.7 * value);
            let found = fit(&Profile { radius: 1.0, albedo: 0.9, exitance, standard_error: [0.0; BINS] });
            assert!((found.sigma / sigma - 1.0).abs() < 1e-3, "{sigma}: {found:?}");
            assert!((found.scale - 0.7).abs() < 1e-3 && found.residual < 1e-4, "{sigma}: {found:?}");
        }
    }

    /// Were sigma = sigma_0 / R true, sigma R were one number for a matter. It is not.
    #[test]
    fn the_best_width_is_not_inverse_to_the_radius() {
        for albedo in [0.9, 0.99, 1.0] {
            let found = [2.0, 5.0, 10.0, 20.0, 50.0].map(|radius| (radius, fit(&profile(radius, albedo, 400_000, 11))));
            for (radius, fit) in found {
                println!(
                    "albedo {albedo:4}, radius {radius:2}: sigma {:.4}, sigma R {:.3}, scale {:.3}, residual {:.4}",
                    fit.sigma,
                    fit.sigma * radius,
                    fit.scale,
                    fit.residual
                );
            }
            let widths = found.map(|(radius, fit)| radius * fit.sigma);
            let drift =
                widths.iter().copied().fold(0.0, f64::max) / widths.iter().copied().fold(f64::INFINITY, f64::min);
            println!("albedo {albedo}: sigma R drifts {drift:.2} times");
            // The smaller the sphere, the wider: so much is true.
            assert!(found.windows(2).all(|pair| pair[0].1.sigma > pair[1].1.sigma), "{found:?}");
            assert!(drift > 1.3, "{drift}");
        }
    }
}
