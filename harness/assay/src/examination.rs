//! All tests of a WGSL function: random inputs, hard cases, promises outside its domain, and inputs
//! next to its branches.

use crate::accuracy_line::Accuracy;
use crate::dispatch::DispatchError;
use crate::environment::SEED_VARIABLE;
use crate::extremum::largest;
use crate::failure::Failure;
use crate::formula::{Formula, HardCase, Words};
use crate::property::{Check, DEFAULT_CASES, Report, Settings, alone, promises, seams};
use crate::runner::Runner;
use crate::tolerance::{Tolerance, numbers};
use std::fmt::Write as _;

/// The findings of all tests.
#[derive(Clone, Debug)]
pub struct Examination {
    /// Report on the random inputs.
    pub report: Report,
    /// The results at the simplest failing input.
    pub failure: Option<Failure>,
    /// Names of the failing hard cases, with the distance from the limit.
    pub broken_hard_cases: Vec<String>,
    /// Broken promises outside the domain, each with an input.
    pub broken_promises: Vec<String>,
    /// Branches with a wrong result one float to either side, each with the input.
    pub broken_branches: Vec<String>,
    /// Fault at an input that holds only by chance, on the worst device that WGSL allows.
    pub worst_choices: Option<String>,
    /// Reason why branches were not examined, if the interpreter cannot run the function.
    pub branches_untested: Option<String>,
    settings: Settings,
}

impl Examination {
    /// Returns whether everything holds. Edges count only from the default number of cases on,
    /// since a shorter run may well miss some.
    pub fn holds(&self) -> bool {
        let edges = self.settings.cases < DEFAULT_CASES || self.report.missed_edges().next().is_none();
        let others = [&self.broken_hard_cases, &self.broken_promises, &self.broken_branches];
        self.report.failed == 0 && self.worst_choices.is_none() && edges && others.into_iter().all(Vec::is_empty)
    }

    /// Describes the faults, one per line, and how to reproduce them.
    pub fn describe(&self, formula: &Formula) -> String {
        let Settings { cases, seed } = self.settings;
        let mut text = String::new();
        if self.report.failed > 0 {
            let reason = self.report.reason.as_deref().unwrap_or("the worst");
            let _ = writeln!(text, "{} of {} inputs failed; {reason}", self.report.failed, self.report.cases);
        }
        if let Some(failure) = &self.failure {
            let comma = if formula.arguments.len() == 1 { "," } else { "" };
            let _ = writeln!(text, "{failure}  to keep it: .case(({}{comma}))", failure.arguments_rust);
        }
        for fault in self.broken_hard_cases.iter().map(|fault| format!("hard case: {fault}")) {
            let _ = writeln!(text, "{fault}");
        }
        for fault in self.broken_promises.iter().chain(&self.broken_branches).chain(&self.worst_choices) {
            let _ = writeln!(text, "{fault}");
        }
        if let Some(why) = &self.branches_untested {
            let _ = writeln!(text, "  inputs beside branches were not looked for: {why}");
        }
        let missed: Vec<&str> = self.report.missed_edges().collect();
        if cases >= DEFAULT_CASES && !missed.is_empty() {
            let _ = writeln!(text, "{}", not_reached(&missed));
        }
        let _ = write!(text, "  seed {seed}, {cases} inputs; again with {SEED_VARIABLE}={seed}");
        format!("{}: {text}", formula.function)
    }
}

/// Describes the edges that no input reached.
pub(crate) fn not_reached(edges: &[&str]) -> String {
    format!("no input reached `{}`; mend the inputs, or the edge", edges.join("`, `"))
}

