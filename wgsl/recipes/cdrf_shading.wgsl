// cdrf_shading: skin, wax or jade by curvature-dependent reflectance in one draw call, under lights and an environment.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Kubo, Dobashi and Morishima, "Real-time Rendering of Translucent Materials using
//   Curvature-Dependent Reflectance Function".
// requires: cdrf, curvature, diffusion, environment, fresnel, half_space, microfacet, reflective_shadow_map
// requires: split_sum
// parts: mesh, mesh_normals, surroundings, lights, light_views, shadow, translucent_shadow
// parts: stone_shadow, harmonics, reflection, metal, scattering_law, texture_tangents, material_textures
// parts: sample_rank
// compares: curvature
//
// Draw 3 vertices per triangle without a vertex buffer. Positions and normals are in world space,
// with any uneven scale of the mesh already applied to both (to normals by the inverse transpose),
// so that curvatures are those of the visible surface.

// Light crosses inside the material from the lit side to the dark side. Called for by
// extras.lapidary.sigma0 above 0.
override EFFECT_CDRF: bool = true;
// The form of the reflectance: 0 wrap lighting, 1 a table through a sampler, 2 a table filtered by
// hand (for formats that no sampler filters), 3 cheap, 4 accurate, 5 quadrature, 6 spherical.
override CDRF_FORM: u32 = 4u;
// How far light spreads, from curvature and material: 0 sigma0 times curvature; 1 the power law of random
// walks through spheres; 2 their drift and a width, which take the half space's law for granted.
override SPREAD_FORM: u32 = 0u;
// The source of the curvature. From the pixel's derivatives: 0 mean, 1 of the section towards each
// light, 2 mean by the usual |dN| / |dP|. From the vertices: 3 mean. Derivatives need no data, but
// jump between the triangles of a coarse mesh; curvatures given at the vertices do not.
override CURVATURE_FORM: u32 = 0u;
// A second lobe of the highlights, as skin has. Called for by extras.lapidary.secondLobe, where there are highlights.
override EFFECT_SECOND_LOBE: bool = false;
// Some of the light does not enter, and leaves the surface as Lambert's law says. Called for by a
// diffuseTransmissionFactor between 0 and 1, or a diffuseTransmissionTexture, on a body that cdrf draws.
override EFFECT_PARTIAL_TRANSMISSION: bool = false;
// The surface covers a share of what is behind it, or only some of its points do. Called for by an
// alphaMode of MASK or BLEND.
override EFFECT_COVERAGE: bool = false;
// Uses irradiance that was drawn into the mesh's own texture and blurred there, by the recipes
// texture_irradiance and blur_texture.
override EFFECT_TEXTURE_DIFFUSION: bool = false;
// Bodies cast shadows on one another and on themselves: the recipe draw_light_map draws each
// light's view beforehand. Called for by bodies that may stand in the light.
override EFFECT_SHADOW: bool = false;
// Light from all around, in addition to the lights. Called for by an environment.
override EFFECT_ENVIRONMENT: bool = true;
// Sums the environment's harmonics per vertex and interpolates them, instead of summing them per
// pixel: over a triangle with smooth normals they are smooth too.
override ENVIRONMENT_AT_VERTICES: bool = true;

const CDRF_FORM_WRAP: u32 = 0u;
const CDRF_FORM_TABLE: u32 = 1u;
const CDRF_FORM_TEXELS: u32 = 2u;
const CDRF_FORM_CHEAP: u32 = 3u;
const CDRF_FORM_QUADRATURE: u32 = 5u;
const CDRF_FORM_SPHERICAL: u32 = 6u;
const SPREAD_FORM_POWER: u32 = 1u;
const SPREAD_FORM_DRIFT: u32 = 2u;
// Factor on the way of light through a body.
const CDRF_LOST_SIDEWAYS: f32 = 1.3f;
const CURVATURE_FORM_TOWARDS: u32 = 1u;
const CURVATURE_FORM_NAIVE: u32 = 2u;
const CURVATURE_FORM_VERTEX: u32 = 3u;

struct CdrfView {
    clip_from_world: mat4x4f,
    eye: vec3f,
}

