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
use std::path::{Path, PathBuf};

/// Measures what accuracy costs: the error and the time of every rung of a ladder. Times are the
/// minimum over interleaved rounds; leave the machine alone meanwhile.
#[derive(clap::Args)]
#[command(
    subcommand_required = true,
    arg_required_else_help = true,
    after_help = "Examples:\n  ./cook cost gem\n  ./cook cost gem --rungs proxy-1,convex-1,bvh-1,triangles-1 --rounds 15\n  ./cook cost gem --json --out target/cost\n  ./cook cost gem --from docs/measurements/lavapipe/gem.json --fill docs/gem_ladder.md,docs/gem_proxy.md\n  ./cook cost cdrf --rungs lambert,table-256-rgba8,accurate,blur\n  ./cook cost optical_path --rungs lambert,tiled-26-64,godunov-64\n  ./cook cost restraint --rungs convex-64 --rounds 3\n  ./cook cost sphere --out target/cost"
)]
pub(super) struct Arguments {
    #[command(subcommand)]
    technique: Technique,
}

#[derive(clap::Subcommand)]
#[command(rename_all = "snake_case")]
enum Technique {
    Gem(gem::Arguments),
    Cdrf(cdrf::Arguments),
    OpticalPath(optical_path::Arguments),
    Effects(effects::Arguments),
    Restraint(restraint::Arguments),
    Sphere(sphere::Arguments),
}

/// Source and destination of a report.
#[derive(clap::Args)]
struct Report {
    /// Show an earlier run's NAME.json, such as gem.json, instead of measuring.
    #[arg(long, value_name = "FILE")]
    from: Option<PathBuf>,
    /// Print one JSON document on stdout, with a row for each measurement, and nothing else.
    #[arg(long)]
    json: bool,
    /// Folder for the text, the plots, and NAME.json with all data.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Pages, comma-separated, whose generated tables are updated.
    #[arg(long, value_name = "FILE", value_delimiter = ',')]
    fill: Vec<PathBuf>,
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
    match &arguments.technique {
        Technique::Gem(arguments) => gem::run(context, arguments),
        Technique::Cdrf(arguments) => cdrf::run(context, arguments),
        Technique::OpticalPath(arguments) => optical_path::run(context, arguments),
        Technique::Effects(arguments) => effects::run(context, arguments),
        Technique::Restraint(arguments) => restraint::run(context, arguments),
        Technique::Sphere(arguments) => sphere::run(arguments),
    }
}

/// Runs a measurement of several minutes behind a progress bar.
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

/// Maximum size of a record or a page in bytes; the largest record takes a hundredth of it.
const MOST_BYTES: u64 = 64 << 20;

fn read_text(path: &Path) -> Result<String, Failure> {
    text_file::read(path, MOST_BYTES).map_err(Failure)
}

/// Destinations of a report, checked before anything is measured.
struct Places<'a> {
    technique: &'static str,
    report: &'a Report,
    pages: Vec<(&'a PathBuf, String)>,
}

/// Forms in which a report is shown.
struct Shown {
    text: String,
    /// Document for `--json`.
    rows: String,
    /// Names and contents of plots.
    plots: Vec<(String, String)>,
}

impl<'a> Places<'a> {
    fn new(technique: &'static str, report: &'a Report) -> Result<Self, Failure> {
        if let Some(out) = &report.out {
            let failed = |error: std::io::Error| Failure(format!("{}: cannot be made: {error}", out.display()));
            std::fs::create_dir_all(out).map_err(failed)?;
            file::check_writable(&out.join(format!("{technique}.txt")))?;
        }
        let read = |path: &'a PathBuf| Ok((path, read_text(path)?));
        let pages: Vec<(&PathBuf, String)> = report.fill.iter().map(read).collect::<Result<_, Failure>>()?;
        for (path, page) in &pages {
            page::check(page).map_err(|error| Failure(format!("{}: {error}", path.display())))?;
            file::check_writable(path)?;
        }
        Ok(Self { technique, report, pages })
    }

    /// Returns the report of `--from`, or measures a new one.
    fn report<R: DeserializeOwned>(&self, measure: impl FnOnce() -> Result<R, Failure>) -> Result<R, Failure> {
        let Some(path) = &self.report.from else { return measure() };
        let technique = self.technique;
        serde_json::from_str(&read_text(path)?).map_err(|error| {
            let path = path.display();
            Failure(format!("{path}: not a {technique}.json of `./cook cost {technique} --out`: {error}; measure anew"))
        })
    }

    /// Writes the report's files and pages, and shows the report. No file is left partially
    /// written.
    fn write<R: Tables + Serialize>(&self, report: &R, shown: &Shown) -> Result<Outcome, Failure> {
        let fill = |(path, page): &(&'a PathBuf, String)| match page::fill(page, report) {
            Ok(filled) => Ok((*path, filled)),
            Err(error) => Err(Failure(format!("{}: {error}", path.display()))),
        };
        let filled: Vec<(&PathBuf, String)> = self.pages.iter().map(fill).collect::<Result<_, _>>()?;
        if let Some(out) = &self.report.out {
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
        output::line(if self.report.json { &shown.rows } else { shown.text.trim_end() })?;
        Ok(Outcome::Passed)
    }
}
