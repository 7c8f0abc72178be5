//! `wgsl/fresnel.wgsl`, function by function, on the device: `cargo test -p lapidary-fresnel`.

use lapidary_fresnel::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/fresnel.wgsl"), formulas())
}