/// Returns the tolerance of a formula's function on this device: the promise in its comment or, for
/// a naive form, the error that it keeps on its benign domain.
///
/// # Errors
/// Returns an error if the comment calls the function naive and its formula has no benign domain.
pub fn tolerance(formula: &Formula, accuracy: &Accuracy, lavapipe: bool) -> Result<Tolerance, String> {
    if let Some(relative) = formula.benign {
        return Ok(Tolerance::of_benign(&formula.arguments, &formula.result, relative));
    }
    let bounds = accuracy.bounds(lavapipe);
    let bounds = bounds.ok_or_else(|| format!("{}: naive, but its formula has no benign domain", formula.function))?;
    Ok(Tolerance::new(&formula.arguments, &formula.result, bounds))
}

/// Examines the function of `formula` in `source`, from which `runner` was made. The `replayed`
/// inputs and those of the hard cases are tested first.
///
/// # Errors
/// Returns an error if the device refuses.
pub fn examine(
    formula: &Formula,
    source: &str,
    runner: &mut dyn Runner,
    tolerance: &Tolerance,
    settings: Settings,
    replayed: &[Words],
) -> Result<Examination, DispatchError> {
    let first: Vec<Words> =
        replayed.iter().chain(formula.hard_cases.iter().map(|case| &case.arguments)).cloned().collect();
    let report = Check { formula, runner: &mut *runner, tolerance }.run(settings, &first)?;
    let failure = match &report.shrunk {
        None => None,
        Some(shrunk) => Some(Failure::at(formula, runner, tolerance, shrunk)?),
    };
    // A naive form that is backward stable passes the tolerance; the limits distinguish it from the
    // stable form.
    let mut broken_hard_cases = Vec::new();
    for case in &formula.hard_cases {
        broken_hard_cases.extend(broken(case, formula, tolerance, runner)?);
    }
    let broken_promises = promises::broken(runner, formula, tolerance, &formula.promises, settings.seed)?;
    // A function with endless loops takes as long on the CPU, and has already failed.
    let branches = if report.stopped > 0 {
        Ok(Vec::new())
    } else {
        seams::of_source(source, formula, runner, tolerance, settings.seed)?
    };
    let (broken_branches, branches_untested) = match branches {
        Ok(faults) => (faults.iter().map(ToString::to_string).collect(), None),
        Err(stopped) => (Vec::new(), Some(stopped.to_string())),
    };
    Ok(Examination {
        report,
        failure,
        broken_hard_cases,
        broken_promises,
        broken_branches,
        worst_choices: None,
        branches_untested,
        settings,
    })
}

/// Returns the fault at a hard case. On a device that errs as far as it may, the result need only
/// keep its tolerance, which is also measured from the oracle.
fn broken(
    case: &HardCase,
    formula: &Formula,
    tolerance: &Tolerance,
    runner: &mut dyn Runner,
) -> Result<Option<String>, DispatchError> {
    let distance = distance_from_limit(runner, formula, &case.arguments, &case.limit)?;
    let bound = case.bound;
    if runner.is_portable() {
        let mut result = Words::new();
        runner.run(&case.arguments, &mut result)?;
        if alone::verdict(formula, tolerance, &case.arguments, &result, true).holds() {
            return Ok(None);
        }
    }
    Ok(if runner.any_stopped() {
        Some(format!("{}: {}", case.name, runner.why_stopped()))
    } else if distance.is_nan() || distance > bound {
        // A NaN distance is not within the bound.
        Some(format!("{}: off the limit by {distance:e}, at most {bound:e}", case.name))
    } else {
        None
    })
}

/// Returns the largest distance of the result's components from `limit`; NaN if a component is NaN,
/// infinite if one is infinite.
///
/// # Errors
/// Returns an error if the device refuses.
pub fn distance_from_limit(
    runner: &mut dyn Runner,
    formula: &Formula,
    arguments: &Words,
    limit: &[f64],
) -> Result<f64, DispatchError> {
    let mut words = Words::new();
    runner.run(arguments, &mut words)?;
    let found = numbers(&formula.result, &words);
    Ok(largest(found.iter().zip(limit).map(|(found, limit)| (found - limit).abs())))
}
