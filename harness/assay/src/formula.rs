//! A formula: a WGSL function with its mirror, its oracle, the domain of its inputs, the edges that
//! the domain must reach, its invariants, its hard cases, and its promises outside the domain.

pub use crate::near::near;

use crate::draws::{Domain, Draws};
use crate::outside::Promise;
use crate::shape::Shape;
use crate::tolerance::number;
use crate::value::{Arguments, Exact, Function, Value};

/// The words of a row.
pub type Words = Vec<u32>;
/// A mirror on words: appends the words of the result.
pub type MirrorFn = Box<dyn Fn(&[u32], &mut Words) + Send + Sync>;
/// An oracle on numbers: appends the numbers of the result.
pub type OracleFn = Box<dyn Fn(&[f64], &mut Vec<f64>) + Send + Sync>;
/// Appends the other input.
type Transform = Box<dyn Fn(&[u32], &mut Words) + Send + Sync>;
type Predicate = Box<dyn Fn(&[u32]) -> bool + Send + Sync>;
/// Describes the fault for these arguments and this result of the shader.
type Invariance = Box<dyn Fn(&[u32], &[u32]) -> Result<(), String> + Send + Sync>;
/// Describes the fault for the results at two related inputs.
type Relation = Box<dyn Fn(&[u32], &[u32], &[u32]) -> Result<(), String> + Send + Sync>;

/// A part of the domain that a run must reach.
pub struct Edge {
    /// Name of the part.
    pub name: &'static str,
    /// Whether the arguments lie in the part.
    pub reached: Predicate,
}

/// A mathematical property of every result.
pub struct Invariant {
    /// Statement of the property.
    pub name: &'static str,
    /// Check of the property.
    pub holds: Invariance,
    /// Whether the property applies only to devices that round to nearest.
    pub at_nearest: bool,
}

/// A mathematical relation between the results at two inputs.
pub struct Pair {
    /// Statement of the relation.
    pub name: &'static str,
    /// Derives the other input from the row's.
    pub transform: Transform,
    /// Check of the relation between the row's result and the other's.
    pub holds: Relation,
}

/// An input at which the usual form fails, with the mathematically correct result.
pub struct HardCase {
    /// Reason why the input is hard.
    pub name: &'static str,
    /// The input.
    pub arguments: Words,
    /// Correct result, flattened.
    pub limit: Vec<f64>,
    /// Largest allowed distance of the stable form's result from `limit`, over all components.
    pub bound: f64,
    /// WGSL function that fails here.
    pub naive: &'static str,
    /// Arguments of the naive form, which may take others.
    pub naive_arguments: Words,
    /// Least error of the naive form, as its largest distance from the limit; infinite if the
    /// result must not even be finite.
    pub naive_error: f64,
}

/// A WGSL function with everything that its tests need.
pub struct Formula {
    /// Name of the module.
    pub module: &'static str,
    /// Name of the WGSL function.
    pub function: &'static str,
    /// Shapes of the arguments.
    pub arguments: Vec<Shape>,
    /// Shape of the result.
    pub result: Shape,
    /// The mirror.
    pub mirror: MirrorFn,
    /// The oracle.
    pub oracle: OracleFn,
    /// Generator of the inputs.
    pub domain: Domain<Words>,
    /// Parts that the domain must reach.
    pub edges: Vec<Edge>,
    /// Properties of every result.
    pub invariants: Vec<Invariant>,
    /// Relations between pairs of results.
    pub pairs: Vec<Pair>,
    /// Inputs at which the naive form fails.
    pub hard_cases: Vec<HardCase>,
    /// Relative error that a naive form keeps on its benign domain.
    pub benign: Option<f64>,
    /// Promises outside the domain.
    pub promises: Vec<Promise>,
}

impl std::fmt::Debug for Formula {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Formula").field("function", &self.function).finish_non_exhaustive()
    }
}

impl Formula {
    /// Converts a row's words to the numbers that they represent, as the oracle takes them.
    pub fn numbers(&self, row: &[u32]) -> Vec<f64> {
        let scalars = self.arguments.iter().flat_map(Shape::scalars);
        row.iter().zip(scalars).map(|(word, scalar)| number(scalar, *word)).collect()
    }

    /// Returns the mirror's result at a row.
    pub fn mirrored(&self, row: &[u32]) -> Words {
        let mut result = Words::new();
        (self.mirror)(row, &mut result);
        result
    }

