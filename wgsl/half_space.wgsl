// half_space: the law by which light enters and leaves a half space of scattering matter, with or without a boundary.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Chandrasekhar, "Radiative Transfer", 1960, sections 33 to 36, for the law and the
//   H function; Hapke, "Theory of Reflectance and Emittance Spectroscopy", 2nd ed., 2012, section
//   8.5, for its approximation by a polynomial under the integral; van de Hulst, "Multiple Light
//   Scattering", 1980, section 14.1, for similarity; Walsh, "The Reflection Factor of a Polished Glass
//   Surface for Diffused Light", 1926, for diffuse light at a dielectric. The fits and the light that
//   the boundary throws back are derived in docs/half_space.md.
//
// All functions take gamma = sqrt(1 - albedo) for the matter, not the albedo of single scattering.
// Reflectances depend on this root: near an albedo of 1 a float's last place is 6e-8, which is 2.4e-4
// in gamma and 6e-4 in the reflectance.

// Cosines below this count as it. It keeps the law finite if light and eye are both
// grazing.
const HALF_SPACE_GRAZING: f32 = 1e-18f;
// Shares of light that add up to less than this count as it.
const HALF_SPACE_NO_LIGHT: f32 = 1e-30f;
// The least share of scattered light that counts as turned, 1 less the mean cosine of scattering. Matter
// that turns no light at all has no reflectance.
const HALF_SPACE_LEAST_TURNED: f32 = 0.001f;
// The largest relative index.
const HALF_SPACE_DENSEST: f32 = 4.0f;
// Upper limit of the edge that half_space_edge returns; an index of 4 has 0.98.
const HALF_SPACE_LAST_EDGE: f32 = 0.981f;

// Gamma of matter whose scattering has the mean cosine `anisotropy`: that of the isotropic matter which
// diffuses light alike, by similarity. Of the extinction a (1 - g) + (1 - a) that counts there, the part
// 1 - a is absorbed. No difference cancels but 1 - a, which is exact from 1/2 on.
// Returns: sqrt((1 - a) / ((1 - a) + a (1 - g))) in [0, 1]; sqrt(1 - a) for g = 0.
// Units: none; `albedo` is the share of light that one scattering leaves, `anisotropy` the mean cosine.
// Domain: any albedo, clamped to [0, 1]; any anisotropy, clamped to [-1, 0.999].
// Outside: nothing.
// Accuracy: lavapipe 5 ulp; portable 18 ulp
fn half_space_gamma(albedo: f32, anisotropy: f32) -> f32 {
    let scattered = clamp(albedo, 0.0f, 1.0f);
    // Clamped, so that no compiler takes the sum below apart and 1 cancels.
    let absorbed = clamp(1.0f - scattered, 0.0f, 1.0f);
    let turned = max(1.0f - clamp(anisotropy, -1.0f, 1.0f), HALF_SPACE_LEAST_TURNED);
    return min(sqrt(absorbed / (absorbed + scattered * turned)), 1.0f);
}

// Gamma of index-matched matter that reflects and absorbs diffuse light in these shares of any whole. The
// fit of half_space_darkening is a quotient of polynomials of degree 2 and 1, so that its inverse is the
// root of a quadratic equation, written as a quotient without a difference.
// Returns: gamma in [0, 1]; 0 if nothing is absorbed, 1 if nothing is reflected.
// Units: none; both shares are of the same whole, which need not be 1.
// Domain: reflected and absorbed from 2^-60 to 1, or 0, but not both 0; above 1 counts as 1.
// Outside: gamma in [0, 1].
// Accuracy: lavapipe 1.4e-4 rel; portable 1.4e-4 rel
fn half_space_gamma_of_shares(reflected: f32, absorbed: f32) -> f32 {
    let parts = clamp(vec2f(reflected, absorbed), vec2f(0.0f), vec2f(1.0f));
    let whole = max(parts.x + parts.y, HALF_SPACE_NO_LIGHT);
    let r = parts.x / whole;
    let rest = parts.y / whole;
    let square = 0.33745154f + 0.62182603f * r;
    let linear = 0.66254846f + 1.647105f * r;
    return min(2.0f * rest / (linear + sqrt(linear * linear + 4.0f * square * rest)), 1.0f);
}

