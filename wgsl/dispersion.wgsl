// dispersion: refractive indices by wavelength, and one traced ray that carries the directions of all wavelengths.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Imagire, "Proxy Geometry Gem Rendering", eq. (10)-(12); the exact tracker differentiates
//   Snell's law, eq. (6). Born and Wolf, "Principles of Optics", 7th ed., 2.3.4, for Sellmeier's
//   and Cauchy's formulas. Coefficients: Peter 1923 (diamond), Malitson 1962 (corundum), Ghosh 1999
//   (quartz), Schott (N-BK7), Wood and Nassau 1982 (cubic zirconia), DeVore 1951 (rutile), Dodge
//   1986 (strontium titanate). Khronos, glTF 2.0, KHR_materials_dispersion.
//
// The tracker follows one ray at a reference wavelength through the stone, as refraction.wgsl does,
// and carries g = d(direction) / d(index of the gem) along with it. At a wavelength with the index
// n_0 + offset, the direction is then r_0 + offset g.

// A material's index of refraction: n^2 - 1 = constant + sum of strengths w^2 / (w^2 - resonances),
// with the wavelength w in µm.
struct DispersionSellmeier {
    constant: f32,
    strengths: vec3f,
    // Squares of the resonance wavelengths, in µm^2.
    resonances: vec3f,
}

// Corundum, quartz and rutile are birefringent; these values are for the ordinary ray.
const DISPERSION_DIAMOND = DispersionSellmeier(0.0f, vec3f(0.3306f, 4.3356f, 0.0f), vec3f(0.030625f, 0.011236f, 0.0f));
const DISPERSION_CORUNDUM = DispersionSellmeier(
    0.0f,
    vec3f(1.4313493f, 0.65054713f, 5.3414021f),
    vec3f(0.0052799261f, 0.0142382647f, 325.017834f),
);
const DISPERSION_QUARTZ = DispersionSellmeier(
    0.28604141f,
    vec3f(1.07044083f, 1.10202242f, 0.0f),
    vec3f(0.0100585997f, 100.0f, 0.0f),
);
// N-BK7, the common optical crown glass.
const DISPERSION_CROWN_GLASS = DispersionSellmeier(
    0.0f,
    vec3f(1.03961212f, 0.231792344f, 1.01046945f),
    vec3f(0.00600069867f, 0.0200179144f, 103.560653f),
);
const DISPERSION_CUBIC_ZIRCONIA = DispersionSellmeier(
    0.0f,
    vec3f(1.347091f, 2.117788f, 9.452943f),
    vec3f(0.00391162685f, 0.0278018941f, 591.490125f),
);
// DeVore's n^2 = 5.913 + 0.2441 / (w^2 - 0.0803), converted to this form: the strength is
// 0.2441 / 0.0803, and the constant is the remainder.
const DISPERSION_RUTILE = DispersionSellmeier(1.87314944f, vec3f(3.03985056f, 0.0f, 0.0f), vec3f(0.0803f, 0.0f, 0.0f));
const DISPERSION_STRONTIUM_TITANATE = DispersionSellmeier(
    0.0f,
    vec3f(3.042143f, 1.170065f, 30.83326f),
    vec3f(0.0217828671f, 0.0872071692f, 1101.31458f),
);

// Fraunhofer lines, in nm. Gemmologists measure dispersion as n_G - n_B, opticians as
// V_d = (n_d - 1) / (n_F - n_C).
const DISPERSION_LINE_B: f32 = 686.7f;
const DISPERSION_LINE_C: f32 = 656.3f;
// The d line of helium. An index given without a wavelength is the index at this line.
const DISPERSION_LINE_D: f32 = 587.6f;
const DISPERSION_LINE_F: f32 = 486.1f;
const DISPERSION_LINE_G: f32 = 430.8f;

// Wavelengths in nm that represent the colour channels when three wavelengths are traced: the
// centroids of linear sRGB's colour matching functions (CIE 1931, 2 degrees) under D65, each over
// its main positive lobe, to 1 nm. A test computes them.
const DISPERSION_RED: f32 = 609.0f;
const DISPERSION_GREEN: f32 = 539.0f;
const DISPERSION_BLUE: f32 = 453.0f;

// The paper's other two channels as frequencies relative to its reference, red: lambda / lambda_0
// of eq. (12), above 1. A ratio of wavelengths would reverse the order of the colours.
const DISPERSION_PAPER_GREEN: f32 = DISPERSION_RED / DISPERSION_GREEN;
const DISPERSION_PAPER_BLUE: f32 = DISPERSION_RED / DISPERSION_BLUE;

// The paper's small number. The 99th percentile of eq. (11)'s error, measured in f32 over
// refractions out of a stone with n cos(angle of refraction) of at least 0.1, is 2.3e-7 / epsilon
// of noise and 3.5 epsilon of truncation. The error is 1.2e-3 where the two meet, at an epsilon
// from 2e-4 to 3e-4.
const DISPERSION_PAPER_EPSILON: f32 = 2e-4f;

