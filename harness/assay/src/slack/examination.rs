//! Everything that is tested of a function, on devices that err as far as WGSL lets them.

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

/// Random inputs, and as many hard cases, whose worst choices are looked for.
const CLIMBED: usize = 8;

/// Random inputs whose first-order allowances are laid beside the bound; they take as long as the rest.
const ALLOWED: u64 = 65_536;

/// What was found.
#[derive(Clone, Debug)]
pub struct Found {
    /// All that was tested.
    pub examination: Examination,
    /// What was taken to hold where the standard states nothing.
    pub assumptions: BTreeSet<Assumption>,
    /// What first order says of the bound; none under reassociation, and where the function takes too long.
    pub allowance: Option<Allowance>,
}

/// Examines the function of `formula` in `source`; `path` is for messages. `replayed` inputs, random ones, hard cases, promises outside of the domain and the inputs beside branches run on a
/// device each; then the worst of the inputs, some hard cases and some others on the worst device that is found for them.
///
/// # Errors
/// Where the source is not valid, or does what the interpreter cannot.
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
