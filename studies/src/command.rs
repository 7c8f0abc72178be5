//! `cook studies`, as which `cook cost` runs what is a study.

use crate::{cdrf, dynamic, gem, outside, restraint, sphere};
use lapidary_cook::command::{Context, Failure, Outcome, number, output};
use lapidary_gpu::Gpu;
use lapidary_ladders::shown::{Rungs, Shown, Timed, behind_a_bar, on_gpu, prepare, read, show, timed};
use lapidary_ladders::{CostError, Ladder, Options, Progress, Report, Table};
use lapidary_plan::Rung;
use std::path::{Path, PathBuf};

/// Measures what was measured once and decided. Times are the minimum over interleaved rounds; leave
/// the machine alone meanwhile.
#[derive(clap::Args)]
#[command(
    subcommand_required = true,
    arg_required_else_help = true,
    after_help = "Examples:\n  ./cook studies gem --beside target/cost/gem.json --out target/cost\n  ./cook studies gem --profile\n  ./cook studies cdrf\n  ./cook studies restraint --rungs convex-64 --rounds 3\n  ./cook studies dynamic --rounds 3\n  ./cook studies sphere --out target/cost\n  ./cook studies sphere --from docs/measurements/random_walk/sphere.json --fill docs/cdrf.md"
)]
pub struct Arguments {
    #[command(subcommand)]
    study: Study,
}

#[derive(clap::Subcommand)]
#[command(rename_all = "snake_case")]
enum Study {
    /// What the gem ladder rests on: the proxy at small sizes, time by the number of facets, and total
    /// reflection by how the proxy's mesh is made. Takes minutes.
    Gem(Gem),
    /// What the reflectance leaves of the distance from random walks: by the law of a half space, by
    /// shadows, and for a head.
    Cdrf(Beside),
    /// What light that leaves a stone meets: the environment, the picture, or bounds of other bodies;
    /// error and time of each.
    Outside(Timed),
    /// Frames in motion: light, camera, shape and topology; each computed from nothing, and with what the one
    /// before left.
    Dynamic(Timed),
    /// Savings from skipping work that a pixel or a tile does not need. Ends rays whose contribution
    /// can no longer be seen, traces optical paths only in tiles with matter, and compares one
    /// recipe variant per material with one for all. Takes minutes.
    Restraint(Rungs),
    /// Compares the curvature-dependent reflectance with random walks through spheres, on the CPU.
    /// Takes half a minute.
    Sphere(Sphere),
}

/// A study that shares the report of its ladder.
#[derive(clap::Args)]
struct Beside {
    /// The ladder's report, as `./cook cost NAME --out` writes it: the study's rows are added to its own, timed
    /// in as many rounds.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["from", "rounds"])]
    beside: Option<PathBuf>,
    #[command(flatten)]
    timed: Timed,
}

#[derive(clap::Args)]
struct Gem {
    /// Profile the cheapest rungs instead, with frames that leave out one part after another; with
    /// --out, written to gem_profile.txt.
    #[arg(long, conflicts_with_all = ["beside", "from", "json", "fill"])]
    profile: bool,
    #[command(flatten)]
    beside: Beside,
}

#[derive(clap::Args)]
struct Sphere {
    /// Random walks through each sphere: a million take half a minute on two cores.
    #[arg(long, value_name = "N", default_value_t = 1_000_000, conflicts_with = "from", value_parser = number::whole(1..=u64::MAX))]
    walks: u64,
    /// Seed of the walks; the same seed gives the same walks.
    #[arg(long, default_value_t = 1, conflicts_with = "from", value_parser = number::whole(0..=u64::MAX))]
    seed: u64,
    #[command(flatten)]
    shown: Shown,
}

/// Rounds and frame of the studies that share a ladder's report, as the ladder has them by default.
const ROUNDS: u32 = 7;
const FRAME: [u32; 2] = [1920, 1080];