struct CdrfMaterial {
    // Diffuse reflectance of the surface, linear RGB; of matter with coefficients that of a half space of it.
    base_color: vec3f,
    // Index of refraction, relative to the medium outside.
    index: f32,
    // sigma0 of each channel, in units of length; the host makes it safe once, as
    // cdrf_sigma(sigma0, 1) does.
    sigma0: vec3f,
    // The largest of the three, for lookups in a table that was baked for this material.
    table_sigma0: f32,
    // Width of the microfacets' slopes, the square of the roughness; 0 for a polished surface.
    alpha: f32,
    // Mean free path of each channel, in units of length; made safe by the host as sigma0 is.
    free_path: vec3f,
    // diffusion_milne of the index at the boundary.
    milne: f32,
    law: ScatteringLaw,
    // The same width of a second lobe of the highlights, and its share of them.
    second_alpha: f32,
    second_weight: f32,
    base_color_place: TexturePlace,
    normal_place: TexturePlace,
    thickness_place: TexturePlace,
    transmission_place: TexturePlace,
    roughness_place: TexturePlace,
    // Share of the light that enters, 0 to 1.
    transmission: f32,
    // Share of what is behind that the surface covers, without its image.
    coverage: f32,
    // The share from which on a point covers; below 0 if a share of the samples covers.
    cutoff: f32,
    // The body's number, which decides which samples cover.
    body: u32,
    // Colour of the light that does not enter, relative to `base_color`.
    rest: vec3f,
    // Share of the surface that is a metal's, without its image.
    metallic: f32,
}

@group(0) @binding(0) var<uniform> view: CdrfView;
// Not a uniform: lavapipe recompiles the shader for every uniform buffer that it is drawn with,
// which costs megabytes per body.
@group(1) @binding(0) var<storage, read> material: CdrfMaterial;
// Three floats per vertex.
@group(1) @binding(1) var<storage, read> positions: array<f32>;
@group(1) @binding(2) var<storage, read> indices: array<u32>;
@group(1) @binding(3) var<storage, read> normals: array<f32>;
// Baked by the recipe cdrf_table with this material's tint.
@group(1) @binding(4) var table: texture_2d<f32>;
@group(1) @binding(5) var table_sampler: sampler;
// Baked with the tint (1, 1, 1) for all materials: one channel, in a format that no sampler
// filters.
@group(1) @binding(6) var table_texels: texture_2d<f32>;
// Mean curvature of each vertex, for CURVATURE_FORM_VERTEX; per unit of length.
@group(1) @binding(7) var<storage, read> curvatures: array<f32>;
// Two floats per vertex, for texture diffusion and for the material's textures.
@group(1) @binding(8) var<storage, read> uvs: array<f32>;
// Blurred irradiance.
@group(1) @binding(9) var diffused: texture_2d<f32>;
@group(1) @binding(10) var diffused_sampler: sampler;

struct CdrfVertex {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) curvature: f32,
    // HarmonicsAround, if it is summed per vertex.
    @location(3) around_zeroth: vec3f,  //+environment
    @location(4) around_first: vec3f,  //+environment
    @location(5) around_second: vec3f,  //+environment
    @location(6) around_fourth: vec3f,  //+environment
    @location(7) uv: vec2f,  //+texture_diffusion
    @location(8) base_color_uv: vec2f,  //+base_color_texture
    @location(9) normal_uv: vec2f,  //+normal_texture
    @location(10) color: vec3f,  //+vertex_color
    @location(11) thickness_uv: vec2f,  //+thickness_texture
    @location(12) transmission_uv: vec2f,  //+transmission_texture
    @location(13) roughness_uv: vec2f,  //+roughness_texture
}

