// gem_bvh: a stone of any closed shape by its exact triangles, found through a bounding volume hierarchy.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the part trace_nearest; its loop over all triangles is the comparison of Imagire, "Proxy
//   Geometry Gem Rendering", section 5.
// requires: absorption, bounds_trace, bvh_trace, dispersion, environment, fresnel, proxy_geometry
// requires: refraction, screen_trace
// parts: surroundings, bodies, lights, glints, trace_nearest, gem_shading, screen, gem_apart
//
// Draw 3 vertices per triangle, in the order of the leaves, without a vertex buffer. The nodes and
// the corners are bound in place of the mesh.

// Light passes through the stone; if off, only its surface reflects. Called for by
// KHR_materials_transmission.
override EFFECT_BVH_TRACE: bool = true;
// The root is first.
@group(2) @binding(0) var<storage, read> nodes: array<BvhTraceNode>;
// Three per triangle, counter-clockwise from outside, in the order of the leaves. w is not read.
@group(2) @binding(1) var<storage, read> corners: array<vec4f>;

struct GemVertex {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat, either) face_normal: vec3f,
    @location(2) @interpolate(flat, either) triangle: u32,  //+bvh_trace
    @location(3) @interpolate(flat, either) instance: u32,  //+instances
}

fn gem_face_normal(triangle: u32) -> vec3f {
    return proxy_geometry_face_normal(
        corners[3u * triangle].xyz,
        corners[3u * triangle + 1u].xyz,
        corners[3u * triangle + 2u].xyz,
    );
}

// A corner of a triangle of the stone.
@vertex
fn gem_vertex(
    @builtin(vertex_index) vertex: u32,
    @builtin(instance_index) instance: u32,  //+instances
) -> GemVertex {
    let position = corners[vertex].xyz;
    let triangle = vertex / 3u;
    return GemVertex(
        //-instances gem_clip(position),
        gem_clip(position, instance),  //+instances
        position,
        gem_face_normal(triangle),
        triangle,  //+bvh_trace
        instance,  //+instances
    );
}

// The place of a ray inside: the triangle that it left last, which it cannot meet again
// immediately.
struct GemPlace {
    triangle: u32,
}

fn gem_enter(input: GemVertex) -> GemPlace {
    return GemPlace(input.triangle);
}

fn gem_hit(place: ptr<function, GemPlace>, ray: GemRay) -> GemHit {
    let nearest = trace_nearest(ray.position, ray.direction, (*place).triangle, TRACE_FAR);
    if (nearest.triangle == BVH_TRACE_NONE) {
        return GemHit(ray.position, -ray.direction, 0.0f, false);
    }
    (*place).triangle = nearest.triangle;
    let normal = gem_face_normal(nearest.triangle);
    return GemHit(ray.position + nearest.distance * ray.direction, -normal, nearest.distance, true);
}

// Radiance that the stone sends to the eye, linear, with an alpha of 1.
@fragment
fn gem_fragment(input: GemVertex) -> @location(0) vec4f {
    let radiance = gem_radiance(input, EFFECT_BVH_TRACE);  //+bvh_trace
    //-bvh_trace let radiance = gem_radiance(input);
    if (EFFECT_BVH_TRACE) {
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
    return gem_geometry_buffer(input, EFFECT_BVH_TRACE);  //+bvh_trace
    //-bvh_trace return gem_geometry_buffer(input);
}
