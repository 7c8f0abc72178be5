//! `cook check`.

mod text;

use super::{Context, Failure, Outcome, browser, number, output};
use lapidary_assay::formula::Formula;
use lapidary_assay::property::persistence::Regressions;
use lapidary_assay::property::{DEFAULT_CASES, Settings};
use lapidary_assay::slack::Reassociation;
use lapidary_browser::{Adapter, Browser};
use lapidary_cook::check::guard::{self, Stage};
use lapidary_cook::check::record::{self, Record};
use lapidary_cook::check::user_file::{Contents, UserFile};
use lapidary_cook::check::{self, CheckError, On, Row, Source};
use lapidary_cook::cookbook::release::Standing;
use lapidary_render::file;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Property tests of formulas: shader, mirror and oracle compared on random inputs, the worst failure shrunk.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  ./cook check refraction\n  ./cook check fresnel::dielectric --cases 1000000\n  ./cook check refraction --portable\n  ./cook check refraction --wgsl my_engine/refraction.wgsl"
)]
pub(super) struct Arguments {
    /// A module, or one function of it as MODULE::FUNCTION; all where left out.
    #[arg(value_name = "MODULE[::FUNCTION]")]
    filter: Option<String>,
    /// Test this file's functions instead of the cookbook's, to the cookbook's tolerance.
    #[arg(long, value_name = "FILE")]
    wgsl: Option<PathBuf>,
    /// Test on devices that err in every operation as far as WGSL lets them, to the portable bounds; no adapter is needed.
    #[arg(long, conflicts_with = "failures")]
    portable: bool,
    /// The same with sums of three and more terms, and products, in other orders, as WGSL lets a compiler take them.
    #[arg(long, requires = "portable")]
    reassociate: bool,
    /// Test in Chromium, which has another WGSL compiler and another driver, to the portable bounds; and say where its results have other bits than
    /// the adapter's. swiftshader, which it brings along, or own: the adapter that it takes by itself. Where no Chromium is on the PATH, functions are
    /// skipped, and counted; LAPIDARY_CHROMIUM=required makes that a fault.
    #[arg(long, value_name = "ADAPTER", num_args = 0..=1, require_equals = true, default_missing_value = "swiftshader", conflicts_with_all = ["portable", "failures"])]
    browser: Option<Adapter>,
    /// Random inputs a function; over 1,048,576, so many from each of several seeds, and no fewer than asked for.
    #[arg(long, default_value_t = DEFAULT_CASES, value_parser = number::whole(1..=1_u64 << 40))]
    cases: u64,
    /// Where the random inputs start; the same seed gives the same inputs.
    #[arg(long, default_value_t = Settings::default().seed, value_parser = number::whole(0..=u64::MAX))]
    seed: u64,
    /// Folder for failing inputs, a file a function; target/lapidary/failures where left out, none for --wgsl. The
    /// cookbook's own functions are tested with what is there first.
    #[arg(long, value_name = "DIR")]
    failures: Option<PathBuf>,
    /// Test the I-th of N parts of the work, to share it between machines or runs: of the functions, and where there are over 1,048,576 --cases of the seeds from which
    /// so many are drawn each.
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// A file for the results as they come. Where it is there from a run that was ended, this one goes on from it.
    #[arg(long, value_name = "FILE", conflicts_with = "wgsl")]
    record: Option<PathBuf>,
    /// Run nothing: show these records, such as those of all shards, as one; with --record, write that too.
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = ["filter", "wgsl", "portable", "browser", "cases", "seed", "shard", "failures"])]
    merge: Vec<PathBuf>,
    /// One JSON document on stdout, and nothing else.
    #[arg(long)]
    json: bool,
}

/// One part of several.
#[derive(Clone, Copy, Debug)]
struct Shard {
    /// From 1.
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
    /// Every N-th part, so that the slow ones of a module fall to several parts; all of them without a shard.
    fn share<T>(shard: Option<Self>, all: Vec<T>) -> Vec<T> {
        let Self { index, count } = shard.unwrap_or(Self { index: 1, count: 1 });
        all.into_iter().skip(index - 1).step_by(count).collect()
    }
}

/// What was checked, and what there is to say besides.
#[derive(Default)]
struct Checked {
    /// What was compared with what.
    about: String,
    rows: Vec<Row>,
    notes: Vec<String>,
    releases: Vec<Standing>,
}

