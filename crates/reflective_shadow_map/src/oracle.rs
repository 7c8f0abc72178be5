//! The truth in f64: axes by the turn that takes +z to the map's axis; clip coordinates as parts of the box or cone that the map covers; the
//! cosine and the height by angles.

use glam::{DQuat, DVec2, DVec3, DVec4};

/// What a map sees; as the mirror's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReflectiveShadowMapView {
    /// The middle of what a sun's map covers, or where a lamp stands.
    pub origin: DVec3,
    /// 0 for a sun, 1 for a lamp.
    pub lamp: u32,
    /// The way that light goes in the map's middle.
    pub axis: DVec3,
    /// Half the map's width, or the tangent of half its angle.
    pub extent: f64,
    /// The least depth.
    pub near: f64,
    /// The greatest.
    pub far: f64,
}

/// Two unit vectors; as the mirror's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReflectiveShadowMapBasis {
    /// Towards the map's right.
    pub right: DVec3,
    /// Towards its upper edge.
    pub up: DVec3,
}

/// x and y, turned as +z is turned to the axis, or to its opposite where that is nearer; there up is turned over, to keep the hand.
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

/// By the axis' azimuth about the vertical.
pub fn basis_naive(axis: DVec3) -> ReflectiveShadowMapBasis {
    let azimuth = axis.x.atan2(axis.z);
    let elevation = axis.y.atan2(axis.x.hypot(axis.z));
    let right = DVec3::new(azimuth.cos(), 0.0, -azimuth.sin());
    let up = DVec3::new(-elevation.sin() * azimuth.sin(), elevation.cos(), -elevation.sin() * azimuth.cos());
    ReflectiveShadowMapBasis { right, up }
}

/// By the point's way in the turned frame, and by where depths lie between near and far: for a lamp, in inverse depth.
pub fn clip(view: ReflectiveShadowMapView, position: DVec3) -> DVec4 {
    let ReflectiveShadowMapBasis { right, up } = basis(-view.axis);
    let way = position - view.origin;
    let [x, y, depth] = [right, up, view.axis].map(|axis| way.length() * cosine_between(way, axis) * axis.length());
    let [x, y] = [x, y].map(|across| across / view.extent);
    if view.lamp == 0 {
        return DVec4::new(x, y, (depth - view.near) / (view.far - view.near), 1.0);
    }
    // z / w is linear in 1 / depth: 0 at near, 1 at far. Written times the depth, which may be 0.
    let [near, far] = [view.near, view.far].map(f64::recip);
    DVec4::new(x, y, (depth * near - 1.0) / (near - far), depth)
}

/// By the corners of the map in clip space.
pub fn texel(clip: DVec4, size: f64) -> DVec2 {
    if clip.w <= 0.0 {
        return DVec2::splat(-1.0);
    }
    let [left, top] = [clip.x + clip.w, clip.w - clip.y];
    DVec2::new(left, top) * size / (2.0 * clip.w)
}

/// Of the angle between two vectors by Kahan's formula; 0 where one is 0.
fn cosine_between(a: DVec3, b: DVec3) -> f64 {
    if a == DVec3::ZERO || b == DVec3::ZERO {
        return 0.0;
    }
    let [a, b] = [a / a.length(), b / b.length()];
    // The sine of what is missing to a right angle: 1 - 2 sin² of half the angle loses what is near 0.
    let (sum, difference) = ((a + b).length(), (a - b).length());
    0.25 * (sum - difference) * (sum + difference)
}

/// By the angle.
pub fn cosine(normal: DVec3, toward_light: DVec3) -> f64 {
    (cosine_between(normal, toward_light) * toward_light.length()).clamp(0.0, 1.0)
}

/// The distance times the cosine of the angle to the normal.
pub fn height(seen: DVec3, position: DVec3, normal: DVec3) -> f64 {
    let way = seen - position;
    way.length() * cosine_between(way, normal)
}

/// The same along the light.
pub fn height_naive(seen: DVec3, position: DVec3, toward_light: DVec3) -> f64 {
    height(seen, position, toward_light) * toward_light.length()
}
