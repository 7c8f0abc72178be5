//! Whether a result is right: the comparison of a shader's row with the mirror's and with the oracle's, under the
//! bounds of the function's `Accuracy:` line.

use super::draws::mix;
use crate::cookbook::accuracy_line::{Bound, FieldBound};
use crate::dispatch::shape::{Leaf, Scalar, Shape};
use crate::golden_section::golden_section;
use std::convert::Infallible;

/// What WGSL lets an implementation flush to zero: the smallest normal f32.
const FLUSHED: f64 = f32::MIN_POSITIVE as f64;

/// Corners of the input box that are tried where it has too many to try all, at first and once more in earnest.
const MOST_CORNERS: [u64; 2] = [256, 1024];

/// Halvings on the way to where a discrete result changes: finer than f32 resolves within the box.
const BISECTIONS: usize = 30;

/// Steps of a golden-section search along one input: it finds a place to 2⁻¹⁴ of the box's width, an extremum to the square of that.
const SECTIONS: usize = 20;

/// Rounds over all inputs on the way to an extremum inside the box.
const ROUNDS: usize = 6;

/// Places along an input, its ends included, that tell where an extremum may lie: a function may have several, and the least may be at an end.
const PLACES: usize = 9;

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
        let wants_backward = plain > 1.0 && self.results.iter().any(|(_, bound)| bound.backward > 0.0);
        let mut ratio = plain;
        for effort in [Effort::Corners, Effort::Boundaries] {
            if wants_backward && ratio > 1.0 {
                let (centre, steps) = input_box(&self.arguments, arguments, self.backward());
                let mut search = Search::new(self, gpu, mirror, oracle);
                search.ends = (effort == Effort::Boundaries).then(|| vec![Default::default(); exact.len()]);
                let judge = |spread: &Spread| self.ratio(gpu, mirror, exact, Some(spread));
                search.run(effort, &centre, &steps, |spread| judge(spread) <= 1.0);
                if effort == Effort::Boundaries && judge(&search.spread) > 1.0 {
                    search.extrema(&centre, &steps, [gpu, mirror], |spread| judge(spread) <= 1.0);
                }
                if search.met == [true; 2] {
                    ratio = ratio.min(judge(&search.spread));
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
    /// right for the other, without what `backward` allows; the largest over fields.
    pub fn apart(&self, one: &[f64], other: &[f64]) -> Option<f64> {
        let excess = self.floats().filter_map(|(leaf, bound)| {
            let range = leaf.start..leaf.start + leaf.length;
            let scale = largest(&one[range.clone()]).max(largest(&other[range.clone()]));
            let allowed = forward(bound, scale);
            let apart = range.map(|index| (one[index] - other[index]).abs()).fold(0.0, f64::max);
            (apart > 2.0 * allowed).then_some(apart)
        });
        excess.reduce(f64::max)
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
    if error <= allowed {
        error / allowed
    } else if error.is_nan() {
        f64::INFINITY
    } else {
        error / allowed
    }
}

/// How hard to look for the oracle's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Effort {
    /// The corners of the box and the middles of its faces.
    Corners,
    /// More corners, and on the way from each to the next every place where a discrete result changes: the rounded result may well lie
    /// right there. Then the extrema inside the box.
    Boundaries,
}

/// The range of the oracle over inputs that are off by up to `backward` ulp, among those with the same discrete results.
struct Spread {
    low: Vec<f64>,
    high: Vec<f64>,
    gpu_and_mirror_agree: bool,
}

/// The oracle's discrete results at a point; none where the point is outside of its domain.
type Case = Option<Vec<f64>>;

/// A search for the oracle's range in the box about an input.
struct Search<'a> {
    oracle: OracleFn<'a>,
    /// Where the discrete results are.
    places: Vec<(usize, Scalar)>,
    /// The shader's discrete results and the mirror's.
    wanted: [Vec<f64>; 2],
    /// Whether the oracle has given them.
    met: [bool; 2],
    /// The range over the points where it gave either.
    spread: Spread,
    /// Where each result was least and where it was greatest, once a search for extrema may start from there.
    ends: Option<Vec<[Vec<f64>; 2]>>,
    result: Vec<f64>,
}

impl<'a> Search<'a> {
    fn new(tolerance: &Tolerance, gpu: &[u32], mirror: &[u32], oracle: OracleFn<'a>) -> Self {
        let places: Vec<(usize, Scalar)> = tolerance
            .results
            .iter()
            .filter(|(leaf, bound)| leaf.scalar != Scalar::F32 && bound.backward > 0.0)
            .flat_map(|(leaf, _)| (leaf.start..leaf.start + leaf.length).map(|index| (index, leaf.scalar)))
            .collect();
        let discrete = |words: &[u32]| -> Vec<f64> {
            places.iter().map(|(index, scalar)| number(*scalar, words[*index])).collect()
        };
        let wanted = [discrete(gpu), discrete(mirror)];
        let spread = Spread {
            low: vec![f64::INFINITY; gpu.len()],
            high: vec![f64::NEG_INFINITY; gpu.len()],
            gpu_and_mirror_agree: wanted[0] == wanted[1],
        };
        Self { oracle, places, wanted, met: [false; 2], spread, ends: None, result: Vec::with_capacity(gpu.len()) }
    }

    /// Asks the oracle at a point.
    fn visit(&mut self, point: &[f64]) -> Case {
        self.result.clear();
        (self.oracle)(point, &mut self.result);
        if self.result.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let found: Vec<f64> = self.places.iter().map(|(index, _)| self.result[*index]).collect();
        let agrees = [found == self.wanted[0], found == self.wanted[1]];
        self.met = [self.met[0] | agrees[0], self.met[1] | agrees[1]];
        if agrees[0] || agrees[1] {
            for (index, value) in self.result.iter().enumerate() {
                let below = *value < self.spread.low[index];
                let above = *value > self.spread.high[index];
                self.spread.low[index] = self.spread.low[index].min(*value);
                self.spread.high[index] = self.spread.high[index].max(*value);
                if let Some(ends) = &mut self.ends {
                    for end in [below, above].iter().zip(&mut ends[index]).filter_map(|(is, end)| is.then_some(end)) {
                        point.clone_into(end);
                    }
                }
            }
        }
        Some(found)
    }

    /// Visits both sides of every change of the discrete results between two points of the way from `from` to `to`, as far
    /// as `halvings` tell them apart.
    fn boundaries(&mut self, from: &[f64], to: &[f64], near: (f64, &Case), far: (f64, &Case), halvings: usize) {
        if near.1 == far.1 || halvings == 0 {
            return;
        }
        let middle = 0.5 * (near.0 + far.0);
        let point: Vec<f64> = from.iter().zip(to).map(|(from, to)| from + middle * (to - from)).collect();
        let found = self.visit(&point);
        self.boundaries(from, to, near, (middle, &found), halvings - 1);
        self.boundaries(from, to, (middle, &found), far, halvings - 1);
    }

    /// Extends the range towards each result that lies beside it, by less than its width: a function that does not go on rising, such
    /// as a square, has its extremum inside the box and not at a corner.
    fn extrema(&mut self, centre: &[f64], steps: &[f64], results: [&[u32]; 2], enough: impl Fn(&Spread) -> bool) {
        for words in results {
            for (index, word) in words.iter().enumerate() {
                // Of a discrete result the bits are no number to approach; as one they lie far from the range.
                let value = f64::from(f32::from_bits(*word));
                let (low, high) = (self.spread.low[index], self.spread.high[index]);
                if value < low && low - value < high - low {
                    self.descend(centre, steps, (index, 1.0), &enough);
                } else if value > high && value - high < high - low {
                    self.descend(centre, steps, (index, -1.0), &enough);
                }
            }
        }
    }

    /// Lowers `sign` times result `index` along one input after another, from where it is lowest so far: at the best of places from end to end, then
    /// by golden-section search between that one's neighbours.
    fn descend(
        &mut self,
        centre: &[f64],
        steps: &[f64],
        (index, sign): (usize, f64),
        enough: &impl Fn(&Spread) -> bool,
    ) {
        let known = self.ends.as_ref().map(|ends| ends[index][usize::from(sign < 0.0)].clone());
        let mut point = known.filter(|point| point.len() == centre.len()).unwrap_or_else(|| centre.to_vec());
        let mut lowest = f64::INFINITY;
        for _ in 0..ROUNDS {
            let before = lowest;
            for moving in (0..steps.len()).filter(|moving| steps[*moving] > 0.0) {
                let start = point[moving];
                let mut at = |search: &mut Self, place: f64| {
                    point[moving] = place;
                    // Where the discrete results are others, it is another function's value.
                    let found = search.visit(&point);
                    let wanted = found.is_some_and(|found| search.wanted.contains(&found));
                    if wanted { sign * search.result[index] } else { f64::INFINITY }
                };
                let mut best = (at(self, start), start);
                let mut consider = |value: f64, place: f64| {
                    if value < best.0 {
                        best = (value, place);
                    }
                };
                let place =
                    |number: usize| centre[moving] + steps[moving] * (2.0 * number as f64 / (PLACES - 1) as f64 - 1.0);
                let values: Vec<f64> = (0..PLACES).map(|number| at(self, place(number))).collect();
                let least = (0..PLACES).min_by(|one, other| values[*one].total_cmp(&values[*other])).unwrap_or(0);
                consider(values[least], place(least));
                let across = [place(least.saturating_sub(1)), place((least + 1).min(PLACES - 1))];
                let Ok(nearest) = golden_section::<Infallible>(across, SECTIONS, |place| Ok(at(self, place)));
                consider(at(self, nearest), nearest);
                (lowest, point[moving]) = best;
                if enough(&self.spread) {
                    return;
                }
            }
            // Nothing moves any more.
            if lowest >= before {
                return;
            }
        }
    }

    /// Searches the corners of the box of `steps` about `centre` and the middles of its faces, until `enough`.
    fn run(&mut self, effort: Effort, centre: &[f64], steps: &[f64], enough: impl Fn(&Spread) -> bool) {
        // From corner to corner, not out from the centre: all lines through one point cross a boundary near that point.
        let mut previous = centre.to_vec();
        let mut at_previous = self.visit(centre);
        let mut walk = |search: &mut Self, point: &[f64]| -> bool {
            let at_point = search.visit(point);
            if effort == Effort::Boundaries {
                search.boundaries(&previous, point, (0.0, &at_previous), (1.0, &at_point), BISECTIONS);
                previous.copy_from_slice(point);
                at_previous = at_point;
            }
            search.met[0] && search.met[1] && enough(&search.spread)
        };
        let moving: Vec<usize> = (0..steps.len()).filter(|index| steps[*index] > 0.0).collect();
        let mut point = centre.to_vec();
        for index in &moving {
            for sign in [-1.0, 1.0] {
                point[*index] = centre[*index] + sign * steps[*index];
                if walk(self, &point) {
                    return;
                }
            }
            point[*index] = centre[*index];
        }
        let most = MOST_CORNERS[effort as usize];
        let all = 1u64.checked_shl(moving.len() as u32).is_some_and(|corners| corners <= most);
        let corners = if all { 1u64 << moving.len() } else { most };
        for corner in 0..corners {
            // Where there are too many corners, a fixed pseudo-random selection.
            let signs = if all { corner } else { mix(corner) };
            for (bit, index) in moving.iter().enumerate() {
                let sign = if (signs >> (bit % 64)) & 1 == 0 { -1.0 } else { 1.0 };
                point[*index] = centre[*index] + sign * steps[*index];
            }
            if walk(self, &point) {
                return;
            }
        }
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
        // Zero is exact; a subnormal may be read as zero.
        let step = match leaf.scalar {
            Scalar::F32 if scale >= FLUSHED => backward * ulp_of(scale),
            Scalar::F32 => scale,
            _ => 0.0,
        };
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

/// How far a component may be off where the exact value's largest is `scale`, without what `backward` allows.
fn forward(bound: &Bound, scale: f64) -> f64 {
    bound.ulp * ulp_of(scale) + bound.relative * scale + bound.absolute + FLUSHED
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
