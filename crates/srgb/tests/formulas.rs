//! `wgsl/srgb.wgsl`, function by function, on the device: `cargo test -p lapidary-srgb`.

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/srgb.wgsl"), lapidary_srgb::formulas::formulas())
}
