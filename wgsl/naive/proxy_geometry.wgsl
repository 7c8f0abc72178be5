// proxy_geometry: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The straightforward form of the normal: normalize(cross).
// Returns: unit normal.
// Units: lengths in, none out.
// Domain: size of the triangle in [1e-4, 1e4], sine of the angle at the first vertex at least 1e-2.
// Outside: not a number for degenerate, very small and very large triangles.
// Accuracy: naive
fn proxy_geometry_face_normal_naive(position_first: vec3f, position_second: vec3f, position_third: vec3f) -> vec3f {
    return normalize(cross(position_second - position_first, position_third - position_first));
}

// The intersection without the special cases.
// Returns: ProxyGeometryHit; `hit` is always true.
// Units: lengths; `direction` and `normal` are unit vectors.
// Domain: as for proxy_geometry_intersect, for a ray that does meet the plane ahead of it.
// Outside: infinite or not a number for a parallel ray, a point behind the ray for a plane behind
//   it.
// Accuracy: naive
fn proxy_geometry_intersect_naive(
    position: vec3f, direction: vec3f, plane_point: vec3f, normal: vec3f
) -> ProxyGeometryHit {
    let distance = dot(normal, plane_point - position) / dot(normal, direction);
    return ProxyGeometryHit(position + distance * direction, distance, true);
}

// The coordinates from the Gram matrix of the edges, the usual way to compute barycentric
// coordinates.
// Returns: the two coordinates.
// Units: lengths in, none out.
// Domain: size of the triangle in [1e-3, 1e3], sine of the angle at least 0.1.
// Outside: loses twice the digits that the triangle's thinness costs; not a number for degenerate,
//   tiny and huge ones.
// Accuracy: naive
fn proxy_geometry_coordinates_naive(point: vec3f, origin: vec3f, edge_first: vec3f, edge_second: vec3f) -> vec2f {
    let offset = point - origin;
    let first_first = dot(edge_first, edge_first);
    let first_second = dot(edge_first, edge_second);
    let second_second = dot(edge_second, edge_second);
    let offset_first = dot(offset, edge_first);
    let offset_second = dot(offset, edge_second);
    return vec2f(
        second_second * offset_first - first_second * offset_second,
        first_first * offset_second - first_second * offset_first,
    ) / (first_first * second_second - first_second * first_second);
}

// The tile from the sum of the fractions, the straightforward form.
// Returns: ProxyGeometryCell.
// Units: lattice coordinates.
// Domain: coordinates up to 2^23, away from the edges of the tiles.
// Outside: just below a whole number a fraction rounds to 1, and the sum forgets the other: points
//   beside a vertex get the wrong half.
// Accuracy: naive
fn proxy_geometry_cell_naive(coordinates: vec2f) -> ProxyGeometryCell {
    let corner = floor(coordinates);
    let within = coordinates - corner;
    return ProxyGeometryCell(vec2i(corner), within.x + within.y > 1.0f);
}

// The normal of a tile from eq. (8) and (9) exactly as written.
// Returns: unit normal.
// Units: lengths in, none out.
// Domain: distance between centroid and centre in [1e-15, 1e15].
// Outside: zero, infinite or not a number where the square of the distance leaves the range of f32.
// Accuracy: naive
fn proxy_geometry_facet_normal_naive(
    centre: vec3f, vertex_first: vec3f, vertex_second: vec3f, vertex_third: vec3f
) -> vec3f {
    return normalize(centre - (vertex_first + vertex_second + vertex_third) / 3.0f);
}
