//! `cook check`: the property tests of a formula, on the cookbook's WGSL or on the user's own copy of it.

pub mod bounds;
pub mod difference;
pub mod guard;
pub mod in_browser;
pub mod record;
pub mod user_file;

use crate::cookbook::header::FunctionDoc;
use crate::{cookbook, formulas};
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
use lapidary_gpu::Gpu;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Why a check could not run; a check that ran and failed is a report.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// No such module or function.
    #[error("{0}")]
    Unknown(String),
    /// A user's file is not to be read, or nothing of it can be checked.
    #[error("{0}")]
    File(String),
    /// The source or the device refused.
    #[error("{}", at_line(path, error))]
    Dispatch {
        /// Whose source.
        path: String,
        /// What is the matter.
        error: DispatchError,
    },
    /// The kept inputs could not be read or written.
    #[error(transparent)]
    Persistence(#[from] PersistenceError),
}

/// Where the cookbook's own failing inputs are kept and replayed from: in the folder of what is built, `CARGO_TARGET_DIR`, else the cookbook's `target`.
pub fn failures() -> Regressions {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    let target = target.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target"));
    Regressions::in_folder(target.join("lapidary/failures"))
}

/// File and line, as compilers write them, where there is a line.
fn at_line(path: &str, error: &DispatchError) -> String {
    match error {
        DispatchError::Fault { line: Some(line), message } => format!("{path}:{line}: {message}"),
        error => format!("{path}: {error}"),
    }
}

/// A row of `cook check`'s table.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Row {
    /// Whether the formula holds.
    pub passed: bool,
    /// The module.
    pub module: String,
    /// The WGSL function.
    pub function: String,
    /// Inputs tested.
    pub cases: u64,
    /// Inputs that failed.
    pub failed: u64,
    /// Results with a NaN or an infinity.
    pub nonfinite: u64,
    /// Inputs at which a loop took more turns than the kernel follows, so that the result says nothing; they count as failed.
    pub stopped: u64,
    /// Forward error against the oracle in ulp of the exact value's largest component.
    pub max_ulp: f64,
    /// The same, at the 99th percentile.
    pub p99_ulp: f64,
    /// The same, the median.
    pub median_ulp: f64,
    /// Largest error over allowed error.
    pub worst_ratio: f64,
    /// The input of that error.
    pub worst_input: String,
    /// The simplest input found that fails as well; null where nothing failed.
    pub shrunk_input: Option<String>,
    /// What the worst input broke; null where nothing failed.
    pub reason: Option<String>,
    /// What the simplest failing input gives; null where nothing failed.
    pub failure: Option<Failure>,
    /// Hard cases tested.
    pub hard_cases: usize,
    /// Those that hold.
    pub held_hard_cases: usize,
    /// Hard cases that do not hold, by name, with the distance from the limit.
    pub broken_hard_cases: Vec<String>,
    /// Promises of the `Outside:` line that do not hold, with the input at which they do not.
    pub broken_promises: Vec<String>,
    /// Branches beside which a result is wrong, one float to either side, with the input at which it is.
    pub broken_branches: Vec<String>,
    /// An input that holds by chance, and not on the worst device that WGSL allows; null where there is none, or no such device was asked for.
    pub worst_choices: Option<String>,
    /// What was taken to hold where WGSL states no accuracy; empty on an adapter.
    pub assumptions: Vec<String>,
    /// Why inputs beside branches were not tested: what the interpreter cannot run; null where they were.
    pub branches_untested: Option<String>,
    /// The largest first-order allowance of an input over the bound stated: above 1 the bound is too low, far below 1 it is too high. Null where none was asked for.
    pub allowance: Option<f64>,
    /// That input.
    pub allowance_input: Option<String>,
    /// The same of each field of the result that is a float.
    pub allowances: Vec<Field>,
    /// Where the browser's results have other bits than the adapter's; null where no browser was asked.
    pub difference: Option<Difference>,
    /// The input of the largest distance between the two; null where there is none.
    pub difference_input: Option<String>,
    /// Edges of the domain that the run did not reach.
    pub missed_edges: Vec<String>,
    /// The newest release whose function the user's is; null where it is none's, or the cookbook's own was checked.
    pub release: Option<String>,
    /// What was changed in the function since that release.
    pub changed_since: Vec<String>,
    /// The file that the simplest failing input was written to; null where none was.
    pub kept_in: Option<String>,
    /// Wall-clock time.
    pub seconds: f64,
    /// The command that runs this again.
    pub reproduce: String,
    /// The seeds from which inputs were drawn, so many from each.
    pub seeds: Vec<u64>,
    /// The distribution behind the quantiles; a [`record::Record`] keeps it.
    #[serde(skip)]
    pub ulps: Histogram,
}

impl Row {
    /// Whether the formula holds. Edges count from the default number of cases on: a shorter run may well miss some.
    pub fn passed(&self) -> bool {
        self.passed
    }

