//! The oracle in f64: orthogonal projections for two lines, the altitude on the longest edge for
//! the fallback point, and for the centre a stacked least-squares problem solved by Householder
//! reflections. A line has the direction of its normal, whatever the length of that vector; its
//! parameter counts in units of the vector as given.

use glam::{DVec2, DVec3};

// The two constants of the module, written out again so that an error in the module does not carry
// over to the oracle.
const REGULARISATION: f64 = 1.0 / 4096.0;
const SLIVER: f64 = 1.0 / 1024.0;

/// Returns the largest magnitude of a vector's components: the norm for p = infinity.
pub fn largest_component(vector: DVec3) -> f64 {
    vector.to_array().into_iter().map(f64::abs).fold(0.0, f64::max)
}

/// Returns the unit direction of a vector, 0 for the zero vector: squares of f32 values neither
/// underflow nor overflow in f64.
pub fn direction(vector: DVec3) -> DVec3 {
    vector.normalize_or_zero()
}

/// Returns the parameters of the closest points of two lines. With s = (t_i + t_j) / 2 and
/// d = t_i - t_j the separation is x - s (n_i - n_j) - d (n_i + n_j) / 2, whose two directions are
/// nearly orthogonal at every angle. x is projected onto one direction, then onto the remainder of
/// the other. Parallel normals, whose cross product is exactly 0 in f64 for f32 values, give
/// (0, 0).
pub fn parameters(origin_i: DVec3, normal_i: DVec3, origin_j: DVec3, normal_j: DVec3) -> DVec2 {
    if normal_i.cross(normal_j) == DVec3::ZERO {
        return DVec2::ZERO;
    }
    let x = origin_j - origin_i;
    let difference = normal_i - normal_j;
    let mean = 0.5 * (normal_i + normal_j);
    let along = mean.normalize();
    let rest = difference - difference.dot(along) * along;
    let s = x.dot(rest) / rest.length_squared();
    let d = (x - s * difference).dot(along) / mean.length();
    DVec2::new(s + 0.5 * d, s - 0.5 * d)
}

/// Returns [`parameters`]: the same function, computed badly by the mirror.
pub fn parameters_dot(origin_i: DVec3, normal_i: DVec3, origin_j: DVec3, normal_j: DVec3) -> DVec2 {
    parameters(origin_i, normal_i, origin_j, normal_j)
}

/// Returns the result of eq. (3) as printed: the two parameters, swapped.
pub fn parameters_literal(origin_i: DVec3, normal_i: DVec3, origin_j: DVec3, normal_j: DVec3) -> DVec2 {
    let t = parameters(origin_i, normal_i, origin_j, normal_j);
    DVec2::new(t.y, t.x)
}

/// Returns the triangle's longest edge and the altitude on it.
fn longest_edge_and_altitude(position_a: DVec3, position_b: DVec3, position_c: DVec3) -> (DVec3, DVec3) {
    let turns = [
        (position_a, position_b, position_c),
        (position_b, position_c, position_a),
        (position_c, position_a, position_b),
    ];
    let (start, end, apex) =
        turns.into_iter().max_by(|p, q| p.0.distance(p.1).total_cmp(&q.0.distance(q.1))).expect("three turns");
    let edge = end - start;
    (edge, (apex - start).reject_from(edge))
}

/// Returns the fallback point: from the centroid along -(edge × altitude), at a distance equal to
/// the longest edge, times the sine of the angle whose tangent is the altitude divided by 1/1024 of
/// the longest edge.
pub fn fallback(position_a: DVec3, position_b: DVec3, position_c: DVec3) -> DVec3 {
    let centroid = (position_a + position_b + position_c) / 3.0;
    if position_a == position_b && position_b == position_c {
        return position_a;
    }
    let (edge, altitude) = longest_edge_and_altitude(position_a, position_b, position_c);
    let fade = altitude.length().atan2(SLIVER * edge.length()).sin();
    centroid - fade * edge.cross(altitude.normalize_or_zero())
}

/// Returns the fallback point without the fade; it differs from [`fallback`] for slivers.
pub fn fallback_naive(position_a: DVec3, position_b: DVec3, position_c: DVec3) -> DVec3 {
    let (edge, altitude) = longest_edge_and_altitude(position_a, position_b, position_c);
    (position_a + position_b + position_c) / 3.0 - edge.cross(altitude.normalize())
}

