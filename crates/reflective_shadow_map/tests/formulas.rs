//! `wgsl/reflective_shadow_map.wgsl`, function by function, on the device: `cargo test -p lapidary-reflective_shadow_map`.

use lapidary_reflective_shadow_map::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/reflective_shadow_map.wgsl"), formulas())
}
