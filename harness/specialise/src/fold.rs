//! Folds everything known about one function: scalars with constant operands, loads of local
//! variables whose value is known, and the branches, switches and loops that depend on them.
//!
//! A single walk visits the body in the order of control flow, with the known values of the local
//! variables. Where paths meet, a variable stays known if they agree on it; across a loop, it stays
//! known if the loop never writes it. Expressions are replaced in place, so that handles stay
//! valid: nothing is renumbered here.

mod control;

use super::operands;
use super::value::{Globals, Value, evaluate, same_bits};
use naga::{
    Arena, Block, Expression, Function, Handle, Literal, LocalVariable, Module, Range, Span, Statement, TypeInner,
};
use std::collections::{BTreeMap, HashMap, HashSet};

/// The known value of a local variable.
#[derive(Clone, Copy)]
enum Held {
    /// A scalar constant.
    Literal(Literal),
    /// The value of an expression that is in scope.
    Expression(Handle<Expression>),
    /// A vector, as written in the variable's initial value. No statement evaluates that
    /// expression, so a load is replaced by a copy of it.
    Initial(Handle<Expression>),
}

impl Held {
    fn is(self, other: Held) -> bool {
        match (self, other) {
            (Held::Literal(left), Held::Literal(right)) => same_bits(left, right),
            (Held::Expression(left), Held::Expression(right)) | (Held::Initial(left), Held::Initial(right)) => {
                left == right
            }
            _ => false,
        }
    }
}

/// The values of local variables, as far as they are known.
type Known = HashMap<Handle<LocalVariable>, Held>;

/// Whether control continues after a block. It does not if every path ends in a return, discard,
/// break or continue.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Flow {
    GoesOn,
    Ends,
}

/// Folds a function in place. `module` provides types and constants; its functions are not read.
pub(super) fn fold_function(module: &mut Module, function: &mut Function) {
    let mut known = initial_values(module, function);
    let body = std::mem::take(&mut function.body);
    let mut folder =
        Folder { module, expressions: &mut function.expressions, stands_for: BTreeMap::new(), scope: Vec::new() };
    let (body, _) = folder.block(body, &mut known);
    let stands_for = folder.stands_for;
    function.body = body;
    // `let x = v;` names a load that is gone: the name moves to the value, unless the value has its
    // own.
    for (expression, value) in stands_for {
        if let Some(name) = function.named_expressions.get(&expression).cloned()
            && !function.expressions[value].needs_pre_emit()
        {
            function.named_expressions.entry(value).or_insert(name);
        }
    }
}

/// Returns the values of the local variables on entry. A scalar holds its initial value, or the
/// zero that WGSL assigns without one; a vector is known only if its initial value is written out.
fn initial_values(module: &Module, function: &Function) -> Known {
    let globals = Globals::of(module);
    let value = |local: &LocalVariable| match local.init {
        Some(init) => Value::scalar(globals, &function.expressions, init),
        None => globals.zero(local.ty),
    };
    let vector = |local: &LocalVariable| {
        let init = local.init?;
        let is_plain = |part: &Handle<Expression>| function.expressions[*part].needs_pre_emit();
        let is_plain = match &function.expressions[init] {
            Expression::Compose { components, .. } => components.iter().all(is_plain),
            Expression::Splat { value, .. } => is_plain(value),
            _ => false,
        };
        let is_vector = matches!(module.types[local.ty].inner, TypeInner::Vector { .. });
        (is_plain && is_vector).then_some(Held::Initial(init))
    };
    let held = |(handle, local)| Some((handle, value(local).map(Held::Literal).or_else(|| vector(local))?));
    function.local_variables.iter().filter_map(held).collect()
}

struct Folder<'a> {
    module: &'a mut Module,
    expressions: &'a mut Arena<Expression>,
    /// Replacements: for a `select` on a constant, the operand that it takes; for a load, the value
    /// that it finds.
    stands_for: BTreeMap<Handle<Expression>, Handle<Expression>>,
    /// The expressions evaluated so far that may be used, in order.
    scope: Vec<Handle<Expression>>,
}

