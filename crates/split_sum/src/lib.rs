//! Mirror of `wgsl/split_sum.wgsl`: a rough metal under an environment. The WGSL file states the units, domain and
//! accuracy of each function. This file follows it line by line.
//!
//! ```
//! use glam::{Vec2, Vec3};
//! use lapidary_split_sum::reflectance;
//!
//! // At f0 = 1 all light is reflected, whatever share of it single scattering loses.
//! let white = reflectance(Vec3::ONE, Vec2::new(0.3, 0.01));
//! assert!((white - 1.0).abs().max_element() < 1e-6);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{UVec2, Vec2, Vec3};
use std::f32::consts::PI;

/// Smallest alpha; smaller values count as this one.
pub const SPLIT_SUM_SMOOTHEST: f32 = 0.001;
/// Smallest cosine of an eye in the shadowing.
pub const SPLIT_SUM_GRAZING: f32 = 1e-15;
/// Smallest albedo; smaller values count as this one.
pub const SPLIT_SUM_LEAST: f32 = 0.25;
/// Share of single scattering's loss that light which leaves a second or later facet loses again.
pub const SPLIT_SUM_STAYING: f32 = 0.72;

/// Returns the share of light that a facet of a metal reflects, by Schlick.
pub fn fresnel(f0: Vec3, cosine: f32) -> Vec3 {
    let rest = 1.0 - cosine.clamp(0.0, 1.0);
    let squared = rest * rest;
    f0 + (1.0 - f0) * (squared * squared * rest)
}

/// Returns a point of Hammersley's set.
pub fn point(index: u32, count: u32) -> Vec2 {
    // As the shader does, which has no function for it in every language.
    let mut bits = index.rotate_right(16);
    bits = ((bits & 0x00ff_00ff) << 8) | ((bits >> 8) & 0x00ff_00ff);
    bits = ((bits & 0x0f0f_0f0f) << 4) | ((bits >> 4) & 0x0f0f_0f0f);
    bits = ((bits & 0x3333_3333) << 2) | ((bits >> 2) & 0x3333_3333);
    bits = ((bits & 0x5555_5555) << 1) | ((bits >> 1) & 0x5555_5555);
    Vec2::new((bits >> 8) as f32 * 5.960_464_5e-8, (index as f32 / count.max(1) as f32).min(0.999_999_94))
}

/// Returns the cosine of the eye and the alpha that a texel of the table of reflectance stands for.
pub fn texel(texel: UVec2, size: UVec2) -> Vec2 {
    let steps = (size.max(UVec2::splat(2)) - UVec2::ONE).as_vec2();
    let share = texel.as_vec2() / steps;
    share * share
}

/// Returns where the table of reflectance is to be read, in fractions of it.
pub fn place(cosine_eye: f32, alpha: f32, size: UVec2) -> Vec2 {
    let texels = size.max(UVec2::splat(2)).as_vec2();
    let share = Vec2::new(cosine_eye.clamp(0.0, 1.0).sqrt(), alpha.clamp(SPLIT_SUM_SMOOTHEST, 1.0).sqrt());
    (share * (texels - 1.0) + 0.5) / texels
}

/// Returns the share of the facets seen by the eye that the light sees too.
pub fn shadowing(cosine_light: f32, cosine_eye: f32, alpha: f32) -> f32 {
    let a = alpha.clamp(SPLIT_SUM_SMOOTHEST, 1.0);
    let l = cosine_light.clamp(0.0, 1.0);
    let v = cosine_eye.clamp(SPLIT_SUM_GRAZING, 1.0);
    let squared = a * a;
    let rest = (1.0 - a) * (1.0 + a);
    let eye = (squared + rest * v * v).sqrt();
    let light = (squared + rest * l * l).sqrt();
    l * ((v + eye) / (l * eye + v * light))
}

/// Computes the same with separate masking and shadowing, a naive form.
pub fn shadowing_naive(cosine_light: f32, cosine_eye: f32, alpha: f32) -> f32 {
    let squared = alpha * alpha;
    let tangent_light = 1.0 / (cosine_light * cosine_light) - 1.0;
    let tangent_eye = 1.0 / (cosine_eye * cosine_eye) - 1.0;
    let lambda_light = 0.5 * ((1.0 + squared * tangent_light).sqrt() - 1.0);
    let lambda_eye = 0.5 * ((1.0 + squared * tangent_eye).sqrt() - 1.0);
    (1.0 + lambda_eye) / (1.0 + lambda_light + lambda_eye)
}

