// gem_resolve: mixes each pixel with its neighbours by the shares that gem_footprint_fragment wrote.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Persson, "Geometry Buffer Anti-Aliasing", in GPU Pro 3, 2012; the module ray_footprint.
// requires: ray_footprint
//
// Draw three vertices over a target of the picture's size. Pixels without a stone have no shares and
// pass through.

struct GemResolveView {
    // Size of the picture in texels; the textures may be larger.
    size: vec2u,
}

@group(0) @binding(0) var<uniform> view: GemResolveView;
@group(0) @binding(1) var radiance: texture_2d<f32>;
@group(0) @binding(2) var neighbours: texture_2d<f32>;

// One triangle that covers the target.
@vertex
fn gem_resolve_vertex(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4f(4.0f * corner - 1.0f, 0.0f, 1.0f);
}

@fragment
fn gem_resolve_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let texel = vec2u(position.xy);
    let found = textureLoad(neighbours, texel, 0);
    // Rounded to eight bits, they may add up to more than 1.
    let shares = found / max(found.x + found.y + found.z + found.w, 1.0f);
    let own = textureLoad(radiance, texel, 0);
    if (all(shares == vec4f(0.0f))) {
        return own;
    }
    // Beyond the border the pixel at the border stands in.
    let before = max(texel, vec2u(1u)) - 1u;
    let after = min(texel + 1u, view.size - 1u);
    let right = textureLoad(radiance, vec2u(after.x, texel.y), 0);
    let left = textureLoad(radiance, vec2u(before.x, texel.y), 0);
    let below = textureLoad(radiance, vec2u(texel.x, after.y), 0);
    let above = textureLoad(radiance, vec2u(texel.x, before.y), 0);
    return ray_footprint_mix(own, right, left, below, above, shares);
}