// The square of 2^-20. Shorter chords are noise, because each end is a unit vector with an error of
// about 2^-24.
const DISPERSION_PAPER_CHORD: f32 = 9.094947017729282e-13f;

// The smallest n cos(angle of refraction) by which a gradient is divided. Its square changes by
// about 2 |b| offset with the index, where b = (slope / n) sin^2 + c dc as in dispersion_refract
// (0.1 or so out of diamond). For diamond's blue, with offset 0.02, that is (1/16)^2. Closer to the
// critical angle, such a wavelength may be totally reflected, and a first derivative, which tends
// to infinity, is meaningless.
const DISPERSION_CRITICAL: f32 = 0.0625f;

// Index of refraction by Sellmeier's formula.
// Returns: the index, at least 1.
// Units: vacuum wavelength in nm.
// Domain: wavelength in [380, 780]; strengths in [0, 40]; each resonance at most 0.1 or at least 50
//   (µm^2); constant in [0, 2]. This includes the resonances of all transparent stones, even the
//   near-ultraviolet ones of strontium titanate and rutile.
// Outside: the same formula while no resonance is met; infinite or not a number where wavelength^2
//   is a resonance.
// Accuracy: lavapipe 6 ulp; portable 20 ulp
fn dispersion_sellmeier(material: DispersionSellmeier, wavelength: f32) -> f32 {
    // From nm² to µm².
    let squared = wavelength * wavelength * 1e-6f;
    let terms = squared / (squared - material.resonances);
    // Clamped to at least 1 both before and after the square root: WGSL's square root of 1 may be
    // less than 1.
    return max(sqrt(max(1.0f + material.constant + dot(material.strengths, terms), 1.0f)), 1.0f);
}

// Index of refraction by Cauchy's formula, a + b / w^2 + c / w^4, which is sufficient for visible
// light far from any resonance.
// Returns: the index.
// Units: wavelength in nm; coefficients (a, b, c) in 1, µm^2, µm^4.
// Domain: wavelength in [380, 780], a in [1, 4], b in [0, 0.1], c in [0, 0.01].
// Outside: the same formula, while the wavelength is in [1e-3, 1e9].
// Accuracy: lavapipe 6 ulp; portable 10 ulp
fn dispersion_cauchy(coefficients: vec3f, wavelength: f32) -> f32 {
    // From nm² to µm².
    let squared = wavelength * wavelength * 1e-6f;
    return coefficients.x + (coefficients.y + coefficients.z / squared) / squared;
}

// Index of refraction as defined by glTF (KHR_materials_dispersion): the first two terms of
// Cauchy's formula, from the index at the d line and the Abbe number V_d = 20 / dispersion. At the
// wavelength of that line, the result differs from the index by 2e-4 (n_d - 1) / V_d.
// Returns: the index, at least 1.
// Units: wavelength in nm; `dispersion` as in glTF, 20 / V_d.
// Domain: wavelength in [380, 780], index in [1, 4], dispersion in [0, 64]; 0 means no dispersion,
//   the same index at every wavelength.
// Outside: the same formula, while the wavelength is in [1e-3, 1e9].
// Accuracy: lavapipe 2 ulp + 4 backward; portable 4 ulp + 8 backward
fn dispersion_abbe(index: f32, dispersion: f32, wavelength: f32) -> f32 {
    let spread = (index - 1.0f) * dispersion / 20.0f;
    return max(index + spread * (523655.0f / (wavelength * wavelength) - 1.5168f), 1.0f);
}

// The Abbe number V_d from the indices at Fraunhofer lines. glTF's dispersion is 20 / V_d.
// Returns: (n_d - 1) / (n_F - n_C).
// Units: none.
// Domain: indices in [1, 4]. If n_F - n_C < 1e-12, there is no dispersion and the divisor is 1e-12,
//   which makes the result effectively infinite.
// Outside: the same quotient.
// Accuracy: lavapipe 1.5 ulp; portable 4 ulp
fn dispersion_abbe_number(index_d: f32, index_f: f32, index_c: f32) -> f32 {
    return (index_d - 1.0f) / max(index_f - index_c, 1e-12f);
}

// The gradient after a ray enters the gem, -(t + |t|^2 / root normal) / n^2: dispersion_refract for a gradient of 0,
// at less cost. t is the ray's tangential part; root, n cos(angle of refraction), is at least DISPERSION_CRITICAL.
// Returns: d(refracted direction) / d(relative_index).
// Units: none; unit vectors and a ratio, index_gem / index_outside. If the outside is not air, divide the result by
//   its index to get the derivative with respect to the gem's own index.
// Domain: |direction| = |normal| = 1, normal . direction <= 0, relative_index in [1, 4].
// Outside: finite. A gem in a denser medium takes dispersion_refract, which knows total internal reflection. A
//   normal that faces away is taken to be at grazing incidence, as refraction.wgsl does.
// Accuracy: lavapipe 8 ulp + 6 backward; portable 16 ulp + 12 backward
fn dispersion_enter(direction: vec3f, normal: vec3f, relative_index: f32) -> vec3f {
    let cosine = max(-dot(normal, direction), 0.0f);
    let radicand = (relative_index - 1.0f) * (relative_index + 1.0f) + cosine * cosine;
    let tangent = direction + cosine * normal;
    let across = dot(tangent, tangent) / sqrt(max(radicand, DISPERSION_CRITICAL * DISPERSION_CRITICAL));
    return (tangent + across * normal) / (-relative_index * relative_index);
}

