//! The truth in f64. A step takes the height from the plane's foot point and the slope from the angle between ray and plane.
//! A whole trace clips a segment: of the part of the ray that is still inside, what lies outside of a plane is cut off between
//! the heights of its two ends, so that no slope is ever formed.

use glam::{DVec3, DVec4, Vec4Swizzles as _};

/// The nearest plane so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvexTraceHit {
    /// Along the ray.
    pub distance: f64,
    /// Its number.
    pub face: u32,
}

/// No face.
const NONE: u32 = 0xffff_ffff;
/// The farthest limit, as f32 rounds it.
const FAR: f64 = 1e30f32 as f64;

/// No face, at the limit.
pub fn start(limit: f64) -> ConvexTraceHit {
    ConvexTraceHit { distance: limit.min(FAR), face: NONE }
}

/// Keeps the smaller of two distances.
pub fn step(
    hit: ConvexTraceHit,
    position: DVec3,
    direction: DVec3,
    plane: DVec4,
    face: u32,
    left: u32,
) -> ConvexTraceHit {
    let slope = slope(plane, direction);
    if slope <= 0.0 || face == left {
        return hit;
    }
    nearer(hit, ConvexTraceHit { distance: (height(plane, position) / slope).max(0.0), face })
}

/// Keeps the smaller of two distances, of those above a ten-thousandth as f32 rounds it.
pub fn step_naive(hit: ConvexTraceHit, position: DVec3, direction: DVec3, plane: DVec4, face: u32) -> ConvexTraceHit {
    let distance = height(plane, position) / slope(plane, direction);
    if distance > f64::from(1e-4f32) { nearer(hit, ConvexTraceHit { distance, face }) } else { hit }
}

/// The nearer of two hits; the first, where neither is.
fn nearer(first: ConvexTraceHit, second: ConvexTraceHit) -> ConvexTraceHit {
    if second.distance < first.distance { second } else { first }
}

/// How far a point lies inside of a plane: the way to the plane's foot point, along its normal.
fn height(plane: DVec4, position: DVec3) -> f64 {
    let normal = plane.xyz();
    let foot = normal * (plane.w / normal.length_squared());
    normal.dot(foot - position)
}

/// The ray's elevation towards a plane, as the sine of an angle.
fn slope(plane: DVec4, direction: DVec3) -> f64 {
    let normal = plane.xyz();
    let elevation = normal.dot(direction).atan2(normal.cross(direction).length());
    normal.length() * direction.length() * elevation.sin()
}

/// The point along the ray split at the plane: its part within the plane by a double cross product, and the plane's foot point.
pub fn point(position: DVec3, direction: DVec3, distance: f64, plane: DVec4) -> DVec3 {
    let normal = plane.xyz();
    let along = position + distance * direction;
    (normal.cross(along.cross(normal)) + plane.w * normal) / normal.length_squared()
}

/// The point along the ray.
pub fn point_naive(position: DVec3, direction: DVec3, distance: f64) -> DVec3 {
    position + distance * direction
}

/// The distance to the surface and the face there, by clipping the segment from `position` on. Of faces at one distance, the first
/// that cuts. A start outside of a plane is cut off at 0 where the ray runs further out. Without any plane ahead, 1e30 and
/// no face.
pub fn trace(planes: &[DVec4], position: DVec3, direction: DVec3, left: u32) -> (f64, u32) {
    let (mut end, mut hit) = (FAR, NONE);
    for (face, plane) in (0..).zip(planes) {
        if face == left {
            continue;
        }
        // How far the segment's two ends lie outside.
        let [first, last] = [position, position + end * direction].map(|point| plane.xyz().dot(point) - plane.w);
        if last > 0.0 && last > first {
            (end, hit) = (end * (-first).max(0.0) / (last - first), face);
        }
    }
    (end, hit)
}
