//! The tests that need the whole harness: a GPU, the compiled-in cookbook, or the real `cook` binary.

mod adapter;
mod antialiasing;
mod bad_input;
mod bvh;
mod cdrf;
mod cdrf_shading;
mod chromium;
mod cli;
mod comparator;
mod constants;
mod contract;
mod cost;
mod curvature;
mod deferred;
mod dispatch;
mod effects_off;
mod formulas;
mod furnace;
mod gem;
mod hard_cases;
#[cfg(unix)]
mod launcher;
mod optical_path;
mod optical_path_shading;
mod outside;
mod parity;
mod pixels;
mod plan;
mod program;
mod random_walk;
mod reference;
mod releases;
mod restraint;
mod rewrites;
mod seams;
mod seeds;
mod shadows;
mod slack;
mod snapshots;
mod specialise;
mod structure;
mod text;
mod texture_diffusion;
mod user_file;
mod vitrine;
mod voxelization;
mod walked_references;

use lapidary_cook::seed::{SEED_VARIABLE, SuiteSeed};
use lapidary_gpu::{AdapterChoice, Gpu};

/// The seed of the property tests. What it is stands in the output of every test that uses it and fails.
fn seed() -> u64 {
    let seed = SuiteSeed::of_environment().unwrap_or_else(|error| panic!("{error}"));
    eprintln!("seed {}, {}; again with {SEED_VARIABLE}={}", seed.value, seed.origin, seed.value);
    seed.value
}

/// The process's one device. A missing adapter fails the test: a suite that skips itself checks nothing.
fn gpu() -> &'static Gpu {
    Gpu::shared(&AdapterChoice::from_environment()).unwrap_or_else(|error| panic!("{error}"))
}
