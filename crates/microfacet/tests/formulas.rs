//! `wgsl/microfacet.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-microfacet`.

use lapidary_microfacet::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(
        include_str!("../../../wgsl/microfacet.wgsl"),
        "\n",
        include_str!("../../../wgsl/naive/microfacet.wgsl")
    );
    lapidary_assay::module::test(module, formulas())
}
