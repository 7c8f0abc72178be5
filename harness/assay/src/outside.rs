//! Promises of a function outside its domain: hostile inputs, and conditions on the results there.

use crate::draws::{Domain, Draws};
use crate::near::near;
use crate::shape::Shape;
use crate::value::{Arguments, Value};
use glam::{UVec2, UVec3, Vec3};

type Predicate = Box<dyn Fn(&[u32], &[u32]) -> Result<(), String> + Send + Sync>;
type Transform = Box<dyn Fn(&[u32], &mut Vec<u32>) + Send + Sync>;

/// A condition on the results.
pub(crate) enum Claim {
    /// The results are finite.
    Finite,
    /// The `Accuracy:` line holds as well.
    Accuracy,
    /// The results equal those of another input: on a device that rounds to nearest to the bit, with
    /// 0 equal to -0; on others within the tolerance.
    Like(Transform),
    /// The predicate holds.
    Holds(Predicate),
    /// No condition: the clause names the failure.
    Nothing,
}

/// A clause of an `Outside:` line.
pub struct Promise {
    /// Name of the WGSL function.
    pub function: &'static str,
    /// Text of the clause, word for word.
    pub says: &'static str,
    /// Argument shapes of the inputs; empty for any shapes.
    pub arguments: Vec<Shape>,
    /// Generator of the inputs; `None` if nothing is promised.
    pub(crate) inputs: Option<Domain<Vec<u32>>>,
    pub(crate) claim: Claim,
    /// Whether the promise applies only to devices that round to nearest.
    pub(crate) at_nearest: bool,
}

impl std::fmt::Debug for Promise {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Promise").field("function", &self.function).field("says", &self.says).finish_non_exhaustive()
    }
}

