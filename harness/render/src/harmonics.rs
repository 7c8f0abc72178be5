//! Spherical harmonics of the environment: its radiance projected onto the degrees that a clamped
//! cosine contains.

use super::Environment;
use glam::{DVec2, DVec3};
use lapidary_environment::oracle;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Number of coefficients: 1 of degree 0, 3 of 1, 5 of 2, 9 of 4.
pub(super) const COUNT: usize = 18;

/// Rows of the grid of directions, from pole to pole; there are twice as many columns. The studio's
/// sharpest edge is 3° wide, or 5 rows.
const ROWS: u32 = 256;

/// Returns the coefficients, linear RGB, by degree and order.
pub(super) fn project(environment: &Environment) -> [DVec3; COUNT] {
    let row = |row: u32| {
        let v = (f64::from(row) + 0.5) / f64::from(ROWS);
        // The exact solid angle of a cell: dz dφ.
        let edges = [row, row + 1].map(|edge| (PI * f64::from(edge) / f64::from(ROWS)).cos());
        let solid_angle = (edges[0] - edges[1]) * PI / f64::from(ROWS);
        let mut sums = [DVec3::ZERO; COUNT];
        for column in 0..2 * ROWS {
            let uv = DVec2::new((f64::from(column) + 0.5) / f64::from(2 * ROWS), v);
            let direction = oracle::direction_from_uv(uv);
            let arriving = solid_angle * environment.radiance(direction);
            for (sum, value) in sums.iter_mut().zip(basis(direction)) {
                *sum += value * arriving;
            }
        }
        sums
    };
    // Rows are summed in order, so the sums do not depend on the number of threads.
    let rows: Vec<[DVec3; COUNT]> = (0..ROWS).into_par_iter().map(row).collect();
    rows.into_iter().fold([DVec3::ZERO; COUNT], |all, row| std::array::from_fn(|k| all[k] + row[k]))
}

fn basis(direction: DVec3) -> impl Iterator<Item = f64> {
    // The mirror's polynomials: a hundred times faster than the oracle's angles, and accurate to
    // 2e-6.
    let values = lapidary_environment::harmonics(direction.as_vec3());
    let all = [values.zeroth].into_iter().chain(values.first.to_array()).chain(values.second).chain(values.fourth);
    all.map(f64::from)
}
