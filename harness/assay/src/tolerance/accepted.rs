//! The results that hold at an input, as intervals: for whoever judges a result without the oracle.

use super::numbers::OracleFn;
use super::search::{InputBox, Search, Spread};
use super::{Tolerance, Window};
use crate::order::{ordered, unordered};
use crate::shape::Scalar;

/// Cases of one input that are looked into, the oracle's own included.
const MOST_CASES: usize = 16;

/// Results that hold at an input: each component lies in its interval, whose ends hold too. The ends of a float's
/// are floats of 32 bits; an integer's or a flag's are equal.
#[derive(Clone, Debug, PartialEq)]
pub struct Accepted {
    /// Least number of each component.
    pub low: Vec<f64>,
    /// Greatest number of each component.
    pub high: Vec<f64>,
}

impl Accepted {
    /// Returns whether a result, as numbers, is among them. A NaN or an infinity is not.
    pub fn holds(&self, result: &[f64]) -> bool {
        let mut ends = self.low.iter().zip(&self.high);
        result.len() == self.low.len()
            && result.iter().all(|value| ends.next().is_some_and(|(l, h)| l <= value && value <= h))
    }

    /// Returns whether every result of `other` is among these.
    pub fn covers(&self, other: &Accepted) -> bool {
        self.low.iter().zip(&other.low).all(|(mine, low)| mine <= low)
            && self.high.iter().zip(&other.high).all(|(mine, high)| mine >= high)
    }
}

impl Tolerance {
    /// Returns the results that [`Tolerance::judge`] takes for right from a shader that equals its mirror, one entry
    /// for each combination of discrete results: the oracle's first, then those that the `backward` allowance
    /// explains. Empty if the oracle does not hold at this input.
    ///
    /// The range of the oracle within the `backward` allowance is sought as for a judgement, but with no result to
    /// reach.
    pub fn accepted(&self, arguments: &[u32], exact: &[f64], oracle: OracleFn<'_>) -> Vec<Accepted> {
        if exact.iter().any(|value| !value.is_finite()) {
            return Vec::new();
        }
        if self.backward() == 0.0 {
            return vec![self.intervals(exact, None)];
        }
        let inputs = InputBox::new(&self.arguments, arguments, self.backward());
        let places = self.backward_places();
        let floats: Vec<usize> = self
            .floats()
            .filter(|(_, bound)| bound.backward > 0.0)
            .flat_map(|(leaf, _)| leaf.start..leaf.start + leaf.length)
            .collect();
        let mut cases = vec![places.iter().map(|(index, _)| exact[*index]).collect::<Vec<f64>>()];
        let mut accepted = Vec::new();
        let mut next = 0;
        while next < cases.len() {
            let mut search = Search::of_case(places.clone(), &cases[next], exact.len(), MOST_CASES, oracle);
            search.look_everywhere(&inputs, &floats, exact);
            if let Some(spread) = search.spread() {
                let mut case = exact.to_vec();
                places.iter().zip(&cases[next]).for_each(|((index, _), value)| case[*index] = *value);
                accepted.push(self.intervals(&case, Some(spread)));
            }
            for other in search.others() {
                if cases.len() < MOST_CASES && !cases.contains(other) {
                    cases.push(other.clone());
                }
            }
            next += 1;
        }
        accepted
    }

    /// Returns the intervals around the exact result, or around the oracle's range if there is one.
    fn intervals(&self, exact: &[f64], spread: Option<&Spread>) -> Accepted {
        let (mut low, mut high) = (exact.to_vec(), exact.to_vec());
        for (leaf, bound) in self.results.iter().filter(|(leaf, _)| leaf.scalar == Scalar::F32) {
            let window = Window::new(leaf, bound, exact, spread);
            for index in 0..leaf.length {
                let (least, greatest) = window.ends(index);
                low[leaf.start + index] = f64::from(least);
                high[leaf.start + index] = f64::from(greatest);
            }
        }
        Accepted { low, high }
    }
}

