//! Mutation of a WGSL function on naga's IR: one operator, comparison or constant changed at a
//! time. If the tests pass on a mutant, they do not test the changed part.
//! [`Test::mutate`](crate::Test::mutate) judges all mutants of a function by its own test.

mod judge;

pub use judge::Judge;

use crate::dispatch::{DispatchError, KernelModule};
use naga::{BinaryOperator, Expression, Handle, Literal, ScalarKind, UnaryOperator};
use std::fmt;

/// Factor on a constant: 1 + 2⁻⁶, far above any tolerance and far below any other value that a
/// formula might hold.
const NUDGE: f32 = 1.0 + 1.0 / 64.0;

/// A single change.
#[derive(Clone, Debug, PartialEq)]
enum Edit {
    Binary(BinaryOperator),
    /// `-x` instead of `x * s` or `s * x` for a vector `x` and a scalar `s`, of which naga's IR has
    /// no quotient.
    Negate(Handle<Expression>),
    /// `x` instead of `-x`, for an `x` of this kind.
    Keep(ScalarKind),
    Literal(Literal),
}

/// Place of a change.
#[derive(Clone, Debug, PartialEq)]
enum Site {
    /// An expression of a function, by its index in the compacted function.
    Expression(usize),
    /// The value of a module's const.
    Constant,
}

/// A mutant: the place of a change, and the change.
#[derive(Clone, Debug, PartialEq)]
pub struct Mutant {
    /// Name of the WGSL function or const.
    pub owner: String,
    /// Line of source, trimmed.
    pub line: String,
    /// Number among the sites on that line with the same change, from 1 on.
    pub occurrence: usize,
    /// Change, in the form `Add -> Subtract`.
    pub change: String,
    site: Site,
    edit: Edit,
}

/// Formats a name that stays the same if other lines change.
impl fmt::Display for Mutant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} | {} | {}", self.owner, self.line, self.change)?;
        if self.occurrence > 1 { write!(f, " | {}", self.occurrence) } else { Ok(()) }
    }
}

/// The number of mutants of a function, and those that its tests miss.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// Number of mutants, including those of the consts that the function uses.
    pub mutants: usize,
    /// Mutants that no test notices.
    pub survivors: Vec<Mutant>,
}

impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {} mutants caught", self.mutants - self.survivors.len(), self.mutants)?;
        self.survivors.iter().try_for_each(|survivor| write!(f, "\n  survived: {survivor}"))
    }
}

/// The mutants of a function.
#[derive(Clone, Debug)]
pub struct Mutants {
    /// Valid mutants, in the same order in every run.
    pub valid: Vec<Mutant>,
    /// Number of further changes that make the program invalid.
    pub invalid: usize,
}

/// Returns every mutant of the named function of `source`, and of the consts that it uses; `path`
/// appears in messages.
///
/// # Errors
/// Returns an error if the source is not valid, or has no such function.
pub fn of_function(source: &str, path: &str, function: &str) -> Result<Mutants, DispatchError> {
    let kernel = compacted(KernelModule::reflect(source, path, function)?);
    let (valid, invalid): (Vec<_>, Vec<_>) =
        mutants(source, function, &kernel).into_iter().partition(|mutant| apply(&kernel, mutant).is_some());
    Ok(Mutants { valid, invalid: invalid.len() })
}

/// Removes everything from a kernel that its function does not use, so that every expression is
/// live.
fn compacted(mut kernel: KernelModule) -> KernelModule {
    naga::compact::compact(&mut kernel.module, naga::compact::KeepUnused::No);
    kernel
}

