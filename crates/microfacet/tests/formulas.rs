//! `wgsl/microfacet.wgsl`, function by function, on the device: `cargo test -p lapidary-microfacet`.

use lapidary_microfacet::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/microfacet.wgsl"), formulas())
}
