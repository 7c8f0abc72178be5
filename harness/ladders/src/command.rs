//! `cook cost`.

use crate::gem::{self, views};
use crate::{
    CostError, Ladder, Options, Progress, Report, cdrf, dynamic, effects, optical_path, outside, page, restraint,
    sphere, translucent,
};
use lapidary_cook::command::named::named;
use lapidary_cook::command::{Context, Failure, Outcome, number, output, progress};
use lapidary_cookbook::text_file;
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use lapidary_render::file;
use lapidary_scene::solver::Reflectance;
use std::path::{Path, PathBuf};

/// Measures what accuracy costs: the error and the time of every rung of a ladder. Times are the
/// minimum over interleaved rounds; leave the machine alone meanwhile.
#[derive(clap::Args)]
#[command(
    subcommand_required = true,
    arg_required_else_help = true,
    after_help = "Examples:\n  ./cook cost gem\n  ./cook cost gem --rungs proxy-1,convex-1,bvh-1,triangles-1 --rounds 15\n  ./cook cost gem --json --out target/cost\n  ./cook cost gem --from docs/measurements/lavapipe/gem.json --fill docs/gem_ladder.md,docs/gem_proxy.md\n  ./cook cost cdrf --rungs lambert,table-256-rgba8,accurate,blur\n  ./cook cost optical_path --rungs lambert,tiled-26-64,godunov-64\n  ./cook cost restraint --rungs convex-64 --rounds 3\n  ./cook cost dynamic --rounds 3\n  ./cook cost sphere --out target/cost"
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
    /// Frames in motion: light, camera, shape and topology; each computed from nothing, and with what the one
    /// before left.
    Dynamic(Timed),
    /// Cost of each effect alone, of none, and of all: time, instructions and bytes.
    Effects(Timed),
    /// What light that leaves a stone meets: the environment, the picture, or bounds of other bodies;
    /// error and time of each.
    Outside(Timed),
    /// Savings from skipping work that a pixel or a tile does not need. Ends rays whose contribution
    /// can no longer be seen, traces optical paths only in tiles with matter, and compares one
    /// recipe variant per material with one for all. Takes minutes.
    Restraint(Rungs),
    /// Compares the curvature-dependent reflectance with random walks through spheres, on the CPU.
    /// Takes half a minute.
    Sphere(Sphere),
}

/// Source and destination of a report.
#[derive(clap::Args)]
struct Shown {
    /// Show an earlier run's NAME.json, such as gem.json, instead of measuring.
    #[arg(long, value_name = "FILE")]
    from: Option<PathBuf>,
    /// Print the report as one JSON document on stdout, with a row for each measurement, and nothing
    /// else.
    #[arg(long)]
    json: bool,
    /// Folder for the text, the plots, and NAME.json with all data.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Pages, comma-separated, whose generated tables are updated.
    #[arg(long, value_name = "FILE", value_delimiter = ',')]
    fill: Vec<PathBuf>,
}

#[derive(clap::Args)]
struct Timed {
    /// Rounds of timing; 0 skips timing, except for restraint. 7 by default, 5 for dynamic, optical_path,
    /// translucent and restraint.
    #[arg(long, conflicts_with = "from", value_parser = number::whole(0..=u32::MAX))]
    rounds: Option<u32>,
    #[command(flatten)]
    shown: Shown,
}

#[derive(clap::Args)]
struct Rungs {
    /// Rungs to measure, comma-separated; all by default.
    #[arg(long, value_delimiter = ',', value_parser = parse_rung, conflicts_with = "from")]
    rungs: Vec<Rung>,
    #[command(flatten)]
    timed: Timed,
}

