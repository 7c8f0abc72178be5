// harmonics: light from all around as a few spherical harmonics, which is all that a diffuse surface sees of it.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps",
//   2001; to degree 4.
//
// A recipe adds: the modules cdrf and environment. The coefficients are bound here.

// Spherical harmonics of the environment, linear RGB: one coefficient of degree 0, three of degree
// 1, five of degree 2, nine of degree 4. A clamped cosine has no component of degree 3.
struct Harmonics {
    coefficients: array<vec4f, 18>,
}

@group(0) @binding(3) var<uniform> harmonics: Harmonics;

// Sums of the environment's harmonics along a normal, by degree, linear RGB.
struct HarmonicsAround {
    zeroth: vec3f,
    first: vec3f,
    second: vec3f,
    fourth: vec3f,
}

fn harmonics_around(normal: vec3f) -> HarmonicsAround {
    let basis = environment_harmonics(normal);
    let first = basis.first[0] * harmonics.coefficients[1].rgb
        + basis.first[1] * harmonics.coefficients[2].rgb
        + basis.first[2] * harmonics.coefficients[3].rgb;
    let second = basis.second[0] * harmonics.coefficients[4].rgb
        + basis.second[1] * harmonics.coefficients[5].rgb
        + basis.second[2] * harmonics.coefficients[6].rgb
        + basis.second[3] * harmonics.coefficients[7].rgb
        + basis.second[4] * harmonics.coefficients[8].rgb;
    let fourth = basis.fourth[0] * harmonics.coefficients[9].rgb
        + basis.fourth[1] * harmonics.coefficients[10].rgb
        + basis.fourth[2] * harmonics.coefficients[11].rgb
        + basis.fourth[3] * harmonics.coefficients[12].rgb
        + basis.fourth[4] * harmonics.coefficients[13].rgb
        + basis.fourth[5] * harmonics.coefficients[14].rgb
        + basis.fourth[6] * harmonics.coefficients[15].rgb
        + basis.fourth[7] * harmonics.coefficients[16].rgb
        + basis.fourth[8] * harmonics.coefficients[17].rgb;
    return HarmonicsAround(basis.zeroth * harmonics.coefficients[0].rgb, first, second, fourth);
}

// Irradiance, with the degrees weighted separately for each channel (cdrf_harmonic_weights). A few
// degrees cannot follow a small light: their sum falls below 0 opposite to it and is clamped there.
fn harmonics_irradiance(around: HarmonicsAround, red: vec4f, green: vec4f, blue: vec4f) -> vec3f {
    let sum = around.zeroth * vec3f(red.x, green.x, blue.x)
        + around.first * vec3f(red.y, green.y, blue.y)
        + around.second * vec3f(red.z, green.z, blue.z)
        + around.fourth * vec3f(red.w, green.w, blue.w);
    return max(sum, vec3f(0.0f));
}
