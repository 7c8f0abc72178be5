//! `wgsl/voxelization.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-voxelization`.

use lapidary_voxelization::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(
        include_str!("../../../wgsl/voxelization.wgsl"),
        "\n",
        include_str!("../../../wgsl/naive/voxelization.wgsl")
    );
    lapidary_assay::module::test(module, formulas())
}
