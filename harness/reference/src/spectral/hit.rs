//! Where a ray meets a body.

use glam::DVec3;

/// Intersection of a ray with a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hit {
    /// Distance in units of the direction, at least 0 up to rounding.
    pub(crate) distance: f64,
    /// Unit normal, pointing out of the body.
    pub(crate) normal: DVec3,
    /// Body and face of the hit.
    pub(crate) place: Place,
}

/// A facet or triangle of a body. A ray that starts from it does not meet it again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) body: usize,
    pub(crate) face: usize,
}
