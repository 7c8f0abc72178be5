//! `wgsl/curvature.wgsl`, function by function, on the device: `cargo test -p lapidary-curvature`.

use lapidary_curvature::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/curvature.wgsl"), formulas())
}