/// Returns every change to the named function of `source`, and to the consts that it uses; `kernel`
/// is the function's own, compacted. A change may make the program invalid.
fn mutants(source: &str, function: &str, kernel: &KernelModule) -> Vec<Mutant> {
    let mut mutants: Vec<Mutant> = Vec::new();
    let mut add = |owner: &str, span: naga::Span, site: Site, change: String, edit: Edit| {
        let start = span.to_range().map_or(0, |range| range.start);
        let line = source[..start.min(source.len())].matches('\n').count();
        let line = source.lines().nth(line).unwrap_or_default().trim().to_owned();
        let same = |other: &&Mutant| other.owner == owner && other.line == line && other.change == change;
        let occurrence = mutants.iter().filter(same).count() + 1;
        mutants.push(Mutant { owner: owner.to_owned(), line, occurrence, change, site, edit });
    };
    let ir = &kernel.module;
    let info = lapidary_specialise::validate(ir).expect("a kernel is valid");
    for (owner, found) in ir.functions.iter().filter(|(_, found)| found.name.as_deref() == Some(function)) {
        let operands = Operands {
            is_vector: &|handle| matches!(info[owner][handle].ty.inner_with(&ir.types), naga::TypeInner::Vector { .. }),
            kind: &|handle| info[owner][handle].ty.inner_with(&ir.types).scalar_kind(),
        };
        for (handle, expression) in found.expressions.iter() {
            let span = found.expressions.get_span(handle);
            for (change, edit) in edits(&operands, expression) {
                add(function, span, Site::Expression(handle.index()), change, edit);
            }
        }
    }
    // Compaction keeps every const with a name. A const that no function reads is for recipes, and
    // no run can tell its value.
    let read: Vec<Handle<naga::Constant>> = ir
        .functions
        .iter()
        .flat_map(|(_, function)| function.expressions.iter())
        .filter_map(|(_, expression)| match expression {
            Expression::Constant(constant) => Some(*constant),
            _ => None,
        })
        .collect();
    for (_, constant) in ir.constants.iter().filter(|(handle, _)| read.contains(handle)) {
        let Some(name) = constant.name.as_deref() else { continue };
        // A const holds a literal.
        for (change, edit) in
            edits(&Operands { is_vector: &|_| false, kind: &|_| None }, &ir.global_expressions[constant.init])
        {
            add(name, ir.global_expressions.get_span(constant.init), Site::Constant, change, edit);
        }
    }
    mutants
}

/// Returns the kernel with one change, or `None` if the kernel lacks the site or the change makes
/// the program invalid.
fn apply(kernel: &KernelModule, mutant: &Mutant) -> Option<KernelModule> {
    let mut mutated = kernel.clone();
    let ir = &mut mutated.module;
    match mutant.site {
        Site::Constant => {
            let (_, constant) = ir.constants.iter().find(|(_, c)| c.name.as_deref() == Some(&mutant.owner))?;
            let init = constant.init;
            edit(ir.global_expressions.get_mut(init), &mutant.edit);
        }
        Site::Expression(index) => {
            let (_, function) =
                ir.functions.iter_mut().find(|(_, function)| function.name.as_deref() == Some(&mutant.owner))?;
            let handle = function.expressions.iter().map(|(handle, _)| handle).nth(index)?;
            edit(function.expressions.get_mut(handle), &mutant.edit);
        }
    }
    lapidary_specialise::validate(&mutated.module).ok()?;
    Some(mutated)
}

fn edit(expression: &mut Expression, edit: &Edit) {
    let replacement = match (&*expression, edit) {
        (Expression::Binary { left, right, .. }, Edit::Binary(op)) => {
            Expression::Binary { op: *op, left: *left, right: *right }
        }
        (Expression::Binary { .. }, Edit::Negate(vector)) => {
            Expression::Unary { op: UnaryOperator::Negate, expr: *vector }
        }
        (Expression::Unary { expr, .. }, Edit::Keep(kind)) => {
            // A conversion to its own type, since no expression can stand for another.
            Expression::As { expr: *expr, kind: *kind, convert: Some(4) }
        }
        (Expression::Literal(_), Edit::Literal(literal)) => Expression::Literal(*literal),
        (other, edit) => unreachable!("{edit:?} was made for another expression than {other:?}"),
    };
    *expression = replacement;
}

