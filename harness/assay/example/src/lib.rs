//! Value noise in Rust, for the game's logic; `noise.wgsl` is the same for its shaders.

use glam::{IVec2, Vec2, Vec2Swizzles as _};

/// The noise and its slope at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Noise in [0, 1).
    pub value: f32,
    /// Slope per unit of either coordinate.
    pub slope: Vec2,
}

/// Returns the random bits of a corner.
pub fn hash(corner: IVec2) -> u32 {
    let x = corner.x.cast_unsigned().wrapping_mul(0x9e37_79b9);
    let mut bits = x.wrapping_add(corner.y.cast_unsigned().wrapping_mul(0x85eb_ca6b));
    bits = (bits ^ (bits >> 15)).wrapping_mul(0x2c1b_3c6d);
    bits = (bits ^ (bits >> 12)).wrapping_mul(0x297a_2d39);
    bits ^ (bits >> 15)
}

/// Returns the value at a corner, in [0, 1).
pub fn corner(corner: IVec2) -> f32 {
    (hash(corner) >> 8) as f32 * 5.960_464_5e-8
}

/// Returns the value and slope at `place`.
pub fn sample(place: Vec2) -> Sample {
    let cell = place.floor();
    let t = place - cell;
    let lattice = cell.as_ivec2();
    let [a, b, c, d] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| corner(lattice + IVec2::new(x, y)));
    let fade = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let rise = 30.0 * t * t * (t * (t - 2.0) + 1.0);
    let twist = a - b - c + d;
    Sample {
        value: a + (b - a) * fade.x + (c - a) * fade.y + twist * fade.x * fade.y,
        slope: rise * (Vec2::new(b, c) - a + twist * fade.yx()),
    }
}
