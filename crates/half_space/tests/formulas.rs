//! Device tests of every function of `wgsl/half_space.wgsl` and its naive forms:
//! `cargo test -p lapidary-half-space`.

use lapidary_half_space::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/half_space.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/half_space.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
