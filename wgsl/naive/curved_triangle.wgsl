// curved_triangle: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// curved_triangle_height from the tangent planes' equations, n . x = n . p. Kept to show where it fails: far from the
// origin both sides are large, and their difference is what their rounding leaves.
// Returns: height along `outward`.
// Units: as for curved_triangle_height.
// Domain: a triangle that bulges to one side, in size and distance from the origin near 1; weights in [0.2, 0.4].
// Outside: as the formula gives.
// Accuracy: naive
fn curved_triangle_height_naive(triangle: CurvedTriangle, barycentrics: vec2f, outward: vec3f) -> f32 {
    let first = 1.0f - barycentrics.x - barycentrics.y;
    let point = first * triangle.a + barycentrics.x * triangle.b + barycentrics.y * triangle.c;
    let above_a = dot(triangle.normal_a, triangle.a) - dot(triangle.normal_a, point);
    let above_b = dot(triangle.normal_b, triangle.b) - dot(triangle.normal_b, point);
    let above_c = dot(triangle.normal_c, triangle.c) - dot(triangle.normal_c, point);
    let mean = first * above_a * dot(triangle.normal_a, outward)
        + barycentrics.x * above_b * dot(triangle.normal_b, outward)
        + barycentrics.y * above_c * dot(triangle.normal_c, outward);
    return 0.5f * mean;
}

// curved_triangle_weights from the dot products of the edges, as in Ericson, "Real-Time Collision Detection", section
// 3.4. Kept to show where it fails: in a sliver the determinant cancels.
// Returns: weights of b and c; 0 / 0 for a triangle without area.
// Units: as for curved_triangle_weights.
// Domain: triangles with angles of 45 degrees or more, near the origin; offsets along both edges.
// Outside: as the formula gives.
// Accuracy: naive
fn curved_triangle_weights_naive(triangle: CurvedTriangle, offset: vec3f) -> vec2f {
    let edge_b = triangle.b - triangle.a;
    let edge_c = triangle.c - triangle.a;
    let bb = dot(edge_b, edge_b);
    let bc = dot(edge_b, edge_c);
    let cc = dot(edge_c, edge_c);
    let ob = dot(offset, edge_b);
    let oc = dot(offset, edge_c);
    return vec2f(cc * ob - bc * oc, bb * oc - bc * ob) / (bb * cc - bc * bc);
}

// curved_triangle_meet without its guards, from positions. Kept to show where it fails: a ray along the triangle
// divides by 0, normals that cancel have no direction, and both forms above have their own faults.
// Returns: the moved hit.
// Units: as for curved_triangle_meet.
// Domain: a triangle that bulges a little, in size and distance from the origin near 1; weights in [0.2, 0.4]; rays
//   that meet it at a cosine of at least 0.5.
// Outside: as the formula gives.
// Accuracy: naive
fn curved_triangle_meet_naive(
    triangle: CurvedTriangle, barycentrics: vec2f, position: vec3f, direction: vec3f, outward: vec3f
) -> CurvedTriangleHit {
    let height = curved_triangle_height_naive(triangle, barycentrics, outward);
    let met = position + height / dot(direction, outward) * direction;
    let weight = curved_triangle_weights_naive(triangle, met - triangle.a);
    let normal = (1.0f - weight.x - weight.y) * triangle.normal_a
        + weight.x * triangle.normal_b
        + weight.y * triangle.normal_c;
    return CurvedTriangleHit(met, normalize(normal));
}

// The interpolated normal at the flat hit: Phong, "Illumination for Computer Generated Pictures", Communications of the
// ACM 18(6), 1975. Kept to show where it fails: position and normal of a slanting ray are off by the square of the
// edges, where curved_triangle_meet is off by their cube.
// Returns: the flat hit with the interpolated normal.
// Units: as for curved_triangle_meet.
// Domain: the triangles, weights and positions of curved_triangle_meet_naive.
// Outside: as the formula gives.
// Accuracy: naive
fn curved_triangle_meet_phong(triangle: CurvedTriangle, barycentrics: vec2f, position: vec3f) -> CurvedTriangleHit {
    let normal = (1.0f - barycentrics.x - barycentrics.y) * triangle.normal_a
        + barycentrics.x * triangle.normal_b
        + barycentrics.y * triangle.normal_c;
    return CurvedTriangleHit(position, normalize(normal));
}
