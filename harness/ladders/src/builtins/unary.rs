//! Built-ins of one float, measured over all floats.

use super::measured::{Measured, Start};
use lapidary_assay::dispatch::DispatchError;
use lapidary_assay::interpreter::Float;
use lapidary_assay::slack::allowance::{Accuracy as _, Wgsl};
use rayon::prelude::*;

/// A built-in function.
pub(super) struct Builtin {
    pub(super) name: &'static str,
    truth: Truth,
    ranges: &'static [Range],
}

/// The exact result of a built-in.
enum Truth {
    /// WGSL states the accuracy.
    Stated(Float),
    /// WGSL derives the accuracy from other functions, or does not state it.
    Derived(fn(f64) -> f64),
}

impl Builtin {
    fn is(&self, function: Float) -> bool {
        matches!(self.truth, Truth::Stated(stated) if stated == function)
    }
}

/// A range of arguments: magnitudes up to a limit, and whether WGSL states an accuracy for them.
struct Range {
    name: &'static str,
    to: f32,
    is_stated: bool,
}

const ALL: &[Range] = &[Range { name: "all", to: f32::MAX, is_stated: true }];
const ANGLES: &[Range] = &[
    Range { name: "to π", to: std::f32::consts::PI, is_stated: true },
    Range { name: "to 2^7", to: 128.0, is_stated: false },
    Range { name: "to 2^16", to: 65_536.0, is_stated: false },
    Range { name: "beyond", to: f32::MAX, is_stated: false },
];

const fn stated(name: &'static str, function: Float) -> Builtin {
    Builtin { name, truth: Truth::Stated(function), ranges: ALL }
}

const fn derived(name: &'static str, exact: fn(f64) -> f64) -> Builtin {
    Builtin { name, truth: Truth::Derived(exact), ranges: ALL }
}

pub(super) const BUILTINS: [Builtin; 18] = [
    stated("sqrt", Float::Sqrt),
    stated("inverseSqrt", Float::InverseSqrt),
    stated("exp", Float::Exp),
    stated("exp2", Float::Exp2),
    stated("log", Float::Log),
    stated("log2", Float::Log2),
    Builtin { ranges: ANGLES, ..stated("sin", Float::Sin) },
    Builtin { ranges: ANGLES, ..stated("cos", Float::Cos) },
    Builtin { ranges: ANGLES, ..derived("tan", f64::tan) },
    stated("asin", Float::Asin),
    stated("acos", Float::Acos),
    stated("atan", Float::Atan),
    derived("sinh", f64::sinh),
    derived("cosh", f64::cosh),
    derived("tanh", f64::tanh),
    derived("asinh", f64::asinh),
    derived("acosh", f64::acosh),
    derived("atanh", f64::atanh),
];

/// Returns the name of a built-in in the record.
pub(super) fn name(function: Float) -> &'static str {
    let found = BUILTINS.iter().find(|builtin| builtin.is(function));
    found.map_or_else(|| super::binary::name(function), |builtin| builtin.name)
}

/// Returns the range of a built-in that contains an argument; `None` for those without ranges.
pub(super) fn range(function: Float, argument: f32) -> Option<&'static str> {
    let found = BUILTINS.iter().find(|builtin| builtin.is(function))?;
    found.ranges.iter().find(|range| argument.abs() <= range.to).map(|range| range.name)
}

/// Results per row.
const RESULTS: u32 = 64;

/// Rows per dispatch.
const ROWS: u32 = 32_768;

/// Returns the source of a function that takes the first of a series of bit patterns and the
/// distance between them, and returns the results for all of them.
fn source(builtin: &str) -> String {
    let part = |index: u32| {
        let first = 4 * index;
        format!(
            "    {builtin}(bitcast<vec4f>(row.x + row.y * vec4u({first}u, {}u, {}u, {}u))),\n",
            first + 1,
            first + 2,
            first + 3
        )
    };
    let parts: String = (0..RESULTS / 4).map(part).collect();
    format!("fn many(row: vec2u) -> array<vec4f, {}> {{\n  return array<vec4f, {0}>(\n{parts}  );\n}}\n", RESULTS / 4)
}