impl Folder<'_> {
    /// Folds the statements of a block; drops those that can never be reached.
    fn block(&mut self, block: Block, known: &mut Known) -> (Block, Flow) {
        let mut folded = Block::with_capacity(block.len());
        for (mut statement, span) in block.span_into_iter() {
            // The operand of a loop is used only at its end.
            if !matches!(statement, Statement::Loop { .. }) {
                operands::of_statement(&mut statement, &mut |operand| *operand = self.resolve(*operand));
            }
            let flow = match statement {
                Statement::Emit(range) => self.emit(range, span, known, &mut folded),
                // In naga's IR a block's variables belong to the function, so the block can be
                // dissolved.
                Statement::Block(inner) => {
                    let (mut inner, flow) = self.block(inner, known);
                    folded.append(&mut inner);
                    flow
                }
                Statement::If { condition, accept, reject } => {
                    self.branch(condition, [accept, reject], span, known, &mut folded)
                }
                Statement::Switch { selector, cases } => self.switch(selector, cases, span, known, &mut folded),
                Statement::Loop { body, continuing, break_if } => {
                    self.repeat(body, continuing, break_if, span, known, &mut folded)
                }
                Statement::Return { .. } | Statement::Kill | Statement::Break | Statement::Continue => {
                    folded.push(statement, span);
                    Flow::Ends
                }
                other => {
                    self.write(&other, known);
                    folded.push(other, span);
                    Flow::GoesOn
                }
            };
            if flow == Flow::Ends {
                return (folded, Flow::Ends);
            }
        }
        (folded, Flow::GoesOn)
    }

    /// Folds a block that stays inside its statement, so that values evaluated in it cannot be used
    /// after it.
    fn inner_block(&mut self, block: Block, known: &mut Known) -> (Block, Flow) {
        let outer = self.scope.len();
        let folded = self.block(block, known);
        let inner: HashSet<_> = self.scope.drain(outer..).collect();
        known.retain(|_, held| !matches!(held, Held::Expression(value) if inner.contains(value)));
        folded
    }

    /// Folds the expressions that are evaluated here. A literal must not be emitted, so the range
    /// is split at literals.
    fn emit(&mut self, range: Range<Expression>, span: Span, known: &Known, folded: &mut Block) -> Flow {
        let mut part: Option<(Handle<Expression>, Handle<Expression>)> = None;
        let mut finish = |part: &mut Option<_>| {
            if let Some((first, last)) = part.take() {
                folded.push(Statement::Emit(Range::new_from_bounds(first, last)), span);
            }
        };
        for expression in range {
            self.expression(expression, known);
            self.scope.push(expression);
            if self.expressions[expression].needs_pre_emit() {
                finish(&mut part);
            } else {
                part = Some((part.map_or(expression, |(first, _)| first), expression));
            }
        }
        finish(&mut part);
        Flow::GoesOn
    }

    /// Replaces an expression by its value if that is known.
    fn expression(&mut self, handle: Handle<Expression>, known: &Known) {
        let mut expression = self.expressions[handle].clone();
        operands::of_expression(&mut expression, &mut |operand| *operand = self.resolve(*operand));
        let value = match expression {
            Expression::Load { pointer } => match self.expressions[pointer] {
                Expression::LocalVariable(local) => match known.get(&local) {
                    Some(Held::Literal(literal)) => Some(*literal),
                    Some(Held::Expression(value)) => {
                        self.stands_for.insert(handle, *value);
                        None
                    }
                    Some(Held::Initial(value)) => {
                        expression = self.expressions[*value].clone();
                        None
                    }
                    None => None,
                },
                _ => None,
            },
            Expression::Select { condition, accept, reject } => {
                if let Some(condition) = self.boolean(condition) {
                    self.stands_for.insert(handle, if condition { accept } else { reject });
                }
                None
            }
            _ => evaluate(self.module, self.expressions, &expression),
        };
        *self.expressions.get_mut(handle) = value.map_or(expression, Expression::Literal);
    }

    /// Returns the expression that replaces an operand, or the operand itself.
    fn resolve(&self, operand: Handle<Expression>) -> Handle<Expression> {
        // One step is enough: a replacement was itself an operand, and so already resolved.
        self.stands_for.get(&operand).copied().unwrap_or(operand)
    }

    fn scalar(&self, expression: Handle<Expression>) -> Option<Literal> {
        Value::scalar(Globals::of(self.module), self.expressions, expression)
    }

    fn boolean(&self, expression: Handle<Expression>) -> Option<bool> {
        match self.scalar(expression)? {
            Literal::Bool(value) => Some(value),
            _ => None,
        }
    }

    /// Records the writes of a simple statement to local variables.
    fn write(&mut self, statement: &Statement, known: &mut Known) {
        if let Statement::Store { pointer, value } = *statement
            && let Expression::LocalVariable(local) = self.expressions[pointer]
        {
            match self.held(value) {
                Some(held) => known.insert(local, held),
                None => known.remove(&local),
            };
            return;
        }
        if let Statement::Call { result: Some(result), .. } = statement {
            self.scope.push(*result);
        }
        let mut written = HashSet::new();
        self.written_by(statement, &mut written);
        forget(known, &written);
    }

    /// Returns the value that a variable holds after an expression is stored in it; `None` for
    /// results of atomics and the like, which are not tracked.
    fn held(&self, value: Handle<Expression>) -> Option<Held> {
        let usable = self.expressions[value].needs_pre_emit() || self.scope.contains(&value);
        self.scalar(value).map(Held::Literal).or(usable.then_some(Held::Expression(value)))
    }

    /// Collects the local variables that a statement may write, apart from the statements inside
    /// it. A pointer that is passed on counts as written.
    fn written_by(&self, statement: &Statement, written: &mut HashSet<Handle<LocalVariable>>) {
        let pointers = match statement {
            Statement::Store { pointer, .. } => vec![*pointer],
            other => operands::list_of_statement(other),
        };
        written.extend(pointers.iter().filter_map(|pointer| operands::local_of_pointer(self.expressions, *pointer)));
    }

    /// Collects the local variables that may be written anywhere in a block.
    fn written_in(&self, block: &Block, written: &mut HashSet<Handle<LocalVariable>>) {
        operands::for_each_statement(block, &mut |statement| self.written_by(statement, written));
    }
}

fn forget(known: &mut Known, written: &HashSet<Handle<LocalVariable>>) {
    known.retain(|local, _| !written.contains(local));
}
