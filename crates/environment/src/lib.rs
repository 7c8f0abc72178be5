//! Mirror of `wgsl/environment.wgsl`: coordinates and texels of a latitude-longitude map, and a
//! procedural studio. The WGSL file states the reasons, domains and accuracies.
//!
//! ```
//! use glam::Vec3;
//! use lapidary_environment::{direction_from_uv, uv_from_direction};
//!
//! let direction = Vec3::new(0.6, 0.0, 0.8);
//! let uv = uv_from_direction(direction);
//! assert!(direction_from_uv(uv).distance(direction) < 1e-6);
//! ```

#[cfg(feature = "formulas")]
pub mod formulas;
pub mod oracle;

use glam::{UVec2, Vec2, Vec3, Vec3Swizzles as _};

/// Returns the angle of the point (x, y) in turns, counterclockwise from +x, in [-1/2, 1/2].
#[rustfmt::skip] // two lines of coefficients, as in the shader
pub fn turns(y: f32, x: f32) -> f32 {
    let longer = x.abs().max(y.abs());
    let shorter = x.abs().min(y.abs());
    let ratio = shorter / longer.max(f32::MIN_POSITIVE);
    let s = ratio * ratio;
    let mut turns = ratio * (0.15915492 - s * (0.053049512 - s * (0.031782802 - s * (0.022312697
        - s * (0.015779087 - s * (0.009467554 - s * (0.0038598904 - s * 0.00074695825)))))));
    if y.abs() > x.abs() {
        turns = 0.25 - turns;
    }
    if x < 0.0 {
        turns = 0.5 - turns;
    }
    if y < 0.0 { -turns } else { turns }
}

/// Returns the length of the vector (a, b). The squares can neither overflow nor underflow.
pub fn hypot(a: f32, b: f32) -> f32 {
    let longer = a.abs().max(b.abs());
    let ratio = a.abs().min(b.abs()) / longer.max(f32::MIN_POSITIVE);
    longer * (1.0 + ratio * ratio).sqrt()
}

/// Returns the sine of an angle in turns, of any size.
pub fn sine(turns: f32) -> f32 {
    let wrapped = turns - turns.round_ties_even();
    let folded = wrapped.clamp(-0.5 - wrapped, 0.5 - wrapped);
    let s = folded * folded;
    folded * (6.2831855 - s * (41.34168 - s * (81.602234 - s * (76.57499 - s * 39.710918))))
}

/// Returns the latitude-longitude coordinates of a direction of any length.
pub fn uv_from_direction(direction: Vec3) -> Vec2 {
    let u = 0.5 + turns(direction.z, direction.x);
    let v = 2.0 * turns(hypot(direction.x, direction.z), direction.y);
    Vec2::new(u, v)
}

/// Computes the same coordinates with normalize and acos.
pub fn uv_from_direction_naive(direction: Vec3) -> Vec2 {
    let unit = direction / direction.length();
    Vec2::new(0.5 + unit.z.atan2(unit.x) * 0.15915494, unit.y.acos() * 0.31830987)
}

/// Returns the unit direction of latitude-longitude coordinates.
pub fn direction_from_uv(uv: Vec2) -> Vec3 {
    let polar = 0.5 * uv.y;
    let sin_polar = sine(polar);
    let cos_polar = -sine(polar - 0.25);
    let sin_azimuth = -sine(uv.x);
    let cos_azimuth = sine(uv.x - 0.25);
    Vec3::new(sin_polar * cos_azimuth, cos_polar, sin_polar * sin_azimuth)
}

/// The four texels around a point of the map, and their blend weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentTexels {
    /// Column and row of the texel at the lower coordinates.
    pub lower: UVec2,
    /// Column and row of the texel at the higher coordinates.
    pub upper: UVec2,
    /// Blend weight of `upper` along each axis.
    pub weight: Vec2,
}

