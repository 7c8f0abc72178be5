//! Exact results in f64, from angles: Snell's law for the angle of refraction, then Fresnel's sine
//! and tangent laws. No formula here is a rearrangement of the shader's formulas in cosines.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

/// Sum and difference of the angles of incidence and refraction, for the sine and tangent laws.
struct Angles {
    /// Sum of the angles of the two rays, from the normal or from the surface.
    sum: f64,
    /// Angle of the incident ray minus the angle of the refracted ray.
    difference: f64,
}

/// Returns the angles of the incident and the refracted ray for `cosine` in [0, 1], or `None` under
/// total internal reflection.
///
/// Close to the normal the angles are measured from the normal: sin θt = sin θi / n. Close to the
/// surface they are measured from the surface, and Snell's law cos αi = n cos αt becomes
/// sin²(αt/2) = ((n - 1)/2 + sin²(αi/2)) / n. Each form keeps the small angle small, so that sum
/// and difference have a relative error of about 1e-16 / |n - 1|, 2e-9 at the smallest f32 step
/// from n = 1. Signs do not matter, because only squares of the laws' quotients are used.
fn angles(cosine: f64, relative_index: f64) -> Option<Angles> {
    let incidence = cosine.acos();
    let sine_refracted = incidence.sin() / relative_index;
    if sine_refracted < FRAC_1_SQRT_2 {
        let refraction = sine_refracted.asin();
        Some(Angles { sum: incidence + refraction, difference: incidence - refraction })
    } else {
        let grazing = cosine.asin();
        let half_sine = (0.5 * grazing).sin();
        let square = (0.5 * (relative_index - 1.0) + half_sine * half_sine) / relative_index;
        if square < 0.0 {
            return None;
        }
        let refracted = 2.0 * square.sqrt().asin();
        Some(Angles { sum: grazing + refracted, difference: grazing - refracted })
    }
}

/// Computes the reflectance from r_s = sin(θi - θt) / sin(θi + θt) and r_p = tan(θi - θt) /
/// tan(θi + θt); 0 for an index of 1.
pub fn dielectric(cosine: f64, relative_index: f64) -> f64 {
    if relative_index == 1.0 {
        return 0.0;
    }
    let cosine = cosine.clamp(0.0, 1.0);
    if cosine == 1.0 {
        return normal_incidence(relative_index);
    }
    match angles(cosine, relative_index) {
        None => 1.0,
        Some(Angles { sum, difference }) => {
            let s = difference.sin() / sum.sin();
            let p = difference.tan() / sum.tan();
            0.5 * (s * s + p * p)
        }
    }
}

/// Calls [`dielectric`]: the naive form is the same function, computed badly.
pub fn dielectric_textbook(cosine: f64, relative_index: f64) -> f64 {
    dielectric(cosine, relative_index)
}

/// Computes the reflectance at normal incidence as tanh²(ln(n) / 2): ln(n) is a rapidity, and the
/// inverse interface has its negative.
pub fn normal_incidence(relative_index: f64) -> f64 {
    let amplitude = (0.5 * (relative_index - 1.0).ln_1p()).tanh();
    amplitude * amplitude
}

/// Computes Schlick's approximation from the angle θ in the thinner medium: 1 - cos θ = 2
/// sin²(θ/2), and 1 beyond the critical angle.
pub fn schlick(cosine: f64, relative_index: f64) -> f64 {
    let incidence = cosine.clamp(0.0, 1.0).acos();
    let sine = incidence.sin() / relative_index.min(1.0);
    let half_sine_squared = if sine > 1.0 {
        return 1.0;
    } else if relative_index >= 1.0 {
        (0.5 * incidence).sin().powi(2)
    } else if sine < FRAC_1_SQRT_2 {
        (0.5 * sine.asin()).sin().powi(2)
    } else {
        let grazing = cosine.asin();
        let half_sine = (0.5 * grazing).sin();
        let square = ((0.5 * (relative_index - 1.0) + half_sine * half_sine) / relative_index).max(0.0);
        (0.5 * (FRAC_PI_2 - 2.0 * square.sqrt().asin())).sin().powi(2)
    };
    let normal = normal_incidence(relative_index);
    normal + (1.0 - normal) * (2.0 * half_sine_squared).powi(5)
}
