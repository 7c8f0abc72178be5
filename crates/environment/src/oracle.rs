//! Exact results for `environment`, in f64 and by other formulas than the mirror's.

use glam::{DMat3, DVec2, DVec3, UVec2};
use std::f64::consts::{PI, TAU};

/// Computes the angle by the half-angle formula, atan(y / (r + |x|)), which never meets the borders
/// of the quadrants.
pub fn turns(y: f64, x: f64) -> f64 {
    let radius = (x * x + y * y).sqrt();
    if radius == 0.0 {
        return 0.0;
    }
    let acute = (y / (radius + x.abs())).atan() / PI;
    match (x < 0.0, y < 0.0) {
        (false, _) => acute,
        (true, false) => 0.5 - acute,
        (true, true) => -0.5 - acute,
    }
}

/// Applies Pythagoras' theorem directly: the square of an f32 neither overflows nor underflows in
/// f64.
pub fn hypot(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

/// Computes the library's sine of the angle, reduced by the nearest half turn, whose parity is the
/// sign.
pub fn sine(turns: f64) -> f64 {
    let half_turns = (2.0 * turns).round();
    let sign = if half_turns.rem_euclid(2.0) == 0.0 { 1.0 } else { -1.0 };
    sign * (TAU * (turns - 0.5 * half_turns)).sin()
}

/// Computes the polar angle by Kahan's formula, 2 atan(|d - |d| y| / |d + |d| y|) with y the
/// zenith.
pub fn uv_from_direction(direction: DVec3) -> DVec2 {
    let zenith = direction.length() * DVec3::Y;
    let polar = 2.0 * (direction - zenith).length().atan2((direction + zenith).length());
    DVec2::new(0.5 + turns(direction.z, direction.x), polar / PI)
}

/// Rotates the zenith twice: down towards +x by the polar angle, then about the vertical by the
/// azimuth.
pub fn direction_from_uv(uv: DVec2) -> DVec3 {
    DMat3::from_rotation_y(-TAU * (uv.x - 0.5)) * (DMat3::from_rotation_z(-PI * uv.y) * DVec3::Y)
}

/// The mirror's struct in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentTexels {
    /// Column and row of the texel at the lower coordinates.
    pub lower: UVec2,
    /// Column and row of the texel at the higher coordinates.
    pub upper: UVec2,
    /// Blend weight of `upper` along each axis.
    pub weight: DVec2,
}

/// Finds the nearest edge between two texels, on a ring of columns and a ladder of rows. The texels
/// on its two sides are the result, and the distance from the edge gives the weight.
pub fn texels(uv: DVec2, size: UVec2) -> EnvironmentTexels {
    let rows = f64::from(size.y);
    let u = uv.x.rem_euclid(1.0) * f64::from(size.x);
    let v = (uv.y * rows).max(0.5).min(rows - 0.5);
    // Halfway between two edges the higher one counts: a point at a centre is in the lower texel of
    // its pair.
    let nearest = |x: f64| (x + 0.5).floor();
    let (edge_u, edge_v) = (nearest(u), nearest(v));
    let column = |edge: f64| edge.rem_euclid(f64::from(size.x)) as u32;
    let row = |index: f64| index.min(rows - 1.0) as u32;
    EnvironmentTexels {
        lower: UVec2::new(column(edge_u - 1.0), row(edge_v - 1.0)),
        upper: UVec2::new(column(edge_u), row(edge_v)),
        weight: DVec2::new(0.5 + u - edge_u, 0.5 + v - edge_v),
    }
}

/// The mirror's struct in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentHarmonics {
    /// Degree 0: constant.
    pub zeroth: f64,
    /// Degree 1, in the order y, z, x.
    pub first: DVec3,
    /// Degree 2, by order from -2 to 2.
    pub second: [f64; 5],
    /// Degree 4, by order from -4 to 4.
    pub fourth: [f64; 9],
}

/// Computes the harmonics from angles, degree by degree.
pub fn harmonics(direction: DVec3) -> EnvironmentHarmonics {
    EnvironmentHarmonics {
        zeroth: harmonic(0, 0, direction),
        first: DVec3::new(harmonic(1, -1, direction), harmonic(1, 0, direction), harmonic(1, 1, direction)),
        second: std::array::from_fn(|k| harmonic(2, k as i32 - 2, direction)),
        fourth: std::array::from_fn(|k| harmonic(4, k as i32 - 4, direction)),
    }
}

