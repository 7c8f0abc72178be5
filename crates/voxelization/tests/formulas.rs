//! `wgsl/voxelization.wgsl`, function by function, on the device: `cargo test -p lapidary-voxelization`.

use lapidary_voxelization::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/voxelization.wgsl"), formulas())
}
