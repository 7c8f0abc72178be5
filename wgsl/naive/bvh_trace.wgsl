// bvh_trace: the forms that one finds elsewhere, kept to show where they fail. They follow wgsl/bvh_trace.wgsl, and use its structs and functions.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The epsilon of bvh_trace_triangle_naive, as one finds it.
const BVH_TRACE_NAIVE_EPSILON = 1e-6f;

// The slab test as one finds it. Kept to show where it fails: a plane through the origin of a ray along it is 0 *
// infinity, and a flat box is missed by rounding.
// Returns: BvhTraceBox.
// Units: those of the positions.
// Domain: components of the direction of at least 0.05; the ray passes the box's edges at 1/100 of its size or more.
// Outside: as the formula gives.
// Accuracy: naive
fn bvh_trace_box_naive(ray: BvhTraceRay, lower: vec3f, upper: vec3f, nearest: f32) -> BvhTraceBox {
    let inverse = 1.0f / ray.direction;
    let first = (lower - ray.origin) * inverse;
    let second = (upper - ray.origin) * inverse;
    let enter = min(first, second);
    let leave = max(first, second);
    let entry = max(max(enter.x, enter.y), max(enter.z, 0.0f));
    let exit = min(min(leave.x, leave.y), min(leave.z, nearest));
    return BvhTraceBox(entry, entry <= exit);
}

// The triangle test that one finds: Möller and Trumbore's, with an epsilon for the determinant and the distance. Kept
// to show where it fails: the signs at an edge are rounded otherwise for each of its triangles, so that both may refuse
// a ray between them; and the epsilon is a length and an area at once, and right for one size of mesh.
// Returns: BvhTraceHit.
// Units: those of the positions.
// Domain: edges in [0.01, 4], normal . direction at least 0.1, the ray at 1/100 of the triangle or more from its edges.
// Outside: as the formula gives.
// Accuracy: naive
fn bvh_trace_triangle_naive(
    hit: BvhTraceHit,
    ray: BvhTraceRay,
    a: vec3f,
    b: vec3f,
    c: vec3f,
    triangle: u32,
    left: u32,
) -> BvhTraceHit {
    let edge_b = b - a;
    let edge_c = c - a;
    let across = cross(ray.direction, edge_c);
    let determinant = -dot(edge_b, across);
    if (triangle == left || determinant < BVH_TRACE_NAIVE_EPSILON) {
        return hit;
    }
    let offset = a - ray.origin;
    let around = cross(offset, edge_b);
    let u = dot(offset, across) / determinant;
    let v = dot(ray.direction, around) / determinant;
    let distance = dot(edge_c, around) / determinant;
    if (u < 0.0f || v < 0.0f || u + v > 1.0f || distance < BVH_TRACE_NAIVE_EPSILON || distance > hit.distance) {
        return hit;
    }
    return BvhTraceHit(distance, vec2f(u, v), triangle);
}
