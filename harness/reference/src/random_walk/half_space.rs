//! Half spaces in closed form (Chandrasekhar, "Radiative Transfer", 1950): the limit of a large
//! sphere.

use super::{BINS, Profile};
use lapidary_fresnel::oracle::dielectric;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Quadrature nodes on each side of the middle, and the step between two nodes.
const NODES: i32 = 80;
const STEP: f64 = 0.04;

/// Chandrasekhar's H function of isotropic scattering.
///
/// H = exp(-μ/π ∫ ln(1 - ω φ cot φ) / (cos² φ + μ² sin² φ) dφ) over a quarter turn, where μ is a
/// `cosine` above 0 and ω the `albedo` of one scattering.
pub fn h(cosine: f64, albedo: f64) -> f64 {
    // Tanh-sinh quadrature, since both ends are logarithmic: φ = 0 if nothing is absorbed, the
    // other end for a small cosine.
    let sum: f64 = (-NODES..=NODES)
        .map(|node| {
            let t = STEP * f64::from(node);
            let odds = (PI * t.sinh()).exp();
            // The distance from each end is computed separately, so that neither loses digits.
            let (angle, rest) = (FRAC_PI_2 * odds / (1.0 + odds), FRAC_PI_2 / (1.0 + odds));
            let weight = PI * t.cosh() * angle * rest / FRAC_PI_2;
            let square = angle * angle;
            // 1 - φ cot φ cancels at 0.
            let lack = if angle < 0.1 {
                square * (1.0 / 3.0 + square * (1.0 / 45.0 + square * (2.0 / 945.0 + square / 4725.0)))
            } else {
                1.0 - angle * rest.tan()
            };
            weight * (1.0 - albedo + albedo * lack).ln() / (rest.sin().powi(2) + (cosine * angle.sin()).powi(2))
        })
        .sum();
    (-cosine / PI * STEP * sum).exp()
}

/// Reflectance of a half space for light whose angle of incidence has this `cosine`, above 0.
pub fn reflectance(cosine: f64, albedo: f64) -> f64 {
    1.0 - h(cosine, albedo) * (1.0 - albedo).max(0.0).sqrt()
}

/// Profile of a sphere of infinite radius: flat everywhere and lit at all angles.
pub fn profile(albedo: f64) -> Profile {
    let lit = |cosine: f64| if cosine > 0.0 { cosine * reflectance(cosine, albedo) } else { 0.0 };
    let exitance = std::array::from_fn(|bin| Profile::mean(bin, lit));
    Profile { radius: f64::INFINITY, albedo, exitance, standard_error: [0.0; BINS] }
}

/// Reflectance of a half space for diffuse light.
///
/// A large sphere reflects the same share of parallel light: its disc holds all angles in
/// proportion to their cosines, as diffuse light does.
pub fn diffuse_albedo(albedo: f64) -> f64 {
    profile(albedo).whole()
}

/// Reflectance of a half space behind a smooth dielectric boundary of a relative `index` above 1,
/// including the boundary's own reflection, for light whose angle of incidence has this `cosine`.
///
/// Chandrasekhar's reflection function is closed by Fresnel's reflectance from inside and summed
/// over the reflections.
pub fn reflectance_behind(cosine: f64, albedo: f64, index: f64) -> f64 {
    let interior = Interior::new(cosine, albedo, index);
    let nodes = interior.nodes.iter().zip(&interior.upwards);
    let out: f64 = nodes.map(|(&(mu, step), up)| TAU * mu * step * open(mu, index) * up).sum();
    dielectric(cosine, index) + out
}

/// Radiance that such a half space sends out at an angle with the cosine `to`, without the
/// boundary's own reflection, under parallel light from an angle with the cosine `from` and of an
/// irradiance of 1 on the surface. Both cosines are above 0.
pub fn radiance_behind(to: f64, from: f64, albedo: f64, index: f64) -> f64 {
    let inside = refracted(to, index);
    open(inside, index) / (index * index) * Interior::new(from, albedo, index).upwards_at(inside, h(inside, albedo))
}

/// 1 - reflectance of a boundary from inside, by the cosine inside.
fn open(inside: f64, index: f64) -> f64 {
    let sine = index * (1.0 - inside * inside).sqrt();
    if sine >= 1.0 { 0.0 } else { 1.0 - dielectric(inside, index.recip()) }
}

/// Cosine inside of light with this cosine outside.
fn refracted(cosine: f64, index: f64) -> f64 {
    (1.0 - (1.0 - cosine * cosine) / (index * index)).sqrt()
}

/// Light below the boundary of a half space.
struct Interior {
    albedo: f64,
    /// Cosine of the light that enters, H there, and its irradiance, perpendicular to it.
    entry: [f64; 3],
    /// Cosines, and the steps that they stand for.
    nodes: Vec<(f64, f64)>,
    /// H at each node.
    values: Vec<f64>,
    /// Share of the light that the boundary reflects at each node, times the solid angle that the
    /// node stands for.
    reflected: Vec<f64>,
    /// Upward radiance at each node.
    upwards: Vec<f64>,
}

