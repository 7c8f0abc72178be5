//! Values as literals for pasting: Rust for the mirrors' crates, WGSL for a shader. Decimals are
//! the shortest that identify the f32 exactly.

use crate::formula::Formula;
use crate::shape::{Scalar, Shape};

/// The language of a literal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// Rust, with glam's types and the module's own crate.
    Rust,
    /// WGSL, with the short names of types.
    Wgsl,
}

/// Formats the call of a formula's function with these arguments: the WGSL function, or its mirror.
pub fn call(language: Language, formula: &Formula, arguments: &[u32]) -> String {
    let name = match language {
        Language::Wgsl => formula.function.to_owned(),
        Language::Rust => {
            let prefix = format!("{}_", formula.module);
            let name = formula.function.strip_prefix(&prefix).unwrap_or(formula.function);
            format!("{}{name}", path(formula.module))
        }
    };
    format!("{name}({})", values(language, formula, arguments))
}

/// Formats a row of arguments, separated by commas.
pub fn values(language: Language, formula: &Formula, arguments: &[u32]) -> String {
    let mut rest = arguments;
    let values: Vec<String> =
        formula.arguments.iter().map(|shape| write(language, formula.module, shape, &mut rest)).collect();
    values.join(", ")
}

/// Formats a value of a formula's result.
pub fn value(language: Language, formula: &Formula, words: &[u32]) -> String {
    let mut rest = words;
    write(language, formula.module, &formula.result, &mut rest)
}

/// Formats a value of a shape; structs have their names alone, without a path.
pub fn of_shape(language: Language, shape: &Shape, words: &[u32]) -> String {
    let mut rest = words;
    write(language, "", shape, &mut rest)
}

/// Formats a value and removes its words from the front.
fn write(language: Language, module: &str, shape: &Shape, words: &mut &[u32]) -> String {
    use Language::{Rust, Wgsl};
    let mut list = |shapes: &mut dyn Iterator<Item = &Shape>| -> Vec<String> {
        shapes.map(|shape| write(language, module, shape, words)).collect()
    };
    match shape {
        Shape::Scalar(kind) => {
            let (first, rest) = words.split_first().unwrap_or((&0, &[]));
            *words = rest;
            scalar(language, *kind, *first)
        }
        Shape::Vector(size, kind) => {
            let element = Shape::Scalar(*kind);
            let parts = list(&mut std::iter::repeat_n(&element, usize::from(*size))).join(", ");
            match language {
                Wgsl => format!("{shape}({parts})"),
                Rust => format!("{}Vec{size}::new({parts})", prefix(*kind)),
            }
        }
        Shape::Matrix(columns, rows) => {
            let column = Shape::Vector(*rows, Scalar::F32);
            let parts = list(&mut std::iter::repeat_n(&column, usize::from(*columns))).join(", ");
            match language {
                Wgsl => format!("{shape}({parts})"),
                // The mirrors' matrices are square.
                Rust => format!("Mat{columns}::from_cols({parts})"),
            }
        }
        Shape::Array(element, length) => {
            let parts = list(&mut std::iter::repeat_n(&**element, *length as usize)).join(", ");
            match language {
                Wgsl => format!("{shape}({parts})"),
                Rust => format!("[{parts}]"),
            }
        }
        Shape::Struct(name, fields) => {
            let parts = list(&mut fields.iter().map(|(_, shape)| shape));
            match language {
                Wgsl => format!("{name}({})", parts.join(", ")),
                Rust => {
                    let members: Vec<String> =
                        fields.iter().zip(&parts).map(|((name, _), part)| format!("{name}: {part}")).collect();
                    format!("{}{name} {{ {} }}", path(module), members.join(", "))
                }
            }
        }
    }
}

/// Returns the path before a name in a module's mirror: its crate, or nothing without a module.
fn path(module: &str) -> String {
    if module.is_empty() { String::new() } else { format!("lapidary_{module}::") }
}

/// Returns glam's prefix of `Vec`.
fn prefix(kind: Scalar) -> &'static str {
    match kind {
        Scalar::F32 => "",
        Scalar::I32 => "I",
        Scalar::U32 => "U",
        Scalar::Bool => "B",
    }
}

fn scalar(language: Language, kind: Scalar, word: u32) -> String {
    let rust = language == Language::Rust;
    match kind {
        Scalar::F32 => {
            let value = f32::from_bits(word);
            match (value.is_finite(), rust) {
                (true, true) => format!("{value:?}"),
                (true, false) => format!("{value:?}f"),
                (false, true) => format!("f32::from_bits({word:#x})"),
                (false, false) => format!("bitcast<f32>({word:#x}u)"),
            }
        }
        Scalar::I32 if rust => word.cast_signed().to_string(),
        // -2147483648i would be a minus sign before an out-of-range literal.
        Scalar::I32 => format!("i32({})", word.cast_signed()),
        Scalar::U32 if rust => word.to_string(),
        Scalar::U32 => format!("{word}u"),
        Scalar::Bool => (word != 0).to_string(),
    }
}
