//! `wgsl/dispersion.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-dispersion`.

use lapidary_dispersion::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(
        include_str!("../../../wgsl/dispersion.wgsl"),
        "\n",
        include_str!("../../../wgsl/naive/dispersion.wgsl")
    );
    lapidary_assay::module::test(module, formulas())
}
