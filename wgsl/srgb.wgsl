// srgb: from scene radiance to display code values: tone curve, luminance, sRGB transfer function and its inverse.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: IEC 61966-2-1:1999 (transfer function); ITU-R BT.709-6, 3.3 (luminance weights); Khronos
//   PBR Neutral Tone Mapper (tone curve).

// Encodes display light into an sRGB code value: the exact two-piece curve.
// Near black the curve is a straight line, because a power alone has an infinite slope at 0. The
// line also keeps the argument of pow, which WGSL evaluates as exp2(y log2 x), away from 0. At the
// standard's threshold, 0.0031308, the two pieces agree to within 3e-8.
// Returns: the code value in [0, 1], not yet quantised.
// Units: display light, 1 = display white; code value, 1 = full scale.
// Domain: any finite value; values outside [0, 1] cannot be displayed and are clamped.
// Outside: nothing.
// Accuracy: lavapipe 2.3e-6 rel; portable 6e-6 rel
fn srgb_encode(light: f32) -> f32 {
    let display = clamp(light, 0.0f, 1.0f);
    if display <= 0.0031308f {
        return 12.92f * display;
    }
    return 1.055f * pow(display, 1.0f / 2.4f) - 0.055f;
}

// Encodes display light with a plain power law of 1/2.2: the cheap rung, one pow and no branch between
// pieces. Its error against the exact curve is at most 0.0336, near 0.002, and 0.0059 above 0.07. Never
// undo srgb_decode by it.
// Returns: the code value in [0, 1].
// Units: the same as for srgb_encode.
// Domain: any finite value; values outside [0, 1] are clamped.
// Outside: nothing.
// Accuracy: lavapipe 3.1e-7 abs; portable 6e-7 abs
fn srgb_encode_gamma(light: f32) -> f32 {
    // pow(0, y) passes through log2(0), which WGSL leaves undefined.
    if light <= 0.0f {
        return 0.0f;
    }
    return pow(min(light, 1.0f), 1.0f / 2.2f);
}

// Decodes an sRGB code value into display light: the exact two-piece curve.
// The threshold is the one in the published standard: 0.04045, which is 12.92 * 0.0031308 to the
// standard's four digits. The threshold in the drafts, 0.03928, which WCAG kept, makes the curve
// jump by 2.5 parts in 10,000.
// Returns: display light in [0, 1].
// Units: the same as for srgb_encode.
// Domain: any finite value; values outside [0, 1] are clamped.
// Outside: nothing.
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
// Units: the same as for srgb_encode; Rec. 709 primaries for input and output.
// Domain: any finite colour; channels outside [0, 1] are clamped.
// Outside: nothing.
// Accuracy: lavapipe 2.3e-6 rel; portable 6e-6 rel
fn srgb_encode_color(color: vec3f) -> vec3f {
    return vec3f(srgb_encode(color.r), srgb_encode(color.g), srgb_encode(color.b));
}

// Decodes a colour, channel by channel.
// Returns: display light in [0, 1].
// Units: the same as for srgb_encode; Rec. 709 primaries for input and output.
// Domain: any finite colour; channels outside [0, 1] are clamped.
// Outside: nothing.
// Accuracy: lavapipe 1.7e-6 rel; portable 6e-6 rel
fn srgb_decode_color(encoded: vec3f) -> vec3f {
    return vec3f(srgb_decode(encoded.r), srgb_decode(encoded.g), srgb_decode(encoded.b));
}

// Relative luminance of a linear colour.
// The weights are the shares of the Rec. 709 primaries in the luminance of white D65, to the
// standard's four digits. They sum to 1.
// Returns: luminance, 1 for white.
// Units: the unit of `color`.
// Domain: channels >= 0, at most 2^126.
// Outside: the same weighted sum, in which channels of opposite sign cancel.
// Accuracy: lavapipe 3 ulp; portable 6 ulp
fn srgb_luminance(color: vec3f) -> f32 {
    return 0.2126f * color.r + 0.7152f * color.g + 0.0722f * color.b;
}

// Khronos PBR Neutral: maps unbounded radiance to [0, 1] and preserves hue and base colours. A toe subtracts
// the 4 % that a dielectric reflects, a shoulder bends the largest channel towards 1 and turns what it removes
// into white. The published form has two branches and three cancellations, this one has neither.
// Returns: linear colour in [0, 1].
// Units: radiance times exposure, 1 = display white; the result is display light.
// Domain: any finite colour up to 2^100; negative channels count as 0.
// Outside: products may overflow.
// Accuracy: lavapipe 7.5 ulp; portable 20 ulp; order kept
fn srgb_tone_curve(color: vec3f) -> vec3f {
    // F90 in Khronos's text: ((1.5 - 1) / (1.5 + 1))^2, the reflectance of index 1.5 at normal
    // incidence.
    let specular = 0.04f;
    // Khronos's K_s = 0.8 - F90: below it, only the toe changes base colours.
    let start = 0.76f;
    // Khronos's K_d: the rate at which the excess turns into white.
    let desaturation = 0.15f;

    // Toe: the smallest channel x becomes x^2 / (4 F90) up to 2 F90, and x - F90 from there on,
    // with continuous value and slope. The other channels keep their distance from it. This equals
    // Khronos's `color - offset`, which for a grey computes x - (x - x^2 / (4 F90)) and so leaves
    // no correct digit for a dark grey.
    let radiance = max(color, vec3f(0.0f));
    let smallest = min(radiance.r, min(radiance.g, radiance.b));
    let curved = min(smallest, 2.0f * specular);
    let toe = curved * curved / (4.0f * specular) + (smallest - curved);
    let base = (radiance - smallest) + toe;

    // Shoulder: start + h e / (e + h). It bends the excess e over `start` into the headroom h below
    // 1, with slope 1 at e = 0. Khronos writes it as 1 - h^2 / (e + h). If no channel exceeds
    // `start`, e is 0 and the ratio is 1.
    let shoulder = max(max(base.r, max(base.g, base.b)), start);
    let headroom = 1.0f - start;
    let excess = shoulder - start;
    let share = excess / (excess + headroom);
    let peak = start + headroom * share;

    // Desaturation: mix with the grey of the new peak in the proportion 1 : K_d * (amount removed
    // by the shoulder). That amount is e - h e / (e + h) = e^2 / (e + h).
    let white = desaturation * excess * share;
    let kept = 1.0f / (white + 1.0f);
    return base * (peak / shoulder * kept) + peak * (white * kept);
}
