//! `wgsl/closest_point.wgsl`, function by function, on the device: `cargo test -p lapidary-closest_point`.

use lapidary_closest_point::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/closest_point.wgsl"), formulas())
}
