//! `cook cost`.

mod cdrf;
mod effects;
mod gem;
mod optical_path;
mod restraint;
mod sphere;

use super::{Context, Failure, Outcome, number, output, progress};
use lapidary_cook::cost::page::{self, Tables};
use lapidary_cook::cost::{CostError, Options, views};
use lapidary_cook::text_file;
use lapidary_plan::Rung;
use lapidary_render::file;
use serde::{Serialize, de::DeserializeOwned};
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};

/// What accuracy costs: the error and the time of every rung of a ladder.
///
/// `gem`: the gem's ladder, timed. Takes minutes. Times are the least of interleaved rounds; leave the machine alone meanwhile.
///
/// `cdrf`: the ladder of the curvature-dependent reflectance, timed in the same way beside Lambert's law and a blur in a texture.
///
/// `optical_path`: the ladder of light's ways through stone, by solver, neighbours and size of the grid. Takes minutes.
///
/// `effects`: each effect alone, none, and all: time, instructions and bytes.
///
/// `restraint`: what is saved by work that a pixel or a tile has no use for: rays that end when what they carry can no longer be seen, and ways
/// through stone sought in tiles with matter alone; and a variant of the recipe for each material beside one for all. Takes minutes.
///
/// `sphere`: the curvature-dependent reflectance beside random walks through spheres, on the CPU. Takes half a minute.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook cost gem\n  ./cook cost gem --rungs proxy-1,convex-1,bvh-1,triangles-1 --rounds 15\n  ./cook cost gem --json --out target/cost\n  ./cook cost gem --from docs/measurements/lavapipe/gem.json --fill docs/gem_ladder.md,docs/gem_proxy.md\n  ./cook cost cdrf --rungs lambert,table-256-rgba8,accurate,blur\n  ./cook cost optical_path --rungs lambert,tiled-26-64,godunov-64\n  ./cook cost restraint --rungs convex-64 --rounds 3\n  ./cook cost sphere --out target/cost"
)]
pub(super) struct Arguments {
    /// What to measure: gem, cdrf, optical_path, effects, restraint or sphere.
    #[arg(default_value = "gem")]
    technique: String,
    /// gem, cdrf, optical_path, restraint: rungs to measure, comma-separated; all where left out.
    #[arg(long, value_delimiter = ',', value_parser = parse_rung)]
    rungs: Vec<Rung>,
    /// gem: views to compare in, comma-separated; all where left out.
    #[arg(long, value_delimiter = ',', value_parser = parse_view)]
    views: Vec<views::View>,
    /// gem, cdrf, optical_path, effects, restraint: rounds of timing, 7 where left out, 5 of optical_path and restraint; 0 leaves times out, but of restraint.
    #[arg(long, value_parser = number::whole(0..=u32::MAX))]
    rounds: Option<u32>,
    /// sphere: random walks through each sphere, 1000000 where left out.
    #[arg(long, value_name = "N", value_parser = number::whole(NonZeroU64::MIN..=NonZeroU64::MAX))]
    walks: Option<NonZeroU64>,
    /// sphere: the same seed gives the same walks; 1 where left out.
    #[arg(long, value_parser = number::whole(0..=u64::MAX))]
    seed: Option<u64>,
    /// Show an earlier run's NAME.json, such as gem.json, again instead of measuring.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["rungs", "views", "rounds", "walks", "seed"])]
    from: Option<PathBuf>,
    /// One JSON document on stdout, a row for each thing measured, and nothing else.
    #[arg(long)]
    json: bool,
    /// A folder for the text, the plots and NAME.json, which holds everything.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Pages, comma-separated, whose generated tables are made anew.
    #[arg(long, value_name = "FILE", value_delimiter = ',')]
    fill: Vec<PathBuf>,
    /// gem: where the time of the cheapest rungs goes instead: frames from which one thing after another is taken away; with --out,
    /// gem_profile.txt.
    #[arg(long, conflicts_with_all = ["rungs", "views", "from", "json", "fill"])]
    profile: bool,
}

fn parse_rung(text: &str) -> Result<Rung, String> {
    match text.parse()? {
        Rung::Reference => Err("the reference is what the others are compared with".to_owned()),
        rung => Ok(rung),
    }
}

fn parse_view(text: &str) -> Result<views::View, String> {
    let all = || views::VIEWS.into_iter().chain(views::CONCAVE);
    let names: Vec<&str> = all().map(|view| view.name).collect();
    let found = all().find(|view| view.name == text);
    found.ok_or_else(|| format!("no such view{}", lapidary_scene::nearest::suggest(text, &names)))
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    match arguments.technique.as_str() {
        "gem" => gem::run(context, arguments),
        "cdrf" => cdrf::run(context, arguments),
        "optical_path" => optical_path::run(context, arguments),
        "effects" => effects::run(context, arguments),
        "restraint" => restraint::run(context, arguments),
        "sphere" => sphere::run(arguments),
        other => Err(CostError::Technique(other.to_owned()).into()),
    }
}

