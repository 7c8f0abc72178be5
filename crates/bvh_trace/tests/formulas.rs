//! `wgsl/bvh_trace.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-bvh_trace`.

use lapidary_bvh_trace::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module =
        concat!(include_str!("../../../wgsl/bvh_trace.wgsl"), "\n", include_str!("../../../wgsl/naive/bvh_trace.wgsl"));
    lapidary_assay::module::test(module, formulas())
}
