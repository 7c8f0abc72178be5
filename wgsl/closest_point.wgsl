// closest_point: the centre of a gem's proxy sphere, from the closest points of the lines along vertex normals.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Imagire, "Proxy Geometry Gem Rendering", eq. (1)-(5), (A.1)-(A.6); eq. (3) corrected
//   after (A.6). The stable centre: Tikhonov, "Solution of Incorrectly Formulated Problems and the
//   Regularization Method", 1963.

// Weight of the fallback point relative to the three lines in closest_point_centre, 2^-12. It
// limits the centre's distance from the fallback point to 1 / (2 sqrt(2^-12)) = 32 times the root
// of the summed squared distances of that point from the lines. The price is a bias of
// 2^-12 / (smallest eigenvalue of the lines' matrix): 0.3 % of that distance for the table of a
// brilliant, whose vertex normals are 17 degrees apart (eigenvalue 3 sin(9.8 degrees)^2 = 0.087).
const CLOSEST_POINT_REGULARISATION = 0.000244140625f;

// Altitude of a triangle, relative to its longest edge, at which closest_point_fallback abandons
// the face normal, 2^-10. Rounding of the vertices rotates the normal by 2^-24 / altitude: by 2^-14
// at this altitude, and never by more. A triangle with altitude h loses (2^-10 / h)^2 / 2 of its
// depth: 6e-7 if it is equilateral.
const CLOSEST_POINT_SLIVER = 0.0009765625f;

// Largest magnitude of a vector's components. A vector divided by it can be squared without
// overflow or underflow.
// Returns: max(|x|, |y|, |z|), at least 0.
// Units: those of `vector`.
// Domain: all finite vectors.
// Outside: nothing.
// Accuracy: lavapipe 0 ulp; portable 0 ulp
fn closest_point_largest_component(vector: vec3f) -> f32 {
    let magnitude = abs(vector);
    return max(magnitude.x, max(magnitude.y, magnitude.z));
}

// Direction of a vector of any size. The built-in `normalize` squares the vector, which underflows
// below 1e-19 and overflows above 1e19.
// Returns: `vector` scaled to unit length; 0 for the zero vector.
// Units: none.
// Domain: 0, or a largest component in [1e-30, 1e37].
// Outside: finite; smaller vectors may count as 0.
// Accuracy: lavapipe 4 ulp; portable 16 ulp; order kept
fn closest_point_direction(vector: vec3f) -> vec3f {
    let size = closest_point_largest_component(vector);
    // A smaller size may be flushed to 0, and the division would be 0 / 0.
    if size < 1.1754944e-38f {
        return vec3f(0.0f);
    }
    // The reciprocal of a larger size is subnormal, and the quotient may be 0.
    let scaled = vector / min(size, 8.507059e37f);
    return scaled / length(scaled);
}

// Parameters of the closest points of two lines, eq. (A.6): point h is origin_h + t_h normal_h. The cross
// product n_i x n_j is half of (n_i + n_j) x (n_j - n_i), since the difference of two nearby normals is exact.
// Returns: (t_i, t_j); (0, 0) for parallel normals, where every point of one line has a closest point on the
//   other.
// Units: t is a length if the normals are unit vectors.
// Domain: unit normals, equal or at an angle of at least 1e-10; |origin_j - origin_i| = 0 or in [1e-15, 1e15].
// Outside: (0, 0) below an angle of 1e-20; finite wherever |origin_j - origin_i| / angle < 1e37.
// Accuracy: lavapipe 4.5 ulp + 2 backward; portable 16 ulp + 4 backward
fn closest_point_parameters(origin_i: vec3f, normal_i: vec3f, origin_j: vec3f, normal_j: vec3f) -> vec2f {
    let across = cross(normal_i + normal_j, normal_j - normal_i);
    let across_squared = dot(across, across);
    // A subnormal divisor may be flushed to 0.
    if across_squared < 1.2e-38f {
        return vec2f(0.0f);
    }
    let x = origin_j - origin_i;
    // `across` is twice n_i x n_j, which enters the numerator once and the denominator squared.
    let t = vec2f(dot(cross(x, normal_j), across), dot(cross(x, normal_i), across));
    return 2.0f * t / across_squared;
}

// Stand-in for the centre if the normals do not determine it: behind the triangle's face, at a
// depth equal to its longest edge. It needs no data beyond the triangle, so one draw can contain
// many stones. The depth fades to 0 for slivers (CLOSEST_POINT_SLIVER), whose face normal is noise.
// Returns: centroid - n longest_edge, where n is the unit normal of the counter-clockwise face; the
//   centroid if the vertices are collinear, the vertex if they coincide.
// Units: those of the positions.
// Domain: positions up to 1e19, the longest edge 0 or at least 1e-20.
// Outside: finite for positions up to 1e37; smaller triangles may count as a point.
// Accuracy: lavapipe 4.5 ulp + 2.5 backward; portable 17 ulp + 6.5 backward
fn closest_point_fallback(position_a: vec3f, position_b: vec3f, position_c: vec3f) -> vec3f {
    let edge_b = position_b - position_a;
    let edge_c = position_c - position_a;
    let size = closest_point_largest_component(max(abs(edge_b), abs(edge_c)));
    if size < 1.2e-38f {
        return position_a;
    }
    let b = edge_b / size;
    let c = edge_c / size;
    let bc = (position_c - position_b) / size;
    let longest_squared = max(max(dot(b, b), dot(c, c)), dot(bc, bc));
    // b x c = b x bc. In a needle, the cross product of the two long edges cancels, but that of a
    // long and the short one does not, so the shorter of c and bc is used.
    let area_normal = cross(b, select(c, bc, dot(bc, bc) < dot(c, c)));
    let faded = CLOSEST_POINT_SLIVER * longest_squared;
    let depth = sqrt(longest_squared / (dot(area_normal, area_normal) + faded * faded));
    return position_a + size * ((b + c) / 3.0f - depth * area_normal);
}

