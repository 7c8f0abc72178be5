//! `cook check`: the property tests of a formula, run on the cookbook's WGSL or on the user's own
//! copy.

pub mod bounds;
pub mod difference;
pub mod differing;
pub mod guard;
pub mod in_browser;
pub mod seeds;
pub mod user_file;

use crate::formulas;
use difference::Difference;
use in_browser::InBrowser;
use lapidary_assay::dispatch::signature::Signature;
use lapidary_assay::dispatch::{self, DispatchError, Kernel, KernelText};
use lapidary_assay::examination::{self, Examination, examine};
use lapidary_assay::failure::Failure;
use lapidary_assay::formula::{Formula, Words};
use lapidary_assay::property::Settings;
use lapidary_assay::property::histogram::Histogram;
use lapidary_assay::property::persistence::{PersistenceError, Regressions};
use lapidary_assay::runner::Runner;
use lapidary_assay::shape::Scalar;
use lapidary_assay::slack::allowance::Field;
use lapidary_assay::slack::{self, Reassociation};
use lapidary_assay::tolerance::Tolerance;
use lapidary_browser::{Adapter, Browser};
use lapidary_cookbook as cookbook;
use lapidary_cookbook::header::FunctionDoc;
use lapidary_cookbook::repository;
use lapidary_gpu::Gpu;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Why a check could not run; a check that ran and failed is a report instead.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// There is no such module or function.
    #[error("{0}")]
    Unknown(String),
    /// A user's file cannot be read, or nothing in it can be checked.
    #[error("{0}")]
    File(String),
    /// The source was rejected or the device failed.
    #[error("{}", at_line(path, error))]
    Dispatch {
        /// Path of the source.
        path: String,
        /// The underlying error.
        error: DispatchError,
    },
    /// The stored failing inputs could not be read or written.
    #[error(transparent)]
    Persistence(#[from] PersistenceError),
}

/// Returns the folder in which the cookbook's own failing inputs are stored and from which they are
/// replayed: inside the build folder, which is `CARGO_TARGET_DIR` or else the cookbook's `target`; without
/// the cookbook, inside the system's folder for temporary files.
pub fn failures() -> Regressions {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    let target = target.or_else(|| Some(repository::root()?.join("target"))).unwrap_or_else(std::env::temp_dir);
    Regressions::in_folder(target.join("lapidary/failures"))
}

/// Formats file and line (if known) the way compilers do.
fn at_line(path: &str, error: &DispatchError) -> String {
    match error {
        DispatchError::Fault { line: Some(line), message } => format!("{path}:{line}: {message}"),
        error => format!("{path}: {error}"),
    }
}

/// A row of `cook check`'s table.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Row {
    /// Whether the formula passed.
    pub passed: bool,
    /// Name of the module.
    pub module: String,
    /// Name of the WGSL function.
    pub function: String,
    /// Number of inputs tested.
    pub cases: u64,
    /// Number of inputs that failed.
    pub failed: u64,
    /// Number of results with a NaN or an infinity.
    pub nonfinite: u64,
    /// Number of inputs for which a loop exceeded the kernel's iteration limit, so that the result
    /// is meaningless; they count as failed.
    pub stopped: u64,
    /// Largest forward error against the oracle, in ulp of the exact value's largest component.
    pub max_ulp: f64,
    /// 99th percentile of the forward error, in the same unit.
    pub p99_ulp: f64,
    /// Median of the forward error, in the same unit.
    pub median_ulp: f64,
    /// Largest ratio of the error to the allowed error.
    pub worst_ratio: f64,
    /// The input with that ratio.
    pub worst_input: String,
    /// The simplest failing input that was found; `None` (null in JSON) if nothing failed.
    pub shrunk_input: Option<String>,
    /// The condition that the worst input violated; `None` (null) if nothing failed.
    pub reason: Option<String>,
    /// Result for the simplest failing input; `None` (null) if nothing failed.
    pub failure: Option<Failure>,
    /// Number of hard cases tested.
    pub hard_cases: usize,
    /// Number of hard cases that hold.
    pub held_hard_cases: usize,
    /// Names of the hard cases that do not hold, with the distance from the limit.
    pub broken_hard_cases: Vec<String>,
    /// Promises of the `Outside:` line that do not hold, each with an input that breaks it.
    pub broken_promises: Vec<String>,
    /// Branches next to which a result is wrong, one float to either side, each with the input.
    pub broken_branches: Vec<String>,
    /// An input that passes by chance, but not on the worst device that WGSL allows; `None` (null)
    /// if there is none or if no such device was requested.
    pub worst_choices: Option<String>,
    /// Assumptions made where WGSL states no accuracy; empty on an adapter.
    pub assumptions: Vec<String>,
    /// Why inputs next to branches were not tested, namely what the interpreter cannot run; `None`
    /// (null) if they were tested.
    pub branches_untested: Option<String>,
    /// Largest ratio of an input's first-order allowance to the stated bound: above 1 the bound is
    /// too low, far below 1 it is too high. `None` (null) if no allowance was requested.
    pub allowance: Option<f64>,
    /// The input with that ratio; `None` (null) if no allowance was requested.
    pub allowance_input: Option<String>,
    /// The same ratio for each floating-point field of the result.
    pub allowances: Vec<Field>,
    /// Differences in bits between the browser's results and the adapter's; `None` (null) without a
    /// browser.
    pub difference: Option<Difference>,
    /// The input with the largest distance between the two; `None` (null) if there is none.
    pub difference_input: Option<String>,
    /// Edges of the domain that no input reached.
    pub missed_edges: Vec<String>,
    /// The file in which the simplest failing input was stored; `None` (null) if there is none.
    pub kept_in: Option<String>,
    /// Wall-clock time in seconds.
    pub seconds: f64,
    /// The command that repeats this check.
    pub reproduce: String,
    /// The seeds of the inputs; each seed gives the same number of inputs.
    pub seeds: Vec<u64>,
    /// The distribution from which the quantiles are computed.
    #[serde(skip)]
    pub ulps: Histogram,
}

