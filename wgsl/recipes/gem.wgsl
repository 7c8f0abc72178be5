// gem: a transparent stone by proxy geometry, one internal hit a pixel, in one draw call.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Imagire, "Proxy Geometry Gem Rendering", section 4.
// requires: closest_point, environment, fresnel, proxy_geometry, refraction
//
// Draw 3 vertices per triangle without a vertex buffer: the soft-edged mesh itself is read from storage buffers, so that
// each vertex sees its whole triangle and the proxy needs no further data and no further pass.

// Light through the stone; off, only its surface reflects (the paper's Fig. 2). Called for by KHR_materials_transmission.
override EFFECT_PROXY_GEOMETRY: bool = true;
// An image as the environment instead of the procedural studio. Called for by the user, who has one.
override EFFECT_ENVIRONMENT_MAP: bool = false;
// The proxy's centre by the paper's eq. (4) instead of the stable form.
override CENTRE_PAPER: bool = false;

struct GemView {
    clip_from_world: mat4x4f,
    eye: vec3f,
}

struct GemMaterial {
    // Linear RGB that light through the stone is multiplied by.
    base_color: vec3f,
    // Index of refraction, relative to the medium outside.
    index: f32,
}

@group(0) @binding(0) var<uniform> view: GemView;
@group(0) @binding(1) var environment_map: texture_2d<f32>;
@group(1) @binding(0) var<uniform> material: GemMaterial;
// Three floats a vertex, in world space; normals shared by the facets that meet there, averaged by angle.
@group(1) @binding(1) var<storage, read> positions: array<f32>;
@group(1) @binding(2) var<storage, read> normals: array<f32>;
@group(1) @binding(3) var<storage, read> indices: array<u32>;

struct GemVertex {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    // The rest is one value a triangle.
    @location(1) @interpolate(flat, either) face_normal: vec3f,
    @location(2) @interpolate(flat, either) centre: vec3f,
    @location(3) @interpolate(flat, either) plane_origin: vec3f,
    @location(4) @interpolate(flat, either) edge_first: vec3f,
    @location(5) @interpolate(flat, either) edge_second: vec3f,
}

fn gem_position(index: u32) -> vec3f {
    return vec3f(positions[3u * index], positions[3u * index + 1u], positions[3u * index + 2u]);
}

fn gem_normal(index: u32) -> vec3f {
    return vec3f(normals[3u * index], normals[3u * index + 1u], normals[3u * index + 2u]);
}

// The proxy's centre, from the three vertex normals.
fn gem_centre(a: u32, b: u32, c: u32) -> vec3f {
    let position_a = gem_position(a);
    let position_b = gem_position(b);
    let position_c = gem_position(c);
    if (CENTRE_PAPER) {
        return closest_point_centre_paper(position_a, gem_normal(a), position_b, gem_normal(b), position_c, gem_normal(c));
    }
    return closest_point_centre(position_a, gem_normal(a), position_b, gem_normal(b), position_c, gem_normal(c));
}

@vertex
fn gem_vertex(@builtin(vertex_index) vertex: u32) -> GemVertex {
    let first = vertex - vertex % 3u;
    let position_a = gem_position(indices[first]);
    let position_b = gem_position(indices[first + 1u]);
    let position_c = gem_position(indices[first + 2u]);
    let position = gem_position(indices[vertex]);
    let face_normal = proxy_geometry_face_normal(position_a, position_b, position_c);
    var centre = position_a;
    if (EFFECT_PROXY_GEOMETRY) {
        centre = gem_centre(indices[first], indices[first + 1u], indices[first + 2u]);
        // Where normals spread inwards, at a dent, the lines meet outside. Such a triangle takes the fallback.
        if (dot(face_normal, position_a - centre) <= 0.0f) {
            centre = closest_point_fallback(position_a, position_b, position_c);
        }
    }
    let plane = proxy_geometry_plane(centre, position_a, position_b, position_c);
    return GemVertex(view.clip_from_world * vec4f(position, 1.0f), position, face_normal, centre, plane.origin, plane.edge_first, plane.edge_second);
}

// Radiance that arrives from a direction.
fn gem_environment(direction: vec3f) -> vec3f {
    if (EFFECT_ENVIRONMENT_MAP) {
        // Filtered by hand: 32-bit float textures need not be filterable.
        let texels = environment_texels(environment_uv_from_direction(direction), textureDimensions(environment_map));
        let lower_left = textureLoad(environment_map, texels.lower, 0).rgb;
        let lower_right = textureLoad(environment_map, vec2u(texels.upper.x, texels.lower.y), 0).rgb;
        let upper_left = textureLoad(environment_map, vec2u(texels.lower.x, texels.upper.y), 0).rgb;
        let upper_right = textureLoad(environment_map, texels.upper, 0).rgb;
        let lower = mix(lower_left, lower_right, texels.weight.x);
        let upper = mix(upper_left, upper_right, texels.weight.x);
        return mix(lower, upper, texels.weight.y);
    }
    return environment_studio(direction);
}

// Radiance that a ray inside the stone brings, once it has met one facet: what is refracted there comes from the environment;
// what is reflected there, all of it under total internal reflection, would travel on, and is taken from the environment along
// the reflected ray instead. That is wrong, and what this rung saves.
fn gem_internal(direction: vec3f, facet_normal: vec3f) -> vec3f {
    let leaving = refraction_refract(direction, facet_normal, 1.0f / material.index);
    let reflected = gem_environment(refraction_reflect(direction, facet_normal));
    if (leaving.total) {
        return reflected;
    }
    let reflectance = fresnel_dielectric(-dot(facet_normal, direction), 1.0f / material.index);
    return mix(gem_environment(leaving.direction), reflected, reflectance);
}

@fragment
fn gem_fragment(input: GemVertex) -> @location(0) vec4f {
    let direction = normalize(input.position - view.eye);
    let normal = input.face_normal;
    let reflectance = fresnel_dielectric(clamp(-dot(normal, direction), 0.0f, 1.0f), material.index);
    var radiance = reflectance * gem_environment(refraction_reflect(direction, normal));
    if (EFFECT_PROXY_GEOMETRY) {
        let entering = refraction_refract(direction, normal, material.index);
        let hit = proxy_geometry_intersect(input.position, entering.direction, input.plane_origin, normal);
        // A miss cannot happen on entry into a denser stone; without a facet the ray would leave as it came in.
        var internal = gem_environment(direction);
        if (hit.hit) {
            let plane = ProxyGeometryPlane(input.plane_origin, input.edge_first, input.edge_second);
            let coordinates = proxy_geometry_coordinates(hit.point, plane.origin, plane.edge_first, plane.edge_second);
            let facet = proxy_geometry_facet(plane, proxy_geometry_cell(coordinates));
            let facet_normal = proxy_geometry_facet_normal(input.centre, facet.vertex_first, facet.vertex_second, facet.vertex_third, entering.direction);
            internal = gem_internal(entering.direction, facet_normal);
        }
        radiance += (1.0f - reflectance) * material.base_color * internal;
    }
    return vec4f(radiance, 1.0f);
}
