//! Mirror of `wgsl/bvh_trace.wgsl`: rays inside a closed mesh of any shape, against triangles and
//! the boxes of a bounding volume hierarchy, without leaks. After Woop, Benthin and Wald 2013 and
//! Ize 2013.
//!
//! The WGSL file states the units, domain and accuracy of each function. This file follows it line
//! by line. [`traversal`] mirrors the part `wgsl/recipes/parts/trace_nearest.wgsl`, and [`Bvh`] builds
//! the nodes that it reads.
//!
//! ```
//! use glam::{Vec3, vec3};
//! use lapidary_bvh_trace::{ray, start, triangle};
//!
//! let (lower, upper) = (Vec3::ZERO, vec3(1.0, 1.0, 1.0));
//! let ray = ray(vec3(0.25, 0.25, 0.0), Vec3::Z, lower, upper);
//! // Triangle 7 of a mesh, seen from inside.
//! let hit = triangle(start(1e30), ray, Vec3::Z, vec3(1.0, 0.0, 1.0), vec3(0.0, 1.0, 1.0), 7, u32::MAX);
//! assert_eq!((hit.triangle, hit.distance), (7, 1.0));
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
mod hierarchy;
pub mod oracle;
pub mod traversal;

pub use hierarchy::Bvh;

#[cfg(test)]
mod tests;

use glam::{UVec3, UVec4, Vec2, Vec3};

/// Factor of the margin on the mesh's largest distance from the origin along an axis, 2⁻¹⁸.
pub const BVH_TRACE_MARGIN_REACH: f32 = 3.814697265625e-6;
/// Factor of the margin on the origin's largest coordinate, 2⁻²¹.
pub const BVH_TRACE_MARGIN_ORIGIN: f32 = 4.76837158203125e-7;

/// The usual epsilon, used by [`triangle_naive`].
pub const BVH_TRACE_NAIVE_EPSILON: f32 = 1e-6;

/// Triangle index that stands for "no hit".
pub const BVH_TRACE_NONE: u32 = 0xffffffff;

/// A node of a hierarchy: up to four children, and their boxes in steps from a corner, rounded
/// outwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceNode {
    /// Corner from which the steps are counted.
    pub corner: Vec3,
    /// Three bytes, from the lowest: the exponents of the steps along x, y and z, as in the bits of
    /// an f32.
    pub steps: u32,
    /// Lower sides of the boxes along x, y and z: a byte for each child, from the lowest.
    pub lower: UVec3,
    /// Upper sides, likewise.
    pub upper: UVec3,
    /// What each child is: the number of a node, below 2³⁰; or a leaf, its number of triangles, 1
    /// to 3, in the two highest bits and its first triangle in the others; or [`BVH_TRACE_NONE`].
    pub children: UVec4,
}

/// The box of a child.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceExtent {
    /// Lower corner.
    pub lower: Vec3,
    /// Upper corner.
    pub upper: Vec3,
}

/// Ray data shared by all box and triangle tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceRay {
    /// Start of the ray.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
    /// 1 / direction by component, at most 2²⁴ in magnitude.
    pub reciprocal: Vec3,
    /// (x / z, y / z, 1 / z) of the direction, its components permuted so that the largest is z.
    pub shear: Vec3,
    /// Index of the direction's largest component.
    pub axis: u32,
    /// Bound on the error of the ray along an axis, as a length, including the rounding of the
    /// origin.
    pub margin: f32,
}

/// A ray in the coordinates of a body (object space).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceObjectRay {
    /// Start of the ray.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
    /// Distance along the ray in the body's coordinates, divided by the same distance in the world.
    pub stretch: f32,
}

/// Result of a box test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceBox {
    /// Distance at which the ray enters the box; 0 if it starts inside.
    pub entry: f32,
    /// True if the ray meets the box before the nearest hit.
    pub hit: bool,
}

/// Nearest hit of a ray so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhTraceHit {
    /// Distance along the ray.
    pub distance: f32,
    /// Weights of the second and the third corner, in [0, 1].
    pub barycentrics: Vec2,
    /// Index of the triangle; [`BVH_TRACE_NONE`] for no hit.
    pub triangle: u32,
}

/// Permutes the components of a vector cyclically so that component `axis` becomes z.
pub fn turn(vector: Vec3, axis: u32) -> Vec3 {
    let x_or_y =
        if axis == 0 { Vec3::new(vector.y, vector.z, vector.x) } else { Vec3::new(vector.z, vector.x, vector.y) };
    if axis < 2 { x_or_y } else { vector }
}

