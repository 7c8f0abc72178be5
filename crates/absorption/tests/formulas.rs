//! `wgsl/absorption.wgsl`, function by function, on the device: `cargo test -p lapidary-absorption`.

use lapidary_absorption::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/absorption.wgsl"), formulas())
}
