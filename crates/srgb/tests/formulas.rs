//! Tests `wgsl/srgb.wgsl` and its naive forms, function by function, on the device:
//! `cargo test -p lapidary-srgb`.

use lapidary_srgb::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/srgb.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/srgb.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
