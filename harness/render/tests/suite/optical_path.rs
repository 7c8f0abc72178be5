//! The optical path's solvers: against Dijkstra's algorithm, against the ball, against each other,
//! and on difficult bodies.

mod ball;
mod bodies;
mod hard;
mod properties;

use bodies::Case;
use lapidary_assay::extremum::larger;
use lapidary_optical_path::oracle::{Number, dijkstra};
use lapidary_render::solver::{LoneSolver, Solve, Status};
use lapidary_render::voxel_grid::VoxelGrid;
use lapidary_scene::solver::{Method, Stencil};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

const STENCILS: [Stencil; 3] = [Stencil::Faces, Stencil::Edges, Stencil::Corners];

/// Enough passes for any path of a small body, however it winds.
const ENOUGH: u32 = 256;

/// Returns the costs of a case, and the progress of the solve. The density varies by voxel if the
/// case has one.
fn solve_within(case: &Case, method: Method, most_passes: Option<u32>) -> (Vec<f32>, Status) {
    /// Compiled solvers. Each serves every body of one extinction in its grid.
    static SOLVERS: Mutex<BTreeMap<String, LoneSolver<'static>>> = Mutex::new(BTreeMap::new());
    let heterogeneous = case.density.iter().any(|density| *density != 1.0);
    let mut solvers = SOLVERS.lock().unwrap_or_else(PoisonError::into_inner);
    let VoxelGrid { spacing, cells, .. } = case.grid;
    let solve = Solve { method, heterogeneous, most_passes };
    let solver = solvers
        .entry(format!("{method} {heterogeneous} {most_passes:?} {spacing} {cells} {}", case.extinction))
        .or_insert_with(|| {
            LoneSolver::new(lapidary_testing::gpu(), case.grid, solve, case.extinction, None).expect("it compiles")
        });
    solver.set_body(&case.bits(), &case.density).expect("the body");
    solver.set_seeds(&case.seeds).expect("the seeds");
    solver.run().expect("run");
    (solver.costs().expect("a device"), solver.status().expect("a device"))
}

/// Returns the costs at the fixpoint.
fn solve(case: &Case, method: Method) -> Vec<f32> {
    let (costs, status) = solve_within(case, method, Some(ENOUGH));
    assert_eq!(status.active, 0, "{method}: {status:?}");
    costs
}

/// Returns Dijkstra's costs from the same seeds.
fn truth<N: Number>(case: &Case, stencil: Stencil, seeds: &[N]) -> Vec<N> {
    let extinctions = case.extinctions();
    dijkstra(&case.body(&extinctions), stencil.neighbours(), seeds)
}

/// Returns the first voxel at which two lists of costs differ by more than `share` of the cost, or
/// of 1 if that is larger.
fn differs(one: &[f32], other: &[f32], share: f32) -> Option<String> {
    let is_off = |(one, other): (&f32, &f32)| {
        let near = (one - other).abs() <= share * one.abs().max(1.0);
        one.to_bits() != other.to_bits() && (share == 0.0 || !near)
    };
    assert_eq!(one.len(), other.len());
    let index = one.iter().zip(other).position(is_off)?;
    Some(format!("voxel {index}: {} and {}", one[index], other[index]))
}

/// Rounding of a cost on a device that fuses products with sums: an ulp for each of some hundred steps.
const FUSED: f32 = 1.2e-5;

fn assert_same(what: &str, one: &[f32], other: &[f32], share: f32) {
    let share = if lapidary_testing::gpu().is_lavapipe() { share } else { share.max(FUSED) };
    if let Some(difference) = differs(one, other, share) {
        panic!("{what}: {difference}");
    }
}

#[test]
fn min_plus_is_dijkstras_to_the_bit() {
    let bodies = [(1, 16), (2, 24), (3, 40)].into_iter().flat_map(|body| [(body, false), (body, true)]);
    for ((seed, cells), heterogeneous) in lapidary_testing::sampled(bodies, 4) {
        let case = Case::random(seed, cells, heterogeneous);
        for stencil in STENCILS {
            let wanted = truth(&case, stencil, &case.seeds);
            for method in [Method::PingPong(stencil), Method::Tiled(stencil)] {
                let what = format!("{method}, body {seed}, heterogeneous {heterogeneous}");
                assert_same(&what, &solve(&case, method), &wanted, 0.0);
            }
        }
    }
}

