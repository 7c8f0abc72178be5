//! Tests `wgsl/reflective_shadow_map.wgsl` and its naive forms, function by function, on the
//! device: `cargo test -p lapidary-reflective-shadow-map`.

use lapidary_reflective_shadow_map::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/reflective_shadow_map.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/reflective_shadow_map.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
