//! `wgsl/cdrf.wgsl`, function by function, on the device: `cargo test -p lapidary-cdrf`.

use lapidary_cdrf::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/cdrf.wgsl"), formulas())
}
