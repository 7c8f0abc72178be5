// gem_convex: a convex stone by its exact facets: each ray inside is tested against every facet plane.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Imagire, "Proxy Geometry Gem Rendering", Fig. 7.
// requires: absorption, bounds_trace, convex_trace, dispersion, environment, fresnel
// requires: proxy_geometry, refraction, screen_trace
// parts: mesh, surroundings, bodies, lights, glints, gem_shading, screen, gem_apart
//
// Draw it like the recipe `gem`, and also bind the stone's facet planes. Each draw takes one stone,
// which must be convex.

// Light passes through the stone; if off, only its surface reflects. Called for by
// KHR_materials_transmission.
override EFFECT_CONVEX_TRACE: bool = true;

// Outward unit normal of each facet plane and its distance from the origin, in the space of
// `positions`.
@group(2) @binding(0) var<storage, read> planes: array<vec4f>;
// The number of each triangle's plane.
@group(2) @binding(1) var<storage, read> face_of_triangle: array<u32>;

struct GemVertex {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat, either) face_normal: vec3f,
    @location(2) @interpolate(flat, either) face: u32,  //+convex_trace
    @location(3) @interpolate(flat, either) instance: u32,  //+instances
}

// A corner of a triangle of the stone.
@vertex
fn gem_vertex(
    @builtin(vertex_index) vertex: u32,
    @builtin(instance_index) instance: u32,  //+instances
) -> GemVertex {
    let position = mesh_position(indices[vertex]);
    let face = face_of_triangle[vertex / 3u];
    return GemVertex(
        //-instances gem_clip(position),
        gem_clip(position, instance),  //+instances
        position,
        planes[face].xyz,
        face,  //+convex_trace
        instance,  //+instances
    );
}

// The place of a ray inside: the facet that it left last, which it cannot meet again immediately.
struct GemPlace {
    face: u32,
}

fn gem_enter(input: GemVertex) -> GemPlace {
    return GemPlace(input.face);
}

fn gem_hit(place: ptr<function, GemPlace>, ray: GemRay) -> GemHit {
    var nearest = convex_trace_start(CONVEX_TRACE_FAR);
    let count = arrayLength(&planes);
    for (var face = 0u; face < count; face++) {
        nearest = convex_trace_step(nearest, ray.position, ray.direction, planes[face], face, (*place).face);
    }
    if (nearest.face >= count) {
        return GemHit(ray.position, -ray.direction, 0.0f, false);
    }
    (*place).face = nearest.face;
    let plane = planes[nearest.face];
    return GemHit(
        convex_trace_point(ray.position, ray.direction, nearest.distance, plane),
        -plane.xyz,
        nearest.distance,
        true
    );
}

// Radiance that the stone sends to the eye, linear, with an alpha of 1.
@fragment
fn gem_fragment(input: GemVertex) -> @location(0) vec4f {
    let radiance = gem_radiance(input, EFFECT_CONVEX_TRACE);  //+convex_trace
    //-convex_trace let radiance = gem_radiance(input);
    if (EFFECT_CONVEX_TRACE) {
        return vec4f(radiance.surface + radiance.inside, 1.0f);
    }
    if (EFFECT_THIN_WALL) {
        return vec4f(radiance.surface + radiance.inside, 1.0f);
    }
    return vec4f(radiance.surface, 1.0f);
}

// For a deferred renderer, in place of gem_fragment; gem_composite shows how the lighting pass uses
// it.
@fragment
fn gem_deferred_fragment(input: GemVertex) -> GemGeometryBuffer {
    return gem_geometry_buffer(input, EFFECT_CONVEX_TRACE);  //+convex_trace
    //-convex_trace return gem_geometry_buffer(input);
}
