//! The truth in f64. A box is met if the ray crosses one of its faces inside that face's rectangle; a triangle is
//! judged by the signed volumes of tetrahedra and by its plane, without a turned or sheared frame. [`crossings`] is the
//! whole mesh by brute force, without any margin: what [`crate::traversal::trace`] is compared with.

use glam::{DMat3, DVec2, DVec3};

/// What the tests of all boxes and triangles need of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceRay {
    /// Where it starts.
    pub origin: DVec3,
    /// Unit direction.
    pub direction: DVec3,
    /// 1 / direction, at most 2²⁴.
    pub reciprocal: DVec3,
    /// With the direction's components turned so that the largest is z: (x / z, y / z, 1 / z).
    pub shear: DVec3,
    /// Which component that is.
    pub axis: u32,
    /// By how far along an axis the ray may be off.
    pub margin: f64,
}

/// A ray in the coordinates of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceObjectRay {
    /// Where it starts.
    pub origin: DVec3,
    /// Unit direction.
    pub direction: DVec3,
    /// A distance along the ray in the body's coordinates over the same in the world's.
    pub stretch: f64,
}

/// A ray against a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceBox {
    /// Distance at which the ray enters the box; 0 from inside.
    pub entry: f64,
    /// Whether it meets the box before the nearest hit.
    pub hit: bool,
}

/// What a ray has met so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceHit {
    /// Along the ray.
    pub distance: f64,
    /// Weights of the second and the third corner.
    pub barycentrics: DVec2,
    /// [`crate::BVH_TRACE_NONE`] if there is none.
    pub triangle: u32,
}

/// The components by index arithmetic.
pub fn turn(vector: DVec3, axis: u32) -> DVec3 {
    let axis = axis.min(2) as usize;
    DVec3::new(vector[(axis + 1) % 3], vector[(axis + 2) % 3], vector[axis])
}

/// The inverse of [`turn`], by the index that each component came from.
fn turn_back(vector: DVec3, axis: u32) -> DVec3 {
    let axis = axis.min(2) as usize;
    let mut result = DVec3::ZERO;
    for place in 0..3 {
        result[(axis + 1 + place) % 3] = vector[place];
    }
    result
}

/// By the matrix's columns, as the world's axes are turned: the sum of each times a component.
pub fn to_object(
    origin: DVec3,
    direction: DVec3,
    place: DVec3,
    row_x: DVec3,
    row_y: DVec3,
    row_z: DVec3,
) -> BvhTraceObjectRay {
    let columns = DMat3::from_cols(row_x, row_y, row_z).transpose();
    let turned = |v: DVec3| columns.x_axis * v.x + columns.y_axis * v.y + columns.z_axis * v.z;
    let along = turned(direction);
    let stretch = along.x.hypot(along.y).hypot(along.z);
    BvhTraceObjectRay { origin: turned(origin) - turned(place), direction: along / stretch, stretch }
}

/// Shears as tangents of angles, reciprocals by logarithms, the reach over the box's eight corners.
pub fn ray(origin: DVec3, direction: DVec3, lower: DVec3, upper: DVec3) -> BvhTraceRay {
    let reciprocal = DVec3::from(direction.to_array().map(|component| {
        let size = component.abs().max(2f64.powi(-24));
        let exact = (-size.log2()).exp2();
        if component < 0.0 { -exact } else { exact }
    }));
    let axis = (0..3).max_by(|a, b| direction[*a].abs().total_cmp(&direction[*b].abs())).unwrap_or(2);
    let largest = direction[axis];
    let slope = |component: f64| {
        let angle = component.atan2(largest.abs()).tan();
        if largest < 0.0 { -angle } else { angle }
    };
    let axis = axis as u32;
    let turned = turn(direction, axis);
    let shear = DVec3::new(slope(turned.x), slope(turned.y), largest.powi(-1));
    let corners = (0..8).map(|corner| {
        DVec3::from(std::array::from_fn(|axis| if corner >> axis & 1 == 0 { lower[axis] } else { upper[axis] }))
    });
    let reach = corners.map(|corner| (corner - origin).abs().max_element()).fold(0.0, f64::max);
    let margin = 2f64.powi(-18) * reach + 2f64.powi(-21) * origin.abs().max_element();
    BvhTraceRay { origin, direction, reciprocal, shear, axis, margin }
}

