// closest_point: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// The direction from the built-in `normalize`.
// Returns: `vector` scaled to unit length.
// Units: none.
// Domain: lengths in [1e-15, 1e15].
// Outside: 0 / 0 for the zero vector and wherever the square underflows, 0 where it overflows.
// Accuracy: naive
fn closest_point_direction_naive(vector: vec3f) -> vec3f {
    return normalize(vector);
}

// The parameters from dot products, eq. (A.4). Kept to show where it fails: its determinant is
// 1 - cos^2 of the angle between the normals, which has lost all digits at 2^-12 rad.
// Returns: (t_i, t_j); 0 / 0 for parallel normals.
// Units: as for closest_point_parameters.
// Domain: unit normals at an angle in [0.5, 2.6].
// Outside: as the formula gives.
// Accuracy: naive
fn closest_point_parameters_dot(origin_i: vec3f, normal_i: vec3f, origin_j: vec3f, normal_j: vec3f) -> vec2f {
    let x = origin_j - origin_i;
    let ii = dot(normal_i, normal_i);
    let jj = dot(normal_j, normal_j);
    let ij = dot(normal_i, normal_j);
    let xi = dot(x, normal_i);
    let xj = dot(x, normal_j);
    return vec2f(jj * xi - ij * xj, ij * xi - ii * xj) / (ii * jj - ij * ij);
}

// The parameters from eq. (3) as printed: the numerator has the cross product with n_h where (A.6)
// has the other normal, so t_i and t_j are swapped. On a sphere they are equal, and the mistake
// does not show.
// Returns: (t_j, t_i) of closest_point_parameters; 0 / 0 for parallel normals.
// Units: as for closest_point_parameters.
// Domain: unit normals at an angle in [0.5, 2.6].
// Outside: as the formula gives.
// Accuracy: naive
fn closest_point_parameters_literal(origin_i: vec3f, normal_i: vec3f, origin_j: vec3f, normal_j: vec3f) -> vec2f {
    let x = origin_j - origin_i;
    let across = cross(normal_i, normal_j);
    let t = vec2f(dot(cross(x, normal_i), across), dot(cross(x, normal_j), across));
    return t / dot(normal_i, cross(normal_j, across));
}

// The straightforward form of the fallback. Kept to show where it fails: the square of the cross
// product underflows for edges below 1e-10 and overflows above 1e9, and a triangle without area has
// no direction to normalise.
// Returns: centroid - n longest_edge; 0 / 0 if the vertices are collinear.
// Units: those of the positions.
// Domain: edges in [1e-4, 1e4], altitudes at least 1/10 of the longest edge.
// Outside: as the formula gives.
// Accuracy: naive
fn closest_point_fallback_naive(position_a: vec3f, position_b: vec3f, position_c: vec3f) -> vec3f {
    let edge_b = position_b - position_a;
    let edge_c = position_c - position_a;
    let longest = max(max(length(edge_b), length(edge_c)), length(edge_c - edge_b));
    return (position_a + position_b + position_c) / 3.0f - longest * normalize(cross(edge_b, edge_c));
}

// The paper's centre, eq. (4), (5), with eq. (3) corrected: for each vertex, the point of its line
// closest to the next vertex's line, averaged with the sines between the normals as weights. As normals
// become parallel it runs off to infinity, and it depends on the winding: docs/closest_point.md.
// Returns: o; closest_point_fallback if all three normals are parallel.
// Units: those of the positions.
// Domain: unit normals at angles in [0.3, 2.8] from each other.
// Outside: as the formula gives.
// Accuracy: naive
fn closest_point_centre_paper(
    position_a: vec3f,
    normal_a: vec3f,
    position_b: vec3f,
    normal_b: vec3f,
    position_c: vec3f,
    normal_c: vec3f,
) -> vec3f {
    let weight = vec3f(
        length(cross(normal_a, normal_b)),
        length(cross(normal_b, normal_c)),
        length(cross(normal_c, normal_a)),
    );
    let total = weight.x + weight.y + weight.z;
    if total == 0.0f {
        return closest_point_fallback(position_a, position_b, position_c);
    }
    let point_a = position_a + normal_a * closest_point_parameters(position_a, normal_a, position_b, normal_b).x;
    let point_b = position_b + normal_b * closest_point_parameters(position_b, normal_b, position_c, normal_c).x;
    let point_c = position_c + normal_c * closest_point_parameters(position_c, normal_c, position_a, normal_a).x;
    return (weight.x * point_a + weight.y * point_b + weight.z * point_c) / total;
}

// The paper's centre with eq. (3) as printed. The point of each vertex lies at its neighbour's
// distance, which is right on a sphere and wrong on any other stone.
// Returns: o with t_i and t_j swapped; 0 / 0 as soon as two normals are parallel.
// Units: those of the positions.
// Domain: unit normals at angles in [0.3, 2.8] from each other.
// Outside: as the formula gives.
// Accuracy: naive
fn closest_point_centre_literal(
    position_a: vec3f,
    normal_a: vec3f,
    position_b: vec3f,
    normal_b: vec3f,
    position_c: vec3f,
    normal_c: vec3f,
) -> vec3f {
    let weight = vec3f(
        length(cross(normal_a, normal_b)),
        length(cross(normal_b, normal_c)),
        length(cross(normal_c, normal_a)),
    );
    let point_a = position_a
        + normal_a * closest_point_parameters_literal(position_a, normal_a, position_b, normal_b).x;
    let point_b = position_b
        + normal_b * closest_point_parameters_literal(position_b, normal_b, position_c, normal_c).x;
    let point_c = position_c
        + normal_c * closest_point_parameters_literal(position_c, normal_c, position_a, normal_a).x;
    return (weight.x * point_a + weight.y * point_b + weight.z * point_c) / (weight.x + weight.y + weight.z);
}
