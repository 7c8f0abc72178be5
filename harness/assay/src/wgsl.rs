//! A property test of one WGSL function, for `cargo test`: [`wgsl`] names the function, further
//! methods state its requirements, and [`Test::run`] runs the test.

use crate::accuracy_line::{Bound, FieldBound, check_fields, parse_bounds};
use crate::dispatch::{self, DispatchError, Kernel, KernelModule};
use crate::draws::{Domain, Draws};
use crate::environment;
use crate::examination::examine;
use crate::formula::{self, Builder, Formula, Words};
use crate::mutate::{self, Judge, Score};
use crate::property::Settings;
use crate::shape::Shape;
use crate::slack::{self, Reassociation};
use crate::tolerance::{Tolerance, number, word};
use crate::value::{Arguments, Exact, Function, Value};
use lapidary_gpu::Gpu;
use proptest::strategy::Strategy;
use std::fmt;

/// Name of the source in messages.
const PATH: &str = "the source";

/// The result of a `#[test]`.
pub type Outcome = Result<(), Failure>;

/// The reason why a test failed, as `cargo test` prints it.
#[derive(Clone, PartialEq, Eq)]
pub struct Failure(String);

impl Failure {
    pub(crate) fn new(message: String) -> Self {
        Self(message)
    }
}

impl fmt::Debug for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Failure {}

/// Begins a test of `function` in `source`, a WGSL text that is valid by itself.
pub fn wgsl(source: impl Into<String>, function: &'static str) -> Source {
    Source { text: source.into(), function }
}

/// A WGSL function without a mirror.
#[derive(Clone, Debug)]
pub struct Source {
    text: String,
    function: &'static str,
}

impl Source {
    /// Sets the mirror, a Rust function in `f32` that the shader must agree with. Its argument and
    /// result types are checked against the shader's.
    pub fn mirror<A, R, F>(self, mirror: F) -> Mirrored<A, R>
    where
        A: Arguments<u32>,
        R: Value,
        F: Function<A, R> + Clone + Send + Sync + 'static,
    {
        let on_words = {
            let mirror = mirror.clone();
            move |mut words: &[u32], result: &mut Words| mirror.call(A::read(&mut words)).write(result)
        };
        let arguments: Vec<_> = A::shapes().iter().flat_map(Shape::scalars).collect();
        let results = R::shape().scalars();
        // Until an oracle is set, the mirror on the nearest words serves as the oracle.
        let oracle = move |numbers: &[f64], exact: &mut Vec<f64>| {
            let words: Words = arguments.iter().zip(numbers).map(|(kind, number)| word(*kind, *number)).collect();
            let mut result = Words::new();
            on_words(&words, &mut result);
            exact.extend(results.iter().zip(&result).map(|(kind, word)| number(*kind, *word)));
        };
        let mirror = Box::new(move |arguments| mirror.call(arguments));
        Mirrored { source: self, mirror, oracle: Box::new(oracle), oracle_fault: None }
    }
}

type Mirror<A, R> = Box<dyn Fn(A) -> R + Send + Sync>;
type Oracle = Box<dyn Fn(&[f64], &mut Vec<f64>) + Send + Sync>;

/// A WGSL function with its mirror.
pub struct Mirrored<A, R> {
    source: Source,
    mirror: Mirror<A, R>,
    oracle: Oracle,
    /// Mismatch between the types of the oracle and the mirror.
    oracle_fault: Option<String>,
}

