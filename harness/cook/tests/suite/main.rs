//! Tests that need the whole harness: a GPU, the compiled-in cookbook, or the real `cook` binary.

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
mod diagrams;
mod diffusion;
mod dispatch;
mod effects_off;
mod engines;
mod environment_harmonics;
mod environment_js;
mod footprint;
mod formulas;

mod frame;
mod furnace;
mod gallery_live;
mod gallery_pages;
mod gallery_rows;
mod gem;
mod generated;
mod hard_cases;
mod host;
mod instances;
mod lamp_inside;
mod languages;
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
mod surroundings;
mod technique;
mod text;
mod texture_diffusion;
mod textures;
mod user_file;
mod vitrine;
mod voxelization;
mod walked_references;

use lapidary_assay::draws::mix;
use lapidary_cook::seed::{SEED_VARIABLE, SuiteSeed};
use lapidary_gpu::{AdapterChoice, Gpu};
use std::io::Write as _;

/// Returns the seed of the property tests. The output of every failing test that uses it states its
/// value.
fn seed() -> u64 {
    let seed = SuiteSeed::of_environment().unwrap_or_else(|error| panic!("{error}"));
    eprintln!("seed {}, {}; again with {SEED_VARIABLE}={}", seed.value, seed.origin, seed.value);
    seed.value
}

/// Variable that, if set, makes the suite run every case instead of samples. `./cook test --whole`
/// and `.ci/full` set it.
const WHOLE_VARIABLE: &str = "LAPIDARY_WHOLE";

/// Whether the suite runs every case instead of samples.
fn whole() -> bool {
    std::env::var_os(WHOLE_VARIABLE).is_some()
}

/// Selects about one in `one_in` of the items of a slow test, but at least one, and all if the
/// suite is run whole. The suite's seed decides, so that another change tests other items. Standard
/// error names the selected ones.
fn sampled<T>(items: impl IntoIterator<Item = T>, one_in: u64) -> Vec<T> {
    let items: Vec<T> = items.into_iter().collect();
    if whole() {
        return items;
    }
    let (count, seed) = (items.len(), seed());
    let certain = usize::try_from(seed % count.max(1) as u64).unwrap_or_default();
    let is_chosen = |index: &usize| *index == certain || mix(seed ^ mix(*index as u64)).is_multiple_of(one_in);
    let chosen: Vec<usize> = (0..count).filter(is_chosen).collect();
    // Straight to the stream: the captured output of a passing test is not shown.
    let name = std::thread::current().name().unwrap_or_default().to_owned();
    let _ = writeln!(std::io::stderr(), "{name}: of {count} cases numbers {chosen:?}; all with {WHOLE_VARIABLE}=1");
    items.into_iter().enumerate().filter(|(index, _)| chosen.contains(index)).map(|(_, item)| item).collect()
}

/// Returns the process's only device. A missing adapter fails the test: a suite that skips itself
/// checks nothing.
fn gpu() -> &'static Gpu {
    Gpu::shared(&AdapterChoice::from_environment()).unwrap_or_else(|error| panic!("{error}"))
}

/// Whether the tests run on lavapipe, the reference device. If not, standard error says that what follows is left
/// out, and why it can be stated for lavapipe alone.
fn on_lavapipe(why: &str) -> bool {
    let gpu = gpu();
    if !gpu.is_lavapipe() {
        let name = std::thread::current().name().unwrap_or_default().to_owned();
        let _ = writeln!(std::io::stderr(), "{name}: left out on {}: {why}", gpu.info.name);
    }
    gpu.is_lavapipe()
}