/// Each step rounds once. The edge, a sum times a length, rounds twice more, relative to itself.
#[test]
fn rounding_grows_with_the_steps_of_a_path_at_most() {
    let case = Case::random(4, 32, true);
    let exact: Vec<f64> = case.seeds.iter().map(|seed| f64::from(*seed)).collect();
    for stencil in STENCILS {
        let exact = truth(&case, stencil, &exact);
        let (costs, status) = solve_within(&case, Method::PingPong(stencil), Some(ENOUGH));
        // A pass carries costs one step on.
        let share = f64::from(status.passes + 2) * 2f64.powi(-24);
        let mut worst: f64 = 0.0;
        for (cost, exact) in costs.iter().zip(&exact).filter(|(_, exact)| **exact < 1e29) {
            let error = (f64::from(*cost) - exact).abs();
            worst = larger(worst, error / exact.max(1e-30));
            assert!(error <= share * exact, "{cost} for {exact}");
        }
        assert!(worst > 0.0 && costs.iter().zip(&exact).all(|(cost, exact)| (*cost < 1e29) == (*exact < 1e29)));
    }
}

#[test]
fn the_papers_solver_is_dijkstras_with_edges_of_length_one() {
    for heterogeneous in [false, true] {
        let mut case = Case::random(5, 24, heterogeneous);
        let wanted = truth(&case, Stencil::Faces, &case.seeds);
        // The spacing of the grid has no effect on the solver: the paper omits it.
        for spacing in [1.0, 0.125] {
            case.grid.spacing = spacing;
            assert_same("paper", &solve(&case, Method::Paper), &wanted, 0.0);
        }
        let other = solve(&case, Method::Tiled(Stencil::Faces));
        assert!(differs(&other, &wanted, 0.0).is_some(), "all others ask for the length");
    }
}

#[test]
fn passes_are_the_mirrors() {
    use lapidary_optical_path::kernels;
    let case = Case::random(6, 16, true);
    let extinctions = case.extinctions();
    let body = case.body(&extinctions);
    for stencil in STENCILS {
        let mut wanted = kernels::seeded(&body, &case.seeds);
        for passes in [2, 4, 6] {
            for _ in 0..2 {
                wanted = kernels::pull(&body, stencil.neighbours(), &wanted);
            }
            let (costs, status) = solve_within(&case, Method::PingPong(stencil), Some(passes));
            assert_eq!(status.passes, passes, "a body of more passes");
            assert_same("pull", &costs, &wanted, 0.0);
        }
    }
    let mut wanted = kernels::seeded(&body, &case.seeds);
    let mut written: Vec<usize> = (0..wanted.len()).filter(|index| wanted[*index] < 1e29).collect();
    while !written.is_empty() {
        written = kernels::push(&body, &mut wanted, &written);
    }
    assert_same("push", &solve(&case, Method::Paper), &wanted, 0.0);
    let mut wanted = kernels::seeded(&body, &case.seeds);
    let mut sweeps = 0;
    while kernels::upwind(&body, &mut wanted, sweeps % 2 == 1) > 1e-6 {
        sweeps += 1;
    }
    // Changes below the tolerance are not passed on. They add up along a path, over a tenth of the
    // steps at most.
    assert_same("upwind", &solve(&case, Method::Godunov), &wanted, 5e-5);
}

#[test]
fn the_bunny_by_tiles_is_the_bunny_untiled() {
    let case = Case::bunny(64, 10.0);
    let filled = case.matter.iter().filter(|matter| **matter).count() as f32 / case.matter.len() as f32;
    assert!((0.1..0.3).contains(&filled), "the bunny fills {filled}");
    let stencil = Stencil::Corners;
    let [wanted, tiled] = [Method::PingPong(stencil), Method::Tiled(stencil)].map(|method| {
        let (costs, status) = solve_within(&case, method, None);
        assert_eq!(status.active, 0, "{method}: {status:?}");
        costs
    });
    assert_same("64", &tiled, &wanted, 0.0);
    let reached = wanted.iter().zip(&case.matter).filter(|(cost, matter)| **matter && **cost < 1e29).count();
    assert!(reached as f32 > 0.99 * filled * wanted.len() as f32);
}
