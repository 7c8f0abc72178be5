// texture_diffusion: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// texture_diffusion_clip with y as in OpenGL, which counts texels from the bottom.
// Returns: the position, upside down in WebGPU.
// Units: as for texture_diffusion_clip.
// Domain: uv in [0, 1].
// Outside: the same.
// Accuracy: naive
fn texture_diffusion_clip_naive(uv: vec2f) -> vec4f {
    return vec4f(2.0f * uv - 1.0f, 0.0f, 1.0f);
}

// texture_diffusion_width as an unguarded quotient.
// Returns: sigma0 / stretch.
// Units: as for texture_diffusion_width.
// Domain: sigma0, stretch in [1e-6, 1e6].
// Outside: infinite at a pole, 0/0 off the charts of a material that does not scatter.
// Accuracy: naive
fn texture_diffusion_width_naive(sigma0: f32, stretch: f32) -> f32 {
    return sigma0 / stretch;
}

// Taps at equal distances, out to the reach that the widest channel needs.
// Returns: as for texture_diffusion_tap.
// Units: standard deviations of the widest channel.
// Domain: index from 0 to pairs; each component of sigma0 positive.
// Outside: 0/0 for a channel that does not scatter; NaNs and negative numbers go through.
// Accuracy: naive
fn texture_diffusion_tap_naive(index: u32, pairs: u32, sigma0: vec3f) -> TextureDiffusionTap {
    let widest = max(max(sigma0.x, sigma0.y), sigma0.z);
    let offset = TEXTURE_DIFFUSION_REACH * f32(index) / f32(pairs);
    let deviations = offset / (sigma0 / widest);
    return TextureDiffusionTap(offset, exp(-0.5f * deviations * deviations));
}

// The usual blur: the sum is divided by the sum of the weights, even where taps miss the chart.
// Returns: irradiance, darkened by the area outside the chart.
// Units: that of the irradiance.
// Domain: total in [1e-6, 1e6].
// Outside: as long as the total is positive.
// Accuracy: naive
fn texture_diffusion_normalize_naive(sum: vec3f, total: vec3f) -> vec3f {
    return sum / total;
}
