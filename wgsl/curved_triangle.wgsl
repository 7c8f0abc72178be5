// curved_triangle: where a ray that meets a triangle meets the curved surface that the normals at its corners describe.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Boubekeur and Alexa, "Phong Tessellation", ACM Transactions on Graphics 27(5), article 141, 2008: the mean of
//   the projections onto the tangent planes at the corners. Own: only its part along the normal of the triangle, with a
//   shape factor of 1/2, and at the hit of a ray.
//
// A smooth body is drawn by triangles with normals at the corners. Refraction and reflection need the
// place on the smooth surface too: a normal from there and a position from the flat triangle do not
// belong together. No triangle is split; one hit is moved along its ray. With a hit of a ray on the
// triangle, the weights of the second and third corner there, and the triangle's own unit normal:
//
//   let curved = curved_triangle_meet(triangle, hit.barycentrics, position, direction, outward);

// Cosine of the angle of incidence below which a ray is not followed further, that of 78 degrees. The ray would meet
// the surface far from the triangle, or not at all. A hit moves by 5 heights at most: 5/4 of an edge.
const CURVED_TRIANGLE_GRAZING: f32 = 0.2f;
// Squared length of an interpolated normal below which it has no direction. At a length of 1/1000, the rounding of the
// normals at the corners turns it by 1e-4.
const CURVED_TRIANGLE_CANCELLED: f32 = 1e-6f;

// A triangle with normals at its corners.
struct CurvedTriangle {
    // The corners.
    a: vec3f,
    b: vec3f,
    c: vec3f,
    // Unit normals at the corners; 0 where there is none.
    normal_a: vec3f,
    normal_b: vec3f,
    normal_c: vec3f,
}

// A place on a curved surface.
struct CurvedTriangleHit {
    position: vec3f,
    // Unit normal.
    normal: vec3f,
}

// Height of the curved surface above the triangle: half of the weighted mean rise to the projections onto the tangent
// planes at the corners, right to the third order in the edges. By differences of normals: equal normals give 0.
// Returns: height along `outward`, at most a quarter of the longer of the edges ab and ac.
// Units: those of the corners; `barycentrics` are the weights of b and c.
// Domain: weights in [0, 1], their sum up to 1; unit normals, or 0; `outward` the triangle's unit normal, to either
//   side; coordinates up to 2^13 altitudes, the longest edge in [2^-13, 2^13] and up to 2^10 altitudes.
// Outside: finite for corners up to 2^40 and other arguments up to 2^10.
// Accuracy: lavapipe 1 ulp + 5 backward; portable 2 ulp + 10 backward
fn curved_triangle_height(triangle: CurvedTriangle, barycentrics: vec2f, outward: vec3f) -> f32 {
    let edge_b = triangle.b - triangle.a;
    let edge_c = triangle.c - triangle.a;
    let rise_a = dot(triangle.normal_a, outward) * triangle.normal_a;
    let rise_b = dot(triangle.normal_b, outward) * triangle.normal_b;
    let rise_c = dot(triangle.normal_c, outward) * triangle.normal_c;
    let way_b = (1.0f - barycentrics.x) * edge_b - barycentrics.y * edge_c;
    let way_c = (1.0f - barycentrics.y) * edge_c - barycentrics.x * edge_b;
    // The weighted ways to the corners add up to 0, so rise_a may be taken from all three rises.
    let mean = barycentrics.x * dot(way_b, rise_b - rise_a) + barycentrics.y * dot(way_c, rise_c - rise_a);
    return 0.5f * mean;
}

// Weights of b and c at an offset from a, or what an offset adds to them: the weights are linear. By areas, since the
// squares and the product of two nearly parallel edges cancel.
// Returns: weights of b and c; of an offset perpendicular to the triangle, 0.
// Units: none; `offset` is in the units of the corners. The normals are not used.
// Domain: offsets of 2^-20 to 2^2 longest edges, or 0; coordinates up to 2^13 altitudes, the longest edge in [2^-13,
//   2^13] and up to 2^10 altitudes.
// Outside: finite for offsets up to 2^20; a triangle without area divides by 0.
// Accuracy: lavapipe 3 ulp + 4 backward; portable 6 ulp + 8 backward
fn curved_triangle_weights(triangle: CurvedTriangle, offset: vec3f) -> vec2f {
    let edge_b = triangle.b - triangle.a;
    let edge_c = triangle.c - triangle.a;
    let edge_bc = triangle.c - triangle.b;
    // In a sliver the cross product of the two long edges cancels; that of a long and the short one does not.
    let across = cross(edge_b, select(edge_c, edge_bc, dot(edge_bc, edge_bc) < dot(edge_c, edge_c)));
    let areas = vec2f(dot(cross(offset, edge_c), across), dot(cross(edge_b, offset), across));
    return areas / dot(across, across);
}

// Where a ray that meets the triangle meets the curved surface. The hit moves along the ray to the height that the
// surface has at the flat hit; the normal is interpolated below the moved hit.
// Returns: the moved hit; where the interpolated normals cancel, `position` and `outward`.
// Units: those of the corners; `barycentrics` are the weights of b and c at `position`.
// Domain: |direction| = 1; `position` on the triangle; others as in curved_triangle_height.
// Outside: finite for positions up to 2^60 and directions up to 2^10; a triangle without area divides by 0.
// Accuracy: lavapipe position 1 ulp + 7 backward, normal 4.5 ulp + 7 backward;
//   portable position 2 ulp + 14 backward, normal 9 ulp + 14 backward
fn curved_triangle_meet(
    triangle: CurvedTriangle, barycentrics: vec2f, position: vec3f, direction: vec3f, outward: vec3f
) -> CurvedTriangleHit {
    let height = curved_triangle_height(triangle, barycentrics, outward);
    let along = dot(direction, outward);
    let slope = select(min(along, -CURVED_TRIANGLE_GRAZING), max(along, CURVED_TRIANGLE_GRAZING), along >= 0.0f);
    let moved = height / slope * direction;
    // The normals of the corners hold a little beyond the triangle too.
    let weight = clamp(barycentrics + curved_triangle_weights(triangle, moved), vec2f(-0.5f), vec2f(1.5f));
    let normal = (1.0f - weight.x - weight.y) * triangle.normal_a
        + weight.x * triangle.normal_b
        + weight.y * triangle.normal_c;
    let squared = dot(normal, normal);
    if (squared < CURVED_TRIANGLE_CANCELLED) {
        return CurvedTriangleHit(position, outward);
    }
    return CurvedTriangleHit(position + moved, normal * inverseSqrt(squared));
}
