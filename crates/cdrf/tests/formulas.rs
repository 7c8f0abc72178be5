//! Device tests of every function of `wgsl/cdrf.wgsl` and its naive forms:
//! `cargo test -p lapidary-cdrf`.

use lapidary_cdrf::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/cdrf.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/cdrf.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