#[derive(clap::Args)]
struct Gem {
    /// Views to compare, comma-separated; all by default.
    #[arg(long, value_delimiter = ',', value_parser = parse_view, conflicts_with = "from")]
    views: Vec<views::View>,
    /// Profile the cheapest rungs instead, with frames that leave out one part after another; with
    /// --out, written to gem_profile.txt.
    #[arg(long, conflicts_with_all = ["rungs", "views", "from", "json", "fill"])]
    profile: bool,
    #[command(flatten)]
    rungs: Rungs,
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

fn parse_rung(text: &str) -> Result<Rung, String> {
    match text.parse()? {
        Rung::Reference => Err("the reference is what the others are compared with".to_owned()),
        rung => Ok(rung),
    }
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
        Technique::Dynamic(arguments) => {
            let options = timed(dynamic::options(), arguments.rounds);
            let measure = |gpu: &Gpu, progress: Progress<'_>| dynamic::run(gpu, &options, progress);
            show(&dynamic::LADDER, &arguments.shown, || on_gpu(context, measure))
        }
        Technique::Effects(arguments) => {
            let options = timed(effects::options(), arguments.rounds);
            let measure = |gpu: &Gpu, progress: Progress<'_>| effects::run(gpu, &options, progress);
            show(&effects::LADDER, &arguments.shown, || on_gpu(context, measure))
        }
        Technique::Outside(arguments) => {
            let options = timed(outside::options(), arguments.rounds);
            let measure = |gpu: &Gpu, progress: Progress<'_>| outside::run(gpu, &options, progress);
            show(&outside::LADDER, &arguments.shown, || on_gpu(context, measure))
        }
        Technique::Restraint(arguments) => {
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
        Technique::Sphere(arguments) => {
            let walk = |progress: Progress<'_>| Ok(sphere::run(arguments.walks, arguments.seed, progress));
            show(&sphere::LADDER, &arguments.shown, || behind_a_bar(walk))
        }
    }
}

/// Returns the options with the number of rounds, if it was given.
fn timed<R>(options: Options<R>, rounds: Option<u32>) -> Options<R> {
    Options { rounds: rounds.unwrap_or(options.rounds), ..options }
}

impl Rungs {
    /// Measures a ladder with the rungs and rounds that were given, and shows its report.
    fn show(
        &self,
        context: &Context,
        ladder: &Ladder,
        options: Options,
        run: fn(&Gpu, &Options, Progress<'_>) -> Result<Report, CostError>,
    ) -> Result<Outcome, Failure> {
        let mut options = timed(options, self.timed.rounds);
        if !self.rungs.is_empty() {
            options.rungs.clone_from(&self.rungs);
        }
        show(ladder, &self.timed.shown, || on_gpu(context, |gpu, progress| run(gpu, &options, progress)))
    }
}

fn gem(context: &Context, Gem { views, profile, rungs }: &Gem) -> Result<Outcome, Failure> {
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
    // The further data that a page needs are measured only with the whole ladder.
    options.sizes = rungs.is_empty() && views.is_empty();
    if !rungs.is_empty() {
        options.rungs.clone_from(rungs);
    }
    if !views.is_empty() {
        (options.concave, options.views) = views.iter().partition(|view| views::CONCAVE.contains(view));
    }
    if *profile {
        if let Some(out) = &timed.shown.out {
            prepare(out, "gem_profile.txt")?;
        }
        let text = on_gpu(context, |gpu, progress| {
            let mut timing = |done, total| progress("timing", done, total);
            gem::profile(gpu, options.rounds.max(1), options.frame, &mut timing)
        })?;
        if let Some(out) = &timed.shown.out {
            file::replace(&out.join("gem_profile.txt"), format!("{text}\n").as_bytes())?;
        }
        output::line(&text)?;
        return Ok(Outcome::Passed);
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

/// Runs a measurement of several minutes behind a progress bar.
fn behind_a_bar<T>(run: impl FnOnce(Progress<'_>) -> Result<T, CostError>) -> Result<T, Failure> {
    let bar = progress::bar(0, "measuring");
    let done = run(&mut |what, done, total| {
        bar.set_message(what);
        bar.set_length(total);
        bar.set_position(done);
    })?;
    bar.finish_and_clear();
    Ok(done)
}

/// Runs a measurement on the chosen device.
fn on_gpu<T>(context: &Context, run: impl FnOnce(&Gpu, Progress<'_>) -> Result<T, CostError>) -> Result<T, Failure> {
    let gpu = context.gpu()?;
    behind_a_bar(|progress| run(gpu, progress))
}

/// Maximum size of a record or a page in bytes; the largest record takes a hundredth of it.
const MOST_BYTES: u64 = 64 << 20;

fn read_text(path: &Path) -> Result<String, Failure> {
    text_file::read(path, MOST_BYTES).map_err(Failure)
}

/// Makes the folder of a report and checks that a file can be written there.
fn prepare(out: &Path, name: &str) -> Result<(), Failure> {
    let failed = |error: std::io::Error| Failure(format!("{}: cannot be made: {error}", out.display()));
    std::fs::create_dir_all(out).map_err(failed)?;
    Ok(file::check_writable(&out.join(name))?)
}

/// Measures a ladder or reads its report, writes the report's files and pages, and prints it. Files
/// and pages are checked before anything is measured, and none is left partially written.
fn show(ladder: &Ladder, shown: &Shown, measure: impl FnOnce() -> Result<Report, Failure>) -> Result<Outcome, Failure> {
    let name = ladder.name;
    let at = |path: &Path, error: &dyn std::fmt::Display| Failure(format!("{}: {error}", path.display()));
    if let Some(out) = &shown.out {
        prepare(out, &format!("{name}.txt"))?;
    }
    let mut pages = Vec::new();
    for path in &shown.fill {
        let page = read_text(path)?;
        page::check(&page).map_err(|error| at(path, &error))?;
        file::check_writable(path)?;
        pages.push((path, page));
    }
    let report = match &shown.from {
        Some(path) => Report::from_json(name, &read_text(path)?).map_err(|error| at(path, &error))?,
        None => measure()?,
    };
    for (path, page) in &mut pages {
        *page = page::fill(page, ladder, &report).map_err(|error| at(path, &error))?;
    }
    let (text, json) = (report.text(ladder), report.json()?);
    if let Some(out) = &shown.out {
        let plots = (ladder.plots)(&report).into_iter().filter(|plot| !plot.is_empty());
        let plots = plots.map(|plot| (plot.file.to_owned(), plot.svg()));
        let reports = [(format!("{name}.txt"), text.clone()), (format!("{name}.json"), format!("{json}\n"))];
        for (file, contents) in reports.into_iter().chain(plots) {
            file::replace(&out.join(file), contents.as_bytes())?;
        }
    }
    for (path, page) in pages {
        file::replace(path, page.as_bytes())?;
    }
    output::line(if shown.json { &json } else { text.trim_end() })?;
    Ok(Outcome::Passed)
}
