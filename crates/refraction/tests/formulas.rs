//! `wgsl/refraction.wgsl`, function by function, on the device: `cargo test -p lapidary-refraction`.

use lapidary_refraction::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/refraction.wgsl"), formulas())
}
