// srgb: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// Encodes with the power piece alone and without a clamp, as much code does to avoid the branch.
// Returns: srgb_encode(light) from 0.0031308 to 1; below that a value that is too dark, and
//   negative under 0.00083.
// Units: the same as for srgb_encode.
// Domain: [0.0031308, 1].
// Outside: -0.055 at 0, where the code value is 0; NaN for negative light, beyond 1 above 1.
// Accuracy: naive
fn srgb_encode_naive(light: f32) -> f32 {
    return 1.055f * pow(light, 1.0f / 2.4f) - 0.055f;
}

// Decodes with 0.03928, the threshold of the standard's drafts, which is still the value copied
// most often.
// Returns: srgb_decode(encoded), except between 0.03928 and 0.04045.
// Units: the same as for srgb_encode.
// Domain: [0, 0.03928] and [0.04045, 1].
// Outside: up to 2.5e-4 relative off between the two thresholds; negative below 0, without bound
//   above 1.
// Accuracy: naive
fn srgb_decode_naive(encoded: f32) -> f32 {
    if encoded <= 0.03928f {
        return encoded / 12.92f;
    }
    return pow((encoded + 0.055f) / 1.055f, 2.4f);
}

// The tone curve as published by Khronos.
// Returns: srgb_tone_curve(color), unless the smallest channel is small.
// Units: the same as for srgb_tone_curve.
// Domain: channels in [0.01, 100].
// Outside: a dark grey x comes out with an absolute error of x 2^-24 where its value is 6.25 x^2; a
//   negative grey, darker than black, comes out bright (-1 as 0.99), since the square in the toe
//   forgets the sign.
// Accuracy: naive
fn srgb_tone_curve_naive(color: vec3f) -> vec3f {
    let start = 0.76f;
    let desaturation = 0.15f;
    let smallest = min(color.r, min(color.g, color.b));
    let offset = select(0.04f, smallest - 6.25f * smallest * smallest, smallest < 0.08f);
    let base = color - offset;
    let peak = max(base.r, max(base.g, base.b));
    if peak < start {
        return base;
    }
    let headroom = 1.0f - start;
    let new_peak = 1.0f - headroom * headroom / (peak + headroom - start);
    let whiteness = 1.0f - 1.0f / (desaturation * (peak - new_peak) + 1.0f);
    return mix(base * (new_peak / peak), vec3f(new_peak), whiteness);
}
