//! The light by which jewellers photograph: large dim softboxes for metal, black flags between them, and rows of
//! small bright lights for stones. The mean is the studio's.
//!
//! Metal shows shapes by wide gradients and dark edges; a stone sparkles if small parts of what it
//! reflects are much brighter than the rest, and shows fire if they are narrower than its spread of colours.
//! Radiances and places are our own, chosen by eye.

use crate::environment_map::EnvironmentMap;
use crate::smoothstep::smoothstep;
use glam::{DVec2, DVec3};
use lapidary_environment::oracle;
use rayon::prelude::*;

/// Columns and rows of the map: a texel is 0.35°, a quarter of the smallest light's diameter.
const SIZE: [u32; 2] = [1024, 512];

/// A soft-edged rectangle at distance 1: see [`oracle::softbox`].
struct Panel {
    /// Direction of its middle, of any length.
    toward: DVec3,
    /// Half width and half height, as tangents.
    half: DVec2,
    /// Half width of its edge, as a tangent.
    softness: f64,
}

impl Panel {
    /// Coverage in [0, 1]; `direction` is a unit vector.
    fn coverage(&self, direction: DVec3) -> f64 {
        let axis = self.toward.normalize();
        let right = DVec3::Y.cross(axis).try_normalize().unwrap_or(DVec3::X);
        oracle::softbox(direction, axis, axis.cross(right), self.half, self.softness)
    }
}

const fn panel(toward: [f64; 3], half: [f64; 2], softness: f64) -> Panel {
    Panel { toward: DVec3::from_array(toward), half: DVec2::from_array(half), softness }
}

/// Softboxes, and their radiance in linear RGB.
const SOFTBOXES: [(Panel, DVec3); 6] = [
    // Overhead and a little behind: wide edges give the top of a band its gradient.
    (panel([0.0, 1.0, -0.35], [0.80, 0.52], 0.36), DVec3::new(2.6, 2.55, 2.45)),
    // The key at the left, warm; the same again at the right, cool and dimmer.
    (panel([-1.0, 0.50, 0.35], [0.46, 0.62], 0.22), DVec3::new(3.6, 3.4, 3.05)),
    (panel([1.0, 0.40, 0.55], [0.30, 0.55], 0.16), DVec3::new(2.2, 2.3, 2.5)),
    // Strips behind at both sides draw the bright lines along a band's edges.
    (panel([-0.62, 0.34, -1.0], [0.07, 0.50], 0.04), DVec3::new(7.0, 6.5, 5.6)),
    (panel([0.70, 0.38, -1.0], [0.09, 0.50], 0.04), DVec3::new(6.2, 6.6, 7.2)),
    // A card low in front, for what faces the viewer.
    (panel([0.20, -0.42, 1.0], [0.85, 0.26], 0.20), DVec3::new(1.0, 0.94, 0.86)),
];

/// Black flags: they take away the light behind them.
const FLAGS: [Panel; 5] = [
    // Beside the key, and across the overhead softbox.
    panel([-1.0, 0.50, 1.05], [0.10, 0.80], 0.03),
    panel([-1.0, 0.50, -0.30], [0.09, 0.80], 0.03),
    panel([0.0, 1.0, -0.35], [0.05, 0.95], 0.025),
    // The other side, and the camera with who holds it.
    panel([1.0, 0.42, 0.0], [0.16, 0.80], 0.03),
    panel([0.25, 0.75, 0.90], [0.22, 0.22], 0.05),
];

/// Half the angle of a small light and half the width of its edge, in radians.
const LIGHT: f64 = 0.014;
const EDGE: f64 = 0.006;

/// Rows of small lights: elevation in degrees, first and last azimuth in degrees from +z towards +x, number, and radiance.
const ROWS: [(f64, [f64; 2], u32, DVec3); 4] = [
    (58.0, [-74.0, -10.0], 6, DVec3::new(78.0, 74.0, 66.0)),
    (50.0, [52.0, 128.0], 6, DVec3::new(70.0, 74.0, 80.0)),
    (64.0, [150.0, 248.0], 7, DVec3::new(66.0, 66.0, 66.0)),
    (26.0, [-46.0, 46.0], 6, DVec3::new(44.0, 42.0, 38.0)),
];

