//! `cook dist`.

use crate::dist;
use lapidary_cook::command::{Failure, Outcome, output};
use lapidary_cookbook::repository;
use std::path::PathBuf;

/// Writes every module and every recipe in every language: WGSL, GLSL, GLSL ES, HLSL, MSL, SPIR-V.
#[derive(clap::Args)]
#[command(after_help = "Example: ./cook dist --out shaders")]
pub struct Arguments {
    /// Output folder; by default target/dist in the cookbook's repository, lapidary-dist elsewhere.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let out = arguments.out.clone().unwrap_or_else(|| repository::output("dist"));
    let written = dist::write(&out)?;
    output::line(&format!("{}: {} files", written.folder.display(), written.files))?;
    Ok(Outcome::Passed)
}
