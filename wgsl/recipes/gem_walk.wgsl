// gem_walk: a convex stone by its exact facets: each ray finds its next facet in a few steps over a map of them.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the module convex_walk.
// requires: absorption, bounds_trace, bvh_trace, convex_trace, convex_walk, dispersion, environment, fresnel
// requires: microfacet, proxy_geometry, ray_footprint, refraction, screen_trace, split_sum
// parts: mesh, surroundings, bodies, beside, trace_nearest, metal, lights, glints, gem_shading, screen
//
// Draw it like the recipe `gem`, and also bind the stone's facet planes and their map, made once for
// a cut (FacetMap in the crate of convex_walk). Each draw takes one stone, which must be convex.

// Light passes through the stone; if off, only its surface reflects. Called for by
// KHR_materials_transmission.
override EFFECT_CONVEX_TRACE: bool = true;
// Facets' edges inside are smoothed from one sample per pixel: gem_footprint_fragment also writes
// shares of the four neighbours, with which gem_resolve mixes them. Not with DISPERSION_FORM 2, whose
// rays have edges of their own. Called for by the user.
override EFFECT_FOOTPRINT: bool = false;

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
// The stone's place.
@group(2) @binding(3) var<storage, read> stone: GemStone;

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

// The place of a ray inside: the facet that it left last, which it cannot meet again immediately,
// and the point where it did, about the centre.
struct GemPlace {
    face: u32,
    position: vec3f,
}

fn gem_enter(input: GemVertex) -> GemPlace {
    return GemPlace(input.face, input.position - stone.centre);
}

//+convex_trace,footprint {
// A pixel's footprint on its ray, and what it has found of edges.
struct GemFootprint {
    // Change of the point on the ray from this pixel to the next, to the right and down.
    right: vec3f,
    down: vec3f,
    // Distance of the eye from the facet that it sees.
    distance: f32,
    // Shares of the neighbours to the right, left, below and above, and the pixel's own.
    neighbours: vec4f,
    own: f32,
    // The plane that the ray would meet next.
    runner_up: ConvexTraceHit,
}

var<private> gem_footprint: GemFootprint;

// Derivatives need uniform control flow: before anything else in the fragment stage.
fn gem_footprint_start(input: GemVertex) {
    let far = convex_trace_start(CONVEX_TRACE_FAR);
    let away = distance(input.position, gem_eye(input));
    gem_footprint = GemFootprint(dpdx(input.position), dpdy(input.position), away, vec4f(0.0f), 1.0f, far);
    // The edges of the facet that the eye sees are those to the candidates of its cell.
    let point = input.position - stone.centre;
    var cell = gem_cell(point);
    for (var step = 0u; step < CONVEX_WALK_STEPS; step++) {
        let word = facet_map[cell];
        let more = word >= CONVEX_WALK_MORE;
        let rest = (word >> CONVEX_WALK_SHIFT) & CONVEX_WALK_PLACE;
        let first = word & CONVEX_WALK_FACE;
        gem_footprint_front(input.face, point, first);
        if (!more) {
            if (rest != first) {
                gem_footprint_front(input.face, point, rest);
            }
            break;
        }
        cell = rest;
    }
}

// The edge between the facet that the eye sees and another. The depth of a point of the one below the
// plane of the other is linear in the pixel.
fn gem_footprint_front(seen: u32, point: vec3f, face: u32) {
    if (face != seen) {
        let plane = planes[face];
        let depth = max(plane.w - dot(plane.xyz, point), 0.0f);
        gem_footprint_add(vec3f(depth, dot(plane.xyz, gem_footprint.right), dot(plane.xyz, gem_footprint.down)), 1.0f);
    }
}

fn gem_footprint_add(edge: vec3f, seen: f32) {
    let share = gem_footprint.own * seen * ray_footprint_share(edge);
    if (share > 0.0f) {
        gem_footprint.neighbours += ray_footprint_neighbours(edge, share);
        gem_footprint.own -= share;
    }
}