pub(super) fn measure(start: Start<'_>, stride: u32, tick: &dyn Fn(&str)) -> Result<Vec<Measured>, DispatchError> {
    let mut rows = Vec::new();
    for builtin in &BUILTINS {
        tick(builtin.name);
        let mut runner = start(&source(builtin.name), "many")?;
        let mut found: Vec<Measured> =
            builtin.ranges.iter().map(|range| Measured::new(builtin.name, range.name, range.is_stated)).collect();
        if let Truth::Derived(_) = builtin.truth {
            found.iter_mut().for_each(|row| row.of_wgsl = None);
        }
        let inputs = (1u64 << 32).div_ceil(stride.into());
        let mut results = Vec::new();
        for batch in (0..inputs).step_by((ROWS * RESULTS) as usize) {
            let count = (inputs - batch).min((ROWS * RESULTS).into());
            // The first pattern of each row; the last row may contain more than are left.
            let starts =
                (0..count).step_by(RESULTS as usize).map(|index| ((batch + index) as u32).wrapping_mul(stride));
            let arguments: Vec<u32> = starts.flat_map(|start| [start, stride]).collect();
            runner.run(&arguments, &mut results)?;
            let parts: Vec<Vec<Measured>> = results
                .par_chunks(RESULTS as usize * 512)
                .enumerate()
                .map(|(part, words)| {
                    judged(builtin, &found, batch + part as u64 * u64::from(RESULTS) * 512, (stride, inputs), words)
                })
                .collect();
            for part in parts {
                found = found.into_iter().zip(part).map(|(one, other)| one.join(other)).collect();
            }
        }
        rows.extend(found);
    }
    Ok(rows)
}

/// Measures the results by range; they start with that of input `first`.
fn judged(
    builtin: &Builtin,
    like: &[Measured],
    first: u64,
    (stride, inputs): (u32, u64),
    words: &[u32],
) -> Vec<Measured> {
    let mut found: Vec<Measured> =
        like.iter().map(|row| Measured::new(&row.name, &row.range, row.of_wgsl.is_some())).collect();
    for (index, word) in (first..inputs).zip(words) {
        let x = f32::from_bits((index as u32).wrapping_mul(stride));
        // WGSL does not specify infinities and NaNs, and lets a device treat a subnormal as 0.
        if !x.is_normal() && x != 0.0 {
            continue;
        }
        let place = builtin.ranges.iter().position(|range| x.abs() <= range.to).unwrap_or(0);
        let (exact, slack) = match builtin.truth {
            Truth::Stated(function) => {
                let (exact, slack) = function.exact(x, x);
                (exact, builtin.ranges[place].is_stated.then_some(slack))
            }
            Truth::Derived(exact) => (exact(x.into()), None),
        };
        found[place]
            .add(&[x], f32::from_bits(*word), exact, || slack.map(|slack| Wgsl.reach(None, exact.into(), slack)));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_assay::interpreter::{Nearest, Program};

    /// The kernel evaluates the function for the patterns that it should.
    #[test]
    fn every_pattern_is_met_once() {
        let program = Program::new(&source("sqrt"), "many.wgsl", "many").expect("valid");
        let mut result = Vec::new();
        program.run(&[1f32.to_bits(), 256], &mut Nearest, &mut result).expect("runs");
        assert_eq!(result.len(), RESULTS as usize);
        for (index, word) in (0u32..).zip(&result) {
            let x = f32::from_bits(1f32.to_bits() + 256 * index);
            assert_eq!(f32::from_bits(*word), x.sqrt(), "{index}");
        }
    }

    #[test]
    fn an_error_is_measured_in_units_and_by_what_wgsl_allows() {
        let mut row = Measured::new("exp", "all", true);
        let (exact, slack) = Float::Exp.exact(1.0, 1.0);
        let off = (exact as f32).next_up().next_up().next_up();
        row.add(&[1.0], off, exact, || Some(Wgsl.reach(None, exact.into(), slack)));
        assert!((2.5..3.5).contains(&row.max_ulp), "{row:?}");
        assert!(row.of_wgsl.is_some_and(|share| (share - row.max_ulp / 5.0).abs() < 1e-12), "{row:?}");
        assert_eq!((row.not_nearest, row.at.as_slice()), (1, &[1.0][..]));
    }
}
