//! Comparison of a shader's row with the mirror's and the oracle's, within the bounds of the
//! function's `Accuracy:` line.

mod accepted;
mod numbers;
mod search;

pub use accepted::Accepted;
pub use numbers::{OracleFn, number, numbers, ulp_of, word};

use crate::accuracy_line::{Bound, FieldBound};
use crate::shape::{Leaf, Scalar, Shape};
use numbers::largest;
use search::{Effort, InputBox, Search, Spread};

/// Error allowed in every result, since WGSL lets an implementation flush numbers below the
/// smallest normal f32 to zero: once in a term, once in the result.
pub(super) const FLUSHED: f64 = 2.0 * f32::MIN_POSITIVE as f64;

/// The result of comparing a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// Error of the shader against the oracle, in ulp of the exact value's largest component; the
    /// largest over all fields.
    pub ulp: f64,
    /// Ratio of error to allowed error, the largest over all fields and the three comparisons;
    /// above 1 the row fails.
    pub ratio: f64,
    /// Whether the shader returned a NaN or an infinity.
    pub nonfinite: bool,
}

impl Verdict {
    /// Returns whether the row is within its tolerance.
    pub fn holds(&self) -> bool {
        // Written so that a NaN ratio fails.
        !self.nonfinite && self.ratio <= 1.0
    }
}

/// The allowed error of a part of a result.
#[derive(Clone, Debug)]
pub struct Allowed {
    /// The part.
    pub leaf: Leaf,
    /// Largest error of a component, whatever the input.
    pub allowed: f64,
    /// Additional error of the input, in ulp.
    pub backward: f64,
}

/// The comparison for one function.
#[derive(Clone, Debug)]
pub struct Tolerance {
    arguments: Vec<Leaf>,
    results: Vec<(Leaf, Bound)>,
}

impl Tolerance {
    /// Creates the tolerance for a function of these shapes. `bounds` holds one bound per field of
    /// the result, as ensured by `Accuracy::check_fields`.
    ///
    /// # Panics
    /// Panics if a field has no bound.
    pub fn new(arguments: &[Shape], result: &Shape, bounds: &[FieldBound]) -> Tolerance {
        let arguments =
            Shape::Struct(String::new(), arguments.iter().map(|shape| (String::new(), shape.clone())).collect());
        let results = result
            .leaves()
            .into_iter()
            .map(|leaf| {
                let field = leaf.path.split(['.', '[']).next().unwrap_or_default().to_owned();
                let bound = bounds
                    .iter()
                    .find(|bound| bound.field.as_deref().is_none_or(|name| name == field))
                    .unwrap_or_else(|| panic!("no bound for `{field}`, though Accuracy::check_fields passed"));
                (leaf, bound.bound)
            })
            .collect();
        Tolerance { arguments: arguments.leaves(), results }
    }

    /// Creates the tolerance of a naive form on its benign domain: one relative bound on every
    /// field.
    pub fn of_benign(arguments: &[Shape], result: &Shape, relative: f64) -> Tolerance {
        let bound = Bound { relative, ..Bound::default() };
        Self::new(arguments, result, &[FieldBound { field: None, bound }])
    }

    /// Compares the shader's and the mirror's results with the exact one and with each other.
    /// `oracle` is called again only if the plain bounds do not suffice and the line allows
    /// `backward` error.
    pub fn judge(
        &self,
        arguments: &[u32],
        gpu: &[u32],
        mirror: &[u32],
        exact: &[f64],
        oracle: OracleFn<'_>,
    ) -> Verdict {
        self.judge_by(&[Effort::Corners, Effort::Boundaries], arguments, [gpu, mirror], exact, oracle)
    }

    /// Judges like [`Tolerance::judge`]; for a row found wrong, adds a search that costs some ten
    /// thousand more calls of `oracle`.
    pub fn judge_thoroughly(
        &self,
        arguments: &[u32],
        gpu: &[u32],
        mirror: &[u32],
        exact: &[f64],
        oracle: OracleFn<'_>,
    ) -> Verdict {
        let efforts = [Effort::Corners, Effort::Boundaries, Effort::Starts];
        self.judge_by(&efforts, arguments, [gpu, mirror], exact, oracle)
    }

