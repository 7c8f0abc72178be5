//! The oracle in f64. A step takes the height from the plane's foot point and the slope from the
//! angle between ray and plane. A whole trace clips a segment of the ray: for each plane, the part
//! outside is cut off between the heights of the two ends, so that no slope is ever formed.

use glam::{DVec3, DVec4, Vec4Swizzles as _};

/// The hit on the nearest plane so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvexTraceHit {
    /// Distance along the ray.
    pub distance: f64,
    /// Index of the plane.
    pub face: u32,
}

/// No face.
const NONE: u32 = 0xffff_ffff;
/// The farthest limit, rounded to f32.
const FAR: f64 = 1e30f32 as f64;

/// Returns a hit without a face, at the limit.
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

/// Keeps the smaller distance, rounded to f32, if the new one is above 1e-4.
pub fn step_naive(hit: ConvexTraceHit, position: DVec3, direction: DVec3, plane: DVec4, face: u32) -> ConvexTraceHit {
    let distance = height(plane, position) / slope(plane, direction);
    if distance > f64::from(1e-4f32) { nearer(hit, ConvexTraceHit { distance, face }) } else { hit }
}

/// Returns the nearer of two hits; the first at equal distances.
fn nearer(first: ConvexTraceHit, second: ConvexTraceHit) -> ConvexTraceHit {
    if second.distance < first.distance { second } else { first }
}

/// Sorts the hits by distance, each plane once, and returns the second; at equal distances the earlier.
/// Before the first plane within the limit, the hits beyond it are sorted alone.
pub fn runner_up(nearest: ConvexTraceHit, runner_up: ConvexTraceHit, hit: ConvexTraceHit) -> ConvexTraceHit {
    if nearest.face == NONE {
        let beyond = hit.face != NONE && hit.distance >= nearest.distance;
        return if beyond { nearer(runner_up, hit) } else { runner_up };
    }
    let mut hits = vec![nearest, runner_up];
    if hit.face != nearest.face {
        hits.push(hit);
    }
    hits.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    hits[1]
}

/// Returns the depth of a point inside a plane: the distance to the plane's foot point, along its
/// normal.
fn height(plane: DVec4, position: DVec3) -> f64 {
    let normal = plane.xyz();
    let foot = normal * (plane.w / normal.length_squared());
    normal.dot(foot - position)
}

/// Returns the elevation of the ray towards a plane, as the sine of an angle.
fn slope(plane: DVec4, direction: DVec3) -> f64 {
    let normal = plane.xyz();
    let elevation = normal.dot(direction).atan2(normal.cross(direction).length());
    normal.length() * direction.length() * elevation.sin()
}

/// Returns the point along the ray, split at the plane: its part within the plane by a double cross
/// product, and the plane's foot point.
pub fn point(position: DVec3, direction: DVec3, distance: f64, plane: DVec4) -> DVec3 {
    let normal = plane.xyz();
    let along = position + distance * direction;
    (normal.cross(along.cross(normal)) + plane.w * normal) / normal.length_squared()
}

/// Returns the point along the ray.
pub fn point_naive(position: DVec3, direction: DVec3, distance: f64) -> DVec3 {
    position + distance * direction
}

/// Returns the distance to the surface and the face there, by clipping the segment that starts at
/// `position`. Of several faces at the same distance, the first that cuts counts. If the start lies
/// outside a plane and the ray runs further out, the segment is cut off at 0. Without any plane
/// ahead, the result is 1e30 and no face.
pub fn trace(planes: &[DVec4], position: DVec3, direction: DVec3, left: u32) -> (f64, u32) {
    let (mut end, mut hit) = (FAR, NONE);
    for (face, plane) in (0..).zip(planes) {
        if face == left {
            continue;
        }
        // Distances of the segment's two ends outside the plane.
        let [first, last] = [position, position + end * direction].map(|point| plane.xyz().dot(point) - plane.w);
        if last > 0.0 && last > first {
            (end, hit) = (end * (-first).max(0.0) / (last - first), face);
        }
    }
    (end, hit)
}
