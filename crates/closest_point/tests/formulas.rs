//! `wgsl/closest_point.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-closest_point`.

use lapidary_closest_point::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(
        include_str!("../../../wgsl/closest_point.wgsl"),
        "\n",
        include_str!("../../../wgsl/naive/closest_point.wgsl")
    );
    lapidary_assay::module::test(module, formulas())
}
