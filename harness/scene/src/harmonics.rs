//! Spherical harmonics of the environment: its radiance projected onto the degrees that a clamped
//! cosine contains.

use crate::Environment;
use glam::{DVec2, DVec3};
use lapidary_environment::oracle;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Number of coefficients: 1 of degree 0, 3 of 1, 5 of 2, 9 of 4.
pub const COUNT: usize = 18;

/// Columns and rows of the grid of directions, at least. The studio's sharpest edge is 3° wide, or 5 rows.
const LEAST: [u32; 2] = [512, 256];

/// Weight of a clamped cosine for each harmonic of degrees 0, 1, 2 and 4, and the number of
/// harmonics of that degree.
const WEIGHTS: [(f64, usize); 4] = [(PI, 1), (2.0 * PI / 3.0, 3), (PI / 4.0, 5), (-PI / 24.0, 9)];

/// Returns the columns and rows of the grid for an environment: every texel of an image is met, in its middle, or
/// as often as others.
fn grid(environment: &Environment) -> [u32; 2] {
    let Environment::Map(map) = environment else { return LEAST };
    let [width, height] = [map.width.max(1), map.height.max(1)];
    [width * LEAST[0].div_ceil(width), height * LEAST[1].div_ceil(height)]
}

/// Returns the coefficients, linear RGB, by degree and order.
#[must_use]
pub fn project(environment: &Environment) -> [DVec3; COUNT] {
    // The studio is always the same, and every frame that it lights asks.
    static STUDIO: OnceLock<[DVec3; COUNT]> = OnceLock::new();
    match environment {
        Environment::Studio => *STUDIO.get_or_init(|| projected(environment)),
        _ => projected(environment),
    }
}

fn projected(environment: &Environment) -> [DVec3; COUNT] {
    let [columns, rows] = grid(environment);
    let row = |row: u32| {
        let v = (f64::from(row) + 0.5) / f64::from(rows);
        // The exact solid angle of a cell: dz dφ.
        let edges = [row, row + 1].map(|edge| (PI * f64::from(edge) / f64::from(rows)).cos());
        let solid_angle = (edges[0] - edges[1]) * 2.0 * PI / f64::from(columns);
        let mut sums = [DVec3::ZERO; COUNT];
        for column in 0..columns {
            let uv = DVec2::new((f64::from(column) + 0.5) / f64::from(columns), v);
            let direction = oracle::direction_from_uv(uv);
            let arriving = solid_angle * environment.radiance(direction);
            for (sum, value) in sums.iter_mut().zip(basis(direction)) {
                *sum += value * arriving;
            }
        }
        sums
    };
    // Rows are summed in order, so the sums do not depend on the number of threads.
    let sums: Vec<[DVec3; COUNT]> = (0..rows).into_par_iter().map(row).collect();
    sums.into_iter().fold([DVec3::ZERO; COUNT], |all, row| std::array::from_fn(|k| all[k] + row[k]))
}

/// Returns the irradiance, linear RGB, on a surface with this unit normal from which nothing hides
/// the environment, given the coefficients of [`project`].
///
/// By the theorem of Funk and Hecke a clamped cosine weights the degrees 0, 1, 2 and 4 by π, 2π/3,
/// π/4 and -π/24. It contains no higher odd degree. The even degrees from 6 on are left out, as in
/// the recipes: opposite to a small bright light the sum falls below 0, and is clamped there.
#[must_use]
pub fn irradiance(coefficients: &[DVec3; COUNT], normal: DVec3) -> DVec3 {
    let parts = coefficients.iter().zip(basis(normal)).zip(weights());
    let sum: DVec3 = parts.map(|((coefficient, value), weight)| weight * value * *coefficient).sum();
    sum.max(DVec3::ZERO)
}

/// Returns a bound of [`irradiance`] over all normals.
///
/// By the theorem of addition the squares of the harmonics of degree l add up to (2l + 1)/(4π) in every
/// direction, so that by Cauchy and Schwarz a degree adds at most the root of that times the length of its
/// coefficients.
#[must_use]
pub fn largest_irradiance(coefficients: &[DVec3; COUNT]) -> DVec3 {
    let mut rest = &coefficients[..];
    let mut sum = DVec3::ZERO;
    for (weight, orders) in WEIGHTS {
        let (of_degree, others) = rest.split_at(orders);
        let squares: DVec3 = of_degree.iter().map(|coefficient| *coefficient * *coefficient).sum();
        sum += weight.abs() * (squares * orders as f64 / (4.0 * PI)).map(f64::sqrt);
        rest = others;
    }
    sum
}

/// Returns the weight of a clamped cosine for each harmonic.
pub fn weights() -> impl Iterator<Item = f64> {
    WEIGHTS.into_iter().flat_map(|(weight, orders)| std::iter::repeat_n(weight, orders))
}

