//! `wgsl/fresnel.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-fresnel`.

use lapidary_fresnel::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module =
        concat!(include_str!("../../../wgsl/fresnel.wgsl"), "\n", include_str!("../../../wgsl/naive/fresnel.wgsl"));
    lapidary_assay::module::test(module, formulas())
}
