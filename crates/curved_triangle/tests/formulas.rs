//! `wgsl/curved_triangle.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-curved-triangle`.

use lapidary_curved_triangle::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/curved_triangle.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/curved_triangle.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
