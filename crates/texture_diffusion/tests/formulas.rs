//! `wgsl/texture_diffusion.wgsl`, function by function, on the device: `cargo test -p lapidary-texture_diffusion`.

use lapidary_texture_diffusion::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/texture_diffusion.wgsl"), formulas())
}
