//! `wgsl/optical_path.wgsl`, function by function, on the device: `cargo test -p lapidary-optical_path`.

use lapidary_optical_path::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/optical_path.wgsl"), formulas())
}
