// optical_path_shading: translucent stone: light that comes along the cheapest way through the body, in one draw call.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Ozawa, Okamoto and Morishima, "Real-time rendering of translucent material using Dynamic
//   Programming", section 3.2.
// requires: environment, cdrf, fresnel, half_space, microfacet, optical_path, reflective_shadow_map, voxelization
// parts: mesh, mesh_normals, surroundings, lights, light_views, shadow, harmonics, reflection, scattering_law
//
// Draw 3 vertices per triangle without a vertex buffer, in world space, after the recipes
// voxelize, draw_light_map, optical_path_seed and a solver have filled the costs.

// Light through the body. If off, only light that falls on the surface itself is reflected
// diffusely. Called for by extras.lapidary.scattering and absorption.
override EFFECT_OPTICAL_PATH: bool = true;
// Separate costs for red, green and blue. If off, the first serves all three. Called for by an
// extinction or a light that is not grey.
override EFFECT_COLOR: bool = true;
// The extinction varies from voxel to voxel. Called for by extras.lapidary.veins, or by a grid of
// densities.
override EFFECT_EXTINCTION_PER_VOXEL: bool = false;
// Diffuse light from all around, in addition to the lights. It does not travel through the body.
// Called for by an environment.
override EFFECT_ENVIRONMENT: bool = true;

struct OpticalPathView {
    clip_from_world: mat4x4f,
    eye: vec3f,
}

struct OpticalPathBody {
    grid: VoxelizationGrid,
    // The surface's diffuse reflectance, linear RGB.
    base_color: vec3f,
    // Index of refraction, relative to the medium outside.
    index: f32,
    // Extinction per unit of length where the density is 1, including the scale.
    extinction: vec3f,
    // Width of the distribution of microfacet slopes, the square of the roughness; 0 for a polished
    // surface.
    alpha: f32,
    // The irradiance whose cost is 0, for each channel.
    largest: vec3f,
    law: ScatteringLaw,
}

@group(0) @binding(0) var<uniform> view: OpticalPathView;
// Bindings 1 to 5 belong to the parts.
// The body is not a uniform because lavapipe compiles the shader anew for each uniform buffer that
// it is drawn with, which takes megabytes for every body.
@group(1) @binding(0) var<storage, read> body: OpticalPathBody;
// Three floats per vertex.
@group(1) @binding(1) var<storage, read> positions: array<f32>;
@group(1) @binding(2) var<storage, read> indices: array<u32>;
@group(1) @binding(3) var<storage, read> normals: array<f32>;
@group(1) @binding(4) var<storage, read> costs_red: array<u32>;
@group(1) @binding(5) var<storage, read> costs_green: array<u32>;
@group(1) @binding(6) var<storage, read> costs_blue: array<u32>;
@group(1) @binding(7) var<storage, read> density: array<f32>;

struct OpticalPathVertex {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
}

@vertex
fn optical_path_vertex(@builtin(vertex_index) vertex: u32) -> OpticalPathVertex {
    let index = indices[vertex];
    let position = mesh_position(index);
    return OpticalPathVertex(view.clip_from_world * vec4f(position, 1.0f), position, mesh_normal(index));
}

// The density at a point, interpolated linearly between voxel centres.
fn optical_path_density(position: vec3f) -> f32 {
    let place = (position - body.grid.origin) / body.grid.spacing - 0.5f;
    let inside = clamp(place, vec3f(0.0f), vec3f(f32(body.grid.cells - 1u)));
    let lower = vec3u(inside);
    let upper = min(lower + 1u, vec3u(body.grid.cells - 1u));
    let weight = inside - vec3f(lower);
    var near = vec2f(0.0f);
    for (var layer = 0u; layer < 2u; layer++) {
        let z = select(lower.z, upper.z, layer == 1u);
        let below = mix(
            density[voxelization_index(body.grid, vec3u(lower.xy, z))],
            density[voxelization_index(body.grid, vec3u(upper.x, lower.y, z))],
            weight.x,
        );
        let above = mix(
            density[voxelization_index(body.grid, vec3u(lower.x, upper.y, z))],
            density[voxelization_index(body.grid, vec3u(upper.xy, z))],
            weight.x,
        );
        near[layer] = mix(below, above, weight.y);
    }
    return mix(near.x, near.y, weight.z);
}

