//! `wgsl/environment.wgsl`, function by function, on the device: `cargo test -p lapidary-environment`.

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(
        include_str!("../../../wgsl/environment.wgsl"),
        lapidary_environment::formulas::formulas(),
    )
}
