//! `wgsl/dispersion.wgsl`, function by function, on the device: `cargo test -p lapidary-dispersion`.

use lapidary_dispersion::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/dispersion.wgsl"), formulas())
}
