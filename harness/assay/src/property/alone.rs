//! What a result is worth on a device that errs as far as it may: held to the oracle alone. How near the mirror is to the oracle is no question of devices.

use crate::formula::{Formula, Words};
use crate::shape::{Scalar, Shape};
use crate::tolerance::{Tolerance, Verdict};

/// Judges a result; an input that is subnormal may have been read as 0.
pub fn verdict(formula: &Formula, tolerance: &Tolerance, row: &[u32], result: &[u32], thoroughly: bool) -> Verdict {
    let judge = if thoroughly { Tolerance::judge_thoroughly } else { Tolerance::judge };
    let of = |row: &[u32]| judge(tolerance, row, result, result, &formula.exact(row), &*formula.oracle);
    let plain = of(row);
    if plain.holds() || plain.nonfinite {
        return plain;
    }
    flushed(formula, row)
        .iter()
        .map(|row| of(row))
        .fold(plain, |best, next| if next.ratio < best.ratio { next } else { best })
}

/// Judges a result as its device is to be: alone where that errs as far as it may, else beside the mirror's as well.
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

/// Subnormals of a row of which each may have been flushed or not; of more all are.
const MOST_SUBNORMALS: usize = 4;

/// The first invariant that a result breaks, and how; of a portable device one that it also breaks for the row as a device may see it that flushes.
pub fn broken(formula: &Formula, row: &[u32], result: &[u32], is_portable: bool) -> Option<(&'static str, String)> {
    let broken = formula.broken(row, result, is_portable)?;
    let holds = |row: &Words| formula.broken(row, result, is_portable).is_none();
    let is_forgiven = is_portable && has_subnormals(formula, row) && flushed(formula, row).iter().any(holds);
    (!is_forgiven).then_some(broken)
}

/// Where the floats of a row are that a device may flush.
fn subnormals(formula: &Formula, row: &[u32]) -> Vec<usize> {
    let scalars = formula.arguments.iter().flat_map(Shape::scalars);
    let is_subnormal = |(word, scalar): (&u32, Scalar)| scalar == Scalar::F32 && f32::from_bits(*word).is_subnormal();
    let parts = row.iter().zip(scalars).enumerate().filter(|(_, part)| is_subnormal(*part));
    parts.map(|(place, _)| place).collect()
}

/// Whether a device may see the row otherwise than it is.
pub fn has_subnormals(formula: &Formula, row: &[u32]) -> bool {
    !subnormals(formula, row).is_empty()
}

/// The row as a device may see it that flushes some of its subnormals: each is kept, or a zero of either sign, or has lost its sign, which a comparison that flushes does not see.
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

/// Whether the standard says anything of a call with these arguments: a device may take infinities and NaNs to be absent.
pub fn is_stated(formula: &Formula, row: &[u32]) -> bool {
    let scalars = formula.arguments.iter().flat_map(Shape::scalars);
    row.iter().zip(scalars).all(|(word, scalar)| scalar != Scalar::F32 || f32::from_bits(*word).is_finite())
}