pub(super) fn run(context: &Context, arguments: &Arguments) -> Result<Outcome, Failure> {
    if !arguments.merge.is_empty() {
        return merged(arguments);
    }
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
            let count = whole.len();
            let work = Shard::share(arguments.shard, whole);
            let on = on(context, arguments)?;
            let regressions = arguments.failures.as_ref().map_or_else(check::failures, Regressions::in_folder);
            let about = text::about(on);
            let mut record = match &arguments.record {
                Some(path) => {
                    file::check_writable(path)?;
                    Record::open(path, &about, settings.cases, count).map_err(Failure)?
                }
                None => Record::new(&about, settings.cases, count),
            };
            let bench = Bench { on, source: Source::Cookbook, regressions: Some(&regressions), stage: None };
            in_parts(&bench, work, &mut record, arguments.record.as_deref())?;
            Checked { about, rows: record.in_order().rows, ..Checked::default() }
        }
        Some(path) => {
            // What the command line alone can be wrong in goes before the file, and both before the device.
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

/// Says what was found.
fn said(checked: &Checked, json: bool) -> Result<Outcome, Failure> {
    if json {
        // stdout is the array alone.
        for line in text::notes(&checked.notes, &checked.releases) {
            eprintln!("cook: {line}");
        }
        output::line(&serde_json::to_string_pretty(&checked.rows)?.to_string())?;
    } else {
        output::bytes(text::report(checked, text::Style::of_stdout()).as_bytes())?;
    }
    Ok(if checked.rows.iter().all(Row::passed) { Outcome::Passed } else { Outcome::Failed })
}

/// The inputs in parts of [`record::PART`], from one seed after the other.
fn parts(arguments: &Arguments) -> Vec<Settings> {
    let Arguments { cases, seed, wgsl, .. } = arguments;
    // A user's file is a matter of seconds.
    if *cases <= record::PART || wgsl.is_some() {
        return vec![Settings { cases: *cases, seed: *seed }];
    }
    (0..cases.div_ceil(record::PART))
        .map(|part| Settings { cases: record::PART, seed: seed.wrapping_add(part) })
        .collect()
}

/// Where and from what functions are tested.
struct Bench<'a> {
    on: On<'a>,
    source: Source<'a>,
    regressions: Option<&'a Regressions>,
    /// What a user's file is at, for who waits for it.
    stage: Option<&'a Stage>,
}

impl Bench<'_> {
    /// Compiles all, so that a wrong signature is said before minutes of testing.
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

    /// Tests one after the other; `keep` takes each row. `before` of them all were done in another run.
    fn run<E: From<CheckError>>(
        &self,
        work: &[(&Formula, Settings)],
        before: usize,
        mut keep: impl FnMut(Row) -> Result<(), E>,
    ) -> Result<(), E> {
        let bar = super::progress::bar((before + work.len()) as u64, "checking");
        bar.set_position(before as u64);
        for (formula, settings) in work {
            if let Some(stage) = self.stage {
                stage.running(&format!("running `{}`", formula.function));
            }
            bar.set_message(format!("{} seed {}", formula.function, settings.seed));
            keep(check::run_keeping(self.on, formula, self.source, *settings, self.regressions)?)?;
            bar.inc(1);
        }
        bar.finish_and_clear();
        Ok(())
    }
}

/// Tests part by part, and writes after each what is done.
fn in_parts(
    bench: &Bench<'_>,
    work: Vec<(&'static Formula, Settings)>,
    record: &mut Record,
    path: Option<&Path>,
) -> Result<(), Failure> {
    let all = work.len();
    let left: Vec<_> = work.into_iter().filter(|(formula, part)| !record.holds(formula.function, part.seed)).collect();
    bench.prepare(left.iter().map(|(formula, _)| *formula))?;
    let write = |record: &Record| path.map_or(Ok(()), |path| file::replace(path, record.text().as_bytes()));
    // A shard without work has a record, too.
    write(record)?;
    bench.run(&left, all - left.len(), |row| {
        record.add(row);
        Ok::<_, Failure>(write(record)?)
    })
}

/// Several records as one.
fn merged(arguments: &Arguments) -> Result<Outcome, Failure> {
    let read = |path: &PathBuf| Record::read(path).map(|record| (path.display().to_string(), record));
    let records = arguments.merge.iter().map(read).collect::<Result<_, _>>().map_err(Failure)?;
    let record = Record::merge(records).map_err(Failure)?;
    if let Some(path) = &arguments.record {
        file::replace(path, record.text().as_bytes())?;
    }
    let (done, parts) = (record.done(), record.parts);
    let outcome = said(&Checked { about: record.about, rows: record.rows, ..Checked::default() }, arguments.json)?;
    if done < parts {
        return Err(Failure(format!(
            "{done} of {parts} parts are done; merge the other shards' records too, or go on with them"
        )));
    }
    Ok(outcome)
}

/// Without a browser nothing is checked in one: said and counted, and a fault where one is required.
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
    eprintln!("cook: {count} functions skipped: {}", browser::MISSING);
    Ok(Outcome::Passed)
}

/// What the check runs on.
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
    let Contents { formulas, notes, releases } = file.contents(filter)?;
    let formulas = Shard::share(shard, formulas);
    let source = Source::Copy(&file.path, &file.text);
    let bench = Bench { on, source, regressions, stage: Some(stage) };
    bench.prepare(formulas.iter().copied())?;
    let work: Vec<_> = formulas.into_iter().map(|formula| (formula, settings)).collect();
    let mut rows = Vec::new();
    bench.run(&work, 0, |row| {
        rows.push(row);
        Ok::<_, CheckError>(())
    })?;
    for row in &mut rows {
        for standing in releases.iter().filter(|standing| standing.module == row.module) {
            if let Some(origin) = standing.origins.iter().find(|origin| origin.function == row.function) {
                row.release.clone_from(&origin.release);
                row.changed_since.clone_from(&origin.changes);
            }
        }
    }
    Ok(Checked { about: String::new(), rows, notes, releases })
}
