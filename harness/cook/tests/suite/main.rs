//! The tests that need the whole harness: a GPU, the compiled-in cookbook, or the real `cook` binary.

mod adapter;
mod allowance;
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
mod frame;
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
mod records;
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
mod technique;
mod text;
mod texture_diffusion;
mod user_file;
mod vitrine;
mod voxelization;
mod walked_references;

use lapidary_assay::draws::mix;
use lapidary_cook::seed::{SEED_VARIABLE, SuiteSeed};
use lapidary_gpu::{AdapterChoice, Gpu};
use std::io::Write as _;

/// The seed of the property tests. What it is stands in the output of every test that uses it and fails.
fn seed() -> u64 {
    let seed = SuiteSeed::of_environment().unwrap_or_else(|error| panic!("{error}"));
    eprintln!("seed {}, {}; again with {SEED_VARIABLE}={}", seed.value, seed.origin, seed.value);
    seed.value
}

/// Set, the suite leaves nothing to samples; `./cook test --whole` and `.ci/full` set it.
const WHOLE_VARIABLE: &str = "LAPIDARY_WHOLE";

/// Whether the suite leaves nothing to samples.
fn whole() -> bool {
    std::env::var_os(WHOLE_VARIABLE).is_some()
}

/// Of what takes long one item in so many, chosen by the suite's seed, so that another change meets others; at least one, and all where the
/// suite is run whole. Standard error says which.
fn sampled<T>(items: impl IntoIterator<Item = T>, one_in: u64) -> Vec<T> {
    let items: Vec<T> = items.into_iter().collect();
    if whole() {
        return items;
    }
    let (count, seed) = (items.len(), seed());
    let certain = usize::try_from(seed % count.max(1) as u64).unwrap_or_default();
    let is_chosen = |index: &usize| *index == certain || mix(seed ^ mix(*index as u64)).is_multiple_of(one_in);
    let chosen: Vec<usize> = (0..count).filter(is_chosen).collect();
    // To the stream itself: what a passing test prints is not shown.
    let name = std::thread::current().name().unwrap_or_default().to_owned();
    let _ = writeln!(std::io::stderr(), "{name}: of {count} cases numbers {chosen:?}; all with {WHOLE_VARIABLE}=1");
    items.into_iter().enumerate().filter(|(index, _)| chosen.contains(index)).map(|(_, item)| item).collect()
}

/// The process's one device. A missing adapter fails the test: a suite that skips itself checks nothing.
fn gpu() -> &'static Gpu {
    Gpu::shared(&AdapterChoice::from_environment()).unwrap_or_else(|error| panic!("{error}"))
}
