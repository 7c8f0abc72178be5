//! A failing input with the results of the shader, the mirror and the oracle, and the allowed
//! error.

use crate::dispatch::DispatchError;
use crate::formula::{Formula, Words};
use crate::literal::{Language, call, value, values};
use crate::runner::Runner;
use crate::tolerance::{Allowed, Tolerance, number, word};

/// A failing input and its results, as literals and as numbers.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Failure {
    /// The call in WGSL.
    pub wgsl: String,
    /// The call of the mirror in Rust.
    pub rust: String,
    /// The arguments alone, in Rust.
    pub arguments_rust: String,
    /// The shader's result as a WGSL literal.
    pub got: String,
    /// The oracle's result, rounded to f32, as a WGSL literal.
    pub expected: String,
    /// The mirror's result as a WGSL literal.
    pub mirror: String,
    /// The shader's result in Rust.
    pub got_rust: String,
    /// The oracle's result in Rust.
    pub expected_rust: String,
    /// The mirror's result in Rust.
    pub mirror_rust: String,
    /// The numbers, one entry per scalar, vector or matrix column of the result.
    pub fields: Vec<Field>,
}

/// A part of a result.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Field {
    /// Path of the part, as `field.member[index]`; empty if the result has one part.
    pub field: String,
    /// Components of the shader's result.
    pub got: Vec<f64>,
    /// Components of the mirror's result.
    pub mirror: Vec<f64>,
    /// Components of the oracle's result.
    pub expected: Vec<f64>,
    /// Allowed error of a component; 0 for a flag or an integer.
    pub allowed: f64,
    /// Additional error of the input, in ulp, for which the result still counts as right.
    pub backward_ulp: f64,
}

/// Formats the call and its result, the expected result and the allowed error for pasting, one line
/// each.
impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "  {} = {}\n  expected {}", self.wgsl, self.got, self.expected)?;
        for field in &self.fields {
            let name = if field.field.is_empty() { String::new() } else { format!("{} ", field.field) };
            write!(f, "  allowed {name}± {:.3e}", field.allowed)?;
            if field.backward_ulp > 0.0 {
                write!(f, ", and what {} ulp of the input explain", field.backward_ulp)?;
            }
            writeln!(f)?;
        }
        writeln!(f, "  in Rust: {} = {}, the shader {}", self.rust, self.mirror_rust, self.got_rust)
    }
}

impl Failure {
    /// Runs shader, mirror and oracle at one input.
    pub fn at(
        formula: &Formula,
        runner: &mut dyn Runner,
        tolerance: &Tolerance,
        arguments: &Words,
    ) -> Result<Failure, DispatchError> {
        let mut got = Words::new();
        runner.run(arguments, &mut got)?;
        let (mirrored, exact) = (formula.mirrored(arguments), formula.exact(arguments));
        let rounded: Words =
            formula.result.scalars().iter().zip(&exact).map(|(kind, number)| word(*kind, *number)).collect();
        let fields = tolerance
            .allowed(&exact)
            .into_iter()
            .map(|Allowed { leaf, allowed, backward }| {
                let range = leaf.start..leaf.start + leaf.length;
                let numbers =
                    |words: &[u32]| words[range.clone()].iter().map(|bits| number(leaf.scalar, *bits)).collect();
                Field {
                    got: numbers(&got),
                    mirror: numbers(&mirrored),
                    expected: exact[range.clone()].to_vec(),
                    field: leaf.path,
                    allowed,
                    backward_ulp: backward,
                }
            })
            .collect();
        let [wgsl, rust] = [Language::Wgsl, Language::Rust];
        Ok(Failure {
            wgsl: call(wgsl, formula, arguments),
            rust: call(rust, formula, arguments),
            arguments_rust: values(rust, formula, arguments),
            got: value(wgsl, formula, &got),
            expected: value(wgsl, formula, &rounded),
            mirror: value(wgsl, formula, &mirrored),
            got_rust: value(rust, formula, &got),
            expected_rust: value(rust, formula, &rounded),
            mirror_rust: value(rust, formula, &mirrored),
            fields,
        })
    }
}