// Gamma of index-matched matter that reflects the share `reflectance` of diffuse light, such as a base
// colour.
// Returns: gamma in [0, 1], the inverse of half_space_reflectance to rounding; 0 for 1, 1 for 0. The
//   albedo of single scattering is (1 - gamma) (1 + gamma).
// Units: none.
// Domain: any reflectance, clamped to [0, 1].
// Outside: nothing.
// Accuracy: lavapipe 1.4e-4 rel; portable 1.4e-4 rel
fn half_space_gamma_of_reflectance(reflectance: f32) -> f32 {
    let r = clamp(reflectance, 0.0f, 1.0f);
    return half_space_gamma_of_shares(r, 1.0f - r);
}

// How much darker than by single absorption matter is under diffuse light: the quotient of 1 - gamma and
// the reflectance. It has a limit at both ends, where reflectances and their complements have only digits
// that cancel.
// Returns: (1 - gamma) / reflectance, from 1 for matter that absorbs nothing to 2.443 for matter that
//   scatters nothing; the fit is accurate to 8e-6.
// Units: none.
// Domain: any gamma, clamped to [0, 1].
// Outside: nothing.
// Accuracy: lavapipe 1e-5 rel; portable 1e-5 rel
fn half_space_darkening(gamma: f32) -> f32 {
    let g = clamp(gamma, 0.0f, 1.0f);
    return (1.0f + g * (1.647105f + 0.62182603f * g)) / (1.0f + 0.33745154f * g);
}

// Share of diffuse light that index-matched matter reflects: its base colour.
// Returns: reflectance in [0, 1]; exactly 0 for gamma = 1.
// Units: none.
// Domain: any gamma, clamped to [0, 1].
// Outside: nothing.
// Accuracy: lavapipe 1e-5 rel; portable 1e-5 rel
fn half_space_reflectance(gamma: f32) -> f32 {
    return min((1.0f - clamp(gamma, 0.0f, 1.0f)) / half_space_darkening(gamma), 1.0f);
}

// The part of 1 / H that scattering makes: 1 / H = gamma + (1 - gamma) N, and this is N. It is the integral
// (1 + gamma) / 2 of m H(m) / (cosine + m) over m, in which a polynomial of degree 2 stands for H(m).
// Polynomials give a logarithm and polynomials. The polynomial's mean is exact, which makes N = 1 at
// grazing incidence; at gamma = 1 it is 1, which leaves the term of single scattering alone.
// Returns: N in [0.3, 1.001].
// Units: none.
// Domain: any cosine, clamped to [1e-18, 1]; any gamma, clamped to [0, 1].
// Outside: nothing.
// Accuracy: lavapipe 2e-4 rel; portable 2e-4 rel
fn half_space_escape(cosine: f32, gamma: f32) -> f32 {
    let c = clamp(cosine, HALF_SPACE_GRAZING, 1.0f);
    let g = clamp(gamma, 0.0f, 1.0f);
    let single = 1.0f - c * log(1.0f + 1.0f / c);
    // The integrals of m (m - 1/2) / (c + m) and m (m^2 - 1/3) / (c + m).
    let first = 0.5f - (c + 0.5f) * single;
    let second = 0.33333334f - 0.5f * c + (c * c - 0.33333334f) * single;
    let slope = 1.0546412f + g * (0.9806169f - 0.6828335f * g);
    let bend = 0.12875553f + g * (1.6066018f - 0.94174538f * g);
    return single + (1.0f - g) * (slope * first - bend * second);
}

// Chandrasekhar's H function for isotropic scattering: how much brighter matter is at this cosine than at
// grazing view, for light that comes from deep inside.
// Returns: H in [1, 2.909]; 1 at grazing incidence or for matter that scatters nothing.
// Units: none.
// Domain: any cosine, clamped to [1e-18, 1]; any gamma, clamped to [0, 1].
// Outside: nothing.
// Accuracy: lavapipe 1.3e-4 rel; portable 1.3e-4 rel
fn half_space_h(cosine: f32, gamma: f32) -> f32 {
    let g = clamp(gamma, 0.0f, 1.0f);
    return 1.0f / (g + (1.0f - g) * half_space_escape(cosine, g));
}

