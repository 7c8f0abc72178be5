// trace_nearest: the nearest triangle that a ray inside a closed mesh leaves through, by a hierarchy or by a loop.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the loop over nodes with a stack, as in Aila and Laine, "Understanding the Efficiency of
//   Ray Traversal on GPUs", HPG 2009; the loop over all triangles: Imagire, "Proxy Geometry Gem
//   Rendering", section 5.
// compares: bvh_trace
//
// A recipe adds: the module bvh_trace, and the bindings `nodes` and `corners`. `nodes`, array<BvhTraceNode>, has
// the root first. `corners`, array<vec4f>, has three entries per triangle, counter-clockwise from the side to
// which rays leave, in the order of the leaves; w is not read. A triangle's number is its position there. A
// corner is then one load; by way of indices a trace takes a fifth more time on lavapipe.

// Loops over all triangles instead of the hierarchy: the paper's comparison.
override TRAVERSAL_LOOP: bool = false;
// Uses Möller and Trumbore's test with an epsilon instead of the watertight test.
override TRIANGLE_NAIVE: bool = false;
// Rays also meet triangles through which they enter a solid. Where two surfaces lie in one place, a ray
// enters one solid before it leaves the other.
override TRAVERSAL_TWO_SIDED: bool = false;

// Capacity of the stack: three children for each of 16 levels of nodes. The builder of the hierarchy
// must respect this limit.
const TRACE_STACK = 48u;
// A distance farther than any hit.
const TRACE_FAR = 1e37f;
// How far ahead of its place a surface counts through which a ray enters, in margins of the ray: over the
// cosine of the angle of incidence, and at most.
const TRACE_AHEAD = 2.0f;
const TRACE_MOST_AHEAD = 64.0f;
// The first number of a child that is a leaf.
const TRACE_LEAF = 0x40000000u;

// A second triangle that a ray does not meet, and the margin of the ray.
var<private> trace_also_left: u32 = BVH_TRACE_NONE;
var<private> trace_margin: f32;

// The children that are still to be visited. Private, so that it is set to 0 once, not for each ray.
var<private> trace_stack: array<u32, TRACE_STACK>;

// Tests a triangle from the side that a ray comes from.
fn trace_either_side(
    hit: BvhTraceHit, ray: BvhTraceRay, a: vec3f, b: vec3f, c: vec3f, triangle: u32, left: u32
) -> BvhTraceHit {
    if (triangle == trace_also_left) {
        return hit;
    }
    let normal = cross(b - a, c - a);
    let along = dot(normal, ray.direction);
    if (along >= 0.0f) {
        return bvh_trace_triangle(hit, ray, a, b, c, triangle, left);
    }
    // Two surfaces in one place are met at distances that differ by the margin over the cosine.
    let ahead = ray.margin * min(TRACE_AHEAD * length(normal) / -along, TRACE_MOST_AHEAD);
    var before = hit;
    before.distance += ahead;
    let found = bvh_trace_triangle(before, ray, a, c, b, triangle, left);
    if (found.triangle != triangle) {
        return hit;
    }
    return BvhTraceHit(max(found.distance - ahead, 0.0f), found.barycentrics.yx, triangle);
}

// Tests the triangle of a given number.
fn trace_triangle(hit: BvhTraceHit, ray: BvhTraceRay, triangle: u32, left: u32) -> BvhTraceHit {
    let a = corners[3u * triangle].xyz;
    let b = corners[3u * triangle + 1u].xyz;
    let c = corners[3u * triangle + 2u].xyz;
    if (TRIANGLE_NAIVE) {
        return bvh_trace_triangle_naive(hit, ray, a, b, c, triangle, left);
    }
    if (TRAVERSAL_TWO_SIDED) {
        return trace_either_side(hit, ray, a, b, c, triangle, left);
    }
    return bvh_trace_triangle(hit, ray, a, b, c, triangle, left);
}

// A child of a node.
struct TraceChild {
    // Distance at which the ray enters its box; TRACE_FAR if the ray does not meet it.
    entry: f32,
    // As in the node.
    child: u32,
}

fn trace_child(node: BvhTraceNode, place: u32, ray: BvhTraceRay, nearest: f32) -> TraceChild {
    let extent = bvh_trace_child_box(node, place);
    let met = bvh_trace_box(ray, extent.lower, extent.upper, nearest);
    let child = node.children[place];
    return TraceChild(select(TRACE_FAR, met.entry, met.hit && child != BVH_TRACE_NONE), child);
}

fn trace_nearer(one: TraceChild, other: TraceChild) -> TraceChild {
    let second = other.entry < one.entry;
    return TraceChild(select(one.entry, other.entry, second), select(one.child, other.child, second));
}

fn trace_farther(one: TraceChild, other: TraceChild) -> TraceChild {
    let second = other.entry < one.entry;
    return TraceChild(select(other.entry, one.entry, second), select(other.child, one.child, second));
}

// Puts a child on the stack if the ray meets it, and returns the new height.
fn trace_push(height: u32, child: TraceChild) -> u32 {
    if (child.entry < TRACE_FAR) {
        trace_stack[height] = child.child;
        return height + 1u;
    }
    return height;
}

// The nearest triangle within a distance through which a ray leaves the solid, or, from both sides, enters or
// leaves one.
fn trace_nearest(origin: vec3f, direction: vec3f, left: u32, within: f32) -> BvhTraceHit {
    var hit = bvh_trace_start(within);
    let whole = bvh_trace_bounds(nodes[0]);
    let ray = bvh_trace_ray(origin, direction, whole.lower, whole.upper);
    if (TRAVERSAL_TWO_SIDED) {
        trace_margin = ray.margin;
    }
    if (TRAVERSAL_LOOP) {
        for (var triangle = 0u; triangle < arrayLength(&corners) / 3u; triangle += 1u) {
            hit = trace_triangle(hit, ray, triangle, left);
        }
        return hit;
    }
    var next = 0u;
    var height = 0u;
    // Invocations beside a triangle's edge may read zeros: a root whose children are the root. Where a
    // recipe computes rays from what it reads, they would turn in this loop for ever.
    var found = any(whole.lower < whole.upper);
    while (found) {
        // Down to a leaf. Rays that run side by side wait here for the last one, so that they test
        // boxes together and then triangles together.
        while (found && next < TRACE_LEAF) {
            let node = nodes[next];
            let a = trace_child(node, 0u, ray, hit.distance);
            let b = trace_child(node, 1u, ray, hit.distance);
            let c = trace_child(node, 2u, ray, hit.distance);
            let d = trace_child(node, 3u, ray, hit.distance);
            // The nearest child first: its hits cull the others, when their boxes are opened. Their
            // order matters less than the time that it takes to sort them, or to keep distances.
            let ab = trace_nearer(a, b);
            let cd = trace_nearer(c, d);
            height = trace_push(height, trace_farther(a, b));
            height = trace_push(height, trace_farther(c, d));
            height = trace_push(height, trace_farther(ab, cd));
            let nearest = trace_nearer(ab, cd);
            next = nearest.child;
            found = nearest.entry < TRACE_FAR;
            if (!found && height > 0u) {
                height -= 1u;
                next = trace_stack[height];
                found = true;
            }
        }
        if (found) {
            let first = next & (TRACE_LEAF - 1u);
            let end = first + (next >> 30u);
            for (var triangle = first; triangle < end; triangle += 1u) {
                hit = trace_triangle(hit, ray, triangle, left);
            }
            found = height > 0u;
            if (found) {
                height -= 1u;
                next = trace_stack[height];
            }
        }
    }
    return hit;
}