// Updates the runner-up with one plane, before the walk tests it.
fn gem_footprint_test(nearest: ConvexTraceHit, start: vec3f, direction: vec3f, face: u32, left: u32) {
    let hit = convex_trace_step(convex_trace_start(CONVEX_TRACE_FAR), start, direction, planes[face], face, left);
    gem_footprint.runner_up = convex_trace_runner_up(nearest, gem_footprint.runner_up, hit);
}

// Counts the edge between the plane that a ray meets and the runner-up.
fn gem_footprint_hit(ray: GemRay, nearest: ConvexTraceHit) {
    let runner_up = gem_footprint.runner_up;
    gem_footprint.runner_up = convex_trace_start(CONVEX_TRACE_FAR);
    if (!ray.followed || nearest.face == CONVEX_TRACE_NONE) {
        return;
    }
    let normal = planes[nearest.face].xyz;
    if (runner_up.face != CONVEX_TRACE_NONE) {
        let gap = runner_up.distance - nearest.distance;
        let edge = ray_footprint_edge(
            ray.direction, gem_footprint.right, gem_footprint.down, normal, planes[runner_up.face].xyz, gap
        );
        let growth = ray_footprint_growth(gem_footprint.distance, ray.travelled + nearest.distance, material.index);
        // What the pixel has gathered before the edge is its own: only the light still to come counts.
        let to_come = max(max(ray.throughput.r, ray.throughput.g), ray.throughput.b);
        gem_footprint_add(vec3f(edge.x, growth * edge.yz), to_come);
    }
    gem_footprint.right = refraction_reflect(gem_footprint.right, normal);
    gem_footprint.down = refraction_reflect(gem_footprint.down, normal);
}
//+convex_trace,footprint }