impl Row {
    /// Whether the formula passed. Missed edges count only from the default number of cases on,
    /// because a shorter run may well miss some.
    pub fn passed(&self) -> bool {
        self.passed
    }

    /// Whether no error was found, regardless of which edges the inputs reached.
    pub fn is_right(&self) -> bool {
        let broken = [&self.broken_hard_cases, &self.broken_promises, &self.broken_branches];
        self.failed == 0 && self.worst_choices.is_none() && broken.into_iter().all(Vec::is_empty)
    }
}

/// What a check runs on.
#[derive(Clone, Copy, Debug)]
pub enum On<'gpu> {
    /// An adapter.
    Adapter(&'gpu Gpu),
    /// Devices that err as far as WGSL allows: the interpreter, without an adapter.
    Slack(Reassociation),
    /// A browser's WebGPU, and the adapter that its results are compared with.
    Browser(&'gpu Browser, &'gpu Gpu),
}

impl<'gpu> From<&'gpu Gpu> for On<'gpu> {
    fn from(gpu: &'gpu Gpu) -> Self {
        On::Adapter(gpu)
    }
}

/// The source that is checked.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a> {
    /// The cookbook's own source.
    Cookbook,
    /// The user's copy: path for messages, and text. The tolerance is still the cookbook's.
    Copy(&'a str, &'a str),
}

/// Returns the function's documentation in the cookbook.
///
/// # Panics
/// If a formula is declared for a function that the cookbook does not have, which a test rules out.
pub fn documentation(formula: &Formula) -> &'static FunctionDoc {
    cookbook::module(formula.module)
        .and_then(|module| module.function(formula.function))
        .unwrap_or_else(|| panic!("wgsl/{}.wgsl has no function `{}`", formula.module, formula.function))
}

/// Returns the formulas that `filter` selects: all (`None`), those of a module, or one function's
/// (`refraction::refract` or `refraction::refraction_refract`). Naive forms are only included by
/// name.
pub fn select(filter: Option<&str>) -> Result<Vec<&'static Formula>, CheckError> {
    let promised = |formula: &&Formula| formula.benign.is_none();
    let Some(filter) = filter else { return Ok(formulas::all().iter().filter(promised).collect()) };
    let (module, function) =
        filter.split_once("::").map_or((filter, None), |(module, function)| (module, Some(function)));
    let Some(module) = cookbook::module(module) else {
        let names: Vec<&str> = cookbook::modules().iter().map(|module| module.name).collect();
        return Err(CheckError::Unknown(format!(
            "no module `{module}`{}",
            lapidary_files::nearest::suggest(module, &names)
        )));
    };
    let Some(function) = function else {
        return Ok(formulas::all().iter().filter(|f| f.module == module.name).filter(promised).collect());
    };
    let found = module.function(function).and_then(|found| formulas::of_function(&found.name));
    found.map(|formula| vec![formula]).ok_or_else(|| {
        let names: Vec<&str> = module.functions.iter().map(|function| function.name.as_str()).collect();
        let hint = lapidary_files::nearest::suggest_function(module.name, function, &names);
        CheckError::Unknown(format!("module `{}` has no function `{function}`{hint}", module.name))
    })
}

