// split_sum: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// A direction of light as Karis prints it: the facet from its cosine. Kept to show where it fails: at small alpha the
// cosine rounds to 1, and facets, directions and densities with it.
// Returns: as split_sum_lobe, but a weight below 0 below the horizon.
// Units: as split_sum_lobe.
// Domain: |axis| = 1, axis.z above -1; alpha in [0.1, 1], u in [0, 1), azimuth a unit vector.
// Outside: not a number for an axis along -z.
// Accuracy: naive
fn split_sum_lobe_naive(axis: vec3f, alpha: f32, u: f32, azimuth: vec2f) -> SplitSumLobe {
    let cosine = sqrt((1.0f - u) / (1.0f + (alpha * alpha - 1.0f) * u));
    let sine = sqrt(1.0f - cosine * cosine);
    let middle = axis + vec3f(0.0f, 0.0f, 1.0f);
    let turned = dot(middle.xy, azimuth) / middle.z * middle - vec3f(azimuth, 0.0f);
    let facet = sine * turned + cosine * axis;
    let facing = dot(axis, facet);
    let toward = 2.0f * facing * facet - axis;
    let spread = facing * facing * (alpha * alpha - 1.0f) + 1.0f;
    let density = alpha * alpha / (3.1415927f * spread * spread) / 4.0f;
    return SplitSumLobe(toward, dot(axis, toward), 1.0f / density);
}

// The share of seen facets with masking and shadowing computed separately. Kept to show where it fails: at grazing
// incidence it is 0 / 0.
// Returns: G2 / G1(v), with Lambda = (sqrt(1 + alpha^2 tan^2) - 1) / 2.
// Units: as split_sum_shadowing.
// Domain: cosines in (0, 1], alpha in (0, 1].
// Outside: not a number where the eye's cosine is below 1e-19: its square underflows.
// Accuracy: naive
fn split_sum_shadowing_naive(cosine_light: f32, cosine_eye: f32, alpha: f32) -> f32 {
    let squared = alpha * alpha;
    let tangent_light = 1.0f / (cosine_light * cosine_light) - 1.0f;
    let tangent_eye = 1.0f / (cosine_eye * cosine_eye) - 1.0f;
    let lambda_light = 0.5f * (sqrt(1.0f + squared * tangent_light) - 1.0f);
    let lambda_eye = 0.5f * (sqrt(1.0f + squared * tangent_eye) - 1.0f);
    return (1.0f + lambda_eye) / (1.0f + lambda_light + lambda_eye);
}

// Single scattering alone, as Karis prints it. Kept to show where it fails: light that meets a second facet is
// lost, more than two thirds of it for alpha 1 head on.
// Returns: f0 x + y.
// Units: as split_sum_reflectance.
// Domain: f0 in [0, 1]; table in [0, 1].
// Outside: as the formula gives.
// Accuracy: naive
fn split_sum_reflectance_naive(f0: vec3f, table: vec2f) -> vec3f {
    return f0 * table.x + table.y;
}

// The compensation as Turquin prints it. Kept to show where it fails: all light that met a second facet leaves, and a
// coloured metal is too bright where it is rough.
// Returns: 1 + f0 (1 - E) / E.
// Units: as split_sum_compensation.
// Domain: f0 in [0, 1]; albedo in (0, 1].
// Outside: infinite for an albedo of 0.
// Accuracy: naive
fn split_sum_compensation_turquin(f0: vec3f, albedo: f32) -> vec3f {
    return 1.0f + f0 * ((1.0f - albedo) / albedo);
}
