//! Property testing on a GPU: each dispatch runs a batch of inputs, every row is compared, and the
//! worst one is shrunk alone.

pub(crate) mod alone;
pub mod histogram;
pub mod persistence;
pub mod promises;
pub mod seams;

pub use alone::accepted;

use crate::dispatch::{DispatchError, ROWS_PER_DISPATCH};
use crate::formula::{Formula, Words};
use crate::runner::Runner;
use crate::shape::Scalar;
use crate::tolerance::{Tolerance, Verdict, number};
use histogram::Histogram;
use proptest::strategy::ValueTree;
use rayon::prelude::*;
use std::time::Instant;

/// Default number of cases per formula.
pub const DEFAULT_CASES: u64 = 65_536;
/// Maximum number of rows in a batch that are judged again thoroughly after the usual search finds
/// them wrong.
const MOST_RECONSIDERED: usize = 64;
/// Maximum number of steps for shrinking one row.
const MOST_SHRINKS: usize = 4_000;
/// Rows in the first dispatch of a function with a loop, which may be endless.
const FIRST_ROWS: usize = 1_024;
/// Rows that one thread generates or compares at a time.
const ROWS_PER_TASK: usize = 512;

/// Settings of a run.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Number of random inputs.
    pub cases: u64,
    /// Seed of the random inputs.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { cases: DEFAULT_CASES, seed: 0x1a91_da21 }
    }
}

/// The findings of a run.
#[derive(Clone, Debug)]
pub struct Report {
    /// Rows tested, including replayed ones.
    pub cases: u64,
    /// Rows that failed their tolerance or an invariant.
    pub failed: u64,
    /// Rows with a NaN or an infinity.
    pub nonfinite: u64,
    /// Rows with a loop that reached the kernel's iteration limit, so that their results mean
    /// nothing.
    pub stopped: u64,
    /// Distribution of the forward error in ulp.
    pub ulps: Histogram,
    /// Largest forward error in ulp.
    pub max_ulp: f64,
    /// Largest ratio of error to allowed error.
    pub worst_ratio: f64,
    /// Row with that ratio.
    pub worst: Words,
    /// Simplest input found that fails at least half as badly as the worst; `None` if nothing
    /// failed.
    pub shrunk: Option<Words>,
    /// Reason why the worst row failed.
    pub reason: Option<String>,
    /// Number of inputs that reached each edge.
    pub edges: Vec<(&'static str, u64)>,
    /// Wall-clock time.
    pub seconds: f64,
}

impl Report {
    /// Returns whether every row held and every edge was reached.
    pub fn passed(&self) -> bool {
        self.failed == 0 && self.missed_edges().next().is_none()
    }

    /// Returns the edges that the run did not reach.
    pub fn missed_edges(&self) -> impl Iterator<Item = &'static str> {
        self.edges.iter().filter(|(_, count)| *count == 0).map(|(name, _)| *name)
    }
}

/// A formula bound to a runner and a tolerance, ready to run.
pub struct Check<'a> {
    /// Formula under test.
    pub formula: &'a Formula,
    /// Runner of the shader.
    pub runner: &'a mut dyn Runner,
    /// Tolerance of the results.
    pub tolerance: &'a Tolerance,
}

/// Judgement of a row's results.
struct Judged {
    verdict: Verdict,
    /// First broken invariant or pair.
    broken: Option<String>,
    /// Whether a loop reached the iteration limit, in the row or in its pair.
    stopped: bool,
}

impl Judged {
    fn fails(&self) -> bool {
        self.stopped || !self.verdict.holds() || self.broken.is_some()
    }

    /// Returns how badly the row fails; above 1 if it does.
    fn badness(&self) -> f64 {
        if self.stopped || self.verdict.nonfinite {
            return f64::INFINITY;
        }
        // A broken invariant has no measure of its own. It counts as just failing, so that a larger
        // error takes precedence.
        let invariant = if self.broken.is_some() { 1.0 + f64::EPSILON } else { 0.0 };
        self.verdict.ratio.max(invariant)
    }
}