/// Returns the harmonics' values in a direction, a unit vector.
pub fn basis(direction: DVec3) -> impl Iterator<Item = f64> {
    // The mirror's polynomials: a hundred times faster than the oracle's angles, and accurate to
    // 2e-6.
    let values = lapidary_environment::harmonics(direction.as_vec3());
    let all = [values.zeroth].into_iter().chain(values.first.to_array()).chain(values.second).chain(values.fourth);
    all.map(f64::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment_map::EnvironmentMap;

    /// Returns a map with this radiance at the middles of its texels.
    fn map(radiance: impl Fn(DVec3) -> DVec3) -> Environment {
        let (width, height) = (128, 64);
        let pixels = (0..width * height).map(|place| {
            let [column, row] = [place % width, place / width].map(|index| f64::from(index) + 0.5);
            let uv = DVec2::new(column / f64::from(width), row / f64::from(height));
            let [red, green, blue] = radiance(oracle::direction_from_uv(uv)).as_vec3().to_array();
            [red, green, blue, 1.0]
        });
        Environment::Map(EnvironmentMap { width, height, pixels: pixels.collect() })
    }

    const NORMALS: [DVec3; 5] = [
        DVec3::X,
        DVec3::NEG_Y,
        DVec3::Z,
        DVec3::new(2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0),
        DVec3::new(-2.0 / 3.0, 2.0 / 3.0, -1.0 / 3.0),
    ];

    /// Under a constant radiance r the irradiance is π r.
    #[test]
    fn light_alike_from_all_sides_gives_its_radiance_times_pi() {
        let radiance = DVec3::new(1.0, 0.25, 3.0);
        let coefficients = project(&map(|_| radiance));
        for normal in NORMALS {
            let found = irradiance(&coefficients, normal);
            assert!((found / (PI * radiance) - 1.0).abs().max_element() < 5e-5, "{normal}: {found}");
        }
    }

    /// Under a radiance 1 + b · d the irradiance is π + 2π/3 b · n.
    #[test]
    fn light_that_grows_along_an_axis_gives_the_cosines_of_degree_one() {
        let coefficients = project(&map(|direction| DVec3::ONE + 0.5 * direction));
        for normal in NORMALS {
            let found = irradiance(&coefficients, normal);
            let expected = PI * (DVec3::ONE + normal / 3.0);
            assert!(found.abs_diff_eq(expected, 2e-3), "{normal}: {found}, not {expected}");
        }
    }

    /// A sun of one texel counts by its solid angle, wherever it is in a large image.
    #[test]
    fn no_texel_of_a_large_image_is_missed() {
        let (width, height) = (2048u32, 1024u32);
        for place in [[700u32, 300u32], [701, 301], [702, 303]] {
            let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; (width * height) as usize];
            pixels[(place[1] * width + place[0]) as usize] = [1e4, 1e4, 1e4, 1.0];
            let found = project(&Environment::Map(EnvironmentMap { width, height, pixels }))[0].x;
            let edges = [place[1], place[1] + 1].map(|row| (PI * f64::from(row) / f64::from(height)).cos());
            let expected = 1e4 * (edges[0] - edges[1]) * 2.0 * PI / f64::from(width) * (0.25 / PI).sqrt();
            assert!((found / expected - 1.0).abs() < 1e-3, "{place:?}: {found}, not {expected}");
        }
    }

    #[test]
    fn no_irradiance_is_above_the_bound() {
        let small = |direction: DVec3| DVec3::splat(100.0 * f64::from(u8::from(direction.y > 0.99)));
        for (environment, near) in [(map(|_| DVec3::ONE), 1.001), (map(small), 1.7), (Environment::Studio, 2.0)] {
            let coefficients = project(&environment);
            let most = NORMALS.iter().chain(&[DVec3::Y]).map(|normal| irradiance(&coefficients, *normal));
            let most = most.fold(DVec3::ZERO, DVec3::max);
            let bound = largest_irradiance(&coefficients);
            assert!(most.cmple(bound * 1.000_1).all() && bound.cmple(near * most).all(), "{most} {bound}");
        }
    }

    /// A small light leaves the sum below 0 on part of the side that faces away; it is clamped.
    #[test]
    fn no_irradiance_is_below_zero() {
        let coefficients = project(&map(|direction| DVec3::splat(100.0 * f64::from(u8::from(direction.y > 0.99)))));
        for polar in 0..=180u32 {
            let (across, along) = f64::from(polar).to_radians().sin_cos();
            let found = irradiance(&coefficients, DVec3::new(across, along, 0.0));
            assert!(found.is_finite() && found.min_element() >= 0.0, "{polar}: {found}");
        }
        let away = irradiance(&coefficients, DVec3::NEG_Y);
        assert!(away.max_element() < 0.1 * irradiance(&coefficients, DVec3::Y).min_element(), "{away}");
    }
}
