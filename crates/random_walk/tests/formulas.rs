//! Device tests of every function of `wgsl/random_walk.wgsl` and its naive forms:
//! `cargo test -p lapidary-random-walk`.

use lapidary_random_walk::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/random_walk.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/random_walk.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
