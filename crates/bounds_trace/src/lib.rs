//! Mirror of `wgsl/bounds_trace.wgsl`: where a ray meets the bounds of another body, a box or an
//! ellipsoid of any size, place and turn.
//!
//! The WGSL file states the units, domain and accuracy of each function. This file follows it line
//! by line.
//!
//! ```
//! use glam::vec3;
//! use lapidary_bounds_trace::{BOUNDS_TRACE_NONE, ball, cuboid};
//!
//! // Along an axis, from 3 before the middle, with a direction of length 2.
//! let (position, direction) = (vec3(0.0, 0.0, -3.0), vec3(0.0, 0.0, 2.0));
//! assert_eq!((cuboid(position, direction), ball(position, direction)), (1.0, 1.0));
//! // The other way, both lie behind.
//! assert_eq!(cuboid(position, -direction), BOUNDS_TRACE_NONE);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{Vec3, vec3};

/// Distance of a ray that meets nothing.
pub const BOUNDS_TRACE_NONE: f32 = -1.0;
/// Slope below which a ray is parallel to a side of the box.
pub const BOUNDS_TRACE_PARALLEL: f32 = 1e-20;

/// Returns the distance at which a ray from outside enters the box.
pub fn cuboid(position: Vec3, direction: Vec3) -> f32 {
    let parallel = Vec3::splat(BOUNDS_TRACE_PARALLEL);
    let inward = Vec3::select(position.cmpge(Vec3::ZERO), -parallel, parallel);
    let slope = Vec3::select(direction.abs().cmplt(parallel), inward, direction);
    let first = (-1.0 - position) / slope;
    let second = (1.0 - position) / slope;
    let enter = first.min(second);
    let leave = first.max(second);
    let entry = enter.x.max(enter.y).max(enter.z);
    let exit = leave.x.min(leave.y).min(leave.z);
    if entry <= 0.0 || entry > exit {
        return BOUNDS_TRACE_NONE;
    }
    entry
}

/// Returns the distance at which a ray from outside enters the box, divided by the direction as it
/// is.
pub fn cuboid_naive(position: Vec3, direction: Vec3) -> f32 {
    let first = (-1.0 - position) / direction;
    let second = (1.0 - position) / direction;
    let enter = first.min(second);
    let leave = first.max(second);
    let entry = enter.x.max(enter.y).max(enter.z);
    let exit = leave.x.min(leave.y).min(leave.z);
    if entry <= 0.0 || entry > exit {
        return BOUNDS_TRACE_NONE;
    }
    entry
}

/// Returns the normal of the box's side that a point on the box belongs to.
pub fn cuboid_normal(point: Vec3) -> Vec3 {
    let size = point.abs();
    let toward = Vec3::select(point.cmpge(Vec3::ZERO), Vec3::ONE, Vec3::NEG_ONE);
    if size.x >= size.y && size.x >= size.z {
        return vec3(toward.x, 0.0, 0.0);
    }
    if size.y >= size.z {
        return vec3(0.0, toward.y, 0.0);
    }
    vec3(0.0, 0.0, toward.z)
}

/// Returns the distance at which a ray from outside enters the unit ball.
pub fn ball(position: Vec3, direction: Vec3) -> f32 {
    let outside = position.dot(position) - 1.0;
    let toward = -position.dot(direction);
    if outside <= 0.0 || toward <= 0.0 {
        return BOUNDS_TRACE_NONE;
    }
    let squared = direction.dot(direction);
    let closest = position + (toward / squared) * direction;
    let radicand = 1.0 - closest.dot(closest);
    if radicand < 0.0 {
        return BOUNDS_TRACE_NONE;
    }
    outside / (toward + (squared * radicand).sqrt())
}

/// Returns the distance at which a ray from outside enters the unit ball, by the quadratic formula.
pub fn ball_naive(position: Vec3, direction: Vec3) -> f32 {
    let a = direction.dot(direction);
    let b = position.dot(direction);
    let c = position.dot(position) - 1.0;
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return BOUNDS_TRACE_NONE;
    }
    let entry = (-b - discriminant.sqrt()) / a;
    if entry <= 0.0 {
        return BOUNDS_TRACE_NONE;
    }
    entry
}
