//! `cook frame`.

use super::drawn::{Drawn, planned, tell};
use super::{Context, Failure, Outcome, output};
use lapidary_plan::Rung;
use lapidary_render::frame::{Frame, Resource};
use std::path::PathBuf;

/// Writes a scene's frame as data for another host: resources with their contents, pipelines as
/// WGSL, passes in order.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook frame brilliant --out frame\n  ./cook frame my_stone.glb --size 1920x1080 --samples 1 --out frame"
)]
pub(super) struct Arguments {
    #[command(flatten)]
    drawn: Drawn,
    /// New or empty output folder.
    #[arg(short, long, value_name = "DIR", help_heading = "Options")]
    out: PathBuf,
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    Frame::check_folder(&arguments.out)?;
    let (scene, settings, mut notes) = arguments.drawn.open(Vec::new())?;
    if settings.rung == Rung::Reference {
        return Err(Failure("rung `reference` is computed on the CPU and has no frame; take another rung".to_owned()));
    }
    let mut frame = lapidary_render::frame(None, &scene, &settings)?;
    // Only reflectance tables are computed by a device.
    if frame.resources.iter().any(Resource::is_left_out) {
        frame = lapidary_render::frame(Some(context.gpu()?), &scene, &settings)?;
    }
    frame.write(&arguments.out)?;
    notes.extend(planned(&scene, &settings));
    tell(&notes, &scene.lacking.clauses());
    output::line(&format!(
        "{}: {} resources, {} pipelines, {} passes",
        arguments.out.display(),
        frame.resources.len(),
        frame.pipelines.len(),
        frame.passes.len()
    ))?;
    Ok(Outcome::Passed)
}
