//! Device tests of every function of `wgsl/bvh_trace.wgsl` and its naive forms:
//! `cargo test -p lapidary-bvh-trace`.

use lapidary_bvh_trace::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/bvh_trace.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/bvh_trace.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
