//! Tests `wgsl/texture_diffusion.wgsl` and its naive forms, function by function, on the device:
//! `cargo test -p lapidary-texture-diffusion`.

use lapidary_texture_diffusion::formulas::formulas;

const MODULE: &str = include_str!("../../../wgsl/texture_diffusion.wgsl");
const NAIVE: &str = include_str!("../../../wgsl/naive/texture_diffusion.wgsl");

fn main() -> std::process::ExitCode {
    lapidary_trials::test(&[MODULE, NAIVE], formulas())
}
