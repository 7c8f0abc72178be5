//! Differences in bits between the results of two devices for the same inputs.

use lapidary_assay::dispatch::{DispatchError, ROWS_PER_DISPATCH};
use lapidary_assay::extremum::largest;
use lapidary_assay::formula::{Formula, Words};
use lapidary_assay::property::Settings;
use lapidary_assay::runner::Runner;
use lapidary_assay::shape::{Scalar, Shape};
use lapidary_assay::tolerance::ulp_of;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Differences between the results of two devices for the same random inputs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Difference {
    /// Number of inputs that both were given.
    pub inputs: u64,
    /// Number of inputs whose results differ in any bit.
    pub differing: u64,
    /// Number of inputs whose results differ in a bool or an integer.
    pub discrete: u64,
    /// Largest distance in ulp of the larger result's largest component; zeros of either sign are
    /// equal.
    pub max_ulp: f64,
    /// Median distance of the results that differ.
    pub median_ulp: f64,
    /// The input with the largest distance.
    #[serde(skip)]
    pub worst: Words,
}

impl Difference {
    /// Combines two differences. The median is that of the one with more differing results.
    pub fn join(self, other: Difference) -> Difference {
        let (larger, smaller) = if other.max_ulp > self.max_ulp { (other, self) } else { (self, other) };
        let more = if larger.differing >= smaller.differing { &larger } else { &smaller };
        Difference {
            inputs: larger.inputs + smaller.inputs,
            differing: larger.differing + smaller.differing,
            discrete: larger.discrete + smaller.discrete,
            median_ulp: more.median_ulp,
            ..larger
        }
    }
}

/// Runs a formula's random inputs, as given by `settings`, on both runners.
///
/// # Errors
/// Returns an error if one of them fails.
pub fn between(
    one: &mut dyn Runner,
    other: &mut dyn Runner,
    formula: &Formula,
    settings: Settings,
) -> Result<Difference, DispatchError> {
    let mut found = Difference { inputs: settings.cases, ..Difference::default() };
    let mut distances = Vec::new();
    let mut results = [Words::new(), Words::new()];
    for first in (0..settings.cases).step_by(ROWS_PER_DISPATCH) {
        let last = (first + ROWS_PER_DISPATCH as u64).min(settings.cases);
        let rows: Vec<Words> =
            (first..last).into_par_iter().map(|row| formula.domain.row(settings.seed, row)).collect();
        let arguments = rows.concat();
        one.run(&arguments, &mut results[0])?;
        other.run(&arguments, &mut results[1])?;
        let width = one.result_words();
        for ((row, one), other) in rows.iter().zip(results[0].chunks_exact(width)).zip(results[1].chunks_exact(width)) {
            if one == other {
                continue;
            }
            found.differing += 1;
            let (distance, is_discrete) = apart(&formula.result, one, other);
            found.discrete += u64::from(is_discrete);
            distances.push(distance);
            // The first difference always counts, however small.
            if found.worst.is_empty() || distance > found.max_ulp {
                found.max_ulp = distance;
                found.worst.clone_from(row);
            }
        }
    }
    distances.sort_by(f64::total_cmp);
    found.median_ulp = distances.get(distances.len() / 2).copied().unwrap_or(0.0);
    Ok(found)
}

/// Returns the largest distance between the floats of two results, and whether a bool or an integer
/// differs; in that case the floats belong to different branches and are not compared.
fn apart(shape: &Shape, one: &[u32], other: &[u32]) -> (f64, bool) {
    let leaves = shape.leaves();
    let words = |leaf: &lapidary_assay::shape::Leaf| leaf.start..leaf.start + leaf.length;
    if leaves.iter().any(|leaf| leaf.scalar != Scalar::F32 && one[words(leaf)] != other[words(leaf)]) {
        return (0.0, true);
    }
    let distances = leaves.iter().filter(|leaf| leaf.scalar == Scalar::F32).map(|leaf| {
        let floats = |row: &[u32]| -> Vec<f64> {
            row[words(leaf)].iter().map(|word| f64::from(f32::from_bits(*word))).collect()
        };
        let (one, other) = (floats(one), floats(other));
        let scale = one.iter().chain(&other).fold(0.0, |scale: f64, float| scale.max(float.abs()));
        let difference = largest(one.iter().zip(&other).map(|(one, other)| (one - other).abs()));
        // JSON has neither infinity nor NaN.
        if difference.is_finite() && scale.is_finite() { difference / ulp_of(scale) } else { f64::MAX }
    });
    (distances.fold(0.0, f64::max), false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_in_units_of_the_largest_component() {
        let shape = Shape::Struct(
            "Hit".to_owned(),
            vec![
                ("direction".to_owned(), Shape::Vector(3, Scalar::F32)),
                ("total".to_owned(), Shape::Scalar(Scalar::Bool)),
            ],
        );
        let row = |x: f32, total: u32| vec![x.to_bits(), 4f32.to_bits(), 0f32.to_bits(), total];
        let next = 1f32.next_up();
        assert_eq!(apart(&shape, &row(1.0, 0), &row(next, 0)), (0.25, false));
        assert_eq!(apart(&shape, &row(1.0, 0), &row(9.0, 1)), (0.0, true));
        assert_eq!(apart(&shape, &row(1.0, 0), &row(f32::NAN, 0)), (f64::MAX, false));
        assert_eq!(apart(&shape, &row(1.0, 0), &row(f32::INFINITY, 0)), (f64::MAX, false));
        let zeros = [row(0.0, 1), row(-0.0, 1)];
        assert_eq!(apart(&shape, &zeros[0], &zeros[1]), (0.0, false));
    }
}
