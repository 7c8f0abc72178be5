//! `wgsl/texture_diffusion.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-texture_diffusion`.

use lapidary_texture_diffusion::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(
        include_str!("../../../wgsl/texture_diffusion.wgsl"),
        "\n",
        include_str!("../../../wgsl/naive/texture_diffusion.wgsl")
    );
    lapidary_assay::module::test(module, formulas())
}
