// material_textures: what the images of a material hold at a point: its colour, the slopes of its
//   surface, how rough and thick it is, and whether light enters.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Khronos Group, glTF 2.0, sections 3.9.2 and 3.9.3; Penner, "Pre-Integrated Skin Shading", GPU Pro
//   2, 2011, for normals blurred per colour.
//
// Call what samples an image outside all branches: the level of the image follows from the derivatives of its
// coordinates.
//
// A recipe adds: the part texture_tangents.

// The diffuse colour varies over the surface. Called for by a material's baseColorTexture.
override EFFECT_BASE_COLOR_TEXTURE: bool = false;
// The surface has slopes too fine for the mesh. Called for by a material's normalTexture.
override EFFECT_NORMAL_TEXTURE: bool = false;
// How far light spreads inside varies over the surface. Called for by a material's thicknessTexture on a body
// that cdrf draws.
override EFFECT_THICKNESS_TEXTURE: bool = false;
// Where light enters varies over the surface. Called for by a material's diffuseTransmissionTexture on a body
// that cdrf draws.
override EFFECT_TRANSMISSION_TEXTURE: bool = false;
// Roughness, and what of the surface is a metal's, vary over it. Called for by a material's metallicRoughnessTexture.
override EFFECT_ROUGHNESS_TEXTURE: bool = false;
// The diffuse colour varies from vertex to vertex. Called for by a mesh's COLOR_0.
override EFFECT_VERTEX_COLOR: bool = false;

// A map of texture coordinates, a row of the matrix for u and one for v: KHR_texture_transform.
struct TexturePlace {
    u: vec3f,
    v: vec3f,
}

// Linear RGB.
@group(1) @binding(11) var base_color_texture: texture_2d<f32>;
@group(1) @binding(12) var base_color_sampler: sampler;
// Normals' x along u and y against v, four layers: as the image has them, and blurred over the surface as far as
// red, green and blue light spread in the material.
@group(1) @binding(13) var normal_texture: texture_2d_array<f32>;
@group(1) @binding(14) var normal_sampler: sampler;
// Three floats per vertex, linear RGB.
@group(1) @binding(15) var<storage, read> colors: array<f32>;
// A share in green.
@group(1) @binding(16) var thickness_texture: texture_2d<f32>;
@group(1) @binding(17) var thickness_sampler: sampler;
// A share in alpha.
@group(1) @binding(18) var transmission_texture: texture_2d<f32>;
@group(1) @binding(19) var transmission_sampler: sampler;
// Factors of the roughness, in green, and of the share that is a metal's, in blue.
@group(1) @binding(20) var roughness_texture: texture_2d<f32>;
@group(1) @binding(21) var roughness_sampler: sampler;

fn texture_place(place: TexturePlace, uv: vec2f) -> vec2f {
    return vec2f(dot(place.u, vec3f(uv, 1.0f)), dot(place.v, vec3f(uv, 1.0f)));
}

// The unit normal of a layer of the texture, at coordinates of its image.
fn texture_normal(layer: u32, uv: vec2f, normal: vec3f, tangents: TextureTangents) -> vec3f {
    let slopes = textureSample(normal_texture, normal_sampler, uv, layer).xy;
    let up = sqrt(max(1.0f - dot(slopes, slopes), 0.0f));
    return normalize(slopes.x * tangents.u - slopes.y * tangents.v + max(up, 1e-3f) * normal);
}
