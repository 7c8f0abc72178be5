//! Judgement of a result from a device that errs as far as it may: against the oracle alone. The
//! distance from the mirror to the oracle does not depend on devices.

use crate::formula::{Formula, Words};
use crate::shape::{Scalar, Shape};
use crate::tolerance::{Accepted, Tolerance, Verdict};

/// Judges a result; a subnormal input may have been read as 0.
pub fn verdict(formula: &Formula, tolerance: &Tolerance, row: &[u32], result: &[u32], thoroughly: bool) -> Verdict {
    let judge = if thoroughly { Tolerance::judge_thoroughly } else { Tolerance::judge };
    let judged = |row: &[u32]| judge(tolerance, row, result, result, &formula.exact(row), &*formula.oracle);
    let plain = judged(row);
    if plain.holds() || plain.nonfinite {
        return plain;
    }
    flushed(formula, row)
        .iter()
        .map(|row| judged(row))
        .fold(plain, |best, next| if next.ratio < best.ratio { next } else { best })
}

/// Returns the results that hold at a row on a device that errs as far as it may: by [`Tolerance::accepted`], for the
/// row as it is and as a flushing device may see it.
pub fn accepted(formula: &Formula, tolerance: &Tolerance, row: &[u32]) -> Vec<Accepted> {
    let results_of = |row: &[u32]| tolerance.accepted(row, &formula.exact(row), &*formula.oracle);
    let mut all = results_of(row);
    if has_subnormals(formula, row) {
        for more in flushed(formula, row).iter().flat_map(|row| results_of(row)) {
            if !all.iter().any(|known| known.covers(&more)) {
                all.push(more);
            }
        }
    }
    all
}

/// Judges a result according to its device: against the oracle alone if the device errs as far as
/// it may, otherwise against the mirror as well.
pub fn verdict_of(
    is_portable: bool,
    formula: &Formula,
    tolerance: &Tolerance,
    row: &[u32],
    result: &[u32],
    thoroughly: bool,
) -> Verdict {
    if is_portable {
        return verdict(formula, tolerance, row, result, thoroughly);
    }
    let judge = if thoroughly { Tolerance::judge_thoroughly } else { Tolerance::judge };
    judge(tolerance, row, result, &formula.mirrored(row), &formula.exact(row), &*formula.oracle)
}

/// Maximum number of subnormals in a row that are each tried flushed or not; beyond it, all are
/// flushed.
const MOST_SUBNORMALS: usize = 4;

/// Returns the first invariant that a result breaks, with the reason. On a portable device the
/// result is forgiven if it holds for the row as a flushing device may see it.
pub fn broken(formula: &Formula, row: &[u32], result: &[u32], is_portable: bool) -> Option<(&'static str, String)> {
    let broken = formula.broken(row, result, is_portable)?;
    let holds = |row: &Words| formula.broken(row, result, is_portable).is_none();
    let is_forgiven = is_portable && has_subnormals(formula, row) && flushed(formula, row).iter().any(holds);
    (!is_forgiven).then_some(broken)
}

/// Returns the places of the floats in a row that a device may flush.
fn subnormals(formula: &Formula, row: &[u32]) -> Vec<usize> {
    let scalars = formula.arguments.iter().flat_map(Shape::scalars);
    let is_subnormal = |(word, scalar): (&u32, Scalar)| scalar == Scalar::F32 && f32::from_bits(*word).is_subnormal();
    let parts = row.iter().zip(scalars).enumerate().filter(|(_, part)| is_subnormal(*part));
    parts.map(|(place, _)| place).collect()
}

/// Returns whether a device may see the row differently.
pub fn has_subnormals(formula: &Formula, row: &[u32]) -> bool {
    !subnormals(formula, row).is_empty()
}

/// Returns the row as it may appear to a device that flushes some of its subnormals: each is kept,
/// becomes a zero of either sign, or changes its sign, which a flushing comparison does not see.
fn flushed(formula: &Formula, row: &[u32]) -> Vec<Words> {
    let places = subnormals(formula, row);
    if places.len() > MOST_SUBNORMALS {
        let mut flushed = row.to_vec();
        places.iter().for_each(|place| flushed[*place] = 0);
        return vec![flushed];
    }
    let mut rows = vec![row.to_vec()];
    for place in places {
        let changed = |word: u32| rows.iter().map(move |row| (row.clone(), word));
        let zeros = changed(0).chain(changed(0x8000_0000));
        let more: Vec<(Words, u32)> = zeros.chain(changed(row[place] ^ 0x8000_0000)).collect();
        rows.extend(more.into_iter().map(|(mut row, word)| {
            row[place] = word;
            row
        }));
    }
    rows
}

/// Returns whether the standard covers a call with these arguments: a device may assume that
/// infinities and NaNs are absent.
pub fn is_stated(formula: &Formula, row: &[u32]) -> bool {
    let scalars = formula.arguments.iter().flat_map(Shape::scalars);
    row.iter().zip(scalars).all(|(word, scalar)| scalar != Scalar::F32 || f32::from_bits(*word).is_finite())
}
