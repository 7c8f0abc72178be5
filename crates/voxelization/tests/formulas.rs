//! Tests `wgsl/voxelization.wgsl` and its naive forms, function by function, on the device:
//! `cargo test -p lapidary-voxelization`.

use lapidary_voxelization::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/voxelization.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/voxelization.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
