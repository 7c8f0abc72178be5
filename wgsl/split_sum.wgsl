// split_sum: a rough metal under an environment: light prefiltered by roughness, times a table of reflectance (GGX).
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course, for the split of the sum and both tables;
//   Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994, eq. (15); Krivanek and Colbert,
//   "Real-time Shading with Filtered Importance Sampling", 2008, for a sample's solid angle; Heitz, "Understanding the
//   Masking-Shadowing Function in Microfacet-Based BRDFs", 2014, eq. (99); Kulla and Conty, "Revisiting Physically
//   Based Shading at Imageworks", SIGGRAPH 2017 course, and Turquin, "Practical Multiple Scattering Compensation for
//   Microfacet Models", 2019, for light that meets several facets. Own: the share that meets a third.
//
// `alpha` is the width of the distribution, a slope: the square of glTF's roughness. `f0` is the colour of a metal: the
// share of light that it reflects head on. A texel of the table is the mean of `split_sum_albedo` over facets that the
// eye sees (`microfacet_facet` draws them); a texel of the environment is the mean of its radiance over
// `split_sum_lobe`, by weight. With the two, light towards the eye is
//
//   prefiltered(reflected, alpha) * split_sum_reflectance(f0, table(split_sum_place(cosine_eye, alpha, size)))

// Smaller values of alpha count as this one, as they do in `microfacet`.
const SPLIT_SUM_SMOOTHEST: f32 = 0.001f;
// An eye nearer to grazing counts as this cosine, so that the quotient of the shadowing is finite in f32: at most 2e15.
const SPLIT_SUM_GRAZING: f32 = 1e-15f;
// Albedos below this one count as it. That of alpha 1, head on, is 0.307.
const SPLIT_SUM_LEAST: f32 = 0.25f;
// Of the light that leaves a second or later facet, the share of single scattering's loss that meets one more. Fitted
// to random walks on the facets at constant reflectance, where the total is right to 1.3 %.
const SPLIT_SUM_STAYING: f32 = 0.72f;

// Share of light that a facet of a metal reflects, by Schlick: all of it at grazing incidence.
// Returns: f0 + (1 - f0) (1 - cosine)^5, in [f0, 1].
// Units: none; shares of light.
// Domain: f0 in [0, 1]; any cosine, clamped to [0, 1].
// Outside: finite for f0 up to 1e30 in magnitude.
// Accuracy: lavapipe 8 ulp; portable 16 ulp
fn split_sum_fresnel(f0: vec3f, cosine: f32) -> vec3f {
    let rest = 1.0f - clamp(cosine, 0.0f, 1.0f);
    let squared = rest * rest;
    return f0 + (1.0f - f0) * (squared * squared * rest);
}

// A point of Hammersley's set: of the unit square each part holds as many as it has area, up to a few.
// Returns: x is the index with its bits behind the binary point, in reverse, cut to 24; y is index / count. Both in [0,
//   1).
// Units: none.
// Domain: index below count, count at most 2^24.
// Outside: y is the float before 1; a count of 0 counts as 1.
// Accuracy: lavapipe 1 ulp; portable 3 ulp
fn split_sum_point(index: u32, count: u32) -> vec2f {
    // GLSL ES has no function that reverses bits: halves change places, then quarters, down to single bits.
    var bits = (index << 16u) | (index >> 16u);
    bits = ((bits & 0x00ff00ffu) << 8u) | ((bits >> 8u) & 0x00ff00ffu);
    bits = ((bits & 0x0f0f0f0fu) << 4u) | ((bits >> 4u) & 0x0f0f0f0fu);
    bits = ((bits & 0x33333333u) << 2u) | ((bits >> 2u) & 0x33333333u);
    bits = ((bits & 0x55555555u) << 1u) | ((bits >> 1u) & 0x55555555u);
    return vec2f(f32(bits >> 8u) * 5.9604645e-8f, min(f32(index) / f32(max(count, 1u)), 0.99999994f));
}

