// microfacet: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The usual form of the distribution, from the cosine alone. Kept to show where it fails: close to
// the normal the cosine rounds to 1, and alpha^2 loses most of its digits when it is added to 1.
// Returns: alpha^2 / (pi (cosine^2 (alpha^2 - 1) + 1)^2).
// Units: 1/sr; alpha is a slope.
// Domain: cosine in [0, 1], alpha in (0, 1]; usable for alpha above 0.1.
// Outside: as the formula gives; 0 / 0 for alpha = 0 at cosine = 1.
// Accuracy: naive
fn microfacet_distribution_naive(cosine: f32, alpha: f32) -> f32 {
    let squared = alpha * alpha;
    let spread = cosine * cosine * (squared - 1.0f) + 1.0f;
    return squared / (3.1415927f * spread * spread);
}

// The visibility with numerator and divisor computed separately, as in Heitz's eq. (72) and (99).
// Kept to show where it fails: at grazing incidence it is 0 / 0.
// Returns: 1 / (1 + Lambda(l) + Lambda(v)) / (4 n.l n.v), with Lambda = (sqrt(1 + alpha^2 tan^2) -
//   1) / 2.
// Units: the same as for microfacet_visibility.
// Domain: cosines in (0, 1], alpha in (0, 1].
// Outside: not a number where a cosine is below 1e-19: its square underflows.
// Accuracy: naive
fn microfacet_visibility_naive(cosine_light: f32, cosine_eye: f32, alpha: f32) -> f32 {
    let squared = alpha * alpha;
    let tangent_light = 1.0f / (cosine_light * cosine_light) - 1.0f;
    let tangent_eye = 1.0f / (cosine_eye * cosine_eye) - 1.0f;
    let lambda_light = 0.5f * (sqrt(1.0f + squared * tangent_light) - 1.0f);
    let lambda_eye = 0.5f * (sqrt(1.0f + squared * tangent_eye) - 1.0f);
    return 1.0f / (1.0f + lambda_light + lambda_eye) / (4.0f * cosine_light * cosine_eye);
}

// The half vector as the normalized sum. Kept to show where it fails: a sum of 0 has no direction.
// Returns: unit direction of toward_light + toward_eye.
// Units: none; unit vectors.
// Domain: unit vectors that are not opposite.
// Outside: not a number.
// Accuracy: naive
fn microfacet_half_naive(toward_light: vec3f, toward_eye: vec3f) -> vec3f {
    return normalize(toward_light + toward_eye);
}

// A facet that the eye sees, as Dupuy and Benyoub print it. Kept to show where it fails: near the middle of
// the cap its sine is the root of a difference, and the normal -z has no half turn about the middle.
// Returns: unit normal.
// Units: none; alpha is a slope.
// Domain: unit vectors with normal . toward_eye above 0, alpha in (0, 1], u in (0, 1), azimuth a unit vector.
// Outside: not a number for a normal along -z.
// Accuracy: naive
fn microfacet_facet_naive(normal: vec3f, toward_eye: vec3f, alpha: f32, u: f32, azimuth: vec2f) -> vec3f {
    let height = dot(normal, toward_eye);
    let eye = normalize(alpha * (toward_eye - height * normal) + height * normal);
    let cosine = dot(normal, eye);
    let z = (1.0f - u) * (1.0f + cosine) - cosine;
    let level = sqrt(1.0f - z * z) * azimuth;
    let middle = normal + vec3f(0.0f, 0.0f, 1.0f);
    let cap = vec3f(level, z);
    let half = eye + dot(middle, cap) / middle.z * middle - cap;
    let rise = dot(normal, half);
    return normalize(alpha * (half - rise * normal) + rise * normal);
}
