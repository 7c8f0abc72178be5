//! `wgsl/veins.wgsl`, function by function, on the device: `cargo test -p lapidary-veins`.

use lapidary_veins::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/veins.wgsl"), formulas())
}
