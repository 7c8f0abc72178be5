//! Every function as its library text in GLSL ES 3.00, in Chromium's WebGL 2: what is translated
//! computes what the mirror computes.

use super::{browser, found};
use lapidary_assay::dispatch::{DispatchError, ROWS_PER_DISPATCH};
use lapidary_assay::formula::{Formula, Words};
use lapidary_assay::property::{Check, Settings};
use lapidary_assay::runner::Runner;
use lapidary_assay::shape::{Scalar, Shape};
use lapidary_assay::slack::Reassociation;
use lapidary_browser::{Browser, Transform};
use lapidary_cook::check::{self, On};
use lapidary_cook::formulas;
use lapidary_cookbook as cookbook;
use lapidary_translate::{Language, library};

/// Random inputs per function, besides the hard cases.
const CASES: u64 = 256;
/// Texels in a row of the texture of words.
const WIDTH: usize = 1_024;

/// A function as a vertex shader.
struct InWebGl<'browser> {
    browser: &'browser Browser,
    code: String,
    arguments: usize,
    results: usize,
    varyings: Vec<String>,
}

impl<'browser> InWebGl<'browser> {
    fn new(browser: &'browser Browser, formula: &Formula, text: &str) -> Self {
        let arguments: usize = formula.arguments.iter().map(Shape::words).sum();
        let results = formula.result.words();
        let varyings: Vec<String> = (0..results.div_ceil(4)).map(|index| format!("found{index}")).collect();
        let mut place = 0;
        let values: Vec<String> = formula.arguments.iter().map(|shape| made(shape, &mut place)).collect();
        let mut words = Vec::new();
        taken(&formula.result, "result", text, &mut words);
        words.resize(4 * varyings.len(), "0u".to_owned());
        let mut code = format!("#version 300 es\n{text}\nuniform highp usampler2D given;\n");
        for varying in &varyings {
            code.push_str(&format!("flat out uvec4 {varying};\n"));
        }
        code.push_str(&format!(
            "uint word(int at) {{\n    int place = {arguments} * gl_VertexID + at;\n    return texelFetch(given, ivec2(place % {WIDTH}, place / {WIDTH}), 0).x;\n}}\n"
        ));
        code.push_str(&format!(
            "void main() {{\n    {} result = {}({});\n",
            type_of(&formula.result),
            formula.function,
            values.join(", ")
        ));
        for (varying, words) in varyings.iter().zip(words.chunks(4)) {
            code.push_str(&format!("    {varying} = uvec4({});\n", words.join(", ")));
        }
        code.push_str("    gl_Position = vec4(0.0);\n    gl_PointSize = 1.0;\n}\n");
        Self { browser, code, arguments, results, varyings }
    }
}

/// Returns GLSL's name of a type that is no array.
fn type_of(shape: &Shape) -> String {
    let scalar = |scalar: &Scalar| match scalar {
        Scalar::F32 => ("float", ""),
        Scalar::I32 => ("int", "i"),
        Scalar::U32 => ("uint", "u"),
        Scalar::Bool => ("bool", "b"),
    };
    match shape {
        Shape::Scalar(kind) => scalar(kind).0.to_owned(),
        Shape::Vector(size, kind) => format!("{}vec{size}", scalar(kind).1),
        Shape::Matrix(columns, rows) => format!("mat{columns}x{rows}"),
        Shape::Array(element, length) => format!("{}[{length}]", type_of(element)),
        Shape::Struct(name, _) => name.clone(),
    }
}

/// Returns the value of a shape whose words begin at `place`.
fn made(shape: &Shape, place: &mut usize) -> String {
    let mut scalar = |kind: Scalar| {
        let word = format!("word({place})");
        *place += 1;
        match kind {
            Scalar::F32 => format!("uintBitsToFloat({word})"),
            Scalar::I32 => format!("int({word})"),
            Scalar::U32 => word,
            Scalar::Bool => format!("({word} != 0u)"),
        }
    };
    let parts: Vec<String> = match shape {
        Shape::Scalar(kind) => return scalar(*kind),
        Shape::Vector(size, kind) => (0..*size).map(|_| scalar(*kind)).collect(),
        Shape::Matrix(columns, rows) => (0..columns * rows).map(|_| scalar(Scalar::F32)).collect(),
        Shape::Array(element, length) => (0..*length).map(|_| made(element, place)).collect(),
        Shape::Struct(_, fields) => fields.iter().map(|(_, shape)| made(shape, place)).collect(),
    };
    format!("{}({})", type_of(shape), parts.join(", "))
}

