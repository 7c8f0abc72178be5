//! `wgsl/optical_path.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-optical_path`.

use lapidary_optical_path::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(
        include_str!("../../../wgsl/optical_path.wgsl"),
        "\n",
        include_str!("../../../wgsl/naive/optical_path.wgsl")
    );
    lapidary_assay::module::test(module, formulas())
}
