//! Device tests of every function of `wgsl/closest_point.wgsl` and its naive forms:
//! `cargo test -p lapidary-closest-point`.

use lapidary_closest_point::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/closest_point.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/closest_point.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
