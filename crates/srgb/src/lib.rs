//! Mirror of `wgsl/srgb.wgsl`: from scene radiance to display code values. The comments of the WGSL
//! file state the reasons, domains and accuracies.
//!
//! ```
//! use lapidary_srgb::{decode, encode};
//!
//! // Middle grey.
//! assert!((255.0 * encode(0.18) - 117.6).abs() < 0.1);
//! assert!((decode(encode(0.18)) - 0.18).abs() < 1e-6);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::Vec3;

/// Encodes display light into an sRGB code value with the exact two-piece curve of
/// IEC 61966-2-1:1999.
pub fn encode(light: f32) -> f32 {
    let display = light.clamp(0.0, 1.0);
    if display <= 0.0031308 {
        return 12.92 * display;
    }
    1.055 * display.powf(1.0 / 2.4) - 0.055
}

/// The power piece of [`encode`] alone, unclamped: negative near black, NaN below 0.
pub fn encode_naive(light: f32) -> f32 {
    1.055 * light.powf(1.0 / 2.4) - 0.055
}

/// Encodes display light with a plain power law of 1/2.2: the cheap rung.
pub fn encode_gamma(light: f32) -> f32 {
    // pow(0, y) passes through log2(0), which WGSL leaves undefined.
    if light <= 0.0 {
        return 0.0;
    }
    light.min(1.0).powf(1.0 / 2.2)
}

/// Decodes an sRGB code value into display light with the exact two-piece curve.
pub fn decode(encoded: f32) -> f32 {
    let code = encoded.clamp(0.0, 1.0);
    if code <= 0.04045 {
        return code / 12.92;
    }
    ((code + 0.055) / 1.055).powf(2.4)
}

/// [`decode`] with the threshold of the standard's drafts, 0.03928.
pub fn decode_naive(encoded: f32) -> f32 {
    if encoded <= 0.03928 {
        return encoded / 12.92;
    }
    ((encoded + 0.055) / 1.055).powf(2.4)
}

/// Encodes a colour with [`encode`], channel by channel.
pub fn encode_color(color: Vec3) -> Vec3 {
    Vec3::new(encode(color.x), encode(color.y), encode(color.z))
}

/// Decodes a colour with [`decode`], channel by channel.
pub fn decode_color(encoded: Vec3) -> Vec3 {
    Vec3::new(decode(encoded.x), decode(encoded.y), decode(encoded.z))
}

/// Relative luminance of a linear Rec. 709 colour.
pub fn luminance(color: Vec3) -> f32 {
    0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z
}

/// Khronos PBR Neutral without branches or cancellations: maps radiance times exposure to display
/// light in [0, 1].
pub fn tone_curve(color: Vec3) -> Vec3 {
    // F90 in Khronos's text: ((1.5 - 1) / (1.5 + 1))^2, the reflectance of index 1.5 at normal
    // incidence.
    let specular = 0.04f32;
    // Khronos's K_s = 0.8 - F90.
    let start = 0.76f32;
    // Khronos's K_d.
    let desaturation = 0.15f32;

    // Toe: the smallest channel x becomes x^2 / (4 F90) up to 2 F90, and x - F90 from there on. The
    // other channels keep their distance from it.
    let radiance = color.max(Vec3::ZERO);
    let smallest = radiance.x.min(radiance.y.min(radiance.z));
    let curved = smallest.min(2.0 * specular);
    let toe = curved * curved / (4.0 * specular) + (smallest - curved);
    let base = (radiance - smallest) + toe;

    // Shoulder: bends the excess e over `start` into the headroom h below 1.
    let shoulder = base.x.max(base.y.max(base.z)).max(start);
    let headroom = 1.0 - start;
    let excess = shoulder - start;
    let share = excess / (excess + headroom);
    let peak = start + headroom * share;

    // Desaturation: the amount removed by the shoulder, e^2 / (e + h), turns into white.
    let white = desaturation * excess * share;
    let kept = 1.0 / (white + 1.0);
    base * (peak / shoulder * kept) + peak * (white * kept)
}

/// The tone curve as published by Khronos.
pub fn tone_curve_naive(color: Vec3) -> Vec3 {
    let start = 0.76f32;
    let desaturation = 0.15f32;
    let smallest = color.x.min(color.y.min(color.z));
    let offset = if smallest < 0.08 { smallest - 6.25 * smallest * smallest } else { 0.04 };
    let base = color - offset;
    let peak = base.x.max(base.y.max(base.z));
    if peak < start {
        return base;
    }
    let headroom = 1.0 - start;
    let new_peak = 1.0 - headroom * headroom / (peak + headroom - start);
    let whiteness = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    (base * (new_peak / peak)).lerp(Vec3::splat(new_peak), whiteness)
}

#[cfg(test)]
mod tests;