/// Returns what one facet that the eye sees adds to its texel of the table: the factor of f0, and the rest.
pub fn albedo(facing: f32, cosine_light: f32, cosine_eye: f32, alpha: f32) -> Vec2 {
    let cosine = facing.clamp(0.0, 1.0);
    let rest = 1.0 - cosine;
    let grazing = rest * rest * (rest * rest) * rest;
    shadowing(cosine_light, cosine_eye, alpha) * Vec2::new(1.0 - grazing, grazing)
}

/// A direction that a texel of the environment takes light from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplitSumLobe {
    /// Unit direction.
    pub toward: Vec3,
    /// Its weight: the cosine to the axis, 0 below the horizon.
    pub weight: f32,
    /// Solid angle for which it stands, times the number of directions, in sr.
    pub solid_angle: f32,
}

/// Returns a direction of light, at random by `u` and `azimuth`, for eye and surface normal both along `axis`.
pub fn lobe(axis: Vec3, alpha: f32, u: f32, azimuth: Vec2) -> SplitSumLobe {
    let a = alpha.clamp(SPLIT_SUM_SMOOTHEST, 1.0);
    let v = u.max(0.0);
    let near = 1.0 - v;
    let far = a * a * v;
    let inverse = 1.0 / (near + far);
    let cosine = (near - far) * inverse;
    let sine = 2.0 * a * (near * v).sqrt() * inverse;
    // The direction along the surface: that in the plane z = 0, turned by half a turn about the middle of the axis and
    // the z axis, or its opposite.
    let middle = axis + Vec3::new(0.0, 0.0, if axis.z < 0.0 { -1.0 } else { 1.0 });
    let turned = middle.truncate().dot(azimuth) / (1.0 + axis.z.abs()) * middle - azimuth.extend(0.0);
    let width = a * inverse;
    SplitSumLobe {
        toward: sine * turned + cosine * axis,
        weight: cosine.max(0.0),
        solid_angle: 4.0 * PI * width * width,
    }
}

/// Computes the same by the cosine of the facet, a naive form.
pub fn lobe_naive(axis: Vec3, alpha: f32, u: f32, azimuth: Vec2) -> SplitSumLobe {
    let cosine = ((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u)).sqrt();
    let sine = (1.0 - cosine * cosine).sqrt();
    let middle = axis + Vec3::Z;
    let turned = middle.truncate().dot(azimuth) / middle.z * middle - azimuth.extend(0.0);
    let facet = sine * turned + cosine * axis;
    let facing = axis.dot(facet);
    let toward = 2.0 * facing * facet - axis;
    let spread = facing * facing * (alpha * alpha - 1.0) + 1.0;
    let density = alpha * alpha / (PI * spread * spread) / 4.0;
    SplitSumLobe { toward, weight: axis.dot(toward), solid_angle: 1.0 / density }
}

/// Returns the factor on single scattering that makes up for light that meets several facets.
pub fn compensation(f0: Vec3, albedo: f32) -> Vec3 {
    let once = albedo.clamp(SPLIT_SUM_LEAST, 1.0);
    let lost = 1.0 - once;
    let staying = SPLIT_SUM_STAYING * lost;
    let mean = f0 + (1.0 - f0) * 0.047_619_048;
    1.0 + mean * (lost * (1.0 - staying) / once) / (1.0 - mean * staying)
}

/// Computes the compensation as if all light left the second facet, a naive form.
pub fn compensation_turquin(f0: Vec3, albedo: f32) -> Vec3 {
    1.0 + f0 * ((1.0 - albedo) / albedo)
}

/// Returns the share of even light from all directions that a rough metal reflects towards the eye.
pub fn reflectance(f0: Vec3, table: Vec2) -> Vec3 {
    (f0 * table.x + table.y) * compensation(f0, table.x + table.y)
}

/// Returns that of single scattering, a naive form.
pub fn reflectance_naive(f0: Vec3, table: Vec2) -> Vec3 {
    f0 * table.x + table.y
}

#[cfg(test)]
mod tests;
