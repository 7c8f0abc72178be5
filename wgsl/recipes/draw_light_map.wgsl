// draw_light_map: what one light sees of a scene: world position and N.L, for seeding paths of light and for shadows.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Dachsbacher and Stamminger, "Reflective Shadow Maps", 2005; Ozawa, Okamoto and Morishima,
//   section 3.1.
// requires: reflective_shadow_map
// parts: mesh, mesh_normals
//
// Draw 3 vertices per triangle, with a depth test and without culling, into one layer of an
// rgba32float texture cleared to (0, 0, 0, REFLECTIVE_SHADOW_MAP_NOTHING).

// Bodies keep light from others, and none enters them: their N.L counts as 0, and their normals are
// neither read nor bound.
override DRAW_LIGHT_MAP_CASTS_ONLY: bool = false;

@group(0) @binding(0) var<uniform> view: ReflectiveShadowMapView;
// Three floats per vertex, in world space.
@group(1) @binding(0) var<storage, read> positions: array<f32>;
@group(1) @binding(1) var<storage, read> indices: array<u32>;
@group(1) @binding(2) var<storage, read> normals: array<f32>;

struct DrawLightMapVertex {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
}

@vertex
fn draw_light_map_vertex(@builtin(vertex_index) vertex: u32) -> DrawLightMapVertex {
    let index = indices[vertex];
    let position = mesh_position(index);
    var normal = vec3f(0.0f);
    if (!DRAW_LIGHT_MAP_CASTS_ONLY) {
        normal = mesh_normal(index);
    }
    return DrawLightMapVertex(reflective_shadow_map_clip(view, position), position, normal);
}

@fragment
fn draw_light_map_fragment(input: DrawLightMapVertex, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    var toward_light = -view.axis;
    if (view.lamp == 1u) {
        toward_light = normalize(view.origin - input.position);
    }
    // Light that falls on a surface from behind has come through a hole in the mesh: the surface
    // casts a shadow, but no light enters there.
    var cosine = 0.0f;
    if (!DRAW_LIGHT_MAP_CASTS_ONLY) {
        cosine = select(0.0f, reflective_shadow_map_cosine(input.normal, toward_light), front);
    }
    return vec4f(input.position, cosine);
}
