// gem_composite: the lighting pass of a deferred renderer for what gem_deferred_fragment wrote.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Imagire, "Proxy Geometry Gem Rendering", sections 4.3.1 and 4.3.4.
// requires: environment, refraction
// parts: surroundings
//
// The stone is lit like any other surface: its emission is added to the reflection in its surface.
// The position is reconstructed from the depth.

struct GemCompositeView {
    world_from_clip: mat4x4f,
    eye: vec3f,
    // Size of the geometry buffer in texels.
    size: vec2f,
}

@group(0) @binding(0) var<uniform> view: GemCompositeView;
@group(0) @binding(2) var emission: texture_2d<f32>;
@group(0) @binding(3) var normal: texture_2d<f32>;
@group(0) @binding(4) var reflectance: texture_2d<f32>;
@group(0) @binding(5) var depth: texture_depth_2d;

// One triangle that covers the target.
@vertex
fn gem_composite_vertex(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4f(4.0f * corner - 1.0f, 0.0f, 1.0f);
}

// The world position that a texel of the depth buffer shows. `texel` is the centre of that texel.
fn gem_composite_position(texel: vec2f, depth_value: f32) -> vec3f {
    let clip = vec4f(2.0f * texel.x / view.size.x - 1.0f, 1.0f - 2.0f * texel.y / view.size.y, depth_value, 1.0f);
    let world = view.world_from_clip * clip;
    return world.xyz / world.w;
}

@fragment
fn gem_composite_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let texel = vec2u(position.xy);
    let inside = textureLoad(emission, texel, 0);
    if (inside.a == 0.0f) {
        return vec4f(0.0f);
    }
    let world = gem_composite_position(position.xy, textureLoad(depth, texel, 0));
    let reflected = refraction_reflect(normalize(world - view.eye), normalize(textureLoad(normal, texel, 0).xyz));
    return vec4f(textureLoad(reflectance, texel, 0).rgb * surroundings_radiance(reflected) + inside.rgb, 1.0f);
}
