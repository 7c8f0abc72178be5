//! `wgsl/convex_trace.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-convex_trace`.

use lapidary_convex_trace::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(
        include_str!("../../../wgsl/convex_trace.wgsl"),
        "\n",
        include_str!("../../../wgsl/naive/convex_trace.wgsl")
    );
    lapidary_assay::module::test(module, formulas())
}
