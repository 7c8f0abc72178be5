//! Compares the oracles with each other and with known values, and tests the mirrors of whole
//! buffers.

use super::kernels::{self, Body};
use super::*;
use lapidary_assay::extremum::larger;

/// Returns the matter and the extinction of a cube full of uniform matter.
fn whole(cells: u32) -> (Vec<bool>, Vec<f32>) {
    let count = (cells as usize).pow(3);
    (vec![true; count], vec![1.0; count])
}

#[test]
fn bits_are_ordered_as_costs_are() {
    let costs = [0.0, 1e-45, 1e-38, 1e-8, 0.5, 1.0, 87.3, 1e8, 1e29, OPTICAL_PATH_UNREACHED];
    assert!(costs.windows(2).all(|pair| encode(pair[0]) < encode(pair[1])));
    for cost in costs {
        assert_eq!(decode(encode(cost)).to_bits(), cost.to_bits());
        assert_eq!(encode(cost), oracle::encode(f64::from(cost)), "{cost:e}");
    }
    for cost in [f32::NAN, -f32::NAN, f32::INFINITY, 3e38] {
        assert_eq!(decode(encode(cost)), OPTICAL_PATH_UNREACHED);
    }
    for cost in [-0.0, -1.0, -1e-45, f32::NEG_INFINITY] {
        assert_eq!(encode(cost), 0);
    }
}

#[test]
fn godunov_adds_a_step_along_one_two_or_three_axes() {
    let far = OPTICAL_PATH_UNREACHED;
    assert_eq!(godunov(Vec3::new(2.0, far, far), 0.5), 2.5);
    let near = |cost: f32, wanted: f32| assert!((cost - wanted).abs() < 2e-7 * wanted, "{cost} {wanted}");
    near(godunov(Vec3::new(2.0, far, 2.0), 0.5), 2.0 + 0.5 / 2f32.sqrt());
    near(godunov(Vec3::splat(2.0), 0.5), 2.0 + 0.5 / 3f32.sqrt());
    assert_eq!(godunov(Vec3::splat(7.0), 0.0), 7.0);
    assert_eq!(godunov(Vec3::splat(far), 1.0), far);
    assert!(godunov_naive(Vec3::splat(1e20), 1e18).is_nan());
}

#[test]
fn the_ball_is_as_deep_as_it_is_wide_up_to_an_optical_radius_of_two() {
    use std::f64::consts::PI;
    for radius in [0.1, 1.0, 2.0] {
        assert!((oracle::ball(radius, radius, PI) - 2.0 * radius).abs() < 1e-9, "{radius}");
    }
    // Beyond that radius, light that enters at the side has a shorter path.
    assert!(oracle::ball(8.0, 8.0, PI) < 16.0 - 1.0);
    // At normal incidence, and in the centre.
    assert!(oracle::ball(8.0, 8.0, 0.0).abs() < 1e-9);
    assert!((oracle::ball(8.0, 0.0, 1.0) - 8.0).abs() < 1e-9);
    // The formula for the surface: T(θ) = min over α of [2τ sin(|θ-α|/2) - ln cos α].
    for angle in [0.3, 1.2, 2.0, 3.0] {
        let direct = (0..200_000)
            .map(|place| {
                let alpha = (f64::from(place) / 100_000.0 - 1.0) * 0.5 * PI;
                16.0 * (0.5 * (angle - alpha).abs()).sin() - alpha.cos().ln()
            })
            .fold(f64::INFINITY, f64::min);
        // The slope at the kink is τ, and the nearest place may be half a step away from it.
        let above = direct - oracle::ball(8.0, 8.0, angle);
        assert!((-1e-9..7e-5).contains(&above), "{angle}: {above:e}");
    }
}

