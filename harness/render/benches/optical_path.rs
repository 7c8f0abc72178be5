//! Compares the times of the optical path's solvers on the bunny, ten optical depths wide:
//! `cargo bench --profile dev --bench optical_path [CELLS…]`.

#![allow(dead_code, reason = "the tests use more of the bodies")]

#[path = "../tests/suite/optical_path/bodies.rs"]
mod bodies;

use bodies::Case;
use lapidary_gpu::{AdapterChoice, Gpu};
use lapidary_render::solver::{LoneSolver, Solve};
use lapidary_scene::solver::Method;
use std::time::{Duration, Instant};

/// Rounds over all solvers. The least time counts.
const ROUNDS: usize = 7;

/// Resets the seeds, solves, and returns the time of the solve.
fn run(gpu: &Gpu, solver: &LoneSolver<'_>, case: &Case) -> Duration {
    let wait = || gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("a device");
    solver.set_seeds(&case.seeds).expect("a seed for each voxel");
    gpu.queue.submit([]);
    wait();
    let start = Instant::now();
    solver.run().expect("run");
    wait();
    start.elapsed()
}

fn main() {
    let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("an adapter");
    println!("{}", gpu.describe());
    let asked: Vec<u32> = std::env::args().filter_map(|argument| argument.parse().ok()).collect();
    for cells in if asked.is_empty() { vec![32, 64, 128] } else { asked } {
        let case = Case::bunny(cells, 10.0);
        println!("{cells}: {} voxels of matter", case.matter.iter().filter(|matter| **matter).count());
        let solvers = Method::ALL.map(|method| {
            let solve = Solve { method, heterogeneous: false, most_passes: None };
            let solver = LoneSolver::new(gpu, case.grid, solve, case.extinction, None).expect("it compiles");
            solver.set_body(&case.bits(), &[]).expect("a bit for each voxel");
            solver
        });
        let mut least = [Duration::MAX; Method::ALL.len()];
        for _ in 0..ROUNDS {
            for (solver, least) in solvers.iter().zip(&mut least) {
                *least = run(gpu, solver, &case).min(*least);
            }
        }
        for ((method, solver), least) in Method::ALL.iter().zip(&solvers).zip(least) {
            run(gpu, solver, &case);
            let status = solver.status().expect("a device");
            println!(
                "| {method} | {:.1} ms | {} passes | {} updates |",
                1e3 * least.as_secs_f64(),
                status.passes,
                status.updates
            );
        }
    }
}
