//! The truth in f64. A step compares distances, each from the plane's foot point and from the angle between ray and plane. A
//! whole trace clips a segment: of the part of the ray that is still inside, what lies outside of a plane is cut off between the heights
//! of its two ends, so that no slope is ever formed. The mirror compares cross products of heights and slopes.

use glam::{DVec3, DVec4, Vec4Swizzles as _};

/// The nearest plane so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvexTraceHit {
    /// How far the plane is away along its normal.
    pub numerator: f64,
    /// How much nearer to it one unit along the ray leads.
    pub denominator: f64,
    /// Its number.
    pub face: u32,
}

/// No face.
const NONE: u32 = 0xffff_ffff;
/// The farthest limit, as f32 rounds it.
const FAR: f64 = 1e30f32 as f64;

/// No face, at the limit.
pub fn start(limit: f64) -> ConvexTraceHit {
    ConvexTraceHit { numerator: limit.min(FAR), denominator: 1.0, face: NONE }
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
    let numerator = height(plane, position);
    let denominator = slope(plane, direction);
    let approaches = denominator > 0.0 && face != left;
    if approaches && numerator / denominator < hit.numerator / hit.denominator {
        ConvexTraceHit { numerator, denominator, face }
    } else {
        hit
    }
}

/// Keeps the smaller of two distances, of those above a ten-thousandth as f32 rounds it.
pub fn step_naive(hit: ConvexTraceHit, position: DVec3, direction: DVec3, plane: DVec4, face: u32) -> ConvexTraceHit {
    let distance = height(plane, position) / slope(plane, direction);
    if distance > f64::from(1e-4f32) && distance < hit.numerator / hit.denominator {
        ConvexTraceHit { numerator: distance, denominator: 1.0, face }
    } else {
        hit
    }
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

/// The quotient by logarithms, so that no division is made.
pub fn distance(hit: ConvexTraceHit) -> f64 {
    if hit.numerator <= 0.0 { 0.0 } else { (hit.numerator.ln() - hit.denominator.ln()).exp() }
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
