//! Exact results in f64: lobes from angles and the density of slopes; shadowing from the share of rays that meet no facet;
//! compensation as the sum of the series, term by term; Schlick's reflectance by a power.

use glam::{DQuat, DVec2, DVec3, UVec2};
use std::f64::consts::PI;

// The module's constants, repeated so that an error in them does not carry over to the oracle.
const SMOOTHEST: f64 = 1e-3;
// The f32 next to 1e-15.
const GRAZING: f64 = 1e-15f32 as f64;
const LEAST: f64 = 0.25;
// The shader's constant is the f32 next to 0.72.
const STAYING: f64 = 0.72f32 as f64;

/// A direction of light, as in the mirror.
pub struct SplitSumLobe {
    /// Unit direction.
    pub toward: DVec3,
    /// Cosine to the axis, 0 below the horizon.
    pub weight: f64,
    /// Inverse density of directions.
    pub solid_angle: f64,
}

/// Blends f0 and 1 by a power.
pub fn fresnel(f0: DVec3, cosine: f64) -> DVec3 {
    f0.lerp(DVec3::ONE, (1.0 - cosine.clamp(0.0, 1.0)).powi(5))
}

/// Adds up the bits of the index, the lowest as a half, and so on, for 24 bits.
pub fn point(index: u32, count: u32) -> DVec2 {
    let reversed = (0..24).map(|bit| f64::from(index >> bit & 1) * 0.5f64.powi(bit + 1)).sum();
    DVec2::new(reversed, (f64::from(index) / f64::from(count.max(1))).min(1.0 - 0.5f64.powi(24)))
}

/// Squares the share of the steps before the texel.
pub fn texel(texel: UVec2, size: UVec2) -> DVec2 {
    (texel.as_dvec2() / (size.as_dvec2().max(DVec2::splat(2.0)) - 1.0)).powf(2.0)
}

/// Finds the texel between whose middles the roots lie.
pub fn place(cosine_eye: f64, alpha: f64, size: UVec2) -> DVec2 {
    let size = size.as_dvec2().max(DVec2::splat(2.0));
    let first = 0.5 / size;
    let last = 1.0 - first;
    let share = DVec2::new(cosine_eye.clamp(0.0, 1.0).powf(0.5), alpha.clamp(SMOOTHEST, 1.0).powf(0.5));
    first + share * (last - first)
}

/// Returns 2 cos θ (1 + Λ) and 2 cos θ Λ of a direction, from its length with the part along the surface times alpha.
fn smith(cosine: f64, alpha: f64) -> (f64, f64) {
    let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    let length = (alpha * sine).hypot(cosine);
    (length + cosine, (alpha * sine).powi(2) / (length + cosine))
}

/// Divides 1 + Λ(v) by 1 + Λ(v) + Λ(l), each with both cosines as factors.
pub fn shadowing(cosine_light: f64, cosine_eye: f64, alpha: f64) -> f64 {
    let alpha = alpha.clamp(SMOOTHEST, 1.0);
    let (light, eye) = (cosine_light.clamp(0.0, 1.0), cosine_eye.clamp(GRAZING, 1.0));
    let seen = light * smith(eye, alpha).0;
    seen / (seen + eye * smith(light, alpha).1)
}

/// Computes the same function without the clamps.
pub fn shadowing_naive(cosine_light: f64, cosine_eye: f64, alpha: f64) -> f64 {
    let seen = cosine_light * smith(cosine_eye, alpha).0;
    seen / (seen + cosine_eye * smith(cosine_light, alpha).1)
}

/// Splits Schlick's reflectance of the facet into f0 and the rest.
pub fn albedo(facing: f64, cosine_light: f64, cosine_eye: f64, alpha: f64) -> DVec2 {
    let black = fresnel(DVec3::ZERO, facing).x;
    shadowing(cosine_light, cosine_eye, alpha) * DVec2::new(1.0 - black, black)
}

/// Turns the azimuth by half a turn about the middle of axis and z axis, on the axis' side.
fn aside(axis: DVec3, azimuth: DVec2) -> DVec3 {
    let side = if axis.z < 0.0 { -1.0 } else { 1.0 };
    DQuat::from_axis_angle((axis + side * DVec3::Z).normalize(), PI) * azimuth.extend(0.0)
}

/// Tilts the direction by twice the angle of the facet's slope; the density is a quarter of the facets' over the
/// cosine, which cancels.
pub fn lobe(axis: DVec3, alpha: f64, u: f64, azimuth: DVec2) -> SplitSumLobe {
    let alpha = alpha.clamp(SMOOTHEST, 1.0);
    let share = u.clamp(0.0, 1.0);
    let tilt = (alpha * share.sqrt()).atan2((1.0 - share).sqrt());
    let (sine, cosine) = (2.0 * tilt).sin_cos();
    // Slopes have the density α² / (π (α² + tan²)²), and directions that over cos⁴.
    let (across, along) = tilt.sin_cos();
    let density = (alpha / (alpha * along).hypot(across).powi(2)).powi(2) / PI;
    SplitSumLobe {
        toward: sine * aside(axis, azimuth) + cosine * axis,
        weight: cosine.max(0.0),
        solid_angle: 4.0 / density,
    }
}

/// Calls [`lobe`]: the naive form is the same function, computed badly.
pub fn lobe_naive(axis: DVec3, alpha: f64, u: f64, azimuth: DVec2) -> SplitSumLobe {
    lobe(axis, alpha, u, azimuth)
}

/// Adds up what leaves after each reflection behind the first, until no light is left.
pub fn compensation(f0: DVec3, albedo: f64) -> DVec3 {
    let once = albedo.clamp(LEAST, 1.0);
    let staying = STAYING * (1.0 - once);
    // The mean of (1 - c)^5 over a hemisphere, by cosine: ∫ 2 c (1 - c)^5 dc.
    let mean = f0.lerp(DVec3::ONE, 1.0 / 21.0);
    let (mut left, mut leaving) = (DVec3::splat(1.0 - once), DVec3::ZERO);
    // At most .54 of the light stays at each facet, or .81 outside of the domain.
    for _ in 0..200 {
        left *= mean;
        leaving += left * (1.0 - staying);
        left *= staying;
    }
    1.0 + leaving / once
}

/// Adds all that single scattering loses, once reflected.
pub fn compensation_turquin(f0: DVec3, albedo: f64) -> DVec3 {
    1.0 - f0 + f0 / albedo
}

/// Single scattering and what follows, added.
pub fn reflectance(f0: DVec3, table: DVec2) -> DVec3 {
    reflectance_naive(f0, table) * compensation(f0, table.x + table.y)
}

/// Blends the parts by f0.
pub fn reflectance_naive(f0: DVec3, table: DVec2) -> DVec3 {
    table.y + f0 * table.x
}
