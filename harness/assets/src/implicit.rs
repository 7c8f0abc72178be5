//! Implicit bodies (points where a function is negative) and triangle meshes of their surfaces.
//!
//! A field is a function from a point to a number that is negative inside, positive outside and,
//! near the surface, approximately the distance from it: the better the approximation, the better
//! the mesh. The functions here are such fields and ways to combine them.

use glam::DVec3;

mod grid;
mod nets;

pub use grid::Grid;
pub use nets::surface;

/// Distance from a rounded cone: a sphere that moves from `from` to `to` while its radius changes
/// from `from_radius` to `to_radius`. Exact if both radii are equal (a capsule).
#[must_use]
pub fn limb(point: DVec3, from: DVec3, to: DVec3, [from_radius, to_radius]: [f64; 2]) -> f64 {
    let (way, along) = (point - from, to - from);
    let share = (way.dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    way.distance(share * along) - from_radius - share * (to_radius - from_radius)
}

/// Distance from an ellipsoid centred at the origin with these radii along the axes, to first order
/// at its surface.
#[must_use]
pub fn ellipsoid(point: DVec3, radii: DVec3) -> f64 {
    let (scaled, gradient) = ((point / radii).length(), (point / (radii * radii)).length());
    // Both lengths vanish at the centre.
    if gradient < f64::MIN_POSITIVE { -radii.min_element() } else { scaled * (scaled - 1.0) / gradient }
}

/// Union of two bodies, given the values of their fields at a point. Surfaces closer together than
/// `width` are blended by a parabola; 0 gives a sharp edge.
#[must_use]
pub fn union(a: f64, b: f64, width: f64) -> f64 {
    let overlap = (width - (a - b).abs()).max(0.0);
    a.min(b) - if width > 0.0 { overlap * overlap / (4.0 * width) } else { 0.0 }
}

/// The part of `a` outside `b`; `width` as in [`union`].
#[must_use]
pub fn difference(a: f64, b: f64, width: f64) -> f64 {
    -union(-a, b, width)
}

/// The part common to both bodies; `width` as in [`union`].
#[must_use]
pub fn intersection(a: f64, b: f64, width: f64) -> f64 {
    -union(-a, -b, width)
}

/// Returns the field's gradient, by central differences over `step` to either side.
fn gradient(field: &(dyn Fn(DVec3) -> f64 + Sync), point: DVec3, step: f64) -> DVec3 {
    let along = |axis: DVec3| (field(point + step * axis) - field(point - step * axis)) / (2.0 * step);
    DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
}

#[cfg(test)]
pub(super) mod tests;