@vertex
fn cdrf_vertex(@builtin(vertex_index) vertex: u32) -> CdrfVertex {
    let index = indices[vertex];
    let position = mesh_position(index);
    let normal = mesh_normal(index);
    var curvature = 0.0f;
    if (CURVATURE_FORM == CURVATURE_FORM_VERTEX) {
        curvature = curvatures[index];
    }
    //+environment {
    var around = HarmonicsAround(vec3f(0.0f), vec3f(0.0f), vec3f(0.0f), vec3f(0.0f));
    if (EFFECT_ENVIRONMENT && ENVIRONMENT_AT_VERTICES) {
        around = harmonics_around(normal * inverseSqrt(max(dot(normal, normal), 1e-12f)));
    }
    //+environment }
    //+texture_diffusion {
    var uv = vec2f(0.0f);
    if (EFFECT_TEXTURE_DIFFUSION) {
        uv = vec2f(uvs[2u * index], uvs[2u * index + 1u]);
    }
    //+texture_diffusion }
    //+base_color_texture {
    var base_color_uv = vec2f(0.0f);
    if (EFFECT_BASE_COLOR_TEXTURE) {
        base_color_uv = texture_place(material.base_color_place, vec2f(uvs[2u * index], uvs[2u * index + 1u]));
    }
    //+base_color_texture }
    //+normal_texture {
    var normal_uv = vec2f(0.0f);
    if (EFFECT_NORMAL_TEXTURE) {
        normal_uv = texture_place(material.normal_place, vec2f(uvs[2u * index], uvs[2u * index + 1u]));
    }
    //+normal_texture }
    //+thickness_texture {
    var thickness_uv = vec2f(0.0f);
    if (EFFECT_THICKNESS_TEXTURE) {
        thickness_uv = texture_place(material.thickness_place, vec2f(uvs[2u * index], uvs[2u * index + 1u]));
    }
    //+thickness_texture }
    //+transmission_texture {
    var transmission_uv = vec2f(0.0f);
    if (EFFECT_TRANSMISSION_TEXTURE) {
        transmission_uv = texture_place(material.transmission_place, vec2f(uvs[2u * index], uvs[2u * index + 1u]));
    }
    //+transmission_texture }
    //+roughness_texture {
    var roughness_uv = vec2f(0.0f);
    if (EFFECT_ROUGHNESS_TEXTURE) {
        roughness_uv = texture_place(material.roughness_place, vec2f(uvs[2u * index], uvs[2u * index + 1u]));
    }
    //+roughness_texture }
    //+vertex_color {
    var color = vec3f(1.0f);
    if (EFFECT_VERTEX_COLOR) {
        color = vec3f(colors[3u * index], colors[3u * index + 1u], colors[3u * index + 2u]);
    }
    //+vertex_color }
    let clip = view.clip_from_world * vec4f(position, 1.0f);
    return CdrfVertex(
        clip,
        position,
        normal,
        curvature,
        around.zeroth,  //+environment
        around.first,  //+environment
        around.second,  //+environment
        around.fourth,  //+environment
        uv,  //+texture_diffusion
        base_color_uv,  //+base_color_texture
        normal_uv,  //+normal_texture
        color,  //+vertex_color
        thickness_uv,  //+thickness_texture
        transmission_uv,  //+transmission_texture
        roughness_uv,  //+roughness_texture
    );
}

// The derivatives at a pixel, the curvature that follows from them, the factor of the lengths by which light
// spreads, and the share of the light that enters.
struct CdrfSurface {
    position_x: vec3f,
    position_y: vec3f,
    normal_x: vec3f,
    normal_y: vec3f,
    curvature: f32,
    thickness: f32,
    transmission: f32,
}

// The surface at a pixel. Call it outside all branches: derivatives need the neighbouring pixels.
fn cdrf_surface(input: CdrfVertex) -> CdrfSurface {
    let position_x = dpdx(input.position);
    let position_y = dpdy(input.position);
    let normal_x = curvature_normal_derivative(input.normal, dpdx(input.normal));
    let normal_y = curvature_normal_derivative(input.normal, dpdy(input.normal));
    var curvature = input.curvature;
    if (CURVATURE_FORM == CURVATURE_FORM_NAIVE) {
        curvature = curvature_naive(position_x, position_y, normal_x, normal_y);
    } else if (CURVATURE_FORM != CURVATURE_FORM_VERTEX) {
        curvature = curvature_mean(position_x, position_y, normal_x, normal_y);
    }
    var thickness = 1.0f;
    if (EFFECT_THICKNESS_TEXTURE) {
        thickness = textureSample(thickness_texture, thickness_sampler, input.thickness_uv).g;
    }
    var transmission = 1.0f;
    if (EFFECT_PARTIAL_TRANSMISSION) {
        transmission = material.transmission;
    }
    if (EFFECT_TRANSMISSION_TEXTURE) {
        transmission *= textureSample(transmission_texture, transmission_sampler, input.transmission_uv).a;
    }
    return CdrfSurface(position_x, position_y, normal_x, normal_y, curvature, thickness, transmission);
}

