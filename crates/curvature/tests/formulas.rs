//! `wgsl/curvature.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-curvature`.

use lapidary_curvature::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module =
        concat!(include_str!("../../../wgsl/curvature.wgsl"), "\n", include_str!("../../../wgsl/naive/curvature.wgsl"));
    lapidary_assay::module::test(module, formulas())
}
