//! Device tests of every function of `wgsl/curvature.wgsl` and its naive forms:
//! `cargo test -p lapidary-curvature`.

use lapidary_curvature::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/curvature.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/curvature.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
