//! Times of the optical path's solvers beside each other: `cargo bench --profile dev --bench optical_path`.

#![allow(dead_code)]
#[path = "../tests/suite/optical_path/bodies.rs"]
mod bodies;

use bodies::Case;
use lapidary_harness::gpu::{AdapterChoice, Gpu};
use lapidary_harness::optical_path::{Method, Solver, Stencil};
use std::time::Instant;

/// Rounds over all solvers, of which the least counts.
const ROUNDS: usize = 7;

fn source(method: Method) -> String {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../wgsl");
    let read = |name: &str| std::fs::read_to_string(root.join(name)).expect("a file");
    let recipe = if method.is_tiled() { "recipes/optical_path_tiles.wgsl" } else { "recipes/optical_path_sweep.wgsl" };
    [read("optical_path.wgsl"), read("recipes/parts/optical_path_grid.wgsl"), read(recipe)].join("\n")
}

fn main() {
    let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("an adapter");
    println!("{}", gpu.describe());
    let only = std::env::var("ONLY").unwrap_or_default();
    let sizes = std::env::var("SIZES").unwrap_or("64".to_owned());
    let het = std::env::var("HET").is_ok();
    for cells in sizes.split(',').map(|size| size.parse().unwrap()) {
        let case = Case::bunny(cells, 10.0);
        println!("{cells}: {} voxels of matter", case.matter.iter().filter(|m| **m).count());
        let methods: Vec<Method> =
            Method::ALL.into_iter().filter(|m| only.is_empty() || only.split(',').any(|o| o == m.name())).collect();
        let mut solvers = Vec::new();
        for method in methods {
            let start = Instant::now();
            let solver = Solver::of_source(
                gpu,
                case.grid,
                method,
                het,
                std::env::var("PASSES").ok().and_then(|p| p.parse().ok()),
                &source(method),
            )
            .unwrap_or_else(|e| panic!("{e}"));
            let uploaded = case.upload(gpu);
            solver_run(gpu, &solver, &uploaded, het, case.extinction);
            println!("  {method}: compiled in {:.2} s", start.elapsed().as_secs_f64());
            solvers.push((method, solver, uploaded, f64::INFINITY));
        }
        for _ in 0..ROUNDS {
            for (_, solver, uploaded, least) in &mut solvers {
                uploaded.reset(gpu);
                let start = Instant::now();
                solver_run(gpu, solver, uploaded, het, case.extinction);
                *least = least.min(start.elapsed().as_secs_f64());
            }
        }
        for (method, solver, _, least) in &solvers {
            println!("  {method}: {:.2} ms, {:?}", 1e3 * least, solver.status().unwrap());
        }
    }
    let _ = Stencil::Faces;
}

fn solver_run(gpu: &Gpu, solver: &Solver<'_>, uploaded: &bodies::Uploaded, het: bool, extinction: f32) {
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    solver
        .encode(&mut encoder, &uploaded.matter, het.then_some(&uploaded.density), &uploaded.cost, extinction)
        .unwrap_or_else(|e| panic!("{e}"));
    gpu.queue.submit([encoder.finish()]);
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
}
