//! `wgsl/veins.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-veins`.

use lapidary_veins::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module =
        concat!(include_str!("../../../wgsl/veins.wgsl"), "\n", include_str!("../../../wgsl/naive/veins.wgsl"));
    lapidary_assay::module::test(module, formulas())
}