/// Types of an expression's operands.
struct Operands<'a> {
    is_vector: &'a dyn Fn(Handle<Expression>) -> bool,
    kind: &'a dyn Fn(Handle<Expression>) -> Option<ScalarKind>,
}

/// Returns the changes to an expression.
fn edits(operands: &Operands<'_>, expression: &Expression) -> Vec<(String, Edit)> {
    match expression {
        Expression::Binary { op, left, right } => {
            operators(*op)
                .iter()
                .map(|other| {
                    // Only a vector times a scalar mixes types.
                    match mixed_vector(operands.is_vector, *left, *right).filter(|_| *other == BinaryOperator::Divide) {
                        Some(vector) => (format!("{op:?} -> negated vector"), Edit::Negate(vector)),
                        None => (format!("{op:?} -> {other:?}"), Edit::Binary(*other)),
                    }
                })
                .collect()
        }
        Expression::Unary { op: UnaryOperator::Negate, expr } => {
            (operands.kind)(*expr).map(|kind| ("Negate -> nothing".to_owned(), Edit::Keep(kind))).into_iter().collect()
        }
        Expression::Literal(literal) => literals(*literal)
            .into_iter()
            .map(|other| (format!("{} -> {}", spell(*literal), spell(other)), Edit::Literal(other)))
            .collect(),
        _ => Vec::new(),
    }
}

/// Returns the vector in a product of a vector and a scalar, or `None` if both sides have one type.
fn mixed_vector(
    is_vector: &dyn Fn(Handle<Expression>) -> bool,
    left: Handle<Expression>,
    right: Handle<Expression>,
) -> Option<Handle<Expression>> {
    match (is_vector(left), is_vector(right)) {
        (true, false) => Some(left),
        (false, true) => Some(right),
        _ => None,
    }
}

fn operators(op: BinaryOperator) -> &'static [BinaryOperator] {
    use BinaryOperator as Op;
    match op {
        Op::Add => &[Op::Subtract],
        Op::Subtract => &[Op::Add],
        Op::Multiply => &[Op::Divide],
        Op::Divide | Op::Modulo => &[Op::Multiply],
        // Each comparison loses or gains its boundary, or is reversed.
        Op::Less => &[Op::LessEqual, Op::Greater],
        Op::LessEqual => &[Op::Less, Op::GreaterEqual],
        Op::Greater => &[Op::GreaterEqual, Op::Less],
        Op::GreaterEqual => &[Op::Greater, Op::LessEqual],
        Op::Equal => &[Op::NotEqual],
        Op::NotEqual => &[Op::Equal],
        Op::LogicalAnd => &[Op::LogicalOr],
        Op::LogicalOr => &[Op::LogicalAnd],
        Op::And => &[Op::InclusiveOr],
        Op::InclusiveOr | Op::ExclusiveOr => &[Op::And],
        Op::ShiftLeft => &[Op::ShiftRight],
        Op::ShiftRight => &[Op::ShiftLeft],
    }
}

fn literals(literal: Literal) -> Vec<Literal> {
    match literal {
        // Neither a factor nor a sign changes 0.
        Literal::F32(0.0) => vec![Literal::F32(NUDGE - 1.0)],
        Literal::F32(value) => vec![Literal::F32(value * NUDGE), Literal::F32(-value), Literal::F32(0.0)],
        Literal::I32(value) => {
            vec![Literal::I32(value.wrapping_add(1)), Literal::I32(value.wrapping_neg()), Literal::I32(0)]
        }
        Literal::U32(value) => vec![Literal::U32(value.wrapping_add(1)), Literal::U32(0)],
        Literal::Bool(value) => vec![Literal::Bool(!value)],
        _ => Vec::new(),
    }
    .into_iter()
    .filter(|other| *other != literal)
    .collect()
}

fn spell(literal: Literal) -> String {
    match literal {
        Literal::F32(value) => format!("{value:?}f"),
        Literal::U32(value) => format!("{value}u"),
        Literal::I32(value) => format!("{value}i"),
        Literal::Bool(value) => value.to_string(),
        other => format!("{other:?}"),
    }
}