// Centre of the proxy sphere: the point o with the least sum |(I - n n^T)(o - x)|^2 +
// CLOSEST_POINT_REGULARISATION |o - p|^2, p the fallback point. Each normal is split along the mean direction,
// since a plain sum would cancel: docs/closest_point.md.
// Returns: o; never farther than 32 sqrt(sum of squared distances of p to the lines) from p. The order of the
//   vertices affects only p, which lies behind the counter-clockwise face.
// Units: those of the positions.
// Domain: unit normals at most 120 degrees apart, positions up to 1e19, the longest edge 0 or at least 1e-20.
// Outside: finite for positions up to 1e30. Opposed normals give o too, with up to four thousand ulp.
// Accuracy: lavapipe 207 ulp + 10 backward; portable 768 ulp + 36 backward
fn closest_point_centre(
    position_a: vec3f,
    normal_a: vec3f,
    position_b: vec3f,
    normal_b: vec3f,
    position_c: vec3f,
    normal_c: vec3f,
) -> vec3f {
    let fallback = closest_point_fallback(position_a, position_b, position_c);
    let offset_a = position_a - fallback;
    let offset_b = position_b - fallback;
    let offset_c = position_c - fallback;
    let size = closest_point_largest_component(max(max(abs(offset_a), abs(offset_b)), abs(offset_c)));
    if size < 1.2e-38f {
        return fallback;
    }
    let a = offset_a / size;
    let b = offset_b / size;
    let c = offset_c / size;

    // normal = along * axis + tilt. If the normals cancel out, the axis is 0 and each tilt is the
    // normal itself.
    let axis = closest_point_direction(normal_a + normal_b + normal_c);
    let along = vec3f(dot(axis, normal_a), dot(axis, normal_b), dot(axis, normal_c));
    let deviation_a = ((normal_a - normal_b) + (normal_a - normal_c)) / 3.0f;
    let deviation_b = ((normal_b - normal_c) + (normal_b - normal_a)) / 3.0f;
    let deviation_c = ((normal_c - normal_a) + (normal_c - normal_b)) / 3.0f;
    let tilt_a = deviation_a - dot(axis, deviation_a) * axis;
    let tilt_b = deviation_b - dot(axis, deviation_b) * axis;
    let tilt_c = deviation_c - dot(axis, deviation_c) * axis;

    // The positions, split in the same way, and n . x.
    let height = vec3f(dot(axis, a), dot(axis, b), dot(axis, c));
    let lean = vec3f(dot(tilt_a, a), dot(tilt_b, b), dot(tilt_c, c));
    let reach = lean + along * height;

    // Right-hand side sum (I - n n^T) x, across and along the axis. For unit normals,
    // 1 - along^2 = |tilt|^2.
    let tilt_squared = vec3f(dot(tilt_a, tilt_a), dot(tilt_b, tilt_b), dot(tilt_c, tilt_c));
    let sum = a + b + c;
    let right_across = sum - dot(axis, sum) * axis - reach.x * tilt_a - reach.y * tilt_b - reach.z * tilt_c;
    let right_along = dot(tilt_squared, height) - dot(along, lean);

    // Matrix sum (I - n n^T) + regularisation: the block across the axis, with the diagonal value
    // also along the axis so that it can be inverted as it is; its coupling with the axis; its
    // entry along the axis.
    let diagonal = 3.0f + CLOSEST_POINT_REGULARISATION;
    let column_x = vec3f(diagonal, 0.0f, 0.0f) - tilt_a.x * tilt_a - tilt_b.x * tilt_b - tilt_c.x * tilt_c;
    let column_y = vec3f(0.0f, diagonal, 0.0f) - tilt_a.y * tilt_a - tilt_b.y * tilt_b - tilt_c.y * tilt_c;
    let column_z = vec3f(0.0f, 0.0f, diagonal) - tilt_a.z * tilt_a - tilt_b.z * tilt_b - tilt_c.z * tilt_c;
    let coupling = -(along.x * tilt_a + along.y * tilt_b + along.z * tilt_c);
    let stiffness = CLOSEST_POINT_REGULARISATION + (tilt_squared.x + tilt_squared.y + tilt_squared.z);

    // Cramer's rule across the axis, then the depth along the axis, then back substitution.
    let row_x = cross(column_y, column_z);
    let row_y = cross(column_z, column_x);
    let row_z = cross(column_x, column_y);
    let determinant = dot(column_x, row_x);
    let at_axis = vec3f(dot(row_x, right_across), dot(row_y, right_across), dot(row_z, right_across)) / determinant;
    let drift = vec3f(dot(row_x, coupling), dot(row_y, coupling), dot(row_z, coupling)) / determinant;
    let depth = (right_along - dot(coupling, at_axis)) / (stiffness - dot(coupling, drift));
    return fallback + size * (at_axis + depth * (axis - drift));
}