/// Every face of the enlarged box in turn: is it crossed within its rectangle? `entry` by the middle and half the width
/// of the slabs.
pub fn r#box(ray: BvhTraceRay, lower: DVec3, upper: DVec3, nearest: f64) -> BvhTraceBox {
    let direction = 1.0 / ray.reciprocal;
    let middle = 0.5 * (lower + upper) - ray.origin;
    let half = 0.5 * (upper - lower) + DVec3::splat(ray.margin);
    let entry =
        (0..3).map(|axis| middle[axis] / direction[axis] - half[axis] / direction[axis].abs()).fold(0.0, f64::max);
    let inside = |distance: f64, but: Option<usize>| {
        (0.0..=nearest).contains(&distance)
            && (0..3).all(|axis| but == Some(axis) || (distance * direction[axis] - middle[axis]).abs() <= half[axis])
    };
    let crosses = (0..3).any(|axis| {
        [-1.0, 1.0].iter().any(|side| inside((middle[axis] + side * half[axis]) / direction[axis], Some(axis)))
    });
    BvhTraceBox { entry, hit: inside(0.0, None) || inside(nearest, None) || crosses }
}

/// Nothing up to a distance.
pub fn start(limit: f64) -> BvhTraceHit {
    BvhTraceHit { distance: limit, barycentrics: DVec2::ZERO, triangle: u32::MAX }
}

/// The direction that a ray's shear stands for, of the length that makes 1 / shear.z its largest component.
fn sheared_direction(ray: &BvhTraceRay) -> DVec3 {
    turn_back(DVec3::new(ray.shear.x, ray.shear.y, 1.0) / ray.shear.z, ray.axis)
}

/// The foot of `position` on the plane through the origin across the ray's axis, along the ray; then how far along it
/// was.
pub fn shear(ray: BvhTraceRay, position: DVec3) -> DVec3 {
    let direction = sheared_direction(&ray);
    let axis = ray.axis.min(2) as usize;
    let offset = position - ray.origin;
    let along = offset[axis] / direction[axis];
    let foot = offset - along * direction;
    DVec3::new(foot[(axis + 1) % 3], foot[(axis + 2) % 3], along)
}

/// Signed volumes: the direction with two corners seen from the origin. The distance is that of the triangle's plane,
/// or where the ray passes beside it, that of the point of the triangle whose weights are those volumes, none below 0.
pub fn triangle(
    hit: BvhTraceHit,
    ray: BvhTraceRay,
    a: DVec3,
    b: DVec3,
    c: DVec3,
    triangle: u32,
    left: u32,
) -> BvhTraceHit {
    let direction = sheared_direction(&ray);
    let axis = ray.axis.min(2) as usize;
    let corners = [a, b, c].map(|corner| corner - ray.origin);
    let normal = (b - a).cross(c - a);
    if triangle == left || normal.dot(direction) <= 0.0 {
        return hit;
    }
    let feet = corners.map(|corner| corner - corner[axis] / direction[axis] * direction);
    let volumes: [f64; 3] = std::array::from_fn(|k| {
        direction.dot(corners[(k + 1) % 3].cross(corners[(k + 2) % 3])) / direction[axis].abs()
    });
    // A foot's component along the axis is 0, so sums and maxima of components are those of the plane.
    for k in 0..3 {
        let mut edge = feet[(k + 2) % 3] - feet[(k + 1) % 3];
        edge[axis] = 0.0;
        if volumes[k] < -ray.margin * edge.abs().element_sum() {
            return hit;
        }
    }
    for other in (0..3).filter(|other| *other != axis) {
        let least = feet.iter().map(|foot| foot[other]).fold(f64::INFINITY, f64::min);
        let greatest = feet.iter().map(|foot| foot[other]).fold(f64::NEG_INFINITY, f64::max);
        if least > ray.margin || greatest < -ray.margin {
            return hit;
        }
    }
    let weights = volumes.map(|volume| volume.max(0.0));
    let total: f64 = weights.iter().sum();
    // How high the plane stands over the origin, times its normal, and the same at a point of the triangle beside the
    // ray.
    let (height, slope) = if volumes.iter().all(|volume| *volume >= 0.0) {
        (normal.dot(corners[0]), normal.dot(direction))
    } else {
        let point: DVec3 = (0..3).map(|k| weights[k] * corners[k]).sum();
        (point[axis] * direction[axis].signum(), total * direction[axis].abs())
    };
    let distance = (height / slope).max(0.0);
    // Along the frame's axes, which are two coordinate axes and the direction, a plane is met at height / slope.
    let slopes: f64 = (0..3).filter(|other| *other != axis).map(|other| normal[other].abs()).sum();
    if height < -ray.margin * (slopes + normal.dot(direction))
        || distance > hit.distance
        || (distance == hit.distance && triangle > hit.triangle)
    {
        return hit;
    }
    BvhTraceHit { distance, barycentrics: DVec2::new(weights[1], weights[2]) / total, triangle }
}

