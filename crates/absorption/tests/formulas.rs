//! `wgsl/absorption.wgsl`, function by function, on the device: `cargo test -p lapidary-absorption`.

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(
        include_str!("../../../wgsl/absorption.wgsl"),
        lapidary_absorption::formulas::formulas(),
    )
}
