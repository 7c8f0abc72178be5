//! Ground truth in f64: the axes from the rotation that takes +z to the map's axis, the clip
//! coordinates as fractions of the box or cone that the map covers, the cosine and the height from
//! angles.

use glam::{DQuat, DVec2, DVec3, DVec4};

/// The view of one map, as in the mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReflectiveShadowMapView {
    /// The centre of a sun's map or the position of a lamp.
    pub origin: DVec3,
    /// 0 for a sun, 1 for a lamp.
    pub lamp: u32,
    /// The direction of the light in the middle of the map.
    pub axis: DVec3,
    /// Half the map's width for a sun, the tangent of half the angle for a lamp.
    pub extent: f64,
    /// The smallest depth.
    pub near: f64,
    /// The largest depth.
    pub far: f64,
}

/// Two unit vectors, as in the mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReflectiveShadowMapBasis {
    /// Direction towards the right edge of the map.
    pub right: DVec3,
    /// Direction towards the upper edge of the map.
    pub up: DVec3,
}

/// Rotates x and y by the rotation that takes +z to the axis, or to the opposite of the axis if
/// that is nearer; in that case `up` is reversed, to keep the basis right-handed.
pub fn basis(axis: DVec3) -> ReflectiveShadowMapBasis {
    let side = if axis.z >= 0.0 { 1.0 } else { -1.0 };
    let target = side * axis;
    let across = DVec3::Z.cross(target);
    let turn = if across == DVec3::ZERO {
        DQuat::IDENTITY
    } else {
        DQuat::from_axis_angle(across.normalize(), across.length().atan2(target.z))
    };
    ReflectiveShadowMapBasis { right: turn * DVec3::X, up: side * (turn * DVec3::Y) }
}

/// Computes the axes from the azimuth of the axis about the vertical, and its elevation.
pub fn basis_naive(axis: DVec3) -> ReflectiveShadowMapBasis {
    let azimuth = axis.x.atan2(axis.z);
    let elevation = axis.y.atan2(axis.x.hypot(axis.z));
    let right = DVec3::new(azimuth.cos(), 0.0, -azimuth.sin());
    let up = DVec3::new(-elevation.sin() * azimuth.sin(), elevation.cos(), -elevation.sin() * azimuth.cos());
    ReflectiveShadowMapBasis { right, up }
}

/// Computes x and y from the point's coordinates in the rotated frame, and z from the fraction of
/// its depth between near and far: for a lamp, of its inverse depth.
pub fn clip(view: ReflectiveShadowMapView, position: DVec3) -> DVec4 {
    let ReflectiveShadowMapBasis { right, up } = basis(-view.axis);
    let way = position - view.origin;
    let [x, y, depth] = [right, up, view.axis].map(|axis| way.length() * cosine_between(way, axis) * axis.length());
    let [x, y] = [x, y].map(|across| across / view.extent);
    if view.lamp == 0 {
        return DVec4::new(x, y, (depth - view.near) / (view.far - view.near), 1.0);
    }
    // z / w is linear in 1 / depth: 0 at near, 1 at far. Here it is multiplied by the depth, which
    // may be 0.
    let [near, far] = [view.near, view.far].map(f64::recip);
    DVec4::new(x, y, (depth * near - 1.0) / (near - far), depth)
}

/// Computes the position from its distances to the left and upper edges of the map in clip space.
pub fn texel(clip: DVec4, size: f64) -> DVec2 {
    if clip.w <= 0.0 {
        return DVec2::splat(-1.0);
    }
    let [left, top] = [clip.x + clip.w, clip.w - clip.y];
    DVec2::new(left, top) * size / (2.0 * clip.w)
}

/// Returns the cosine of the angle between two vectors, by Kahan's formula; 0 if either is 0.
fn cosine_between(a: DVec3, b: DVec3) -> f64 {
    if a == DVec3::ZERO || b == DVec3::ZERO {
        return 0.0;
    }
    let [a, b] = [a / a.length(), b / b.length()];
    // The sine of the complement of the angle: 1 - 2 sin² of half the angle loses digits near 0.
    let (sum, difference) = ((a + b).length(), (a - b).length());
    0.25 * (sum - difference) * (sum + difference)
}

/// Computes N·L from the angle.
pub fn cosine(normal: DVec3, toward_light: DVec3) -> f64 {
    (cosine_between(normal, toward_light) * toward_light.length()).clamp(0.0, 1.0)
}

/// Multiplies the distance by the cosine of the angle to the normal.
pub fn height(seen: DVec3, position: DVec3, normal: DVec3) -> f64 {
    let way = seen - position;
    way.length() * cosine_between(way, normal)
}

/// Computes the same along the light.
pub fn height_naive(seen: DVec3, position: DVec3, toward_light: DVec3) -> f64 {
    height(seen, position, toward_light) * toward_light.length()
}
