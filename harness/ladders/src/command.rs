//! `cook cost`.

use crate::gem::{self, views};
use crate::options::{Options, Progress};
use crate::shown::{Rungs, Timed, on_gpu, show, timed};
use crate::{cdrf, effects, optical_path, translucent};
use lapidary_cook::command::named::named;
use lapidary_cook::command::{Context, Failure, Outcome};
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_scene::solver::Reflectance;

/// Measures what accuracy costs: the error and the time of every rung of a ladder. Times are the
/// minimum over interleaved rounds; leave the machine alone meanwhile.
#[derive(clap::Args)]
#[command(
    subcommand_required = true,
    arg_required_else_help = true,
    after_help = "Examples:\n  ./cook cost gem\n  ./cook cost gem --rungs proxy-1,convex-1,bvh-1,triangles-1 --rounds 15\n  ./cook cost gem --json --out target/cost\n  ./cook cost gem --from docs/measurements/lavapipe/gem.json --fill docs/gem_ladder.md,docs/gem_proxy.md\n  ./cook cost cdrf --rungs lambert,table-256-rgba8,accurate,blur\n  ./cook cost optical_path --rungs lambert,tiled-26-64,godunov-64\n\nMeasured once: ./cook studies has restraint, dynamic, outside, sphere, and what gem and cdrf rest on."
)]
pub struct Arguments {
    #[command(subcommand)]
    technique: Technique,
}

#[derive(clap::Subcommand)]
#[command(rename_all = "snake_case")]
enum Technique {
    /// Ladder of the gem, timed. Takes minutes.
    Gem(Gem),
    /// Ladder of the curvature-dependent reflectance, timed against Lambert's law and a blur in a
    /// texture.
    Cdrf(Rungs),
    /// Ladder of optical paths through stone, by solver, neighbours and grid size. Takes minutes.
    OpticalPath(Rungs),
    /// Ladder of bodies through which light comes: optical paths and diffusion beside random walks.
    /// Takes minutes.
    Translucent(Rungs),
    /// Cost of each effect alone, of none, and of all: time, instructions and bytes.
    Effects(Timed),
}

#[derive(clap::Args)]
struct Gem {
    /// Views to compare, comma-separated; all by default.
    #[arg(long, value_delimiter = ',', value_parser = parse_view, conflicts_with = "from")]
    views: Vec<views::View>,
    #[command(flatten)]
    rungs: Rungs,
}

fn parse_view(text: &str) -> Result<views::View, String> {
    named("view", text, views::VIEWS.into_iter().chain(views::CONCAVE), |view| view.name)
}

/// Runs the command.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    match &arguments.technique {
        Technique::Gem(arguments) => gem(context, arguments),
        Technique::Cdrf(arguments) => {
            let mut rungs = cdrf::options().rungs;
            if !arguments.rungs.is_empty() {
                rungs = arguments.rungs.iter().map(|rung| reflectance(*rung)).collect::<Result<_, _>>()?;
            }
            let options = Options { rungs, ..timed(cdrf::options(), arguments.timed.rounds) };
            let measure = |gpu: &Gpu, progress: Progress<'_>| cdrf::run(gpu, &options, progress);
            show(&cdrf::LADDER, &arguments.timed.shown, || on_gpu(context, measure))
        }
        Technique::Translucent(arguments) => {
            let comes_through = |rung: &Rung| match rung {
                Rung::Diffuse(reflectance) => reflectance.is_lambert(),
                other => matches!(other, Rung::OpticalPath(_) | Rung::Diffusion(_)),
            };
            if let Some(other) = arguments.rungs.iter().find(|rung| !comes_through(rung)) {
                let names = translucent::RUNGS.join(", ");
                return Err(Failure(format!("`translucent` has no rung {other}; there are {names}")));
            }
            arguments.show(context, &translucent::LADDER, translucent::options(), translucent::run)
        }
        Technique::OpticalPath(arguments) => {
            let draws_stone = |rung: &Rung| match rung {
                Rung::Diffuse(reflectance) => reflectance.is_lambert(),
                other => matches!(other, Rung::OpticalPath(_)),
            };
            if let Some(other) = arguments.rungs.iter().find(|rung| !draws_stone(rung)) {
                let names = optical_path::RUNGS.join(", ");
                return Err(Failure(format!("`optical_path` has no rung {other}; there are {names}")));
            }
            arguments.show(context, &optical_path::LADDER, optical_path::options(), optical_path::run)
        }
        Technique::Effects(arguments) => {
            let options = timed(effects::options(), arguments.rounds);
            let measure = |gpu: &Gpu, progress: Progress<'_>| effects::run(gpu, &options, progress);
            show(&effects::LADDER, &arguments.shown, || on_gpu(context, measure))
        }
    }
}

fn gem(context: &Context, Gem { views, rungs }: &Gem) -> Result<Outcome, Failure> {
    let Rungs { rungs, timed } = rungs;
    if let Some(rung) =
        rungs.iter().find(|rung| matches!(rung, Rung::Diffuse(_) | Rung::OpticalPath(_) | Rung::Diffusion(_)))
    {
        let ladder = match rung {
            Rung::Diffuse(_) => "cdrf",
            Rung::Diffusion(_) => "translucent",
            _ => "optical_path",
        };
        return Err(Failure(format!(
            "`gem` has no rung {rung}, which draws no clear stone; `./cook cost {ladder}` has it"
        )));
    }
    let mut options = gem::Options::default();
    options.rounds = timed.rounds.unwrap_or(options.rounds);
    if !rungs.is_empty() {
        options.rungs.clone_from(rungs);
    }
    if !views.is_empty() {
        (options.concave, options.views) = views.iter().partition(|view| views::CONCAVE.contains(view));
    }
    show(&gem::LADDER, &timed.shown, || on_gpu(context, |gpu, progress| gem::run(gpu, &options, progress)))
}

/// Returns a rung of the ladder of reflectances.
fn reflectance(rung: Rung) -> Result<Reflectance, Failure> {
    match rung {
        Rung::Diffuse(reflectance) if cdrf::RUNGS.contains(&reflectance.name()) => Ok(reflectance),
        other => Err(Failure(format!("`cdrf` has no rung {other}; there are {}", cdrf::RUNGS.join(", ")))),
    }
}