/// Runs the command.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    match &arguments.study {
        Study::Gem(Gem { profile: true, beside }) => profile(context, &beside.timed),
        Study::Gem(Gem { beside, .. }) => {
            beside.show(context, &gem::LADDER, |report| gem::tables::own(report).to_vec(), gem::measure)
        }
        Study::Cdrf(beside) => {
            beside.show(context, &cdrf::LADDER, |report| cdrf::tables::own(report).to_vec(), cdrf::measure)
        }
        Study::Outside(arguments) => {
            let options = timed(outside::options(), arguments.rounds);
            let measure = |gpu: &Gpu, progress: Progress<'_>| outside::run(gpu, &options, progress);
            show(&outside::LADDER, &arguments.shown, || on_gpu(context, measure))
        }
        Study::Dynamic(arguments) => {
            let options = timed(dynamic::options(), arguments.rounds);
            let measure = |gpu: &Gpu, progress: Progress<'_>| dynamic::run(gpu, &options, progress);
            show(&dynamic::LADDER, &arguments.shown, || on_gpu(context, measure))
        }
        Study::Restraint(arguments) => {
            if let Some(rung) = arguments.rungs.iter().find(|rung| !matches!(rung, Rung::Inside { .. })) {
                return Err(Failure(format!(
                    "`restraint` has no rung {rung}, whose rays end at once; take one such as convex-8"
                )));
            }
            if arguments.timed.rounds == Some(0) {
                return Err(Failure("`restraint` compares times; --rounds takes at least 1".to_owned()));
            }
            arguments.show(context, &restraint::LADDER, restraint::options(), restraint::run)
        }
        Study::Sphere(arguments) => {
            let walk = |progress: Progress<'_>| Ok(sphere::run(arguments.walks, arguments.seed, progress));
            show(&sphere::LADDER, &arguments.shown, || behind_a_bar(walk))
        }
    }
}

impl Beside {
    /// Measures a study behind the ladder's rows, if there are any, and shows the report. `tables_of` makes the
    /// study's tables.
    fn show(
        &self,
        context: &Context,
        ladder: &Ladder,
        tables_of: fn(&Report) -> Vec<Table>,
        study: fn(&Gpu, &mut Report, Progress<'_>) -> Result<(), CostError>,
    ) -> Result<Outcome, Failure> {
        let start = |gpu: &Gpu| match &self.beside {
            Some(path) => begun(path, ladder, tables_of, gpu),
            None => {
                let Options { rounds, frame: [width, height], .. } =
                    timed(Options::<Rung> { rounds: ROUNDS, frame: FRAME, rungs: Vec::new() }, self.timed.rounds);
                let settings = [("width", width), ("height", height), ("rounds", rounds)];
                let settings = settings.map(|(name, value)| (name, value.into()));
                Ok(Report::new(ladder.name, gpu.describe(), &settings))
            }
        };
        show(ladder, &self.timed.shown, || {
            let mut report = start(context.gpu()?)?;
            on_gpu(context, |gpu, progress| study(gpu, &mut report, progress))?;
            Ok(report)
        })
    }
}

/// Reads a ladder's report to which a study is added on the same device.
fn begun(path: &Path, ladder: &Ladder, tables_of: fn(&Report) -> Vec<Table>, gpu: &Gpu) -> Result<Report, Failure> {
    let report = read(ladder.name, path)?;
    let file = path.display();
    if report.adapter != gpu.describe() {
        return Err(Failure(format!("{file}: measured on {}, and not on {}", report.adapter, gpu.describe())));
    }
    match tables_of(&report).iter().find(|table| !table.is_empty()) {
        Some(table) => Err(Failure(format!("{file}: holds what the study measures already, such as `{}`", table.name))),
        None => Ok(report),
    }
}

/// Profiles the cheapest rungs of the gem.
fn profile(context: &Context, arguments: &Timed) -> Result<Outcome, Failure> {
    if let Some(out) = &arguments.shown.out {
        prepare(out, "gem_profile.txt")?;
    }
    let text = on_gpu(context, |gpu, progress| {
        let mut timing = |done, total| progress("timing", done, total);
        gem::profile(gpu, arguments.rounds.unwrap_or(ROUNDS).max(1), FRAME, &mut timing)
    })?;
    if let Some(out) = &arguments.shown.out {
        lapidary_files::replace(&out.join("gem_profile.txt"), format!("{text}\n").as_bytes())?;
    }
    output::line(&text)?;
    Ok(Outcome::Passed)
}
