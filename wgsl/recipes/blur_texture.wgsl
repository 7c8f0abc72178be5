// blur_texture: the blur passes of texture-space diffusion, and the gutter round its charts.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Borshukov and Lewis, "Realistic Human Face Rendering for The Matrix Reloaded", SIGGRAPH
//   2003 sketch; d'Eon and Luebke, "Advanced Techniques for Realistic Real-Time Skin Rendering",
//   GPU Gems 3, 2007, chapter 14.
// requires: texture_diffusion
//
// 1. The host draws the mesh into its own texture, in a pass of its own: positions by
//    texture_diffusion_clip of the texture coordinates, no culling, no depth test, one sample per
//    pixel, both targets cleared to 0. Leaving out albedo and the view, it writes
//    - the irradiance, including cosine and shadow, through texture_diffusion_half to an
//      rgba16float target, with an alpha of 1;
//    - texture_diffusion_stretch of dpdx and dpdy of the world position to an rg32float target.
//    Triangles that cross the edge of a repeating texture must be drawn on both sides of it.
// 2. `blur_texture_along` along u, then along v, each time from one of two rgba16float
//    textures, both cleared to 0 beforehand, into the other. Run it once per chart, with the
//    chart's own uniform and its rectangle as the scissor; the charts' rectangles must lie one
//    texel or more apart.
// 3. `blur_texture_dilate`, unless the charts fill the texture. The result is the irradiance:
//    look it up with a linear sampler and multiply it by albedo / pi.

// Number of texels filled around a chart: a bilinear lookup needs one, or two if slivers cover no
// texel's centre.
const BLUR_TEXTURE_GUTTER: i32 = 2i;

struct BlurTextureChart {
    // (1, 0) along u, (0, 1) along v.
    direction: vec2f,
    // sigma0 of the widest channel, a length.
    sigma0: f32,
    // Number of taps in use.
    pairs: u32,
    // Lower and upper corner of the chart's rectangle in texels. Taps outside it find nothing. A
    // repeating direction has no bounds: +-1e9.
    chart: vec4f,
    // texture_diffusion_tap for index 1 to `pairs`: offset, then weights.
    taps: array<vec4f, 23>,
}

// Irradiance times the coverage in alpha.
@group(0) @binding(0) var irradiance: texture_2d<f32>;
@group(0) @binding(1) var<uniform> blur: BlurTextureChart;
// Linear. It repeats along a direction in which the surface closes; otherwise it clamps to the
// edge.
@group(0) @binding(2) var linear_sampler: sampler;
// World length of a texel along u and along v.
@group(0) @binding(3) var stretch: texture_2d<f32>;

// One triangle that covers the target.
@vertex
fn blur_texture_vertex(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4f(4.0f * corner - 1.0f, 0.0f, 1.0f);
}

// Irradiance times coverage in RGB, coverage in alpha.
@fragment
fn blur_texture_along(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let texel = vec2u(position.xy);
    let size = vec2f(textureDimensions(irradiance));
    let centre = textureLoad(irradiance, texel, 0);
    let lengths = textureLoad(stretch, texel, 0);
    let along = select(lengths.x, lengths.y, blur.direction.y > 0.5f);
    let width = texture_diffusion_width(blur.sigma0, along, 0.5f * dot(blur.direction, size));
    if centre.a == 0.0f || width == 0.0f {
        return centre;
    }
    var sum = centre.rgb;
    var coverage = vec3f(centre.a);
    for (var index = 0u; index < blur.pairs; index++) {
        let tap = blur.taps[index];
        let step = tap.x * width * blur.direction;
        for (var side = -1i; side <= 1i; side += 2i) {
            let place = position.xy + f32(side) * step;
            if all(place >= blur.chart.xy) && all(place <= blur.chart.zw) {
                let found = textureSampleLevel(irradiance, linear_sampler, place / size, 0.0f);
                sum += tap.yzw * found.rgb;
                coverage += tap.yzw * found.a;
            }
        }
    }
    return vec4f(texture_diffusion_half(centre.a * texture_diffusion_normalize(sum, coverage)), centre.a);
}

// Irradiance, and 1 in alpha, on the charts and in their gutters; 0 elsewhere.
@fragment
fn blur_texture_dilate(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let texel = vec2i(position.xy);
    let size = vec2i(textureDimensions(irradiance));
    let centre = textureLoad(irradiance, texel, 0);
    var sum = centre.rgb;
    var coverage = centre.a;
    if centre.a == 0.0f {
        for (var row = -BLUR_TEXTURE_GUTTER; row <= BLUR_TEXTURE_GUTTER; row++) {
            for (var column = -BLUR_TEXTURE_GUTTER; column <= BLUR_TEXTURE_GUTTER; column++) {
                let step = vec2i(column, row);
                if all(texel + step >= vec2i(0i)) && all(texel + step < size) {
                    let neighbour = textureLoad(irradiance, texel + step, 0);
                    let weight = texture_diffusion_nearness(vec2f(step));
                    sum += weight * neighbour.rgb;
                    coverage += weight * neighbour.a;
                }
            }
        }
    }
    return vec4f(
        texture_diffusion_half(texture_diffusion_normalize(sum, vec3f(coverage))),
        select(0.0f, 1.0f, coverage > 0.0f)
    );
}
