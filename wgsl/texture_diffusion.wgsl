// texture_diffusion: diffusion of light along a surface, as a Gaussian blur of the irradiance in its own texture.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Borshukov and Lewis, "Realistic Human Face Rendering for The Matrix Reloaded", SIGGRAPH
//   2003 sketch; d'Eon and Luebke, "Advanced Techniques for Realistic Real-Time Skin Rendering",
//   GPU Gems 3, 2007, chapter 14: stretch, separable blur. The placement of the taps is derived in
//   docs/texture_diffusion.md.
//
// Each channel has one Gaussian, of standard deviation `sigma0` on the surface. On a cylinder of
// radius R this is the convolution of the curvature-dependent reflectance with sigma = sigma0 / R.
// A tap is one bilinear fetch that all three channels share. Texels hold the irradiance times their
// coverage, and the coverage: 1 inside a chart, 0 outside the surface.

// Distance of the outermost taps, in standard deviations of the widest channel.
const TEXTURE_DIFFUSION_REACH: f32 = 3.4f;
// Smallest share of the widest channel that the placement of taps takes into account.
const TEXTURE_DIFFUSION_LEAST_RATIO: f32 = 0.0625f;
// A channel narrower than this share of the widest, 2^-12, counts as this wide: nothing of it is
// left at the first tap.
const TEXTURE_DIFFUSION_NARROWEST: f32 = 0.000244140625f;
// Lower limit of divisors, 2^-60, so that no quotient overflows.
const TEXTURE_DIFFUSION_SMALLEST: f32 = 8.673617379884035e-19f;

// Makes a number from any source, such as a texture or a material, safe to calculate with. It tests
// the bits, because WGSL may assume that there are neither NaNs nor infinities, and a comparison
// then finds none.
// Returns: `value`; 0 for a NaN; +-1e18 for larger magnitudes and infinities.
// Units: that of `value`.
// Domain: any bits.
// Outside: nothing; a subnormal may count as zero.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn texture_diffusion_finite(value: f32) -> f32 {
    let bits = bitcast<u32>(value);
    let magnitude = bits & 0x7fffffffu;
    if magnitude > 0x7f800000u {
        return 0.0f;
    }
    // 0x5d5e0b6b is the bit pattern of 1e18. Positive floats have the same order as their bits.
    return bitcast<f32>((bits & 0x80000000u) | min(magnitude, 0x5d5e0b6bu));
}

// Clip-space position of a vertex that draws the surface into its own texture. Texture coordinates
// count from the upper left corner with v pointing down; clip space has its origin in the middle
// and y pointing up. The centre of pixel (i, j) is then at ((i, j) + 1/2) / size, as is the centre
// of texel (i, j).
// Returns: clip-space position with z = 0 and w = 1.
// Units: uv in fractions of the texture.
// Domain: uv in [-4, 4]; the texture itself is [0, 1].
// Outside: the same, less accurate.
// Accuracy: lavapipe 1 ulp; portable 1 ulp
fn texture_diffusion_clip(uv: vec2f) -> vec4f {
    return vec4f(2.0f * uv.x - 1.0f, 1.0f - 2.0f * uv.y, 0.0f, 1.0f);
}

// Extent of the surface under a step of one texel, for the pass that draws the irradiance: there
// dpdx and dpdy of the world position are its derivatives by texels along u and v. Take them before
// any branch.
// Returns: world length of a texel along u and along v.
// Units: that of the position, per texel.
// Domain: components of derivatives 0 or in [1e-15, 1e15].
// Outside: 0 for shorter ones, infinite for longer ones; texture_diffusion_width takes both.
// Accuracy: lavapipe 2 ulp; portable 10 ulp
fn texture_diffusion_stretch(position_x: vec3f, position_y: vec3f) -> vec2f {
    return vec2f(length(position_x), length(position_y));
}

