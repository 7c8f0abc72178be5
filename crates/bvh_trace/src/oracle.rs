//! The oracle in f64. A box is hit if the ray crosses one of its faces inside that face's
//! rectangle. A triangle is judged by the signed volumes of tetrahedra and by its plane, without a
//! permuted or sheared frame. [`crossings`] tests the whole mesh by brute force, without any
//! margin; it is the reference for [`crate::traversal::trace`].

use glam::{DMat3, DVec2, DVec3, UVec3, UVec4};

/// Ray data shared by all box and triangle tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceRay {
    /// Start of the ray.
    pub origin: DVec3,
    /// Unit direction.
    pub direction: DVec3,
    /// 1 / direction by component, at most 2²⁴ in magnitude.
    pub reciprocal: DVec3,
    /// (x / z, y / z, 1 / z) of the direction, its components permuted so that the largest is z.
    pub shear: DVec3,
    /// Index of the direction's largest component.
    pub axis: u32,
    /// Bound on the error of the ray along an axis, as a length.
    pub margin: f64,
}

/// A ray in the coordinates of a body (object space).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceObjectRay {
    /// Start of the ray.
    pub origin: DVec3,
    /// Unit direction.
    pub direction: DVec3,
    /// Distance along the ray in the body's coordinates, divided by the same distance in the world.
    pub stretch: f64,
}

/// A node, with the exact corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceNode {
    /// Corner from which the steps are counted.
    pub corner: DVec3,
    /// Exponents of the steps.
    pub steps: u32,
    /// Lower sides of the boxes, a byte for each child.
    pub lower: UVec3,
    /// Upper sides, likewise.
    pub upper: UVec3,
    /// What each child is.
    pub children: UVec4,
}

/// The box of a child.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceExtent {
    /// Lower corner.
    pub lower: DVec3,
    /// Upper corner.
    pub upper: DVec3,
}

/// Result of a box test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceBox {
    /// Distance at which the ray enters the box; 0 if it starts inside.
    pub entry: f64,
    /// True if the ray meets the box before the nearest hit.
    pub hit: bool,
}

/// Nearest hit of a ray so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceHit {
    /// Distance along the ray.
    pub distance: f64,
    /// Weights of the second and the third corner, in [0, 1].
    pub barycentrics: DVec2,
    /// Index of the triangle; [`crate::BVH_TRACE_NONE`] for no hit.
    pub triangle: u32,
}

/// Permutes the components by index arithmetic.
pub fn turn(vector: DVec3, axis: u32) -> DVec3 {
    let axis = axis.min(2) as usize;
    DVec3::new(vector[(axis + 1) % 3], vector[(axis + 2) % 3], vector[axis])
}

/// Inverts [`turn`], from the index at which each component came in.
fn turn_back(vector: DVec3, axis: u32) -> DVec3 {
    let axis = axis.min(2) as usize;
    let mut result = DVec3::ZERO;
    for place in 0..3 {
        result[(axis + 1 + place) % 3] = vector[place];
    }
    result
}

/// Transforms by the columns of the matrix, the images of the world's axes: the sum of each column
/// times a component.
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

/// Computes shears as tangents of angles, reciprocals with logarithms, and the reach over the eight
/// corners of the box.
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

/// Tests each face of the enlarged box for a crossing within its rectangle. `entry` is computed
/// from the middle and half the width of the slabs.
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

/// Returns the box of a child, axis by axis, with powers of two for the steps.
pub fn child_box(node: BvhTraceNode, child: u32) -> BvhTraceExtent {
    let side = |words: UVec3, axis: usize| {
        let step = 2f64.powi(i32::from(node.steps.to_le_bytes()[axis]) - 127);
        node.corner[axis] + f64::from(words[axis].to_le_bytes()[child as usize % 4]) * step
    };
    let corner = |words: UVec3| DVec3::from_array([0, 1, 2].map(|axis| side(words, axis)));
    BvhTraceExtent { lower: corner(node.lower), upper: corner(node.upper) }
}

