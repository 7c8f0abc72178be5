//! Allowed error of a result to first order: the sum over all operations of the allowed error times
//! the derivative of the result with respect to the operation.
//!
//! A call is recorded operation by operation, and the record is run backwards (adjoints, as in
//! automatic differentiation). First order misses the branches that an error changes, and infinite
//! derivatives, such as that of a root at 0; rows with infinite derivatives are counted separately.

use crate::formula::{Formula, Words};
use crate::interpreter::{Exact, Float, Machine, Operation, Program, Registers, Slack, Stopped};
use crate::property::{Settings, alone};
use crate::tolerance::{Tolerance, numbers};
use rayon::prelude::*;

/// Rows that one thread takes at a time.
const ROWS_PER_TASK: usize = 64;

/// Most operations of all rows together; a function that takes long is run on fewer rows.
const MOST_OPERATIONS: u64 = 2_000_000_000;

/// A stated bound compared with the first-order allowance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Allowance {
    /// Rows with a first-order allowance.
    pub rows: u64,
    /// Rows without one: a derivative is not finite, or an argument is subnormal.
    pub beyond: u64,
    /// Largest ratio of a row's allowance to its stated bound.
    pub largest: f64,
    /// Row of the largest ratio.
    pub at: Words,
    /// Float parts of the result.
    pub fields: Vec<Field>,
}

/// A part of the result and its bound.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Field {
    /// Name; empty if the result has no parts.
    pub name: String,
    /// Largest ratio of a row's allowance to its stated bound.
    pub largest: f64,
    /// The same ratio with the error of the result under rounding to nearest added. In an
    /// approximation, most of that is the error of the method.
    pub with_method: f64,
    /// Whether the part is stated to be exact. Then the bound allows only flushing, and is not too
    /// large.
    pub is_exact: bool,
}

/// Largest factor by which a bound may exceed the allowance.
const MOST_SPARE: f64 = 8.0;

impl Field {
    /// Returns whether the bound is neither below the first-order allowance nor far above it.
    pub fn is_fitting(&self) -> bool {
        self.largest <= 1.0 && (self.is_exact || MOST_SPARE * self.with_method >= 1.0)
    }
}

/// Accuracy of each operation.
pub trait Accuracy: Sync {
    /// Returns the largest distance of a result from the exact one, for an operation that WGSL
    /// allows an error of `slack`. `function` holds the function and its first argument, or is
    /// `None` for an infix operator. A power is a logarithm, a product and an exponential (`Log2`,
    /// `None`, `Exp2`).
    fn reach(&self, function: Option<(Float, f32)>, exact: Exact, slack: Slack) -> f64;
}

/// The accuracy that WGSL requires.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wgsl;

impl Accuracy for Wgsl {
    fn reach(&self, _: Option<(Float, f32)>, exact: Exact, slack: Slack) -> f64 {
        super::device::reach(exact, slack)
    }
}

/// An operation in the record.
#[derive(Clone, Copy, Debug)]
struct Node {
    operands: [u32; 2],
    partials: [f64; 2],
    /// Largest error of its result.
    reach: f64,
    /// Error if the result is flushed.
    flushed: f64,
}

/// A machine that rounds to nearest and records operations.
struct Recorder<'a> {
    accuracy: &'a dyn Accuracy,
    nodes: Vec<Node>,
    /// Roundings of the current operation.
    steps: Vec<(Exact, Slack)>,
}

impl Machine for Recorder<'_> {
    const RECORDS: bool = true;

    fn round(&mut self, exact: Exact, slack: Slack) -> f32 {
        self.steps.push((exact, slack));
        exact.value as f32
    }

    fn recorded(&mut self, operation: Operation) -> u32 {
        let reach = match self.steps[..] {
            [] => 0.0,
            // pow(x, y) as exp2(y log2(x)): the errors of the logarithm and the product pass
            // through the power.
            [logarithm, product, power] => {
                let base = operation.function.map_or(1.0, |(_, base)| base);
                let reach_of = |function, (exact, slack): (Exact, Slack)| self.accuracy.reach(function, exact, slack);
                // The derivative with respect to x is y x^(y - 1), so this is |y| x^y.
                let by_logarithm = (operation.partials[0] * logarithm.0.value.exp2()).abs();
                let exponent = reach_of(Some((Float::Log2, base)), logarithm) * by_logarithm;
                let exponent = exponent + reach_of(None, product) * power.0.value.abs();
                reach_of(Some((Float::Exp2, product.0.value as f32)), power) + std::f64::consts::LN_2 * exponent
            }
            _ => self.steps.iter().map(|(exact, slack)| self.accuracy.reach(operation.function, *exact, *slack)).sum(),
        };
        let result = self.steps.last().map_or(0.0, |(exact, _)| exact.value.abs());
        let flushed = if result < f64::from(f32::MIN_POSITIVE) { result } else { 0.0 };
        self.steps.clear();
        let Operation { operands, partials, .. } = operation;
        self.nodes.push(Node { operands, partials, reach, flushed });
        self.nodes.len() as u32
    }
}

