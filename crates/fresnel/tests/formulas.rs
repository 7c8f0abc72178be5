//! Device tests of every function of `wgsl/fresnel.wgsl` and its naive forms:
//! `cargo test -p lapidary-fresnel`.

use lapidary_fresnel::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/fresnel.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/fresnel.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