/// Returns the tolerance of a formula on a device: from its `Accuracy:` line, or from its benign
/// domain for a naive form.
///
/// # Panics
/// If a naive form has no benign domain, which a test rules out.
pub fn tolerance<'gpu>(on: impl Into<On<'gpu>>, formula: &Formula) -> Tolerance {
    let lavapipe = matches!(on.into(), On::Adapter(gpu) if gpu.is_lavapipe());
    let promised = examination::tolerance(formula, &documentation(formula).accuracy, lavapipe);
    promised.unwrap_or_else(|fault| panic!("{fault}"))
}

/// Checks that the source is valid and that the signature matches the mirror's. On an adapter,
/// including one that is compared with a browser, the function is also compiled.
///
/// # Errors
/// Returns an error if one of these fails.
pub fn prepare(on: On<'_>, formula: &Formula, source: Source<'_>) -> Result<(), CheckError> {
    match on {
        On::Adapter(gpu) | On::Browser(_, gpu) => kernel(gpu, formula, source).map(|_| ()),
        On::Slack(_) => {
            let (path, text) = located(formula, source);
            let in_path = |error| CheckError::Dispatch { path: path.clone(), error };
            if let Source::Copy(..) = source {
                dispatch::examine(text, &path, formula.function).map_err(in_path)?;
            }
            let signature = Signature::of_source(text, &path, formula.function).map_err(in_path)?;
            signature.expect(&formula.arguments, &formula.result).map_err(|error| in_path(error.into()))
        }
    }
}

/// Parses the source, compares the signature with the mirror's, and compiles the kernel.
pub fn kernel<'gpu>(gpu: &'gpu Gpu, formula: &Formula, source: Source<'_>) -> Result<Kernel<'gpu>, CheckError> {
    let (path, text) = located(formula, source);
    let in_path = |error| CheckError::Dispatch { path: path.clone(), error };
    if let Source::Copy(..) = source {
        dispatch::examine(text, &path, formula.function).map_err(in_path)?;
    }
    let kernel = Kernel::of_function(gpu, text, &path, formula.function).map_err(in_path)?;
    kernel.signature().expect(&formula.arguments, &formula.result).map_err(|error| in_path(error.into()))?;
    Ok(kernel.portable(!gpu.is_lavapipe()))
}

/// Runs the property tests of one formula. Failing inputs of the cookbook's own source are stored
/// in the target folder and tested first in later runs; those of a user's copy are not stored.
///
/// # Errors
/// Returns an error if the check cannot run.
pub fn run<'gpu>(
    on: impl Into<On<'gpu>>,
    formula: &Formula,
    source: Source<'_>,
    settings: Settings,
) -> Result<Row, CheckError> {
    match source {
        Source::Cookbook => run_keeping(on, formula, source, settings, Some(&failures())),
        Source::Copy(..) => run_keeping(on, formula, source, settings, None),
    }
}

/// Runs the same tests as [`run`] with a different store for failing inputs, or none.
///
/// Stored inputs are tested first for the cookbook's own source, and never for a user's copy. The
/// inputs of the hard cases always come first. For devices that err as far as WGSL allows nothing
/// is stored: a failing input fails again.
///
/// # Errors
/// Returns an error if the check cannot run.
pub fn run_keeping<'gpu>(
    on: impl Into<On<'gpu>>,
    formula: &Formula,
    source: Source<'_>,
    settings: Settings,
    regressions: Option<&Regressions>,
) -> Result<Row, CheckError> {
    let on = on.into();
    let tolerance = tolerance(on, formula);
    let (path, text) = located(formula, source);
    let (row, found) = match on {
        On::Adapter(gpu) => {
            let mut kernel = kernel(gpu, formula, source)?;
            let replayed = match (source, regressions) {
                (Source::Cookbook, Some(regressions)) => regressions.load(formula.function, kernel.argument_words())?,
                _ => Vec::new(),
            };
            let found = examine(formula, text, &mut kernel, &tolerance, settings, &replayed)
                .map_err(|error| CheckError::Dispatch { path: formula.function.to_owned(), error })?;
            let kept_in = match (regressions, &found.report.shrunk) {
                (Some(regressions), Some(shrunk)) => {
                    let reason = found.report.reason.as_deref().unwrap_or_default();
                    Some(regressions.store(formula.function, shrunk, reason)?.display().to_string())
                }
                _ => None,
            };
            (Row { kept_in, ..Row::default() }, found)
        }
        On::Slack(reassociation) => {
            prepare(on, formula, source)?;
            let found = slack::examine(formula, (text, &path), &tolerance, settings, reassociation, &[])
                .map_err(|error| CheckError::Dispatch { path, error })?;
            let assumptions = found.assumptions.iter().map(ToString::to_string).collect();
            let allowance = found.allowance.as_ref().map(|allowance| allowance.largest);
            let allowance_input = found.allowance.as_ref().map(|allowance| spell(formula, &allowance.at));
            let allowances = found.allowance.map_or_else(Vec::new, |allowance| allowance.fields);
            (Row { assumptions, allowance, allowance_input, allowances, ..Row::default() }, found.examination)
        }
        On::Browser(browser, gpu) => {
            let mut beside = kernel(gpu, formula, source)?;
            let in_path = |error| CheckError::Dispatch { path: path.clone(), error };
            let kernel = KernelText::of_function(text, &path, formula.function).map_err(in_path)?;
            let mut runner = InBrowser::new(browser, kernel);
            let found = examine(formula, text, &mut runner, &tolerance, settings, &[]).map_err(in_path)?;
            let difference = difference::between(&mut runner, &mut beside, formula, settings).map_err(in_path)?;
            let input = (difference.differing > 0).then(|| spell(formula, &difference.worst));
            (Row { difference: Some(difference), difference_input: input, ..Row::default() }, found)
        }
    };
    Ok(filled(row, formula, found, (settings.seed, reproduce(on, formula, source, settings))))
}

