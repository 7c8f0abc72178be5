//! The oracle in f64. The exit is the shortest of the distances to all six sides that lie ahead. The
//! square adds up the parts of the octahedron's edge that a point lies between, without a difference.

use glam::{DVec2, DVec3};

/// Slope below which a ray is parallel to a side, rounded to f32.
const PARALLEL: f64 = 1e-20f32 as f64;

/// Returns the shortest distance to a side of the box ahead.
pub fn exit(position: DVec3, direction: DVec3, lower: DVec3, upper: DVec3) -> f64 {
    let mut nearest = f64::INFINITY;
    for axis in 0..3 {
        for (normal, side) in [(1.0, upper[axis]), (-1.0, -lower[axis])] {
            let slope = normal * direction[axis];
            let height = side - normal * position[axis];
            // A direction of 0 counts as towards the lower side.
            if slope > 0.0 || slope == 0.0 && normal < 0.0 {
                nearest = nearest.min(height.max(0.0) / slope.max(PARALLEL));
            }
        }
    }
    nearest
}

/// Returns the octahedral coordinates.
pub fn square(point: DVec3) -> DVec2 {
    let [x, y, z] = point.to_array();
    let sum = x.abs() + y.abs() + z.abs();
    if sum == 0.0 {
        return DVec2::ZERO;
    }
    let side = |value: f64| if value >= 0.0 { 1.0 } else { -1.0 };
    match z >= 0.0 {
        true => DVec2::new(x / sum, y / sum),
        // 1 - |y| / sum, and the same for x.
        false => DVec2::new(side(x) * (x.abs() - z) / sum, side(y) * (y.abs() - z) / sum),
    }
}

/// Returns the cell, counted in whole numbers.
pub fn cell(square: DVec2, side: u32) -> u32 {
    let along = |value: f64| {
        // A whole number of cells from the middle, which is below 0 for any value below 0.
        let from_middle = (0.5 * value * f64::from(side)).floor() as i64;
        (from_middle + i64::from(side / 2)).clamp(0, i64::from(side) - 1) as u32
    };
    along(square.x) + side * along(square.y)
}
