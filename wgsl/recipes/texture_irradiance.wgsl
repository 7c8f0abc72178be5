// texture_irradiance: what arrives at a surface, drawn into its own texture, for the recipe blur_texture to blur.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Borshukov and Lewis, "Realistic Human Face Rendering for The Matrix Reloaded", SIGGRAPH
//   2003 sketch; d'Eon and Luebke, "Advanced Techniques for Realistic Real-Time Skin Rendering",
//   GPU Gems 3, 2007, chapter 14.
// requires: cdrf, environment, reflective_shadow_map, texture_diffusion
// parts: mesh, mesh_normals, lights, light_views, shadow, stone_shadow, harmonics
//
// Draw 3 vertices per triangle, without culling or depth test, into two targets cleared to 0:
// rgba16float and rg32float.

// Bodies cast shadows on one another and on themselves. Called for by bodies that may stand in the
// light.
override EFFECT_SHADOW: bool = false;
// Light from all around, in addition to the lights. Called for by an environment.
override EFFECT_ENVIRONMENT: bool = true;

// Positions and normals: three floats per vertex, in world space. Texture coordinates: two.
@group(1) @binding(0) var<storage, read> positions: array<f32>;
@group(1) @binding(1) var<storage, read> indices: array<u32>;
@group(1) @binding(2) var<storage, read> normals: array<f32>;
@group(1) @binding(3) var<storage, read> uvs: array<f32>;

struct TextureIrradianceVertex {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
}

struct TextureIrradianceTexel {
    // Irradiance times coverage, which is 1.
    @location(0) irradiance: vec4f,
    // World length of a texel along u and along v.
    @location(1) stretch: vec2f,
}

@vertex
fn texture_irradiance_vertex(@builtin(vertex_index) vertex: u32) -> TextureIrradianceVertex {
    let index = indices[vertex];
    let clip = texture_diffusion_clip(vec2f(uvs[2u * index], uvs[2u * index + 1u]));
    return TextureIrradianceVertex(clip, mesh_position(index), mesh_normal(index));
}

@fragment
fn texture_irradiance_fragment(input: TextureIrradianceVertex) -> TextureIrradianceTexel {
    let stretch = texture_diffusion_stretch(dpdx(input.position), dpdy(input.position));
    // Interpolation between opposite normals may leave no direction; the triangle's own normal then
    // replaces it. Its sign follows from texels running right and down as seen from outside.
    let flat = cross(dpdy(input.position), dpdx(input.position));
    let given = select(flat, input.normal, dot(input.normal, input.normal) > 1e-12f);
    let normal = given * inverseSqrt(max(dot(given, given), 1.1754944e-38f));
    var received = vec3f(0.0f);
    for (var index = 0u; index < arrayLength(&lights); index++) {
        let arrival = light_arrival(lights[index], input.position);
        let cosine = dot(normal, arrival.direction);
        var part = arrival.irradiance * cdrf_lambert(cosine);
        if (EFFECT_SHADOW) {
            part *= shadow_of_light(index, input.position, normal);
        }
        if (EFFECT_COLORED_SHADOW) {
            part *= stone_shadow_of_light(index, input.position);
        }
        received += part;
    }
    if (EFFECT_ENVIRONMENT) {
        let weights = cdrf_harmonic_weights(0.0f);
        received += harmonics_irradiance(harmonics_around(normal), weights, weights, weights);
    }
    return TextureIrradianceTexel(vec4f(texture_diffusion_half(received), 1.0f), stretch);
}
