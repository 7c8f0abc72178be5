//! A property test of one WGSL function, for `cargo test`: [`wgsl`] names the function, the methods after it say what it is held to, and
//! [`Test::run`] answers.

use crate::accuracy_line::{Bound, FieldBound, parse_bounds};
use crate::dispatch::{self, Kernel};
use crate::draws::{Domain, Draws};
use crate::failure::Failure as FailureAt;
use crate::formula::{self, Builder, Formula, Words};
use crate::property::{Check, Report, Settings};
use crate::shape::Shape;
use crate::tolerance::{Tolerance, number, word};
use crate::value::{Arguments, Exact, Function, Value};
use lapidary_gpu::{AdapterChoice, Gpu};
use proptest::strategy::Strategy;
use std::fmt::{self, Write as _};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Overrides the seed: a whole number, as a failure prints it.
pub const SEED_VARIABLE: &str = "ASSAY_SEED";
/// Set to `skip`, tests pass without an adapter, and say so.
pub const WITHOUT_ADAPTER_VARIABLE: &str = "ASSAY_WITHOUT_ADAPTER";

/// What a `#[test]` returns.
pub type Outcome = Result<(), Failure>;

/// Why a test failed: what `cargo test` prints.
#[derive(Clone, PartialEq, Eq)]
pub struct Failure(String);

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
    /// The function in Rust, in `f32`, that the shader is to agree with. Its argument and result types are checked against the shader's.
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
        // Until there is an oracle, the mirror on the nearest words.
        let oracle = move |numbers: &[f64], exact: &mut Vec<f64>| {
            let words: Words = arguments.iter().zip(numbers).map(|(kind, number)| word(*kind, *number)).collect();
            let mut result = Words::new();
            on_words(&words, &mut result);
            exact.extend(results.iter().zip(&result).map(|(kind, word)| number(*kind, *word)));
        };
        Mirrored { source: self, mirror: Box::new(move |arguments| mirror.call(arguments)), oracle: Box::new(oracle) }
    }
}

type Mirror<A, R> = Box<dyn Fn(A) -> R + Send + Sync>;
type Oracle = Box<dyn Fn(&[f64], &mut Vec<f64>) + Send + Sync>;

/// A WGSL function with its mirror.
pub struct Mirrored<A, R> {
    source: Source,
    mirror: Mirror<A, R>,
    oracle: Oracle,
}

