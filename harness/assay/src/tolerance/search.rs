//! Range of an oracle over inputs within the `backward` allowance: corners of the box around the
//! input, places at which a discrete result changes, and extrema.

use super::numbers::{OracleFn, largest, number, ulp_of};
use crate::draws::mix;
use crate::golden_section::golden_section;
use crate::shape::{Leaf, Scalar};
use std::convert::Infallible;

/// Number of corners tried if the input box has too many to try all: in the first pass, and in a
/// second, more thorough one.
const MOST_CORNERS: [u64; 2] = [256, 1024];

/// Bisections towards a change of a discrete result: finer than f32 resolves within the box.
const BISECTIONS: usize = 30;

/// Steps of a golden-section search along one input. They find a place to 2⁻¹⁶ of the box's width,
/// and an extremum to the square of that accuracy.
const SECTIONS: usize = 20;

/// Rounds over all inputs in the search for an extremum.
const ROUNDS: usize = 6;

/// Places along an input, including its ends, that show where an extremum may lie: a function may
/// have several, and the least may be at an end.
const PLACES: usize = 9;

/// Starting places of [`Effort::Starts`]: from a single place, a search ends in the nearest of
/// several extrema.
const STARTS: u64 = 24;

/// Places per start that are visited first, for a case that few of them lie in.
const PLACES_PER_START: u64 = 512;

/// Places visited in a box in which the function bends, when the whole range is sought.
const PLACES_WHERE_IT_BENDS: u64 = 4096;

/// Largest distance of a linear function's result at the centre from the middle of its range, as a share of the
/// range: roundings of the oracle, and the little by which any smooth function bends.
const LINEAR: f64 = 1.0 / 64.0;

/// Fraction of the box's half width by which the inputs are moved to either side to find the
/// direction in which a result falls.
const SLOPE: f64 = 1.0 / 64.0;

/// The effort in the search for the oracle's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// The corners of the box and the middles of its faces.
    Corners,
    /// More corners, and every change of a discrete result on the way from one to the next, since
    /// the rounded result may well lie right there. Then the extrema, from the best place so far.
    Boundaries,
    /// The extrema again, from many places, for the few rows that still exceed their bounds.
    Starts,
}

/// The range of the oracle over inputs that are off by up to `backward` ulp, among those with the
/// same discrete results.
pub struct Spread {
    /// Least value of each result.
    pub low: Vec<f64>,
    /// Greatest value of each result.
    pub high: Vec<f64>,
    /// Whether shader and mirror found the same case.
    pub gpu_and_mirror_agree: bool,
}

/// The oracle's discrete results at a point; `None` if the point is outside its domain.
type Case = Option<Vec<f64>>;

/// A search for the oracle's range in the box around an input.
pub struct Search<'a> {
    oracle: OracleFn<'a>,
    /// Places of the discrete results.
    places: Vec<(usize, Scalar)>,
    /// Discrete results of the shader and of the mirror.
    wanted: [Vec<f64>; 2],
    /// Whether the oracle has given each of them.
    met: [bool; 2],
    /// Range over the points at which the oracle gave either.
    spread: Spread,
    /// Points of the least and the greatest value of each result, from which a search for extrema
    /// starts.
    ends: Vec<[Vec<f64>; 2]>,
    /// Up to so many other cases that the oracle gave.
    others: Vec<Vec<f64>>,
    most_others: usize,
    result: Vec<f64>,
}

impl<'a> Search<'a> {
    /// Creates a search for the cases that shader and mirror found: the results at `places`.
    pub fn new(places: Vec<(usize, Scalar)>, gpu: &[u32], mirror: &[u32], oracle: OracleFn<'a>) -> Self {
        let discrete = |words: &[u32]| -> Vec<f64> {
            places.iter().map(|(index, scalar)| number(*scalar, words[*index])).collect()
        };
        let wanted = [discrete(gpu), discrete(mirror)];
        Self::of_cases(places, wanted, gpu.len(), oracle)
    }

    /// Creates a search for one case of a result of `length` words, which remembers up to `most_others` other
    /// cases.
    pub fn of_case(
        places: Vec<(usize, Scalar)>,
        case: &[f64],
        length: usize,
        most_others: usize,
        oracle: OracleFn<'a>,
    ) -> Self {
        Self { most_others, ..Self::of_cases(places, [case.to_vec(), case.to_vec()], length, oracle) }
    }