/// The plane of the triangle, and the winding of its edges about the point where the ray meets it; with the epsilon
/// that the naive form has for the determinant and for the distance.
pub fn triangle_naive(
    hit: BvhTraceHit,
    ray: BvhTraceRay,
    a: DVec3,
    b: DVec3,
    c: DVec3,
    triangle: u32,
    left: u32,
) -> BvhTraceHit {
    let epsilon = f64::from(crate::BVH_TRACE_NAIVE_EPSILON);
    let normal = (b - a).cross(c - a);
    let slope = normal.dot(ray.direction);
    if triangle == left || slope < epsilon {
        return hit;
    }
    let distance = normal.dot(a - ray.origin) / slope;
    let point = ray.origin + distance * ray.direction;
    let weight = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(normal) / normal.length_squared();
    let (v, w, u) = (weight(c, a), weight(a, b), weight(b, c));
    if u < 0.0 || v < 0.0 || w < 0.0 || distance < epsilon || distance > hit.distance {
        return hit;
    }
    BvhTraceHit { distance, barycentrics: DVec2::new(v, w), triangle }
}

/// A triangle that the line of a ray leaves the solid through, or passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Its number.
    pub triangle: u32,
    /// Where the ray meets its plane.
    pub distance: f64,
    /// How far inside the triangle's outline, seen along the ray, the ray passes; negative outside of it.
    pub clearance: f64,
}

/// The triangle `corners` as the line sees it; none where it is edge-on or the ray enters the solid through it.
pub fn crossing(corners: [DVec3; 3], triangle: u32, origin: DVec3, direction: DVec3) -> Option<Crossing> {
    let direction = direction.normalize();
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    if normal.dot(direction) <= 0.0 {
        return None;
    }
    let distance = normal.dot(a - origin) / normal.dot(direction);
    let across = corners.map(|corner| (corner - origin) - (corner - origin).dot(direction) * direction);
    let mut inside = f64::INFINITY;
    let mut nearest = f64::INFINITY;
    for k in 0..3 {
        let (from, to) = (across[k], across[(k + 1) % 3]);
        let edge = to - from;
        // A triangle that the ray leaves through winds counter-clockwise about its direction: left of each edge is
        // inside.
        let height = direction.dot(from.cross(to)) / edge.length().max(f64::MIN_POSITIVE);
        inside = inside.min(height);
        let share = (-from.dot(edge) / edge.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        nearest = nearest.min((from + share * edge).length());
    }
    Some(Crossing { triangle, distance, clearance: if inside >= 0.0 { inside } else { -nearest } })
}

/// Every triangle of a mesh that the line leaves the solid through at a clearance of more than `-bound`, but for
/// `left`.
pub fn crossings(
    positions: &[DVec3],
    indices: &[u32],
    origin: DVec3,
    direction: DVec3,
    left: u32,
    bound: f64,
) -> Vec<Crossing> {
    indices
        .chunks_exact(3)
        .zip(0..)
        .filter(|(_, triangle)| *triangle != left)
        .filter_map(|(corners, triangle)| {
            let corners = [0, 1, 2].map(|k| positions[corners[k] as usize]);
            crossing(corners, triangle, origin, direction)
        })
        .filter(|crossing| crossing.clearance > -bound)
        .collect()
}
