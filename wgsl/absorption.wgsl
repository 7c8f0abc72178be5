// absorption: the share of light that a coloured medium lets through along a path inside, by Beer and Lambert's law.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Khronos, glTF extension KHR_materials_volume, "Attenuation"; Born and Wolf, "Principles
//   of Optics", 7th ed., section 14.1. Abramowitz and Stegun, "Handbook of Mathematical Functions",
//   4.1.27, for the logarithm.

// The smallest colour value: darker colours are clamped to it. It is 2^-126, the smallest value
// that an implementation may not flush to zero. A colour of 0 would absorb without limit. With the
// clamp, 2^-126 of the light remains at the attenuation distance, and 1 % at a nineteenth of it.
const ABSORPTION_DARKEST: f32 = 1.1754943508222875e-38f;
// From this attenuation distance on, nothing is absorbed: glTF's default is infinite, and WGSL may
// assume that there are no infinities.
const ABSORPTION_FARTHEST: f32 = 1e30f;
// Shorter attenuation distances count as this one. A coefficient is then at most 88 / 1e-30, which
// is finite.
const ABSORPTION_NEAREST: f32 = 1e-30f;

// Optical depth of a medium that transmits the share `transmittance`: -ln(transmittance). It does not use
// `log`, whose error near 1 may be as large as the depth of a nearly clear medium: docs/absorption.md.
// Returns: optical depth in [0, 87.34]; exactly 0 for a transmittance of 1.
// Units: none.
// Domain: any transmittance, clamped to [2^-126, 1].
// Outside: nothing.
// Accuracy: lavapipe 6 ulp; portable 16 ulp
fn absorption_optical_depth(transmittance: f32) -> f32 {
    let bits = bitcast<i32>(clamp(transmittance, ABSORPTION_DARKEST, 1.0f));
    // 0x3f3504f3 is the bit pattern of the square root of 1/2. m lies between that root and its
    // inverse, so |s| is at most 0.1716.
    let exponent = (bits - 0x3f3504f3i) >> 23u;
    let mantissa = bitcast<f32>(bits - (exponent << 23u));
    let s = (mantissa - 1.0f) / (mantissa + 1.0f);
    let square = s * s;
    // artanh(s) / s = 1 + s^2 / 3 + s^4 / 5 + s^6 / 7 + ..., truncated here. The last coefficient,
    // 1/7 in the series, is adjusted to absorb the remainder as well, which leaves an error of
    // 7e-9.
    let series = 1.0f + square * (0.33333334f + square * (0.2f + square * 0.14595f));
    return f32(-exponent) * 0.6931472f - 2.0f * s * series;
}

// Absorption coefficient of a medium that turns white light into `attenuation_color` over `attenuation_distance`.
// Returns: -ln(attenuation_color) / attenuation_distance per channel, finite and at least 0; exactly 0 for
//   channels in which the colour is 1.
// Units: the inverse of the unit of `attenuation_distance`.
// Domain: any colour, clamped to [2^-126, 1]; any distance that is not subnormal. Distances that are 0, negative
//   or at least 1e30 mean that nothing is absorbed, and give 0. Positive distances below 1e-30 count as 1e-30.
// Outside: subnormal distances count as 1e-30 or as 0.
// Accuracy: lavapipe 7 ulp; portable 19 ulp
fn absorption_coefficient(attenuation_color: vec3f, attenuation_distance: f32) -> vec3f {
    if (attenuation_distance <= 0.0f || attenuation_distance >= ABSORPTION_FARTHEST) {
        return vec3f(0.0f);
    }
    let depth = vec3f(
        absorption_optical_depth(attenuation_color.x),
        absorption_optical_depth(attenuation_color.y),
        absorption_optical_depth(attenuation_color.z),
    );
    return depth / max(attenuation_distance, ABSORPTION_NEAREST);
}

// Share of light that remains after a path of length `distance` inside the medium. For two paths in
// succession, multiply the transmittances.
// Returns: exp(-coefficient distance) per channel, in [0, 1]; exactly 1 if the coefficient or the
//   distance is 0; at optical depths of 88 and more, either 0 or a value below 2^-126.
// Units: none; the coefficient's unit is the inverse of the distance's.
// Domain: coefficient in [0, 1e32]; distance up to 1e6, with negative distances counted as 0.
// Outside: overflows where the product exceeds 3e38; 1 for a negative coefficient.
// Accuracy: lavapipe 3.5 ulp + 2.5 backward; portable 4 ulp + 3 backward
fn absorption_transmittance(coefficient: vec3f, distance: f32) -> vec3f {
    let depth = coefficient * max(distance, 0.0f);
    // A depth of 0 is handled separately, and the result is limited to 1: WGSL allows exp an error
    // of 3 ulp near 0, but a colourless stone must not gain or lose light.
    let clear = vec3f(1.0f);
    return select(min(exp(-depth), clear), clear, depth == vec3f(0.0f));
}
