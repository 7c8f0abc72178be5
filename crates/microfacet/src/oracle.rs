//! Exact results in f64: the distribution from the slope of the facets, by an angle; masking from
//! the length of a stretched direction; the half vector from its azimuth and elevation. The mirror
//! uses neither angles nor slopes.

use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::PI;

// The module's constants, repeated so that an error in them does not carry over to the oracle.
const SMOOTHEST: f64 = 1e-3;
const GRAZING: f64 = 1e-24;
const OPPOSITE: f64 = 1e-15;

/// Returns the density of slopes, α² / (π (α² + tan²)²), over cos⁴, which converts slopes to
/// directions; beyond 45° from the cotangent.
fn by_slope(angle: f64, alpha: f64) -> f64 {
    let tangent = angle.tan();
    let root = if tangent.abs() <= 1.0 {
        alpha * (1.0 + tangent * tangent) / (alpha * alpha + tangent * tangent)
    } else {
        let cotangent = tangent.recip();
        alpha * (1.0 + cotangent * cotangent) / (1.0 + (alpha * cotangent).powi(2))
    };
    root * root / PI
}

/// Computes the distribution from the slope of facets at Kahan's angle between the vectors,
/// 2 atan(|a - b| / |a + b|).
pub fn distribution(normal: DVec3, half: DVec3, alpha: f64) -> f64 {
    if normal == DVec3::ZERO || half == DVec3::ZERO {
        return 0.0;
    }
    let [normal, half] = [normal, half].map(DVec3::normalize);
    let angle = 2.0 * (normal - half).length().atan2((normal + half).length());
    by_slope(angle, alpha.clamp(SMOOTHEST, 1.0))
}

/// Computes the same from the angle of the cosine, with an alpha that is not clamped.
pub fn distribution_naive(cosine: f64, alpha: f64) -> f64 {
    by_slope(cosine.acos(), alpha)
}

/// Returns the length of a unit direction whose part along the surface is multiplied by `alpha`:
/// cos θ (1 + 2 Λ).
fn stretched(cosine: f64, alpha: f64) -> f64 {
    let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    (alpha * sine).hypot(cosine)
}

/// Returns 4 l v (1 + Λ(l) + Λ(v)), twice the sum of each cosine times the stretched length of the
/// other.
fn masked(light: f64, eye: f64, alpha: f64) -> f64 {
    2.0 * (eye * stretched(light, alpha) + light * stretched(eye, alpha))
}

/// Computes the visibility from stretched lengths.
pub fn visibility(cosine_light: f64, cosine_eye: f64, alpha: f64) -> f64 {
    let [light, eye] = [cosine_light, cosine_eye].map(|cosine| cosine.clamp(0.0, 1.0));
    masked(light, eye, alpha.clamp(SMOOTHEST, 1.0)).max(2.0 * GRAZING).recip()
}

/// Computes the same function without the clamps.
pub fn visibility_naive(cosine_light: f64, cosine_eye: f64, alpha: f64) -> f64 {
    masked(cosine_light, cosine_eye, alpha).recip()
}

/// Computes the half vector from the azimuth and the elevation of the sum. Sums shorter than the
/// limit fade with their length.
pub fn half(toward_light: DVec3, toward_eye: DVec3) -> DVec3 {
    let sum = toward_light + toward_eye;
    let azimuth = sum.y.atan2(sum.x);
    let level = sum.x.hypot(sum.y);
    let elevation = sum.z.atan2(level);
    let fade = (level.hypot(sum.z) / OPPOSITE).min(1.0);
    fade * DVec3::new(elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin())
}

/// Calls [`half`]: the naive form is the same function, computed badly.
pub fn half_naive(toward_light: DVec3, toward_eye: DVec3) -> DVec3 {
    half(toward_light, toward_eye)
}

/// Multiplies the parts, each by the formula above.
pub fn reflectance(normal: DVec3, toward_light: DVec3, toward_eye: DVec3, alpha: f64, fresnel: f64) -> f64 {
    let [light, eye] = [toward_light, toward_eye].map(|toward| normal.dot(toward));
    let density = distribution(normal, half(toward_light, toward_eye), alpha);
    fresnel * density * visibility(light, eye, alpha) * light.max(0.0)
}

/// Finds the facet on the hemisphere that stretching makes of the facets: it lies halfway between the eye and a direction in a
/// cap around the normal, from whose edge on the hemisphere reflects the eye's rays downwards. The cap is turned by half a
/// turn about the middle of the normal and the z axis, on the normal's side.
pub fn facet(normal: DVec3, toward_eye: DVec3, alpha: f64, u: f64, azimuth: DVec2) -> DVec3 {
    let alpha = alpha.clamp(SMOOTHEST, 1.0);
    let height = normal.dot(toward_eye);
    let along = toward_eye - height * normal;
    let eye = (height * normal + alpha * along).normalize();
    let cosine = normal.dot(eye).clamp(-1.0, 1.0);
    // Of the cap's height 1 + cosine, the share u lies above.
    let share = u.max(0.0);
    let polar = 2.0 * (0.5 * share * (1.0 + cosine)).sqrt().asin();
    let side = if normal.z < 0.0 { -1.0 } else { 1.0 };
    let level = polar.sin() * azimuth;
    let turn = DQuat::from_axis_angle((normal + side * DVec3::Z).normalize(), PI);
    let cap = turn * DVec3::new(level.x, level.y, side * polar.cos());
    let half = eye + cap;
    let upward = normal.dot(half);
    (upward * normal + alpha * (half - upward * normal)).normalize()
}

/// Calls [`facet`]: the naive form is the same function, computed badly.
pub fn facet_naive(normal: DVec3, toward_eye: DVec3, alpha: f64, u: f64, azimuth: DVec2) -> DVec3 {
    facet(normal, toward_eye, alpha, u, azimuth)
}