/// Returns the centre, as the least-squares solution of the twelve equations (I - n nᵀ)(o - x) = 0
/// and √λ (o - p) = 0. The smallest singular value is √λ, so the condition number is 111; for the
/// normal equations it would be the square of 111.
pub fn centre(
    position_a: DVec3,
    normal_a: DVec3,
    position_b: DVec3,
    normal_b: DVec3,
    position_c: DVec3,
    normal_c: DVec3,
) -> DVec3 {
    let fallback = fallback(position_a, position_b, position_c);
    let mut rows = Vec::new();
    for (position, normal) in [(position_a, normal_a), (position_b, normal_b), (position_c, normal_c)] {
        for axis in DVec3::AXES {
            let row = axis.reject_from(normal);
            rows.push([row.x, row.y, row.z, row.dot(position - fallback)]);
        }
    }
    let pull = REGULARISATION.sqrt();
    for axis in DVec3::AXES {
        rows.push([pull * axis.x, pull * axis.y, pull * axis.z, 0.0]);
    }
    fallback + least_squares(rows)
}

/// Returns the least-squares solution of rows `[a_x, a_y, a_z | b]` of full rank, by Householder
/// reflections.
fn least_squares(mut rows: Vec<[f64; 4]>) -> DVec3 {
    for k in 0..3 {
        let norm = rows[k..].iter().map(|row| row[k] * row[k]).sum::<f64>().sqrt();
        let mut mirror: Vec<f64> = rows[k..].iter().map(|row| row[k]).collect();
        mirror[0] += norm.copysign(mirror[0]);
        let mirror_squared: f64 = mirror.iter().map(|v| v * v).sum();
        for column in k..4 {
            let product: f64 = mirror.iter().zip(&rows[k..]).map(|(v, row)| v * row[column]).sum();
            for (v, row) in mirror.iter().zip(&mut rows[k..]) {
                row[column] -= 2.0 * product / mirror_squared * v;
            }
        }
    }
    let z = rows[2][3] / rows[2][2];
    let y = (rows[1][3] - rows[1][2] * z) / rows[1][1];
    let x = (rows[0][3] - rows[0][1] * y - rows[0][2] * z) / rows[0][0];
    DVec3::new(x, y, z)
}

/// Evaluates eq. (4), (5) with the closest points of one pair of lines per vertex, and weights
/// |n_i| |n_k| sin(angle).
fn weighted_points(parameters: fn(DVec3, DVec3, DVec3, DVec3) -> DVec2, lines: [(DVec3, DVec3); 3]) -> Option<DVec3> {
    let mut total = 0.0;
    let mut sum = DVec3::ZERO;
    for i in 0..3 {
        let (origin, normal) = lines[i];
        let (next_origin, next_normal) = lines[(i + 1) % 3];
        let weight = normal.length() * next_normal.length() * normal.angle_between(next_normal).sin();
        total += weight;
        sum += weight * (origin + normal * parameters(origin, normal, next_origin, next_normal).x);
    }
    (total > 0.0).then(|| sum / total)
}

/// Returns the paper's centre with eq. (3) corrected.
pub fn centre_paper(
    position_a: DVec3,
    normal_a: DVec3,
    position_b: DVec3,
    normal_b: DVec3,
    position_c: DVec3,
    normal_c: DVec3,
) -> DVec3 {
    weighted_points(parameters, [(position_a, normal_a), (position_b, normal_b), (position_c, normal_c)])
        .unwrap_or_else(|| fallback(position_a, position_b, position_c))
}

/// Returns the paper's centre with eq. (3) as printed; defined unless all normals are parallel.
pub fn centre_literal(
    position_a: DVec3,
    normal_a: DVec3,
    position_b: DVec3,
    normal_b: DVec3,
    position_c: DVec3,
    normal_c: DVec3,
) -> DVec3 {
    weighted_points(parameters_literal, [(position_a, normal_a), (position_b, normal_b), (position_c, normal_c)])
        .unwrap_or(DVec3::ZERO)
}
