//! `cook check`.

mod text;

use super::{Context, Failure, Outcome, browser, number, output};
use lapidary_assay::formula::Formula;
use lapidary_assay::property::persistence::Regressions;
use lapidary_assay::property::{DEFAULT_CASES, Settings};
use lapidary_assay::slack::Reassociation;
use lapidary_browser::{Adapter, Browser};
use lapidary_cook::check::guard::{self, Stage};
use lapidary_cook::check::seeds;
use lapidary_cook::check::user_file::{Contents, UserFile};
use lapidary_cook::check::{self, CheckError, On, Row, Source};
use text::Checked;

use std::collections::BTreeSet;
use std::path::PathBuf;

/// Property tests of formulas: compares shader, mirror and oracle on random inputs, and shrinks the
/// worst failure.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook check refraction\n  ./cook check fresnel::dielectric --cases 1000000\n  ./cook check refraction --portable\n  ./cook check refraction --wgsl my_engine/refraction.wgsl"
)]
pub(super) struct Arguments {
    /// A module, or one of its functions as MODULE::FUNCTION; all modules by default.
    #[arg(value_name = "MODULE[::FUNCTION]")]
    filter: Option<String>,
    /// Test this file's functions instead of the cookbook's, to the cookbook's tolerance.
    #[arg(long, value_name = "FILE")]
    wgsl: Option<PathBuf>,
    /// Test on simulated devices whose every operation errs as far as WGSL allows, to the portable
    /// bounds. No adapter is needed.
    #[arg(long, conflicts_with = "failures")]
    portable: bool,
    /// The same, with products and with sums of three or more terms evaluated in other orders, as
    /// WGSL allows a compiler to do.
    #[arg(long, requires = "portable")]
    reassociate: bool,
    /// Test in Chromium, which has another WGSL compiler and another driver, to the portable
    /// bounds, and report results whose bits differ from the adapter's. swiftshader is included in
    /// Chromium; own is the adapter that it chooses by itself. If no Chromium is on the PATH,
    /// functions are skipped and counted; LAPIDARY_CHROMIUM=required makes that an error.
    #[arg(long, value_name = "ADAPTER", num_args = 0..=1, require_equals = true, default_missing_value = "swiftshader", conflicts_with_all = ["portable", "failures"])]
    browser: Option<Adapter>,
    /// Random inputs per function. Above 1,048,576, that many are drawn from each of several seeds,
    /// and no fewer in total than requested.
    #[arg(long, default_value_t = DEFAULT_CASES, value_parser = number::whole(1..=1_u64 << 40))]
    cases: u64,
    /// First seed of the random inputs; the same seed gives the same inputs.
    #[arg(long, default_value_t = Settings::default().seed, value_parser = number::whole(0..=u64::MAX))]
    seed: u64,
    /// Folder for failing inputs, one file per function; target/lapidary/failures by default, none
    /// for --wgsl. The cookbook's own functions are first tested with the inputs already there.
    #[arg(long, value_name = "DIR")]
    failures: Option<PathBuf>,
    /// Test the I-th of N parts of the work, to divide it between machines or runs. The work is
    /// divided by function and, above 1,048,576 --cases, also by seed, with that many cases for
    /// each seed.
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Print one JSON document on stdout, and nothing else.
    #[arg(long)]
    json: bool,
}

/// One part of several.
#[derive(Clone, Copy, Debug)]
struct Shard {
    /// Number of the part, from 1.
    index: usize,
    count: usize,
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        match numbers {
            Some((index, count)) if (1..=count).contains(&index) => Ok(Self { index, count }),
            _ => Err("expected I/N with I from 1 to N, such as 1/4".to_owned()),
        }
    }
}

impl Shard {
    /// Takes every N-th item, so that the slow ones of a module are spread over several parts; all
    /// items without a shard.
    fn share<T>(shard: Option<Self>, all: Vec<T>) -> Vec<T> {
        let Self { index, count } = shard.unwrap_or(Self { index: 1, count: 1 });
        all.into_iter().skip(index - 1).step_by(count).collect()
    }
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    if arguments.browser.is_some() && Browser::find().is_none() {
        return skipped(arguments);
    }
    let parts = parts(arguments);
    let settings = parts[0];
    let checked = match &arguments.wgsl {
        None => {
            let formulas = check::select(arguments.filter.as_deref())?;
            let work = parts.iter().flat_map(|part| formulas.iter().map(|formula| (*formula, *part)));
            let whole: Vec<(&Formula, Settings)> = work.collect();
            let work = Shard::share(arguments.shard, whole);
            let on = on(context, arguments)?;
            let regressions = arguments.failures.as_ref().map_or_else(check::failures, Regressions::in_folder);
            let bench = Bench { on, source: Source::Cookbook, regressions: Some(&regressions), stage: None };
            bench.prepare(work.iter().map(|(formula, _)| *formula))?;
            let mut rows: Vec<Row> = Vec::new();
            bench.run(&work, |row| {
                match rows.iter_mut().find(|earlier| earlier.function == row.function) {
                    Some(earlier) => *earlier = std::mem::take(earlier).join(row),
                    None => rows.push(row),
                }
                Ok::<_, Failure>(())
            })?;
            Checked { about: text::about(on), rows, ..Checked::default() }
        }
        Some(path) => {
            // Errors in the command line alone are reported before the file is read, and both
            // before the device is opened.
            check::select(arguments.filter.as_deref())?;
            let file = UserFile::read(path)?;
            let on = on(context, arguments)?;
            let filter = arguments.filter.clone();
            let about = text::about(on);
            let shard = arguments.shard;
            let regressions = arguments.failures.as_ref().map(Regressions::in_folder);
            let work = move |stage: &Stage| {
                let checked = of_file(on, &file, (filter.as_deref(), shard), settings, regressions.as_ref(), stage)?;
                Ok::<_, CheckError>(Checked { about, ..checked })
            };
            guard::watched(work).map_err(|error| Failure(format!("{}: {error}", path.display())))??
        }
    };
    said(&checked, arguments.json)
}