impl Window<'_> {
    /// Returns the least and the greatest float that a component may be; the least is above the greatest if there is
    /// none.
    fn ends(&self, index: usize) -> (f32, f32) {
        let holds = |value: f32| value.is_finite() && self.ratio(index, f64::from(value)) <= 1.0;
        let nearest = (self.middle(index) as f32).clamp(f32::MIN, f32::MAX);
        let around = [nearest, nearest.next_down(), nearest.next_up()];
        let Some(inside) = around.into_iter().find(|value| holds(*value)) else { return (f32::MAX, f32::MIN) };
        // By bisection, so that not even a rounding in the judgement sets the ends apart from it.
        let last = |end: f32| {
            if holds(end) {
                return end;
            }
            let (mut inside, mut outside) = (ordered(inside.to_bits()), ordered(end.to_bits()));
            while inside.abs_diff(outside) > 1 {
                let middle = inside.midpoint(outside);
                if holds(f32::from_bits(unordered(middle))) { inside = middle } else { outside = middle }
            }
            f32::from_bits(unordered(inside))
        };
        (last(f32::MIN), last(f32::MAX))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy_line::parse_bounds;
    use crate::shape::Shape;

    const FLOAT: Shape = Shape::Scalar(Scalar::F32);

    fn tolerance(arguments: &[Shape], result: &Shape, bounds: &str) -> Tolerance {
        Tolerance::new(arguments, result, &parse_bounds(bounds).expect("bounds"))
    }

    /// A value holds by the intervals exactly if the judgement says so: at both ends, and one float beyond them.
    fn ends_are_those_of_the_judgement(bounds: &str, x: f32, oracle: impl Fn(f64) -> f64) {
        let tolerance = tolerance(&[FLOAT], &FLOAT, bounds);
        let exact = [oracle(f64::from(x))];
        let on_numbers = |numbers: &[f64], result: &mut Vec<f64>| result.push(oracle(numbers[0]));
        let arguments = [x.to_bits()];
        let accepted = tolerance.accepted(&arguments, &exact, &on_numbers);
        let [only] = accepted.as_slice() else { panic!("{bounds}: {accepted:?}") };
        let judged = |value: f32| {
            let words = [value.to_bits()];
            tolerance.judge(&arguments, &words, &words, &exact, &on_numbers).holds()
        };
        let (low, high) = (only.low[0] as f32, only.high[0] as f32);
        for (value, holds) in [(low, true), (high, true), (low.next_down(), false), (high.next_up(), false)] {
            assert_eq!(judged(value), holds, "{bounds} at {x}: {value:?}");
            assert_eq!(only.holds(&[f64::from(value)]), holds, "{bounds} at {x}: {value:?}");
        }
        assert!(!only.holds(&[f64::NAN]) && !only.holds(&[f64::INFINITY]) && !only.holds(&[]));
    }

    #[test]
    fn both_ends_hold_and_a_float_beyond_does_not() {
        for x in [1.0, 0.3, -7.7e9, 1e-20, 0.0] {
            for bounds in ["0 ulp", "2.5 ulp", "0.001 rel", "0.000001 abs", "3 ulp + 0.01 abs"] {
                ends_are_those_of_the_judgement(bounds, x, |x| x);
            }
        }
        ends_are_those_of_the_judgement("1 ulp", 0.1, |x| x / 3.0);
        ends_are_those_of_the_judgement("4 backward", 0.7, |x| 3.0 * x);
        ends_are_those_of_the_judgement("1 ulp + 4 backward", 0.999_999_9, |x| (1.0 - x).abs());
        // The least is inside the box.
        // A range so wide that its ends are no longer those of a sum.
        ends_are_those_of_the_judgement("4 backward", 1.0, |x| 3e5 * (1.0 + 1e6 * (x - 1.0)));
        ends_are_those_of_the_judgement("0.1 ulp + 16 backward", 1.000_000_2, |x| 1.0 + 1e9 * (x - 1.0) * (x - 1.0));
    }

    #[test]
    fn a_vectors_interval_is_that_of_its_largest_component() {
        let accepted = tolerance(&[], &Shape::Vector(2, Scalar::F32), "1 ulp").accepted(&[], &[1.0, 0.0], &|_, _| {});
        assert_eq!(accepted[0].low[1], -accepted[0].high[1]);
        assert_eq!(accepted[0].high[1], f64::from(f32::EPSILON));
    }

    #[test]
    fn either_flag_holds_beside_its_threshold_with_the_floats_of_its_case() {
        let result = Shape::Struct(
            "Hit".to_owned(),
            vec![("value".to_owned(), FLOAT), ("hit".to_owned(), Shape::Scalar(Scalar::Bool))],
        );
        let tolerance = tolerance(&[FLOAT], &result, "value 1 ulp + 2 backward, hit 2 backward");
        let oracle = |numbers: &[f64], result: &mut Vec<f64>| {
            let hit = numbers[0] > 1.0;
            result.extend([if hit { 5.0 } else { -5.0 }, f64::from(u8::from(hit))]);
        };
        let accepted_at = |x: f32| {
            let mut exact = Vec::new();
            oracle(&[f64::from(x)], &mut exact);
            tolerance.accepted(&[x.to_bits()], &exact, &oracle)
        };
        let both = accepted_at(1.0);
        assert_eq!(both.len(), 2, "{both:?}");
        let any = |result: [f64; 2]| both.iter().any(|accepted| accepted.holds(&result));
        assert!(any([5.0, 1.0]) && any([-5.0, 0.0]));
        assert!(!any([5.0, 0.0]) && !any([-5.0, 1.0]));
        assert_eq!(accepted_at(1.1).len(), 1);
    }

    #[test]
    fn an_oracle_without_a_value_accepts_nothing() {
        assert_eq!(tolerance(&[], &FLOAT, "1 ulp").accepted(&[], &[f64::NAN], &|_, _| {}), []);
    }
}
