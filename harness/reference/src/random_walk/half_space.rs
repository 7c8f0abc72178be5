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
/// including the boundary's own reflection.
///
/// Chandrasekhar's reflection function is closed by Fresnel's reflectance from inside and summed
/// over the reflections.
pub fn reflectance_behind(cosine: f64, albedo: f64, index: f64) -> f64 {
    // 1 - reflectance of the boundary, by the cosine inside.
    let open = |inside: f64| {
        let sine = index * (1.0 - inside * inside).sqrt();
        if sine >= 1.0 { 0.0 } else { 1.0 - dielectric(inside, index.recip()) }
    };
    // Midpoints of steps on either side of the critical angle, finer towards it, where the boundary
    // opens like a square root.
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
    // Upward radiance for downward light at the cosine `from` of irradiance 1, measured
    // perpendicular to the light.
    let scattered =
        |to: usize, from: f64, h_from: f64| albedo / 4.0 * from / (nodes[to].0 + from) * values[to] * h_from / PI;
    let entry = (1.0 - (1.0 - cosine * cosine) / (index * index)).sqrt();
    let enters = 1.0 - dielectric(cosine, index);
    let h_entry = h(entry, albedo);
    // `enters` is the power per area that enters; divided by the cosine of the refracted light, it
    // is the irradiance perpendicular to that light.
    let source: Vec<f64> = (0..nodes.len()).map(|to| enters / entry * scattered(to, entry, h_entry)).collect();
    let mut upwards = source.clone();
    for _ in 0..2000 {
        let next: Vec<f64> = (0..nodes.len())
            .map(|to| {
                let again: f64 = (0..nodes.len())
                    .filter(|from| open(nodes[*from].0) < 1.0)
                    .map(|from| {
                        let (mu, step) = nodes[from];
                        (1.0 - open(mu)) * upwards[from] * TAU * step * scattered(to, mu, values[from])
                    })
                    .sum();
                source[to] + again
            })
            .collect();
        let change: f64 = next.iter().zip(&upwards).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        upwards = next;
        if change < 1e-9 {
            break;
        }
    }
    let out: f64 = nodes.iter().zip(&upwards).map(|((mu, step), up)| TAU * mu * step * open(*mu) * up).sum();
    1.0 - enters + out
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
}
