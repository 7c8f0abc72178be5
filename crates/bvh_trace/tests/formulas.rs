//! `wgsl/bvh_trace.wgsl`, function by function, on the device: `cargo test -p lapidary-bvh_trace`.

use lapidary_bvh_trace::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/bvh_trace.wgsl"), formulas())
}
