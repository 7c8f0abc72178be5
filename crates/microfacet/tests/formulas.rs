//! Device tests of every function of `wgsl/microfacet.wgsl` and its naive forms:
//! `cargo test -p lapidary-microfacet`.

use lapidary_microfacet::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/microfacet.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/microfacet.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
