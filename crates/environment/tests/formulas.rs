//! `wgsl/environment.wgsl`, function by function, on the device: `cargo test -p lapidary-environment`.

use lapidary_environment::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/environment.wgsl"), formulas())
}
