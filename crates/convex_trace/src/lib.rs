//! Mirror of `wgsl/convex_trace.wgsl`: the point at which a ray inside a convex stone meets its
//! surface, from the planes of its facets. Imagire, "Proxy Geometry Gem Rendering", section 5,
//! fig. 7.
//!
//! The WGSL file states the units, domain and accuracy of each function. This file follows it line
//! by line. [`Facets`] finds the planes of a mesh.
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

pub mod facets;
#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

pub use facets::{Facets, NoFacets};

use glam::{Vec3, Vec4, Vec4Swizzles as _};

/// The hit on the nearest plane so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvexTraceHit {
    /// Distance along the ray, at least 0; the limit while no plane is hit.
    pub distance: f32,
    /// Index of the plane; `CONVEX_TRACE_NONE` while no plane is hit.
    pub face: u32,
}

/// No face: the value of `left` for a ray that starts inside the stone, and of `face` if nothing is
/// hit.
pub const CONVEX_TRACE_NONE: u32 = 0xffff_ffff;
/// A limit on the distance, beyond the length of any ray inside a stone.
pub const CONVEX_TRACE_FAR: f32 = 1e30;

/// Returns the initial hit: no face yet, and a limit that a plane must be nearer than.
pub fn start(limit: f32) -> ConvexTraceHit {
    ConvexTraceHit { distance: limit.min(CONVEX_TRACE_FAR), face: CONVEX_TRACE_NONE }
}

/// Updates the hit with one plane.
pub fn step(hit: ConvexTraceHit, position: Vec3, direction: Vec3, plane: Vec4, face: u32, left: u32) -> ConvexTraceHit {
    let height = plane.w - plane.xyz().dot(position);
    let slope = plane.xyz().dot(direction);
    // The quotient is ignored if the slope is 0.
    let distance = height.max(0.0) / slope;
    if slope > 0.0 && distance < hit.distance && face != left {
        return ConvexTraceHit { distance, face };
    }
    hit
}

/// Updates the hit with one plane, with an epsilon to avoid hitting the face that the ray has just
/// left.
pub fn step_naive(hit: ConvexTraceHit, position: Vec3, direction: Vec3, plane: Vec4, face: u32) -> ConvexTraceHit {
    let distance = (plane.w - plane.xyz().dot(position)) / plane.xyz().dot(direction);
    if distance > 1e-4 && distance < hit.distance {
        return ConvexTraceHit { distance, face };
    }
    hit
}

/// Updates the runner-up with one plane's own hit, before the nearest hit takes it up.
pub fn runner_up(nearest: ConvexTraceHit, runner_up: ConvexTraceHit, hit: ConvexTraceHit) -> ConvexTraceHit {
    let overtakes = hit.distance < nearest.distance;
    let second = hit.distance < runner_up.distance && hit.face != nearest.face && !overtakes;
    let overtaken = overtakes && nearest.face != CONVEX_TRACE_NONE;
    let kept = if second { hit } else { runner_up };
    if overtaken { nearest } else { kept }
}

/// Returns the point at which a ray meets a plane, moved back onto the plane.
pub fn point(position: Vec3, direction: Vec3, distance: f32, plane: Vec4) -> Vec3 {
    let point = position + distance * direction;
    point - (plane.xyz().dot(point) - plane.w) * plane.xyz()
}

/// Returns the point along the ray, not corrected for rounding.
pub fn point_naive(position: Vec3, direction: Vec3, distance: f32) -> Vec3 {
    position + distance * direction
}

/// Runs the whole loop that the WGSL file's header shows, as a recipe does for each hit. Returns
/// the plane through which a ray leaves the stone. `left` is the face on which the ray starts, or
/// [`CONVEX_TRACE_NONE`].
pub fn trace(planes: &[Vec4], position: Vec3, direction: Vec3, left: u32) -> ConvexTraceHit {
    let mut hit = start(CONVEX_TRACE_FAR);
    for (face, plane) in (0..).zip(planes) {
        hit = step(hit, position, direction, *plane, face, left);
    }
    hit
}

#[cfg(test)]
mod tests;
