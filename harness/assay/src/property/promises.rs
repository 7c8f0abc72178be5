//! What a function promises outside of its domain, tested.

use crate::dispatch::{DispatchError, Kernel};
use crate::formula::{Formula, Words};
use crate::literal::{self, Language};
use crate::outside::{Claim, Promise};
use crate::shape::Scalar;
use crate::tolerance::{Tolerance, number};

/// Inputs tried for each promise.
const CASES: u64 = 2_048;

/// Runs `promises` of `formula`; a line for each that does not hold, with the first input at which it does not.
pub fn broken(
    kernel: &mut Kernel<'_>,
    formula: &Formula,
    tolerance: &Tolerance,
    promises: &[Promise],
    seed: u64,
) -> Result<Vec<String>, DispatchError> {
    let mut faults = Vec::new();
    for promise in promises {
        let Some(inputs) = &promise.inputs else { continue };
        let rows: Vec<Words> = (0..CASES).map(|row| inputs.row(seed, row)).collect();
        let mut results = Words::new();
        kernel.run(&rows.concat(), &mut results)?;
        let mut others = Words::new();
        if let Claim::Like(transform) = &promise.claim {
            let mut inside = Words::new();
            rows.iter().for_each(|row| transform(row, &mut inside));
            kernel.run(&inside, &mut others)?;
        }
        let width = kernel.result_words();
        let fault = rows.iter().enumerate().find_map(|(index, row)| {
            let range = index * width..(index + 1) * width;
            let result = &results[range.clone()];
            let verdict = match &promise.claim {
                Claim::Finite => all_finite(formula, result),
                Claim::Accuracy => within_accuracy(formula, tolerance, row, result),
                Claim::Like(_) => same_bits(formula, result, &others[range]),
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
    // 0 and -0 are one number; a NaN is none.
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

fn within_accuracy(formula: &Formula, tolerance: &Tolerance, row: &[u32], result: &[u32]) -> Result<(), String> {
    let verdict = tolerance.judge(row, result, &formula.mirrored(row), &formula.exact(row), &*formula.oracle);
    if verdict.holds() { Ok(()) } else { Err(format!("off by {:.2} times the allowed error", verdict.ratio)) }
}