// Standard deviation of the Gaussian at a texel. If a texel has no extent, as at a sphere's pole, the
// Gaussian covers all texels that are one point there: `widest`, for which half the texture is enough.
// Returns: width in [0, widest]; 0, which is no blur, if sigma0 is 0, negative or a NaN; sigma0 / 1e18
//   if stretch is infinite.
// Units: texels; sigma0 in a length, stretch in lengths per texel.
// Domain: any bits for sigma0 and stretch, magnitudes count as at most 1e18, a NaN stretch as 0; widest
//   in [0, 1e6].
// Outside: a negative widest counts as 0.
// Accuracy: lavapipe 1 ulp; portable 3 ulp
fn texture_diffusion_width(sigma0: f32, stretch: f32, widest: f32) -> f32 {
    let sigma = max(texture_diffusion_finite(sigma0), 0.0f);
    let texel = abs(texture_diffusion_finite(stretch));
    return max(min(sigma / max(texel, TEXTURE_DIFFUSION_SMALLEST), widest), 0.0f);
}

// Scattering of each channel, made safe.
// Returns: sigma0 in [0, 1e18]; 0 for negative values and NaNs.
// Units: that of sigma0.
// Domain: any bits.
// Outside: nothing; a subnormal may count as zero.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn texture_diffusion_sigma(sigma0: vec3f) -> vec3f {
    let finite = vec3f(
        texture_diffusion_finite(sigma0.x),
        texture_diffusion_finite(sigma0.y),
        texture_diffusion_finite(sigma0.z),
    );
    return max(finite, vec3f(0.0f));
}

// Spread of the channels: the narrowest as a share of the widest. It determines the placement and
// the number of taps.
// Returns: ratio in [1/16, 1]; 1/16 if nothing scatters.
// Units: none.
// Domain: any bits; magnitudes 0 or in [2^-60, 1e18].
// Outside: less than the ratio for a widest below 2^-60.
// Accuracy: lavapipe 1 ulp; portable 3 ulp
fn texture_diffusion_ratio(sigma0: vec3f) -> f32 {
    let sigma = texture_diffusion_sigma(sigma0);
    let widest = max(max(sigma.x, sigma.y), sigma.z);
    let narrowest = min(min(sigma.x, sigma.y), sigma.z);
    return clamp(narrowest / max(widest, TEXTURE_DIFFUSION_SMALLEST), TEXTURE_DIFFUSION_LEAST_RATIO, 1.0f);
}

// Number of pairs of taps, besides the tap in the middle, that keep the error of the blur below
// 1e-3 for the clamped cosine around a cylinder, blurred by up to 1 radian; one pair fewer does
// not. The steps are measured: docs/texture_diffusion.md.
// Returns: from 15 for equal channels to 23 for a ratio of 1/16.
// Units: none.
// Domain: as for texture_diffusion_ratio.
// Outside: the same.
// Accuracy: lavapipe 2 backward; portable 4 backward
fn texture_diffusion_pairs(sigma0: vec3f) -> u32 {
    let ratio = texture_diffusion_ratio(sigma0);
    var pairs = 15u;
    pairs += select(0u, 1u, ratio < 0.695f);
    pairs += select(0u, 1u, ratio < 0.345f);
    pairs += select(0u, 1u, ratio < 0.248f);
    pairs += select(0u, 1u, ratio < 0.198f);
    pairs += select(0u, 1u, ratio < 0.124f);
    pairs += select(0u, 1u, ratio < 0.104f);
    pairs += select(0u, 1u, ratio < 0.087f);
    pairs += select(0u, 1u, ratio < 0.073f);
    return pairs;
}

// One of a pair of taps on opposite sides of the texel.
struct TextureDiffusionTap {
    // Distance from the texel, in standard deviations of the widest channel.
    offset: f32,
    // Weight in each channel, where the tap in the middle has weight 1; the weights are divided by
    // their sum.
    weight: vec3f,
}

