//! Tests of the studies, their records and the diagrams.

mod bad_input;
mod diagrams;
mod records;
mod restraint;
mod runs;

use lapidary_testing::program::{Answer, run};
use std::path::Path;

/// Runs the studies' program in `folder`.
fn studies(folder: &Path, arguments: &[&str]) -> Answer {
    run(Path::new(env!("CARGO_BIN_EXE_studies")), folder, arguments, &[])
}

/// Runs the studies' program in `folder`, and asserts success and an empty stderr.
fn succeeds(folder: &Path, arguments: &[&str]) -> Answer {
    let answer = studies(folder, arguments);
    assert_eq!((answer.code, answer.stderr.as_str()), (Some(0), ""), "{arguments:?}: {}", answer.stdout);
    answer
}
