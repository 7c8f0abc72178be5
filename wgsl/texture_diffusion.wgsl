// texture_diffusion: diffusion of light along a surface, as a Gaussian blur of the irradiance drawn into the surface's texture.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0, hash 9a84eb75750ecbf2
// Source: Borshukov and Lewis, "Realistic Human Face Rendering for The Matrix Reloaded", SIGGRAPH 2003 sketch;
//   d'Eon and Luebke, "Advanced Techniques for Realistic Real-Time Skin Rendering", GPU Gems 3, 2007, chapter 14: stretch, separable blur.
//   The placement of the taps is derived in docs/texture_diffusion.md.
//
// One Gaussian for each channel, of standard deviation `sigma0` on the surface: on a cylinder of radius R that is the convolution of the
// curvature-dependent reflectance with sigma = sigma0 / R. A tap is one bilinear fetch that all three channels share. Texels hold the
// irradiance times their coverage, and the coverage: 1 inside a chart, 0 where no surface is.

// Where the outermost taps lie, in standard deviations of the widest channel.
const TEXTURE_DIFFUSION_REACH: f32 = 3.4f;
// Placement knows no narrower channel than this share of the widest.
const TEXTURE_DIFFUSION_LEAST_RATIO: f32 = 0.0625f;
// A channel narrower than this share of the widest, 2^-12, counts as so narrow: nothing of it is left at the first tap.
const TEXTURE_DIFFUSION_NARROWEST: f32 = 0.000244140625f;
// Divisors are at least this, 2^-60, so that no quotient overflows.
const TEXTURE_DIFFUSION_SMALLEST: f32 = 8.673617379884035e-19f;

// A number that may come from anywhere, such as a texture or a material, made safe to calculate with.
// By its bits: WGSL may assume that there are neither NaNs nor infinities, and then a comparison finds none.
// Returns: `value`; 0 for a NaN; +-1e18 beyond that and for infinities.
// Units: that of `value`.
// Domain: any bits.
// Outside: none is; a subnormal may count as zero.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn texture_diffusion_finite(value: f32) -> f32 {
    let bits = bitcast<u32>(value);
    let magnitude = bits & 0x7fffffffu;
    if magnitude > 0x7f800000u {
        return 0.0f;
    }
    // 0x5d5e0b6b are the bits of 1e18. Positive floats are ordered as their bits are.
    return bitcast<f32>((bits & 0x80000000u) | min(magnitude, 0x5d5e0b6bu));
}

// Where a vertex is drawn so that the surface fills its own texture: texture coordinates count from the upper left corner and v runs
// down, clip space has its origin in the middle and y runs up. Pixel (i, j) then has its middle at ((i, j) + 1/2) / size, where texel (i, j) has it.
// Returns: clip-space position with z = 0 and w = 1.
// Units: uv in fractions of the texture.
// Domain: uv in [-4, 4]; the texture itself is [0, 1].
// Outside: the same, less accurate.
// Accuracy: lavapipe 1 ulp; portable 1 ulp
fn texture_diffusion_clip(uv: vec2f) -> vec4f {
    return vec4f(2.0f * uv.x - 1.0f, 1.0f - 2.0f * uv.y, 0.0f, 1.0f);
}

// How much surface lies under a step of one texel, for the pass that draws the irradiance: there dpdx and dpdy of the
// world position are its derivatives by texels along u and v. Take them before any branch.
// Returns: world length of a texel along u and along v.
// Units: that of the position, per texel.
// Domain: components of derivatives 0 or in [1e-15, 1e15].
// Outside: 0 for shorter ones, infinite for longer ones; texture_diffusion_width takes both.
// Accuracy: lavapipe 2 ulp; portable 10 ulp
fn texture_diffusion_stretch(position_x: vec3f, position_y: vec3f) -> vec2f {
    return vec2f(length(position_x), length(position_y));
}

// Standard deviation of the Gaussian at a texel.
// Where a texel has no extent, as at a sphere's pole, the Gaussian covers all texels that are one point there: `widest`. Half the
// texture is enough for that.
// Returns: width in [0, widest]; 0, which is no blur, where sigma0 is 0, negative or a NaN, or stretch infinite.
// Units: texels; sigma0 in a length, stretch in lengths per texel.
// Domain: any bits for sigma0 and stretch, magnitudes count as at most 1e18, a NaN of a stretch as 0; widest in [0, 1e6].
// Outside: a negative widest counts as 0.
// Accuracy: lavapipe 1 ulp; portable 3 ulp
fn texture_diffusion_width(sigma0: f32, stretch: f32, widest: f32) -> f32 {
    let sigma = max(texture_diffusion_finite(sigma0), 0.0f);
    let texel = abs(texture_diffusion_finite(stretch));
    return max(min(sigma / max(texel, TEXTURE_DIFFUSION_SMALLEST), widest), 0.0f);
}

