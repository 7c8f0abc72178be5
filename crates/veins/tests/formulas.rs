//! `wgsl/veins.wgsl`, function by function, on the device: `cargo test -p lapidary-veins`.

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/veins.wgsl"), lapidary_veins::formulas::formulas())
}
