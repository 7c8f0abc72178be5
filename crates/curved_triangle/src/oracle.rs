//! The truth in f64: the projections onto the tangent planes as places in the world, and weights by the distances from
//! the sides of the triangle.

use glam::{DVec2, DVec3};

/// Least cosine at which a ray is followed: that of the shader, which is an f32.
const GRAZING: f64 = 0.2f32 as f64;
/// Squared length of a normal that has no direction, likewise.
const CANCELLED: f64 = 1e-6f32 as f64;

/// A triangle with normals at its corners, as in the mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvedTriangle {
    /// The first corner.
    pub a: DVec3,
    /// The second corner.
    pub b: DVec3,
    /// The third corner.
    pub c: DVec3,
    /// Unit normal at `a`, or 0.
    pub normal_a: DVec3,
    /// Unit normal at `b`, or 0.
    pub normal_b: DVec3,
    /// Unit normal at `c`, or 0.
    pub normal_c: DVec3,
}

/// A place on a curved surface, as in the mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvedTriangleHit {
    /// The position.
    pub position: DVec3,
    /// Unit normal.
    pub normal: DVec3,
}

impl CurvedTriangle {
    /// The corners with their normals and weights.
    fn weighted(&self, barycentrics: DVec2) -> [(DVec3, DVec3, f64); 3] {
        let first = 1.0 - barycentrics.element_sum();
        [
            (self.a, self.normal_a, first),
            (self.b, self.normal_b, barycentrics.x),
            (self.c, self.normal_c, barycentrics.y),
        ]
    }

    /// The weighted mean of the normals.
    fn normal(&self, barycentrics: DVec2) -> DVec3 {
        self.weighted(barycentrics).into_iter().map(|(_, normal, weight)| weight * normal).sum()
    }
}

/// Projects the point onto the three tangent planes, and takes half of the weighted mean of how far that leads along
/// the triangle's normal.
pub fn height(triangle: CurvedTriangle, barycentrics: DVec2, outward: DVec3) -> f64 {
    let corners = triangle.weighted(barycentrics);
    let point: DVec3 = corners.into_iter().map(|(corner, _, weight)| weight * corner).sum();
    let risen = |(corner, normal, weight): (DVec3, DVec3, f64)| {
        let projected = point + (corner - point).dot(normal) * normal;
        weight * (projected - point).dot(outward)
    };
    0.5 * corners.into_iter().map(risen).sum::<f64>()
}

/// How far the offset leads away from the side opposite to a corner, over how far the corner is from that side.
pub fn weights(triangle: CurvedTriangle, offset: DVec3) -> DVec2 {
    let (edge_b, edge_c) = (triangle.b - triangle.a, triangle.c - triangle.a);
    let share = |corner: DVec3, side: DVec3| {
        let away = corner - corner.dot(side) / side.length_squared() * side;
        offset.dot(away) / away.length_squared()
    };
    DVec2::new(share(edge_b, edge_c), share(edge_c, edge_b))
}

/// The same steps with the height and the weights of this file.
pub fn meet(
    triangle: CurvedTriangle,
    barycentrics: DVec2,
    position: DVec3,
    direction: DVec3,
    outward: DVec3,
) -> CurvedTriangleHit {
    let along = direction.dot(outward);
    let side = if along >= 0.0 { 1.0 } else { -1.0 };
    let distance = height(triangle, barycentrics, outward) / (side * along.abs().max(GRAZING));
    let met = barycentrics + weights(triangle, distance * direction);
    let normal = triangle.normal(met.clamp(DVec2::splat(-0.5), DVec2::splat(1.5)));
    if normal.length_squared() < CANCELLED {
        return CurvedTriangleHit { position, normal: outward };
    }
    CurvedTriangleHit { position: position + distance * direction, normal: normal.normalize() }
}

/// The flat hit: another place than [`meet`]'s.
pub fn meet_phong(triangle: CurvedTriangle, barycentrics: DVec2, position: DVec3) -> CurvedTriangleHit {
    CurvedTriangleHit { position, normal: triangle.normal(barycentrics).normalize() }
}
