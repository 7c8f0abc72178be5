//! Tests `wgsl/refraction.wgsl` and its naive forms, function by function, on the device:
//! `cargo test -p lapidary-refraction`.

use lapidary_refraction::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/refraction.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/refraction.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
