// gem_walk: a convex stone by its exact facets: each ray inside finds its next facet in a few steps over a map of the facets by direction.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the module convex_walk.
// requires: absorption, convex_trace, convex_walk, dispersion, environment, fresnel, proxy_geometry, refraction
// parts: mesh, surroundings, gem_shading
//
// Draw it like the recipe `gem`, and also bind the stone's facet planes and their map, made once for
// a cut (FacetMap in the crate of convex_walk). Each draw takes one stone, which must be convex.

// Light passes through the stone; if off, only its surface reflects. Called for by
// KHR_materials_transmission.
override EFFECT_CONVEX_TRACE: bool = true;

// The stone's place and a box around it.
struct GemStone {
    // A point well inside the stone, in the space of `positions`: the origin of the planes, the map
    // and the box.
    centre: vec3f,
    // Cells along each side of the map.
    side: u32,
    // Corners of the box, about the centre.
    lower: vec3f,
    upper: vec3f,
}

// Outward unit normal of each facet plane and its distance from the stone's centre.
@group(2) @binding(0) var<storage, read> planes: array<vec4f>;
// The number of each triangle's plane.
@group(2) @binding(1) var<storage, read> face_of_triangle: array<u32>;
// The cells' words and, behind them, further ones of cells with more than two candidates.
@group(2) @binding(2) var<storage, read> facet_map: array<u32>;
@group(2) @binding(3) var<storage, read> stone: GemStone;

struct GemVertex {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat, either) face_normal: vec3f,
    @location(2) @interpolate(flat, either) face: u32,  //+convex_trace
    @location(3) @interpolate(flat, either) instance: u32,  //+instances
}

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

// The place of a ray inside: the facet that it left last, which it cannot meet again immediately,
// and the point where it did, about the centre.
struct GemPlace {
    face: u32,
    position: vec3f,
}

fn gem_enter(input: GemVertex) -> GemPlace {
    return GemPlace(input.face, input.position - stone.centre);
}

// Walks from a point that is not inside the stone, the hit so far, to the facet that the ray meets.
fn gem_walk(so_far: ConvexTraceHit, first_cell: u32, start: vec3f, direction: vec3f, left: u32) -> ConvexTraceHit {
    var nearest = so_far;
    var before = nearest.face;
    var cell = first_cell;
    for (var step = 0u; step < CONVEX_WALK_STEPS; step++) {
        let word = facet_map[cell];
        let more = word >= CONVEX_WALK_MORE;
        let rest = (word >> CONVEX_WALK_SHIFT) & CONVEX_WALK_PLACE;
        let first = word & CONVEX_WALK_FACE;
        let second = select(rest, first, more);
        nearest = convex_trace_step(nearest, start, direction, planes[first], first, left);
        nearest = convex_trace_step(nearest, start, direction, planes[second], second, left);
        if (more) {
            cell = rest;
        } else {
            if (nearest.face == before) {
                break;
            }
            before = nearest.face;
            cell = gem_cell(start + nearest.distance * direction);
        }
    }
    return nearest;
}

fn gem_cell(point: vec3f) -> u32 {
    return convex_walk_cell(convex_walk_square(point), stone.side);
}

// Moves a ray's place to the facet that it meets.
fn gem_met(place: ptr<function, GemPlace>, position: vec3f, direction: vec3f, nearest: ConvexTraceHit) -> GemHit {
    if (nearest.face == CONVEX_TRACE_NONE) {
        return GemHit(position, -direction, 0.0f, false);
    }
    let plane = planes[nearest.face];
    *place = GemPlace(nearest.face, convex_trace_point((*place).position, direction, nearest.distance, plane));
    return GemHit((*place).position + stone.centre, -plane.xyz, nearest.distance, true);
}

fn gem_hit(place: ptr<function, GemPlace>, position: vec3f, direction: vec3f) -> GemHit {
    let start = (*place).position;
    let beyond = convex_trace_start(convex_walk_exit(start, direction, stone.lower, stone.upper));
    let cell = gem_cell(start + beyond.distance * direction);
    return gem_met(place, position, direction, gem_walk(beyond, cell, start, direction, (*place).face));
}

// The walk of the first ray, whose candidates the second ray is tested against as well. If that finds
// another facet for it, it walks on from there by itself. It may then have missed a facet that is
// met by neither ray's candidates: a sliver between two edges.
fn gem_hit_both(
    place: ptr<function, GemPlace>,
    position: vec3f,
    direction: vec3f,
    place_other: ptr<function, GemPlace>,
    position_other: vec3f,
    direction_other: vec3f,
) -> GemHits {
    let start = (*place).position;
    let left = (*place).face;
    let start_other = (*place_other).position;
    let left_other = (*place_other).face;
    var nearest = convex_trace_start(convex_walk_exit(start, direction, stone.lower, stone.upper));
    var other = convex_trace_start(CONVEX_TRACE_FAR);
    var before = nearest.face;
    var cell = gem_cell(start + nearest.distance * direction);
    for (var step = 0u; step < CONVEX_WALK_STEPS; step++) {
        let word = facet_map[cell];
        let more = word >= CONVEX_WALK_MORE;
        let rest = (word >> CONVEX_WALK_SHIFT) & CONVEX_WALK_PLACE;
        let first = word & CONVEX_WALK_FACE;
        let second = select(rest, first, more);
        nearest = convex_trace_step(nearest, start, direction, planes[first], first, left);
        nearest = convex_trace_step(nearest, start, direction, planes[second], second, left);
        other = convex_trace_step(other, start_other, direction_other, planes[first], first, left_other);
        other = convex_trace_step(other, start_other, direction_other, planes[second], second, left_other);
        if (more) {
            cell = rest;
        } else {
            if (nearest.face == before) {
                break;
            }
            before = nearest.face;
            cell = gem_cell(start + nearest.distance * direction);
        }
    }
    if (other.face != nearest.face) {
        let point = start_other + other.distance * direction_other;
        other = gem_walk(other, gem_cell(point), start_other, direction_other, left_other);
    }
    return GemHits(gem_met(place, position, direction, nearest), gem_met(place_other, position_other, direction_other, other));
}

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
