//! `wgsl/bounds_trace.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-bounds-trace`.

use lapidary_bounds_trace::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/bounds_trace.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/bounds_trace.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