// Share of the light from one direction that index-matched matter reflects into all directions, 1 - gamma
// H; and by reciprocity its radiance in this direction under uniform light of radiance 1. As a quotient
// of two parts of 1 / H nothing cancels.
// Returns: reflectance in [0, 1]; exactly 0 for gamma = 1.
// Units: none.
// Domain: any cosine, clamped to [1e-18, 1]; any gamma, clamped to [0, 1].
// Outside: nothing.
// Accuracy: lavapipe 1.3e-4 rel; portable 1.3e-4 rel
fn half_space_directional(cosine: f32, gamma: f32) -> f32 {
    let g = clamp(gamma, 0.0f, 1.0f);
    let scattered = (1.0f - g) * half_space_escape(cosine, g);
    return min(scattered / (g + scattered), 1.0f);
}

// Chandrasekhar's law of diffuse reflection. Radiance is this times the irradiance perpendicular to the
// light times the cosine of the light.
// Returns: BRDF albedo / (4 pi) H(eye) H(light) / (eye + light); up to 4e16 if both are grazing.
// Units: 1/sr.
// Domain: any cosines, clamped to [1e-18, 1]; any gamma, clamped to [0, 1].
// Outside: nothing.
// Accuracy: lavapipe 2.5e-4 rel; portable 2.5e-4 rel
fn half_space_brdf(cosine_eye: f32, cosine_light: f32, gamma: f32) -> f32 {
    let g = clamp(gamma, 0.0f, 1.0f);
    let sum = clamp(cosine_eye, HALF_SPACE_GRAZING, 1.0f) + clamp(cosine_light, HALF_SPACE_GRAZING, 1.0f);
    let albedo = (1.0f - g) * (1.0f + g);
    return 0.07957747f * albedo * half_space_h(cosine_eye, g) * half_space_h(cosine_light, g) / sum;
}

// The law as a factor on Lambert's with the same reflectance under diffuse light, or on another law that
// holds for diffuse light: pi BRDF / reflectance. The factor 1 - gamma of both has cancelled, so that it
// has a limit for matter that scatters nothing.
// Returns: factor, symmetric in the cosines; its mean over both hemispheres, weighted with both cosines,
//   is 1 to 3e-4; up to 6e17 if both are grazing.
// Units: none.
// Domain: any cosines, clamped to [1e-18, 1]; any gamma, clamped to [0, 1].
// Outside: nothing.
// Accuracy: lavapipe 2.6e-4 rel; portable 2.6e-4 rel
fn half_space_factor(cosine_eye: f32, cosine_light: f32, gamma: f32) -> f32 {
    let g = clamp(gamma, 0.0f, 1.0f);
    let sum = clamp(cosine_eye, HALF_SPACE_GRAZING, 1.0f) + clamp(cosine_light, HALF_SPACE_GRAZING, 1.0f);
    let relative = 0.25f * (1.0f + g) * half_space_darkening(g);
    return relative * half_space_h(cosine_eye, g) * half_space_h(cosine_light, g) / sum;
}

// Angular law of light that comes from deep inside, as a factor on light that leaves alike in all
// directions: for diffusion, which computes the flux that leaves but no direction.
// Returns: H(cosine) over twice its first moment; its mean, weighted with the cosine, is 1 to 3e-4.
// Units: none.
// Domain: any cosine, clamped to [1e-18, 1]; any gamma, clamped to [0, 1].
// Outside: nothing.
// Accuracy: lavapipe 2.6e-4 rel; portable 2.6e-4 rel
fn half_space_exit(cosine: f32, gamma: f32) -> f32 {
    let g = clamp(gamma, 0.0f, 1.0f);
    // Twice the moment is (1 - reflectance) / gamma; with the fit of half_space_darkening, gamma cancels.
    let inverse_moment = (1.0f + g * (1.647105f + 0.62182603f * g)) / (2.3096535f + 0.95927757f * g);
    return half_space_h(cosine, g) * inverse_moment;
}

// Cosine of the refracted direction in the denser matter, by Snell's law.
// Returns: cosine in [0, 1], at least `cosine`; `cosine` itself for an index of 1.
// Units: none; `relative_index` is n_inside / n_outside.
// Domain: any cosine, clamped to [1e-18, 1]; any relative_index, clamped to [1, 4].
// Outside: nothing.
// Accuracy: lavapipe 4 ulp; portable 18 ulp
fn half_space_refract(cosine: f32, relative_index: f32) -> f32 {
    let c = clamp(cosine, HALF_SPACE_GRAZING, 1.0f);
    let n = clamp(relative_index, 1.0f, HALF_SPACE_DENSEST);
    let refracted = sqrt((n - 1.0f) * (n + 1.0f) + c * c) / n;
    return min(max(refracted, c), 1.0f);
}