// The cosine of the eye and the alpha that a texel of the table of reflectance stands for: squares of even steps.
// Returns: x is the cosine of the eye, 0 in the first column and 1 in the last; y is alpha, 0 and 1.
// Units: texels; the cosine is to the surface normal, alpha is a slope.
// Domain: texel below size in both, size from 2 to 4096.
// Outside: finite; a size below 2 counts as 2.
// Accuracy: lavapipe 4 ulp; portable 9 ulp
fn split_sum_texel(texel: vec2u, size: vec2u) -> vec2f {
    let steps = vec2f(max(size, vec2u(2u)) - vec2u(1u));
    let share = vec2f(texel) / steps;
    return share * share;
}

// Where the table of reflectance is to be read, with a sampler that blends and clamps.
// Returns: x, y in (0, 1): at the middle of a texel for what `split_sum_texel` gives for it.
// Units: fractions of the table; the cosine is to the surface normal, alpha is a slope.
// Domain: any cosine and alpha, clamped to [0, 1] and [0.001, 1]; size from 2 to 4096.
// Outside: a size below 2 counts as 2.
// Accuracy: lavapipe 5 ulp; portable 14 ulp
fn split_sum_place(cosine_eye: f32, alpha: f32, size: vec2u) -> vec2f {
    let texels = vec2f(max(size, vec2u(2u)));
    let share = sqrt(vec2f(clamp(cosine_eye, 0.0f, 1.0f), clamp(alpha, SPLIT_SUM_SMOOTHEST, 1.0f)));
    return (share * (texels - 1.0f) + 0.5f) / texels;
}

// Share of the facets seen by the eye that the light sees too: Smith's height-correlated G2, divided by G1 of the eye.
// All that tends to 0 where the eye is grazing has cancelled.
// Returns: n.l (n.v + sqrt(alpha^2 + (1 - alpha^2) n.v^2)) / (n.l sqrt(alpha^2 + (1 - alpha^2) n.v^2) + n.v
//   sqrt(alpha^2 + (1 - alpha^2) n.l^2)), in [0, 1] up to rounding.
// Units: none; the cosines are to the surface normal, alpha is a slope.
// Domain: any cosines and alpha, clamped: the light's to [0, 1], the eye's to [1e-15, 1], alpha to [0.001, 1].
// Outside: nothing.
// Accuracy: lavapipe 12 ulp; portable 36 ulp; order kept
fn split_sum_shadowing(cosine_light: f32, cosine_eye: f32, alpha: f32) -> f32 {
    let a = clamp(alpha, SPLIT_SUM_SMOOTHEST, 1.0f);
    let l = clamp(cosine_light, 0.0f, 1.0f);
    let v = clamp(cosine_eye, SPLIT_SUM_GRAZING, 1.0f);
    let squared = a * a;
    let rest = (1.0f - a) * (1.0f + a);
    let eye = sqrt(squared + rest * v * v);
    let light = sqrt(squared + rest * l * l);
    return l * ((v + eye) / (l * eye + v * light));
}

// What one facet that the eye sees adds to its texel of the table. Its reflectance is a + b f0 in every f0; the mean
// over the facets is that of the surface, and the sum of both parts the albedo at f0 = 1.
// Returns: x is the factor of f0, y the rest, in [0, 1] up to rounding.
// Units: none. `facing` is the cosine between facet and eye; the others are to the surface normal, alpha is a slope.
// Domain: any cosines and alpha, clamped: to [0, 1], the eye's to [1e-15, 1], alpha to [0.001, 1]. No facet sees a
//   light below the surface.
// Outside: nothing.
// Accuracy: lavapipe 22 ulp; portable 56 ulp; order kept
fn split_sum_albedo(facing: f32, cosine_light: f32, cosine_eye: f32, alpha: f32) -> vec2f {
    let cosine = clamp(facing, 0.0f, 1.0f);
    let rest = 1.0f - cosine;
    let grazing = rest * rest * (rest * rest) * rest;
    return split_sum_shadowing(cosine_light, cosine_eye, alpha) * vec2f(1.0f - grazing, grazing);
}

// A direction that a texel of the environment takes light from.
struct SplitSumLobe {
    // Unit direction.
    toward: vec3f,
    // Its weight: the cosine to the axis, 0 below the horizon. Divide the sum by the sum of the weights.
    weight: f32,
    // Solid angle for which it stands, times the number of directions. A blurred level of the map has texels as large.
    solid_angle: f32,
}