/// Prints the results.
fn said(checked: &Checked, json: bool) -> Result<Outcome, Failure> {
    if json {
        // stdout holds only the array.
        for line in text::notes(&checked.notes) {
            output::remark(&line);
        }
        output::line(&serde_json::to_string_pretty(&checked.rows)?.to_string())?;
    } else {
        output::bytes(text::report(checked, text::Style::of_stdout()).as_bytes())?;
    }
    Ok(if checked.rows.iter().all(Row::passed) { Outcome::Passed } else { Outcome::Failed })
}

/// Splits the inputs into parts of [`seeds::PART`], with consecutive seeds.
fn parts(arguments: &Arguments) -> Vec<Settings> {
    let Arguments { cases, seed, wgsl, .. } = arguments;
    // A user's file takes only seconds.
    if *cases <= seeds::PART || wgsl.is_some() {
        return vec![Settings { cases: *cases, seed: *seed }];
    }
    (0..cases.div_ceil(seeds::PART))
        .map(|part| Settings { cases: seeds::PART, seed: seed.wrapping_add(part) })
        .collect()
}

/// Device and source of the functions under test.
struct Bench<'a> {
    on: On<'a>,
    source: Source<'a>,
    regressions: Option<&'a Regressions>,
    /// Progress on a user's file, for the watchdog; `None` for the cookbook's own functions.
    stage: Option<&'a Stage>,
}

impl Bench<'_> {
    /// Compiles all functions, so that a wrong signature is reported before minutes of testing.
    fn prepare<'f>(&self, formulas: impl Iterator<Item = &'f Formula>) -> Result<(), CheckError> {
        let mut prepared = BTreeSet::new();
        for formula in formulas.filter(|formula| prepared.insert(formula.function)) {
            if let Some(stage) = self.stage {
                stage.compiling(&format!("compiling `{}`", formula.function));
            }
            check::prepare(self.on, formula, self.source)?;
        }
        Ok(())
    }

    /// Runs the tests in order and passes each row to `keep`.
    fn run<E: From<CheckError>>(
        &self,
        work: &[(&Formula, Settings)],
        mut keep: impl FnMut(Row) -> Result<(), E>,
    ) -> Result<(), E> {
        let bar = super::progress::bar(work.len() as u64, "checking");
        for (formula, settings) in work {
            if let Some(stage) = self.stage {
                stage.running(&format!("running `{}`", formula.function), settings.cases);
            }
            bar.set_message(format!("{} seed {}", formula.function, settings.seed));
            keep(check::run_keeping(self.on, formula, self.source, *settings, self.regressions)?)?;
            bar.inc(1);
        }
        bar.finish_and_clear();
        Ok(())
    }
}

/// Without a browser nothing can be checked in one: reports the number of functions skipped, or
/// returns an error if a browser is required.
fn skipped(arguments: &Arguments) -> Result<Outcome, Failure> {
    browser::may_be_missing()?;
    let count = match &arguments.wgsl {
        None => Shard::share(arguments.shard, check::select(arguments.filter.as_deref())?).len(),
        Some(path) => {
            let contents = UserFile::read(path)?;
            Shard::share(arguments.shard, contents.contents(arguments.filter.as_deref())?.formulas).len()
        }
    };
    if arguments.json {
        output::line("[]")?;
    }
    output::remark(&format!("{count} functions skipped: {}", browser::MISSING));
    Ok(Outcome::Passed)
}

/// Device that the check runs on.
fn on(context: &Context, arguments: &Arguments) -> Result<On<'static>, Failure> {
    Ok(match arguments {
        Arguments { reassociate: true, .. } => On::Slack(Reassociation::Reordered),
        Arguments { portable: true, .. } => On::Slack(Reassociation::Written),
        Arguments { browser: Some(adapter), .. } => On::Browser(browser::started(*adapter)?, context.gpu()?),
        _ => On::Adapter(context.gpu()?),
    })
}

/// Checks a user's file.
fn of_file(
    on: On<'_>,
    file: &UserFile,
    (filter, shard): (Option<&str>, Option<Shard>),
    settings: Settings,
    regressions: Option<&Regressions>,
    stage: &Stage,
) -> Result<Checked, CheckError> {
    let Contents { formulas, notes } = file.contents(filter)?;
    let formulas = Shard::share(shard, formulas);
    let source = Source::Copy(&file.path, &file.text);
    let bench = Bench { on, source, regressions, stage: Some(stage) };
    bench.prepare(formulas.iter().copied())?;
    let work: Vec<_> = formulas.into_iter().map(|formula| (formula, settings)).collect();
    let mut rows = Vec::new();
    bench.run(&work, |row| {
        rows.push(row);
        Ok::<_, CheckError>(())
    })?;
    Ok(Checked { about: String::new(), rows, notes })
}
