//! `wgsl/convex_trace.wgsl`, function by function, on the device: `cargo test -p lapidary-convex_trace`.

use lapidary_convex_trace::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/convex_trace.wgsl"), formulas())
}