/// Returns a source's path, for messages, and its text.
fn located<'a>(formula: &Formula, source: Source<'a>) -> (String, &'a str) {
    match source {
        Source::Cookbook => {
            let text = cookbook::module(formula.module).map_or("", |module| module.whole);
            (format!("wgsl/{}.wgsl", formula.module), text)
        }
        Source::Copy(path, text) => (path.to_owned(), text),
    }
}

/// Returns the command that runs the same inputs again.
fn reproduce(on: On<'_>, formula: &Formula, source: Source<'_>, settings: Settings) -> String {
    let portable = match on {
        On::Adapter(_) => "",
        On::Browser(browser, _) if browser.choice() == Adapter::Own => " --browser=own",
        On::Browser(..) => " --browser",
        On::Slack(Reassociation::Written) => " --portable",
        On::Slack(Reassociation::Reordered) => " --portable --reassociate",
    };
    let copy = match source {
        Source::Cookbook => String::new(),
        Source::Copy(path, _) => format!(" --wgsl {path}"),
    };
    let Settings { cases, seed } = settings;
    format!("./cook check {}::{}{copy}{portable} --seed {seed} --cases {cases}", formula.module, formula.function)
}

fn filled(row: Row, formula: &Formula, found: Examination, (seed, reproduce): (u64, String)) -> Row {
    let passed = found.holds();
    let hard_cases = formula.hard_cases.len();
    let Examination { report, failure, broken_hard_cases, broken_promises, broken_branches, worst_choices, .. } = found;
    Row {
        passed,
        module: formula.module.to_owned(),
        function: formula.function.to_owned(),
        cases: report.cases,
        failed: report.failed,
        nonfinite: report.nonfinite,
        stopped: report.stopped,
        // JSON has no infinity.
        max_ulp: report.max_ulp.min(f64::MAX),
        p99_ulp: report.ulps.quantile(0.99).min(f64::MAX),
        median_ulp: report.ulps.quantile(0.5).min(f64::MAX),
        worst_ratio: report.worst_ratio.min(f64::MAX),
        worst_input: spell(formula, &report.worst),
        shrunk_input: report.shrunk.as_ref().map(|words| spell(formula, words)),
        missed_edges: report.missed_edges().map(str::to_owned).collect(),
        reason: report.reason,
        failure,
        hard_cases,
        held_hard_cases: hard_cases - broken_hard_cases.len(),
        broken_hard_cases,
        broken_promises,
        broken_branches,
        worst_choices,
        branches_untested: found.branches_untested,
        seconds: report.seconds,
        reproduce,
        seeds: vec![seed],
        ulps: report.ulps,
        ..row
    }
}

/// Formats the input for people: the shortest decimals that identify each f32 exactly, with vectors
/// in parentheses.
pub fn spell(formula: &Formula, words: &Words) -> String {
    let mut offset = 0;
    let mut arguments = Vec::new();
    for shape in &formula.arguments {
        let mut leaves = Vec::new();
        for leaf in shape.leaves() {
            let numbers: Vec<String> = words
                .iter()
                .skip(offset + leaf.start)
                .take(leaf.length)
                .map(|word| match leaf.scalar {
                    Scalar::F32 => format!("{:?}", f32::from_bits(*word)),
                    Scalar::I32 => word.cast_signed().to_string(),
                    Scalar::U32 => word.to_string(),
                    Scalar::Bool => (*word != 0).to_string(),
                })
                .collect();
            leaves.push(if numbers.len() == 1 { numbers.concat() } else { format!("({})", numbers.join(", ")) });
        }
        offset += shape.words();
        arguments.push(if leaves.len() == 1 { leaves.concat() } else { format!("{{{}}}", leaves.join(", ")) });
    }
    arguments.join(", ")
}
