//! Mathematical properties of the costs at two related inputs.

use super::bodies::Case;
use super::{STENCILS, assert_same, solve};
use glam::{IVec3, UVec3};
use lapidary_assay::draws::Draws;
use lapidary_optical_path::OPTICAL_PATH_UNREACHED;
use lapidary_scene::solver::{Method, Stencil};

/// Accumulated tolerance of Godunov's passes, as a share of the cost.
const GODUNOV: f32 = 1e-4;

/// The methods, and the share of a cost by which two solves of the same body may differ.
const METHODS: [(Method, f32); 4] = [
    (Method::Tiled(Stencil::Faces), 0.0),
    (Method::Tiled(Stencil::Edges), 0.0),
    (Method::Tiled(Stencil::Corners), 0.0),
    (Method::Godunov, GODUNOV),
];

#[test]
fn more_extinction_costs_no_less() {
    for (method, share) in METHODS {
        let case = Case::random(11, 24, true);
        let mut denser = case.clone();
        let mut draws = Draws::of_row(12, 0);
        denser.density.iter_mut().for_each(|density| *density *= draws.pick(&[1.0, 1.0, 1.5, 3.0]));
        let [before, after] = [&case, &denser].map(|case| solve(case, method));
        let fallen = before.iter().zip(&after).position(|(before, after)| *after < before - share * before.max(1.0));
        assert_eq!(fallen, None, "{method}");
        assert!(before.iter().zip(&after).any(|(before, after)| after > before), "{method}");
    }
}

#[test]
fn another_seed_raises_no_cost() {
    for (method, share) in METHODS {
        let case = Case::random(13, 24, false);
        let mut lit = case.clone();
        let unlit = (0..lit.seeds.len()).rev().find(|index| lit.matter[*index] && lit.seeds[*index] > 1e29);
        lit.seeds[unlit.expect("a voxel without a seed")] = 0.25;
        let [before, after] = [&case, &lit].map(|case| solve(case, method));
        let risen = before.iter().zip(&after).position(|(before, after)| *after > before + share * before.max(1.0));
        assert_eq!(risen, None, "{method}");
        assert!(before.iter().zip(&after).any(|(before, after)| after < before), "{method}");
    }
}

#[test]
fn four_times_the_extinction_is_four_times_the_cost() {
    for (method, share) in METHODS {
        let case = Case::random(14, 24, true);
        let mut four = case.clone();
        four.extinction *= 4.0;
        four.seeds.iter_mut().filter(|seed| **seed < 1e29).for_each(|seed| *seed *= 4.0);
        let wanted: Vec<f32> =
            solve(&case, method).iter().map(|cost| if *cost < 1e29 { 4.0 * cost } else { *cost }).collect();
        assert_same(method.name(), &solve(&four, method), &wanted, share);
    }
}

/// Returns the distances from a voxel, as costs with no other seed.
fn from(case: &Case, voxel: usize, method: Method) -> Vec<f32> {
    let mut alone = case.clone();
    alone.seeds.fill(OPTICAL_PATH_UNREACHED);
    alone.seeds[voxel] = 0.0;
    solve(&alone, method)
}

#[test]
fn no_way_is_shorter_by_a_third_voxel() {
    let case = Case::random(15, 16, true);
    // Sums are rounded at every step.
    let rounding = 1.0 + 64.0 * f32::EPSILON;
    let inside: Vec<usize> = (0..case.matter.len()).filter(|index| case.matter[*index]).collect();
    let [a, b] = [inside[0], inside[inside.len() / 2]];
    for stencil in STENCILS {
        let method = Method::Tiled(stencil);
        let [all, from_a, from_b] = [solve(&case, method), from(&case, a, method), from(&case, b, method)];
        assert!((from_a[b] - from_b[a]).abs() <= (rounding - 1.0) * from_a[b], "{method}: there and back");
        for c in inside.iter().copied() {
            assert!(from_a[c] <= (from_a[b] + from_b[c]) * rounding, "{method}: from {a} by {b} to {c}");
            assert!(all[c] <= (all[a] + from_a[c]) * rounding, "{method}: lit {c} by {a}");
        }
    }
}

/// Applies one of the cube's 48 symmetries: a permutation of the axes, and the reversal of some.
fn turned(case: &Case, symmetry: usize) -> (Case, Vec<usize>) {
    let order = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]][symmetry / 8];
    let last = case.grid.cells as i32 - 1;
    let place = |voxel: UVec3| {
        let position = voxel.as_ivec3().to_array();
        let moved: [i32; 3] = std::array::from_fn(|axis| {
            if symmetry >> axis & 1 == 1 { last - position[order[axis]] } else { position[order[axis]] }
        });
        case.grid.index(IVec3::from(moved).as_uvec3())
    };
    let places: Vec<usize> = (0..case.matter.len()).map(|index| place(case.grid.voxel(index))).collect();
    let mut other = case.clone();
    for (index, place) in places.iter().enumerate() {
        other.matter[*place] = case.matter[index];
        other.density[*place] = case.density[index];
        other.seeds[*place] = case.seeds[index];
    }
    (other, places)
}

#[test]
fn no_axis_and_no_direction_is_another() {
    let case = Case::random(16, 16, true);
    for (method, share) in [(Method::Tiled(Stencil::Corners), 0.0), (Method::Godunov, GODUNOV)] {
        let wanted = solve(&case, method);
        for symmetry in 1..48 {
            let (other, places) = turned(&case, symmetry);
            let costs = solve(&other, method);
            let back: Vec<f32> = places.iter().map(|place| costs[*place]).collect();
            assert_same(&format!("{method}, symmetry {symmetry}"), &back, &wanted, share);
        }
    }
}
