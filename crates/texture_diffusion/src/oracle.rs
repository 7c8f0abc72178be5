//! Ground truth in f64. Quotients come from logarithms, lengths from hypotenuses, the number of
//! taps from its ladder, and the position and weight of a tap from partial fractions; the
//! mirror has one fraction.

use glam::{DVec2, DVec3, DVec4};

// The module's constants, repeated: a mistake in the module must not carry over to the truth.
const REACH: f64 = 3.4f32 as f64;
const SMALLEST: f64 = 1.0 / (1u64 << 60) as f64;
const MOST: f64 = 1e18f32 as f64;
/// Ratios below which one more pair is added.
const LADDER: [f32; 8] = [0.695, 0.345, 0.248, 0.198, 0.124, 0.104, 0.087, 0.073];

/// Maps NaN to 0 and limits magnitudes to the f32 value of 1e18.
pub fn finite(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value.clamp(-MOST, MOST) }
}

/// Returns the valid value of a number: 0 if it is negative or NaN, at most `MOST`.
fn positive(value: f64) -> f64 {
    if value > 0.0 { value.min(MOST) } else { 0.0 }
}

/// Returns the quotient of positive numbers, from their logarithms.
fn quotient(dividend: f64, divisor: f64) -> f64 {
    if dividend == 0.0 { 0.0 } else { (dividend.log2() - divisor.log2()).exp2() }
}

/// Interpolates from the upper left corner, (-1, 1), to the lower right corner, (1, -1).
pub fn clip(uv: DVec2) -> DVec4 {
    let (upper_left, lower_right) = (DVec2::new(-1.0, 1.0), DVec2::new(1.0, -1.0));
    let place = (DVec2::ONE - uv) * upper_left + uv * lower_right;
    DVec4::new(place.x, place.y, 0.0, 1.0)
}

/// Interpolates from the lower left corner to the upper right corner.
pub fn clip_naive(uv: DVec2) -> DVec4 {
    let place = uv - (DVec2::ONE - uv);
    DVec4::new(place.x, place.y, 0.0, 1.0)
}

/// Computes the lengths as hypotenuses.
pub fn stretch(position_x: DVec3, position_y: DVec3) -> DVec2 {
    let length = |v: DVec3| v.x.hypot(v.y).hypot(v.z);
    DVec2::new(length(position_x), length(position_y))
}

/// Returns the quotient of the valid values.
pub fn width(sigma0: f64, stretch: f64, widest: f64) -> f64 {
    let texel = if stretch.is_nan() { 0.0 } else { stretch.abs() };
    quotient(positive(sigma0), texel.clamp(SMALLEST, MOST)).min(positive(widest))
}

/// Returns the quotient, which is correct for valid values.
pub fn width_naive(sigma0: f64, stretch: f64) -> f64 {
    quotient(sigma0, stretch)
}

/// Returns the valid value of each channel.
pub fn sigma(sigma0: DVec3) -> DVec3 {
    DVec3::from(sigma0.to_array().map(positive))
}

/// Sorts the channels by width and returns the first as a share of the last.
pub fn ratio(sigma0: DVec3) -> f64 {
    let mut channels = sigma0.to_array().map(positive);
    channels.sort_by(f64::total_cmp);
    quotient(channels[0], channels[2].max(SMALLEST)).max(1.0 / 16.0)
}

/// Adds one pair for each step of the ladder above the ratio.
pub fn pairs(sigma0: DVec3) -> u32 {
    let ratio = ratio(sigma0);
    15 + LADDER.iter().filter(|least| ratio < f64::from(**least)).count() as u32
}

/// One of a pair of taps on opposite sides of the texel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureDiffusionTap {
    /// Distance from the texel, in standard deviations of the widest channel.
    pub offset: f64,
    /// Weight in each channel.
    pub weight: DVec3,
}

/// Computes x = c t / (1 - b t²) and its derivative from partial fractions. The poles are at
/// t = ± 1/√b.
pub fn tap(index: u32, pairs: u32, sigma0: DVec3) -> TextureDiffusionTap {
    let channels = sigma0.to_array().map(positive);
    let widest = channels.into_iter().fold(SMALLEST, f64::max);
    let straight = f64::from(0.64f32) * ratio(sigma0).powf(0.25);
    let root = (1.0 - straight).sqrt();
    let t = f64::from(index) / f64::from(pairs.max(1));
    let [near, far] = [1.0 / (1.0 - root * t.min(1.0)), 1.0 / (1.0 + root * t.min(1.0))];
    let offset = REACH * straight * (near - far) / (2.0 * root);
    let spacing = 0.5 * (near * near + far * far);
    let weight = channels.map(|channel| {
        let deviations = offset / quotient(channel, widest).max(1.0 / 4096.0);
        spacing * std::f64::consts::E.powf(-0.5 * deviations.powi(2))
    });
    TextureDiffusionTap { offset, weight: DVec3::from(weight) }
}

/// Computes the Gaussian at equal distances.
pub fn tap_naive(index: u32, pairs: u32, sigma0: DVec3) -> TextureDiffusionTap {
    let offset = REACH * (f64::from(index) / f64::from(pairs));
    let weight = sigma0 / sigma0.max_element();
    let weight = weight.to_array().map(|share| (0.5f64).powf((offset / share).powi(2) / (2.0 * 2f64.ln())));
    TextureDiffusionTap { offset, weight: DVec3::from(weight) }
}

/// Returns the quotients of the magnitudes, with the signs of the sum.
pub fn normalize(sum: DVec3, coverage: DVec3) -> DVec3 {
    let mean = |sum: f64, coverage: f64| quotient(sum.abs(), coverage.max(SMALLEST)).copysign(sum);
    DVec3::new(mean(sum.x, coverage.x), mean(sum.y, coverage.y), mean(sum.z, coverage.z))
}

/// Returns the quotients of the magnitudes, with the signs of the sum.
pub fn normalize_naive(sum: DVec3, total: DVec3) -> DVec3 {
    let mean = |sum: f64, total: f64| quotient(sum.abs(), total).copysign(sum);
    DVec3::new(mean(sum.x, total.x), mean(sum.y, total.y), mean(sum.z, total.z))
}

/// Rounds to a multiple of 2^-10 times the power of two at or below the magnitude.
pub fn half(value: DVec3) -> DVec3 {
    let round = |value: f64| {
        let most = value.abs().min(65504.0);
        if most == 0.0 {
            return 0.0;
        }
        let step = (most.log2().floor() - 10.0).exp2();
        ((most / step).round_ties_even() * step).copysign(value)
    };
    DVec3::from(value.to_array().map(round))
}

/// Raises the distance to the power of -4.
pub fn nearness(step: DVec2) -> f64 {
    step.x.hypot(step.y).max(1.0).powi(-4)
}
