//! `wgsl/screen_trace.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-screen-trace`.

use lapidary_screen_trace::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/screen_trace.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/screen_trace.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
