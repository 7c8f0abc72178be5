//! `cook scene`.

use super::{Failure, Outcome, output};
use lapidary_render::file;
use lapidary_scene as scene;
use lapidary_scene::{Scene, glb};
use std::path::PathBuf;

/// Writes a built-in scene as binary glTF 2.0, with meshes, materials, lights and camera, for use
/// in other programs.
#[derive(clap::Args)]
#[command(after_help = "Example: ./cook scene brilliant --out brilliant.glb")]
pub(super) struct Arguments {
    #[arg(help = format!("one of {}", scene::names()))]
    name: String,
    /// Output file.
    #[arg(short, long, value_name = "F.glb")]
    out: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    file::check_ending(&arguments.out, ".glb")?;
    let bytes = glb::write(&Scene::named(&arguments.name)?)?;
    lapidary_files::replace(&arguments.out, &bytes)?;
    output::line(&arguments.out.display().to_string())?;
    Ok(Outcome::Passed)
}