// Each channel's scattering, made safe.
// Returns: sigma0 in [0, 1e18]; 0 for what is negative or a NaN.
// Units: that of sigma0.
// Domain: any bits.
// Outside: none is; a subnormal may count as zero.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn texture_diffusion_sigma(sigma0: vec3f) -> vec3f {
    let finite = vec3f(
        texture_diffusion_finite(sigma0.x),
        texture_diffusion_finite(sigma0.y),
        texture_diffusion_finite(sigma0.z),
    );
    return max(finite, vec3f(0.0f));
}

// How far apart the channels are: the narrowest's share of the widest. It decides where taps lie and how many it takes.
// Returns: ratio in [1/16, 1]; 1/16 where nothing scatters.
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

// How many pairs of taps, beside the one in the middle, keep the error of the blur below 1e-3 for the clamped cosine round a cylinder,
// blurred by up to 1 radian; one pair fewer does not. Steps as measured: docs/texture_diffusion.md.
// Returns: from 15 for equal channels to 23 for a ratio of 1/16.
// Units: none.
// Domain: as texture_diffusion_ratio.
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

// One of two taps that lie opposite each other.
struct TextureDiffusionTap {
    // Distance from the texel, in standard deviations of the widest channel.
    offset: f32,
    // Of each channel, the tap in the middle having 1; they are divided by their sum.
    weight: vec3f,
}

// Place and weights of a pair of taps. With t = index / pairs they lie at x = reach (1 - bend) t / (1 - bend t^2): evenly in the middle, as close as
// the narrowest channel needs it, and ever farther apart outside. The weight is the Gaussian times dx/dt, which makes the sum an integral over t.
// Returns: offset in [0, 3.4]; weights at least 0, 1 for index 0; those of a channel that does not scatter are 0 for any other index.
// Units: standard deviations of the widest channel.
// Domain: index from 0 to pairs, pairs from 1 to 1024; sigma0 as texture_diffusion_ratio.
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

// The mean over what the taps have found of the surface. Both sums are taken with the channel's weights: of the texels' colours, which are
// multiplied by their coverage, and of the coverage alone. So the weights need not sum to 1, and texels outside all charts count for nothing.
// Returns: irradiance of each channel: a mean of that of the covered texels; 0 where nothing is covered.
// Units: that of the irradiance.
// Domain: coverage 0 or in [2^-60, 1e6], sum at most 1e18 times the coverage.
// Outside: fades to 0 for smaller coverages.
// Accuracy: lavapipe 1 ulp; portable 3 ulp
fn texture_diffusion_normalize(sum: vec3f, coverage: vec3f) -> vec3f {
    return sum / max(coverage, vec3f(TEXTURE_DIFFUSION_SMALLEST));
}

// The nearest half float, for a target of those. How a target rounds is up to the device: one that cuts off takes up to 2^-10 in each
// pass, and half floats that are an ulp low become one step lower each time.
// Returns: value to 11 significant bits, ties to even; at most 65504.
// Units: that of the value.
// Domain: value 0 or in [2^-14, 1e18] in magnitude.
// Outside: smaller values keep 11 bits too, which half floats do not have there: the target rounds them, by less than 2^-24.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn texture_diffusion_half(value: vec3f) -> vec3f {
    let bits = bitcast<vec3u>(clamp(value, vec3f(-65504.0f), vec3f(65504.0f)));
    let odd = (bits >> vec3u(13u)) & vec3u(1u);
    return bitcast<vec3f>((bits + 0xfffu + odd) & vec3u(0xffffe000u));
}

// Weight of a covered texel for an empty one beside a chart, which takes on what is next to it.
// Returns: 1 / |step|^4: the nearest counts most.
// Units: step in texels.
// Domain: |step| in [1, 16].
// Outside: |step| below 1 counts as 1.
// Accuracy: lavapipe 1 ulp; portable 13 ulp
fn texture_diffusion_nearness(step: vec2f) -> f32 {
    let squared = max(dot(step, step), 1.0f);
    return 1.0f / (squared * squared);
}