impl Interior {
    /// Light from outside has the cosine `from` and an irradiance of 1 on the surface.
    fn new(from: f64, albedo: f64, index: f64) -> Self {
        // Midpoints of steps on either side of the critical angle, finer towards it, where the
        // boundary opens like a square root.
        let critical = (1.0 - index.powi(-2)).sqrt();
        let count = 200;
        let nodes: Vec<(f64, f64)> = [(0.0, critical), (critical, 1.0)]
            .into_iter()
            .flat_map(|(from, to)| {
                (0..count).map(move |k| {
                    let angle = FRAC_PI_2 * (f64::from(k) + 0.5) / f64::from(count);
                    let step = FRAC_PI_2 / f64::from(count) * (to - from) * 2.0 * angle.sin() * angle.cos();
                    (from + (to - from) * angle.sin().powi(2), step)
                })
            })
            .collect();
        let values: Vec<f64> = nodes.iter().map(|(mu, _)| h(*mu, albedo)).collect();
        let cosine = refracted(from, index);
        // What enters is power per area; divided by the cosine of the refracted light, it is the
        // irradiance perpendicular to that light.
        let entry = [cosine, h(cosine, albedo), (1.0 - dielectric(from, index)) / cosine];
        let reflected = nodes.iter().map(|(mu, step)| (1.0 - open(*mu, index)) * TAU * step).collect();
        let mut interior = Self { albedo, entry, nodes, values, reflected, upwards: vec![0.0; 2 * count as usize] };
        for _ in 0..2000 {
            let next: Vec<f64> = interior
                .nodes
                .iter()
                .zip(&interior.values)
                .map(|((mu, _), value)| interior.upwards_at(*mu, *value))
                .collect();
            let change: f64 = next.iter().zip(&interior.upwards).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            interior.upwards = next;
            if change < 1e-9 {
                break;
            }
        }
        interior
    }

    /// Upward radiance at a cosine where H has the value `h_to`: of the light that enters, and of
    /// what the boundary reflects.
    fn upwards_at(&self, to: f64, h_to: f64) -> f64 {
        // Upward radiance for downward light at the cosine `from` of irradiance 1, measured
        // perpendicular to the light.
        let scattered = |from: f64, h_from: f64| self.albedo / 4.0 * from / (to + from) * h_to * h_from / PI;
        let nodes = self.nodes.iter().zip(&self.values).zip(self.reflected.iter().zip(&self.upwards));
        let again = nodes.map(|(((mu, _), value), (reflected, up))| reflected * up * scattered(*mu, *value));
        let [cosine, value, strength] = self.entry;
        strength * scattered(cosine, value) + again.sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_spaces_reflect_as_in_tables() {
        for (albedo, normal, diffuse) in
            [(0.5, 0.115226, 0.146544), (0.9, 0.414947, 0.478024), (0.99, 0.752721, 0.794564)]
        {
            let found = [reflectance(1.0, albedo), diffuse_albedo(albedo)];
            assert!((found[0] - normal).abs() < 6e-7 && (found[1] - diffuse).abs() < 6e-7, "{albedo}: {found:?}");
        }
        assert_eq!((reflectance(0.3, 1.0), reflectance(0.3, 0.0)), (1.0, 0.0));
        assert!((diffuse_albedo(1.0) - 1.0).abs() < 1e-12);
    }

    /// H solves 1/H(μ) = √(1 - ω) + ω/2 ∫ μ' H(μ') / (μ + μ') dμ', a different formula from the one
    /// that computes it.
    #[test]
    fn h_solves_its_equation() {
        for albedo in [0.5, 0.99, 1.0] {
            for cosine in [0.02, 0.3, 1.0] {
                let count = 2000;
                let integral: f64 = (0..count)
                    .map(|node| (f64::from(node) + 0.5) / f64::from(count))
                    .map(|other| other * h(other, albedo) / (cosine + other) / f64::from(count))
                    .sum();
                let right = (1.0f64 - albedo).sqrt() + 0.5 * albedo * integral;
                assert!((h(cosine, albedo) * right - 1.0).abs() < 2e-6, "{albedo} {cosine}: {}", h(cosine, albedo));
            }
        }
    }

    #[test]
    fn behind_a_boundary_that_does_nothing_and_behind_glass() {
        for (cosine, albedo) in [(1.0, 0.9), (0.4, 0.5)] {
            let found = reflectance_behind(cosine, albedo, 1.000_000_1);
            assert!((found - reflectance(cosine, albedo)).abs() < 1e-4, "{cosine} {albedo}: {found}");
        }
        // If nothing is absorbed, nothing is lost, however often the boundary sends light back; a
        // black medium leaves only the boundary's own reflection.
        assert!((reflectance_behind(0.7, 1.0, 1.5) - 1.0).abs() < 2e-3);
        assert!((reflectance_behind(1.0, 0.0, 1.5) - 0.04).abs() < 1e-12);
    }

    /// The radiance in all directions adds up to the reflectance, and light and eye may change
    /// places.
    #[test]
    fn what_leaves_a_half_space_behind_glass_adds_up_and_is_reciprocal() {
        let (albedo, index, from) = (0.9, 1.4, 0.7);
        let count = 40;
        let sum: f64 = (0..count)
            .map(|k| (f64::from(k) + 0.5) / f64::from(count))
            .map(|mu| TAU * mu * radiance_behind(mu, from, albedo, index) / f64::from(count))
            .sum();
        let expected = reflectance_behind(from, albedo, index) - dielectric(from, index);
        assert!((sum / expected - 1.0).abs() < 1e-3, "{sum} {expected}");
        let (one, other) = (radiance_behind(0.9, 0.3, albedo, index), radiance_behind(0.3, 0.9, albedo, index));
        assert!((one / other - 1.0).abs() < 1e-3, "{one} {other}");
    }
}
