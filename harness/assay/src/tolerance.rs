//! Whether a result is right: the comparison of a shader's row with the mirror's and with the oracle's, under the
//! bounds of the function's `Accuracy:` line.

mod search;

use crate::accuracy_line::{Bound, FieldBound};
use crate::shape::{Leaf, Scalar, Shape};
use search::{Effort, InputBox, Search, Spread};

/// What is forgiven of every result, since WGSL lets an implementation flush what is below the smallest normal f32 to zero: once in a term, once in the result.
pub(super) const FLUSHED: f64 = 2.0 * f32::MIN_POSITIVE as f64;

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

/// How far a part of a result may be off.
#[derive(Clone, Debug)]
pub struct Allowed {
    /// The part.
    pub leaf: Leaf,
    /// The largest error of a component, whatever the input.
    pub allowed: f64,
    /// By how many ulp the input may be off besides.
    pub backward: f64,
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
    ///
    /// # Panics
    /// Where a field has none.
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

    /// The tolerance of a naive form on its benign domain: one relative bound on every field.
    pub fn of_benign(arguments: &[Shape], result: &Shape, relative: f64) -> Tolerance {
        let bound = Bound { relative, ..Bound::default() };
        Self::new(arguments, result, &[FieldBound { field: None, bound }])
    }

    /// Compares the shader's and the mirror's results with the exact one and with each other. `oracle` is called again only
    /// where the plain bounds do not suffice and the line allows `backward` error.
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

    /// [`Tolerance::judge`] with a search that costs some ten thousand calls of `oracle` more, for rows that it finds wrong.
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
            // The formula's own fault: mirror or oracle does not hold over its domain.
            return Verdict { ulp: f64::INFINITY, ratio: f64::INFINITY, nonfinite };
        }
        // Beyond a discrete difference the floats belong to another case, and their distance says nothing.
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

    /// How far each part of a result may be off from the exact one, by the plain bounds.
    pub fn allowed(&self, exact: &[f64]) -> Vec<Allowed> {
        let of = |(leaf, bound): &(Leaf, Bound)| {
            let scale = largest(&exact[leaf.start..leaf.start + leaf.length]);
            let allowed = match leaf.scalar {
                Scalar::F32 => forward(bound, scale),
                _ => 0.0,
            };
            Allowed { leaf: leaf.clone(), allowed, backward: bound.backward }
        };
        self.results.iter().map(of).collect()
    }

    /// A result's error over the allowed one, without what `backward` allows; infinite where a discrete field differs.
    pub fn forward(&self, result: &[u32], exact: &[f64]) -> f64 {
        self.ratio(result, result, exact, None)
    }

    /// Whether two of the oracle's results differ in a bool or an integer.
    pub fn discrete_differ(&self, one: &[f64], other: &[f64]) -> bool {
        let discrete = self.results.iter().filter(|(leaf, _)| leaf.scalar != Scalar::F32);
        discrete.flat_map(|(leaf, _)| leaf.start..leaf.start + leaf.length).any(|index| one[index] != other[index])
    }

    /// By how much two of the oracle's results are apart, where that is more than a result that is right for one may be off and one that is
    /// right for the other, an ulp each at least, without what `backward` allows; the largest over fields.
    pub fn apart(&self, one: &[f64], other: &[f64]) -> Option<f64> {
        let excess = self.floats().filter_map(|(leaf, bound)| {
            let range = leaf.start..leaf.start + leaf.length;
            let scale = largest(&one[range.clone()]).max(largest(&other[range.clone()]));
            let allowed = forward(bound, scale).max(ulp_of(scale));
            let apart = range.map(|index| (one[index] - other[index]).abs()).fold(0.0, f64::max);
            (apart > 2.0 * allowed).then_some(apart)
        });
        excess.reduce(f64::max)
    }

    /// The names of the parts of a result that are floats, and whether each is to be exact.
    pub fn fields(&self) -> impl Iterator<Item = (&str, bool)> {
        self.floats().map(|(leaf, bound)| (leaf.path.as_str(), *bound == Bound::default()))
    }

    /// Of each part that is floats, how far it may be off for these arguments, what `backward` allows included to first order: `derivatives` holds those of each word of
    /// the result by each word of the arguments. None where that is not finite.
    pub fn stated(&self, arguments: &[u32], exact: &[f64], derivatives: &[Vec<f64>]) -> Option<Vec<f64>> {
        // The unit of the input's largest component, for each of its words.
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

    /// Of each part that is floats, the largest of these numbers, one for each word of the result.
    pub fn largest_of_parts(&self, numbers: &[f64]) -> Vec<f64> {
        self.floats().map(|(leaf, _)| largest(&numbers[leaf.start..leaf.start + leaf.length])).collect()
    }

    fn floats(&self) -> impl Iterator<Item = &(Leaf, Bound)> {
        self.results.iter().filter(|(leaf, _)| leaf.scalar == Scalar::F32)
    }

    /// Whether the discrete fields with a bound that `concerns` says are the oracle's.
    fn discrete_fields_agree(&self, words: &[u32], exact: &[f64], concerns: impl Fn(&Bound) -> bool) -> bool {
        self.results.iter().filter(|(leaf, bound)| leaf.scalar != Scalar::F32 && concerns(bound)).all(|(leaf, _)| {
            (leaf.start..leaf.start + leaf.length).all(|index| number(leaf.scalar, words[index]) == exact[index])
        })
    }

    /// Where the discrete results with a backward bound are.
    fn backward_places(&self) -> Vec<(usize, Scalar)> {
        let discrete = self.results.iter().filter(|(leaf, bound)| leaf.scalar != Scalar::F32 && bound.backward > 0.0);
        discrete
            .flat_map(|(leaf, _)| (leaf.start..leaf.start + leaf.length).map(|index| (index, leaf.scalar)))
            .collect()
    }

    /// The largest backward bound of any field.
    fn backward(&self) -> f64 {
        self.results.iter().map(|(_, bound)| bound.backward).fold(0.0, f64::max)
    }

    /// The worst error over allowed error; discrete fields that differ count as infinite.
    fn ratio(&self, gpu: &[u32], mirror: &[u32], exact: &[f64], spread: Option<&Spread>) -> f64 {
        // With a spread, the oracle has already been met at the inputs where it gives these very discrete values, as far as
        // their fields allow backward error.
        let agree = |words: &[u32]| match spread {
            None => self.discrete_fields_agree(words, exact, |_| true),
            Some(_) => self.discrete_fields_agree(words, exact, |bound| bound.backward == 0.0),
        };
        if !agree(gpu) || !agree(mirror) {
            return f64::INFINITY;
        }
        let mut worst: f64 = 0.0;
        for (leaf, bound) in self.floats() {
            let range = leaf.start..leaf.start + leaf.length;
            let (low, high) = match spread.filter(|_| bound.backward > 0.0) {
                Some(spread) => (&spread.low[range.clone()], &spread.high[range.clone()]),
                None => (&exact[range.clone()], &exact[range.clone()]),
            };
            // As a vector's ulp is that of its largest component, so its range is that of the component that varies most.
            let half = low.iter().zip(high).map(|(low, high)| 0.5 * (high - low)).fold(0.0, f64::max);
            let scale = largest(low).max(largest(high));
            let allowed = forward(bound, scale);
            let mut between: f64 = 0.0;
            for (index, (low, high)) in range.zip(low.iter().zip(high)) {
                let middle = 0.5 * (low + high);
                let from_gpu = f64::from(f32::from_bits(gpu[index]));
                let from_mirror = f64::from(f32::from_bits(mirror[index]));
                for value in [from_gpu, from_mirror] {
                    worst = worst.max(ratio_of(((value - middle).abs() - half).max(0.0), allowed));
                }
                between = between.max((from_gpu - from_mirror).abs());
            }
            if spread.is_none_or(|spread| spread.gpu_and_mirror_agree) {
                worst = worst.max(ratio_of(between, allowed + 2.0 * half));
            }
        }
        worst
    }
}