    /// Returns the first invariant that a row's result breaks, with the reason. `is_portable` means
    /// that the device need not round to nearest.
    pub fn broken(&self, row: &[u32], result: &[u32], is_portable: bool) -> Option<(&'static str, String)> {
        let mut said = self.invariants.iter().filter(|invariant| !(is_portable && invariant.at_nearest));
        said.find_map(|invariant| (invariant.holds)(row, result).err().map(|why| (invariant.name, why)))
    }

    /// Returns the oracle's result at a row.
    pub fn exact(&self, row: &[u32]) -> Vec<f64> {
        let mut result = Vec::new();
        (self.oracle)(&self.numbers(row), &mut result);
        result
    }
}

/// Starts a formula with the WGSL function's name, the mirror and the oracle. Argument and result
/// types are the mirror's and are checked against naga's at start-up; the oracle's types must match
/// them.
///
/// # Panics
/// Panics if mirror and oracle differ in shape: a slip in `formulas/`, found by the first test that
/// runs.
pub fn formula<A, R, EA, ER>(
    module: &'static str,
    function: &'static str,
    mirror: impl Function<A, R> + Send + Sync + 'static,
    oracle: impl Function<EA, ER> + Send + Sync + 'static,
    domain: impl Fn(&mut Draws<'_>) -> A + Send + Sync + 'static,
) -> Builder<A, R>
where
    A: Arguments<u32>,
    R: Value,
    EA: Arguments<f64>,
    ER: Exact,
{
    assert_eq!(A::shapes(), EA::shapes(), "{function}: the arguments of mirror and oracle differ");
    assert_eq!(R::shape(), ER::shape(), "{function}: the results of mirror and oracle differ");
    Builder {
        formula: Formula {
            module,
            function,
            arguments: A::shapes(),
            result: R::shape(),
            mirror: Box::new(move |mut words, result| mirror.call(A::read(&mut words)).write(result)),
            oracle: Box::new(move |mut numbers, result| oracle.call(EA::read(&mut numbers)).write(result)),
            domain: Domain::new(move |draws| {
                let mut words = Words::new();
                domain(draws).write(&mut words);
                words
            }),
            edges: Vec::new(),
            invariants: Vec::new(),
            pairs: Vec::new(),
            hard_cases: Vec::new(),
            benign: None,
            promises: Vec::new(),
        },
        cases: Vec::new(),
        types: std::marker::PhantomData,
    }
}

/// Starts a formula without a module, with a typed mirror and an oracle that reads its arguments
/// from numbers.
#[cfg(feature = "gpu")]
pub(crate) fn of_parts<A: Arguments<u32> + 'static, R: Value + 'static>(
    function: &'static str,
    mirror: Box<dyn Fn(A) -> R + Send + Sync>,
    oracle: OracleFn,
    domain: Domain<Words>,
) -> Builder<A, R> {
    Builder {
        formula: Formula {
            module: "",
            function,
            arguments: A::shapes(),
            result: R::shape(),
            mirror: Box::new(move |mut words, result| mirror(A::read(&mut words)).write(result)),
            oracle,
            domain,
            edges: Vec::new(),
            invariants: Vec::new(),
            pairs: Vec::new(),
            hard_cases: Vec::new(),
            benign: None,
            promises: Vec::new(),
        },
        cases: Vec::new(),
        types: std::marker::PhantomData,
    }
}

/// A formula under construction, with its types.
pub struct Builder<A, R> {
    formula: Formula,
    /// Inputs that are always tested.
    #[cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "what tests them needs a device"))]
    cases: Vec<Words>,
    types: std::marker::PhantomData<fn(A) -> R>,
}

impl<A: Arguments<u32> + 'static, R: Value + 'static> Builder<A, R> {
    /// Names a part of the domain that a run of the default size must reach.
    pub fn edge(mut self, name: &'static str, reached: impl Fn(A) -> bool + Send + Sync + 'static) -> Self {
        self.formula.edges.push(Edge { name, reached: Box::new(move |mut words| reached(A::read(&mut words))) });
        self
    }

    /// Adds a mathematical property of every result; the error message states the deviation.
    pub fn invariant(
        self,
        name: &'static str,
        holds: impl Fn(A, R) -> Result<(), String> + Send + Sync + 'static,
    ) -> Self {
        self.said(name, holds, false)
    }

    /// Adds a property that applies only to devices that round sums, products, quotients and roots
    /// to nearest, as the mirrors do: exact results for simple numbers, or a bound that rests on
    /// such rounding. On other devices results come as close to it as the bounds say.
    pub fn invariant_at_nearest(
        self,
        name: &'static str,
        holds: impl Fn(A, R) -> Result<(), String> + Send + Sync + 'static,
    ) -> Self {
        self.said(name, holds, true)
    }

    fn said(
        mut self,
        name: &'static str,
        holds: impl Fn(A, R) -> Result<(), String> + Send + Sync + 'static,
        at_nearest: bool,
    ) -> Self {
        let holds = Box::new(move |mut arguments: &[u32], mut result: &[u32]| {
            holds(A::read(&mut arguments), R::read(&mut result))
        });
        self.formula.invariants.push(Invariant { name, holds, at_nearest });
        self
    }

    /// Adds a mathematical relation between the results at an input and at its image under
    /// `transform`.
    pub fn pair(
        mut self,
        name: &'static str,
        transform: impl Fn(A) -> A + Send + Sync + 'static,
        holds: impl Fn(A, R, R) -> Result<(), String> + Send + Sync + 'static,
    ) -> Self {
        self.formula.pairs.push(Pair {
            name,
            transform: Box::new(move |mut words, other| transform(A::read(&mut words)).write(other)),
            holds: Box::new(move |mut arguments: &[u32], mut result: &[u32], mut other: &[u32]| {
                holds(A::read(&mut arguments), R::read(&mut result), R::read(&mut other))
            }),
        });
        self
    }

    /// Adds a hard case: at `arguments` the result is within `bound` of `limit`, and `naive`, at
    /// the same arguments, is off by `naive_error` or more (infinite: not finite).
    pub fn hard_case(
        self,
        name: &'static str,
        arguments: A,
        (limit, bound): (&[f64], f64),
        (naive, naive_error): (&'static str, f64),
    ) -> Self {
        let mut words = Words::new();
        arguments.write(&mut words);
        self.push_hard_case(name, words.clone(), (limit, bound), naive, words, naive_error)
    }

    /// Adds a hard case whose naive form takes other arguments.
    pub fn hard_case_with<N: Arguments<u32>>(
        self,
        name: &'static str,
        arguments: A,
        limit: (&[f64], f64),
        (naive, naive_arguments, naive_error): (&'static str, N, f64),
    ) -> Self {
        let (mut words, mut naive_words) = (Words::new(), Words::new());
        arguments.write(&mut words);
        naive_arguments.write(&mut naive_words);
        self.push_hard_case(name, words, limit, naive, naive_words, naive_error)
    }

    fn push_hard_case(
        mut self,
        name: &'static str,
        arguments: Words,
        (limit, bound): (&[f64], f64),
        naive: &'static str,
        naive_arguments: Words,
        naive_error: f64,
    ) -> Self {
        let limit = limit.to_vec();
        self.formula.hard_cases.push(HardCase { name, arguments, limit, bound, naive, naive_arguments, naive_error });
        self
    }

    /// Marks the function as a naive form that keeps this relative error on the given benign
    /// domain.
    pub fn benign(mut self, relative: f64) -> Self {
        self.formula.benign = Some(relative);
        self
    }

    /// Adds an input that is always tested.
    #[cfg(feature = "gpu")]
    pub(crate) fn case(mut self, arguments: A) -> Self {
        let mut words = Words::new();
        arguments.write(&mut words);
        self.cases.push(words);
        self
    }

    /// Returns the formula and the inputs that are always tested.
    #[cfg(feature = "gpu")]
    pub(crate) fn build_with_cases(self) -> (Formula, Vec<Words>) {
        (self.formula, self.cases)
    }

    /// Returns the formula.
    pub fn build(self) -> Formula {
        self.formula
    }
}

/// Adds to the formulas the promises of their functions outside their domains.
///
/// # Panics
/// Panics if a promise names a function without a formula, or was made for other arguments: a slip
/// in a module's formulas, found by the first test that runs.
#[must_use]
pub fn with_promises(mut formulas: Vec<Formula>, promises: Vec<Promise>) -> Vec<Formula> {
    for promise in promises {
        let function = promise.function;
        let formula = formulas.iter_mut().find(|formula| formula.function == function);
        let formula = formula.unwrap_or_else(|| panic!("{promise:?}: no function `{function}`"));
        assert!(
            !promise.is_tested() || promise.arguments == formula.arguments,
            "{promise:?}: made for other arguments"
        );
        formula.promises.push(promise);
    }
    formulas
}
