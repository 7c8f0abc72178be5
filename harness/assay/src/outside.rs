//! What a function promises outside of its domain, as its `Outside:` line says it, tested: hostile inputs, and what must hold of
//! the results there. The promises stand in `formulas/outside/`.

use crate::dispatch::{DispatchError, Kernel};
use crate::draws::{Domain, Draws};
use crate::formula::{Formula, Words};
use crate::literal::{self, Language};
use crate::shape::{Scalar, Shape};
use crate::tolerance::{Tolerance, number};
use crate::value::{Arguments, Value};

/// Inputs tried for each promise.
const CASES: u64 = 2_048;

type Predicate = Box<dyn Fn(&[u32], &[u32]) -> Result<(), String> + Send + Sync>;
type Transform = Box<dyn Fn(&[u32], &mut Words) + Send + Sync>;

/// What is promised of the results.
enum Claim {
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
    inputs: Option<Domain<Words>>,
    claim: Claim,
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
            let mut words = Words::new();
            inputs(draws).write(&mut words);
            words
        });
        Self { function, says, arguments: A::shapes(), inputs: Some(inputs), claim }
    }

    /// Whether there is something to test.
    pub fn is_tested(&self) -> bool {
        self.inputs.is_some()
    }
}

/// The clause names what goes wrong, and promises nothing.
pub fn nothing(function: &'static str, says: &'static str) -> Promise {
    Promise { function, says, arguments: Vec::new(), inputs: None, claim: Claim::Nothing }
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
    let transform = Box::new(move |mut words: &[u32], other: &mut Words| inside(A::read(&mut words)).write(other));
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

/// Runs the promises of `formula`; a line for each that does not hold, with the first input at which it does not.
pub fn broken(
    kernel: &mut Kernel<'_>,
    formula: &Formula,
    tolerance: &Tolerance,
    promises: &[Promise],
    seed: u64,
) -> Result<Vec<String>, DispatchError> {
    let mut faults = Vec::new();
    for promise in promises.iter().filter(|promise| promise.function == formula.function) {
        let Some(inputs) = &promise.inputs else { continue };
        let rows: Vec<Words> = (0..CASES).map(|row| inputs.row(seed, row)).collect();
        let mut results = Words::new();
        kernel.run(&rows.concat(), &mut results)?;
        let mut others = Words::new();
        if let Claim::Like(transform) = &promise.claim {
            let mut inside = Words::new();
            rows.iter().for_each(|row| transform(row, &mut inside));
            kernel.run(&inside, &mut others)?;
        }
        let width = kernel.result_words();
        let fault = rows.iter().enumerate().find_map(|(index, row)| {
            let range = index * width..(index + 1) * width;
            let result = &results[range.clone()];
            let verdict = match &promise.claim {
                Claim::Finite => all_finite(formula, result),
                Claim::Accuracy => within_accuracy(formula, tolerance, row, result),
                Claim::Like(_) => same_bits(formula, result, &others[range]),
                Claim::Holds(predicate) => predicate(row, result),
                Claim::Nothing => Ok(()),
            };
            verdict.err().map(|why| (row, why))
        });
        if let Some((row, why)) = fault {
            faults.push(format!(
                "outside of its domain it promises `{}`; at {}: {why}",
                promise.says,
                literal::call(Language::Wgsl, formula, row)
            ));
        }
    }
    Ok(faults)
}

fn all_finite(formula: &Formula, result: &[u32]) -> Result<(), String> {
    let bad = result
        .iter()
        .zip(formula.result.scalars())
        .find(|(word, scalar)| *scalar == Scalar::F32 && !f32::from_bits(**word).is_finite());
    bad.map_or(Ok(()), |(word, _)| Err(format!("the result holds {}", f32::from_bits(*word))))
}

fn same_bits(formula: &Formula, result: &[u32], other: &[u32]) -> Result<(), String> {
    // 0 and -0 are one number; a NaN is none.
    let differ = |(word, other): (&u32, &u32), scalar: Scalar| match scalar {
        Scalar::F32 => f32::from_bits(*word) != f32::from_bits(*other),
        _ => word != other,
    };
    let scalars = formula.result.scalars();
    match result.iter().zip(other).zip(&scalars).find(|(words, scalar)| differ(*words, **scalar)) {
        None => Ok(()),
        Some(((word, other), scalar)) => {
            Err(format!("the result holds {}, inside {}", number(*scalar, *word), number(*scalar, *other)))
        }
    }
}

fn within_accuracy(formula: &Formula, tolerance: &Tolerance, row: &[u32], result: &[u32]) -> Result<(), String> {
    let verdict = tolerance.judge(row, result, &formula.mirrored(row), &formula.exact(row), &*formula.oracle);
    if verdict.holds() { Ok(()) } else { Err(format!("off by {:.2} times the allowed error", verdict.ratio)) }
}
