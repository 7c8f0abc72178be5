//! Mirror of `wgsl/convex_trace.wgsl`: where a ray inside a convex stone meets its surface, from the planes of its facets.
//! Imagire, "Proxy Geometry Gem Rendering", section 5, fig. 7.
//!
//! The WGSL file states units, domain and accuracy of each function; this file reads line by line like it.

pub mod oracle;

use glam::{Vec3, Vec4, Vec4Swizzles as _};

/// The nearest plane so far, its distance as a fraction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvexTraceHit {
    /// How far the plane is away along its normal. Below 0 where the ray's start lies outside by rounding.
    pub numerator: f32,
    /// How much nearer to it one unit along the ray leads; above 0.
    pub denominator: f32,
    /// Its number; `CONVEX_TRACE_NONE` while none is hit.
    pub face: u32,
}

/// No face.
pub const CONVEX_TRACE_NONE: u32 = 0xffff_ffff;
/// A limit on the distance that no ray in a stone reaches.
pub const CONVEX_TRACE_FAR: f32 = 1e30;

/// The hit to start from: none, nearer than which a plane must be.
pub fn start(limit: f32) -> ConvexTraceHit {
    ConvexTraceHit { numerator: limit.min(CONVEX_TRACE_FAR), denominator: 1.0, face: CONVEX_TRACE_NONE }
}

/// Takes one plane into account.
pub fn step(hit: ConvexTraceHit, position: Vec3, direction: Vec3, plane: Vec4, face: u32, left: u32) -> ConvexTraceHit {
    let height = plane.w - plane.xyz().dot(position);
    let slope = plane.xyz().dot(direction);
    if slope > 0.0 && height * hit.denominator < hit.numerator * slope && face != left {
        return ConvexTraceHit { numerator: height, denominator: slope, face };
    }
    hit
}

/// The same with a division, and with an epsilon against meeting the face that was left.
pub fn step_naive(hit: ConvexTraceHit, position: Vec3, direction: Vec3, plane: Vec4, face: u32) -> ConvexTraceHit {
    let distance = (plane.w - plane.xyz().dot(position)) / plane.xyz().dot(direction);
    if distance > 1e-4 && distance < hit.numerator / hit.denominator {
        return ConvexTraceHit { numerator: distance, denominator: 1.0, face };
    }
    hit
}

/// Distance of a hit: the one division of a trace.
pub fn distance(hit: ConvexTraceHit) -> f32 {
    hit.numerator.max(0.0) / hit.denominator
}

/// Where a ray meets a plane, put back onto the plane.
pub fn point(position: Vec3, direction: Vec3, distance: f32, plane: Vec4) -> Vec3 {
    let point = position + distance * direction;
    point - (plane.xyz().dot(point) - plane.w) * plane.xyz()
}

/// The point along the ray, left where rounding puts it.
pub fn point_naive(position: Vec3, direction: Vec3, distance: f32) -> Vec3 {
    position + distance * direction
}

/// The whole loop that the WGSL file's header shows, as a recipe runs it for each hit: the plane by which a ray leaves the stone.
/// `left` is the face that it starts on, or [`CONVEX_TRACE_NONE`].
pub fn trace(planes: &[Vec4], position: Vec3, direction: Vec3, left: u32) -> ConvexTraceHit {
    let mut hit = start(CONVEX_TRACE_FAR);
    for (face, plane) in (0..).zip(planes) {
        hit = step(hit, position, direction, *plane, face, left);
    }
    hit
}

#[cfg(test)]
mod tests;
