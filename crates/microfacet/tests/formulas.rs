//! `wgsl/microfacet.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-microfacet`.

use lapidary_microfacet::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/microfacet.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/microfacet.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(&[MODULE, NAIVE], formulas())
}
