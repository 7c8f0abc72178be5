//! Whether a result is right: the comparison of a shader's row with the mirror's and with the oracle's, under the
//! bounds of the function's `Accuracy:` line.

use crate::cookbook::accuracy_line::{Bound, FieldBound};
use crate::dispatch::shape::{Leaf, Scalar, Shape};

/// What WGSL lets an implementation flush to zero: the smallest normal f32.
const FLUSHED: f64 = f32::MIN_POSITIVE as f64;

/// Corners of the input box that are tried where it has too many to try all.
const MOST_CORNERS: u64 = 256;

/// An oracle on numbers.
pub type OracleFn<'a> = &'a dyn Fn(&[f64], &mut Vec<f64>);

/// What comparing a row found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// Error of the shader against the oracle in ulp of the exact value's largest component, the largest over fields.
    pub ulp: f64,
    /// Error over allowed error, the largest over fields and over the three comparisons; above 1 the row fails.
    pub ratio: f64,
    /// Whether the shader returned a NaN or an infinity.
    pub nonfinite: bool,
}

impl Verdict {
    /// Whether the row is within its tolerance.
    pub fn holds(&self) -> bool {
        // Written so that a NaN ratio does not hold.
        !self.nonfinite && self.ratio <= 1.0
    }
}

/// The comparison for one function.
#[derive(Clone, Debug)]
pub struct Tolerance {
    arguments: Vec<Leaf>,
    results: Vec<(Leaf, Bound)>,
}

impl Tolerance {
    /// The tolerance for a function of these shapes. `bounds` holds one bound per field of the result, as
    /// `Accuracy::check_fields` has made sure.
    pub fn new(arguments: &[Shape], result: &Shape, bounds: &[FieldBound]) -> Tolerance {
        let arguments = Shape::Struct(String::new(), arguments.iter().map(|shape| (String::new(), shape.clone())).collect());
        let results = result
            .leaves()
            .into_iter()
            .map(|leaf| {
                let field = leaf.path.split(['.', '[']).next().unwrap_or_default().to_owned();
                let bound = bounds.iter().find(|bound| bound.field.as_deref().is_none_or(|name| name == field));
                (leaf, bound.map_or(Bound::default(), |bound| bound.bound))
            })
            .collect();
        Tolerance { arguments: arguments.leaves(), results }
    }

    /// The tolerance of a naive form on its benign domain: one relative bound on every field.
    pub fn of_benign(arguments: &[Shape], result: &Shape, relative: f64) -> Tolerance {
        let bound = Bound { relative, ..Bound::default() };
        Self::new(arguments, result, &[FieldBound { field: None, bound }])
    }

    /// Compares the shader's and the mirror's results with the exact one and with each other. `oracle` is called again only
    /// where the plain bounds do not suffice and the line allows `backward` error.
    pub fn judge(&self, arguments: &[u32], gpu: &[u32], mirror: &[u32], exact: &[f64], oracle: OracleFn<'_>) -> Verdict {
        let is_finite = |word: &u32| f32::from_bits(*word).is_finite();
        let nonfinite =
            self.floats().any(|(leaf, _)| !gpu[leaf.start..leaf.start + leaf.length].iter().all(is_finite));
        if nonfinite {
            return Verdict { ulp: f64::INFINITY, ratio: f64::INFINITY, nonfinite };
        }
        let broken_mirror =
            self.floats().any(|(leaf, _)| !mirror[leaf.start..leaf.start + leaf.length].iter().all(is_finite));
        if broken_mirror || exact.iter().any(|value| !value.is_finite()) {
            // The formula's own fault: mirror or oracle does not hold over its domain.
            return Verdict { ulp: f64::INFINITY, ratio: f64::INFINITY, nonfinite };
        }
        let ulp = self.floats().map(|(leaf, _)| in_ulps(leaf, gpu, exact)).fold(0.0, f64::max);
        let plain = self.ratio(gpu, mirror, exact, None);
        let wants_backward = plain > 1.0 && self.results.iter().any(|(_, bound)| bound.backward > 0.0);
        let ratio = if wants_backward {
            Spread::of(self, arguments, exact, gpu, mirror, oracle)
                .map_or(f64::INFINITY, |spread| self.ratio(gpu, mirror, exact, Some(&spread)))
                .min(plain)
        } else {
            plain
        };
        Verdict { ulp, ratio, nonfinite }
    }

