//! `wgsl/refraction.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-refraction`.

use lapidary_refraction::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(
        include_str!("../../../wgsl/refraction.wgsl"),
        "\n",
        include_str!("../../../wgsl/naive/refraction.wgsl")
    );
    lapidary_assay::module::test(module, formulas())
}