/// Dark all round: below as a dark cloth, above as an unlit room.
const BELOW: DVec3 = DVec3::new(0.018, 0.018, 0.022);
const ABOVE: DVec3 = DVec3::new(0.07, 0.075, 0.085);

/// Returns the map.
pub(super) fn map() -> EnvironmentMap {
    let [width, height] = SIZE;
    let lights = small_lights();
    let pixel = |place: u32| {
        let [column, row] = [place % width, place / width].map(|part| f64::from(part) + 0.5);
        let uv = DVec2::new(column / f64::from(width), row / f64::from(height));
        radiance(&lights, oracle::direction_from_uv(uv)).as_vec3().extend(1.0).to_array()
    };
    EnvironmentMap { width, height, pixels: (0..width * height).into_par_iter().map(pixel).collect() }
}

/// Returns the directions of all small lights, and their radiance.
fn small_lights() -> Vec<(DVec3, DVec3)> {
    let row = |(elevation, [first, last], count, radiance): (f64, [f64; 2], u32, DVec3)| {
        let (up, across) = f64::to_radians(elevation).sin_cos();
        (0..count).map(move |number| {
            let share = f64::from(number) / f64::from(count - 1);
            let (x, z) = (first + share * (last - first)).to_radians().sin_cos();
            (DVec3::new(across * x, up, across * z), radiance)
        })
    };
    ROWS.into_iter().flat_map(row).collect()
}

/// Returns the linear RGB radiance from a unit direction.
fn radiance(lights: &[(DVec3, DVec3)], direction: DVec3) -> DVec3 {
    let mut sum = oracle::dome(direction, BELOW, ABOVE);
    for (softbox, radiance) in &SOFTBOXES {
        sum += softbox.coverage(direction) * *radiance;
    }
    for flag in &FLAGS {
        sum *= 1.0 - 0.97 * flag.coverage(direction);
    }
    // Small lights stand before the flags.
    for (toward, radiance) in lights {
        let angle = direction.cross(*toward).length().atan2(direction.dot(*toward));
        sum += smoothstep(LIGHT + EDGE, LIGHT - EDGE, angle) * *radiance;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Environment;
    use lapidary_srgb::oracle::luminance;
    use std::f64::consts::PI;

    /// Luminances of all directions of a grid, with their shares of the sphere.
    fn seen(radiance: impl Fn(DVec3) -> DVec3) -> Vec<(f64, f64)> {
        let [columns, rows] = SIZE;
        let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        let one = |(column, row): (u32, u32)| {
            let uv =
                DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5) / DVec2::new(columns.into(), rows.into());
            let edges = [row, row + 1].map(|edge| (PI * f64::from(edge) / f64::from(rows)).cos());
            (luminance(radiance(oracle::direction_from_uv(uv))), 0.5 * (edges[0] - edges[1]) / f64::from(columns))
        };
        places.map(one).collect()
    }

    fn of_map(map: &EnvironmentMap) -> Vec<(f64, f64)> {
        let environment = Environment::Map(map.clone());
        seen(|direction| environment.radiance(direction))
    }

    #[test]
    fn it_is_radiance_and_as_bright_as_the_studio_on_the_whole() {
        let map = map();
        assert!(map.pixels.iter().flatten().all(|part| part.is_finite() && *part >= 0.0));
        let mean = |seen: Vec<(f64, f64)>| seen.into_iter().map(|(light, share)| light * share).sum::<f64>();
        let (here, studio) = (mean(of_map(&map)), mean(seen(oracle::studio)));
        assert!((here / studio - 1.0).abs() < 0.05, "{here} and {studio}");
    }

    /// The contrast that docs/scene_files.md states.
    #[test]
    fn most_of_it_is_dark_and_a_little_is_very_bright() {
        let seen = of_map(&map());
        let share = |is_meant: fn(f64) -> bool| {
            seen.iter().filter(|(light, _)| is_meant(*light)).map(|(_, share)| share).sum::<f64>()
        };
        let (dark, bright) = (share(|light| light < 0.07), share(|light| light > 20.0));
        assert!(dark > 0.5, "{dark}");
        assert!((0.0005..0.005).contains(&bright), "{bright}");
    }
}
