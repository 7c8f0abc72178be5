//! `wgsl/srgb.wgsl`, function by function, on the device: `cargo test -p lapidary-srgb`.

use lapidary_srgb::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/srgb.wgsl"), formulas())
}
