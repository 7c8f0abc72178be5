//! Device tests of every function of `wgsl/optical_path.wgsl` and its naive forms:
//! `cargo test -p lapidary-optical-path`.

use lapidary_optical_path::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/optical_path.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/optical_path.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