    /// Whether nothing wrong was found, whatever edges the inputs reached.
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
    /// Devices that err as far as WGSL lets them: the interpreter, without an adapter.
    Slack(Reassociation),
    /// A browser's WebGPU, and the adapter that its results are laid beside.
    Browser(&'gpu Browser, &'gpu Gpu),
}

impl<'gpu> From<&'gpu Gpu> for On<'gpu> {
    fn from(gpu: &'gpu Gpu) -> Self {
        On::Adapter(gpu)
    }
}

/// The source that a check runs on.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a> {
    /// The cookbook's own.
    Cookbook,
    /// The user's copy: path for messages, and text. The tolerance stays the cookbook's.
    Copy(&'a str, &'a str),
}

/// The function's comment in the cookbook.
///
/// # Panics
/// Where a formula is declared for a function that the cookbook does not have, which a test forbids.
pub fn documentation(formula: &Formula) -> &'static FunctionDoc {
    cookbook::module(formula.module)
        .and_then(|module| module.function(formula.function))
        .unwrap_or_else(|| panic!("wgsl/{}.wgsl has no function `{}`", formula.module, formula.function))
}

/// The formulas that `filter` names: all, a module's, or one function's (`refraction::refract` or
/// `refraction::refraction_refract`). Naive forms are left out unless named.
pub fn select(filter: Option<&str>) -> Result<Vec<&'static Formula>, CheckError> {
    let promised = |formula: &&Formula| formula.benign.is_none();
    let Some(filter) = filter else { return Ok(formulas::all().iter().filter(promised).collect()) };
    let (module, function) =
        filter.split_once("::").map_or((filter, None), |(module, function)| (module, Some(function)));
    let Some(module) = cookbook::module(module) else {
        let names: Vec<&str> = cookbook::modules().iter().map(|module| module.name).collect();
        return Err(CheckError::Unknown(format!(
            "no module `{module}`{}",
            lapidary_scene::nearest::suggest(module, &names)
        )));
    };
    let Some(function) = function else {
        return Ok(formulas::all().iter().filter(|f| f.module == module.name).filter(promised).collect());
    };
    let found = module.function(function).and_then(|found| formulas::of_function(&found.name));
    found.map(|formula| vec![formula]).ok_or_else(|| {
        let names: Vec<&str> = module.functions.iter().map(|function| function.name.as_str()).collect();
        let hint = lapidary_scene::nearest::suggest_function(module.name, function, &names);
        CheckError::Unknown(format!("module `{}` has no function `{function}`{hint}", module.name))
    })
}

/// The tolerance of a formula there: that of its `Accuracy:` line, or of its benign domain for a naive form.
///
/// # Panics
/// Where a naive form has no benign domain, which a test forbids.
pub fn tolerance<'gpu>(on: impl Into<On<'gpu>>, formula: &Formula) -> Tolerance {
    let lavapipe = matches!(on.into(), On::Adapter(gpu) if gpu.is_lavapipe());
    let promised = examination::tolerance(formula, &documentation(formula).accuracy, lavapipe);
    promised.unwrap_or_else(|fault| panic!("{fault}"))
}

/// Whether a check can begin: the source is valid, and the signature the mirror's. On an adapter the function is compiled, beside a browser too.
///
/// # Errors
/// Where it cannot.
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

/// Reflects, checks the signature against the mirror's, and compiles.
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

/// Runs the property tests of one formula. Failing inputs of the cookbook's own are kept in the target folder, and go first
/// in later runs; those of a user's copy are not kept.
///
/// # Errors
/// Where the check cannot run.
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

/// The same with another place for failing inputs, or none. What is kept there goes first where the cookbook's own is
/// tested, never into the test of a user's copy. The inputs of the hard cases go first always. Of devices that err as far as they may nothing is kept:
/// a failing input fails again.
///
/// # Errors
/// Where the check cannot run.
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

/// A source's path, for messages, and its text.
fn located<'a>(formula: &Formula, source: Source<'a>) -> (String, &'a str) {
    match source {
        Source::Cookbook => {
            let text = cookbook::module(formula.module).map_or("", |module| module.whole);
            (format!("wgsl/{}.wgsl", formula.module), text)
        }
        Source::Copy(path, text) => (path.to_owned(), text),
    }
}

/// The command that runs the same inputs again.
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

/// The input as a person reads it: shortest decimals that name the f32 exactly, vectors in parentheses.
pub fn spell(formula: &Formula, words: &Words) -> String {
    let mut at = 0;
    let mut arguments = Vec::new();
    for shape in &formula.arguments {
        let mut leaves = Vec::new();
        for leaf in shape.leaves() {
            let numbers: Vec<String> = words
                .iter()
                .skip(at + leaf.start)
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
        at += shape.words();
        arguments.push(if leaves.len() == 1 { leaves.concat() } else { format!("{{{}}}", leaves.join(", ")) });
    }
    arguments.join(", ")
}
