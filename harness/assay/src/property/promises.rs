//! Tests of a function's promises outside its domain.

use super::alone;
use crate::dispatch::DispatchError;
use crate::formula::{Formula, Words};
use crate::literal::{self, Language};
use crate::outside::{Claim, Promise};
use crate::runner::Runner;
use crate::shape::Scalar;
use crate::tolerance::{Tolerance, Verdict, number};

/// Number of inputs per promise.
const CASES: u64 = 2_048;

/// Tests `promises` of `formula`. Returns a line for each broken promise, with the first input that
/// breaks it.
pub fn broken(
    runner: &mut dyn Runner,
    formula: &Formula,
    tolerance: &Tolerance,
    promises: &[Promise],
    seed: u64,
) -> Result<Vec<String>, DispatchError> {
    let mut faults = Vec::new();
    for promise in promises {
        let Some(inputs) = promise.inputs.as_ref().filter(|_| !(runner.is_portable() && promise.at_nearest)) else {
            continue;
        };
        let rows: Vec<Words> = (0..CASES).map(|row| inputs.row(seed, row)).collect();
        let mut results = Words::new();
        runner.run(&rows.concat(), &mut results)?;
        let mut others = Words::new();
        let is_portable = runner.is_portable();
        if let (Claim::Like(transform), false) = (&promise.claim, is_portable) {
            let mut inside = Words::new();
            rows.iter().for_each(|row| transform(row, &mut inside));
            runner.run(&inside, &mut others)?;
        }
        let width = runner.result_words();
        let fault = rows.iter().enumerate().find_map(|(index, row)| {
            let range = index * width..(index + 1) * width;
            let result = &results[range.clone()];
            let verdict = match &promise.claim {
                // The standard says nothing about infinities and NaNs.
                _ if is_portable && !alone::is_stated(formula, row) => Ok(()),
                Claim::Accuracy => ratio(alone::verdict_of(is_portable, formula, tolerance, row, result, is_portable)),
                Claim::Like(transform) if is_portable => {
                    let mut inside = Words::new();
                    transform(row, &mut inside);
                    ratio(alone::verdict(formula, tolerance, &inside, result, true))
                }
                Claim::Like(_) => same_bits(formula, result, &others[range]),
                Claim::Finite => all_finite(formula, result),
                Claim::Holds(predicate) => predicate(row, result),
                Claim::Nothing => Ok(()),
            };
            verdict.err().map(|why| (row, why))
        });
        if let Some((row, why)) = fault {
            faults.push(format!(
                "outside of its domain it promises `{}`; at {}: {why}",
                promise.says,
                literal::call(Language::Wgsl, formula, row)
            ));
        }
    }
    Ok(faults)
}

fn all_finite(formula: &Formula, result: &[u32]) -> Result<(), String> {
    let bad = result
        .iter()
        .zip(formula.result.scalars())
        .find(|(word, scalar)| *scalar == Scalar::F32 && !f32::from_bits(**word).is_finite());
    bad.map_or(Ok(()), |(word, _)| Err(format!("the result holds {}", f32::from_bits(*word))))
}

fn same_bits(formula: &Formula, result: &[u32], other: &[u32]) -> Result<(), String> {
    // 0 and -0 are the same number; a NaN is no number.
    let differ = |(word, other): (&u32, &u32), scalar: Scalar| match scalar {
        Scalar::F32 => f32::from_bits(*word) != f32::from_bits(*other),
        _ => word != other,
    };
    let scalars = formula.result.scalars();
    match result.iter().zip(other).zip(&scalars).find(|(words, scalar)| differ(*words, **scalar)) {
        None => Ok(()),
        Some(((word, other), scalar)) => {
            Err(format!("the result holds {}, inside {}", number(*scalar, *word), number(*scalar, *other)))
        }
    }
}

fn ratio(verdict: Verdict) -> Result<(), String> {
    if verdict.holds() { Ok(()) } else { Err(format!("off by {:.2} times the allowed error", verdict.ratio)) }
}
