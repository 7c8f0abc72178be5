//! Bodies and seeds that are difficult for solvers.

use super::bodies::Case;
use super::{STENCILS, assert_same, solve, solve_within, truth};
use glam::UVec3;
use lapidary_assay::extremum::larger;
use lapidary_optical_path::{OPTICAL_PATH_UNREACHED, luminance};
use lapidary_scene::solver::Method;

fn ball(cells: u32, extinction: f32) -> Case {
    let middle = 0.5 * cells as f32;
    let inside = |voxel: UVec3| (voxel.as_vec3() + 0.5 - middle).length() < 0.4 * cells as f32;
    Case::of(cells, extinction, inside)
}

#[test]
fn without_a_seed_all_stays_dark_and_no_pass_is_run() {
    let case = ball(16, 1.0);
    for method in Method::ALL {
        let (costs, status) = solve_within(&case, method, None);
        assert!(costs.iter().all(|cost| *cost == OPTICAL_PATH_UNREACHED && luminance(*cost) == 0.0), "{method}");
        assert_eq!((status.passes, status.updates, status.active), (0, 0, 0), "{method}");
        assert_eq!(status.luminance_bound(), 0.0);
    }
}

#[test]
fn where_all_is_seeded_alike_nothing_moves() {
    let mut case = ball(16, 1.0);
    case.seeds.fill(0.75);
    for method in Method::ALL {
        for (cost, matter) in solve(&case, method).iter().zip(&case.matter) {
            assert_eq!(*cost, if *matter { 0.75 } else { OPTICAL_PATH_UNREACHED }, "{method}");
        }
    }
}

/// A full cube has voxels at every border of the grid.
#[test]
fn extinctions_of_every_size_keep_costs_finite() {
    for extinction in [0.0, 1e-8, 1e8] {
        let mut case = Case::of(24, extinction, |_| true);
        (case.seeds[0], case.seeds[24 * 24 * 24 - 1]) = (0.5, 0.25);
        for method in Method::ALL {
            let costs = solve(&case, method);
            assert!(costs.iter().all(|cost| (0.25..1e10).contains(cost)), "{method} at {extinction}");
            if extinction == 0.0 {
                assert!(costs.iter().all(|cost| *cost == 0.25), "{method}: the plateau");
            }
            if extinction == 1e8 {
                let dark = costs.iter().zip(&case.seeds).filter(|(_, seed)| **seed > 1e29);
                assert!(dark.clone().all(|(cost, _)| luminance(*cost) == 0.0), "{method}: underflow");
            }
            if method != Method::Godunov {
                assert_same(method.name(), &costs, &truth(&case, method.stencil(), &case.seeds), 0.0);
            }
        }
    }
}

#[test]
fn what_is_no_cost_is_no_seed() {
    let mut case = ball(16, 0.5);
    let inside: Vec<usize> = (0..case.matter.len()).filter(|index| case.matter[*index]).collect();
    // NaN, infinity and huge costs are no light. Negative costs are 0.
    for (place, seed) in [f32::NAN, -f32::NAN, f32::INFINITY, 3e38].into_iter().enumerate() {
        case.seeds[inside[100 * place]] = seed;
    }
    let mut wanted = case.clone();
    wanted.seeds.fill(OPTICAL_PATH_UNREACHED);
    for (place, seed) in [-0.0, -1.0, f32::NEG_INFINITY].into_iter().enumerate() {
        case.seeds[inside[50 + 100 * place]] = seed;
        wanted.seeds[inside[50 + 100 * place]] = 0.0;
    }
    // A seed in the air.
    case.seeds[0] = 0.0;
    for method in Method::ALL {
        let share = if method == Method::Godunov { 1e-4 } else { 0.0 };
        assert_same(method.name(), &solve(&case, method), &solve(&wanted, method), share);
    }
}

#[test]
fn light_does_not_cross_the_air() {
    let mut case = Case::of(32, 0.5, |voxel| voxel.x < 12 || voxel.x > 13);
    case.seeds[0] = 0.0;
    for method in Method::ALL {
        for (index, cost) in solve(&case, method).iter().enumerate() {
            let x = case.grid.voxel(index).x;
            assert_eq!(*cost < OPTICAL_PATH_UNREACHED, x < 12, "{method}: voxel {index}");
            if x >= 12 {
                assert_eq!(luminance(*cost), 0.0, "{method}: voxel {index}");
            }
        }
    }
}

/// Returns a corridor, two voxels wide, that winds through the whole grid with walls between its
/// turns. Its length is some seventy times the grid's for 24 cells.
fn labyrinth(cells: u32) -> Case {
    let last = cells - 1;
    let mut case = Case::of(cells, 0.02, |voxel| {
        let UVec3 { x, y, z } = voxel;
        // Rows along x, joined at alternate ends; layers joined likewise.
        let (row, layer) = (y / 3, z / 3);
        let corridor = y % 3 < 2 && z % 3 < 2;
        let turn = y % 3 == 2 && z % 3 < 2 && if row % 2 == 0 { x >= last - 1 } else { x <= 1 };
        let rise = z % 3 == 2 && y % 3 < 2 && x <= 1 && if layer % 2 == 0 { y + 2 >= cells } else { y < 2 };
        corridor || turn || rise
    });
    case.seeds[0] = 0.0;
    case
}

#[test]
fn a_labyrinth_ends_at_the_fixpoint_or_says_how_far_off_it_is() {
    let case = labyrinth(24);
    for method in Method::ALL {
        let (costs, status) = solve_within(&case, method, Some(2048));
        assert_eq!(status.active, 0, "{method}: {status:?}");
        assert!(status.passes > 100, "{method}: {} passes are no labyrinth", status.passes);
        if method != Method::Godunov {
            assert_same(method.name(), &costs, &truth(&case, method.stencil(), &case.seeds), 0.0);
        }
        for most in [10, 50, 90] {
            let (early, status) = solve_within(&case, method, Some(most));
            assert!(status.active > 0 && status.passes == most, "{method}: {status:?}");
            let share = if method == Method::Godunov { 1e-4 } else { 0.0 };
            let bound = status.luminance_bound();
            assert!(bound > 0.0 && status.least < 1e3, "{method}: {status:?}");
            let mut worst: f32 = 0.0;
            for (early, cost) in early.iter().zip(&costs) {
                assert!(*early >= cost - share * cost.max(1.0), "{method}: no cost is below the fixpoint's");
                if *cost < status.least - share * status.least.max(1.0) {
                    assert!(early - cost <= share * cost.max(1.0), "{method}: {early} was not final at {cost}");
                }
                worst = larger(worst, (luminance(*early) - luminance(*cost)).abs());
            }
            assert!(worst <= bound * (1.0 + 2.0 * share) && worst > 0.0, "{method}: {worst} beyond {bound}");
        }
    }
}

#[test]
fn concave_bodies_are_solved_within_the_passes_that_are_granted_by_default() {
    // A slab bent three times.
    let case = {
        let mut case = Case::of(64, 0.2, |voxel| {
            voxel.y % 16 < 12 || if voxel.y / 16 % 2 == 0 { voxel.x > 57 } else { voxel.x < 6 }
        });
        case.seeds[0] = 0.0;
        case
    };
    for stencil in STENCILS {
        let (costs, status) = solve_within(&case, Method::Tiled(stencil), None);
        assert_eq!(status.active, 0, "{stencil:?}: {status:?}");
        assert_same("bent", &costs, &truth(&case, stencil, &case.seeds), 0.0);
    }
    let (_, status) = solve_within(&case, Method::Godunov, None);
    assert_eq!(status.active, 0, "{status:?}");
}
