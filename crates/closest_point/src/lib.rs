//! Mirror of `wgsl/closest_point.wgsl`, line by line: the centre of a gem's proxy sphere, from the
//! closest points of the lines along a triangle's vertex normals. The WGSL file states the units,
//! domain and accuracy of each function.
//!
//! ```
//! use glam::Vec3;
//! use lapidary_closest_point::centre;
//!
//! // The normals of a sphere meet in its centre.
//! let corners = [Vec3::X, Vec3::Y, Vec3::Z];
//! let [a, b, c] = corners;
//! let centre = centre(a, a, b, b, c, c);
//! assert!(centre.length() < 0.01, "{centre}");
//! ```

use glam::{Vec2, Vec3};

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

/// Weight of the fallback point relative to the three lines in [`centre`], 2^-12.
pub const CLOSEST_POINT_REGULARISATION: f32 = 0.000244140625;

/// Altitude of a triangle, relative to its longest edge, at which [`fallback`] abandons the face
/// normal, 2^-10.
pub const CLOSEST_POINT_SLIVER: f32 = 0.0009765625;

/// Returns the largest magnitude of a vector's components.
pub fn largest_component(vector: Vec3) -> f32 {
    let magnitude = vector.abs();
    magnitude.x.max(magnitude.y.max(magnitude.z))
}

/// Returns the direction of a vector of any size; 0 for the zero vector.
pub fn direction(vector: Vec3) -> Vec3 {
    let size = largest_component(vector);
    if size < f32::MIN_POSITIVE {
        return Vec3::ZERO;
    }
    let scaled = vector / size.min(8.507059e37);
    scaled / scaled.length()
}

/// Returns the direction from the built-in `normalize`.
pub fn direction_naive(vector: Vec3) -> Vec3 {
    vector.normalize()
}

/// Returns the parameters (t_i, t_j) of the closest points of two lines, eq. (A.6); (0, 0) for
/// parallel normals.
pub fn parameters(origin_i: Vec3, normal_i: Vec3, origin_j: Vec3, normal_j: Vec3) -> Vec2 {
    let across = (normal_i + normal_j).cross(normal_j - normal_i);
    let across_squared = across.dot(across);
    // A subnormal divisor may be flushed to 0.
    if across_squared < 1.2e-38 {
        return Vec2::splat(0.0);
    }
    let x = origin_j - origin_i;
    let t = Vec2::new(x.cross(normal_j).dot(across), x.cross(normal_i).dot(across));
    2.0 * t / across_squared
}

/// Returns the parameters from dot products, eq. (A.4); a naive form.
pub fn parameters_dot(origin_i: Vec3, normal_i: Vec3, origin_j: Vec3, normal_j: Vec3) -> Vec2 {
    let x = origin_j - origin_i;
    let ii = normal_i.dot(normal_i);
    let jj = normal_j.dot(normal_j);
    let ij = normal_i.dot(normal_j);
    let xi = x.dot(normal_i);
    let xj = x.dot(normal_j);
    Vec2::new(jj * xi - ij * xj, ij * xi - ii * xj) / (ii * jj - ij * ij)
}

/// Returns the parameters from eq. (3) as printed, which swaps them.
pub fn parameters_literal(origin_i: Vec3, normal_i: Vec3, origin_j: Vec3, normal_j: Vec3) -> Vec2 {
    let x = origin_j - origin_i;
    let across = normal_i.cross(normal_j);
    let t = Vec2::new(x.cross(normal_i).dot(across), x.cross(normal_j).dot(across));
    t / normal_i.dot(normal_j.cross(across))
}

/// Returns the stand-in for the centre if the normals do not determine it: behind the
/// counter-clockwise face, at a depth equal to its longest edge.
pub fn fallback(position_a: Vec3, position_b: Vec3, position_c: Vec3) -> Vec3 {
    let edge_b = position_b - position_a;
    let edge_c = position_c - position_a;
    let size = largest_component(edge_b.abs().max(edge_c.abs()));
    if size < 1.2e-38 {
        return position_a;
    }
    let b = edge_b / size;
    let c = edge_c / size;
    let bc = (position_c - position_b) / size;
    let longest_squared = b.dot(b).max(c.dot(c)).max(bc.dot(bc));
    let area_normal = b.cross(if bc.dot(bc) < c.dot(c) { bc } else { c });
    let faded = CLOSEST_POINT_SLIVER * longest_squared;
    let depth = (longest_squared / (area_normal.dot(area_normal) + faded * faded)).sqrt();
    position_a + size * ((b + c) / 3.0 - depth * area_normal)
}

/// Returns the straightforward form of [`fallback`]; a naive form.
pub fn fallback_naive(position_a: Vec3, position_b: Vec3, position_c: Vec3) -> Vec3 {
    let edge_b = position_b - position_a;
    let edge_c = position_c - position_a;
    let longest = edge_b.length().max(edge_c.length()).max((edge_c - edge_b).length());
    let area_normal = edge_b.cross(edge_c);
    (position_a + position_b + position_c) / 3.0 - longest * (area_normal / area_normal.length())
}

