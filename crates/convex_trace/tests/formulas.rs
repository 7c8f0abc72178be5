//! Device tests of every function of `wgsl/convex_trace.wgsl` and its naive forms:
//! `cargo test -p lapidary-convex-trace`.

use lapidary_convex_trace::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/convex_trace.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/convex_trace.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