    fn of_cases(places: Vec<(usize, Scalar)>, wanted: [Vec<f64>; 2], length: usize, oracle: OracleFn<'a>) -> Self {
        let spread = Spread {
            low: vec![f64::INFINITY; length],
            high: vec![f64::NEG_INFINITY; length],
            gpu_and_mirror_agree: wanted[0] == wanted[1],
        };
        let (ends, result) = (vec![Default::default(); length], Vec::with_capacity(length));
        Self { oracle, places, wanted, met: [false; 2], spread, ends, others: Vec::new(), most_others: 0, result }
    }

    /// Returns the other cases that the oracle gave.
    pub fn others(&self) -> &[Vec<f64>] {
        &self.others
    }

    /// Searches for the whole range, without a result to reach: the corners, and the places at which the case changes
    /// if there are cases; then the corner downhill of each end of each result at `floats`, where a monotonic function
    /// has its extremum. Where the function bends within the box, many places inside it and the extrema as well.
    /// `centre` is the oracle's result at the centre.
    pub fn look_everywhere(&mut self, inputs: &InputBox, floats: &[usize], centre: &[f64]) {
        let effort = if self.places.is_empty() { Effort::Corners } else { Effort::Boundaries };
        self.corners(effort, inputs, |_| false);
        self.go_on_from_ends(floats, |search, best, what| {
            let corner = search.downhill(inputs, &best, what);
            search.visit(&corner);
        });
        if self.bends(floats, centre) {
            self.corners(Effort::Boundaries, inputs, |_| false);
            for number in 0..PLACES_WHERE_IT_BENDS {
                self.visit(&inputs.place(number));
            }
            self.go_on_from_ends(floats, |search, best, what| search.descend(inputs, best, what, &|_| false));
        }
    }

    /// Goes on from the best place so far of the least and of the greatest of each of these results.
    fn go_on_from_ends(&mut self, floats: &[usize], go_on: impl Fn(&mut Self, Vec<f64>, (usize, f64))) {
        if self.spread().is_none() {
            return;
        }
        for index in floats {
            for (end, sign) in [(0, 1.0), (1, -1.0)] {
                let best = self.ends[*index][end].clone();
                go_on(self, best, (*index, sign));
            }
        }
    }

    /// Whether the result at the centre lies beside the middle of the range, where a linear function has it.
    fn bends(&self, floats: &[usize], centre: &[f64]) -> bool {
        floats.iter().any(|index| {
            let (low, high) = (self.spread.low[*index], self.spread.high[*index]);
            let beside = (centre[*index] - 0.5 * (low + high)).abs();
            // A range that is not found bends.
            beside.is_nan() || beside > LINEAR * (high - low)
        })
    }

    /// Returns the range found so far, or `None` if the oracle did not give both cases.
    pub fn spread(&self) -> Option<&Spread> {
        (self.met == [true; 2]).then_some(&self.spread)
    }

    /// Searches for the range until `enough`, after all lesser efforts. `results` are the shader's
    /// and the mirror's.
    pub fn look(&mut self, effort: Effort, inputs: &InputBox, results: [&[u32]; 2], enough: impl Fn(&Spread) -> bool) {
        let starts = match effort {
            Effort::Corners => return self.corners(effort, inputs, enough),
            Effort::Boundaries => {
                self.corners(effort, inputs, &enough);
                0
            }
            Effort::Starts => {
                // A case may be so thin that hardly any path between corners ends in it.
                for number in 0..STARTS * PLACES_PER_START {
                    if self.spread().is_some_and(&enough) {
                        return;
                    }
                    self.visit(&inputs.place(number));
                }
                STARTS
            }
        };
        if self.spread().is_some_and(|spread| !enough(spread)) {
            self.extrema(inputs, results, starts, enough);
        }
    }

