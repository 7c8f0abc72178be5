//! `wgsl/convex_walk.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-convex-walk`.

use lapidary_convex_walk::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/convex_walk.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/convex_walk.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