/// Transforms a ray from world space to the coordinates of a body.
pub fn to_object(
    origin: Vec3,
    direction: Vec3,
    place: Vec3,
    row_x: Vec3,
    row_y: Vec3,
    row_z: Vec3,
) -> BvhTraceObjectRay {
    let offset = origin - place;
    let turned = Vec3::new(row_x.dot(direction), row_y.dot(direction), row_z.dot(direction));
    let size = turned.x.abs().max(turned.y.abs().max(turned.z.abs()));
    let scaled = turned / size;
    let length_of_scaled = scaled.dot(scaled).sqrt();
    BvhTraceObjectRay {
        origin: Vec3::new(row_x.dot(offset), row_y.dot(offset), row_z.dot(offset)),
        direction: scaled / length_of_scaled,
        stretch: size * length_of_scaled,
    }
}

/// Returns the ray data shared by all box and triangle tests, computed once per ray.
pub fn ray(origin: Vec3, direction: Vec3, lower: Vec3, upper: Vec3) -> BvhTraceRay {
    let toward = Vec3::select(direction.cmpge(Vec3::ZERO), Vec3::ONE, Vec3::NEG_ONE);
    let size = direction.abs();
    // A component below 2⁻²⁴ is replaced by that value, so its reciprocal is finite. The ray then
    // strays by less than 2⁻²³ of the mesh while crossing it, which the margin covers.
    let reciprocal = toward / size.max(Vec3::splat(5.9604644775390625e-8));
    let largest = size.x.max(size.y.max(size.z));
    let y_or_x = if size.y == largest { 1 } else { 0 };
    let axis = if size.z == largest { 2 } else { y_or_x };
    let turned = turn(direction, axis);
    let shear = Vec3::new(turned.x, turned.y, 1.0) / turned.z;
    let reach = (lower - origin).abs().max((upper - origin).abs());
    let place = origin.abs();
    let margin = BVH_TRACE_MARGIN_REACH * reach.x.max(reach.y.max(reach.z))
        + BVH_TRACE_MARGIN_ORIGIN * place.x.max(place.y.max(place.z));
    BvhTraceRay { origin, direction, reciprocal, shear, axis, margin }
}

/// Returns the box of a child of a node; for a place without a child, the node's corner twice.
pub fn child_box(node: BvhTraceNode, child: u32) -> BvhTraceExtent {
    let exponents = [0, 8, 16].map(|place| (node.steps >> place) & 255);
    let step = Vec3::from_array(exponents.map(|exponent| f32::from_bits(exponent << 23)));
    let place = 8 * (child & 3);
    // A product with a power of two is exact, so only the sum rounds.
    let lower = node.corner + ((node.lower >> place) & 255).as_vec3() * step;
    let upper = node.corner + ((node.upper >> place) & 255).as_vec3() * step;
    BvhTraceExtent { lower, upper }
}

/// Returns the box around all children of a node; around the whole mesh if the node is the root.
pub fn bounds(node: BvhTraceNode) -> BvhTraceExtent {
    let a = child_box(node, 0);
    let b = child_box(node, 1);
    let c = child_box(node, 2);
    let d = child_box(node, 3);
    BvhTraceExtent {
        lower: a.lower.min(b.lower).min(c.lower.min(d.lower)),
        upper: a.upper.max(b.upper).max(c.upper.max(d.upper)),
    }
}

/// Tests whether a ray meets a box, enlarged by the ray's margin on all sides, at a distance in
/// [0, nearest].
pub fn r#box(ray: BvhTraceRay, lower: Vec3, upper: Vec3, nearest: f32) -> BvhTraceBox {
    let first = (lower - ray.origin - ray.margin) * ray.reciprocal;
    let second = (upper - ray.origin + ray.margin) * ray.reciprocal;
    let enter = first.min(second);
    let leave = first.max(second);
    let entry = enter.x.max(enter.y).max(enter.z.max(0.0));
    let exit = leave.x.min(leave.y).min(leave.z.min(nearest));
    BvhTraceBox { entry, hit: entry <= exit }
}

/// Performs the usual slab test.
pub fn box_naive(ray: BvhTraceRay, lower: Vec3, upper: Vec3, nearest: f32) -> BvhTraceBox {
    let inverse = 1.0 / ray.direction;
    let first = (lower - ray.origin) * inverse;
    let second = (upper - ray.origin) * inverse;
    let enter = first.min(second);
    let leave = first.max(second);
    let entry = enter.x.max(enter.y).max(enter.z.max(0.0));
    let exit = leave.x.min(leave.y).min(leave.z.min(nearest));
    BvhTraceBox { entry, hit: entry <= exit }
}

