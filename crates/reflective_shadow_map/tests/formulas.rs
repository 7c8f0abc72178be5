//! `wgsl/reflective_shadow_map.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-reflective_shadow_map`.

use lapidary_reflective_shadow_map::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(
        include_str!("../../../wgsl/reflective_shadow_map.wgsl"),
        "\n",
        include_str!("../../../wgsl/naive/reflective_shadow_map.wgsl")
    );
    lapidary_assay::module::test(module, formulas())
}
