// random_walk: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The free path by the built-in logarithm, as usually written. Kept to show where it fails: below
// 2^-25 nothing is left of u.
// Returns: -log(1 - u) / majorant.
// Units: as random_walk_free_path.
// Domain: u in [0.1, 0.9], majorant in [1e-3, 1e3].
// Outside: off by its whole value for a small u, infinite for u = 1 or no majorant.
// Accuracy: naive
fn random_walk_free_path_naive(u: f32, majorant: f32) -> f32 {
    return -log(1.0f - u) / majorant;
}

// random_walk_ratio with the quotient taken first. Kept to show where it fails: for a density near
// the majorant.
// Returns: transmittance (1 - density / majorant).
// Units: as random_walk_ratio.
// Domain: transmittance in [0.1, 1]; density at most half the majorant.
// Outside: off by the rounding of 1 where both are nearly equal.
// Accuracy: naive
fn random_walk_ratio_naive(transmittance: f32, density: f32, majorant: f32) -> f32 {
    return transmittance * (1.0f - density / majorant);
}

// The phase function as printed in the literature. Kept to show where it fails: for g near 1 its
// sum is the difference of nearly equal numbers.
// Returns: (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^1.5).
// Units: as random_walk_phase.
// Domain: cosine in [-1, 1], g in [-0.8, 0.8].
// Outside: 0 / 0 for g = 1 and cosine = 1.
// Accuracy: naive
fn random_walk_phase_naive(cosine: f32, g: f32) -> f32 {
    return 0.07957747f * (1.0f - g * g) / pow(1.0f + g * g - 2.0f * g * cosine, 1.5f);
}

// The deflection as printed in the literature. Kept to show where it fails: it divides a difference
// of nearly equal numbers by a small g.
// Returns: cosine (1 + g^2 - ((1 - g^2) / (1 - g + 2 g u))^2) / (2 g) and its sine.
// Units: none.
// Domain: u in [0.05, 0.95], |g| in [0.3, 0.8].
// Outside: 0 / 0 for g = 0.
// Accuracy: naive
fn random_walk_deflection_naive(u: f32, g: f32) -> vec2f {
    let root = (1.0f - g * g) / (1.0f - g + 2.0f * g * u);
    let cosine = (1.0f + g * g - root * root) / (2.0f * g);
    return vec2f(cosine, sqrt(max(1.0f - cosine * cosine, 0.0f)));
}

// Frisvad's original basis, without the branch. Kept to show where it fails: towards -z its divisor
// tends to 0.
// Returns: RandomWalkBasis.
// Units: none; unit vectors.
// Domain: |normal| = 1, normal.z >= 0.
// Outside: off by up to 1 near -z, and not finite there.
// Accuracy: naive
fn random_walk_basis_naive(normal: vec3f) -> RandomWalkBasis {
    let a = 1.0f / (1.0f + normal.z);
    let b = -normal.x * normal.y * a;
    return RandomWalkBasis(
        vec3f(1.0f - normal.x * normal.x * a, b, -normal.x),
        vec3f(b, 1.0f - normal.y * normal.y * a, -normal.y),
    );
}
