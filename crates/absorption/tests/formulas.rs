//! `wgsl/absorption.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-absorption`.

use lapidary_absorption::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(
        include_str!("../../../wgsl/absorption.wgsl"),
        "\n",
        include_str!("../../../wgsl/naive/absorption.wgsl")
    );
    lapidary_assay::module::test(module, formulas())
}
