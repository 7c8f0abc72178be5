//! Mirror of `wgsl/absorption.wgsl`: the share of light that a coloured medium transmits along a
//! path inside it, by the law of Beer and Lambert.
//!
//! The WGSL file states the units, domain and accuracy of each function. This file follows it line
//! by line.
//!
//! ```
//! use glam::Vec3;
//! use lapidary_absorption::{coefficient, transmittance};
//!
//! // A glass that lets half of the green light through one centimetre, and all of the red.
//! let coefficient = coefficient(Vec3::new(1.0, 0.5, 0.25), 0.01);
//! let left = transmittance(coefficient, 0.02);
//! assert!((left - Vec3::new(1.0, 0.25, 0.0625)).abs().max_element() < 1e-6);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::Vec3;
use std::f32::consts::LN_2;

/// Smallest colour value, 2^-126: darker colours are clamped to it.
pub const ABSORPTION_DARKEST: f32 = 1.175_494_350_822_287_5e-38;
/// From this attenuation distance on, nothing is absorbed.
pub const ABSORPTION_FARTHEST: f32 = 1e30;
/// Shorter attenuation distances count as this one.
pub const ABSORPTION_NEAREST: f32 = 1e-30;

/// Returns the optical depth of a medium that transmits the share `transmittance`:
/// -ln(transmittance).
pub fn optical_depth(transmittance: f32) -> f32 {
    let bits = transmittance.clamp(ABSORPTION_DARKEST, 1.0).to_bits().cast_signed();
    // 0x3f3504f3 is the bit pattern of the square root of 1/2. m lies between that root and its
    // inverse, so |s| is at most 0.1716.
    let exponent = (bits - 0x3f35_04f3) >> 23;
    let mantissa = f32::from_bits((bits - (exponent << 23)).cast_unsigned());
    let s = (mantissa - 1.0) / (mantissa + 1.0);
    let square = s * s;
    let series = 1.0 + square * (0.333_333_34 + square * (0.2 + square * 0.145_95));
    -exponent as f32 * LN_2 - 2.0 * s * series
}

/// Returns the absorption coefficient of a medium that turns white light into `attenuation_color`
/// over the distance `attenuation_distance`.
pub fn coefficient(attenuation_color: Vec3, attenuation_distance: f32) -> Vec3 {
    if attenuation_distance <= 0.0 || attenuation_distance >= ABSORPTION_FARTHEST {
        return Vec3::ZERO;
    }
    let depth = Vec3::new(
        optical_depth(attenuation_color.x),
        optical_depth(attenuation_color.y),
        optical_depth(attenuation_color.z),
    );
    depth / attenuation_distance.max(ABSORPTION_NEAREST)
}

/// Returns the coefficient, computed with the built-in logarithm.
pub fn coefficient_naive(attenuation_color: Vec3, attenuation_distance: f32) -> Vec3 {
    -attenuation_color.map(f32::ln) / attenuation_distance
}

/// Returns the share of light that remains after a path of length `distance` inside the medium.
pub fn transmittance(coefficient: Vec3, distance: f32) -> Vec3 {
    let depth = coefficient * distance.max(0.0);
    let clear = Vec3::ONE;
    Vec3::select(depth.cmpeq(Vec3::ZERO), clear, (-depth).exp().min(clear))
}

/// Returns the transmittance as given in KHR_materials_volume.
pub fn transmittance_naive(attenuation_color: Vec3, attenuation_distance: f32, distance: f32) -> Vec3 {
    attenuation_color.powf(distance / attenuation_distance)
}

#[cfg(test)]
mod tests;
