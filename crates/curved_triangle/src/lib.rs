//! Mirror of `wgsl/curved_triangle.wgsl`: where a ray that meets a triangle meets the curved surface that the normals
//! at its corners describe. After Boubekeur and Alexa, "Phong Tessellation".
//!
//! The WGSL file states the units, domain and accuracy of each function. This file follows it line by line.
//!
//! ```
//! use glam::{Vec2, Vec3};
//! use lapidary_curved_triangle::{CurvedTriangle, meet};
//!
//! // A ray onto the middle of an octahedron's face, with the normals of the sphere around it.
//! let (a, b, c) = (Vec3::X, Vec3::Y, Vec3::Z);
//! let triangle = CurvedTriangle { a, b, c, normal_a: a, normal_b: b, normal_c: c };
//! let (middle, outward) = (Vec3::splat(1.0 / 3.0), Vec3::ONE.normalize());
//! let hit = meet(triangle, Vec2::splat(1.0 / 3.0), middle, -outward, outward);
//! assert!(hit.position.length() > 0.76 && middle.length() < 0.58);
//! assert!(hit.normal.distance(outward) < 1e-6);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;
#[cfg(test)]
mod tests;

use glam::{Vec2, Vec3};

/// Cosine of the angle of incidence below which a ray is not followed further.
pub const CURVED_TRIANGLE_GRAZING: f32 = 0.2;
/// Squared length of an interpolated normal below which it has no direction.
pub const CURVED_TRIANGLE_CANCELLED: f32 = 1e-6;

/// A triangle with normals at its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvedTriangle {
    /// The first corner.
    pub a: Vec3,
    /// The second corner.
    pub b: Vec3,
    /// The third corner.
    pub c: Vec3,
    /// Unit normal at `a`; 0 where there is none.
    pub normal_a: Vec3,
    /// Unit normal at `b`; 0 where there is none.
    pub normal_b: Vec3,
    /// Unit normal at `c`; 0 where there is none.
    pub normal_c: Vec3,
}

/// A place on a curved surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvedTriangleHit {
    /// The position.
    pub position: Vec3,
    /// Unit normal.
    pub normal: Vec3,
}

/// Returns the height of the curved surface above the triangle, along `outward`.
pub fn height(triangle: CurvedTriangle, barycentrics: Vec2, outward: Vec3) -> f32 {
    let edge_b = triangle.b - triangle.a;
    let edge_c = triangle.c - triangle.a;
    let rise_a = triangle.normal_a.dot(outward) * triangle.normal_a;
    let rise_b = triangle.normal_b.dot(outward) * triangle.normal_b;
    let rise_c = triangle.normal_c.dot(outward) * triangle.normal_c;
    let way_b = (1.0 - barycentrics.x) * edge_b - barycentrics.y * edge_c;
    let way_c = (1.0 - barycentrics.y) * edge_c - barycentrics.x * edge_b;
    // The weighted ways to the corners add up to 0, so rise_a may be taken from all three rises.
    let mean = barycentrics.x * way_b.dot(rise_b - rise_a) + barycentrics.y * way_c.dot(rise_c - rise_a);
    0.5 * mean
}

/// Returns the same from the tangent planes' equations.
pub fn height_naive(triangle: CurvedTriangle, barycentrics: Vec2, outward: Vec3) -> f32 {
    let first = 1.0 - barycentrics.x - barycentrics.y;
    let point = first * triangle.a + barycentrics.x * triangle.b + barycentrics.y * triangle.c;
    let above_a = triangle.normal_a.dot(triangle.a) - triangle.normal_a.dot(point);
    let above_b = triangle.normal_b.dot(triangle.b) - triangle.normal_b.dot(point);
    let above_c = triangle.normal_c.dot(triangle.c) - triangle.normal_c.dot(point);
    let mean = first * above_a * triangle.normal_a.dot(outward)
        + barycentrics.x * above_b * triangle.normal_b.dot(outward)
        + barycentrics.y * above_c * triangle.normal_c.dot(outward);
    0.5 * mean
}

/// Returns the weights of b and c at an offset from a, or what an offset adds to them.
pub fn weights(triangle: CurvedTriangle, offset: Vec3) -> Vec2 {
    let edge_b = triangle.b - triangle.a;
    let edge_c = triangle.c - triangle.a;
    let edge_bc = triangle.c - triangle.b;
    // In a sliver the cross product of the two long edges cancels; that of a long and the short one does not.
    let across = edge_b.cross(if edge_bc.dot(edge_bc) < edge_c.dot(edge_c) { edge_bc } else { edge_c });
    let areas = Vec2::new(offset.cross(edge_c).dot(across), edge_b.cross(offset).dot(across));
    areas / across.dot(across)
}

/// Returns the same from the dot products of the edges.
pub fn weights_naive(triangle: CurvedTriangle, offset: Vec3) -> Vec2 {
    let edge_b = triangle.b - triangle.a;
    let edge_c = triangle.c - triangle.a;
    let bb = edge_b.dot(edge_b);
    let bc = edge_b.dot(edge_c);
    let cc = edge_c.dot(edge_c);
    let ob = offset.dot(edge_b);
    let oc = offset.dot(edge_c);
    Vec2::new(cc * ob - bc * oc, bb * oc - bc * ob) / (bb * cc - bc * bc)
}

/// Returns where a ray that meets the triangle at `position` meets the curved surface.
pub fn meet(
    triangle: CurvedTriangle,
    barycentrics: Vec2,
    position: Vec3,
    direction: Vec3,
    outward: Vec3,
) -> CurvedTriangleHit {
    let height = height(triangle, barycentrics, outward);
    let along = direction.dot(outward);
    let slope = if along >= 0.0 { along.max(CURVED_TRIANGLE_GRAZING) } else { along.min(-CURVED_TRIANGLE_GRAZING) };
    let moved = height / slope * direction;
    // The normals of the corners hold a little beyond the triangle too.
    let weight = (barycentrics + weights(triangle, moved)).clamp(Vec2::splat(-0.5), Vec2::splat(1.5));
    let normal =
        (1.0 - weight.x - weight.y) * triangle.normal_a + weight.x * triangle.normal_b + weight.y * triangle.normal_c;
    let squared = normal.dot(normal);
    if squared < CURVED_TRIANGLE_CANCELLED {
        return CurvedTriangleHit { position, normal: outward };
    }
    CurvedTriangleHit { position: position + moved, normal: normal * (1.0 / squared.sqrt()) }
}

/// Returns the same without guards, from positions.
pub fn meet_naive(
    triangle: CurvedTriangle,
    barycentrics: Vec2,
    position: Vec3,
    direction: Vec3,
    outward: Vec3,
) -> CurvedTriangleHit {
    let height = height_naive(triangle, barycentrics, outward);
    let met = position + height / direction.dot(outward) * direction;
    let weight = weights_naive(triangle, met - triangle.a);
    let normal =
        (1.0 - weight.x - weight.y) * triangle.normal_a + weight.x * triangle.normal_b + weight.y * triangle.normal_c;
    CurvedTriangleHit { position: met, normal: normal.normalize() }
}

/// Returns the flat hit with the interpolated normal there.
pub fn meet_phong(triangle: CurvedTriangle, barycentrics: Vec2, position: Vec3) -> CurvedTriangleHit {
    let normal = (1.0 - barycentrics.x - barycentrics.y) * triangle.normal_a
        + barycentrics.x * triangle.normal_b
        + barycentrics.y * triangle.normal_c;
    CurvedTriangleHit { position, normal: normal.normalize() }
}