    /// Evaluates the oracle at a point.
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
                let ends = [below, above].into_iter().zip(&mut self.ends[index]);
                ends.filter(|(is_new, _)| *is_new).for_each(|(_, end)| point.clone_into(end));
            }
        } else if self.others.len() < self.most_others && !self.others.contains(&found) {
            self.others.push(found.clone());
        }
        Some(found)
    }

    /// Visits both sides of every change of the discrete results between two points on the way from
    /// `from` to `to`, as far as `halvings` resolve them.
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

    /// Extends the range towards each result that lies outside it by less than its width: a
    /// function that is not monotonic, such as a square, has its extremum inside the box and not at
    /// a corner. Starts from the best place so far, and from `starts` others.
    fn extrema(&mut self, inputs: &InputBox, results: [&[u32]; 2], starts: u64, enough: impl Fn(&Spread) -> bool) {
        for words in results {
            for (index, word) in words.iter().enumerate() {
                // The bits of a discrete result are no number to approach; its range has no width,
                // and nothing lies next to it.
                let value = f64::from(f32::from_bits(*word));
                let (low, high) = (self.spread.low[index], self.spread.high[index]);
                let sign = if value < low && low - value < high - low {
                    1.0
                } else if value > high && value - high < high - low {
                    -1.0
                } else {
                    continue;
                };
                let best = self.ends[index][usize::from(sign < 0.0)].clone();
                for start in std::iter::once(best).chain((0..starts).map(|start| inputs.place(start))) {
                    self.descend(inputs, start, (index, sign), &enough);
                    if enough(&self.spread) {
                        return;
                    }
                }
            }
        }
    }

    /// Returns `sign` times result `index` at a point; infinite if the discrete results differ,
    /// since it is another function's value there.
    fn at(&mut self, point: &[f64], (index, sign): (usize, f64)) -> f64 {
        let found = self.visit(point);
        let wanted = found.is_some_and(|found| self.wanted.contains(&found));
        if wanted { sign * self.result[index] } else { f64::INFINITY }
    }

    /// Lowers a result from `point`: all inputs at once, then one after another, until neither
    /// lowers it any further.
    fn descend(
        &mut self,
        inputs: &InputBox,
        mut point: Vec<f64>,
        what: (usize, f64),
        enough: &impl Fn(&Spread) -> bool,
    ) {
        let mut lowest = self.at(&point, what);
        for _ in 0..ROUNDS {
            let before = lowest;
            let corner = self.downhill(inputs, &point, what);
            let lines = std::iter::once(None).chain(inputs.moving.iter().map(Some));
            for line in lines {
                let [mut from, mut to] = [point.clone(), corner.clone()];
                if let Some(&moving) = line {
                    to.clone_from(&point);
                    from[moving] = inputs.centre[moving] - inputs.steps[moving];
                    to[moving] = inputs.centre[moving] + inputs.steps[moving];
                }
                let (least, place) = self.lowest_between(&from, &to, what);
                if least < lowest {
                    (lowest, point) = (least, place);
                }
                if enough(&self.spread) {
                    return;
                }
            }
            // No move helps any more.
            if lowest >= before {
                return;
            }
        }
    }

    /// Returns the corner that lies downhill in each input; for a linear function, the lowest one.
    fn downhill(&mut self, inputs: &InputBox, point: &[f64], what: (usize, f64)) -> Vec<f64> {
        let mut corner = point.to_vec();
        let mut beside = point.to_vec();
        for &moving in &inputs.moving {
            let (centre, step) = (inputs.centre[moving], inputs.steps[moving]);
            let [below, above] = [-1.0, 1.0].map(|side| {
                beside[moving] = (point[moving] + side * SLOPE * step).clamp(centre - step, centre + step);
                self.at(&beside, what)
            });
            beside[moving] = point[moving];
            if below != above {
                corner[moving] = if below < above { centre - step } else { centre + step };
            }
        }
        corner
    }

    /// Returns the least value on the way from `from` to `to`, and its place: at the best of
    /// several places, by golden-section search between its neighbours, and at the end of the case.
    fn lowest_between(&mut self, from: &[f64], to: &[f64], what: (usize, f64)) -> (f64, Vec<f64>) {
        let on_the_way = |share: f64| -> Vec<f64> {
            from.iter().zip(to).map(|(from, to)| (1.0 - share) * from + share * to).collect()
        };
        let share = |number: usize| number as f64 / (PLACES - 1) as f64;
        let values: Vec<f64> = (0..PLACES).map(|number| self.at(&on_the_way(share(number)), what)).collect();
        let least = (0..PLACES).min_by(|one, other| values[*one].total_cmp(&values[*other])).unwrap_or(0);
        let across = [least.saturating_sub(1), (least + 1).min(PLACES - 1)];
        let Ok(nearest) =
            golden_section::<Infallible>(across.map(share), SECTIONS, |place| Ok(self.at(&on_the_way(place), what)));
        let value = self.at(&on_the_way(nearest), what);
        let mut best = if value < values[least] { (value, nearest) } else { (values[least], share(least)) };
        let is_met = best.0 < f64::INFINITY;
        for end in across.into_iter().filter(|end| is_met && values[*end] == f64::INFINITY) {
            let (mut inside, mut outside) = (best.1, share(end));
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (inside + outside);
                let value = self.at(&on_the_way(middle), what);
                *(if value < f64::INFINITY { &mut inside } else { &mut outside }) = middle;
                if value < best.0 {
                    best = (value, middle);
                }
            }
        }
        (best.0, on_the_way(best.1))
    }

    /// Searches the corners of the box and the middles of its faces, until `enough`.
    fn corners(&mut self, effort: Effort, inputs: &InputBox, enough: impl Fn(&Spread) -> bool) {
        let InputBox { centre, steps, moving } = inputs;
        // From corner to corner, not outwards from the centre: all lines through one point cross a
        // boundary near that point.
        let mut previous = centre.clone();
        let mut at_previous = self.visit(centre);
        let mut walk = |search: &mut Self, point: &[f64]| -> bool {
            let at_point = search.visit(point);
            if effort == Effort::Boundaries {
                search.boundaries(&previous, point, (0.0, &at_previous), (1.0, &at_point), BISECTIONS);
                previous.copy_from_slice(point);
                at_previous = at_point;
            }
            search.spread().is_some_and(&enough)
        };
        let mut point = centre.clone();
        for index in moving {
            for sign in [-1.0, 1.0] {
                point[*index] = centre[*index] + sign * steps[*index];
                if walk(self, &point) {
                    return;
                }
            }
            point[*index] = centre[*index];
        }
        let most = MOST_CORNERS[usize::from(effort == Effort::Boundaries)];
        let all = 1u64.checked_shl(moving.len() as u32).is_some_and(|corners| corners <= most);
        let corners = if all { 1u64 << moving.len() } else { most };
        for corner in 0..corners {
            // With too many corners, a fixed pseudo-random selection.
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

/// The inputs that may stand for given ones: a box around them.
pub struct InputBox {
    centre: Vec<f64>,
    /// Largest deviation of each input.
    steps: Vec<f64>,
    /// Indices of the inputs that may deviate.
    moving: Vec<usize>,
}

impl InputBox {
    /// Creates the box of up to `backward` ulp of a vector's largest component around the inputs.
    pub fn new(leaves: &[Leaf], words: &[u32], backward: f64) -> Self {
        let mut centre = Vec::with_capacity(words.len());
        let mut steps = Vec::with_capacity(words.len());
        for leaf in leaves {
            let values: Vec<f64> =
                words[leaf.start..leaf.start + leaf.length].iter().map(|word| number(leaf.scalar, *word)).collect();
            let scale = largest(&values);
            // Zero is exact; a subnormal may be read as zero.
            let step = match leaf.scalar {
                Scalar::F32 if scale >= f64::from(f32::MIN_POSITIVE) => backward * ulp_of(scale),
                Scalar::F32 => scale,
                _ => 0.0,
            };
            steps.extend(std::iter::repeat_n(step, values.len()));
            centre.extend(values);
        }
        let moving = (0..steps.len()).filter(|index| steps[*index] > 0.0).collect();
        Self { centre, steps, moving }
    }

    /// Returns a fixed pseudo-random place in the box.
    fn place(&self, number: u64) -> Vec<f64> {
        let mut chance = mix(number);
        let mut offset = || {
            chance = mix(chance);
            chance as f64 / u64::MAX as f64 * 2.0 - 1.0
        };
        self.centre.iter().zip(&self.steps).map(|(centre, step)| centre + offset() * step).collect()
    }
}