// Walks from a point that is not inside the stone, the hit so far, to the facet that the ray meets.
fn gem_walk(so_far: ConvexTraceHit, start: vec3f, direction: vec3f, left: u32) -> ConvexTraceHit {
    var nearest = so_far;
    var before = nearest.face;
    var cell = gem_cell(start + nearest.distance * direction);
    for (var step = 0u; step < CONVEX_WALK_STEPS; step++) {
        let word = facet_map[cell];
        let more = word >= CONVEX_WALK_MORE;
        let rest = (word >> CONVEX_WALK_SHIFT) & CONVEX_WALK_PLACE;
        let first = word & CONVEX_WALK_FACE;
        let second = select(rest, first, more);
        if (EFFECT_FOOTPRINT) {
            gem_footprint_test(nearest, start, direction, first, left);
        }
        nearest = convex_trace_step(nearest, start, direction, planes[first], first, left);
        if (EFFECT_FOOTPRINT) {
            gem_footprint_test(nearest, start, direction, second, left);
        }
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
fn gem_met(place: ptr<function, GemPlace>, ray: GemRay, nearest: ConvexTraceHit) -> GemHit {
    if (nearest.face == CONVEX_TRACE_NONE) {
        return GemHit(ray.position, -ray.direction, 0.0f, false);
    }
    let plane = planes[nearest.face];
    *place = GemPlace(nearest.face, convex_trace_point((*place).position, ray.direction, nearest.distance, plane));
    return GemHit((*place).position + stone.centre, -plane.xyz, nearest.distance, true);
}

fn gem_hit(place: ptr<function, GemPlace>, ray: GemRay) -> GemHit {
    let start = (*place).position;
    let beyond = convex_trace_start(convex_walk_exit(start, ray.direction, stone.lower, stone.upper));
    let nearest = gem_walk(beyond, start, ray.direction, (*place).face);
    if (EFFECT_FOOTPRINT) {
        gem_footprint_hit(ray, nearest);
    }
    return gem_met(place, ray, nearest);
}

// The walk of the first ray, whose candidates the second ray is tested against as well. As long as
// both come from one facet and meet one facet, that is all; otherwise the second ray walks on by
// itself, from the nearest of them. A facet that is no candidate of the first ray may then be missed
// while the rays are together: a sliver between two edges.
fn gem_hit_both(
    place: ptr<function, GemPlace>, ray: GemRay, place_other: ptr<function, GemPlace>, other: GemRay
) -> GemHits {
    let start = (*place).position;
    let left = (*place).face;
    let start_other = (*place_other).position;
    let left_other = (*place_other).face;
    var nearest = convex_trace_start(convex_walk_exit(start, ray.direction, stone.lower, stone.upper));
    var nearest_other = convex_trace_start(CONVEX_TRACE_FAR);
    var before = nearest.face;
    var cell = gem_cell(start + nearest.distance * ray.direction);
    for (var step = 0u; step < CONVEX_WALK_STEPS; step++) {
        let word = facet_map[cell];
        let more = word >= CONVEX_WALK_MORE;
        let rest = (word >> CONVEX_WALK_SHIFT) & CONVEX_WALK_PLACE;
        let first = word & CONVEX_WALK_FACE;
        let second = select(rest, first, more);
        if (EFFECT_FOOTPRINT) {
            gem_footprint_test(nearest, start, ray.direction, first, left);
        }
        nearest = convex_trace_step(nearest, start, ray.direction, planes[first], first, left);
        if (EFFECT_FOOTPRINT) {
            gem_footprint_test(nearest, start, ray.direction, second, left);
        }
        nearest = convex_trace_step(nearest, start, ray.direction, planes[second], second, left);
        nearest_other = convex_trace_step(
            nearest_other, start_other, other.direction, planes[first], first, left_other
        );
        nearest_other = convex_trace_step(
            nearest_other, start_other, other.direction, planes[second], second, left_other
        );
        if (more) {
            cell = rest;
        } else {
            if (nearest.face == before) {
                break;
            }
            before = nearest.face;
            cell = gem_cell(start + nearest.distance * ray.direction);
        }
    }
    if (EFFECT_FOOTPRINT) {
        // The first ray stands for both.
        gem_footprint_hit(ray, nearest);
    }
    if (nearest_other.face != nearest.face || left_other != left) {
        nearest_other = gem_walk(nearest_other, start_other, other.direction, left_other);
        if (EFFECT_FOOTPRINT) {
            gem_footprint.runner_up = convex_trace_start(CONVEX_TRACE_FAR);
        }
    }
    return GemHits(gem_met(place, ray, nearest), gem_met(place_other, other, nearest_other));
}

fn gem_seen(input: GemVertex) -> vec4f {
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

// Radiance that the stone sends to the eye, linear, with an alpha of 1.
@fragment
fn gem_fragment(input: GemVertex) -> @location(0) vec4f {
    return gem_seen(input);
}

// The picture and, for gem_resolve, each pixel's shares of its neighbours.
struct GemFootprintTargets {
    @location(0) radiance: vec4f,
    // Of the neighbours to the right, left, below and above; eight bits suffice.
    @location(1) neighbours: vec4f,
}

// In place of gem_fragment, for a second pass by gem_resolve. Draw without blending, after all bodies
// behind or before the stones; `neighbours` is cleared to 0.
@fragment
fn gem_footprint_fragment(input: GemVertex) -> GemFootprintTargets {
    var neighbours = vec4f(0.0f);
    if (EFFECT_FOOTPRINT) {
        if (EFFECT_CONVEX_TRACE) {
            gem_footprint_start(input);
        }
    }
    let radiance = gem_seen(input);
    if (EFFECT_FOOTPRINT) {
        if (EFFECT_CONVEX_TRACE) {
            neighbours = gem_footprint.neighbours;
        }
    }
    return GemFootprintTargets(radiance, neighbours);
}

// For a deferred renderer, in place of gem_fragment; gem_composite shows how the lighting pass uses
// it.
@fragment
fn gem_deferred_fragment(input: GemVertex) -> GemGeometryBuffer {
    return gem_geometry_buffer(input, EFFECT_CONVEX_TRACE);  //+convex_trace
    //-convex_trace return gem_geometry_buffer(input);
}
