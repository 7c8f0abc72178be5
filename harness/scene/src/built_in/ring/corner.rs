//! Corners of outlines.

use glam::DVec2;

/// Returns the point at a share, 0 to 1, of the way from `start` to `end` around a rounded corner: a parabola that touches both edges.
pub(super) fn rounded_corner(start: DVec2, corner: DVec2, end: DVec2, share: f64) -> DVec2 {
    start.lerp(corner, share).lerp(corner.lerp(end, share), share)
}