/// Returns the associated Legendre function of the polar angle, by its recurrence over the degree
/// and without the Condon-Shortley sign, times the cosine or sine of a multiple of the azimuth.
fn harmonic(l: u32, m: i32, direction: DVec3) -> f64 {
    let order = m.unsigned_abs();
    let across = direction.truncate().length();
    let (sine, cosine) = across.atan2(direction.z).sin_cos();
    let mut legendre = (0..order).fold(1.0, |value, k| value * f64::from(2 * k + 1) * sine);
    let mut before = 0.0;
    for degree in order + 1..=l {
        let next = (f64::from(2 * degree - 1) * cosine * legendre - f64::from(degree + order - 1) * before)
            / f64::from(degree - order);
        (before, legendre) = (legendre, next);
    }
    let factorials: f64 = (l - order + 1..=l + order).map(f64::from).product();
    let norm = (f64::from(2 * l + 1) / (4.0 * PI) / factorials).sqrt();
    let azimuth = direction.y.atan2(direction.x) * f64::from(order);
    let around = match m.signum() {
        0 => 1.0,
        1 => 2f64.sqrt() * azimuth.cos(),
        _ => 2f64.sqrt() * azimuth.sin(),
    };
    norm * legendre * around
}

/// Intersects the ray with the light's plane, whose point nearest to the origin is `axis`. Each
/// smoothstep is the area under 6 x (1 - x), by Simpson's rule, which is exact for it.
pub fn softbox(direction: DVec3, axis: DVec3, up: DVec3, half_size: DVec2, softness: f64) -> f64 {
    let along = axis.length_squared() / direction.dot(axis);
    if direction.dot(axis) <= 0.0 {
        return 0.0;
    }
    let on_plane = direction * along - axis;
    let edge = |from_middle: f64, half: f64| {
        let into = ((half + softness - from_middle.abs()) / (2.0 * softness)).clamp(0.0, 1.0);
        let density = |x: f64| 6.0 * x * (1.0 - x);
        into / 6.0 * (density(0.0) + 4.0 * density(0.5 * into) + density(into))
    };
    edge(on_plane.dot(up.cross(axis)), half_size.x) * edge(on_plane.dot(up), half_size.y)
}

/// Computes the weight as cos^4 of half the angle to the zenith.
pub fn dome(direction: DVec3, ground: DVec3, zenith: DVec3) -> DVec3 {
    let polar = direction.y.clamp(-1.0, 1.0).acos();
    ground.lerp(zenith, (0.5 * polar).cos().powi(4))
}

/// Adds the brightest light to the dome: no two lights overlap, so the maximum replaces the sum. A
/// light is (tint, axis and up as integer vectors, their common length, half size, softness).
pub fn studio(direction: DVec3) -> DVec3 {
    type Light = ([f64; 3], [f64; 3], [f64; 3], f64, [f64; 2], f64);
    const LIGHTS: [Light; 9] = [
        ([9.0, 8.4, 7.2], [-2.0, 6.0, 3.0], [6.0, 3.0, -2.0], 7.0, [0.28, 0.28], 0.05),
        ([13.0, 13.0, 13.0], [0.0, 24.0, -7.0], [0.0, 7.0, 24.0], 25.0, [0.70, 0.06], 0.03),
        ([7.0, 8.6, 10.0], [6.0, 3.0, 2.0], [-2.0, 6.0, -3.0], 7.0, [0.08, 0.45], 0.04),
        ([9.0, 7.2, 5.0], [-2.0, 1.0, -2.0], [2.0, 2.0, -1.0], 3.0, [0.09, 0.40], 0.04),
        ([20.0, 19.0, 17.0], [4.0, 7.0, -4.0], [1.0, 4.0, 8.0], 9.0, [0.08, 0.08], 0.03),
        ([15.0, 16.0, 18.0], [1.0, 2.0, 2.0], [-2.0, 2.0, -1.0], 3.0, [0.07, 0.07], 0.03),
        ([16.0, 16.0, 16.0], [2.0, 3.0, -6.0], [6.0, 2.0, 3.0], 7.0, [0.06, 0.06], 0.03),
        ([2.6, 2.75, 2.9], [0.0, -3.0, -4.0], [0.0, 4.0, -3.0], 5.0, [0.60, 0.20], 0.10),
        ([2.0, 1.85, 1.7], [0.0, -5.0, 12.0], [0.0, 12.0, 5.0], 13.0, [0.50, 0.14], 0.10),
    ];
    let surround = dome(direction, DVec3::new(0.025, 0.024, 0.026), DVec3::new(0.26, 0.30, 0.38));
    LIGHTS.iter().fold(surround, |radiance, (tint, axis, up, length, half_size, softness)| {
        let axis = DVec3::from_array(*axis) / *length;
        let up = DVec3::from_array(*up) / *length;
        let coverage = softbox(direction, axis, up, DVec2::from_array(*half_size), *softness);
        radiance.max(surround + DVec3::from_array(*tint) * coverage)
    })
}