/// Returns the texels and weights of a bilinear lookup: columns wrap, rows are clamped.
pub fn texels(uv: Vec2, size: UVec2) -> EnvironmentTexels {
    // The value of a texel is at its centre, half a texel from its edge.
    let column = (uv.x - uv.x.floor()) * size.x as f32 - 0.5;
    let row = (uv.y.clamp(0.0, 1.0) * size.y as f32 - 0.5).clamp(0.0, size.y as f32 - 1.0);
    // To the left of the first centre the column is -1; adding the width turns it into the last
    // column.
    let left = (column.floor() + size.x as f32) as u32 % size.x;
    let top = row.floor() as u32;
    let lower = UVec2::new(left, top);
    let upper = UVec2::new((left + 1) % size.x, (top + 1).min(size.y - 1));
    EnvironmentTexels { lower, upper, weight: Vec2::new(column - column.floor(), row - row.floor()) }
}

/// Computes the same with both coordinates clamped.
pub fn texels_naive(uv: Vec2, size: UVec2) -> EnvironmentTexels {
    let corner = uv * size.as_vec2() - 0.5;
    let lower = corner.floor().max(Vec2::ZERO).as_uvec2();
    let upper = (lower + 1).min(size - 1);
    EnvironmentTexels { lower, upper, weight: corner - corner.floor() }
}

/// The real spherical harmonics of a direction, orthonormal over the sphere. Within each degree,
/// the order runs from -l to l.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentHarmonics {
    /// Degree 0: constant.
    pub zeroth: f32,
    /// Degree 1, in the order y, z, x.
    pub first: Vec3,
    /// Degree 2.
    pub second: [f32; 5],
    /// Degree 4.
    pub fourth: [f32; 9],
}

/// Computes spherical harmonics as polynomials in the direction's components, with z as the polar
/// axis.
pub fn harmonics(direction: Vec3) -> EnvironmentHarmonics {
    let x = direction.x;
    let y = direction.y;
    let z = direction.z;
    let xx = x * x;
    let yy = y * y;
    let zz = z * z;
    let first = 0.48860252 * direction.yzx();
    let second = [
        1.0925485 * x * y,
        1.0925485 * y * z,
        0.31539157 * (3.0 * zz - 1.0),
        1.0925485 * x * z,
        0.54627424 * (xx - yy),
    ];
    let fourth = [
        2.5033429 * x * y * (xx - yy),
        1.7701308 * y * z * (3.0 * xx - yy),
        0.9461747 * x * y * (7.0 * zz - 1.0),
        0.66904655 * y * z * (7.0 * zz - 3.0),
        0.10578555 * (zz * (35.0 * zz - 30.0) + 3.0),
        0.66904655 * x * z * (7.0 * zz - 3.0),
        0.47308735 * (xx - yy) * (7.0 * zz - 1.0),
        1.7701308 * x * z * (xx - 3.0 * yy),
        0.62583573 * (xx * (xx - 3.0 * yy) - yy * (3.0 * xx - yy)),
    ];
    EnvironmentHarmonics { zeroth: 0.28209478, first, second, fourth }
}

/// Returns the coverage of a direction by a rectangular light with soft edges, in [0, 1].
pub fn softbox(direction: Vec3, axis: Vec3, up: Vec3, half_size: Vec2, softness: f32) -> f32 {
    let depth = direction.dot(axis);
    // The projection ignores the sign of the depth: without this test, -axis would hit the middle
    // of the light. The smallest normal number still has a finite reciprocal.
    if depth < f32::MIN_POSITIVE {
        return 0.0;
    }
    let right = up.cross(axis);
    // Reciprocals are used because a division costs as much as several multiplications; the
    // division by a constant softness costs nothing at all.
    let position = Vec2::new(direction.dot(right), direction.dot(up)) * (1.0 / depth);
    let inside = (half_size + softness - position.abs()) * (0.5 / softness);
    let t = inside.clamp(Vec2::ZERO, Vec2::ONE);
    let coverage = t * t * (3.0 - 2.0 * t);
    coverage.x * coverage.y
}

/// Computes the same without the test of the depth's sign.
pub fn softbox_naive(direction: Vec3, axis: Vec3, up: Vec3, half_size: Vec2, softness: f32) -> f32 {
    let depth = direction.dot(axis);
    let right = up.cross(axis);
    let position = Vec2::new(direction.dot(right), direction.dot(up)) * (1.0 / depth);
    let inside = (half_size + softness - position.abs()) * (0.5 / softness);
    let t = inside.clamp(Vec2::ZERO, Vec2::ONE);
    let coverage = t * t * (3.0 - 2.0 * t);
    coverage.x * coverage.y
}

