//! `wgsl/environment.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-environment`.

use lapidary_environment::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(
        include_str!("../../../wgsl/environment.wgsl"),
        "\n",
        include_str!("../../../wgsl/naive/environment.wgsl")
    );
    lapidary_assay::module::test(module, formulas())
}