#[test]
fn dijkstra_measures_the_stencils() {
    let cells = 16;
    let (matter, extinction) = whole(cells);
    let body = Body { cells, spacing: 0.5, matter: &matter, extinction: &extinction };
    let mut seeds = vec![f64::from(OPTICAL_PATH_UNREACHED); matter.len()];
    seeds[0] = 0.0;
    // Along the diagonal of the cube and of a face.
    for (stencil, cube, face) in [(6, 3.0, 2.0), (18, 1.5 * 2f64.sqrt(), 2f64.sqrt()), (26, 3f64.sqrt(), 2f64.sqrt())] {
        let costs = oracle::dijkstra(&body, stencil, &seeds);
        let cost_at = |x: usize, y: usize, z: usize| costs[x + 16 * (y + 16 * z)] / 0.5;
        assert!((cost_at(15, 0, 0) - 15.0).abs() < 1e-6);
        assert!((cost_at(0, 14, 14) - 14.0 * face).abs() < 1e-5, "{stencil}");
        assert!((cost_at(14, 14, 14) - 14.0 * cube).abs() < 1e-5, "{stencil}");
    }
}

#[test]
fn the_kernels_end_where_dijkstra_does() {
    let cells = 8;
    let (mut matter, mut extinction) = whole(cells);
    for index in 0..matter.len() {
        matter[index] = index % 7 != 3;
        extinction[index] = 0.25 + (index % 5) as f32;
    }
    let mut seeds = vec![OPTICAL_PATH_UNREACHED; matter.len()];
    (seeds[5], seeds[300], seeds[3]) = (0.5, -0.0, 0.1);
    let body = Body { cells, spacing: 0.5, matter: &matter, extinction: &extinction };
    let seeds = kernels::seeded(&body, &seeds);
    assert_eq!(seeds[3], OPTICAL_PATH_UNREACHED, "no matter");
    for stencil in [6, 18, 26] {
        let mut costs = seeds.clone();
        for _ in 0..40 {
            costs = kernels::pull(&body, stencil, &costs);
        }
        assert_eq!(costs, oracle::dijkstra(&body, stencil, &seeds));
    }
    let (mut costs, mut written) = (seeds.clone(), vec![5, 300]);
    while !written.is_empty() {
        written = kernels::push(&body, &mut costs, &written);
    }
    // An edge of length 1 costs as much as in the paper.
    assert_eq!(costs, oracle::dijkstra(&Body { spacing: 1.0, ..body }, 6, &seeds));
}

/// Checks that upwind differences carry a plane front exactly, because it is linear, and that edges
/// do not, because no path along them has its direction.
#[test]
fn godunov_carries_a_plane_front_exactly_and_edges_do_not() {
    let cells = 24;
    let (matter, extinction) = whole(cells);
    let body = Body { cells, spacing: 1.0, matter: &matter, extinction: &extinction };
    let direction = Vec3::new(1.0, 2.0, 3.0).normalize();
    let front = |index: usize| body.voxel(index).as_vec3().dot(direction);
    let seed = |index| if body.voxel(index).min_element() == 0 { front(index) } else { OPTICAL_PATH_UNREACHED };
    let seeds: Vec<f32> = (0..matter.len()).map(seed).collect();
    let mut costs = seeds.clone();
    // In the order of the voxel indices, the front has passed all neighbours that a voxel uses.
    kernels::upwind(&body, &mut costs, false);
    let worst = |costs: &[f32]| (0..costs.len()).map(|index| (costs[index] - front(index)).abs()).fold(0.0, larger);
    // Each of the 69 steps to the far corner may round three times.
    assert!(worst(&costs) < 200.0 * 2f32.powi(-24) * 50.0, "{}", worst(&costs));
    assert_eq!(kernels::upwind(&body, &mut costs, true), 0.0, "one sweep is enough");
    for (stencil, least) in [(6, 3.0), (18, 1.0), (26, 0.5)] {
        let along_edges = worst(&oracle::dijkstra(&body, stencil, &seeds));
        assert!(along_edges > least, "{stencil}: {along_edges}");
    }
}
