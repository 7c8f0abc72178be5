// trace: rays from inside closed meshes, each to the nearest triangle that it leaves through, one invocation a ray.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the loop over nodes with a stack, as in Aila and Laine, "Understanding the Efficiency of Ray Traversal on
//   GPUs", HPG 2009; the loop over all triangles: Imagire, "Proxy Geometry Gem Rendering", section 5.
// requires: bvh_trace
//
// Whatever traces inside a shader copies `trace_nearest` and the bindings of its group 0.

// A loop over all triangles instead of the hierarchy: the paper's comparator.
override TRAVERSAL_LOOP: bool = false;
// Möller and Trumbore's test with an epsilon instead of the watertight one.
override TRIANGLE_NAIVE: bool = false;

// The largest number of nodes between the root and a leaf. Whoever builds the hierarchy keeps to it.
const TRACE_DEPTH = 32u;
// Farther than anything that a ray may meet.
const TRACE_FAR = 1e37f;

// The root first; the two children of a node side by side. At least one node.
@group(0) @binding(0) var<storage, read> nodes: array<BvhTraceNode>;
// Three floats a vertex.
@group(0) @binding(1) var<storage, read> positions: array<f32>;
// Three a triangle, counter-clockwise from outside, in the order of the leaves. A triangle's number is its place here.
@group(0) @binding(2) var<storage, read> indices: array<u32>;

struct TraceQuery {
    origin: vec3f,
    // The triangle that the ray has just left; BVH_TRACE_NONE if it starts inside.
    left: u32,
    direction: vec3f,
}

@group(1) @binding(0) var<storage, read> queries: array<TraceQuery>;
@group(1) @binding(1) var<storage, read_write> hits: array<BvhTraceHit>;

fn trace_position(index: u32) -> vec3f {
    return vec3f(positions[3u * index], positions[3u * index + 1u], positions[3u * index + 2u]);
}

// One triangle, by its number.
fn trace_triangle(hit: BvhTraceHit, ray: BvhTraceRay, triangle: u32, left: u32) -> BvhTraceHit {
    let a = trace_position(indices[3u * triangle]);
    let b = trace_position(indices[3u * triangle + 1u]);
    let c = trace_position(indices[3u * triangle + 2u]);
    if (TRIANGLE_NAIVE) {
        return bvh_trace_triangle_naive(hit, ray, a, b, c, triangle, left);
    }
    return bvh_trace_triangle(hit, ray, a, b, c, triangle, left);
}

// The nearest triangle that a ray leaves the solid through.
fn trace_nearest(origin: vec3f, direction: vec3f, left: u32) -> BvhTraceHit {
    var hit = bvh_trace_start(TRACE_FAR);
    let ray = bvh_trace_ray(origin, direction, nodes[0].lower, nodes[0].upper);
    if (TRAVERSAL_LOOP) {
        for (var triangle = 0u; triangle < arrayLength(&indices) / 3u; triangle += 1u) {
            hit = trace_triangle(hit, ray, triangle, left);
        }
        return hit;
    }
    // The farther children, and where the ray enters them.
    var stack: array<u32, TRACE_DEPTH>;
    var entries: array<f32, TRACE_DEPTH>;
    var depth = 0u;
    var node = 0u;
    loop {
        let first = nodes[node].first;
        let count = nodes[node].count;
        if (count == 0u) {
            let box_one = bvh_trace_box(ray, nodes[first].lower, nodes[first].upper, hit.distance);
            let box_other = bvh_trace_box(ray, nodes[first + 1u].lower, nodes[first + 1u].upper, hit.distance);
            // The nearer child first: what it finds culls the farther.
            let other_first = box_other.hit && (!box_one.hit || box_other.entry < box_one.entry);
            let near = select(first, first + 1u, other_first);
            if (box_one.hit && box_other.hit) {
                stack[depth] = 2u * first + 1u - near;
                entries[depth] = max(box_one.entry, box_other.entry);
                depth += 1u;
            }
            if (box_one.hit || box_other.hit) {
                node = near;
                continue;
            }
        }
        for (var triangle = first; triangle < first + count; triangle += 1u) {
            hit = trace_triangle(hit, ray, triangle, left);
        }
        // Back to the last box that may still hold something nearer.
        var found = false;
        while (depth > 0u && !found) {
            depth -= 1u;
            node = stack[depth];
            found = entries[depth] <= hit.distance;
        }
        if (!found) {
            break;
        }
    }
    return hit;
}

@compute @workgroup_size(64)
fn trace_rays(@builtin(global_invocation_id) invocation: vec3u) {
    if (invocation.x < arrayLength(&queries)) {
        let query = queries[invocation.x];
        hits[invocation.x] = trace_nearest(query.origin, query.direction, query.left);
    }
}