// What the surface is at a pixel where light does not enter: the width of the microfacets' slopes, and the share that
// is a metal's.
struct CdrfGloss {
    alpha: f32,
    metallic: f32,
}

// Call it outside all branches, for the level of the image.
fn cdrf_gloss(input: CdrfVertex) -> CdrfGloss {
    var gloss = CdrfGloss(material.alpha, 0.0f);
    if (EFFECT_METAL) {
        gloss.metallic = material.metallic;
    }
    if (EFFECT_ROUGHNESS_TEXTURE) {
        let texel = textureSample(roughness_texture, roughness_sampler, input.roughness_uv);
        gloss.alpha *= texel.g * texel.g;
        gloss.metallic *= texel.b;
    }
    return gloss;
}

// The unit normal. If interpolation between opposite normals leaves no direction, the surface
// counts as facing the eye.
fn cdrf_unit_normal(normal: vec3f, toward_eye: vec3f) -> vec3f {
    let squared = dot(normal, normal);
    return select(toward_eye, normal * inverseSqrt(max(squared, 1e-12f)), squared > 1e-12f);
}

// Normals at a pixel: of the mesh, of the surface with its fine slopes, and of these as far as the light of each
// channel does not even them out.
struct CdrfNormals {
    coarse: vec3f,
    sharp: vec3f,
    red: vec3f,
    green: vec3f,
    blue: vec3f,
}

// Call it outside all branches, for the derivatives of the coordinates.
fn cdrf_normals(input: CdrfVertex, surface: CdrfSurface, normal: vec3f) -> CdrfNormals {
    var normals = CdrfNormals(normal, normal, normal, normal, normal);
    if (EFFECT_NORMAL_TEXTURE) {
        let uv = input.normal_uv;
        let tangents = texture_tangents(normal, surface.position_x, surface.position_y, dpdx(uv), dpdy(uv));
        normals.sharp = texture_normal(0u, uv, normal, tangents);
        normals.red = texture_normal(1u, uv, normal, tangents);
        normals.green = texture_normal(2u, uv, normal, tangents);
        normals.blue = texture_normal(3u, uv, normal, tangents);
    }
    return normals;
}

// Cosines of a direction with each channel's normal.
fn cdrf_cosines(normals: CdrfNormals, direction: vec3f) -> vec3f {
    return vec3f(dot(normals.red, direction), dot(normals.green, direction), dot(normals.blue, direction));
}

// Width of the Gaussian for each channel: cdrf_sigma, with sigma0 already made safe by the host.
fn cdrf_sigmas(curvature: f32) -> vec3f {
    if (SPREAD_FORM == SPREAD_FORM_POWER) {
        return vec3f(
            cdrf_sigma_power(material.free_path.x, curvature),
            cdrf_sigma_power(material.free_path.y, curvature),
            cdrf_sigma_power(material.free_path.z, curvature),
        );
    }
    if (SPREAD_FORM == SPREAD_FORM_DRIFT) {
        return vec3f(
            cdrf_drift(material.free_path.x, curvature, material.law.gamma.x).sigma,
            cdrf_drift(material.free_path.y, curvature, material.law.gamma.y).sigma,
            cdrf_drift(material.free_path.z, curvature, material.law.gamma.z).sigma,
        );
    }
    return material.sigma0 * abs(cdrf_finite(curvature));
}

// Looks up the table by hand, blending four texels.
fn cdrf_lookup(cosine: f32, sigma: f32) -> f32 {
    let texels = cdrf_texels(cdrf_table_coordinates(cosine, sigma), textureDimensions(table_texels));
    return cdrf_blend(
        texels.weight,
        textureLoad(table_texels, texels.lower, 0).rgb,
        textureLoad(table_texels, vec2u(texels.upper.x, texels.lower.y), 0).rgb,
        textureLoad(table_texels, vec2u(texels.lower.x, texels.upper.y), 0).rgb,
        textureLoad(table_texels, texels.upper, 0).rgb,
    ).x;
}