impl Check<'_> {
    /// Tests the `replayed` rows first, then `settings.cases` random ones, and shrinks the worst if
    /// any failed.
    pub fn run(&mut self, settings: Settings, replayed: &[Words]) -> Result<Report, DispatchError> {
        let start = Instant::now();
        let mut report = Report {
            cases: 0,
            failed: 0,
            nonfinite: 0,
            stopped: 0,
            ulps: Histogram::default(),
            max_ulp: 0.0,
            worst_ratio: -1.0,
            worst: Words::new(),
            shrunk: None,
            reason: None,
            edges: self.formula.edges.iter().map(|edge| (edge.name, 0)).collect(),
            seconds: 0.0,
        };
        // Kept apart from the report's worst row, which may be a replayed one without draws to
        // shrink.
        let mut worst_random: Option<(u64, f64)> = None;
        if !replayed.is_empty() {
            self.batch(&replayed.concat(), &mut report)?;
        }
        let width = self.runner.argument_words();
        let mut first = 0;
        // After a loop reaches the limit the verdict is clear, and more rows with as many
        // iterations take long.
        while first < settings.cases && report.stopped == 0 {
            let most = if self.runner.loops() && first == 0 { FIRST_ROWS } else { ROWS_PER_DISPATCH };
            let rows = (settings.cases - first).min(most as u64) as usize;
            let mut arguments = vec![0; rows * width];
            let domain = &self.formula.domain;
            arguments.par_chunks_mut(ROWS_PER_TASK * width).enumerate().for_each(|(task, words)| {
                for (index, row) in words.chunks_exact_mut(width).enumerate() {
                    row.copy_from_slice(&domain.row(settings.seed, first + (task * ROWS_PER_TASK + index) as u64));
                }
            });
            let (index, badness) = self.batch(&arguments, &mut report)?;
            // Counts random inputs only: a replayed one says nothing about the reach of the
            // generator.
            for (edge, (_, count)) in self.formula.edges.iter().zip(&mut report.edges) {
                *count += arguments.par_chunks_exact(width).filter(|row| (edge.reached)(row)).count() as u64;
            }
            if badness > 1.0 && worst_random.is_none_or(|(_, worst)| badness > worst) {
                worst_random = Some((first + index as u64, badness));
            }
            first += rows as u64;
        }
        if report.failed > 0 {
            report.shrunk = Some(match worst_random {
                Some((row, badness)) => self.shrink(settings.seed, row, badness)?,
                // A replayed row was shrunk when it was recorded.
                None => report.worst.clone(),
            });
        }
        report.worst_ratio = report.worst_ratio.max(0.0);
        report.seconds = start.elapsed().as_secs_f64();
        Ok(report)
    }

    /// Tests a batch and adds it to the report. Returns the index of its worst row, and how badly
    /// that row fails.
    fn batch(&mut self, arguments: &[u32], report: &mut Report) -> Result<(usize, f64), DispatchError> {
        let width = self.runner.argument_words();
        let batch = self.judge(arguments)?;
        let mut worst = (0, -1.0);
        for (index, row) in batch.iter().enumerate() {
            let verdict = &row.verdict;
            report.failed += u64::from(row.fails());
            report.nonfinite += u64::from(verdict.nonfinite);
            report.stopped += u64::from(row.stopped);
            report.ulps.add(verdict.ulp);
            report.max_ulp = report.max_ulp.max(verdict.ulp);
            let badness = row.badness();
            if badness > report.worst_ratio {
                report.worst_ratio = badness;
                report.worst = arguments[index * width..(index + 1) * width].to_vec();
                report.reason = self.reason(row);
            }
            if badness > worst.1 {
                worst = (index, badness);
            }
        }
        report.cases += batch.len() as u64;
        Ok(worst)
    }

    /// Returns the reason why a row fails, or `None` if it holds.
    fn reason(&self, row: &Judged) -> Option<String> {
        if row.stopped {
            return Some(self.runner.why_stopped());
        }
        row.broken.clone().or_else(|| (!row.verdict.holds()).then(|| describe(&row.verdict)))
    }

    fn judge(&mut self, arguments: &[u32]) -> Result<Vec<Judged>, DispatchError> {
        let formula = self.formula;
        let (width, result_width) = (self.runner.argument_words(), self.runner.result_words());
        let rows = arguments.len() / width;
        let mut results = Words::new();
        self.runner.run(arguments, &mut results)?;
        let mut stopped: Vec<bool> = (0..rows).map(|row| self.runner.stopped(row)).collect();
        let mut others = Vec::new();
        let is_portable = self.runner.is_portable();
        let pairs = if is_portable { &[] } else { &formula.pairs[..] };
        for pair in pairs {
            let mut transformed = Words::with_capacity(arguments.len());
            arguments.chunks_exact(width).for_each(|row| (pair.transform)(row, &mut transformed));
            let mut other = Words::new();
            self.runner.run(&transformed, &mut other)?;
            stopped.iter_mut().enumerate().for_each(|(row, stopped)| *stopped |= self.runner.stopped(row));
            others.push(other);
        }
        let scalars: Vec<Scalar> = formula.arguments.iter().flat_map(crate::shape::Shape::scalars).collect();
        let tolerance = self.tolerance;
        let judge_row = |row: usize, thoroughly: bool, scratch: &mut (Words, Vec<f64>, Vec<f64>)| {
            let (mirrored, numbers, exact) = scratch;
            let arguments = &arguments[row * width..(row + 1) * width];
            let result = &results[row * result_width..(row + 1) * result_width];
            let verdict = if is_portable {
                alone::verdict(formula, tolerance, arguments, result, thoroughly)
            } else {
                mirrored.clear();
                (formula.mirror)(arguments, mirrored);
                numbers.clear();
                numbers.extend(arguments.iter().zip(&scalars).map(|(word, scalar)| number(*scalar, *word)));
                exact.clear();
                (formula.oracle)(numbers, exact);
                let judge = if thoroughly { Tolerance::judge_thoroughly } else { Tolerance::judge };
                judge(tolerance, arguments, result, mirrored, exact, &*formula.oracle)
            };
            let mut pairs = pairs.iter().zip(&others);
            let broken_pair = || {
                pairs.find_map(|(pair, other)| {
                    let other = &other[row * result_width..(row + 1) * result_width];
                    (pair.holds)(arguments, result, other).err().map(|why| (pair.name, why))
                })
            };
            let broken = alone::broken(formula, arguments, result, is_portable).or_else(broken_pair);
            let broken = broken.map(|(name, why)| format!("{name}: {why}"));
            Judged { verdict, broken, stopped: stopped[row] }
        };
        let mut judged: Vec<Judged> = (0..rows)
            .into_par_iter()
            .with_min_len(ROWS_PER_TASK)
            .map_init(Default::default, |scratch, row| judge_row(row, false, scratch))
            .collect();
        let wrong: Vec<usize> = (0..rows).filter(|row| !judged[*row].verdict.holds()).collect();
        // For a function that is wrong everywhere this would take long and tell nothing new.
        if wrong.len() <= MOST_RECONSIDERED {
            let again = wrong.par_iter().map_init(Default::default, |scratch, row| judge_row(*row, true, scratch));
            let again: Vec<Judged> = again.collect();
            wrong.into_iter().zip(again).for_each(|(row, again)| judged[row] = again);
        }
        Ok(judged)
    }

    /// Returns the simplest input near row `row` that still fails at least half as badly.
    fn shrink(&mut self, seed: u64, row: u64, worst: f64) -> Result<Words, DispatchError> {
        let mut tree = self.formula.domain.tree(seed, row);
        let mut simplest = tree.current();
        // Half the worst, so that the search does not end on the tolerance's edge; every candidate
        // must still fail.
        let enough = (worst / 2.0).min(f64::MAX);
        let mut fails = true;
        for _ in 0..MOST_SHRINKS {
            // As in proptest's own runner, the value after a step back is tested as well.
            if !(if fails { tree.simplify() } else { tree.complicate() }) {
                break;
            }
            let candidate = tree.current();
            fails = candidate == simplest || {
                let badness = self.judge(&candidate)?[0].badness();
                badness >= enough && badness > 1.0
            };
            if fails {
                simplest = candidate;
            }
        }
        Ok(simplest)
    }
}

fn describe(verdict: &Verdict) -> String {
    if verdict.nonfinite {
        "the result is not finite".to_owned()
    } else {
        format!("off by {:.1} times the allowed error", verdict.ratio)
    }
}
