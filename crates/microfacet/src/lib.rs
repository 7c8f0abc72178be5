//! Mirror of `wgsl/microfacet.wgsl`: the highlight of a rough dielectric surface. The WGSL file
//! states the units, domain and accuracy of each function. This file follows it line by line.
//!
//! ```
//! use glam::{Vec2, Vec3};
//! use lapidary_microfacet::reflectance;
//!
//! // Towards the mirror direction and away from it, at a roughness of 0.3 squared.
//! let (light, eye) = (Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.6, 0.8, 0.0));
//! assert!(reflectance(Vec3::Y, light, eye, 0.09, 0.04) > 10.0 * reflectance(Vec3::Y, light, Vec3::Y, 0.09, 0.04));
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, PI};

/// Smallest alpha; smaller values count as this one.
pub const MICROFACET_SMOOTHEST: f32 = 0.001;
/// Lower limit of the divisor of the visibility.
pub const MICROFACET_GRAZING: f32 = 1e-24;
/// Lower limit of the squared length of the sum of two unit vectors.
pub const MICROFACET_OPPOSITE: f32 = 1e-30;

/// Returns the distribution of the facets' normals by Trowbridge and Reitz in 1/sr, with the
/// squared sine by Lagrange's identity.
pub fn distribution(normal: Vec3, half: Vec3, alpha: f32) -> f32 {
    let a = alpha.clamp(MICROFACET_SMOOTHEST, 1.0);
    let cosine = normal.dot(half);
    let across = normal.cross(half);
    let cosine_squared = cosine * cosine;
    let sine_squared = across.dot(across);
    let spread = a * a * cosine_squared + sine_squared;
    // A subnormal divisor may be flushed to zero.
    if spread < 1.2e-38 {
        return 0.0;
    }
    let quotient = a * (cosine_squared + sine_squared) / spread;
    FRAC_1_PI * quotient * quotient
}

/// Computes the distribution from the cosine alone, a naive form.
pub fn distribution_naive(cosine: f32, alpha: f32) -> f32 {
    let squared = alpha * alpha;
    let spread = cosine * cosine * (squared - 1.0) + 1.0;
    squared / (PI * spread * spread)
}

/// Returns Smith's height-correlated masking and shadowing, divided by 4 (n . l) (n . v).
pub fn visibility(cosine_light: f32, cosine_eye: f32, alpha: f32) -> f32 {
    let a = alpha.clamp(MICROFACET_SMOOTHEST, 1.0);
    let l = cosine_light.clamp(0.0, 1.0);
    let v = cosine_eye.clamp(0.0, 1.0);
    let squared = a * a;
    let rest = (1.0 - a) * (1.0 + a);
    let shadowing = v * (squared + rest * l * l).sqrt();
    let masking = l * (squared + rest * v * v).sqrt();
    0.5 / (shadowing + masking).max(MICROFACET_GRAZING)
}

/// Computes the same quotient with a separate numerator and divisor, a naive form.
pub fn visibility_naive(cosine_light: f32, cosine_eye: f32, alpha: f32) -> f32 {
    let squared = alpha * alpha;
    let tangent_light = 1.0 / (cosine_light * cosine_light) - 1.0;
    let tangent_eye = 1.0 / (cosine_eye * cosine_eye) - 1.0;
    let lambda_light = 0.5 * ((1.0 + squared * tangent_light).sqrt() - 1.0);
    let lambda_eye = 0.5 * ((1.0 + squared * tangent_eye).sqrt() - 1.0);
    1.0 / (1.0 + lambda_light + lambda_eye) / (4.0 * cosine_light * cosine_eye)
}

/// Returns the normal of the facets that reflect the light into the eye; 0 for opposite directions.
pub fn half(toward_light: Vec3, toward_eye: Vec3) -> Vec3 {
    let sum = toward_light + toward_eye;
    sum / sum.dot(sum).max(MICROFACET_OPPOSITE).sqrt()
}

/// Normalizes the sum, a naive form.
pub fn half_naive(toward_light: Vec3, toward_eye: Vec3) -> Vec3 {
    (toward_light + toward_eye).normalize()
}

/// Returns the normal of a facet that the eye sees, at random by `u` and `azimuth`, the cosine and sine of a random angle.
pub fn facet(normal: Vec3, toward_eye: Vec3, alpha: f32, u: f32, azimuth: Vec2) -> Vec3 {
    let a = alpha.clamp(MICROFACET_SMOOTHEST, 1.0);
    let height = normal.dot(toward_eye);
    let along = a * (toward_eye - height * normal);
    let inverse = 1.0 / (along.dot(along) + height * height).sqrt();
    let cosine = inverse * height;
    let sine_squared = inverse * inverse * along.dot(along);
    // Height of the facet, times the length of the sum of two unit vectors: towards the eye, and of the cap.
    let v = u.max(0.0);
    let rise = (1.0 - v) * (1.0 + cosine);
    let sine = (v * ((1.0 + cosine) * rise + sine_squared)).sqrt();
    // The cap's direction along the surface: that in the plane z = 0, turned by half a turn about the middle of the
    // normal and the z axis.
    let middle = normal + Vec3::new(0.0, 0.0, if normal.z < 0.0 { -1.0 } else { 1.0 });
    let level = sine * azimuth;
    let turned = middle.truncate().dot(level) / (1.0 + normal.z.abs()) * middle - level.extend(0.0);
    let facet = a * (inverse * along + turned) + rise * normal;
    facet / facet.dot(facet).max(MICROFACET_OPPOSITE).sqrt()
}

/// Returns the same with the cap's height and its sine from their difference, a naive form.
pub fn facet_naive(normal: Vec3, toward_eye: Vec3, alpha: f32, u: f32, azimuth: Vec2) -> Vec3 {
    let height = normal.dot(toward_eye);
    let eye = (alpha * (toward_eye - height * normal) + height * normal).normalize();
    let cosine = normal.dot(eye);
    let z = (1.0 - u) * (1.0 + cosine) - cosine;
    let level = (1.0 - z * z).sqrt() * azimuth;
    let middle = normal + Vec3::Z;
    let cap = level.extend(z);
    let half = eye + middle.dot(cap) / middle.z * middle - cap;
    let rise = normal.dot(half);
    (alpha * (half - rise * normal) + rise * normal).normalize()
}

/// Returns the BRDF times n . l, in 1/sr; `fresnel` is the share of light that a facet reflects.
pub fn reflectance(normal: Vec3, toward_light: Vec3, toward_eye: Vec3, alpha: f32, fresnel: f32) -> f32 {
    let half = half(toward_light, toward_eye);
    let cosine_light = normal.dot(toward_light).max(0.0);
    let visibility = visibility(cosine_light, normal.dot(toward_eye), alpha);
    fresnel * distribution(normal, half, alpha) * visibility * cosine_light
}

#[cfg(test)]
mod tests;