// The reflectance of one channel, after the drift of its light.
fn cdrf_drifted(cosine: f32, drift: CdrfDrift) -> f32 {
    return drift.share * cdrf_cheap(cdrf_shifted(cosine, drift.shift), drift.sigma);
}

// Looks up the table through its sampler.
fn cdrf_sampled(cosine: f32, sigma: f32) -> vec3f {
    let coordinates = cdrf_table_coordinates(cosine, sigma);
    return textureSampleLevel(table, table_sampler,
        cdrf_texture_coordinates(coordinates, textureDimensions(table)), 0.0f).rgb;
}

// The reflectance towards one light, per channel, of each channel's cosine.
fn cdrf_reflectance(cosines: vec3f, curvature: f32) -> vec3f {
    if (!EFFECT_CDRF) {  //+cdrf
        return vec3f(cdrf_lambert(cosines.x), cdrf_lambert(cosines.y), cdrf_lambert(cosines.z));
    }  //+cdrf
    //+cdrf {
    if (CDRF_FORM == CDRF_FORM_TABLE) {
        let widest = material.table_sigma0 * abs(cdrf_finite(curvature));
        var found = cdrf_sampled(cosines.x, widest);
        if (EFFECT_NORMAL_TEXTURE) {
            found = vec3f(found.x, cdrf_sampled(cosines.y, widest).y, cdrf_sampled(cosines.z, widest).z);
        }
        return found;
    }
    if (SPREAD_FORM == SPREAD_FORM_DRIFT) {
        return vec3f(
            cdrf_drifted(cosines.x, cdrf_drift(material.free_path.x, curvature, material.law.gamma.x)),
            cdrf_drifted(cosines.y, cdrf_drift(material.free_path.y, curvature, material.law.gamma.y)),
            cdrf_drifted(cosines.z, cdrf_drift(material.free_path.z, curvature, material.law.gamma.z)),
        );
    }
    let sigma = cdrf_sigmas(curvature);
    if (CDRF_FORM == CDRF_FORM_TEXELS) {
        return vec3f(cdrf_lookup(cosines.x, sigma.x), cdrf_lookup(cosines.y, sigma.y), cdrf_lookup(cosines.z, sigma.z));
    }
    if (CDRF_FORM == CDRF_FORM_WRAP) {
        return vec3f(cdrf_wrap(cosines.x, sigma.x), cdrf_wrap(cosines.y, sigma.y), cdrf_wrap(cosines.z, sigma.z));
    }
    if (CDRF_FORM == CDRF_FORM_CHEAP) {
        return vec3f(cdrf_cheap(cosines.x, sigma.x), cdrf_cheap(cosines.y, sigma.y), cdrf_cheap(cosines.z, sigma.z));
    }
    if (CDRF_FORM == CDRF_FORM_QUADRATURE) {
        return vec3f(
            cdrf_quadrature(cosines.x, sigma.x),
            cdrf_quadrature(cosines.y, sigma.y),
            cdrf_quadrature(cosines.z, sigma.z)
        );
    }
    if (CDRF_FORM == CDRF_FORM_SPHERICAL) {
        return vec3f(
            cdrf_spherical(cosines.x, sigma.x),
            cdrf_spherical(cosines.y, sigma.y),
            cdrf_spherical(cosines.z, sigma.z)
        );
    }
    return vec3f(
        cdrf_accurate(cosines.x, sigma.x),
        cdrf_accurate(cosines.y, sigma.y),
        cdrf_accurate(cosines.z, sigma.z)
    );
    //+cdrf }
}

// The visible share of a light. A surface that faces away from the light needs no shadow to be
// dark, so it gets 1.
fn cdrf_visible(light: u32, cosine: f32, position: vec3f, normal: vec3f) -> f32 {
    if (cosine <= 0.0f) {
        return 1.0f;
    }
    return shadow_of_light(light, position, normal);
}

