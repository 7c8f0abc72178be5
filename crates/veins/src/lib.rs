//! Rust mirror of `wgsl/veins.wgsl`, line by line: density of veined stone. The comments of the
//! WGSL functions state units, domain and accuracy.
//!
//! ```
//! use glam::Vec3;
//! use lapidary_veins::noise;
//!
//! // Gradient noise is 0 at the corners of its lattice.
//! assert_eq!(noise(Vec3::new(1.0, 2.0, 3.0), 42), 0.0);
//! assert_ne!(noise(Vec3::new(1.5, 2.25, 3.125), 42), 0.0);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{IVec3, UVec4, Vec3, Vec4, Vec4Swizzles as _};

/// Positions are clamped to this many cells from the origin on each axis.
pub const VEINS_FARTHEST: f32 = 4194304.0;
/// The minimum width of a vein; smaller widths are clamped to it.
pub const VEINS_NARROWEST: f32 = 0.0009765625;
/// The maximum width, 2²⁰; larger widths are clamped to it.
pub const VEINS_WIDEST: f32 = 1_048_576.0;
/// The maximum number of octaves.
pub const VEINS_MOST_OCTAVES: u32 = 8;

/// A cell of the noise and a position in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VeinsCell {
    /// Corner of the cell at the lower coordinates.
    pub corner: IVec3,
    /// Position relative to that corner, in [0, 1].
    pub offset: Vec3,
}

/// Parameters of a stone's veins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VeinsPattern {
    /// Number of cells of the first octave per unit of length.
    pub frequency: f32,
    /// Value of the noise at which a vein's density has fallen halfway to `least`.
    pub width: f32,
    /// Density between the veins.
    pub least: f32,
    /// Density in the middle of a vein.
    pub greatest: f32,
    /// Number of octaves, 0 to 8; more count as 8.
    pub octaves: u32,
    /// Seed; different seeds give different veins.
    pub seed: u32,
}

/// Cell of the noise at a point.
pub fn cell(position: Vec3) -> VeinsCell {
    let p = position.clamp(Vec3::splat(-VEINS_FARTHEST), Vec3::splat(VEINS_FARTHEST));
    let lower = p.floor();
    VeinsCell { corner: lower.as_ivec3(), offset: p - lower }
}

/// The cell by conversion to integers: a naive form.
pub fn cell_naive(position: Vec3) -> VeinsCell {
    let corner = position.as_ivec3();
    VeinsCell { corner, offset: position - corner.as_vec3() }
}

/// Random bits for a corner of the grid, by pcg4d.
pub fn hash(corner: IVec3, seed: u32) -> u32 {
    let mut v =
        corner.as_uvec3().extend(seed).wrapping_mul(UVec4::splat(1664525)).wrapping_add(UVec4::splat(1013904223));
    v.x = v.x.wrapping_add(v.y.wrapping_mul(v.w));
    v.y = v.y.wrapping_add(v.z.wrapping_mul(v.x));
    v.z = v.z.wrapping_add(v.x.wrapping_mul(v.y));
    v.w = v.w.wrapping_add(v.y.wrapping_mul(v.z));
    v ^= v >> UVec4::splat(16);
    v.x.wrapping_add(v.y.wrapping_mul(v.w))
}

/// One of the twelve directions from the centre of a cube to the middles of its edges.
pub fn gradient(bits: u32) -> Vec3 {
    let first = if (bits & 0x80000000) != 0 { -1.0 } else { 1.0 };
    let second = if (bits & 0x40000000) != 0 { -1.0 } else { 1.0 };
    let axis = bits % 3;
    if axis == 0 {
        return Vec3::new(0.0, first, second);
    }
    if axis == 1 {
        return Vec3::new(first, 0.0, second);
    }
    Vec3::new(first, second, 0.0)
}

/// The contribution of one corner to the noise, before fading.
pub fn corner(cell: VeinsCell, corner: IVec3, seed: u32) -> f32 {
    gradient(hash(cell.corner + corner, seed)).dot(cell.offset - corner.as_vec3())
}

/// Gradient noise.
pub fn noise(position: Vec3, seed: u32) -> f32 {
    let cell = cell(position);
    let o = cell.offset;
    let fade = o * o * o * (o * (o * 6.0 - 15.0) + 10.0);
    let near = Vec4::new(
        corner(cell, IVec3::new(0, 0, 0), seed),
        corner(cell, IVec3::new(0, 1, 0), seed),
        corner(cell, IVec3::new(0, 0, 1), seed),
        corner(cell, IVec3::new(0, 1, 1), seed),
    );
    let far = Vec4::new(
        corner(cell, IVec3::new(1, 0, 0), seed),
        corner(cell, IVec3::new(1, 1, 0), seed),
        corner(cell, IVec3::new(1, 0, 1), seed),
        corner(cell, IVec3::new(1, 1, 1), seed),
    );
    let along_x = near + fade.x * (far - near);
    let along_y = along_x.xz() + fade.y * (along_x.yw() - along_x.xz());
    along_y.x + fade.z * (along_y.y - along_y.x)
}

/// A sum of octaves of the noise.
pub fn fractal(position: Vec3, octaves: u32, seed: u32) -> f32 {
    let mut sum = 0.0;
    let mut amplitude = 1.0;
    let mut place = position;
    for octave in 0..octaves.min(VEINS_MOST_OCTAVES) {
        sum += amplitude * noise(place, seed.wrapping_add(octave));
        amplitude *= 0.5;
        place *= 2.0;
    }
    sum
}

/// A vein where the noise passes through 0.
pub fn fold(value: f32, width: f32) -> f32 {
    let half = width.clamp(VEINS_NARROWEST, VEINS_WIDEST);
    let squared = half * half;
    (squared / (squared + value * value)).min(1.0)
}

/// A vein by the absolute value: a naive form.
pub fn fold_naive(value: f32, width: f32) -> f32 {
    1.0 - value.abs() / (2.0 * width)
}

/// Density of veined stone.
pub fn density(position: Vec3, pattern: VeinsPattern) -> f32 {
    let value = fractal(position * pattern.frequency, pattern.octaves, pattern.seed);
    let share = fold(value, pattern.width);
    pattern.least * (1.0 - share) + pattern.greatest * share
}

#[cfg(test)]
mod tests;
