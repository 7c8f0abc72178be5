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
