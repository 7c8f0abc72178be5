//! The tests that need the whole harness: a GPU, the compiled-in cookbook, or the real `cook` binary.

mod adapter;
mod bad_input;
mod cli;
mod comparator;
mod contract;
mod dispatch;
mod formulas;
mod furnace;
mod hard_cases;
mod program;
mod snapshots;
mod specialise;
mod text;

use lapidary_harness::gpu::{AdapterChoice, Gpu};

/// The process's one device. A missing adapter fails the test: a suite that skips itself checks nothing.
fn gpu() -> &'static Gpu {
    Gpu::shared(&AdapterChoice::from_environment()).unwrap_or_else(|error| panic!("{error}"))
}