// The reflectance without the shadowed share of the light that falls on the point itself, the
// clamped cosine; light that entered nearby stays. So nothing changes at the terminator, where a
// mask over the whole reflectance would have an edge.
fn cdrf_shadowed(reflectance: vec3f, cosines: vec3f, visible: f32) -> vec3f {
    return max(reflectance - (1.0f - visible) * max(cosines, vec3f(0.0f)), vec3f(0.0f));
}

// The cosine at which the light that leaves here has entered, for the law of the matter: its mean over
// where the light entered, weighted with the light. Of a Gaussian around a small angle x that is x + sigma^2 / x on
// the lit side and 1.25 sigma at the terminator; the root lies between, and is not grazing where
// something is spread. Where nothing is, it is the reflectance, the clamped cosine.
fn cdrf_entered(reflectance: vec3f, curvature: f32) -> vec3f {
    if (!EFFECT_CDRF) {  //+cdrf
        return reflectance;
    }  //+cdrf
    //+cdrf {
    let sigma = cdrf_sigmas(curvature);
    return min(sqrt(reflectance * reflectance + sigma * sigma), vec3f(1.0f));
    //+cdrf }
}

// How far up the light what a bent surface spreads to a point can have entered. On a sphere, light that arrives
// past the terminator at a cosine -c has entered at most 2 c radii up the light, and it arrives hardly farther
// past it than three widths.
fn cdrf_reach(cosine: f32, curvature: f32, spread: f32) -> vec3f {
    let sigma = cdrf_sigmas(spread);
    let angle = 2.0f * (min(vec3f(abs(cosine)), 3.0f * sigma) + sigma);
    return max(angle / max(abs(cdrf_finite(curvature)), 1e-12f), vec3f(1e-6f));
}

// Reflectance under a light that enters around the point or behind it, as its map says. What enters around is
// spread, as far as no other part of a body has taken it, and what enters behind comes through the body as
// through a slab. The larger one counts: the spread was fitted to whole spheres, through which light comes as
// well. Where the light falls on the point itself its way is short, and nearly nothing collides on it. Through
// a bent body light also gets lost sideways, as if its way were longer.
fn cdrf_translucent(
    reflectance: vec3f, law: vec3f, cosines: vec3f, shadow: TranslucentShadow, cosine_eye: f32
) -> vec3f {
    let falls = max(cosines, vec3f(0.0f));
    let all = max(reflectance - (vec3f(1.0f) - shadow.visible) * falls, vec3f(0.0f));
    let own = min(all, shadow.visible * falls);
    let spread = own + (all - own) * shadow.near;
    if (SHADOW_FORM != SHADOW_FORM_THROUGH) {
        return law * spread;
    }
    let depth = CDRF_LOST_SIDEWAYS * shadow.way / max(material.free_path, vec3f(1e-12f));
    let passed = vec3f(
        diffusion_slab(depth.x, material.law.gamma.x, material.milne)
        * scattering_law_passed(shadow.cosine.x, material.law),
        diffusion_slab(depth.y, material.law.gamma.y, material.milne)
        * scattering_law_passed(shadow.cosine.y, material.law),
        diffusion_slab(depth.z, material.law.gamma.z, material.milne)
        * scattering_law_passed(shadow.cosine.z, material.law),
    );
    let seen = 0.31830987f * material.law.light * scattering_law_inside(cosine_eye, material.law);
    return max(law * spread, shadow.cosine * passed * seen);
}

// Irradiance from all around, per channel, by a normal.
fn cdrf_around(around: HarmonicsAround, sigma: vec3f) -> vec3f {
    let red = cdrf_harmonic_weights(sigma.x);
    let green = cdrf_harmonic_weights(sigma.y);
    let blue = cdrf_harmonic_weights(sigma.z);
    return harmonics_irradiance(around, red, green, blue);
}

