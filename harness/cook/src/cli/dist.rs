//! `cook dist`.

use super::{Failure, Outcome, output};
use lapidary_cook::dist;
use std::path::{Path, PathBuf};

/// Writes every module and every recipe in every language: WGSL, GLSL, GLSL ES, HLSL, MSL, SPIR-V.
#[derive(clap::Args)]
#[command(after_help = "Example: ./cook dist --out shaders")]
pub(super) struct Arguments {
    /// Output folder; target/dist of the cookbook by default.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let out = arguments.out.clone().unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/dist"));
    let written = dist::write(&out)?;
    output::line(&format!("{}: {} files", written.folder.display(), written.files))?;
    Ok(Outcome::Passed)
}
