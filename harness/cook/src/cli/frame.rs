//! `cook frame`.

use super::asked::Asked;
use super::{Context, Failure, Outcome, number, output};
use lapidary_plan::{Decisions, Rung};
use lapidary_render::{MOST_SAMPLES, Settings};
use lapidary_scene::{SAMPLES, Scene};
use std::path::PathBuf;

/// Writes a scene's frame as data for another host: resources with their contents, pipelines as
/// WGSL, passes in order.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook frame brilliant --out frame\n  ./cook frame my_stone.glb --size 1920x1080 --samples 1 --out frame"
)]
pub(super) struct Arguments {
    #[command(flatten)]
    asked: Asked,
    /// Samples along each side of a pixel.
    #[arg(long, value_name = "N", default_value_t = SAMPLES, value_parser = number::whole(1..=MOST_SAMPLES))]
    samples: u32,
    /// New or empty output folder.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    let scene = Scene::open(&arguments.asked.scene)?;
    let (settings, mut notes) = arguments.asked.settings(&scene)?;
    if settings.rung == Rung::Reference {
        return Err(Failure("rung `reference` is computed on the CPU and has no frame; take another rung".to_owned()));
    }
    let settings = Settings { samples: arguments.samples, ..settings };
    let frame = lapidary_render::frame(Some(context.gpu()?), &scene, &settings)?;
    frame.write(&arguments.out)?;
    let decisions = Decisions::all(&scene, &settings.request());
    notes.extend(lapidary_plan::notes(&scene, &settings.request(), &decisions.iter().collect::<Vec<_>>()));
    for note in notes {
        eprintln!("cook: {note}");
    }
    output::line(&format!(
        "{}: {} resources, {} pipelines, {} passes",
        arguments.out.display(),
        frame.resources.len(),
        frame.pipelines.len(),
        frame.passes.len()
    ))?;
    Ok(Outcome::Passed)
}