// Irradiance, each light's part spread by its reflectance and seen by the law of the matter.
fn cdrf_received(input: CdrfVertex, surface: CdrfSurface, normals: CdrfNormals, toward_eye: vec3f) -> vec3f {
    let normal = normals.coarse;
    var cosine_eye = 1.0f;
    if (EFFECT_HALF_SPACE) {
        // By derivatives of its own: those of the surface bring its curvature along.
        cosine_eye = mesh_cosine_to_eye(normal, toward_eye, dpdx(input.position), dpdy(input.position));
    }
    var received = vec3f(0.0f);
    for (var index = 0u; index < arrayLength(&lights); index++) {
        let arrival = light_arrival(lights[index], input.position);
        var curvature = surface.curvature;
        if (CURVATURE_FORM == CURVATURE_FORM_TOWARDS) {
            curvature = curvature_towards(
                surface.position_x, surface.position_y, surface.normal_x, surface.normal_y, arrival.direction
            );
        }
        let cosine = dot(normal, arrival.direction);
        var cosines = vec3f(cosine);
        if (EFFECT_NORMAL_TEXTURE) {
            cosines = cdrf_cosines(normals, arrival.direction);
        }
        // Every width is a length times a curvature.
        let spread = surface.thickness * curvature;
        var reflectance = cdrf_reflectance(cosines, spread);
        //+partial_transmission {
        var opaque = vec3f(max(dot(normals.sharp, arrival.direction), 0.0f));
        //+partial_transmission }
        //+half_space {
        var law = vec3f(1.0f);
        if (EFFECT_HALF_SPACE) {
            law = scattering_law_of_light(cosine_eye, cdrf_entered(reflectance, spread), material.law);
        }
        //+half_space }
        if (EFFECT_TRANSLUCENT_SHADOW) {  //+translucent_shadow
            //+translucent_shadow {
            let reach = cdrf_reach(max(cosines.x, max(cosines.y, cosines.z)), curvature, spread);
            let shadow = translucent_shadow_of_light(
                index, input.position, normal, arrival.direction, surface.thickness * material.free_path, reach
            );
            var seen = vec3f(1.0f);
            if (EFFECT_HALF_SPACE) {
                seen = law;
            }
            reflectance = cdrf_translucent(reflectance, seen, cosines, shadow, cosine_eye);
            if (EFFECT_PARTIAL_TRANSMISSION) {
                opaque *= shadow.visible;
            }
            //+translucent_shadow }
        } else {  //+translucent_shadow
            if (EFFECT_SHADOW) {
                let most = max(cosine, max(cosines.x, max(cosines.y, cosines.z)));
                let visible = cdrf_visible(index, most, input.position, normal);
                reflectance = cdrf_shadowed(reflectance, cosines, visible);
                if (EFFECT_PARTIAL_TRANSMISSION) {
                    opaque *= visible;
                }
            }
            if (EFFECT_HALF_SPACE) {
                reflectance *= law;
            }
        }  //+translucent_shadow
        if (EFFECT_PARTIAL_TRANSMISSION) {
            reflectance = mix(material.rest * opaque, reflectance, surface.transmission);
        }
        if (EFFECT_COLORED_SHADOW) {
            reflectance *= stone_shadow_of_light(index, input.position);
        }
        received += arrival.irradiance * reflectance;
    }
    if (EFFECT_ENVIRONMENT) {
        var irradiance = vec3f(0.0f);
        var around = HarmonicsAround(input.around_zeroth, input.around_first, input.around_second, input.around_fourth);
        if (!ENVIRONMENT_AT_VERTICES) {
            around = harmonics_around(normal);
        }
        var sigma = vec3f(0.0f);
        if (EFFECT_CDRF) {
            sigma = cdrf_sigmas(surface.thickness * surface.curvature);
        }
        if (EFFECT_NORMAL_TEXTURE) {  //+normal_texture
            //+normal_texture {
            irradiance = vec3f(
                cdrf_around(harmonics_around(normals.red), sigma).x,
                cdrf_around(harmonics_around(normals.green), sigma).y,
                cdrf_around(harmonics_around(normals.blue), sigma).z,
            );
            //+normal_texture }
        } else {  //+normal_texture
            irradiance = cdrf_around(around, sigma);
        }  //+normal_texture
        if (EFFECT_HALF_SPACE) {
            irradiance *= scattering_law_around(cosine_eye, material.law);
        }
        if (EFFECT_PARTIAL_TRANSMISSION) {
            irradiance = mix(
                material.rest * cdrf_around(harmonics_around(normals.sharp), vec3f(0.0f)),
                irradiance,
                surface.transmission,
            );
        }
        received += irradiance;
    }
    return received;
}