/// Returns the box around all children.
pub fn bounds(node: BvhTraceNode) -> BvhTraceExtent {
    let all = (0..4).map(|child| child_box(node, child));
    let empty = BvhTraceExtent { lower: DVec3::INFINITY, upper: DVec3::NEG_INFINITY };
    all.fold(empty, |a, b| BvhTraceExtent { lower: a.lower.min(b.lower), upper: a.upper.max(b.upper) })
}

/// Returns a record without a hit, up to a distance.
pub fn start(limit: f64) -> BvhTraceHit {
    BvhTraceHit { distance: limit, barycentrics: DVec2::ZERO, triangle: u32::MAX }
}

/// Returns the direction that a ray's shear encodes, with 1 / shear.z as its largest component.
fn sheared_direction(ray: &BvhTraceRay) -> DVec3 {
    turn_back(DVec3::new(ray.shear.x, ray.shear.y, 1.0) / ray.shear.z, ray.axis)
}

/// Projects `position` along the ray onto the plane through the origin perpendicular to the ray's
/// axis. Returns the foot point, and the distance along the ray.
pub fn shear(ray: BvhTraceRay, position: DVec3) -> DVec3 {
    let direction = sheared_direction(&ray);
    let axis = ray.axis.min(2) as usize;
    let offset = position - ray.origin;
    let along = offset[axis] / direction[axis];
    let foot = offset - along * direction;
    DVec3::new(foot[(axis + 1) % 3], foot[(axis + 2) % 3], along)
}

/// Computes signed volumes, spanned by the direction and two corners seen from the origin. The
/// distance is measured to the triangle's plane. If the ray passes beside the triangle, it is
/// measured to the point of the triangle whose weights are those volumes, with negative volumes
/// counted as 0.
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
    // The component of a foot along the axis is 0, so sums and maxima of components are those in
    // the plane.
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
    // Height of the plane over the origin, times its normal. If the ray passes beside the triangle,
    // the height at a point of the triangle instead.
    let (height, slope) = if volumes.iter().all(|volume| *volume >= 0.0) {
        (normal.dot(corners[0]), normal.dot(direction))
    } else {
        let point: DVec3 = (0..3).map(|k| weights[k] * corners[k]).sum();
        (point[axis] * direction[axis].signum(), total * direction[axis].abs())
    };
    let distance = (height / slope).max(0.0);
    // Along the axes of the frame, which are two coordinate axes and the direction, the plane is
    // met at height / slope.
    let slopes: f64 = (0..3).filter(|other| *other != axis).map(|other| normal[other].abs()).sum();
    if height < -ray.margin * (slopes + normal.dot(direction))
        || distance > hit.distance
        || (distance == hit.distance && triangle > hit.triangle)
    {
        return hit;
    }
    BvhTraceHit { distance, barycentrics: DVec2::new(weights[1], weights[2]) / total, triangle }
}

/// Intersects the plane of the triangle and tests the winding of its edges around the intersection
/// point, with the naive form's epsilon for the determinant and for the distance.
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

/// A triangle through which the line of a ray leaves the solid, or which the line passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Index of the triangle.
    pub triangle: u32,
    /// Distance along the ray to the triangle's plane.
    pub distance: f64,
    /// Distance of the ray from the triangle's outline, seen along the ray; positive inside,
    /// negative outside.
    pub clearance: f64,
}

/// Returns the triangle `corners` as the line sees it; `None` if it is edge-on or the ray enters
/// the solid through it.
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
        // A triangle through which the ray leaves winds counter-clockwise around the ray's
        // direction: the inside is to the left of each edge.
        let height = direction.dot(from.cross(to)) / edge.length().max(f64::MIN_POSITIVE);
        inside = inside.min(height);
        let share = (-from.dot(edge) / edge.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        nearest = nearest.min((from + share * edge).length());
    }
    Some(Crossing { triangle, distance, clearance: if inside >= 0.0 { inside } else { -nearest } })
}

/// Returns every triangle of a mesh, except `left`, through which the line leaves the solid with a
/// clearance of more than `-bound`.
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
