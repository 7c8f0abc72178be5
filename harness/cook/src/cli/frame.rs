//! `cook frame`.

use super::asked::Asked;
use super::{Context, Failure, Outcome, output};
use lapidary_plan::Rung;
use lapidary_render::{MOST_SAMPLES, Settings};
use lapidary_scene::{SAMPLES, Scene};
use std::path::PathBuf;

/// A scene's frame as data, for another host: resources with their contents, pipelines as WGSL, passes in order.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook frame brilliant --out frame\n  ./cook frame my_stone.glb --size 1920x1080 --samples 1 --out frame"
)]
pub(super) struct Arguments {
    #[command(flatten)]
    asked: Asked,
    /// Samples along each side of a pixel.
    #[arg(long, value_name = "N", default_value_t = SAMPLES, value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_SAMPLES)))]
    samples: u32,
    /// A new or empty folder.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    let scene = Scene::open(&arguments.asked.scene)?;
    let (settings, notes) = arguments.asked.settings(&scene)?;
    if settings.rung == Rung::Reference {
        return Err(Failure("rung `reference` is computed on the CPU and has no frame; take another rung".to_owned()));
    }
    let settings = Settings { samples: arguments.samples, ..settings };
    let frame = lapidary_render::frame(Some(context.gpu()?), &scene, &settings)?;
    frame.write(&arguments.out)?;
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
