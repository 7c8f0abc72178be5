//! "Edit a function and check it": for every function with a bound, inputs as `cook check` draws them and the
//! results that hold there on any device that conforms to WGSL, as data that a page judges by; and the editor.
//!
//! `data/rows/FUNCTION.js` holds a function's kernel and its rows: the hard
//! cases, [`DRAWN`] random inputs, and one more input for each edge of the domain that those miss. Intervals come
//! from [`lapidary_assay::property::accepted`], which shares its code with the check's judgement.

mod pack;

use super::data::{self, DataError};
use super::templates::{self, Markup};
use lapidary_assay::accuracy_line::{Accuracy, FieldBound};
use lapidary_assay::dispatch::layout::Layout;
use lapidary_assay::dispatch::{DispatchError, ENTRY_POINT, KernelText, WORKGROUP_SIZE, kernel_source};
use lapidary_assay::formula::{Formula, Words};
use lapidary_assay::property::{DEFAULT_CASES, Settings, accepted};
use lapidary_assay::shape::Shape;
use lapidary_assay::slack::Reassociation;
use lapidary_assay::tolerance::Accepted;
use lapidary_cook::check;
use lapidary_cook::formulas;
use lapidary_cookbook::header::FunctionDoc;
use lapidary_cookbook::{self as cookbook, Module};
use rayon::prelude::*;
use serde::Serialize;
use std::path::Path;

/// Random inputs of a function, the first that `cook check` draws.
pub const DRAWN: u64 = 512;

/// Why the rows were not written.
#[derive(Debug, thiserror::Error)]
pub enum RowsError {
    /// A function of the cookbook cannot be made into a kernel.
    #[error("wgsl/{module}.wgsl: {error}")]
    Kernel {
        /// Name of the module.
        module: &'static str,
        /// The underlying error.
        error: DispatchError,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Data(#[from] DataError),
}

/// What was written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Number of functions.
    pub functions: usize,
    /// Number of rows of all functions.
    pub rows: usize,
    /// Size of all files in bytes.
    pub bytes: usize,
}

/// A function as the page loads it.
#[derive(Serialize)]
struct FunctionData<'a> {
    function: &'a str,
    module: &'a str,
    /// The bounds that any conforming device keeps, in the words of the `Accuracy:` line.
    accuracy: String,
    /// WGSL to append to the module's text.
    kernel: String,
    entry: &'a str,
    workgroup: u32,
    input: Place<'a>,
    output: Place<'a>,
    arguments: Vec<Value<'a>>,
    result: Value<'a>,
    /// Number of rows: those of the hard cases, the drawn ones, and those of the edges, in this order.
    count: usize,
    hard: Vec<&'a str>,
    edges: Vec<&'a str>,
    seed: u64,
    /// The rows, packed: see [`pack`].
    rows: String,
}

/// Where a row's words lie in a buffer, in bytes.
#[derive(Serialize)]
struct Place<'a> {
    stride: usize,
    offsets: &'a [usize],
}

impl<'a> From<&'a Layout> for Place<'a> {
    fn from(layout: &'a Layout) -> Self {
        Self { stride: layout.stride, offsets: &layout.offsets }
    }
}

/// An argument or a result: its WGSL type, and its scalars, vectors and columns.
#[derive(Serialize)]
struct Value<'a> {
    name: &'a str,
    parts: Vec<Part>,
}

#[derive(Serialize)]
struct Part {
    path: String,
    kind: &'static str,
    length: usize,
    /// The part's bound, without its name; empty for an argument.
    #[serde(skip_serializing_if = "String::is_empty")]
    bound: String,
}

/// Writes the rows of every function with a bound into `data/rows` of the site's folder.
///
/// # Errors
/// Returns an error if the file system fails.
pub fn write(folder: &Path) -> Result<Summary, RowsError> {
    write_of(folder, |_| true)
}

/// Writes the same for the modules that `selects` chooses.
///
/// # Errors
/// Returns an error if the file system fails.
pub fn write_of(folder: &Path, selects: impl Fn(&Module) -> bool + Sync) -> Result<Summary, RowsError> {
    let modules: Vec<&Module> = cookbook::modules().iter().filter(|module| selects(module)).collect();
    let functions: Vec<(&Module, &FunctionDoc, &Formula)> =
        modules.iter().flat_map(|module| checked(module).map(|(doc, formula)| (*module, doc, formula))).collect();
    let mut summary = Summary { functions: functions.len(), ..Summary::default() };
    // Functions take very different times.
    let written: Vec<(usize, usize)> = functions
        .par_iter()
        .with_max_len(1)
        .map(|(module, doc, formula)| write_function(folder, module, doc, formula))
        .collect::<Result<_, _>>()?;
    for (count, bytes) in written {
        summary.rows += count;
        summary.bytes += bytes;
    }
    Ok(summary)
}

/// Returns the editor of a module's functions, or `None` if none of them has a bound. Its page needs
/// `assets/check.css`, `assets/check.js`, `assets/editor.js`, `data/source/MODULE.js` and the files of [`write()`].
pub fn editor(module: &Module) -> Option<Markup> {
    #[derive(Serialize)]
    struct Function<'a> {
        name: &'a str,
        accuracy: String,
    }
    #[derive(Serialize)]
    struct Editor<'a> {
        module: &'a str,
        functions: Vec<Function<'a>>,
        drawn: u64,
    }
    let functions: Vec<Function<'_>> =
        checked(module).map(|(doc, _)| Function { name: &doc.name, accuracy: promise(doc) }).collect();
    let editor = Editor { module: module.name, functions, drawn: DRAWN };
    (!editor.functions.is_empty()).then(|| templates::render("editor.html", editor))
}

