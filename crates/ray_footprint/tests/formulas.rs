//! `wgsl/ray_footprint.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-ray-footprint`.

use lapidary_ray_footprint::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/ray_footprint.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/ray_footprint.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
