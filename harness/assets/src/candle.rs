//! A partly burnt candle: a bowl of melted wax around the wick, an uneven rim, and runs of wax down
//! the side.
//!
//! Lengths are in millimetres; y is up and the candle stands at 0. Its curvature is continuous, so
//! that scattering which depends on curvature shows no seams.

use glam::{DVec2, DVec3, dvec2};
use std::f64::consts::{PI, TAU};

use lapidary_scene::Mesh;
use lapidary_scene::surfaces::grid;

/// Number of quadrilaterals around, and along each span of the outline.
const COLUMNS: u32 = 64;
const ROWS: u32 = 3;

/// Radius of the side without runs of wax.
pub const RADIUS: f64 = 15.0;

/// Distance from the axis and height of the control points of the outline, a uniform cubic B-spline
/// from the centre of the bowl to the centre of the foot. Points are denser where it bends more.
const OUTLINE: [[f64; 2]; 15] = [
    [0.0, 51.0],
    [5.5, 51.5],
    [10.0, 55.0],
    [12.4, 60.0],
    [14.4, 60.0],
    [15.0, 56.5],
    [15.0, 49.0],
    [15.0, 41.0],
    [15.0, 33.0],
    [15.0, 25.0],
    [15.0, 16.0],
    [15.0, 7.0],
    [15.3, 0.0],
    [12.0, 0.0],
    [0.0, 0.0],
];

/// Parameter along the outline, from 0 to 1, at the top of the rim; wax runs down beyond it.
const RIM: f64 = 0.26;

/// Wax that has run over the rim and solidified.
struct Run {
    /// Azimuth from +z towards +x, in radians.
    azimuth: f64,
    /// Height of the lower end.
    end: f64,
    /// Distance from the middle at which the thickness has fallen to 1/e.
    half_width: f64,
}

const RUNS: [Run; 5] = [
    Run { azimuth: -0.85, end: 24.0, half_width: 2.9 },
    Run { azimuth: -0.35, end: 41.0, half_width: 2.7 },
    Run { azimuth: 0.55, end: 31.0, half_width: 3.1 },
    Run { azimuth: 1.6, end: 14.0, half_width: 3.0 },
    Run { azimuth: 3.4, end: 35.0, half_width: 3.2 },
];

/// Returns the candle, 31 mm wide and 60 mm high, with texture coordinates: u runs around it, v
/// from the centre of the bowl to the centre of the foot.
#[must_use]
pub fn mesh() -> Mesh {
    let spans = OUTLINE.len() as u32 - 1;
    grid([COLUMNS, ROWS * spans], |uv| (point(uv), normal(uv)))
}

fn point(uv: DVec2) -> DVec3 {
    let azimuth = TAU * uv.x.fract();
    let along = outline(uv.y);
    // Zero on the axis, so that each pole stays a single point.
    let aside = (along.x / RADIUS).powi(4);
    let over_rim = aside * step((uv.y - RIM) / 0.025);
    let radius = along.x + over_rim * RUNS.iter().map(|run| run.depth(azimuth, along.y)).sum::<f64>();
    let sag = 0.7 * (azimuth - 2.0).cos() + 0.45 * (2.0 * azimuth + 0.6).cos() + 0.2 * (5.0 * azimuth).sin();
    let height = along.y + aside * step((along.y - 45.0) / 2.5) * sag;
    DVec3::new(radius * azimuth.sin(), height, radius * azimuth.cos())
}

/// Returns the unit normal by central differences; at the poles it lies along the axis.
fn normal(uv: DVec2) -> DVec3 {
    const DIFFERENCE: f64 = 1e-5;
    if uv.y <= 0.0 {
        return DVec3::Y;
    }
    if uv.y >= 1.0 {
        return DVec3::NEG_Y;
    }
    let along = |way: DVec2| point(uv + DIFFERENCE * way) - point(uv - DIFFERENCE * way);
    along(DVec2::Y).cross(along(DVec2::X)).normalize()
}

impl Run {
    /// Returns how far the run stands out from the side.
    fn depth(&self, azimuth: f64, height: f64) -> f64 {
        let turn = (azimuth - self.azimuth + PI).rem_euclid(TAU) - PI;
        let (aside, above) = (RADIUS * turn / self.half_width, (height - self.end) / self.half_width);
        // A drop has gathered at the end of the run.
        let drop = 0.8 * (-(above - 0.9).powi(2)).exp();
        (1.3 + drop) * step(3.0 * above) * (-aside * aside).exp()
    }
}

/// The logistic function: a smooth step from 0 to 1.
fn step(place: f64) -> f64 {
    1.0 / (1.0 + (-place).exp())
}

/// Returns distance from the axis and height at a parameter from 0, the centre of the bowl, to 1,
/// the centre of the foot.
fn outline(place: f64) -> DVec2 {
    let last = OUTLINE.len() as i32 - 1;
    // The outline is mirrored beyond the axis.
    let control = |number: i32| {
        let [radius, height] = OUTLINE[(last - (last - number.abs()).abs()) as usize];
        dvec2(if (0..=last).contains(&number) { radius } else { -radius }, height)
    };
    let span = (place * f64::from(last)).floor().clamp(0.0, f64::from(last - 1));
    let t = place * f64::from(last) - span;
    let weights = [(1.0 - t).powi(3), (3.0 * t - 6.0) * t * t + 4.0, ((3.0 - 3.0 * t) * t + 3.0) * t + 1.0, t.powi(3)];
    let weighted = (span as i32 - 1..).zip(weights).map(|(number, weight)| weight * control(number));
    weighted.sum::<DVec2>() / 6.0
}

#[cfg(test)]
mod tests;
