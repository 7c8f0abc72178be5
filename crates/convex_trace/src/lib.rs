//! Mirror of `wgsl/convex_trace.wgsl`: where a ray inside a convex stone meets its surface, from the planes of its facets.
//! Imagire, "Proxy Geometry Gem Rendering", section 5, fig. 7.
//!
//! The WGSL file states units, domain and accuracy of each function; this file reads line by line like it.
//!
//! ```
//! use glam::{Vec3, vec4};
//! use lapidary_convex_trace::trace;
//!
//! // A cube about the origin: outward normal and distance of each face.
//! let planes = [1.0, -1.0].into_iter().flat_map(|s| [vec4(s, 0.0, 0.0, 1.0), vec4(0.0, s, 0.0, 1.0), vec4(0.0, 0.0, s, 1.0)]);
//! let planes: Vec<_> = planes.collect();
//! let hit = trace(&planes, Vec3::ZERO, Vec3::X, u32::MAX);
//! assert_eq!((hit.face, hit.distance), (0, 1.0));
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{Vec3, Vec4, Vec4Swizzles as _};

/// The nearest plane so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvexTraceHit {
    /// Along the ray, at least 0; the limit while none is hit.
    pub distance: f32,
    /// The plane's number; `CONVEX_TRACE_NONE` while none is hit.
    pub face: u32,
}

/// No face.
pub const CONVEX_TRACE_NONE: u32 = 0xffff_ffff;
/// A limit on the distance that no ray in a stone reaches.
pub const CONVEX_TRACE_FAR: f32 = 1e30;

/// The hit to start from: none, nearer than which a plane must be.
pub fn start(limit: f32) -> ConvexTraceHit {
    ConvexTraceHit { distance: limit.min(CONVEX_TRACE_FAR), face: CONVEX_TRACE_NONE }
}

/// Takes one plane into account.
pub fn step(hit: ConvexTraceHit, position: Vec3, direction: Vec3, plane: Vec4, face: u32, left: u32) -> ConvexTraceHit {
    let height = plane.w - plane.xyz().dot(position);
    let slope = plane.xyz().dot(direction);
    // Where the slope is 0 this is not looked at.
    let distance = height.max(0.0) / slope;
    if slope > 0.0 && distance < hit.distance && face != left {
        return ConvexTraceHit { distance, face };
    }
    hit
}

/// The same with an epsilon against meeting the face that was left.
pub fn step_naive(hit: ConvexTraceHit, position: Vec3, direction: Vec3, plane: Vec4, face: u32) -> ConvexTraceHit {
    let distance = (plane.w - plane.xyz().dot(position)) / plane.xyz().dot(direction);
    if distance > 1e-4 && distance < hit.distance {
        return ConvexTraceHit { distance, face };
    }
    hit
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