impl Promise {
    fn new<A: Arguments<u32>>(
        function: &'static str,
        says: &'static str,
        inputs: impl Fn(&mut Draws<'_>) -> A + Send + Sync + 'static,
        claim: Claim,
    ) -> Self {
        let inputs = Domain::new(move |draws| {
            let mut words = Vec::new();
            inputs(draws).write(&mut words);
            words
        });
        Self { function, says, arguments: A::shapes(), inputs: Some(inputs), claim, at_nearest: false }
    }

    /// Restricts the promise to devices that round sums, products, quotients and roots to nearest,
    /// as the mirrors do.
    #[must_use]
    pub fn at_nearest(self) -> Self {
        Self { at_nearest: true, ..self }
    }

    /// Returns whether there is anything to test.
    pub fn is_tested(&self) -> bool {
        self.inputs.is_some()
    }
}

/// Creates a clause that names the failure and promises nothing.
pub fn nothing(function: &'static str, says: &'static str) -> Promise {
    Promise { function, says, arguments: Vec::new(), inputs: None, claim: Claim::Nothing, at_nearest: false }
}

/// Promises that results are finite.
pub fn finite<A: Arguments<u32>>(
    function: &'static str,
    says: &'static str,
    inputs: impl Fn(&mut Draws<'_>) -> A + Send + Sync + 'static,
) -> Promise {
    Promise::new(function, says, inputs, Claim::Finite)
}

/// Promises that the `Accuracy:` line holds for these inputs as well.
pub fn accurate<A: Arguments<u32>>(
    function: &'static str,
    says: &'static str,
    inputs: impl Fn(&mut Draws<'_>) -> A + Send + Sync + 'static,
) -> Promise {
    Promise::new(function, says, inputs, Claim::Accuracy)
}

/// Promises that the result equals the result at the input that `inside` returns: on a device that
/// rounds to nearest to the bit, with 0 equal to -0; on others within the tolerance.
pub fn like<A: Arguments<u32> + 'static>(
    function: &'static str,
    says: &'static str,
    inputs: impl Fn(&mut Draws<'_>) -> A + Send + Sync + 'static,
    inside: impl Fn(A) -> A + Send + Sync + 'static,
) -> Promise {
    let transform = Box::new(move |mut words: &[u32], other: &mut Vec<u32>| inside(A::read(&mut words)).write(other));
    Promise::new(function, says, inputs, Claim::Like(transform))
}

/// Promises that the predicate holds for each input and its result.
pub fn holds<A: Arguments<u32> + 'static, R: Value + 'static>(
    function: &'static str,
    says: &'static str,
    inputs: impl Fn(&mut Draws<'_>) -> A + Send + Sync + 'static,
    predicate: impl Fn(A, R) -> Result<(), String> + Send + Sync + 'static,
) -> Promise {
    let predicate = Box::new(move |mut arguments: &[u32], mut result: &[u32]| {
        predicate(A::read(&mut arguments), R::read(&mut result))
    });
    Promise::new(function, says, inputs, Claim::Holds(predicate))
}

/// Draws any finite number: 0, the ends of f32's range, and every magnitude between.
pub fn any_finite(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => draws.pick(&[0.0, -0.0, 1.0, -1.0, f32::MAX, f32::MIN, f32::MIN_POSITIVE, -f32::MIN_POSITIVE]),
        1 => draws.between(-2.0, 2.0),
        _ => draws.signed(-126, 127),
    }
}

/// Draws any bit pattern, including subnormals, infinities and every NaN.
pub fn any_bits(draws: &mut Draws<'_>) -> f32 {
    match draws.below(3) {
        0 => draws.pick(&[f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e-40, -1e-40, 0.0, -0.0]),
        1 => f32::from_bits(draws.bits()),
        _ => any_finite(draws),
    }
}

/// Draws a vector of any finite components.
pub fn any_vector(draws: &mut Draws<'_>) -> Vec3 {
    Vec3::new(any_finite(draws), any_finite(draws), any_finite(draws))
}

/// Draws a vector whose components are 0 or have magnitudes up to 2^`high`.
pub fn vector_up_to(draws: &mut Draws<'_>, high: i32) -> Vec3 {
    let mut component = || if draws.below(6) == 0 { 0.0 } else { draws.signed(-126, high - 1) };
    Vec3::new(component(), component(), component())
}

/// Draws a vector of any direction, with a length between 2^`low` and 2^`high`.
pub fn of_length(draws: &mut Draws<'_>, low: i32, high: i32) -> Vec3 {
    draws.magnitude(low, high - 1) * draws.unit_vector()
}

/// Draws a whole number: a small one, one of the ends of the range, or any.
pub fn any_number(draws: &mut Draws<'_>) -> u32 {
    match draws.below(3) {
        0 => draws.pick(&[0, 1, 2, u32::MAX, u32::MAX - 1, 1 << 31]),
        1 => draws.below(100),
        _ => draws.bits(),
    }
}

/// Draws three numbers with [`any_number`].
pub fn any_numbers(draws: &mut Draws<'_>) -> UVec3 {
    UVec3::new(any_number(draws), any_number(draws), any_number(draws))
}

/// Draws a texture size of 1 to 64 in each dimension.
pub fn small_size(draws: &mut Draws<'_>) -> UVec2 {
    UVec2::new(1 + draws.below(64), 1 + draws.below(64))
}

/// Checks that `right` is true; otherwise `what` gives the error message.
pub fn that(right: bool, what: impl FnOnce() -> String) -> Result<(), String> {
    if right { Ok(()) } else { Err(what()) }
}

/// Checks that every component of `value` is within `bound` of `wanted`; a NaN never is.
pub fn close(value: &[f32], wanted: &[f64], bound: f64) -> Result<(), String> {
    value.iter().zip(wanted).try_for_each(|(value, wanted)| near("a component", f64::from(*value), *wanted, bound))
}

/// Checks that all values are finite.
pub fn finite_values(values: &[f32]) -> Result<(), String> {
    that(values.iter().all(|value| value.is_finite()), || format!("the result is {values:?}"))
}