/// The first-order analysis of one row.
#[derive(Clone, Debug, Default)]
struct FirstOrder {
    /// The result.
    result: Words,
    /// Largest error of each word of the result.
    reach: Vec<f64>,
    /// Derivatives of each word of the result with respect to each word of the arguments.
    by_argument: Vec<Vec<f64>>,
}

/// Runs a row and propagates the adjoints back through the record.
fn first_order(
    program: &Program,
    registers: &mut Registers,
    accuracy: &dyn Accuracy,
    row: &[u32],
) -> Result<FirstOrder, Stopped> {
    let mut recorder = Recorder { accuracy, nodes: Vec::new(), steps: Vec::new() };
    let mut found = FirstOrder::default();
    program.run_in(registers, row, &mut recorder, &mut found.result)?;
    let mut adjoints = vec![0f64; recorder.nodes.len() + 1];
    for result in program.recorded(registers)? {
        adjoints.fill(0.0);
        adjoints[result as usize] = 1.0;
        let (mut reach, mut flushed) = (0.0, 0f64);
        for (index, node) in recorder.nodes.iter().enumerate().take(result as usize).rev() {
            let adjoint = adjoints[index + 1];
            if adjoint == 0.0 {
                continue;
            }
            if node.reach > 0.0 {
                reach += adjoint.abs() * node.reach;
            }
            // A 0 is not flushed again, so the worst flush of a chain counts. That is too little
            // for independent terms; the runs on flushing devices cover those.
            if node.flushed > 0.0 {
                flushed = flushed.max(adjoint.abs() * node.flushed);
            }
            for (operand, partial) in node.operands.iter().zip(node.partials) {
                if partial != 0.0 && *operand != 0 {
                    adjoints[*operand as usize] += adjoint * partial;
                }
            }
        }
        found.reach.push(reach + flushed);
        // The arguments were recorded first.
        found.by_argument.push(adjoints[1..=row.len()].to_vec());
    }
    Ok(found)
}