// Position and weights of a pair of taps. With t = index / pairs they lie at x = reach (1 - bend) t /
// (1 - bend t^2): evenly in the middle, ever farther apart outside. The weight is the Gaussian times
// dx/dt, for an integral over t.
// Returns: offset in [0, 3.4]; weights at least 0, and 1 for index 0; for any other index, 0 in a
//   channel that does not scatter.
// Units: standard deviations of the widest channel.
// Domain: index from 0 to pairs, pairs from 1 to 1024; sigma0 as for texture_diffusion_ratio.
// Outside: an index beyond the last counts as the last; 0 pairs as 1.
// Accuracy: lavapipe offset 8.5 ulp, weight 2.9e-6 abs; portable offset 45 ulp, weight 9e-6 abs
fn texture_diffusion_tap(index: u32, pairs: u32, sigma0: vec3f) -> TextureDiffusionTap {
    let sigma = texture_diffusion_sigma(sigma0);
    let widest = max(max(sigma.x, sigma.y), sigma.z);
    let relative = max(sigma / max(widest, TEXTURE_DIFFUSION_SMALLEST), vec3f(TEXTURE_DIFFUSION_NARROWEST));
    let straight = 0.64f * sqrt(sqrt(texture_diffusion_ratio(sigma0)));
    let last = max(pairs, 1u);
    let t = f32(min(index, last)) / f32(last);
    let bent = (1.0f - straight) * t * t;
    let apart = 1.0f - bent;
    let offset = min(TEXTURE_DIFFUSION_REACH * straight * t / apart, TEXTURE_DIFFUSION_REACH);
    let deviations = offset / relative;
    return TextureDiffusionTap(offset, (1.0f + bent) / (apart * apart) * exp(-0.5f * deviations * deviations));
}

// Mean irradiance of the part of the surface that the taps hit. Both sums use the weights of each
// channel: `sum` adds the texels' colours, which are multiplied by their coverage, and `coverage`
// adds the coverage alone. So the weights need not sum to 1, and texels outside all charts do not
// count.
// Returns: irradiance of each channel, a mean over the covered texels; 0 if nothing is covered.
// Units: that of the irradiance.
// Domain: coverage 0 or in [2^-60, 1e6], sum at most 1e18 times the coverage.
// Outside: fades to 0 for smaller coverages.
// Accuracy: lavapipe 1 ulp; portable 3 ulp
fn texture_diffusion_normalize(sum: vec3f, coverage: vec3f) -> vec3f {
    return sum / max(coverage, vec3f(TEXTURE_DIFFUSION_SMALLEST));
}

// Nearest half float, for a target of half floats. The device decides how a target rounds: one that
// truncates takes off up to 2^-10 in each pass, and values an ulp below a half float become one
// step lower each time.
// Returns: value to 11 significant bits, ties to even; at most 65504.
// Units: that of the value.
// Domain: value 0 or in [2^-14, 1e18] in magnitude.
// Outside: smaller values keep 11 bits too, which half floats do not have there: the target rounds
//   them, by less than 2^-24.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn texture_diffusion_half(value: vec3f) -> vec3f {
    let bits = bitcast<vec3u>(clamp(value, vec3f(-65504.0f), vec3f(65504.0f)));
    let odd = (bits >> vec3u(13u)) & vec3u(1u);
    return bitcast<vec3f>((bits + 0xfffu + odd) & vec3u(0xffffe000u));
}

// Weight of a covered texel for an empty texel beside a chart, which is filled from the texels next
// to it.
// Returns: 1 / |step|^4, so the nearest texel counts most.
// Units: step in texels.
// Domain: |step| in [1, 16].
// Outside: |step| below 1 counts as 1.
// Accuracy: lavapipe 1 ulp; portable 13 ulp
fn texture_diffusion_nearness(step: vec2f) -> f32 {
    let squared = max(dot(step, step), 1.0f);
    return 1.0f / (squared * squared);
}