/// A NaN in either counts as failing.
fn ratio_of(error: f64, allowed: f64) -> f64 {
    if error <= allowed || error > allowed { error / allowed } else { f64::INFINITY }
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

/// A value's words as the numbers that they stand for.
pub fn numbers(shape: &Shape, words: &[u32]) -> Vec<f64> {
    words.iter().zip(shape.scalars()).map(|(word, scalar)| number(scalar, *word)).collect()
}

/// The word nearest to a number.
pub fn word(kind: Scalar, number: f64) -> u32 {
    match kind {
        Scalar::F32 => (number as f32).to_bits(),
        Scalar::I32 => (number as i32).cast_unsigned(),
        Scalar::U32 => number as u32,
        Scalar::Bool => u32::from(number != 0.0),
    }
}

/// How far a component may be off where the exact value's largest is `scale`, without what `backward` allows.
fn forward(bound: &Bound, scale: f64) -> f64 {
    bound.ulp * ulp_of(scale) + bound.relative * scale + bound.absolute + FLUSHED
}

/// The unit in the last place of an f32 of this size, whatever its sign; that of the smallest normal below it.
pub fn ulp_of(value: f64) -> f64 {
    let magnitude = value.abs();
    if magnitude.is_nan() || magnitude < f64::from(f32::MIN_POSITIVE) {
        return 2f64.powi(-149);
    }
    // The exponent's bits alone make the power of two below `magnitude`, without a logarithm a row.
    f64::from_bits(magnitude.min(f64::from(f32::MAX)).to_bits() & 0x7ff0_0000_0000_0000) * 2f64.powi(-23)
}

pub(super) fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |largest, value| if value.abs() > largest || value.is_nan() { value.abs() } else { largest })
}

fn in_ulps(leaf: &Leaf, gpu: &[u32], exact: &[f64]) -> f64 {
    let range = leaf.start..leaf.start + leaf.length;
    let ulp = ulp_of(largest(&exact[range.clone()]));
    let error = range.map(|index| (f64::from(f32::from_bits(gpu[index])) - exact[index]).abs()).fold(0.0, f64::max);
    // What may be flushed is no error.
    if error <= FLUSHED { 0.0 } else { error / ulp }
}
