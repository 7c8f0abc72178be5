//! Device tests of every function of `wgsl/proxy_geometry.wgsl` and its naive forms:
//! `cargo test -p lapidary-proxy-geometry`.

use lapidary_proxy_geometry::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/proxy_geometry.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/proxy_geometry.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