/// Adds the words of a value, in order.
fn taken(shape: &Shape, value: &str, text: &str, words: &mut Vec<String>) {
    let scalar = |kind: &Scalar, value: String| match kind {
        Scalar::F32 => format!("floatBitsToUint({value})"),
        Scalar::I32 | Scalar::Bool => format!("uint({value})"),
        Scalar::U32 => value,
    };
    match shape {
        Shape::Scalar(kind) => words.push(scalar(kind, value.to_owned())),
        Shape::Vector(size, kind) => {
            words.extend(
                (0..usize::from(*size)).map(|index| scalar(kind, format!("{value}.{}", ["x", "y", "z", "w"][index]))),
            );
        }
        Shape::Matrix(columns, rows) => {
            for column in 0..*columns {
                taken(&Shape::Vector(*rows, Scalar::F32), &format!("{value}[{column}]"), text, words);
            }
        }
        Shape::Array(element, length) => {
            (0..*length).for_each(|index| taken(element, &format!("{value}[{index}]"), text, words))
        }
        Shape::Struct(_, fields) => {
            for (name, shape) in fields {
                // A keyword ends with an underscore.
                let is_keyword = [";", "["].iter().any(|end| text.contains(&format!(" {name}_{end}")));
                taken(shape, &format!("{value}.{name}{}", if is_keyword { "_" } else { "" }), text, words);
            }
        }
    }
}

impl Runner for InWebGl<'_> {
    fn argument_words(&self) -> usize {
        self.arguments
    }

    fn result_words(&self) -> usize {
        self.results
    }

    fn run(&mut self, arguments: &[u32], results: &mut Vec<u32>) -> Result<(), DispatchError> {
        results.clear();
        for rows in arguments.chunks(ROWS_PER_DISPATCH * self.arguments) {
            let filled: Vec<u8> = rows.iter().flat_map(|word| word.to_le_bytes()).collect();
            let vertices = (rows.len() / self.arguments) as u32;
            let transform = Transform { code: &self.code, varyings: &self.varyings, filled: &filled, vertices };
            let found = self.browser.transform(&transform);
            let found = found.map_err(|error| DispatchError::Runner(format!("{error}\n{}", self.code)))?;
            for row in found.chunks(16 * self.varyings.len()) {
                let words = row.chunks(4).map(|word| u32::from_le_bytes(word.try_into().expect("four bytes")));
                results.extend(words.take(self.results));
            }
        }
        Ok(())
    }

    fn is_portable(&self) -> bool {
        true
    }

    fn loops(&self) -> bool {
        false
    }

    fn stopped(&self, _: usize) -> bool {
        false
    }

    fn any_stopped(&self) -> bool {
        false
    }

    fn why_stopped(&self) -> String {
        String::new()
    }
}

/// Returns the number of failed rows.
fn failed(browser: &Browser, formula: &Formula, text: &str, settings: Settings) -> Result<u64, String> {
    let hard: Vec<Words> = formula.hard_cases.iter().map(|case| case.arguments.clone()).collect();
    let tolerance = check::tolerance(On::Slack(Reassociation::Written), formula);
    let mut runner = InWebGl::new(browser, formula, text);
    let report = Check { formula, runner: &mut runner, tolerance: &tolerance }.run(settings, &hard);
    report.map(|report| report.failed).map_err(|error| error.to_string())
}

fn text(module: &str) -> String {
    let source = cookbook::module(module).expect("a module").source;
    library(source, module, Language::GlslEs).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_function_in_glsl_es_computes_in_webgl_what_its_mirror_does() {
    let stable = lapidary_testing::sampled(formulas::promised(), super::ONE_IN);
    let Some(browser) = found(browser(), &format!("{} functions in GLSL ES", stable.len())) else { return };
    let settings = Settings { cases: CASES, seed: lapidary_testing::seed() };
    let mut faults = Vec::new();
    for formula in stable {
        match failed(&browser, formula, &text(formula.module), settings) {
            Ok(0) => {}
            Ok(count) => faults.push(format!("{}: {count} of {CASES} failed", formula.function)),
            Err(error) => faults.push(format!("{}: {error}", formula.function)),
        }
    }
    assert!(faults.is_empty(), "{}, the first:\n{}", faults.len(), faults[..faults.len().min(8)].join("\n"));
}

/// Another text fails, and so does one that is no GLSL.
#[test]
fn a_changed_text_is_told_in_webgl() {
    let Some(browser) = found(browser(), "a changed text in GLSL ES") else { return };
    let formula = formulas::of_function("fresnel_schlick").expect("a formula");
    let settings = Settings { cases: CASES, ..Settings::default() };
    let right = text("fresnel");
    let wrong = right.replace("1.0 - ", "1.001 - ");
    assert_ne!(right, wrong);
    assert!(failed(&browser, formula, &wrong, settings).is_ok_and(|count| count > CASES / 4));
    assert!(failed(&browser, formula, &right.replace(';', ","), settings).is_err_and(|error| error.contains("syntax")));
}