impl Arguments {
    /// Refuses the flags that the technique would ignore: all that are some technique's but those that it obeys.
    fn refuse_but(&self, technique: &str, obeyed: &[&str]) -> Result<(), Failure> {
        let flags = [
            ("--rungs", !self.rungs.is_empty()),
            ("--views", !self.views.is_empty()),
            ("--rounds", self.rounds.is_some()),
            ("--walks", self.walks.is_some()),
            ("--seed", self.seed.is_some()),
            ("--profile", self.profile),
        ];
        match flags.iter().find(|(flag, given)| *given && !obeyed.contains(flag)) {
            Some((flag, _)) => Err(Failure(format!("`{technique}` knows no {flag}; leave it out"))),
            None => Ok(()),
        }
    }
}

/// Runs what takes minutes behind a progress bar.
fn behind_a_bar<T>(
    run: impl FnOnce(&mut dyn FnMut(&'static str, u64, u64)) -> Result<T, CostError>,
) -> Result<T, Failure> {
    let bar = progress::bar(0, "measuring");
    let done = run(&mut |what, done, total| {
        bar.set_message(what);
        bar.set_length(total);
        bar.set_position(done);
    })?;
    bar.finish_and_clear();
    Ok(done)
}

/// Bytes of a record or a page; the largest record takes a hundredth.
const MOST_BYTES: u64 = 64 << 20;

fn read_text(path: &Path) -> Result<String, Failure> {
    text_file::read(path, MOST_BYTES).map_err(Failure)
}

/// Where a report goes, found fit before anything is measured.
struct Places<'a> {
    technique: &'static str,
    arguments: &'a Arguments,
    pages: Vec<(&'a PathBuf, String)>,
}

/// What is shown of a report.
struct Shown {
    text: String,
    /// The document of `--json`.
    rows: String,
    /// Names and contents of plots.
    plots: Vec<(String, String)>,
}

impl<'a> Places<'a> {
    fn new(technique: &'static str, arguments: &'a Arguments) -> Result<Self, Failure> {
        if let Some(out) = &arguments.out {
            let failed = |error: std::io::Error| Failure(format!("{}: cannot be made: {error}", out.display()));
            std::fs::create_dir_all(out).map_err(failed)?;
            file::check_writable(&out.join(format!("{technique}.txt")))?;
        }
        let read = |path: &'a PathBuf| Ok((path, read_text(path)?));
        let pages: Vec<(&PathBuf, String)> = arguments.fill.iter().map(read).collect::<Result<_, Failure>>()?;
        for (path, page) in &pages {
            page::check(page).map_err(|error| Failure(format!("{}: {error}", path.display())))?;
            file::check_writable(path)?;
        }
        Ok(Self { technique, arguments, pages })
    }

    /// The report of `--from`, or a new one.
    fn report<R: DeserializeOwned>(&self, measure: impl FnOnce() -> Result<R, Failure>) -> Result<R, Failure> {
        let Some(path) = &self.arguments.from else { return measure() };
        let technique = self.technique;
        serde_json::from_str(&read_text(path)?).map_err(|error| {
            let path = path.display();
            Failure(format!("{path}: not a {technique}.json of `./cook cost {technique} --out`: {error}; measure anew"))
        })
    }

    /// Writes the report's files and pages, all of them or none that is not whole, and shows it.
    fn write<R: Tables + Serialize>(&self, report: &R, shown: &Shown) -> Result<Outcome, Failure> {
        let fill = |(path, page): &(&'a PathBuf, String)| match page::fill(page, report) {
            Ok(filled) => Ok((*path, filled)),
            Err(error) => Err(Failure(format!("{}: {error}", path.display()))),
        };
        let filled: Vec<(&PathBuf, String)> = self.pages.iter().map(fill).collect::<Result<_, _>>()?;
        if let Some(out) = &self.arguments.out {
            let write = |name: &str, contents: &str| file::replace(&out.join(name), contents.as_bytes());
            write(&format!("{}.txt", self.technique), &shown.text)?;
            write(&format!("{}.json", self.technique), &serde_json::to_string_pretty(report)?)?;
            for (name, plot) in &shown.plots {
                write(name, plot)?;
            }
        }
        for (path, page) in filled {
            file::replace(path, page.as_bytes())?;
        }
        output::line(if self.arguments.json { &shown.rows } else { shown.text.trim_end() })?;
        Ok(Outcome::Passed)
    }
}