/// Returns the centre of the proxy sphere: the point closest to the three normal lines, by least
/// squares with a pull towards [`fallback`].
pub fn centre(
    position_a: Vec3,
    normal_a: Vec3,
    position_b: Vec3,
    normal_b: Vec3,
    position_c: Vec3,
    normal_c: Vec3,
) -> Vec3 {
    let fallback = fallback(position_a, position_b, position_c);
    let offset_a = position_a - fallback;
    let offset_b = position_b - fallback;
    let offset_c = position_c - fallback;
    let size = largest_component(offset_a.abs().max(offset_b.abs()).max(offset_c.abs()));
    if size < 1.2e-38 {
        return fallback;
    }
    let a = offset_a / size;
    let b = offset_b / size;
    let c = offset_c / size;

    let axis = direction(normal_a + normal_b + normal_c);
    let along = Vec3::new(axis.dot(normal_a), axis.dot(normal_b), axis.dot(normal_c));
    let deviation_a = ((normal_a - normal_b) + (normal_a - normal_c)) / 3.0;
    let deviation_b = ((normal_b - normal_c) + (normal_b - normal_a)) / 3.0;
    let deviation_c = ((normal_c - normal_a) + (normal_c - normal_b)) / 3.0;
    let tilt_a = deviation_a - axis.dot(deviation_a) * axis;
    let tilt_b = deviation_b - axis.dot(deviation_b) * axis;
    let tilt_c = deviation_c - axis.dot(deviation_c) * axis;

    let height = Vec3::new(axis.dot(a), axis.dot(b), axis.dot(c));
    let lean = Vec3::new(tilt_a.dot(a), tilt_b.dot(b), tilt_c.dot(c));
    let reach = lean + along * height;

    let tilt_squared = Vec3::new(tilt_a.dot(tilt_a), tilt_b.dot(tilt_b), tilt_c.dot(tilt_c));
    let sum = a + b + c;
    let right_across = sum - axis.dot(sum) * axis - reach.x * tilt_a - reach.y * tilt_b - reach.z * tilt_c;
    let right_along = tilt_squared.dot(height) - along.dot(lean);

    let diagonal = 3.0 + CLOSEST_POINT_REGULARISATION;
    let column_x = Vec3::new(diagonal, 0.0, 0.0) - tilt_a.x * tilt_a - tilt_b.x * tilt_b - tilt_c.x * tilt_c;
    let column_y = Vec3::new(0.0, diagonal, 0.0) - tilt_a.y * tilt_a - tilt_b.y * tilt_b - tilt_c.y * tilt_c;
    let column_z = Vec3::new(0.0, 0.0, diagonal) - tilt_a.z * tilt_a - tilt_b.z * tilt_b - tilt_c.z * tilt_c;
    let coupling = -(along.x * tilt_a + along.y * tilt_b + along.z * tilt_c);
    let stiffness = CLOSEST_POINT_REGULARISATION + (tilt_squared.x + tilt_squared.y + tilt_squared.z);

    let row_x = column_y.cross(column_z);
    let row_y = column_z.cross(column_x);
    let row_z = column_x.cross(column_y);
    let determinant = column_x.dot(row_x);
    let at_axis = Vec3::new(row_x.dot(right_across), row_y.dot(right_across), row_z.dot(right_across)) / determinant;
    let drift = Vec3::new(row_x.dot(coupling), row_y.dot(coupling), row_z.dot(coupling)) / determinant;
    let depth = (right_along - coupling.dot(at_axis)) / (stiffness - coupling.dot(drift));
    fallback + size * (at_axis + depth * (axis - drift))
}

/// Returns the paper's centre, eq. (4), (5), with eq. (3) corrected, a naive form; [`fallback`] if
/// all three normals are parallel.
pub fn centre_paper(
    position_a: Vec3,
    normal_a: Vec3,
    position_b: Vec3,
    normal_b: Vec3,
    position_c: Vec3,
    normal_c: Vec3,
) -> Vec3 {
    let weight = Vec3::new(
        normal_a.cross(normal_b).length(),
        normal_b.cross(normal_c).length(),
        normal_c.cross(normal_a).length(),
    );
    let total = weight.x + weight.y + weight.z;
    if total == 0.0 {
        return fallback(position_a, position_b, position_c);
    }
    let point_a = position_a + normal_a * parameters(position_a, normal_a, position_b, normal_b).x;
    let point_b = position_b + normal_b * parameters(position_b, normal_b, position_c, normal_c).x;
    let point_c = position_c + normal_c * parameters(position_c, normal_c, position_a, normal_a).x;
    (weight.x * point_a + weight.y * point_b + weight.z * point_c) / total
}

/// Returns the paper's centre with eq. (3) as printed; a naive form.
pub fn centre_literal(
    position_a: Vec3,
    normal_a: Vec3,
    position_b: Vec3,
    normal_b: Vec3,
    position_c: Vec3,
    normal_c: Vec3,
) -> Vec3 {
    let weight = Vec3::new(
        normal_a.cross(normal_b).length(),
        normal_b.cross(normal_c).length(),
        normal_c.cross(normal_a).length(),
    );
    let point_a = position_a + normal_a * parameters_literal(position_a, normal_a, position_b, normal_b).x;
    let point_b = position_b + normal_b * parameters_literal(position_b, normal_b, position_c, normal_c).x;
    let point_c = position_c + normal_c * parameters_literal(position_c, normal_c, position_a, normal_a).x;
    (weight.x * point_a + weight.y * point_b + weight.z * point_c) / (weight.x + weight.y + weight.z)
}

#[cfg(test)]
mod tests;
