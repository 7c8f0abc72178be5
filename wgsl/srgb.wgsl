// srgb: from scene radiance to display code values: tone curve, luminance, sRGB transfer function and its inverse.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0, hash e69664fd168512a3
// Source: IEC 61966-2-1:1999 (transfer function); ITU-R BT.709-6, 3.3 (luminance weights); Khronos PBR Neutral Tone Mapper (tone curve).

// Encodes display light into an sRGB code value: the exact two-piece curve.
// Near black the curve is a straight line, because a power alone has infinite slope at 0; the line also keeps
// pow, which WGSL evaluates as exp2(y log2 x), away from 0. The pieces meet to 3e-8 at the standard's 0.0031308.
// Returns: the code value in [0, 1], not yet quantised.
// Units: display light, 1 = display white; code value, 1 = full scale.
// Domain: any finite value; values outside [0, 1] cannot be displayed and are clamped.
// Outside: nothing is outside.
// Accuracy: lavapipe 2.3e-6 rel; portable 6e-6 rel
fn srgb_encode(light: f32) -> f32 {
    let display = clamp(light, 0.0f, 1.0f);
    if display <= 0.0031308f {
        return 12.92f * display;
    }
    return 1.055f * pow(display, 1.0f / 2.4f) - 0.055f;
}

// Encodes display light with a plain power law of 1/2.2: the cheap rung, one pow and no pieces.
// Against the exact curve it is off by at most 0.0336 (9 of 255 steps; too bright, in the shadows near 0.002) and,
// above 0.07, by at most 0.0059 (1.5 steps). Never use it to undo srgb_decode.
// Returns: the code value in [0, 1].
// Units: as srgb_encode.
// Domain: any finite value; values outside [0, 1] are clamped.
// Outside: nothing is outside.
// Accuracy: lavapipe 3.1e-7 abs; portable 6e-7 abs
fn srgb_encode_gamma(light: f32) -> f32 {
    // pow(0, y) passes through log2(0), which WGSL leaves undefined.
    if light <= 0.0f {
        return 0.0f;
    }
    return pow(min(light, 1.0f), 1.0f / 2.2f);
}

// Decodes an sRGB code value into display light: the exact two-piece curve.
// The threshold is that of the published standard, 0.04045 = 12.92 * 0.0031308 to its four digits; the drafts'
// 0.03928, which WCAG carried on, break the curve by 2.5 parts in 10,000 there.
// Returns: display light in [0, 1].
// Units: as srgb_encode.
// Domain: any finite value; values outside [0, 1] are clamped.
// Outside: nothing is outside.
// Accuracy: lavapipe 1.7e-6 rel; portable 6e-6 rel
fn srgb_decode(encoded: f32) -> f32 {
    let code = clamp(encoded, 0.0f, 1.0f);
    if code <= 0.04045f {
        return code / 12.92f;
    }
    return pow((code + 0.055f) / 1.055f, 2.4f);
}

// Encodes a colour, channel by channel.
// Returns: code values in [0, 1].
// Units: as srgb_encode; Rec. 709 primaries on both sides.
// Domain: any finite colour; channels outside [0, 1] are clamped.
// Outside: nothing is outside.
// Accuracy: lavapipe 2.3e-6 rel; portable 6e-6 rel
fn srgb_encode_color(color: vec3f) -> vec3f {
    return vec3f(srgb_encode(color.r), srgb_encode(color.g), srgb_encode(color.b));
}

// Decodes a colour, channel by channel.
// Returns: display light in [0, 1].
// Units: as srgb_encode; Rec. 709 primaries on both sides.
// Domain: any finite colour; channels outside [0, 1] are clamped.
// Outside: nothing is outside.
// Accuracy: lavapipe 1.7e-6 rel; portable 6e-6 rel
fn srgb_decode_color(encoded: vec3f) -> vec3f {
    return vec3f(srgb_decode(encoded.r), srgb_decode(encoded.g), srgb_decode(encoded.b));
}

// Relative luminance of a linear colour.
// The weights are what the Rec. 709 primaries add to white D65, to the standard's four digits; they sum to 1.
// Returns: luminance, 1 for white.
// Units: that of `color`.
// Domain: channels >= 0, at most 2^126.
// Outside: the same weighted sum, in which channels of opposite sign cancel.
// Accuracy: lavapipe 3 ulp; portable 6 ulp
fn srgb_luminance(color: vec3f) -> f32 {
    return 0.2126f * color.r + 0.7152f * color.g + 0.0722f * color.b;
}

// Khronos PBR Neutral: brings unbounded radiance into [0, 1] and leaves hue and base colours alone.
// A toe takes away the 4 % that a dielectric reflects at normal incidence, a shoulder bends the largest channel
// towards 1 along a hyperbola, and what the shoulder took away turns into white. Published with two branches and three
// cancellations; written here without either, so that a dark grey keeps its digits and a black needs no guard.
// Returns: linear colour in [0, 1].
// Units: radiance times exposure, 1 = display white; the result is display light.
// Domain: any finite colour up to 2^100; a negative channel counts as 0.
// Outside: products may overflow.
// Accuracy: lavapipe 7.5 ulp; portable 20 ulp; order kept
fn srgb_tone_curve(color: vec3f) -> vec3f {
    // F90 of Khronos's text: ((1.5 - 1) / (1.5 + 1))^2, the reflectance of index 1.5 at normal incidence.
    let specular = 0.04f;
    // Khronos's K_s = 0.8 - F90: below it, base colours pass unchanged but for the toe.
    let start = 0.76f;
    // Khronos's K_d: how fast the excess turns into white.
    let desaturation = 0.15f;

    // Toe: the smallest channel x becomes x^2 / (4 F90) up to 2 F90 and x - F90 from there, value and slope
    // continuous; the others keep their distance to it. That is Khronos's `color - offset`, which leaves
    // x - (x - x^2 / (4 F90)) for a grey and with it no digit for a dark one.
    let radiance = max(color, vec3f(0.0f));
    let smallest = min(radiance.r, min(radiance.g, radiance.b));
    let curved = min(smallest, 2.0f * specular);
    let toe = curved * curved / (4.0f * specular) + (smallest - curved);
    let base = (radiance - smallest) + toe;

    // Shoulder: start + h e / (e + h), the excess e over `start` bent into the headroom h below 1; slope 1 at e = 0.
    // Khronos writes it 1 - h^2 / (e + h). Where nothing exceeds `start`, e is 0 and the ratio 1.
    let shoulder = max(max(base.r, max(base.g, base.b)), start);
    let headroom = 1.0f - start;
    let excess = shoulder - start;
    let share = excess / (excess + headroom);
    let peak = start + headroom * share;

    // Desaturation: mix with the grey of the new peak in proportion 1 : K_d * (what the shoulder took away),
    // and that is e - h e / (e + h) = e^2 / (e + h).
    let white = desaturation * excess * share;
    let kept = 1.0f / (white + 1.0f);
    return base * (peak / shoulder * kept) + peak * (white * kept);
}