// A direction of light, at random, for eye and surface normal both along `axis`. The facet's slope is
// alpha sqrt(u / (1 - u)); that of twice its angle, and the density, are rational in u: no square loses digits.
// Returns: see SplitSumLobe; the solid angle is 4 pi alpha^2 / (1 - u + alpha^2 u)^2.
// Units: solid angle in sr; alpha is a slope.
// Domain: |axis| = 1; any alpha, clamped to [0.001, 1]; u in [0, 1), a multiple of 2^-24, and less than 0 counts as 0;
//   azimuth (cos, sin) of any angle. It turns about the axis, from a direction that jumps where axis.z changes sign.
// Outside: finite for u up to 1 and vectors up to 1e9.
// Accuracy: lavapipe toward 20 ulp + 2 backward, weight 5e-7 abs + 2 backward, solid_angle 16 ulp + 2 backward;
//   portable toward 60 ulp + 4 backward, weight 2e-6 abs + 4 backward, solid_angle 40 ulp + 4 backward; order kept
fn split_sum_lobe(axis: vec3f, alpha: f32, u: f32, azimuth: vec2f) -> SplitSumLobe {
    let a = clamp(alpha, SPLIT_SUM_SMOOTHEST, 1.0f);
    let v = max(u, 0.0f);
    let near = 1.0f - v;
    let far = a * a * v;
    let inverse = 1.0f / (near + far);
    let cosine = (near - far) * inverse;
    let sine = 2.0f * a * sqrt(near * v) * inverse;
    // The direction along the surface: that in the plane z = 0, turned by half a turn about the middle of the axis and
    // the z axis, or its opposite.
    let middle = axis + vec3f(0.0f, 0.0f, select(1.0f, -1.0f, axis.z < 0.0f));
    let turned = dot(middle.xy, azimuth) / (1.0f + abs(axis.z)) * middle - vec3f(azimuth, 0.0f);
    let width = a * inverse;
    return SplitSumLobe(sine * turned + cosine * axis, max(cosine, 0.0f), 12.566371f * width * width);
}

// Factor on single scattering that makes up for light that meets several facets. Of what is lost, 1 - E, each
// reflection leaves the mean of Schlick's reflectance over a hemisphere, f0 + (1 - f0) / 21; `SPLIT_SUM_STAYING` (1 -
// E) of it meets one more facet and the rest leaves: a geometric series.
// Returns: 1 + F (1 - E) / E (1 - s) / (1 - F s); at f0 = 1 it is 1 / E.
// Units: none; `albedo` is E, the share of light that facets of reflectance 1 reflect once.
// Domain: f0 in [0, 1]; any albedo, clamped to [1/4, 1].
// Outside: finite for f0 in [-1, 1.5].
// Accuracy: lavapipe 10 ulp; portable 24 ulp
fn split_sum_compensation(f0: vec3f, albedo: f32) -> vec3f {
    let once = clamp(albedo, SPLIT_SUM_LEAST, 1.0f);
    let lost = 1.0f - once;
    let staying = SPLIT_SUM_STAYING * lost;
    let mean = f0 + (1.0f - f0) * 0.047619048f;
    return 1.0f + mean * (lost * (1.0f - staying) / once) / (1.0f - mean * staying);
}

// Share of even light from all directions that a rough metal reflects towards the eye: all that the eye sees where the
// environment is the same everywhere. Elsewhere it is the factor on the prefiltered environment.
// Returns: (f0 x + y) times the compensation for E = x + y, in [0, 1] up to rounding.
// Units: none; `table` is the table's value.
// Domain: f0 in [0, 1]; table with x and y in [0, 1] and their sum in [1/4, 1].
// Outside: finite for f0 in [-1, 1.5] and a table up to 1e30 in magnitude.
// Accuracy: lavapipe 18 ulp; portable 40 ulp
fn split_sum_reflectance(f0: vec3f, table: vec2f) -> vec3f {
    return (f0 * table.x + table.y) * split_sum_compensation(f0, table.x + table.y);
}