// Radiance that the surface reflects from all lights towards the eye, without spreading it.
fn cdrf_highlights(
    position: vec3f,
    normals: CdrfNormals,
    toward_eye: vec3f,
    gloss: CdrfGloss,
    metal: Metal,  //+metal
) -> vec3f {
    var sum = vec3f(0.0f);
    for (var index = 0u; index < arrayLength(&lights); index++) {
        let arrival = light_arrival(lights[index], position);
        var highlight = reflection_highlight(arrival, normals.sharp, toward_eye, material.index, gloss.alpha);
        if (EFFECT_SECOND_LOBE) {
            let second = reflection_highlight(
                arrival, normals.sharp, toward_eye, material.index, material.second_alpha
            );
            highlight = mix(highlight, second, material.second_weight);
        }
        if (EFFECT_METAL) {
            let of_metal = metal_highlight(metal, arrival, normals.sharp, toward_eye);
            highlight = mix(highlight, of_metal, gloss.metallic);
        }
        if (EFFECT_SHADOW) {
            highlight *= cdrf_visible(index, dot(normals.sharp, arrival.direction), position, normals.coarse);
        }
        if (EFFECT_COLORED_SHADOW) {
            highlight *= stone_shadow_of_light(index, position);
        }
        sum += highlight;
    }
    return sum;
}

// The coverage above which a sample is drawn: the cutoff, or one of 16 evenly spaced shares, each once in
// 4 x 4 neighbouring samples, so that bodies need no order. Each body begins with another one.
fn cdrf_threshold(place: vec2u) -> f32 {
    if (material.cutoff >= 0.0f) {
        return material.cutoff;
    }
    return (f32((sample_rank(place) + sample_shift(place, material.body)) & 15u) + 0.5f) / 16.0f;
}

@fragment
fn cdrf_fragment(input: CdrfVertex) -> @location(0) vec4f {
    let surface = cdrf_surface(input);
    let gloss = cdrf_gloss(input);
    let toward_eye = normalize(view.eye - input.position);
    let normals = cdrf_normals(input, surface, cdrf_unit_normal(input.normal, toward_eye));

    var received = vec3f(0.0f);
    if (EFFECT_TEXTURE_DIFFUSION) {  //+texture_diffusion
        received = textureSampleLevel(diffused, diffused_sampler, input.uv, 0.0f).rgb;  //+texture_diffusion
    } else {  //+texture_diffusion
        received = cdrf_received(input, surface, normals, toward_eye);
    }  //+texture_diffusion
    var base_color = material.base_color;
    var coverage = material.coverage;
    if (EFFECT_BASE_COLOR_TEXTURE) {
        let texel = textureSample(base_color_texture, base_color_sampler, input.base_color_uv);
        base_color *= texel.rgb;
        coverage *= texel.a;
    }
    if (EFFECT_VERTEX_COLOR) {
        base_color *= input.color;
    }
    let inside = 0.31830987f * base_color * received;
    var radiance = inside;
    if (EFFECT_REFLECTION) {
        radiance = reflection_over(inside, normals.sharp, toward_eye, material.index, gloss.alpha);
    }
    //+metal {
    var metal = Metal(vec3f(0.0f), 0.0f, vec3f(0.0f), vec3f(0.0f));
    //+metal }
    if (EFFECT_METAL) {
        metal = metal_seen(base_color, gloss.alpha, dot(normals.sharp, toward_eye));
        let mirrored = reflect(-toward_eye, normals.sharp);
        var around = metal_surroundings(mirrored, gloss.alpha);
        if (EFFECT_REFLECTION) {
            // The first level is the environment at the size of the map.
            around = surroundings_radiance(mirrored);
        }
        radiance = mix(radiance, metal.reflectance * around, gloss.metallic);
    }
    if (EFFECT_MICROFACET) {
        if (material.alpha > 0.0f) {
            radiance += cdrf_highlights(
                input.position,
                normals,
                toward_eye,
                gloss,
                metal,  //+metal
            );
        }
    }
    if (EFFECT_COVERAGE) {
        if (coverage < cdrf_threshold(vec2u(input.clip.xy))) {
            discard;
        }
    }
    return vec4f(radiance, 1.0f);
}
