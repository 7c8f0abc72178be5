// cdrf: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// cdrf_sigma as the plain product, as printed in the paper.
// Returns: sigma0 curvature.
// Units: as for cdrf_sigma.
// Domain: sigma0, curvature in [0, 1e18].
// Outside: negative, a NaN or infinite.
// Accuracy: naive
fn cdrf_sigma_naive(sigma0: f32, curvature: f32) -> f32 {
    return sigma0 * curvature;
}

// cdrf_sigma_power of the plain product.
// Returns: 1.8 (mean_free_path curvature)^0.59.
// Units: as for cdrf_sigma_power.
// Domain: mean_free_path, curvature in [1e-6, 1e18].
// Outside: a NaN in a hollow; a NaN or infinite.
// Accuracy: naive
fn cdrf_sigma_power_naive(mean_free_path: f32, curvature: f32) -> f32 {
    return 1.8f * pow(mean_free_path * curvature, 0.59f);
}

// cdrf_edge to first order, with an unguarded quotient.
// Returns: max(cosine, 0), blurred as if the cosine were a straight line.
// Units: as for cdrf_edge.
// Domain: cosine in [-1, 1]; sigma in [0.01, 0.3].
// Outside: 0/0 at the terminator for sigma = 0.
// Accuracy: naive
fn cdrf_edge_naive(cosine: f32, sigma: f32) -> f32 {
    let u = cosine / sigma;
    return cosine * cdrf_normal_share(u) + sigma * cdrf_normal_density(u);
}

// cdrf_series alone, with four terms for every sigma: too few if the Gaussian is narrow.
// Returns: cdrf_accurate(...) to 1.5e-5 for sigma >= 0.35.
// Units: sigma in radians.
// Domain: cosine in [-1, 1]; sigma in [0.35, 8].
// Outside: 0.035 off at the terminator for sigma = 0, negative in the shadow.
// Accuracy: naive
fn cdrf_series_naive(cosine: f32, sigma: f32) -> f32 {
    return cdrf_series(cosine, sigma, 4u);
}

// The single-edge form for every sigma, not wrapped around: the light that comes from behind is
// missing.
// Returns: cdrf_accurate(...) for sigma <= 0.3.
// Units: sigma in radians.
// Domain: cosine in [-1, 1]; sigma in [0, 0.3].
// Outside: 0.025 off at sigma = 1, 0.39 at 2.
// Accuracy: naive
fn cdrf_accurate_naive(cosine: f32, sigma: f32) -> f32 {
    return cdrf_edge(cosine, sigma);
}

// The reflectance computed from the angle, as the formula is written: the error of acos enters with
// the full slope of the function.
// Returns: cdrf_accurate(...) to 6.8e-5, or to 4.9e-4 if acos is as inaccurate as WGSL allows.
// Units: sigma in radians.
// Domain: cosine in [-1, 1]; any sigma.
// Outside: acos of more than 1 is not a number.
// Accuracy: naive
fn cdrf_angle_naive(cosine: f32, sigma: f32) -> f32 {
    return cdrf_accurate(cos(acos(cosine)), sigma);
}

// cdrf_texture_coordinates without the half texel: lookups shift towards the table's middle.
// Returns: `coordinates`, unchanged.
// Units: fractions of the texture.
// Domain: coordinates in [0, 1].
// Outside: the same.
// Accuracy: naive
fn cdrf_texture_coordinates_naive(coordinates: vec2f) -> vec2f {
    return coordinates;
}