// The gradient after a refraction: the derivative of refraction.wgsl's direction, for both branches.
// Returns: d(direction) / d(index of the gem), at most 17 / n (|gradient| + |slope| / n) long, and perpendicular
//   to the new direction unless the root is clamped. Under total internal reflection it is the reflected gradient.
// Units: none; unit vectors and ratios. `relative_index_slope` is d(relative_index) / d(index of the gem): 1 /
//   index_outside on the way in, 1 in air; -relative_index / index_gem on the way out, -1 / index_gem^2 into air.
// Domain: |direction| = |normal| = 1, normal . direction <= 0, relative_index in [1/4, 4], gradient . direction =
//   0, |gradient| in [2^-40, 2^40] or 0, |relative_index_slope| in [2^-40, 1] or 0.
// Outside: finite. A normal that faces away is taken to be at grazing incidence, as refraction.wgsl does.
// Accuracy: lavapipe 96 ulp + 10 backward; portable 192 ulp + 20 backward; order kept
fn dispersion_refract(
    direction: vec3f,
    gradient: vec3f,
    normal: vec3f,
    relative_index: f32,
    relative_index_slope: f32,
) -> vec3f {
    let cosine = max(-dot(normal, direction), 0.0f);
    let cosine_slope = -dot(normal, gradient);
    let radicand = (relative_index - 1.0f) * (relative_index + 1.0f) + cosine * cosine;
    if (radicand < 0.0f) {
        return gradient + 2.0f * cosine_slope * normal;
    }
    let tangent = direction + cosine * normal;
    let bending = relative_index_slope / relative_index;
    let leaning = gradient + cosine_slope * normal - bending * tangent;
    // If the gradient lies along the normal, rounding leaves a larger part along the normal than
    // remains along the surface. The normal part is therefore removed a second time.
    let along = leaning - dot(normal, leaning) * normal;
    let across = (bending * dot(tangent, tangent) + cosine * cosine_slope) / max(sqrt(radicand), DISPERSION_CRITICAL);
    return (along - across * normal) / relative_index;
}

// The gradient after a reflection. Reflection is linear, so all wavelengths are treated alike.
// Returns: the reflected gradient, g - 2 (n . g) n. The normal may point to either side.
// Units: any; `normal` is a unit vector.
// Domain: |normal| = 1, |gradient| up to 1e37.
// Outside: for other lengths of the normal the same linear map, which then is no reflection.
// Accuracy: lavapipe 10 ulp; portable 18 ulp
fn dispersion_reflect(gradient: vec3f, normal: vec3f) -> vec3f {
    return gradient - 2.0f * dot(normal, gradient) * normal;
}

// The direction at another wavelength. Inside the stone it can also be used to decide total
// internal reflection for each wavelength: refract this direction exactly, with that wavelength's
// own index.
// Returns: unit direction, normalize(direction + index_offset gradient).
// Units: none; `index_offset` is the index at that wavelength minus the index at which `direction`
//   was traced.
// Domain: |direction| = 1, gradient . direction = 0, |index_offset gradient| up to 1e18.
// Outside: not a number where the sum is 0, which a perpendicular gradient cannot bring about.
// Accuracy: lavapipe 4 ulp + 2 backward; portable 17 ulp + 3 backward
fn dispersion_direction(direction: vec3f, gradient: vec3f, index_offset: f32) -> vec3f {
    return normalize(direction + index_offset * gradient);
}

// Eq. (10): the direction in which a ray spreads on entry, from the chord between the ray and the
// refracted ray. If the two coincide, at normal incidence or for equal indices, there is no
// dispersion and the result is 0.
// Returns: unit vector, which deviates from the derivative's direction by half the angle of
//   deviation; 0 for a chord below 2^-20.
// Units: none; unit vectors.
// Domain: |direction| = |refracted| = 1.
// Outside: the same quotient.
// Accuracy: lavapipe 3 ulp + 1 backward; portable 18 ulp + 2 backward
fn dispersion_paper_enter(direction: vec3f, refracted: vec3f) -> vec3f {
    let chord = refracted - direction;
    let squared = dot(chord, chord);
    if (squared < DISPERSION_PAPER_CHORD) {
        return vec3f(0.0f);
    }
    return chord / sqrt(squared);
}