impl<A: Arguments<u32> + 'static, R: Value + 'static> Mirrored<A, R> {
    /// Sets the oracle, a Rust function in `f64` that defines the correct result. Without an
    /// oracle, the mirror defines it. The oracle's types are the mirror's, with `f64` for `f32`.
    #[must_use]
    pub fn oracle<EA, ER>(mut self, oracle: impl Function<EA, ER> + Send + Sync + 'static) -> Self
    where
        EA: Arguments<f64>,
        ER: Exact,
    {
        let spell = |(arguments, result): &(Vec<Shape>, Shape)| {
            let arguments: Vec<String> = arguments.iter().map(ToString::to_string).collect();
            format!("({}) -> {result}", arguments.join(", "))
        };
        let [mirrors, oracles] = [(A::shapes(), R::shape()), (EA::shapes(), ER::shape())];
        if mirrors != oracles {
            let [mirrors, oracles] = [spell(&mirrors), spell(&oracles)];
            self.oracle_fault = Some(format!("the oracle is {oracles} with f64 for f32, the mirror {mirrors}"));
        }
        self.oracle = Box::new(move |mut numbers, result| oracle.call(EA::read(&mut numbers)).write(result));
        self
    }

    /// Takes inputs from a proptest strategy, which also shrinks failing inputs.
    pub fn inputs(self, strategy: impl Strategy<Value = A> + Send + Sync + 'static) -> Test<A, R>
    where
        A: fmt::Debug,
    {
        self.over(Domain::of_strategy(strategy.prop_map(|arguments| to_words(&arguments))))
    }

    /// Takes inputs from draws. Every guarantee of the generator also holds for the shrunk inputs.
    pub fn draws(self, generate: impl Fn(&mut Draws<'_>) -> A + Send + Sync + 'static) -> Test<A, R> {
        self.over(Domain::new(move |draws| to_words(&generate(draws))))
    }

    fn over(self, domain: Domain<Words>) -> Test<A, R> {
        let Source { text, function } = self.source;
        let formula = formula::of_parts(function, self.mirror, self.oracle, domain);
        Test {
            text,
            formula,
            oracle_fault: self.oracle_fault,
            bounds: None,
            portable: None,
            settings: Settings::default(),
        }
    }
}

fn to_words<A: Arguments<u32>>(arguments: &A) -> Words {
    let mut words = Words::new();
    arguments.write(&mut words);
    words
}

/// A property test, ready to run.
#[must_use = "a test says nothing until it is run"]
pub struct Test<A, R> {
    text: String,
    formula: Builder<A, R>,
    oracle_fault: Option<String>,
    bounds: Option<String>,
    portable: Option<String>,
    settings: Settings,
}

impl<A: Arguments<u32> + 'static, R: Value + 'static> Test<A, R> {
    /// Sets the tolerance between shader, mirror and oracle, pairwise: a sum of `ulp`, `abs`, `rel`
    /// and `backward` terms, such as `"4 ulp + 2 backward"`; for a struct, one sum per field in
    /// field order, such as `"direction 12 ulp + 8 backward, total 0 ulp"`. By default only 2^-125
    /// is allowed, since WGSL lets a device flush subnormals. A non-finite result fails.
    pub fn within(mut self, bounds: &str) -> Self {
        self.bounds = Some(bounds.to_owned());
        self
    }

    /// Sets the tolerance for [`Test::run_anywhere`], in which a device may err more than most do.
    /// The default is the tolerance of [`Test::within`].
    pub fn within_anywhere(mut self, bounds: &str) -> Self {
        self.portable = Some(bounds.to_owned());
        self
    }

    /// Names a part of the inputs that the run must reach.
    pub fn edge(mut self, name: &'static str, reached: impl Fn(A) -> bool + Send + Sync + 'static) -> Self {
        self.formula = self.formula.edge(name, reached);
        self
    }

    /// Adds a property that every result must have; the error message states the deviation.
    pub fn invariant(
        mut self,
        name: &'static str,
        holds: impl Fn(A, R) -> Result<(), String> + Send + Sync + 'static,
    ) -> Self {
        self.formula = self.formula.invariant(name, holds);
        self
    }

    /// Adds a relation between the results at an input and at its image under `transform`.
    pub fn pair(
        mut self,
        name: &'static str,
        transform: impl Fn(A) -> A + Send + Sync + 'static,
        holds: impl Fn(A, R, R) -> Result<(), String> + Send + Sync + 'static,
    ) -> Self {
        self.formula = self.formula.pair(name, transform, holds);
        self
    }

    /// Adds an input that is always tested first.
    pub fn case(mut self, arguments: A) -> Self {
        self.formula = self.formula.case(arguments);
        self
    }

    /// Sets the number of random inputs; the default is 65,536. With fewer, edges are not required.
    pub fn cases(mut self, cases: u64) -> Self {
        self.settings.cases = cases;
        self
    }

    /// Sets the seed; `ASSAY_SEED` overrides it.
    pub fn seed(mut self, seed: u64) -> Self {
        self.settings.seed = seed;
        self
    }

    /// Runs the function on the device that `LAPIDARY_ADAPTER` names (see
    /// `lapidary_gpu::AdapterChoice`).
    ///
    /// # Errors
    /// Returns an error if a result is wrong, with the simplest input found; if the source is not
    /// valid or its signature differs; or if there is no adapter, unless
    /// `ASSAY_WITHOUT_ADAPTER=skip`.
    pub fn run(self) -> Outcome {
        let Ready { text, formula, cases, tolerance, settings } = self.ready()?;
        let Some(gpu) = gpu(&formula)? else { return Ok(()) };
        let fail = |error: DispatchError| Failure(format!("{}: {error}", formula.function));
        let mut kernel = Kernel::of_function(gpu, &text, PATH, formula.function).map_err(fail)?;
        let found = examine(&formula, &text, &mut kernel, &tolerance, settings, &cases).map_err(fail)?;
        if found.holds() { Ok(()) } else { Err(Failure(found.describe(&formula))) }
    }

    /// Runs the function on the CPU, as any device that conforms to WGSL may run it: each row
    /// rounds either way, errs in quotients and built-in functions up to the standard's limits,
    /// fuses products with sums or not, flushes subnormals or not, ignores the sign of zeros, and
    /// replaces infinities and NaNs with anything. Needs no adapter. Invariants are tested as well;
    /// pairs are not, since both results are held to their bounds.
    ///
    /// # Errors
    /// Returns an error if a result is wrong, with the simplest input found; if the source is not
    /// valid or its signature differs; or if the interpreter cannot run the function.
    pub fn run_anywhere(mut self) -> Outcome {
        self.bounds = self.portable.take().or(self.bounds);
        let Ready { text, formula, cases, tolerance, settings } = self.ready()?;
        let fail = |error: DispatchError| Failure(format!("{}: {error}", formula.function));
        let source = (text.as_str(), PATH);
        let found = slack::examine(&formula, source, &tolerance, settings, Reassociation::Written, &cases)
            .map_err(fail)?
            .examination;
        if found.holds() { Ok(()) } else { Err(Failure(found.describe(&formula))) }
    }

    /// Changes one operator, comparison or constant of the function at a time, and reports the
    /// changes that this test does not notice. Each is an equivalent mutant, or a gap in the
    /// inputs, the invariants or the bounds. The inputs are the test's cases and 139,264 inputs
    /// from seeds of its own. A mutant also counts as caught if it computes an intermediate
    /// infinity or NaN that the function does not, since another device may replace it with
    /// anything. Called functions and built-ins are not changed. Takes a fraction of a second per
    /// mutant.
    ///
    /// # Errors
    /// Returns the errors of [`Test::run`], and an error if the test fails on the unchanged
    /// function. Without an adapter, if tests may be skipped, the score has no mutants.
    pub fn mutate(self) -> Result<Score, Failure> {
        let Ready { text, formula, cases, tolerance, .. } = self.ready()?;
        let Some(gpu) = gpu(&formula)? else { return Ok(Score { mutants: 0, survivors: Vec::new() }) };
        let fail = |what: &dyn fmt::Display| Failure(format!("{}: {what}", formula.function));
        let mut mutants = mutate::of_function(&text, PATH, formula.function).map_err(|error| fail(&error))?.valid;
        let judge = Judge::new(gpu, &formula, (&text, PATH), tolerance, &cases).map_err(|error| fail(&error))?;
        if judge.rejects_unchanged() {
            return Err(fail(&"does not pass its own test, so nothing can be said of its mutants"));
        }
        let count = mutants.len();
        mutants.retain(|mutant| !judge.catches(mutant));
        Ok(Score { mutants: count, survivors: mutants })
    }

    /// Prepares everything that a run needs, except the device.
    fn ready(self) -> Result<Ready, Failure> {
        let Self { text, formula, oracle_fault, bounds, mut settings, .. } = self;
        let (formula, cases) = formula.build_with_cases();
        let function = formula.function;
        let fail = |what: &dyn fmt::Display| Failure(format!("{function}: {what}"));
        if settings.cases == 0 && cases.is_empty() {
            return Err(fail(&"no cases: nothing would be tested"));
        }
        if let Some(fault) = &oracle_fault {
            return Err(fail(fault));
        }
        let bounds = match bounds {
            Some(text) => parse_bounds(&text).map_err(|fault| fail(&format!("within: {fault}")))?,
            None => exact(&formula.result),
        };
        settings.seed = environment::seed().map_err(|fault| fail(&fault))?.unwrap_or(settings.seed);
        dispatch::examine(&text, PATH, function).map_err(|error| fail(&error))?;
        let signature = KernelModule::reflect(&text, PATH, function).map_err(|error| fail(&error))?.signature;
        signature.expect(&formula.arguments, &formula.result).map_err(|error| Failure(error.to_string()))?;
        check_fields(&bounds, &formula.result).map_err(|fault| fail(&format!("within: {fault}")))?;
        let tolerance = Tolerance::new(&formula.arguments, &formula.result, &bounds);
        Ok(Ready { text, formula, cases, tolerance, settings })
    }
}

/// Returns the device, or `None` if there is no adapter and tests may be skipped.
fn gpu(formula: &Formula) -> Result<Option<&'static Gpu>, Failure> {
    environment::gpu(formula.function).map_err(|error| Failure(format!("{}: {error}", formula.function)))
}

/// A test whose parts match each other.
struct Ready {
    text: String,
    formula: Formula,
    cases: Vec<Words>,
    tolerance: Tolerance,
    settings: Settings,
}

/// Returns bounds that allow no error in any field.
fn exact(result: &Shape) -> Vec<FieldBound> {
    let none = |field| FieldBound { field, bound: Bound::default() };
    match result {
        Shape::Struct(_, fields) => fields.iter().map(|(name, _)| none(Some(name.clone()))).collect(),
        _ => vec![none(None)],
    }
}
