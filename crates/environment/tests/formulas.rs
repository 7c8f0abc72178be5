//! Device tests of every function of `wgsl/environment.wgsl` and its naive forms:
//! `cargo test -p lapidary-environment`.

use lapidary_environment::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/environment.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/environment.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