// The boundary seen by diffuse light inside: as if it reflected all light at cosines below this edge and
// none above. The square is the share of diffuse light that the boundary reflects back inside.
// Returns: edge in [0, 0.981], the root of the reflectance for diffuse light from inside; 0 for an index
//   of 1. 1 - edge^2 is the share that passes from inside, n^2 (1 - edge^2) that from outside.
// Units: none; `relative_index` is n_inside / n_outside.
// Domain: any relative_index, clamped to [1, 4]; below 1 nothing is reflected totally, and this module
//   takes the boundary to be none.
// Outside: nothing.
// Accuracy: lavapipe 5e-5 rel; portable 5e-5 rel
fn half_space_edge(relative_index: f32) -> f32 {
    let n = clamp(relative_index, 1.0f, HALF_SPACE_DENSEST);
    let x = n - 1.0f;
    // 1 + (reflectance from outside) / (n^2 - 1), 7/6 for n -> 1, in which all terms are positive.
    let numerator = 1.1665642f + x * (118.47884f + x * (711.88998f + x * 312.90763f));
    let denominator = 1.0f + x * (102.81827f + x * (666.10355f + x * 316.42606f));
    return sqrt(x * (n + 1.0f) * numerator / denominator) / n;
}

// Strength of the light that the boundary has thrown back inside at least once, for half_space_inside. It
// depends on the matter only: compute it once per material.
// Returns: factor in [0.07, 12]. It is fitted to the law with all reflections inside, weighted with the
//   share of light that it concerns.
// Units: 1/sr; `edge` is half_space_edge of the index.
// Domain: any gamma, clamped to [0, 1]; any edge, clamped to [0, 0.981].
// Outside: nothing.
// Accuracy: lavapipe 40 ulp; portable 120 ulp
fn half_space_gain(gamma: f32, edge: f32) -> f32 {
    let g = clamp(gamma, 0.0f, 1.0f);
    let e = clamp(edge, 0.0f, HALF_SPACE_LAST_EDGE);
    let passed = (1.0f - e) * (1.0f + e);
    let white = passed * (1.0093106f + 1.0942524f * g - 0.39723844f * e);
    let dark = g * (2.48031f * e - 1.0689417f + g * (1.6286656f * e - 0.06959722f));
    return 0.07957747f * (1.0f + e * (3.3934849f - 1.3134133f * e)) / (white + dark);
}

// The law between directions inside the boundary: index-matched matter, and the light that the boundary
// has thrown back. The latter is a product of H(m) (1 - ln(1 + y) / y), with y = edge / m, for both
// directions: docs/half_space.md.
// Returns: BRDF between the directions inside; half_space_brdf, to rounding, if the edge is 0.
// Units: 1/sr; cosines inside, `edge` and `gain` as half_space_edge and half_space_gain return them.
// Domain: any cosines, clamped to [1e-18, 1]; any gamma, clamped to [0, 1]; any edge, clamped to [0,
//   0.981]; any gain, clamped to [0, 100].
// Outside: nothing.
// Accuracy: lavapipe 2.6e-4 rel; portable 2.6e-4 rel
fn half_space_inside(cosine_eye: f32, cosine_light: f32, gamma: f32, edge: f32, gain: f32) -> f32 {
    let g = clamp(gamma, 0.0f, 1.0f);
    let e = clamp(edge, 0.0f, HALF_SPACE_LAST_EDGE);
    let cosines = clamp(vec2f(cosine_eye, cosine_light), vec2f(HALF_SPACE_GRAZING), vec2f(1.0f));
    let p = e / (cosines + e);
    let below = p * (15.0f - 7.0f * p) / (30.0f - p * (24.0f - 3.0f * p));
    let sum = cosines.x + cosines.y;
    let albedo = (1.0f - g) * (1.0f + g);
    let thrown_back = clamp(gain, 0.0f, 100.0f) * albedo * below.x * below.y;
    let both = half_space_h(cosines.x, g) * half_space_h(cosines.y, g);
    return albedo * both * (0.07957747f / sum + thrown_back);
}