    fn judge_by(
        &self,
        efforts: &[Effort],
        arguments: &[u32],
        [gpu, mirror]: [&[u32]; 2],
        exact: &[f64],
        oracle: OracleFn<'_>,
    ) -> Verdict {
        let is_finite = |word: &u32| f32::from_bits(*word).is_finite();
        let nonfinite = self.floats().any(|(leaf, _)| !gpu[leaf.start..leaf.start + leaf.length].iter().all(is_finite));
        if nonfinite {
            return Verdict { ulp: f64::INFINITY, ratio: f64::INFINITY, nonfinite };
        }
        let broken_mirror =
            self.floats().any(|(leaf, _)| !mirror[leaf.start..leaf.start + leaf.length].iter().all(is_finite));
        if broken_mirror || exact.iter().any(|value| !value.is_finite()) {
            // A fault of the formula itself: mirror or oracle does not hold over its domain.
            return Verdict { ulp: f64::INFINITY, ratio: f64::INFINITY, nonfinite };
        }
        // After a discrete difference the floats belong to another case, and their distance means
        // nothing.
        let ulp = if self.discrete_fields_agree(gpu, exact, |_| true) {
            self.floats().map(|(leaf, _)| in_ulps(leaf, gpu, exact)).fold(0.0, f64::max)
        } else {
            0.0
        };
        let plain = self.ratio(gpu, mirror, exact, None);
        let mut ratio = plain;
        if plain > 1.0 && self.backward() > 0.0 {
            let inputs = InputBox::new(&self.arguments, arguments, self.backward());
            let judge = |spread: &Spread| self.ratio(gpu, mirror, exact, Some(spread));
            let mut search = Search::new(self.backward_places(), gpu, mirror, oracle);
            for effort in efforts {
                if ratio > 1.0 {
                    search.look(*effort, &inputs, [gpu, mirror], |spread| judge(spread) <= 1.0);
                    ratio = search.spread().map_or(ratio, |spread| ratio.min(judge(spread)));
                }
            }
        }
        Verdict { ulp, ratio, nonfinite }
    }

    /// Returns the allowed error of each part of a result against the exact one, by the plain
    /// bounds.
    pub fn allowed(&self, exact: &[f64]) -> Vec<Allowed> {
        let allowed_of = |(leaf, bound): &(Leaf, Bound)| {
            let scale = largest(&exact[leaf.start..leaf.start + leaf.length]);
            let allowed = match leaf.scalar {
                Scalar::F32 => forward(bound, scale),
                _ => 0.0,
            };
            Allowed { leaf: leaf.clone(), allowed, backward: bound.backward }
        };
        self.results.iter().map(allowed_of).collect()
    }

    /// Returns the ratio of a result's error to the allowed error, without the `backward`
    /// allowance; infinite if a discrete field differs.
    pub fn forward(&self, result: &[u32], exact: &[f64]) -> f64 {
        self.ratio(result, result, exact, None)
    }

    /// Returns whether two of the oracle's results differ in a bool or an integer.
    pub fn discrete_differ(&self, one: &[f64], other: &[f64]) -> bool {
        let discrete = self.results.iter().filter(|(leaf, _)| leaf.scalar != Scalar::F32);
        discrete.flat_map(|(leaf, _)| leaf.start..leaf.start + leaf.length).any(|index| one[index] != other[index])
    }

    /// Returns the distance between two of the oracle's results, if it exceeds the combined error
    /// of a correct result for each, at least an ulp each, without the `backward` allowance; the
    /// largest over fields.
    pub fn apart(&self, one: &[f64], other: &[f64]) -> Option<f64> {
        let excess = self.floats().filter_map(|(leaf, bound)| {
            let range = leaf.start..leaf.start + leaf.length;
            let scale = largest(&one[range.clone()]).max(largest(&other[range.clone()]));
            let allowed = forward(bound, scale).max(ulp_of(scale));
            let difference = range.map(|index| (one[index] - other[index]).abs()).fold(0.0, f64::max);
            (difference > 2.0 * allowed).then_some(difference)
        });
        excess.reduce(f64::max)
    }

    /// Returns the names of the float parts of a result, and whether each must be exact.
    pub fn fields(&self) -> impl Iterator<Item = (&str, bool)> {
        self.floats().map(|(leaf, bound)| (leaf.path.as_str(), *bound == Bound::default()))
    }

    /// Returns the allowed error of each float part for these arguments, including the `backward`
    /// allowance to first order. `derivatives` holds the derivatives of each word of the result
    /// with respect to each word of the arguments. Returns `None` if an error is not finite.
    pub fn stated(&self, arguments: &[u32], exact: &[f64], derivatives: &[Vec<f64>]) -> Option<Vec<f64>> {
        // The ulp of the input's largest component, for each of its words.
        let mut units = vec![0.0; arguments.len()];
        for leaf in self.arguments.iter().filter(|leaf| leaf.scalar == Scalar::F32) {
            let range = leaf.start..leaf.start + leaf.length;
            let floats: Vec<f64> = arguments[range.clone()].iter().map(|word| number(leaf.scalar, *word)).collect();
            units[range].fill(ulp_of(largest(&floats)));
        }
        let spread: Vec<f64> = derivatives
            .iter()
            .map(|by| by.iter().zip(&units).map(|(derivative, unit)| (derivative * unit).abs()).sum())
            .collect();
        let stated = |(leaf, bound): &(Leaf, Bound)| {
            let range = leaf.start..leaf.start + leaf.length;
            let backward = if bound.backward > 0.0 { bound.backward * largest(&spread[range.clone()]) } else { 0.0 };
            Some(forward(bound, largest(&exact[range])) + backward).filter(|stated| stated.is_finite())
        };
        self.floats().map(stated).collect()
    }

    /// Returns the largest of these numbers in each float part; there is one number for each word
    /// of the result.
    pub fn largest_of_parts(&self, numbers: &[f64]) -> Vec<f64> {
        self.floats().map(|(leaf, _)| largest(&numbers[leaf.start..leaf.start + leaf.length])).collect()
    }