/// Returns the initial hit record of a ray, before its first triangle: no hit up to the distance
/// `limit`.
pub fn start(limit: f32) -> BvhTraceHit {
    BvhTraceHit { distance: limit, barycentrics: Vec2::ZERO, triangle: BVH_TRACE_NONE }
}

/// Returns a position in the frame of a ray: the ray is the z axis, and x and y are two of the
/// coordinate axes.
pub fn shear(ray: BvhTraceRay, position: Vec3) -> Vec3 {
    let turned = turn(position - ray.origin, ray.axis);
    (turned.truncate() - ray.shear.truncate() * turned.z).extend(turned.z * ray.shear.z)
}

/// Returns the nearer of `hit` and a hit with the triangle a b c, if the ray leaves the solid
/// through it.
pub fn triangle(
    hit: BvhTraceHit,
    ray: BvhTraceRay,
    a: Vec3,
    b: Vec3,
    c: Vec3,
    triangle: u32,
    left: u32,
) -> BvhTraceHit {
    let p = shear(ray, a);
    let q = shear(ray, b);
    let r = shear(ray, c);
    let qr = r - q;
    let rp = p - r;
    let pq = q - p;
    // Twice the areas spanned by the origin and the edges opposite a, b, c. Each is computed from the
    // nearer end of its edge: the error of an area is the distance of that end times the edge. If the
    // direction's largest component is negative, the frame is seen against the ray, and the sign changes.
    let squared =
        Vec3::new(p.truncate().length_squared(), q.truncate().length_squared(), r.truncate().length_squared());
    let on_qr = if squared.z < squared.y { r } else { q };
    let on_rp = if squared.x < squared.z { p } else { r };
    let on_pq = if squared.y < squared.x { q } else { p };
    let spanned =
        Vec3::new(on_qr.x * qr.y - on_qr.y * qr.x, on_rp.x * rp.y - on_rp.y * rp.x, on_pq.x * pq.y - on_pq.y * pq.x);
    let area = ray.shear.z.signum() * spanned;
    if triangle == left || area.x + area.y + area.z <= 0.0 {
        return hit;
    }
    // Distance from an edge times the length of the edge, both measured along the axes: the
    // distance as the largest component, the length as the sum of the components.
    let give = ray.margin * Vec3::new(qr.x.abs() + qr.y.abs(), rp.x.abs() + rp.y.abs(), pq.x.abs() + pq.y.abs());
    let lower = p.truncate().min(q.truncate()).min(r.truncate());
    let upper = p.truncate().max(q.truncate()).max(r.truncate());
    if area.cmplt(-give).any()
        || lower.cmpgt(Vec2::splat(ray.margin)).any()
        || upper.cmplt(Vec2::splat(-ray.margin)).any()
    {
        return hit;
    }
    let weight = area.max(Vec3::ZERO);
    let total = weight.x + weight.y + weight.z;
    // Distance from the plane times its normal, measured in the same way as the distance from an
    // edge. Divided by `total` it is the distance along the ray, but measured that way a plane
    // close to the origin may be far behind it, if the ray meets it at a shallow angle.
    let height = weight.x * p.z + weight.y * q.z + weight.z * r.z;
    let normal = qr.cross(rp).abs();
    let distance = (height / total).max(0.0);
    if height < -ray.margin * (normal.x + normal.y + normal.z)
        || distance > hit.distance
        || (distance == hit.distance && triangle > hit.triangle)
    {
        return hit;
    }
    BvhTraceHit { distance, barycentrics: Vec2::new(weight.y, weight.z) / total, triangle }
}

/// Performs the usual triangle test, Möller and Trumbore's, with an epsilon.
pub fn triangle_naive(
    hit: BvhTraceHit,
    ray: BvhTraceRay,
    a: Vec3,
    b: Vec3,
    c: Vec3,
    triangle: u32,
    left: u32,
) -> BvhTraceHit {
    let edge_b = b - a;
    let edge_c = c - a;
    let across = ray.direction.cross(edge_c);
    let determinant = -edge_b.dot(across);
    if triangle == left || determinant < BVH_TRACE_NAIVE_EPSILON {
        return hit;
    }
    let offset = a - ray.origin;
    let around = offset.cross(edge_b);
    let u = offset.dot(across) / determinant;
    let v = ray.direction.dot(around) / determinant;
    let distance = edge_c.dot(around) / determinant;
    if u < 0.0 || v < 0.0 || u + v > 1.0 || distance < BVH_TRACE_NAIVE_EPSILON || distance > hit.distance {
        return hit;
    }
    BvhTraceHit { distance, barycentrics: Vec2::new(u, v), triangle }
}
