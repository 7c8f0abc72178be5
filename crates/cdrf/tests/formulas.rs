//! `wgsl/cdrf.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-cdrf`.

use lapidary_cdrf::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(include_str!("../../../wgsl/cdrf.wgsl"), "\n", include_str!("../../../wgsl/naive/cdrf.wgsl"));
    lapidary_assay::module::test(module, formulas())
}
