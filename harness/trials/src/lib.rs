//! The tests of a module of WGSL functions, for `cargo test`: one for each formula, filtered by
//! name as usual in cargo.
//!
//! In the module's `tests/formulas.rs`, whose `[[test]]` has `harness = false`:
//!
//! ```ignore
//! fn main() -> std::process::ExitCode {
//!     lapidary_trials::test(&[include_str!("../refraction.wgsl")], formulas())
//! }
//! ```

use lapidary_assay::accuracy_line::Accuracy;
use lapidary_assay::dispatch::{DispatchError, Kernel};
use lapidary_assay::environment;
use lapidary_assay::examination::{Examination, examine, tolerance};
use lapidary_assay::formula::Formula;
use lapidary_assay::property::{DEFAULT_CASES, Settings};
use lapidary_gpu::Gpu;
use libtest_mimic::{Arguments, Completion, Failed, Trial};
use std::process::ExitCode;
use std::sync::Arc;

/// Factor on the number of inputs when a run that missed a rare edge is repeated.
const MORE: u64 = 16;

/// Tests the function of each formula in `sources`, which are joined into one text: a module and
/// its naive forms. The function's comment states its bounds in an `Accuracy:` line. The tests
/// cover random inputs, hard cases, promises outside the domain and inputs next to branches.
/// Accepts libtest's arguments.
pub fn test(sources: &[&str], formulas: Vec<Formula>) -> ExitCode {
    let source: Arc<str> = sources.join("\n").into();
    let trial = |formula: Formula| {
        let kind = if formula.benign.is_some() { "naive" } else { "" };
        let source = Arc::clone(&source);
        Trial::ignorable_test(formula.function, move || completion(&source, &formula)).with_kind(kind)
    };
    libtest_mimic::run(&Arguments::from_args(), formulas.into_iter().map(trial).collect()).exit_code()
}

/// Runs one test. Without an adapter, if the environment allows that, it counts as ignored.
fn completion(source: &str, formula: &Formula) -> Result<Completion, Failed> {
    let gpu = environment::gpu(formula.function).map_err(|error| Failed::from(error.to_string()))?;
    let Some(gpu) = gpu else { return Ok(Completion::ignored_with("no adapter")) };
    let seed = environment::seed()?.unwrap_or(Settings::default().seed);
    let mut found = examined(gpu, source, formula, Settings { cases: DEFAULT_CASES, seed })?;
    if found.report.failed == 0 && found.report.missed_edges().next().is_some() {
        // A seed may miss a rare edge by chance.
        found = examined(gpu, source, formula, Settings { cases: MORE * DEFAULT_CASES, seed })?;
    }
    if found.holds() { Ok(Completion::Completed) } else { Err(found.describe(formula).into()) }
}

fn examined(gpu: &Gpu, source: &str, formula: &Formula, settings: Settings) -> Result<Examination, String> {
    let function = formula.function;
    let accuracy = Accuracy::of_function(source, function)?;
    accuracy.check_fields(&formula.result).map_err(|fault| format!("{function}: Accuracy: {fault}"))?;
    let tolerance = tolerance(formula, &accuracy, gpu.is_lavapipe())?;
    let fail = |error: DispatchError| format!("{function}: {error}");
    let mut kernel = Kernel::of_function(gpu, source, formula.module, function).map_err(fail)?;
    kernel.signature().expect(&formula.arguments, &formula.result).map_err(|error| error.to_string())?;
    examine(formula, source, &mut kernel, &tolerance, settings, &[]).map_err(fail)
}
