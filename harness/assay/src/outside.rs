//! What a function promises outside of its domain: hostile inputs, and what must hold of the results there.

use crate::draws::{Domain, Draws};
use crate::near::near;
use crate::shape::Shape;
use crate::value::{Arguments, Value};
use glam::{UVec2, UVec3, Vec3};

type Predicate = Box<dyn Fn(&[u32], &[u32]) -> Result<(), String> + Send + Sync>;
type Transform = Box<dyn Fn(&[u32], &mut Vec<u32>) + Send + Sync>;

/// What is promised of the results.
pub(crate) enum Claim {
    /// They are finite.
    Finite,
    /// The `Accuracy:` line holds there too.
    Accuracy,
    /// They are those of another input, to the bit.
    Like(Transform),
    /// Whatever the predicate says.
    Holds(Predicate),
    /// Nothing: the words name what goes wrong.
    Nothing,
}

/// A clause of an `Outside:` line.
pub struct Promise {
    /// The WGSL function.
    pub function: &'static str,
    /// The clause, word for word.
    pub says: &'static str,
    /// Shapes that the inputs were made for; empty for any.
    pub arguments: Vec<Shape>,
    /// The inputs; none where nothing is promised.
    pub(crate) inputs: Option<Domain<Vec<u32>>>,
    pub(crate) claim: Claim,
    /// Whether it is said only of devices that round to nearest.
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

    /// The same of devices that round sums, products, quotients and roots to nearest, as the mirrors do.
    #[must_use]
    pub fn at_nearest(self) -> Self {
        Self { at_nearest: true, ..self }
    }

    /// Whether there is something to test.
    pub fn is_tested(&self) -> bool {
        self.inputs.is_some()
    }
}

/// The clause names what goes wrong, and promises nothing.
pub fn nothing(function: &'static str, says: &'static str) -> Promise {
    Promise { function, says, arguments: Vec::new(), inputs: None, claim: Claim::Nothing, at_nearest: false }
}

/// Results are finite.
pub fn finite<A: Arguments<u32>>(
    function: &'static str,
    says: &'static str,
    inputs: impl Fn(&mut Draws<'_>) -> A + Send + Sync + 'static,
) -> Promise {
    Promise::new(function, says, inputs, Claim::Finite)
}

/// The `Accuracy:` line holds for these inputs as well.
pub fn accurate<A: Arguments<u32>>(
    function: &'static str,
    says: &'static str,
    inputs: impl Fn(&mut Draws<'_>) -> A + Send + Sync + 'static,
) -> Promise {
    Promise::new(function, says, inputs, Claim::Accuracy)
}

/// The result is that of the input that `inside` makes of it, to the bit.
pub fn like<A: Arguments<u32> + 'static>(
    function: &'static str,
    says: &'static str,
    inputs: impl Fn(&mut Draws<'_>) -> A + Send + Sync + 'static,
    inside: impl Fn(A) -> A + Send + Sync + 'static,
) -> Promise {
    let transform = Box::new(move |mut words: &[u32], other: &mut Vec<u32>| inside(A::read(&mut words)).write(other));
    Promise::new(function, says, inputs, Claim::Like(transform))
}

/// The predicate holds of each input and its result.
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

/// Any finite number: 0, the ends of f32's range, every magnitude between.
pub fn any_finite(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => draws.pick(&[0.0, -0.0, 1.0, -1.0, f32::MAX, f32::MIN, f32::MIN_POSITIVE, -f32::MIN_POSITIVE]),
        1 => draws.between(-2.0, 2.0),
        _ => draws.signed(-126, 127),
    }
}

/// Any bits at all: subnormal numbers, infinities and every NaN too.
pub fn any_bits(draws: &mut Draws<'_>) -> f32 {
    match draws.below(3) {
        0 => draws.pick(&[f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e-40, -1e-40, 0.0, -0.0]),
        1 => f32::from_bits(draws.bits()),
        _ => any_finite(draws),
    }
}

/// A vector of any finite components.
pub fn any_vector(draws: &mut Draws<'_>) -> Vec3 {
    Vec3::new(any_finite(draws), any_finite(draws), any_finite(draws))
}

/// A vector with components 0 or of magnitudes up to 2^`high`.
pub fn vector_up_to(draws: &mut Draws<'_>, high: i32) -> Vec3 {
    let mut component = || if draws.below(6) == 0 { 0.0 } else { draws.signed(-126, high - 1) };
    Vec3::new(component(), component(), component())
}

/// A direction of any length between 2^`low` and 2^`high`.
pub fn of_length(draws: &mut Draws<'_>, low: i32, high: i32) -> Vec3 {
    draws.magnitude(low, high - 1) * draws.unit_vector()
}

/// Whole numbers: small ones, the ends, any.
pub fn any_number(draws: &mut Draws<'_>) -> u32 {
    match draws.below(3) {
        0 => draws.pick(&[0, 1, 2, u32::MAX, u32::MAX - 1, 1 << 31]),
        1 => draws.below(100),
        _ => draws.bits(),
    }
}

/// Three of them.
pub fn any_numbers(draws: &mut Draws<'_>) -> UVec3 {
    UVec3::new(any_number(draws), any_number(draws), any_number(draws))
}

/// A texture's size, 1 to 64 either way.
pub fn small_size(draws: &mut Draws<'_>) -> UVec2 {
    UVec2::new(1 + draws.below(64), 1 + draws.below(64))
}

/// Passes where `right`; `what` says what is not.
pub fn that(right: bool, what: impl FnOnce() -> String) -> Result<(), String> {
    if right { Ok(()) } else { Err(what()) }
}

/// Passes where every component of `value` is within `bound` of `wanted`; a NaN never is.
pub fn close(value: &[f32], wanted: &[f64], bound: f64) -> Result<(), String> {
    value.iter().zip(wanted).try_for_each(|(value, wanted)| near("a component", f64::from(*value), *wanted, bound))
}

/// Passes where all are finite.
pub fn finite_values(values: &[f32]) -> Result<(), String> {
    that(values.iter().all(|value| value.is_finite()), || format!("the result is {values:?}"))
}