impl<A: Arguments<u32> + 'static, R: Value + 'static> Mirrored<A, R> {
    /// The function in Rust, in `f64`, that says what is right. Without one, the mirror does.
    ///
    /// # Panics
    /// Where its types are not the twins of the mirror's.
    #[must_use]
    pub fn oracle<EA, ER>(mut self, oracle: impl Function<EA, ER> + Send + Sync + 'static) -> Self
    where
        EA: Arguments<f64>,
        ER: Exact,
    {
        assert_eq!(A::shapes(), EA::shapes(), "{}: the arguments of mirror and oracle differ", self.source.function);
        assert_eq!(R::shape(), ER::shape(), "{}: the results of mirror and oracle differ", self.source.function);
        self.oracle = Box::new(move |mut numbers, result| oracle.call(EA::read(&mut numbers)).write(result));
        self
    }

    /// Inputs from a proptest strategy, which also shrinks those that fail.
    pub fn inputs(self, strategy: impl Strategy<Value = A> + Send + Sync + 'static) -> Test<A, R>
    where
        A: fmt::Debug,
    {
        self.over(Domain::of_strategy(strategy.prop_map(|arguments| to_words(&arguments))))
    }

    /// Inputs from draws: what a generator guarantees holds of every shrunk input as well.
    pub fn draws(self, generate: impl Fn(&mut Draws<'_>) -> A + Send + Sync + 'static) -> Test<A, R> {
        self.over(Domain::new(move |draws| to_words(&generate(draws))))
    }

    fn over(self, domain: Domain<Words>) -> Test<A, R> {
        let Source { text, function } = self.source;
        let formula = formula::of_parts(function, self.mirror, self.oracle, domain);
        Test { text, formula, bounds: None, settings: Settings::default() }
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
    bounds: Option<String>,
    settings: Settings,
}

impl<A: Arguments<u32> + 'static, R: Value + 'static> Test<A, R> {
    /// How far the shader may be from the oracle, and the mirror from either: a sum of `ulp`, `abs`, `rel` and `backward`, as
    /// `"4 ulp + 2 backward"`; of a struct for each field, as `"direction 12 ulp + 8 backward, total 8 backward"`. Without it, nothing.
    pub fn within(mut self, bounds: &str) -> Self {
        self.bounds = Some(bounds.to_owned());
        self
    }

    /// A part of the inputs that must be reached.
    pub fn edge(mut self, name: &'static str, reached: impl Fn(A) -> bool + Send + Sync + 'static) -> Self {
        self.formula = self.formula.edge(name, reached);
        self
    }

    /// What holds of every result; the message says by how much it does not.
    pub fn invariant(
        mut self,
        name: &'static str,
        holds: impl Fn(A, R) -> Result<(), String> + Send + Sync + 'static,
    ) -> Self {
        self.formula = self.formula.invariant(name, holds);
        self
    }

    /// What holds of the results at an input and at `transform` of it.
    pub fn pair(
        mut self,
        name: &'static str,
        transform: impl Fn(A) -> A + Send + Sync + 'static,
        holds: impl Fn(A, R, R) -> Result<(), String> + Send + Sync + 'static,
    ) -> Self {
        self.formula = self.formula.pair(name, transform, holds);
        self
    }

    /// An input that is tested first, always.
    pub fn case(mut self, arguments: A) -> Self {
        self.formula = self.formula.case(arguments);
        self
    }

    /// How many random inputs; 65,536 otherwise. Edges count from that number on.
    pub fn cases(mut self, cases: u64) -> Self {
        self.settings.cases = cases;
        self
    }

    /// From which seed, where the environment's `ASSAY_SEED` names none.
    pub fn seed(mut self, seed: u64) -> Self {
        self.settings.seed = seed;
        self
    }

    /// Runs the function on the device that `LAPIDARY_ADAPTER` names: `lapidary_gpu::AdapterChoice`.
    ///
    /// # Errors
    /// Where a result is wrong, with the simplest input found; where the source is not valid or its signature another; where there is no adapter,
    /// unless `ASSAY_WITHOUT_ADAPTER=skip`.
    pub fn run(self) -> Outcome {
        let Self { text, formula, bounds, mut settings } = self;
        let (formula, cases) = formula.build_with_cases();
        let function = formula.function;
        let fail = |what: &dyn fmt::Display| Failure(format!("{function}: {what}"));
        let bounds = match bounds {
            Some(text) => parse_bounds(&text).map_err(|fault| fail(&format!("within: {fault}")))?,
            None => exact(&formula.result),
        };
        if let Some(seed) = std::env::var_os(SEED_VARIABLE) {
            let seed = seed.to_str().and_then(|seed| seed.parse().ok());
            settings.seed = seed.ok_or_else(|| fail(&format!("{SEED_VARIABLE} is no whole number")))?;
        }
        let gpu = match Gpu::shared(&AdapterChoice::from_environment()) {
            Ok(gpu) => gpu,
            Err(_) if std::env::var_os(WITHOUT_ADAPTER_VARIABLE).is_some_and(|value| value == "skip") => {
                static SKIPPED: AtomicUsize = AtomicUsize::new(0);
                let number = SKIPPED.fetch_add(1, Ordering::Relaxed) + 1;
                eprintln!(
                    "assay: {function} was not tested: no adapter, and {WITHOUT_ADAPTER_VARIABLE}=skip ({number} so far)"
                );
                return Ok(());
            }
            Err(error) => return Err(fail(&error)),
        };
        dispatch::examine(&text, "the source", function).map_err(|error| fail(&error))?;
        let mut kernel = Kernel::of_function(gpu, &text, "the source", function).map_err(|error| fail(&error))?;
        let signature = kernel.signature();
        signature.expect(&formula.arguments, &formula.result).map_err(|error| Failure(error.to_string()))?;
        crate::accuracy_line::check_fields(&bounds, &formula.result)
            .map_err(|fault| fail(&format!("within: {fault}")))?;
        let tolerance = Tolerance::new(&formula.arguments, &formula.result, &bounds);
        let report = Check { formula: &formula, kernel: &mut kernel, tolerance: &tolerance }
            .run(settings, &cases)
            .map_err(|error| fail(&error))?;
        let Some(shrunk) = &report.shrunk else { return edges(&formula, &report, settings) };
        let at = FailureAt::at(&formula, &mut kernel, &tolerance, shrunk).map_err(|error| fail(&error))?;
        Err(Failure(describe(&formula, &report, &at, settings)))
    }
}

/// No error at all, in any field.
fn exact(result: &Shape) -> Vec<FieldBound> {
    let none = |field| FieldBound { field, bound: Bound::default() };
    match result {
        Shape::Struct(_, fields) => fields.iter().map(|(name, _)| none(Some(name.clone()))).collect(),
        _ => vec![none(None)],
    }
}

/// Whether all edges were reached, in a run of the default size or more.
fn edges(formula: &Formula, report: &Report, settings: Settings) -> Outcome {
    let missed: Vec<&str> = report.missed_edges().collect();
    if settings.cases < Settings::default().cases || missed.is_empty() {
        return Ok(());
    }
    let missed = missed.join("`, `");
    Err(Failure(format!("{}: no input reached `{missed}`; mend the inputs, or the edge", formula.function)))
}

fn describe(formula: &Formula, report: &Report, at: &FailureAt, settings: Settings) -> String {
    let mut text = format!(
        "{}: {} of {} inputs failed; {}\n  {} = {}\n  expected {}\n",
        formula.function,
        report.failed,
        report.cases,
        report.reason.as_deref().unwrap_or("the worst"),
        at.wgsl,
        at.got,
        at.expected
    );
    for field in &at.fields {
        let name = if field.field.is_empty() { String::new() } else { format!("{} ", field.field) };
        let backward = if field.backward_ulp > 0.0 {
            format!(", and what {} ulp of the input explain", field.backward_ulp)
        } else {
            String::new()
        };
        let _ = writeln!(text, "  allowed {name}± {:.3e}{backward}", field.allowed);
    }
    let _ = writeln!(text, "  in Rust: {} = {}, the shader {}", at.rust, at.mirror_rust, at.got_rust);
    let Settings { cases, seed } = settings;
    let _ = write!(text, "  seed {seed}, {cases} inputs; again with {SEED_VARIABLE}={seed}");
    text
}