// The share of the largest irradiance that reaches a point along the cheapest path through the 27
// voxels around it.
fn optical_path_along(position: vec3f) -> vec3f {
    let around = vec3i(voxelization_voxel(body.grid, position));
    let last = i32(body.grid.cells) - 1i;
    //+extinction_per_voxel {
    var own = 1.0f;
    if (EFFECT_EXTINCTION_PER_VOXEL) {
        own = optical_path_density(position);
    }
    //+extinction_per_voxel }
    var least = vec3f(OPTICAL_PATH_UNREACHED);
    for (var neighbour = 0i; neighbour < 27i; neighbour++) {
        let step = vec3i(neighbour % 3i, (neighbour / 3i) % 3i, neighbour / 9i) - 1i;
        let voxel = vec3u(clamp(around + step, vec3i(0i), vec3i(last)));
        let index = voxelization_index(body.grid, voxel);
        let offset = distance(position, voxelization_centre(body.grid, voxel));
        var extinction = body.extinction;
        if (EFFECT_EXTINCTION_PER_VOXEL) {
            extinction *= 0.5f * (own + density[index]);
        }
        least.x = min(least.x, optical_path_through(optical_path_decode(costs_red[index]), extinction.x, offset));
        if (EFFECT_COLOR) {
            least.y = min(least.y, optical_path_through(optical_path_decode(costs_green[index]), extinction.y, offset));
            least.z = min(least.z, optical_path_through(optical_path_decode(costs_blue[index]), extinction.z, offset));
        }
    }
    let red = optical_path_luminance(least.x);
    if (!EFFECT_COLOR) {  //+color
        return vec3f(red);
    }  //+color
    return vec3f(red, optical_path_luminance(least.y), optical_path_luminance(least.z));  //+color
}

@fragment
fn optical_path_fragment(input: OpticalPathVertex) -> @location(0) vec4f {
    let toward_eye = normalize(view.eye - input.position);
    let squared = dot(input.normal, input.normal);
    let normal = select(toward_eye, input.normal * inverseSqrt(max(squared, 1e-12f)), squared > 1e-12f);
    let cosine_eye = mesh_cosine_to_eye(normal, toward_eye, dpdx(input.position), dpdy(input.position));  //+half_space

    var received = vec3f(0.0f);
    var highlights = vec3f(0.0f);  //+microfacet
    // The views of a light are consecutive. At a seam between two views both see the point, but it
    // counts once.
    var counted = arrayLength(&lights);
    for (var layer = 0u; layer < arrayLength(&views); layer++) {
        let light = views[layer].light;
        let arrival = light_arrival(lights[light], input.position);
        let cosine = reflective_shadow_map_cosine(normal, arrival.direction);
        if (cosine > 0.0f && light != counted) {
            let lit = shadow_in_view(layer, input.position, normal);
            if (lit < 0.0f) {
                continue;
            }
            counted = light;
            var part = lit * cosine * arrival.irradiance;
            if (EFFECT_HALF_SPACE) {
                part *= scattering_law_of_light(cosine_eye, vec3f(cosine), body.law);
            }
            received += part;
            if (EFFECT_MICROFACET) {
                highlights += lit * reflection_highlight(arrival, normal, toward_eye, body.index, body.alpha);
            }
        }
    }
    if (EFFECT_OPTICAL_PATH) {
        var along = body.largest * optical_path_along(input.position);
        if (EFFECT_HALF_SPACE) {
            along *= scattering_law_inside(cosine_eye, body.law);
        }
        // Light that falls on the point itself takes one of the paths, of length 0.
        received = max(received, along);
    }
    if (EFFECT_ENVIRONMENT) {
        let weights = cdrf_harmonic_weights(0.0f);
        var irradiance = harmonics_irradiance(harmonics_around(normal), weights, weights, weights);
        if (EFFECT_HALF_SPACE) {
            irradiance *= scattering_law_around(cosine_eye, body.law);
        }
        received += irradiance;
    }
    let inside = 0.31830987f * body.base_color * received;
    var radiance = inside;
    if (EFFECT_REFLECTION) {
        radiance = reflection_over(inside, normal, toward_eye, body.index, body.alpha);
    }
    if (EFFECT_MICROFACET) {
        if (body.alpha > 0.0f) {
            radiance += highlights;
        }
    }
    return vec4f(radiance, 1.0f);
}
