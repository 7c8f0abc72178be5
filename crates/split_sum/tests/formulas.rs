//! Device tests of every function of `wgsl/split_sum.wgsl` and its naive forms:
//! `cargo test -p lapidary-split-sum`.

use lapidary_split_sum::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/split_sum.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/split_sum.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
