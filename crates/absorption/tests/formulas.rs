//! Device tests of every function of `wgsl/absorption.wgsl` and its naive forms:
//! `cargo test -p lapidary-absorption`.

use lapidary_absorption::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/absorption.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/absorption.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
