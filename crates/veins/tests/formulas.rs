//! Tests `wgsl/veins.wgsl` and its naive forms, function by function, on the device:
//! `cargo test -p lapidary-veins`.

use lapidary_veins::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/veins.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/veins.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