    fn floats(&self) -> impl Iterator<Item = &(Leaf, Bound)> {
        self.results.iter().filter(|(leaf, _)| leaf.scalar == Scalar::F32)
    }

    /// The worst error over allowed error; discrete fields that differ count as infinite.
    fn ratio(&self, gpu: &[u32], mirror: &[u32], exact: &[f64], spread: Option<&Spread>) -> f64 {
        let mut worst: f64 = 0.0;
        for (leaf, bound) in &self.results {
            let range = leaf.start..leaf.start + leaf.length;
            if leaf.scalar != Scalar::F32 {
                // With a spread, the oracle has already been met at the inputs where it gives these very values.
                let differs = |words: &[u32]| {
                    range.clone().any(|index| number(leaf.scalar, words[index]) != exact[index])
                };
                if spread.is_none() && (differs(gpu) || differs(mirror)) {
                    return f64::INFINITY;
                }
                continue;
            }
            let scale = largest(&exact[range.clone()]);
            let allowed = bound.ulp * ulp_of(scale) + bound.relative * scale + bound.absolute + FLUSHED;
            let mut between: f64 = 0.0;
            let mut widest: f64 = allowed;
            for index in range {
                let (low, high) =
                    spread.map_or((exact[index], exact[index]), |spread| (spread.low[index], spread.high[index]));
                let from_gpu = f64::from(f32::from_bits(gpu[index]));
                let from_mirror = f64::from(f32::from_bits(mirror[index]));
                for value in [from_gpu, from_mirror] {
                    let outside = (low - value).max(value - high).max(0.0);
                    worst = worst.max(ratio_of(outside, allowed));
                }
                between = between.max((from_gpu - from_mirror).abs());
                widest = widest.max(allowed + (high - low));
            }
            let same_branch = spread.is_none_or(|spread| spread.gpu_and_mirror_agree);
            if same_branch {
                worst = worst.max(ratio_of(between, widest));
            }
        }
        worst
    }
}

/// A NaN in either counts as failing.
fn ratio_of(error: f64, allowed: f64) -> f64 {
    if error <= allowed { error / allowed } else if error.is_nan() { f64::INFINITY } else { error / allowed }
}

/// The range of the oracle over inputs that are off by up to `backward` ulp, among those with the same discrete results.
struct Spread {
    low: Vec<f64>,
    high: Vec<f64>,
    gpu_and_mirror_agree: bool,
}

