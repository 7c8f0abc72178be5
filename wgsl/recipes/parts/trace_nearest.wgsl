// trace_nearest: the nearest triangle that a ray inside a closed mesh leaves through, by a hierarchy or by a loop.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the loop over nodes with a stack, as in Aila and Laine, "Understanding the Efficiency of
//   Ray Traversal on GPUs", HPG 2009; the loop over all triangles: Imagire, "Proxy Geometry Gem
//   Rendering", section 5.
// compares: bvh_trace
//
// A recipe adds: the module bvh_trace, the part mesh, and the bindings `nodes` and `indices`.
// `nodes`, array<BvhTraceNode>, has the root first and the two children of a node side by side.
// `indices`, array<u32>, has three entries per triangle, counter-clockwise from outside, in the
// order of the leaves. A triangle's number is its position there.

// Loops over all triangles instead of the hierarchy: the paper's comparison.
override TRAVERSAL_LOOP: bool = false;
// Uses Möller and Trumbore's test with an epsilon instead of the watertight test.
override TRIANGLE_NAIVE: bool = false;

// The largest number of nodes between the root and a leaf. The builder of the hierarchy must
// respect this limit.
const TRACE_DEPTH = 32u;
// A distance farther than any hit.
const TRACE_FAR = 1e37f;

// Tests the triangle of a given number.
fn trace_triangle(hit: BvhTraceHit, ray: BvhTraceRay, triangle: u32, left: u32) -> BvhTraceHit {
    let a = mesh_position(indices[3u * triangle]);
    let b = mesh_position(indices[3u * triangle + 1u]);
    let c = mesh_position(indices[3u * triangle + 2u]);
    if (TRIANGLE_NAIVE) {
        return bvh_trace_triangle_naive(hit, ray, a, b, c, triangle, left);
    }
    return bvh_trace_triangle(hit, ray, a, b, c, triangle, left);
}

// The nearest triangle through which a ray leaves the solid.
fn trace_nearest(origin: vec3f, direction: vec3f, left: u32) -> BvhTraceHit {
    var hit = bvh_trace_start(TRACE_FAR);
    let ray = bvh_trace_ray(origin, direction, nodes[0].lower, nodes[0].upper);
    if (TRAVERSAL_LOOP) {
        for (var triangle = 0u; triangle < arrayLength(&indices) / 3u; triangle += 1u) {
            hit = trace_triangle(hit, ray, triangle, left);
        }
        return hit;
    }
    // The farther children, and the distances at which the ray enters them.
    var stack: array<u32, TRACE_DEPTH>;
    var entries: array<f32, TRACE_DEPTH>;
    var depth = 0u;
    var first = nodes[0].first;
    var count = nodes[0].count;
    var found = true;
    while (found) {
        // Down to a leaf. Rays that run side by side wait here for the last one, so that they test
        // boxes together and then triangles together.
        while (found && count == 0u) {
            let box_one = bvh_trace_box(ray, nodes[first].lower, nodes[first].upper, hit.distance);
            let box_other = bvh_trace_box(ray, nodes[first + 1u].lower, nodes[first + 1u].upper, hit.distance);
            // The nearer child first: its hits cull the farther child.
            let other_first = box_other.hit && (!box_one.hit || box_other.entry < box_one.entry);
            var node = select(first, first + 1u, other_first);
            if (box_one.hit && box_other.hit) {
                stack[depth] = 2u * first + 1u - node;
                entries[depth] = max(box_one.entry, box_other.entry);
                depth += 1u;
            }
            // Back to the last box that may still hold a nearer hit.
            found = box_one.hit || box_other.hit;
            while (depth > 0u && !found) {
                depth -= 1u;
                node = stack[depth];
                found = entries[depth] <= hit.distance;
            }
            first = nodes[node].first;
            count = nodes[node].count;
        }
        if (found) {
            for (var triangle = first; triangle < first + count; triangle += 1u) {
                hit = trace_triangle(hit, ray, triangle, left);
            }
            var node = 0u;
            found = false;
            while (depth > 0u && !found) {
                depth -= 1u;
                node = stack[depth];
                found = entries[depth] <= hit.distance;
            }
            first = nodes[node].first;
            count = nodes[node].count;
        }
    }
    return hit;
}