/// Returns the radiance of a dome that changes from `ground` at the nadir to `zenith` at the
/// zenith.
pub fn dome(direction: Vec3, ground: Vec3, zenith: Vec3) -> Vec3 {
    let height = 0.5 + 0.5 * direction.y;
    let weight = height * height;
    ground * (1.0 - weight) + zenith * weight
}

/// Returns the radiance of a jeweller's studio: a dim tent over dark paper, with a few small,
/// bright lights.
#[rustfmt::skip] // a light is two lines, as in the shader
pub fn studio(direction: Vec3) -> Vec3 {
    // Surround: dark paper below, a dim, slightly blue tent above.
    let surround = dome(direction, Vec3::new(0.025, 0.024, 0.026), Vec3::new(0.26, 0.30, 0.38));
    // Key light: a square softbox at the front left, high and slightly warm.
    let key = Vec3::new(9.0, 8.4, 7.2) * softbox(direction,
        Vec3::new(-2.0, 6.0, 3.0) / 7.0, Vec3::new(6.0, 3.0, -2.0) / 7.0, Vec2::new(0.28, 0.28), 0.05);
    // Overhead: a long neutral strip just behind the zenith, which the table and the upper halves
    // reflect.
    let overhead = Vec3::new(13.0, 13.0, 13.0) * softbox(direction,
        Vec3::new(0.0, 24.0, -7.0) / 25.0, Vec3::new(0.0, 7.0, 24.0) / 25.0, Vec2::new(0.70, 0.06), 0.03);
    // Two upright strips, cool from the right and warm from the back left, give the two sides of
    // the bezels different colours.
    let cool_strip = Vec3::new(7.0, 8.6, 10.0) * softbox(direction,
        Vec3::new(6.0, 3.0, 2.0) / 7.0, Vec3::new(-2.0, 6.0, -3.0) / 7.0, Vec2::new(0.08, 0.45), 0.04);
    let warm_strip = Vec3::new(9.0, 7.2, 5.0) * softbox(direction,
        Vec3::new(-2.0, 1.0, -2.0) / 3.0, Vec3::new(2.0, 2.0, -1.0) / 3.0, Vec2::new(0.09, 0.40), 0.04);
    // Three sparks, too small to light the stone but bright enough for dispersion to spread them
    // into colours.
    let back_spark = Vec3::new(20.0, 19.0, 17.0) * softbox(direction,
        Vec3::new(4.0, 7.0, -4.0) / 9.0, Vec3::new(1.0, 4.0, 8.0) / 9.0, Vec2::new(0.08, 0.08), 0.03);
    let front_spark = Vec3::new(15.0, 16.0, 18.0) * softbox(direction,
        Vec3::new(1.0, 2.0, 2.0) / 3.0, Vec3::new(-2.0, 2.0, -1.0) / 3.0, Vec2::new(0.07, 0.07), 0.03);
    let low_spark = Vec3::new(16.0, 16.0, 16.0) * softbox(direction,
        Vec3::new(2.0, 3.0, -6.0) / 7.0, Vec3::new(6.0, 2.0, 3.0) / 7.0, Vec2::new(0.06, 0.06), 0.03);
    // Two cards from below, like the white paper that a jeweller holds there: they keep the
    // pavilion from going dark when the stone is tilted.
    let back_card = Vec3::new(2.6, 2.75, 2.9) * softbox(direction,
        Vec3::new(0.0, -3.0, -4.0) / 5.0, Vec3::new(0.0, 4.0, -3.0) / 5.0, Vec2::new(0.60, 0.20), 0.10);
    let front_card = Vec3::new(2.0, 1.85, 1.7) * softbox(direction,
        Vec3::new(0.0, -5.0, 12.0) / 13.0, Vec3::new(0.0, 12.0, 5.0) / 13.0, Vec2::new(0.50, 0.14), 0.10);
    surround + key + overhead + cool_strip + warm_strip + back_spark + front_spark + low_spark + back_card + front_card
}

#[cfg(test)]
mod tests;
