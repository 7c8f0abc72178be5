//! What several test suites share: the seed, samples of slow tests, the device, runs of a program.

pub mod generated;
pub mod pixels;
pub mod program;
pub mod seed;

use lapidary_assay::draws::mix;
use lapidary_gpu::{AdapterChoice, Gpu};
use seed::{SEED_VARIABLE, SuiteSeed};
use std::io::Write as _;

/// Returns the seed of the property tests. The output of every failing test that uses it states its
/// value.
pub fn seed() -> u64 {
    let seed = SuiteSeed::of_environment().unwrap_or_else(|error| panic!("{error}"));
    eprintln!("seed {}, {}; again with {SEED_VARIABLE}={}", seed.value, seed.origin, seed.value);
    seed.value
}

/// Variable that, if set, makes the suite run every case instead of samples. `./cook test --whole`
/// and `.ci/full` set it.
pub const WHOLE_VARIABLE: &str = "LAPIDARY_WHOLE";

/// Whether the suite runs every case instead of samples.
pub fn whole() -> bool {
    std::env::var_os(WHOLE_VARIABLE).is_some()
}

/// Selects about one in `one_in` of the items of a slow test, but at least one, and all if the
/// suite is run whole. The suite's seed decides, so that another change tests other items. Standard
/// error names the selected ones.
pub fn sampled<T>(items: impl IntoIterator<Item = T>, one_in: u64) -> Vec<T> {
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
pub fn gpu() -> &'static Gpu {
    Gpu::shared(&AdapterChoice::from_environment()).unwrap_or_else(|error| panic!("{error}"))
}

/// Whether the tests run on lavapipe, the reference device. If not, standard error says that what follows is left
/// out, and why it can be stated for lavapipe alone.
pub fn on_lavapipe(why: &str) -> bool {
    let gpu = gpu();
    if !gpu.is_lavapipe() {
        let name = std::thread::current().name().unwrap_or_default().to_owned();
        let _ = writeln!(std::io::stderr(), "{name}: left out on {}: {why}", gpu.info.name);
    }
    gpu.is_lavapipe()
}
