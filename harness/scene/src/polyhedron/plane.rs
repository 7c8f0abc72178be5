//! The plane of a facet.

use glam::DVec3;

/// The half-space `normal · x <= distance`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Outward normal; [`Polyhedron::from_planes`](super::Polyhedron::from_planes) scales it to unit length.
    pub normal: DVec3,
    /// Distance of the plane from the origin along the normal, in units of the normal's length.
    pub distance: f64,
}

impl Plane {
    /// Returns the plane through `point` with the outward `normal`.
    #[must_use]
    pub fn through(point: DVec3, normal: DVec3) -> Self {
        let normal = normal.normalize_or_zero();
        Self { normal, distance: normal.dot(point) }
    }

    /// Returns the signed distance of `point` from the plane, positive outside.
    #[must_use]
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.distance
    }
}
