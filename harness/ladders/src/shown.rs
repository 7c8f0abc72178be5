//! Where a report comes from and where it goes, as arguments of a command: measured or read; printed, written, and put
//! into pages.

use crate::error::CostError;
use crate::ladder::Ladder;
use crate::options::{Options, Progress};
use crate::page;
use crate::report::Report;
use lapidary_cook::command::{Context, Failure, Outcome, number, output, progress};
use lapidary_files::text_file;
use lapidary_gpu::Gpu;
use lapidary_plan::Rung;
use std::path::{Path, PathBuf};

/// Source and destination of a report.
#[derive(clap::Args)]
pub struct Shown {
    /// Show an earlier run's NAME.json, such as gem.json, instead of measuring.
    #[arg(long, value_name = "FILE")]
    pub from: Option<PathBuf>,
    /// Print the report as one JSON document on stdout, with a row for each measurement, and nothing
    /// else.
    #[arg(long)]
    pub json: bool,
    /// Folder for the text, the plots, and NAME.json with all data.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Pages, comma-separated, whose generated tables are updated.
    #[arg(long, value_name = "FILE", value_delimiter = ',')]
    pub fill: Vec<PathBuf>,
}

/// How thoroughly to time, and what becomes of the report.
#[derive(clap::Args)]
pub struct Timed {
    /// Rounds of timing; 0 skips timing, where there is more to measure. 7 by default, 5 where frames take
    /// long.
    #[arg(long, conflicts_with = "from", value_parser = number::whole(0..=u32::MAX))]
    pub rounds: Option<u32>,
    /// What becomes of the report.
    #[command(flatten)]
    pub shown: Shown,
}

/// Which rungs to measure, how thoroughly to time them, and what becomes of the report.
#[derive(clap::Args)]
pub struct Rungs {
    /// Rungs to measure, comma-separated; all by default.
    #[arg(long, value_delimiter = ',', value_parser = parse_rung, conflicts_with = "from")]
    pub rungs: Vec<Rung>,
    /// The rounds, and what becomes of the report.
    #[command(flatten)]
    pub timed: Timed,
}

fn parse_rung(text: &str) -> Result<Rung, String> {
    match text.parse()? {
        Rung::Reference => Err("the reference is what the others are compared with".to_owned()),
        rung => Ok(rung),
    }
}

/// Returns the options with the number of rounds, if it was given.
pub fn timed<R>(options: Options<R>, rounds: Option<u32>) -> Options<R> {
    Options { rounds: rounds.unwrap_or(options.rounds), ..options }
}

impl Rungs {
    /// Measures a ladder with the rungs and rounds that were given, and shows its report.
    ///
    /// # Errors
    /// Returns one line for the user: what is wrong, where, and what to do.
    pub fn show(
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

/// Runs a measurement of several minutes behind a progress bar.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn behind_a_bar<T>(run: impl FnOnce(Progress<'_>) -> Result<T, CostError>) -> Result<T, Failure> {
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
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn on_gpu<T>(
    context: &Context,
    run: impl FnOnce(&Gpu, Progress<'_>) -> Result<T, CostError>,
) -> Result<T, Failure> {
    let gpu = context.gpu()?;
    behind_a_bar(|progress| run(gpu, progress))
}

/// Maximum size of a record or a page in bytes; the largest record takes a hundredth of it.
const MOST_BYTES: u64 = 64 << 20;

fn read_text(path: &Path) -> Result<String, Failure> {
    text_file::read(path, MOST_BYTES).map_err(Failure)
}

/// Reads the report of a ladder.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn read(ladder: &str, path: &Path) -> Result<Report, Failure> {
    let text = read_text(path)?;
    Report::from_json(ladder, &text).map_err(|error| Failure(format!("{}: {error}", path.display())))
}

/// Makes the folder of a report and checks that a file can be written there.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn prepare(out: &Path, name: &str) -> Result<(), Failure> {
    let failed = |error: std::io::Error| Failure(format!("{}: cannot be made: {error}", out.display()));
    std::fs::create_dir_all(out).map_err(failed)?;
    Ok(lapidary_files::check_writable(&out.join(name))?)
}

/// Measures a ladder or reads its report, writes the report's files and pages, and prints it. Files
/// and pages are checked before anything is measured, and none is left partially written.
///
/// # Errors
/// Returns one line for the user: what is wrong, where, and what to do.
pub fn show(
    ladder: &Ladder,
    shown: &Shown,
    measure: impl FnOnce() -> Result<Report, Failure>,
) -> Result<Outcome, Failure> {
    let name = ladder.name;
    let failure = |path: &Path, error: &dyn std::fmt::Display| Failure(format!("{}: {error}", path.display()));
    if let Some(out) = &shown.out {
        prepare(out, &format!("{name}.txt"))?;
    }
    let mut pages = Vec::new();
    for path in &shown.fill {
        let page = read_text(path)?;
        page::check(&page).map_err(|error| failure(path, &error))?;
        lapidary_files::check_writable(path)?;
        pages.push((path, page));
    }
    let report = match &shown.from {
        Some(path) => read(name, path)?,
        None => measure()?,
    };
    for (path, page) in &mut pages {
        *page = page::fill(page, ladder, &report).map_err(|error| failure(path, &error))?;
    }
    let (text, json) = (ladder.text(&report), report.json()?);
    if let Some(out) = &shown.out {
        let plots = (ladder.plots)(&report).into_iter().filter(|plot| !plot.is_empty());
        let plots = plots.map(|plot| (plot.file.to_owned(), plot.svg()));
        let reports = [(format!("{name}.txt"), text.clone()), (format!("{name}.json"), format!("{json}\n"))];
        for (file, contents) in reports.into_iter().chain(plots) {
            lapidary_files::replace(&out.join(file), contents.as_bytes())?;
        }
    }
    for (path, page) in pages {
        lapidary_files::replace(path, page.as_bytes())?;
    }
    output::line(if shown.json { &json } else { text.trim_end() })?;
    Ok(Outcome::Passed)
}
