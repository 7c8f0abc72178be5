//! All tests of a function, on devices that err as far as WGSL allows.

use super::allowance::{self, Allowance, Wgsl};
use super::{Reassociation, Slackened, climb};
use crate::dispatch::DispatchError;
use crate::examination::{self, Examination};
use crate::formula::{Formula, Words};
use crate::interpreter::Assumption;
use crate::literal::{Language, call};
use crate::property::Settings;
use crate::tolerance::Tolerance;
use std::collections::BTreeSet;

/// Number of random inputs, and of hard cases, for which the worst choices are searched.
const CLIMBED: usize = 8;

/// Random inputs with a comparison of first-order allowance and bound. They take as long as all
/// other tests.
const ALLOWED: u64 = 65_536;

/// Results of an examination.
#[derive(Clone, Debug)]
pub struct Found {
    /// Results of all tests.
    pub examination: Examination,
    /// Assumptions made in cases on which the standard is silent.
    pub assumptions: BTreeSet<Assumption>,
    /// First-order check of the bound; `None` under reassociation, and if the function takes too
    /// long.
    pub allowance: Option<Allowance>,
}

/// Examines the function of `formula` in `source`; `path` appears in messages. Each of the
/// `replayed` inputs, random inputs, hard cases, promises outside of the domain and inputs near
/// branches runs on its own device. Then the worst input, some hard cases and some other inputs run
/// on the worst device that a search finds for them.
///
/// # Errors
/// Returns an error if the source is not valid, or uses a feature that the interpreter lacks.
pub fn examine(
    formula: &Formula,
    (source, path): (&str, &str),
    tolerance: &Tolerance,
    settings: Settings,
    reassociation: Reassociation,
    replayed: &[Words],
) -> Result<Found, DispatchError> {
    let mut runner = Slackened::new(source, path, formula.function, settings.seed, reassociation)?;
    let mut found = examination::examine(formula, source, &mut runner, tolerance, settings, replayed)?;
    let allowed = Settings { cases: settings.cases.min(ALLOWED), ..settings };
    let allowance = match reassociation {
        Reassociation::Written => allowance::of_formula(runner.program(), formula, tolerance, &Wgsl, allowed).ok(),
        Reassociation::Reordered => None,
    };
    if reassociation == Reassociation::Written && found.report.failed == 0 {
        let random = (0..settings.cases.min(CLIMBED as u64)).map(|row| formula.domain.row(settings.seed, row));
        let hard = formula.hard_cases.iter().map(|case| case.arguments.clone()).take(CLIMBED);
        let worst = (!found.report.worst.is_empty()).then(|| found.report.worst.clone());
        let rows: Vec<Words> = worst.into_iter().chain(replayed.iter().cloned()).chain(random).chain(hard).collect();
        let worst = climb::worst(runner.program(), formula, tolerance, settings.seed, &rows);
        let worst = worst.map_err(|stopped| DispatchError::Fault { line: None, message: stopped.to_string() })?;
        if let Some(worst) = worst.filter(|worst| worst.ratio > found.report.worst_ratio) {
            found.report.worst_ratio = worst.ratio;
            if worst.ratio > 1.0 {
                let input = call(Language::Wgsl, formula, &worst.arguments);
                found.worst_choices = Some(format!(
                    "on the worst device for it off by {:.2} times the allowed error: {input}",
                    worst.ratio
                ));
            }
            found.report.worst = worst.arguments;
        }
    }
    Ok(Found { examination: found, assumptions: runner.assumptions().clone(), allowance })
}
