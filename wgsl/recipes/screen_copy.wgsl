// screen_copy: draws the colour and depth of one picture into another, so that bodies drawn over it can read the first.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own.
//
// A target cannot be read while it is drawn to. So what the gem recipes read under the effect
// screen_trace is drawn to textures, and copied from there to the target. An engine that copies
// textures needs no such draw. Draw three vertices with a depth test that passes where the target is
// cleared.

struct ScreenCopyView {
    // Size of the picture in texels; the textures may be larger.
    size: vec2u,
}

@group(0) @binding(0) var<uniform> view: ScreenCopyView;
@group(0) @binding(1) var radiance: texture_2d<f32>;
@group(0) @binding(2) var depth: texture_depth_2d;

struct ScreenCopyTargets {
    @location(0) radiance: vec4f,
    @builtin(frag_depth) depth: f32,
}

// One triangle that covers the target.
@vertex
fn screen_copy_vertex(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4f(4.0f * corner - 1.0f, 0.0f, 1.0f);
}

@fragment
fn screen_copy_fragment(@builtin(position) position: vec4f) -> ScreenCopyTargets {
    let texel = min(vec2u(position.xy), view.size - 1u);
    return ScreenCopyTargets(textureLoad(radiance, texel, 0), textureLoad(depth, texel, 0));
}
