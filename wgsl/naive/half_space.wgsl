// half_space: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// Gamma by way of the similar albedo, as similarity is printed.
// Returns: sqrt(1 - a (1 - g) / (1 - a g)).
// Units: as half_space_gamma.
// Domain: albedo in [0.01, 0.9], anisotropy in [-0.9, 0.9].
// Outside: near an albedo of 1 the difference cancels; 0 / 0 if both are 1.
// Accuracy: naive
fn half_space_gamma_naive(albedo: f32, anisotropy: f32) -> f32 {
    let similar = albedo * (1.0f - anisotropy) / (1.0f - albedo * anisotropy);
    return sqrt(1.0f - similar);
}

// H in one line, by Hapke, "Bidirectional Reflectance Spectroscopy 1", 1981, eq. (10): within 4.1 %.
// Returns: (1 + 2 c) / (1 + 2 c gamma).
// Units: as half_space_h.
// Domain: cosine in [0, 1], gamma in [0, 1].
// Outside: as the formula gives.
// Accuracy: naive
fn half_space_h_paper(cosine: f32, gamma: f32) -> f32 {
    return (1.0f + 2.0f * cosine) / (1.0f + 2.0f * cosine * gamma);
}

// The directional reflectance as it is printed.
// Returns: 1 - gamma H.
// Units: as half_space_directional.
// Domain: cosine in [0.01, 1], gamma in [0, 0.9].
// Outside: near gamma = 1, where matter is dark, the difference cancels, and may be negative.
// Accuracy: naive
fn half_space_directional_naive(cosine: f32, gamma: f32) -> f32 {
    return 1.0f - gamma * half_space_h(cosine, gamma);
}

// The law relative to Lambert's as a quotient of the two.
// Returns: pi BRDF / reflectance.
// Units: as half_space_factor.
// Domain: cosines in [0.01, 1], gamma in [0, 0.9].
// Outside: infinite where both cosines are 0; 0 / 0 for gamma = 1.
// Accuracy: naive
fn half_space_factor_naive(cosine_eye: f32, cosine_light: f32, gamma: f32) -> f32 {
    let albedo = 1.0f - gamma * gamma;
    let both = half_space_h(cosine_eye, gamma) * half_space_h(cosine_light, gamma);
    return 0.25f * albedo * both / (cosine_eye + cosine_light) / half_space_reflectance(gamma);
}

// The law as it is printed.
// Returns: albedo / (4 pi) H(eye) H(light) / (eye + light).
// Units: as half_space_brdf.
// Domain: cosines in [0.01, 1], gamma in [0, 0.9].
// Outside: infinite where both cosines are 0; for gamma near 1 the albedo cancels.
// Accuracy: naive
fn half_space_brdf_naive(cosine_eye: f32, cosine_light: f32, gamma: f32) -> f32 {
    let albedo = 1.0f - gamma * gamma;
    let both = half_space_h(cosine_eye, gamma) * half_space_h(cosine_light, gamma);
    return 0.07957747f * albedo * both / (cosine_eye + cosine_light);
}

// The edge by Walsh's closed form of the reflectance for diffuse light from outside.
// Returns: the root of 1 - (1 - reflectance) / n^2.
// Units: as half_space_edge.
// Domain: relative_index in [1.3, 3].
// Outside: near 1 terms of 1 / (n - 1)^2 cancel; not a number for 1.
// Accuracy: naive
fn half_space_edge_naive(relative_index: f32) -> f32 {
    let n = relative_index;
    let square = n * n;
    let fourth = square * square;
    let ratio = (n - 1.0f) / (n + 1.0f);
    let plain = 0.5f + (n - 1.0f) * (3.0f * n + 1.0f) / (6.0f * (n + 1.0f) * (n + 1.0f));
    let polarised = square * (square - 1.0f) * (square - 1.0f)
        / ((square + 1.0f) * (square + 1.0f) * (square + 1.0f)) * log(ratio);
    let rational = 2.0f * n * square * (square + 2.0f * n - 1.0f) / ((square + 1.0f) * (fourth - 1.0f));
    let rest = 8.0f * fourth * (fourth + 1.0f) / ((square + 1.0f) * (fourth - 1.0f) * (fourth - 1.0f)) * log(n);
    let outside = plain + polarised - rational + rest;
    return sqrt(1.0f - (1.0f - outside) / square);
}