/// Compares a formula's stated bound with the first-order allowance, for random inputs and the hard
/// cases.
///
/// # Errors
/// Returns an error if the interpreter cannot run the function, or the function does not end.
pub fn of_formula(
    program: &Program,
    formula: &Formula,
    tolerance: &Tolerance,
    accuracy: &dyn Accuracy,
    settings: Settings,
) -> Result<Allowance, Stopped> {
    let registers = program.registers()?;
    let [_, results] = program.words()?;
    let steps =
        program.run(&formula.domain.row(settings.seed, 0), &mut crate::interpreter::Nearest, &mut Words::new())?;
    let most = MOST_OPERATIONS / (steps.max(1) * results.max(1) as u64);
    let cases = settings.cases.min(most.max(64));
    let random = (0..cases).into_par_iter().map(|row| formula.domain.row(settings.seed, row));
    let rows: Vec<Words> = random.chain(formula.hard_cases.par_iter().map(|case| case.arguments.clone())).collect();
    let shares: Vec<Option<(Vec<f64>, Vec<f64>)>> = rows
        .par_iter()
        .with_min_len(ROWS_PER_TASK)
        .map_init(
            || registers.clone(),
            |registers, row| {
                // A subnormal argument may have been read as 0.
                if alone::has_subnormals(formula, row) {
                    return Ok(None);
                }
                let FirstOrder { result, reach, by_argument } = first_order(program, registers, accuracy, row)?;
                let exact = formula.exact(row);
                let Some(stated) = tolerance.stated(row, &exact, &by_argument) else { return Ok(None) };
                let shares = |reach: &[f64]| -> Option<Vec<f64>> {
                    let shares = tolerance.largest_of_parts(reach).into_iter().zip(&stated);
                    shares.map(|(reach, stated)| Some(reach / stated).filter(|share| share.is_finite())).collect()
                };
                let found = numbers(&formula.result, &result);
                let off = found.iter().zip(&exact).zip(&reach);
                let off: Vec<f64> = off.map(|((found, exact), reach)| reach + (found - exact).abs()).collect();
                Ok(shares(&reach).zip(shares(&off)))
            },
        )
        .collect::<Result<_, Stopped>>()?;
    let fields =
        tolerance.fields().map(|(name, is_exact)| Field { name: name.to_owned(), is_exact, ..Field::default() });
    let mut found = Allowance { fields: fields.collect(), ..Allowance::default() };
    for (row, shares) in rows.iter().zip(shares) {
        let Some((shares, off)) = shares else {
            found.beyond += 1;
            continue;
        };
        let share = shares.iter().copied().fold(0.0, f64::max);
        found.fields.iter_mut().zip(&shares).for_each(|(field, share)| field.largest = field.largest.max(*share));
        found.fields.iter_mut().zip(&off).for_each(|(field, share)| field.with_method = field.with_method.max(*share));
        if share > found.largest {
            found.largest = share;
            found.at.clone_from(row);
        }
        found.rows += 1;
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draws::mix;
    use crate::interpreter::Nearest;
    use crate::slack::{Device, Mode};

    fn program(expression: &str) -> Program {
        let source = format!("fn f(x: f32, y: f32) -> f32 {{ return {expression}; }}");
        Program::new(&source, "test.wgsl", "f").expect("valid")
    }

    fn of(program: &Program, [x, y]: [f32; 2]) -> FirstOrder {
        let mut registers = program.registers().expect("runs");
        first_order(program, &mut registers, &Wgsl, &[x.to_bits(), y.to_bits()]).expect("ends")
    }

    fn value(program: &Program, [x, y]: [f32; 2], machine: &mut impl Machine) -> f64 {
        let mut result = Words::new();
        program.run(&[x.to_bits(), y.to_bits()], machine, &mut result).expect("ends");
        f64::from(f32::from_bits(result[0]))
    }

    const EXPRESSIONS: [&str; 26] = [
        "x + y",
        "x - y",
        "x * y",
        "x / y",
        "-x",
        "abs(y - 4.0f)",
        "sqrt(x)",
        "inverseSqrt(x)",
        "exp(x)",
        "exp2(x)",
        "log(x)",
        "log2(y)",
        "pow(x, y)",
        "sin(x)",
        "cos(x)",
        "tan(x)",
        "asin(x)",
        "acos(x)",
        "atan(x)",
        "atan2(x, y)",
        "mix(x, y, 0.3f)",
        "min(x, y) * max(x, y)",
        "clamp(x, 0.1f, 0.9f) + clamp(y, 0.0f, 1.0f)",
        "dot(vec3f(x, y, 1.0f), vec3f(y, y, x))",
        "length(vec2f(x, y))",
        "smoothstep(0.0f, 4.0f, x + y)",
    ];

    #[test]
    fn derivatives_are_those_of_the_function() {
        let (arguments, step) = ([0.625f32, 1.75f32], 1.0 / 256.0);
        for expression in EXPRESSIONS {
            let program = program(expression);
            let found = of(&program, arguments).by_argument;
            for (place, derivative) in found[0].iter().enumerate() {
                let beside = |sign: f32| {
                    let mut moved = arguments;
                    moved[place] += sign * step;
                    value(&program, moved, &mut Nearest)
                };
                let quotient = (beside(1.0) - beside(-1.0)) / f64::from(2.0 * step);
                assert!(
                    (quotient - derivative).abs() < 1e-3 * (1.0 + derivative.abs()),
                    "{expression}: {derivative}, {quotient}"
                );
            }
        }
    }

    #[test]
    fn an_allowance_is_what_the_operations_may_add() {
        let unit = 2f64.powi(-23);
        // Exact operations; one rounding; a rounding in the unit of 8192 that the difference leaves;
        // a quotient and functions with bounds of their own.
        for (expression, arguments, reach) in [
            ("x + y", [0.5, 0.25], 0.0),
            ("x * 2.0f", [0.3, 0.0], 0.0),
            ("x + y", [1.0, 1e-9], unit),
            ("(x + 8192.0f) - 8192.0f", [0.3, 0.0], 8192.0 * unit),
            ("x / y", [1.0, 3.0], 2.5 * unit / 4.0),
            ("sin(x)", [1.0, 0.0], 2f64.powi(-11)),
            ("0.3f * sin(x)", [0.5, 0.0], f64::from(0.3f32) * 2f64.powi(-11) + unit / 8.0),
        ] {
            let found = of(&program(expression), arguments).reach[0];
            assert!((found - reach).abs() <= 1e-9 * reach, "{expression}: {found:e}, not {reach:e}");
        }
    }

    /// Results of devices stay within the allowance: the second order is far below the first here.
    #[test]
    fn no_device_exceeds_it() {
        for expression in EXPRESSIONS {
            let program = program(expression);
            for row in 0..64 {
                let share = |place: u64| (mix(row ^ mix(place)) >> 40) as f32 / 16_777_216.0;
                let arguments = [0.1 + 0.8 * share(1), 1.1 + 2.0 * share(2)];
                let nearest = value(&program, arguments, &mut Nearest);
                let reach = of(&program, arguments).reach[0];
                for key in 0..64 {
                    let key = mix(key ^ mix(row));
                    let found = value(&program, arguments, &mut Device::new(Mode::of(key), key));
                    // The result under rounding to nearest is itself off by at most as much.
                    assert!(
                        (found - nearest).abs() <= 2.001 * reach,
                        "{expression} at {arguments:?}: {found}, {nearest} ± {reach:e}"
                    );
                }
            }
        }
    }
}