impl Spread {
    /// Nothing where no such input gives the discrete results that the shader or the mirror gave.
    fn of(
        tolerance: &Tolerance,
        arguments: &[u32],
        exact: &[f64],
        gpu: &[u32],
        mirror: &[u32],
        oracle: OracleFn<'_>,
    ) -> Option<Spread> {
        let backward = tolerance.results.iter().map(|(_, bound)| bound.backward).fold(0.0, f64::max);
        let (centre, steps) = input_box(&tolerance.arguments, arguments, backward);
        let discrete = |words: &[u32]| -> Vec<(usize, f64)> {
            let leaves = tolerance.results.iter().filter(|(leaf, _)| leaf.scalar != Scalar::F32);
            leaves
                .flat_map(|(leaf, _)| {
                    (leaf.start..leaf.start + leaf.length).map(|index| (index, number(leaf.scalar, words[index])))
                })
                .collect()
        };
        let (from_gpu, from_mirror) = (discrete(gpu), discrete(mirror));
        let mut spread = Spread {
            low: vec![f64::INFINITY; exact.len()],
            high: vec![f64::NEG_INFINITY; exact.len()],
            gpu_and_mirror_agree: from_gpu == from_mirror,
        };
        let (mut gpu_met, mut mirror_met) = (false, false);
        let mut result = Vec::with_capacity(exact.len());
        let mut visit = |values: &[f64]| {
            result.clear();
            oracle(values, &mut result);
            if result.iter().any(|value| !value.is_finite()) {
                // The step left the oracle's domain.
                return;
            }
            let agrees = |wanted: &[(usize, f64)]| wanted.iter().all(|(index, value)| result[*index] == *value);
            let (as_gpu, as_mirror) = (agrees(&from_gpu), agrees(&from_mirror));
            gpu_met |= as_gpu;
            mirror_met |= as_mirror;
            if as_gpu || as_mirror {
                for (index, value) in result.iter().enumerate() {
                    spread.low[index] = spread.low[index].min(*value);
                    spread.high[index] = spread.high[index].max(*value);
                }
            }
        };
        let mut point = centre.clone();
        visit(&point);
        for (index, step) in steps.iter().enumerate().filter(|(_, step)| **step > 0.0) {
            for sign in [-1.0, 1.0] {
                point[index] = centre[index] + sign * step;
                visit(&point);
            }
            point[index] = centre[index];
        }
        let moving: Vec<usize> = (0..steps.len()).filter(|index| steps[*index] > 0.0).collect();
        let all = moving.len() < 8;
        let corners = if all { 1u64 << moving.len() } else { MOST_CORNERS };
        for corner in 0..corners {
            // Where there are too many corners, a fixed pseudo-random selection, each with its opposite.
            let scattered = (corner / 2 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let signs = if all { corner } else { scattered ^ (corner % 2).wrapping_neg() };
            for (bit, index) in moving.iter().enumerate() {
                let sign = if (signs >> (bit % 64)) & 1 == 0 { -1.0 } else { 1.0 };
                point[*index] = centre[*index] + sign * steps[*index];
            }
            visit(&point);
        }
        (gpu_met && mirror_met).then_some(spread)
    }
}

/// The inputs as numbers, and how far each may be off.
fn input_box(leaves: &[Leaf], words: &[u32], backward: f64) -> (Vec<f64>, Vec<f64>) {
    let mut centre = Vec::with_capacity(words.len());
    let mut steps = Vec::with_capacity(words.len());
    for leaf in leaves {
        let values: Vec<f64> =
            words[leaf.start..leaf.start + leaf.length].iter().map(|word| number(leaf.scalar, *word)).collect();
        let scale = largest(&values);
        // A subnormal may be read as zero.
        let step = if leaf.scalar == Scalar::F32 { (backward * ulp_of(scale)).max(scale.min(FLUSHED)) } else { 0.0 };
        steps.extend(std::iter::repeat_n(step, values.len()));
        centre.extend(values);
    }
    (centre, steps)
}

/// A word as the number that it stands for.
pub fn number(scalar: Scalar, word: u32) -> f64 {
    match scalar {
        Scalar::F32 => f64::from(f32::from_bits(word)),
        Scalar::I32 => f64::from(word.cast_signed()),
        Scalar::U32 => f64::from(word),
        Scalar::Bool => f64::from(u8::from(word != 0)),
    }
}

/// The unit in the last place of an f32 of this magnitude; that of the smallest normal below it.
pub fn ulp_of(magnitude: f64) -> f64 {
    if magnitude.is_nan() || magnitude < f64::from(f32::MIN_POSITIVE) {
        return 2f64.powi(-149);
    }
    // The exponent's bits alone make the power of two below `magnitude`, without a logarithm a row.
    f64::from_bits(magnitude.min(f64::from(f32::MAX)).to_bits() & 0x7ff0_0000_0000_0000) * 2f64.powi(-23)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| if value.abs() > largest || value.is_nan() { value.abs() } else { largest })
}

fn in_ulps(leaf: &Leaf, gpu: &[u32], exact: &[f64]) -> f64 {
    let range = leaf.start..leaf.start + leaf.length;
    let ulp = ulp_of(largest(&exact[range.clone()]));
    let error = range.map(|index| (f64::from(f32::from_bits(gpu[index])) - exact[index]).abs()).fold(0.0, f64::max);
    // What may be flushed is no error.
    if error <= FLUSHED { 0.0 } else { error / ulp }
}
