//! `wgsl/srgb.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-srgb`.

use lapidary_srgb::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(include_str!("../../../wgsl/srgb.wgsl"), "\n", include_str!("../../../wgsl/naive/srgb.wgsl"));
    lapidary_assay::module::test(module, formulas())
}