    fn floats(&self) -> impl Iterator<Item = &(Leaf, Bound)> {
        self.results.iter().filter(|(leaf, _)| leaf.scalar == Scalar::F32)
    }

    /// Returns whether the discrete fields equal the oracle's, for the bounds that `concerns`
    /// selects.
    fn discrete_fields_agree(&self, words: &[u32], exact: &[f64], concerns: impl Fn(&Bound) -> bool) -> bool {
        self.results.iter().filter(|(leaf, bound)| leaf.scalar != Scalar::F32 && concerns(bound)).all(|(leaf, _)| {
            (leaf.start..leaf.start + leaf.length).all(|index| number(leaf.scalar, words[index]) == exact[index])
        })
    }

    /// Returns the places of the discrete results with a backward bound.
    fn backward_places(&self) -> Vec<(usize, Scalar)> {
        let discrete = self.results.iter().filter(|(leaf, bound)| leaf.scalar != Scalar::F32 && bound.backward > 0.0);
        discrete
            .flat_map(|(leaf, _)| (leaf.start..leaf.start + leaf.length).map(|index| (index, leaf.scalar)))
            .collect()
    }

    /// Returns the largest backward bound of any field.
    fn backward(&self) -> f64 {
        self.results.iter().map(|(_, bound)| bound.backward).fold(0.0, f64::max)
    }

    /// Returns the largest ratio of error to allowed error; a differing discrete field counts as
    /// infinite.
    fn ratio(&self, gpu: &[u32], mirror: &[u32], exact: &[f64], spread: Option<&Spread>) -> f64 {
        // With a spread, the search has already found inputs at which the oracle gives these very
        // discrete values, as far as their fields allow backward error.
        let agree = |words: &[u32]| match spread {
            None => self.discrete_fields_agree(words, exact, |_| true),
            Some(_) => self.discrete_fields_agree(words, exact, |bound| bound.backward == 0.0),
        };
        if !agree(gpu) || !agree(mirror) {
            return f64::INFINITY;
        }
        let mut worst: f64 = 0.0;
        for (leaf, bound) in self.floats() {
            let window = Window::new(leaf, bound, exact, spread);
            let mut between: f64 = 0.0;
            for index in 0..leaf.length {
                let from_gpu = f64::from(f32::from_bits(gpu[leaf.start + index]));
                let from_mirror = f64::from(f32::from_bits(mirror[leaf.start + index]));
                for value in [from_gpu, from_mirror] {
                    worst = worst.max(window.ratio(index, value));
                }
                between = between.max((from_gpu - from_mirror).abs());
            }
            if spread.is_none_or(|spread| spread.gpu_and_mirror_agree) {
                worst = worst.max(ratio_of(between, window.allowed + 2.0 * window.half));
            }
        }
        worst
    }
}

/// What a float part of a result may be: the oracle's range, and the error allowed beyond it.
struct Window<'a> {
    low: &'a [f64],
    high: &'a [f64],
    /// Half the range of the component that varies most. As a vector's ulp is that of its largest component, so
    /// its range is that component's.
    half: f64,
    allowed: f64,
}

impl<'a> Window<'a> {
    fn new(leaf: &Leaf, bound: &Bound, exact: &'a [f64], spread: Option<&'a Spread>) -> Self {
        let range = leaf.start..leaf.start + leaf.length;
        let (low, high) = match spread.filter(|_| bound.backward > 0.0) {
            Some(spread) => (&spread.low[range.clone()], &spread.high[range]),
            None => (&exact[range.clone()], &exact[range]),
        };
        let half = low.iter().zip(high).map(|(low, high)| 0.5 * (high - low)).fold(0.0, f64::max);
        Self { low, high, half, allowed: forward(bound, largest(low).max(largest(high))) }
    }

    fn middle(&self, index: usize) -> f64 {
        0.5 * (self.low[index] + self.high[index])
    }

    /// Returns the ratio of a component's error to the allowed error.
    fn ratio(&self, index: usize, value: f64) -> f64 {
        ratio_of(((value - self.middle(index)).abs() - self.half).max(0.0), self.allowed)
    }
}

/// Returns error over allowed error; a NaN in either counts as failing.
fn ratio_of(error: f64, allowed: f64) -> f64 {
    if error <= allowed || error > allowed { error / allowed } else { f64::INFINITY }
}

/// Returns the allowed error of a component if the exact value's largest one is `scale`, without
/// the `backward` allowance.
fn forward(bound: &Bound, scale: f64) -> f64 {
    bound.ulp * ulp_of(scale) + bound.relative * scale + bound.absolute + FLUSHED
}

fn in_ulps(leaf: &Leaf, gpu: &[u32], exact: &[f64]) -> f64 {
    let range = leaf.start..leaf.start + leaf.length;
    let ulp = ulp_of(largest(&exact[range.clone()]));
    let error = range.map(|index| (f64::from(f32::from_bits(gpu[index])) - exact[index]).abs()).fold(0.0, f64::max);
    // A difference that flushing may cause is no error.
    if error <= FLUSHED { 0.0 } else { error / ulp }
}
