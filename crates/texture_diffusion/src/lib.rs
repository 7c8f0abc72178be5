//! Rust mirror of `wgsl/texture_diffusion.wgsl`, line by line: diffusion of light along a surface
//! as a blur of its texture. The comments of the WGSL functions state units, domain and accuracy.
//!
//! ```
//! use glam::Vec3;
//! use lapidary_texture_diffusion::{pairs, tap};
//!
//! // Skin: red light spreads farthest. One side of the blur's taps, each with its weights.
//! let sigma0 = Vec3::new(0.02, 0.01, 0.005);
//! let pairs = pairs(sigma0);
//! let weights: Vec3 = (0..pairs).map(|index| tap(index, pairs, sigma0).weight).sum();
//! assert!(weights.min_element() > 0.0);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{UVec3, Vec2, Vec3, Vec4};

/// Distance of the outermost taps, in standard deviations of the widest channel.
pub const TEXTURE_DIFFUSION_REACH: f32 = 3.4;
/// Smallest share of the widest channel that the placement of taps takes into account.
pub const TEXTURE_DIFFUSION_LEAST_RATIO: f32 = 0.0625;
/// A channel narrower than this share of the widest, 2^-12, counts as this wide.
pub const TEXTURE_DIFFUSION_NARROWEST: f32 = 0.000244140625;
/// Lower limit of divisors, 2^-60.
pub const TEXTURE_DIFFUSION_SMALLEST: f32 = 8.673617379884035e-19;

/// Makes a number from any source safe to calculate with: a NaN becomes 0, and magnitudes are
/// limited to 1e18.
pub fn finite(value: f32) -> f32 {
    let bits = value.to_bits();
    let magnitude = bits & 0x7fff_ffff;
    if magnitude > 0x7f80_0000 {
        return 0.0;
    }
    f32::from_bits((bits & 0x8000_0000) | magnitude.min(0x5d5e_0b6b))
}

/// Clip-space position of a vertex, from its texture coordinates.
pub fn clip(uv: Vec2) -> Vec4 {
    Vec4::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.0, 1.0)
}

/// The same position upside down: a naive form.
pub fn clip_naive(uv: Vec2) -> Vec4 {
    (2.0 * uv - 1.0).extend(0.0).extend(1.0)
}

/// World length of a texel along u and along v, from the derivatives of the position in the
/// texture.
pub fn stretch(position_x: Vec3, position_y: Vec3) -> Vec2 {
    Vec2::new(position_x.length(), position_y.length())
}

/// Standard deviation of the Gaussian at a texel, in texels.
pub fn width(sigma0: f32, stretch: f32, widest: f32) -> f32 {
    let sigma = finite(sigma0).max(0.0);
    let texel = finite(stretch).abs();
    (sigma / texel.max(TEXTURE_DIFFUSION_SMALLEST)).min(widest).max(0.0)
}

/// The unguarded quotient: a naive form.
pub fn width_naive(sigma0: f32, stretch: f32) -> f32 {
    sigma0 / stretch
}

/// Scattering of each channel, made safe.
pub fn sigma(sigma0: Vec3) -> Vec3 {
    let finite = Vec3::new(finite(sigma0.x), finite(sigma0.y), finite(sigma0.z));
    finite.max(Vec3::ZERO)
}

/// The narrowest channel as a share of the widest.
pub fn ratio(sigma0: Vec3) -> f32 {
    let sigma = sigma(sigma0);
    let widest = sigma.x.max(sigma.y).max(sigma.z);
    let narrowest = sigma.x.min(sigma.y).min(sigma.z);
    (narrowest / widest.max(TEXTURE_DIFFUSION_SMALLEST)).clamp(TEXTURE_DIFFUSION_LEAST_RATIO, 1.0)
}

/// Number of pairs of taps, besides the tap in the middle, that keep the error of the blur below
/// 1e-3.
pub fn pairs(sigma0: Vec3) -> u32 {
    let ratio = ratio(sigma0);
    let mut pairs = 15;
    pairs += u32::from(ratio < 0.695);
    pairs += u32::from(ratio < 0.345);
    pairs += u32::from(ratio < 0.248);
    pairs += u32::from(ratio < 0.198);
    pairs += u32::from(ratio < 0.124);
    pairs += u32::from(ratio < 0.104);
    pairs += u32::from(ratio < 0.087);
    pairs += u32::from(ratio < 0.073);
    pairs
}

/// One of a pair of taps on opposite sides of the texel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureDiffusionTap {
    /// Distance from the texel, in standard deviations of the widest channel.
    pub offset: f32,
    /// Weight in each channel, where the tap in the middle has weight 1; the weights are divided by
    /// their sum.
    pub weight: Vec3,
}

/// Position and weights of a pair of taps.
pub fn tap(index: u32, pairs: u32, sigma0: Vec3) -> TextureDiffusionTap {
    let sigma = sigma(sigma0);
    let widest = sigma.x.max(sigma.y).max(sigma.z);
    let relative = (sigma / widest.max(TEXTURE_DIFFUSION_SMALLEST)).max(Vec3::splat(TEXTURE_DIFFUSION_NARROWEST));
    let straight = 0.64 * ratio(sigma0).sqrt().sqrt();
    let last = pairs.max(1);
    let t = index.min(last) as f32 / last as f32;
    let bent = (1.0 - straight) * t * t;
    let apart = 1.0 - bent;
    let offset = (TEXTURE_DIFFUSION_REACH * straight * t / apart).min(TEXTURE_DIFFUSION_REACH);
    let deviations = offset / relative;
    TextureDiffusionTap { offset, weight: (1.0 + bent) / (apart * apart) * (-0.5 * deviations * deviations).exp() }
}

/// Taps at equal distances: a naive form.
pub fn tap_naive(index: u32, pairs: u32, sigma0: Vec3) -> TextureDiffusionTap {
    let widest = sigma0.x.max(sigma0.y).max(sigma0.z);
    let offset = TEXTURE_DIFFUSION_REACH * index as f32 / pairs as f32;
    let deviations = offset / (sigma0 / widest);
    TextureDiffusionTap { offset, weight: (-0.5 * deviations * deviations).exp() }
}

/// Mean irradiance of the part of the surface that the taps hit.
pub fn normalize(sum: Vec3, coverage: Vec3) -> Vec3 {
    sum / coverage.max(Vec3::splat(TEXTURE_DIFFUSION_SMALLEST))
}

/// The sum divided by the sum of the weights, even if taps miss the chart: a naive form.
pub fn normalize_naive(sum: Vec3, total: Vec3) -> Vec3 {
    sum / total
}

/// The nearest half float.
pub fn half(value: Vec3) -> Vec3 {
    let bits = UVec3::from(value.clamp(Vec3::splat(-65504.0), Vec3::splat(65504.0)).to_array().map(f32::to_bits));
    let odd = (bits >> UVec3::splat(13)) & UVec3::splat(1);
    Vec3::from(((bits + 0xfff + odd) & UVec3::splat(0xffff_e000)).to_array().map(f32::from_bits))
}

/// Weight of a covered texel for an empty texel that is `step` texels away.
pub fn nearness(step: Vec2) -> f32 {
    let squared = step.dot(step).max(1.0);
    1.0 / (squared * squared)
}

#[cfg(test)]
mod tests;
