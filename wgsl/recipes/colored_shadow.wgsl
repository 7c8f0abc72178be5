// colored_shadow: clear stones as one light sees them: the light lost in them, per channel, and where they begin.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own. Everitt, "Order-Independent Transparency", 2001, names the trouble of order; sums of
//   optical depths have none.
// requires: fresnel, reflective_shadow_map
// parts: mesh
//
// Draw 3 vertices per triangle of each closed stone, without culling or depth test, into one layer of
// an rgba16float texture cleared to (0, 0, 0, 1). The blend operation is add for the colour and min for
// alpha, all factors 1. Light goes straight on: it is not refracted, and nothing gathers it.

struct ColoredShadowStone {
    // Absorption coefficient in each channel, per unit of length.
    absorption: vec3f,
    // Index of refraction, relative to the medium outside.
    index: f32,
    // What each of the two faces keeps back by its colour, as an optical depth.
    surface: vec3f,
    // Depths are counted from here, so that sums stay small.
    centre: vec3f,
}

// All of the light that passes a face at grazing incidence: less than this share is not told apart.
const COLORED_SHADOW_LEAST: f32 = 0.01f;

@group(0) @binding(0) var<uniform> view: ReflectiveShadowMapView;
@group(1) @binding(0) var<storage, read> stone: ColoredShadowStone;
// Three floats per vertex, in world space.
@group(1) @binding(1) var<storage, read> positions: array<f32>;
@group(1) @binding(2) var<storage, read> indices: array<u32>;

struct ColoredShadowVertex {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
}

@vertex
fn colored_shadow_vertex(@builtin(vertex_index) vertex: u32) -> ColoredShadowVertex {
    let position = mesh_position(indices[vertex]);
    return ColoredShadowVertex(reflective_shadow_map_clip(view, position), position);
}

@fragment
fn colored_shadow_fragment(input: ColoredShadowVertex, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    // The triangle's own normal: facets are flat, whatever the vertices' normals are for.
    let across = cross(dpdx(input.position), dpdy(input.position));
    var toward_light = -view.axis;
    var way = dot(input.position - stone.centre, view.axis);
    var depth = dot(input.position - view.origin, view.axis);
    if (view.lamp == 1u) {
        let from_light = input.position - view.origin;
        toward_light = -normalize(from_light);
        way = length(from_light) - length(stone.centre - view.origin);
    }
    let cosine = abs(dot(across, toward_light)) * inverseSqrt(max(dot(across, across), 1e-30f));
    let passed = max(1.0f - fresnel_dielectric(cosine, stone.index), COLORED_SHADOW_LEAST);
    // Where light leaves less where it enters is the length of its way inside, summed over all stones.
    let inside = select(way, -way, front);
    let far = clamp((depth - view.near) / (view.far - view.near), 0.0f, 1.0f);
    return vec4f(stone.absorption * inside + stone.surface - log(passed), far);
}
