//! Judgement of a mutant by a function's tests.

use super::{Mutant, apply, compacted};
use crate::dispatch::{DispatchError, Kernel, KernelModule};
use crate::formula::{Formula, Words};
use crate::interpreter::Program;
use crate::property::{Check, Settings, promises};
use crate::runner::Runner;
use crate::slack::Slackened;
use crate::tolerance::Tolerance;
use lapidary_gpu::Gpu;
use std::cell::OnceCell;

/// Seed of the rows. It is fixed: the known equivalent mutants must not depend on a run's seed.
const SEED: u64 = 0x1a91_da21;
/// Rows compared first. A loop that only the driver ends is over soon with them, and mostly wrong.
const FIRST_ROWS: usize = 256;
/// Rows with stored right results.
const KEPT_ROWS: u64 = 8_192;
/// Rows for mutants that the stored rows do not reveal.
const MORE_ROWS: u64 = 131_072;

/// Rows on devices that err as far as WGSL allows, for mutants that no other input reveals.
const ROWS_ANYWHERE: u64 = 16_384;

/// A function with its tests and the right results of its first inputs, computed once for all
/// mutants.
pub struct Judge<'a> {
    gpu: &'a Gpu,
    formula: &'a Formula,
    source: &'a str,
    path: &'a str,
    kernel: KernelModule,
    tolerance: Tolerance,
    /// Tolerance on any device that conforms to WGSL.
    anywhere: Option<Tolerance>,
    arguments: Words,
    mirrored: Vec<Words>,
    exact: Vec<Vec<f64>>,
    /// Kernel that reports the rows with an infinity or a NaN, and those rows of the unchanged
    /// function; made at first use.
    watched: OnceCell<(KernelModule, Vec<bool>)>,
}

impl std::fmt::Debug for Judge<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Judge").field("function", &self.formula.function).finish_non_exhaustive()
    }
}

impl<'a> Judge<'a> {
    /// Returns a judge with the tests of `formula` on `source`, and the inputs that are always
    /// tested; `path` appears in messages.
    ///
    /// # Errors
    /// Returns an error if the source is not valid, or has no such function.
    pub fn new(
        gpu: &'a Gpu,
        formula: &'a Formula,
        (source, path): (&'a str, &'a str),
        tolerance: Tolerance,
        cases: &[Words],
    ) -> Result<Self, DispatchError> {
        let kernel = compacted(KernelModule::reflect(source, path, formula.function)?);
        let rows = (0..KEPT_ROWS).map(|row| formula.domain.row(SEED, row));
        let first = cases.iter().chain(formula.hard_cases.iter().map(|case| &case.arguments)).cloned();
        let rows: Vec<Words> = first.chain(rows).collect();
        let (mirrored, exact) = rows.iter().map(|row| (formula.mirrored(row), formula.exact(row))).unzip();
        let arguments = rows.concat();
        let watched = OnceCell::new();
        let anywhere = None;
        Ok(Self { gpu, formula, source, path, kernel, tolerance, anywhere, arguments, mirrored, exact, watched })
    }

    /// Also tests each mutant that passes on the device on any device that conforms to WGSL, to
    /// this tolerance.
    #[must_use]
    pub fn and_anywhere(self, tolerance: Tolerance) -> Self {
        Self { anywhere: Some(tolerance), ..self }
    }

    /// Returns whether a test fails on the unchanged function, so that its mutants cannot be
    /// judged.
    pub fn rejects_unchanged(&self) -> bool {
        self.notices(self.kernel.clone())
    }

    /// Returns whether a test fails on the mutant. An invalid mutant, or one outside of this
    /// function's reach, is not noticed.
    pub fn catches(&self, mutant: &Mutant) -> bool {
        apply(&self.kernel, mutant)
            .is_some_and(|mutated| self.notices(mutated) || self.computes_more_infinities(mutant))
    }

    /// Returns whether the mutant computes an infinity or a NaN in a row without one in the
    /// unchanged function. WGSL leaves its effect to each device, even if this one returns the
    /// right result.
    fn computes_more_infinities(&self, mutant: &Mutant) -> bool {
        let nonfinite = |kernel: KernelModule| -> Option<Vec<bool>> {
            let mut kernel = Kernel::new(self.gpu, kernel.watched()).ok()?;
            let mut results = Words::new();
            kernel.run(&self.arguments, &mut results).ok()?;
            Some(results.chunks_exact(kernel.result_words()).map(|row| row.last() == Some(&1)).collect())
        };
        let (kernel, right) = self.watched.get_or_init(|| {
            let kernel = KernelModule::reflect_watched(self.source, self.path, self.formula.function);
            let kernel = compacted(kernel.expect("valid, since it was reflected before"));
            let right = nonfinite(kernel.clone()).unwrap_or_default();
            (kernel, right)
        });
        let Some(found) = apply(kernel, mutant).and_then(nonfinite) else { return false };
        found.iter().zip(right).any(|(found, right)| *found && !right)
    }

    /// Returns whether the property tests tell this kernel from the right one.
    fn notices(&self, mutated: KernelModule) -> bool {
        let module = mutated.module.clone();
        let Ok(mut kernel) = Kernel::new(self.gpu, mutated) else { return true };
        let (width, all) = (kernel.argument_words(), self.mirrored.len());
        for (first, last) in [(0, FIRST_ROWS.min(all)), (FIRST_ROWS.min(all), all)] {
            let arguments = &self.arguments[first * width..last * width];
            let mut results = Words::new();
            if kernel.run(arguments, &mut results).is_err() {
                return true;
            }
            let rows = arguments.chunks_exact(width).zip(results.chunks_exact(kernel.result_words()));
            let right = self.mirrored[first..last].iter().zip(&self.exact[first..last]);
            let broken = rows.zip(right).any(|((arguments, result), (mirrored, exact))| {
                !self.tolerance.judge(arguments, result, mirrored, exact, &*self.formula.oracle).holds()
                    || self.formula.broken(arguments, result, false).is_some()
            });
            if broken {
                return true;
            }
        }
        let broken = promises::broken(&mut kernel, self.formula, &self.tolerance, &self.formula.promises, SEED);
        if broken.is_ok_and(|broken| !broken.is_empty()) {
            return true;
        }
        let settings = Settings { cases: MORE_ROWS, seed: SEED + 1 };
        let report =
            Check { formula: self.formula, runner: &mut kernel, tolerance: &self.tolerance }.run(settings, &[]);
        if report.map_or(true, |report| report.failed > 0) {
            return true;
        }
        let Some(tolerance) = &self.anywhere else { return false };
        let Some(program) = Program::of_module(module, self.formula.function) else { return true };
        let Ok(mut runner) = Slackened::of_program(program, SEED) else { return false };
        let promises = &self.formula.promises;
        let settings = Settings { cases: ROWS_ANYWHERE, seed: SEED + 2 };
        let report = Check { formula: self.formula, runner: &mut runner, tolerance }.run(settings, &[]);
        let broken = promises::broken(&mut runner, self.formula, tolerance, promises, SEED);
        report.map_or(true, |report| report.failed > 0) || broken.map_or(true, |broken| !broken.is_empty())
    }
}
