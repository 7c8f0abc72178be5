//! Folds what is known of one function: scalars whose operands are constants, loads of local variables whose value is
//! known, and the branches, switches and loops that depend on them.
//!
//! One walk through the body in order of control, with the local variables' known values beside it. Where paths meet,
//! a variable stays known if they agree on it; round a loop it stays known if the loop never writes it. Expressions are
//! replaced where they stand, so that handles stay valid: nothing is renumbered here.

mod control;

use super::operands;
use super::value::{Globals, Value, evaluate, same_bits};
use naga::{
    Arena, Block, Expression, Function, Handle, Literal, LocalVariable, Module, Range, Span, Statement, TypeInner,
};
use std::collections::{BTreeMap, HashMap, HashSet};

/// What a local variable holds.
#[derive(Clone, Copy)]
enum Held {
    /// A scalar constant.
    Literal(Literal),
    /// The value of an expression that is in scope.
    Expression(Handle<Expression>),
    /// A vector, as the variable's own initial value writes it. No statement evaluates that, so a load is replaced by a copy.
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

/// What local variables hold, where that is known.
type Known = HashMap<Handle<LocalVariable>, Held>;

/// Whether control goes on behind a block. It does not behind a return, discard, break or continue on every path.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Flow {
    GoesOn,
    Ends,
}

/// Folds a function in place. `module` lends its types and constants; its functions are not read.
pub(super) fn fold_function(module: &mut Module, function: &mut Function) {
    let mut known = initial_values(module, function);
    let body = std::mem::take(&mut function.body);
    let mut folder =
        Folder { module, expressions: &mut function.expressions, stands_for: BTreeMap::new(), scope: Vec::new() };
    let (body, _) = folder.block(body, &mut known);
    let stands_for = folder.stands_for;
    function.body = body;
    // `let x = v;` names a load that is no longer there: the name goes to the value, unless that has its own.
    for (expression, value) in stands_for {
        if let Some(name) = function.named_expressions.get(&expression).cloned()
            && !function.expressions[value].needs_pre_emit()
        {
            function.named_expressions.entry(value).or_insert(name);
        }
    }
}

/// What each scalar variable holds on entry: its initial value, or the zero that WGSL gives one without. Of vectors those
/// that are written out.
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
    /// The operand that a `select` on a constant takes, and the value that a load finds.
    stands_for: BTreeMap<Handle<Expression>, Handle<Expression>>,
    /// The expressions that have been evaluated up to here and may be used, in order.
    scope: Vec<Handle<Expression>>,
}

impl Folder<'_> {
    /// Folds the statements of a block; what can never be reached behind one is dropped.
    fn block(&mut self, block: Block, known: &mut Known) -> (Block, Flow) {
        let mut folded = Block::with_capacity(block.len());
        for (mut statement, span) in block.span_into_iter() {
            // Of a loop, the operand is used at its end.
            if !matches!(statement, Statement::Loop { .. }) {
                operands::of_statement(&mut statement, &mut |operand| *operand = self.resolve(*operand));
            }
            let flow = match statement {
                Statement::Emit(range) => self.emit(range, span, known, &mut folded),
                // Its variables are the function's, so that nothing in naga's IR needs it to stay one.
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

    /// Folds a block that stays inside its statement, so that what is evaluated in it cannot be used behind it.
    fn inner_block(&mut self, block: Block, known: &mut Known) -> (Block, Flow) {
        let outer = self.scope.len();
        let folded = self.block(block, known);
        let inner: HashSet<_> = self.scope.drain(outer..).collect();
        known.retain(|_, held| !matches!(held, Held::Expression(value) if inner.contains(value)));
        folded
    }

    /// Folds what is evaluated here. A literal must not be emitted, so the range falls into the parts between them.
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

    /// Replaces an expression by its value, where that is known.
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

    /// What an operand has come down to.
    fn resolve(&self, operand: Handle<Expression>) -> Handle<Expression> {
        // What it stands for was an operand itself, and resolved.
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

    /// Notes what a plain statement writes to local variables.
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

    /// What a variable holds once an expression is stored in it. Results of atomics and the like are not followed.
    fn held(&self, value: Handle<Expression>) -> Option<Held> {
        let usable = self.expressions[value].needs_pre_emit() || self.scope.contains(&value);
        self.scalar(value).map(Held::Literal).or(usable.then_some(Held::Expression(value)))
    }

    /// The local variables that a statement may write, without those inside it. A pointer that is handed on counts.
    fn written_by(&self, statement: &Statement, written: &mut HashSet<Handle<LocalVariable>>) {
        let pointers = match statement {
            Statement::Store { pointer, .. } => vec![*pointer],
            other => operands::list_of_statement(other),
        };
        written.extend(pointers.iter().filter_map(|pointer| operands::local_of_pointer(self.expressions, *pointer)));
    }

    /// The local variables that may be written somewhere in a block.
    fn written_in(&self, block: &Block, written: &mut HashSet<Handle<LocalVariable>>) {
        operands::for_each_statement(block, &mut |statement| self.written_by(statement, written));
    }
}

fn forget(known: &mut Known, written: &HashSet<Handle<LocalVariable>>) {
    known.retain(|local, _| !written.contains(local));
}
