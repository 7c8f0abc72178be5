// bvh_trace: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The usual epsilon, used by bvh_trace_triangle_naive.
const BVH_TRACE_NAIVE_EPSILON = 1e-6f;

// The usual slab test. Kept to show where it fails: a ray that starts in a plane of the box and
// runs along it gives 0 * infinity, and rounding makes a ray miss a flat box.
// Returns: BvhTraceBox.
// Units: those of the positions.
// Domain: components of the direction of at least 0.05; the ray passes the edges of the box at a
//   distance of at least 1/100 of its size.
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

// Möller and Trumbore's triangle test, with an epsilon for determinant and distance. The signs at an
// edge are rounded differently for its two triangles, so both may reject a ray; one epsilon, a length
// and an area, fits one size of mesh.
// Returns: BvhTraceHit.
// Units: those of the positions.
// Domain: edges in [0.01, 4]; normal . direction at least 0.1; the ray at least 1/100 of the triangle's
//   size away from its edges.
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