/// Returns the functions of a module that promise something, with their formulas.
pub(super) fn checked(module: &Module) -> impl Iterator<Item = (&FunctionDoc, &'static Formula)> {
    let promising = module.functions.iter().filter(|doc| bounds(doc).is_some());
    promising.filter_map(|doc| {
        let formula = formulas::of_function(&doc.name).filter(|formula| formula.benign.is_none())?;
        Some((doc, formula))
    })
}

/// Returns the bounds that hold on any conforming device.
fn bounds(doc: &FunctionDoc) -> Option<&[FieldBound]> {
    match &doc.accuracy {
        Accuracy::Naive => None,
        Accuracy::Bounded { portable, .. } => Some(portable),
    }
}

/// Formats those bounds in the words of the `Accuracy:` line.
fn promise(doc: &FunctionDoc) -> String {
    bounds(doc).unwrap_or_default().iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// Writes a function's file; returns its number of rows and its size.
fn write_function(
    folder: &Path,
    module: &Module,
    doc: &FunctionDoc,
    formula: &'static Formula,
) -> Result<(usize, usize), RowsError> {
    let kernel = KernelText::of_function(module.source, module.name, formula.function)
        .map_err(|error| RowsError::Kernel { module: formula.module, error })?;
    let seed = Settings::default().seed;
    let (rows, edges) = rows(formula, seed);
    let tolerance = check::tolerance(check::On::Slack(Reassociation::Written), formula);
    let accepted: Vec<Vec<Accepted>> = rows.par_iter().map(|row| accepted(formula, &tolerance, row)).collect();
    let exact: Vec<Vec<f64>> = rows.iter().map(|row| formula.exact(row)).collect();
    let values = FunctionData {
        function: formula.function,
        module: formula.module,
        accuracy: promise(doc),
        kernel: kernel_source(&kernel.signature),
        entry: ENTRY_POINT,
        workgroup: WORKGROUP_SIZE,
        input: (&kernel.input).into(),
        output: (&kernel.output).into(),
        arguments: kernel.signature.arguments.iter().map(|(name, shape)| value(name, shape, &[])).collect(),
        result: value("", &formula.result, bounds(doc).unwrap_or_default()),
        count: rows.len(),
        hard: formula.hard_cases.iter().map(|case| case.name).collect(),
        edges,
        seed,
        rows: pack::packed(&formula.result, &rows, &exact, &accepted),
    };
    Ok((rows.len(), data::deliver(folder, &["rows/", formula.function].concat(), &values)?))
}

/// Returns the inputs of a function, and the names of the edges that only the last of them reach.
fn rows(formula: &Formula, seed: u64) -> (Vec<Words>, Vec<&str>) {
    let drawn: Vec<Words> = (0..DRAWN).map(|row| formula.domain.row(seed, row)).collect();
    let missed = formula.edges.iter().filter(|edge| !drawn.iter().any(|row| (edge.reached)(row)));
    let found = missed.filter_map(|edge| {
        let mut later = (DRAWN..DEFAULT_CASES).map(|row| formula.domain.row(seed, row));
        Some((later.find(|row| (edge.reached)(row))?, edge.name))
    });
    let (at_edges, edges): (Vec<Words>, Vec<&str>) = found.unzip();
    let hard = formula.hard_cases.iter().map(|case| case.arguments.clone());
    (hard.chain(drawn).chain(at_edges).collect(), edges)
}

fn value<'a>(name: &'a str, shape: &Shape, bounds: &[FieldBound]) -> Value<'a> {
    let bound_of = |path: &str| {
        let field = path.split(['.', '[']).next().unwrap_or_default();
        let of_field = |bound: &&FieldBound| bound.field.as_deref().is_none_or(|name| name == field);
        let bound = bounds.iter().find(of_field)?;
        Some(FieldBound { field: None, bound: bound.bound }.to_string())
    };
    let parts = shape.leaves().into_iter().map(|leaf| Part {
        bound: bound_of(&leaf.path).unwrap_or_default(),
        kind: leaf.scalar.name(),
        length: leaf.length,
        path: leaf.path,
    });
    Value { name, parts: parts.collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_function_with_a_bound_is_in_its_modules_editor() {
        let promised = formulas::promised().count();
        let shown: Vec<&str> = cookbook::modules().iter().flat_map(checked).map(|(doc, _)| doc.name.as_str()).collect();
        assert_eq!(shown.len(), promised);
        let files: BTreeSet<&str> = cookbook::modules().iter().map(|module| module.name).chain(shown).collect();
        assert_eq!(files.len(), promised + cookbook::modules().len(), "a function with the name of a module");
        for module in cookbook::modules() {
            let editor = editor(module).expect("a function to check");
            for (doc, _) in checked(module) {
                assert!(editor.0.contains(&format!("value=\"{}\"", doc.name)), "{}", doc.name);
            }
            assert!(!editor.0.contains("_naive"), "{}", module.name);
        }
    }

    #[test]
    fn rows_begin_with_the_hard_cases_and_end_with_missed_edges() {
        let seed = Settings::default().seed;
        for formula in formulas::promised() {
            let (rows, edges) = rows(formula, seed);
            let hard = formula.hard_cases.len();
            assert_eq!(rows.len(), hard + DRAWN as usize + edges.len(), "{}", formula.function);
            assert_eq!(rows[hard], formula.domain.row(seed, 0));
            for edge in &formula.edges {
                assert!(rows[hard..].iter().any(|row| (edge.reached)(row)), "{}: {}", formula.function, edge.name);
            }
        }
    }
}
