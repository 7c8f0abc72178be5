//! Mirror of `wgsl/convex_walk.wgsl`: the facet through which a ray leaves a convex stone, found in
//! a few steps over a map of the facets by direction; and the map, made from the stone's planes.
//!
//! The WGSL file states the units, domain and accuracy of each function. This file follows it line
//! by line. [`FacetMap`] is what a host uploads beside the planes.
//!
//! ```
//! use glam::{Vec3, vec4};
//! use lapidary_convex_walk::FacetMap;
//!
//! // A cube about the origin: outward normal and distance of each face.
//! let planes = [1.0, -1.0].into_iter().flat_map(|s| [vec4(s, 0.0, 0.0, 1.0), vec4(0.0, s, 0.0, 1.0), vec4(0.0, 0.0, s, 1.0)]);
//! let map = FacetMap::of_planes(&planes.collect::<Vec<_>>(), 64)?;
//! // Along +x, only the face +x is seen.
//! assert!(map.candidates(Vec3::X).all(|face| face == 0));
//! # Ok::<(), lapidary_convex_walk::NoMap>(())
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
mod map;
pub mod oracle;

pub use map::{FacetMap, NoMap, facet_corners};

use glam::{Vec2, Vec2Swizzles as _, Vec3, Vec3Swizzles as _};

/// The bits of a word that hold a facet's number: at most 4096 facets.
pub const CONVEX_WALK_FACE: u32 = 0xfff;
/// The bits below a word's second part.
pub const CONVEX_WALK_SHIFT: u32 = 12;
/// The bits of the second part, after the shift.
pub const CONVEX_WALK_PLACE: u32 = 0x7ffff;
/// The bit of a word that another follows.
pub const CONVEX_WALK_MORE: u32 = 0x8000_0000;
/// Most words that a walk may read.
pub const CONVEX_WALK_STEPS: u32 = 16384;
/// Slope below which a ray is parallel to a side of the box.
pub const CONVEX_WALK_PARALLEL: f32 = 1e-20;

/// Returns the distance at which a ray leaves a box.
pub fn exit(position: Vec3, direction: Vec3, lower: Vec3, upper: Vec3) -> f32 {
    let height = Vec3::select(direction.cmpgt(Vec3::ZERO), upper - position, position - lower);
    let slope = direction.abs().max(Vec3::splat(CONVEX_WALK_PARALLEL));
    let distance = height.max(Vec3::ZERO) / slope;
    distance.x.min(distance.y).min(distance.z)
}

/// Returns the octahedral coordinates of a point's direction from the origin.
pub fn square(point: Vec3) -> Vec2 {
    let sum = (point.x.abs() + point.y.abs() + point.z.abs()).max(1e-37);
    let inner = point.xy() / sum;
    if point.z >= 0.0 {
        return inner;
    }
    let outer = Vec2::ONE - inner.yx().abs();
    Vec2::select(point.xy().cmpge(Vec2::ZERO), outer, -outer)
}

/// Returns the octahedral coordinates with `sign` for the side on which a point lies.
pub fn square_naive(point: Vec3) -> Vec2 {
    let inner = point.xy() / (point.x.abs() + point.y.abs() + point.z.abs());
    if point.z >= 0.0 {
        return inner;
    }
    let sign = |value: f32| if value == 0.0 { 0.0 } else { value.signum() };
    (Vec2::ONE - inner.yx().abs()) * Vec2::new(sign(point.x), sign(point.y))
}

/// Returns the cell of the map that holds a place on the square.
pub fn cell(square: Vec2, side: u32) -> u32 {
    let half_side = (side / 2) as f32;
    let place = (square * half_side).floor().clamp(Vec2::splat(-half_side), Vec2::splat(half_side - 1.0));
    let cell = (place + half_side).as_uvec2();
    cell.x + side * cell.y
}

#[cfg(test)]
mod tests;