// The law of matter behind a dielectric boundary, for light that enters. Multiply it by the shares that pass the
// boundary, (1 - F(eye)) (1 - F(light)), with F by the module fresnel, and add the boundary's own reflection.
// Returns: BRDF without the shares that pass: half_space_inside of the refracted cosines over n^2; half_space_brdf
//   for an index of 1 and an edge of 0.
// Units: 1/sr; cosines outside; `relative_index` is n_inside / n_outside.
// Domain: any cosines, clamped to [1e-18, 1]; any relative_index, clamped to [1, 4]; gamma, edge and gain as for
//   half_space_inside.
// Outside: nothing.
// Accuracy: lavapipe 2.6e-4 rel; portable 2.7e-4 rel
fn half_space_dielectric(
    cosine_eye: f32, cosine_light: f32, gamma: f32, relative_index: f32, edge: f32, gain: f32
) -> f32 {
    let n = clamp(relative_index, 1.0f, HALF_SPACE_DENSEST);
    let eye = half_space_refract(cosine_eye, n);
    let light = half_space_refract(cosine_light, n);
    return half_space_inside(eye, light, gamma, edge, gain) / (n * n);
}

// How the odds of absorption behind a boundary exceed those by Saunderson's formula, which takes the light
// that meets the boundary from inside to be diffuse. Really more of it is slanted, is thrown back, and
// meets matter that reflects slanted light better.
// Returns: factor in [1, 1.62], accurate to 0.25 %.
// Units: none.
// Domain: any gamma, clamped to [0, 1]; any edge, clamped to [0, 0.981].
// Outside: nothing.
// Accuracy: lavapipe 5 ulp; portable 14 ulp
fn half_space_slant(gamma: f32, edge: f32) -> f32 {
    let g = clamp(gamma, 0.0f, 1.0f);
    let e = clamp(edge, 0.0f, HALF_SPACE_LAST_EDGE);
    return 1.0f + e * e * g * (2.3512168f - 0.04584427f * g) / (1.0f + e * (1.3143637f + 1.3818834f * g));
}

// Share of the light that has entered matter behind a boundary and leaves it again, under diffuse light
// outside. The reflectance under diffuse light, without the reflection at the boundary, is this times the
// share that enters, n^2 (1 - edge^2).
// Returns: share in [0, 1], half_space_reflectance for an edge of 0; 1 for gamma = 0, 0 for gamma = 1.
// Units: none; `edge` is half_space_edge of the index.
// Domain: any gamma, clamped to [0, 1]; any edge, clamped to [0, 0.981].
// Outside: nothing.
// Accuracy: lavapipe 1.3e-4 rel; portable 1.3e-4 rel
fn half_space_entered(gamma: f32, edge: f32) -> f32 {
    let g = clamp(gamma, 0.0f, 1.0f);
    let e = clamp(edge, 0.0f, HALF_SPACE_LAST_EDGE);
    // The odds of absorption are absorbed / left. Those without a boundary are 1 / reflectance - 1, in
    // which the fit of half_space_darkening leaves a factor gamma.
    let left = (1.0f - g) * (1.0f + 0.33745154f * g) * (1.0f - e) * (1.0f + e);
    let absorbed = half_space_slant(g, e) * g * (2.3096535f + 0.95927757f * g);
    return min(left / (left + absorbed), 1.0f);
}

// Gamma of matter behind a boundary that returns the share `share` of diffuse light that has entered it. The
// odds of half_space_entered are turned around; their factor half_space_slant depends on gamma weakly,
// and each of four steps leaves a tenth of its error.
// Returns: gamma in [0, 1], the inverse of half_space_entered to 4e-6; 0 for 1, 1 for 0.
// Units: none; for a base colour, `share` is the colour over n^2 (1 - edge^2).
// Domain: any share, clamped to [0, 1]; any edge, clamped to [0, 0.981].
// Outside: nothing.
// Accuracy: lavapipe 1.6e-4 rel; portable 1.6e-4 rel
fn half_space_gamma_of_entered(share: f32, edge: f32) -> f32 {
    let s = clamp(share, 0.0f, 1.0f);
    let e = clamp(edge, 0.0f, HALF_SPACE_LAST_EDGE);
    let absorbed = (1.0f - s) * (1.0f - e) * (1.0f + e);
    var gamma = half_space_gamma_of_shares(s, absorbed);
    for (var turn = 0u; turn < 4u; turn += 1u) {
        let left = s * half_space_slant(gamma, e);
        gamma = half_space_gamma_of_shares(left, absorbed);
    }
    return gamma;
}
