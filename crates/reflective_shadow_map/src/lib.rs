//! Rust mirror of `wgsl/reflective_shadow_map.wgsl`, line by line: the view of a scene from a
//! light. The comments of the WGSL functions state units, domain and accuracy.
//!
//! ```
//! use glam::Vec3;
//! use lapidary_reflective_shadow_map::{ReflectiveShadowMapView, clip};
//!
//! // A sun that shines down on a scene of radius 1.
//! let view = ReflectiveShadowMapView { origin: Vec3::ZERO, lamp: 0, axis: Vec3::NEG_Y, extent: 1.0, near: -1.0, far: 1.0 };
//! let clip = clip(view, Vec3::new(0.0, 1.0, 0.0));
//! assert_eq!(clip.z / clip.w, 0.0);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{Vec2, Vec3, Vec4};

/// N·L of a texel that sees nothing.
pub const REFLECTIVE_SHADOW_MAP_NOTHING: f32 = -1.0;

/// The view of one map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReflectiveShadowMapView {
    /// The centre of a sun's map or the position of a lamp, in world units.
    pub origin: Vec3,
    /// 0 for a sun (parallel rays), 1 for a lamp.
    pub lamp: u32,
    /// The unit direction of the light in the middle of the map.
    pub axis: Vec3,
    /// Half the map's width: in world units for a sun, the tangent of half the angle for a lamp.
    pub extent: f32,
    /// The smallest depth along the axis, in world units; above 0 for a lamp.
    pub near: f32,
    /// The largest depth along the axis, in world units.
    pub far: f32,
}

/// Two unit vectors, perpendicular to an axis and to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReflectiveShadowMapBasis {
    /// Direction towards the right edge of the map.
    pub right: Vec3,
    /// Direction towards the upper edge of the map.
    pub up: Vec3,
}

/// The map's axes, after Duff et al.
pub fn basis(axis: Vec3) -> ReflectiveShadowMapBasis {
    let side = if axis.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (side + axis.z);
    let b = axis.x * axis.y * a;
    let right = Vec3::new(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x);
    let up = Vec3::new(b, side + axis.y * axis.y * a, -axis.y);
    ReflectiveShadowMapBasis { right, up }
}

/// The axes by a cross product with the vertical: a naive form.
pub fn basis_naive(axis: Vec3) -> ReflectiveShadowMapBasis {
    let right = Vec3::Y.cross(axis).normalize();
    ReflectiveShadowMapBasis { right, up: axis.cross(right) }
}

/// The position of a point in a map, in WebGPU's clip coordinates.
pub fn clip(view: ReflectiveShadowMapView, position: Vec3) -> Vec4 {
    let basis = basis(-view.axis);
    let way = position - view.origin;
    let depth = way.dot(view.axis);
    let across = Vec2::new(way.dot(basis.right), way.dot(basis.up)) / view.extent;
    if view.lamp == 0 {
        return across.extend((depth - view.near) / (view.far - view.near)).extend(1.0);
    }
    across.extend((depth - view.near) * view.far / (view.far - view.near)).extend(depth)
}

/// The position of a point in the map, in texels from the upper left corner, from its clip
/// coordinates; (-1, -1) for points behind a lamp or in its plane.
pub fn texel(clip: Vec4, size: f32) -> Vec2 {
    if clip.w <= 0.0 {
        return Vec2::splat(-1.0);
    }
    (Vec2::splat(0.5) + Vec2::new(0.5, -0.5) * (Vec2::new(clip.x, clip.y) / clip.w)) * size
}

/// N·L for a normal of any length.
pub fn cosine(normal: Vec3, toward_light: Vec3) -> f32 {
    let unit = normal * (1.0 / normal.dot(normal).max(1e-30).sqrt());
    unit.dot(toward_light).clamp(0.0, 1.0)
}

/// The height of the position that the light sees at a point's texel, over the tangent plane of the
/// surface at the point.
pub fn height(seen: Vec3, position: Vec3, normal: Vec3) -> f32 {
    let unit = normal * (1.0 / normal.dot(normal).max(1e-30).sqrt());
    (seen - position).dot(unit)
}

/// The distance along the light by which the seen point is closer to the light: a naive form.
pub fn height_naive(seen: Vec3, position: Vec3, toward_light: Vec3) -> f32 {
    seen.dot(toward_light) - position.dot(toward_light)
}
