//! Device tests of every function of `wgsl/dispersion.wgsl` and its naive forms:
//! `cargo test -p lapidary-dispersion`.

use lapidary_dispersion::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/dispersion.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/dispersion.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
