//! Device tests of every function of `wgsl/diffusion.wgsl` and its naive forms:
//! `cargo test -p lapidary-diffusion`.

use lapidary_diffusion::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/diffusion.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/diffusion.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
