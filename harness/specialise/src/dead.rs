//! Drops code without effect: stores to variables that are never read, calls of pure functions
//! whose result is never read, and the branches and loops that contain nothing else.
//!
//! Everything is assumed dead until something that matters needs it. Returns, discards, writes to
//! anything that is not the function's own, and whatever other invocations may see matter. The
//! order of statements does not change.

use super::operands;
use naga::{Arena, Block, Expression, Function, Handle, LocalVariable, Module, Statement};
use std::collections::{HashMap, HashSet};

/// Drops the dead statements of every function, and the names of dead expressions, since naga keeps
/// every named expression.
pub(super) fn drop_dead_statements(module: &mut Module) {
    let pure = pure_functions(module);
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    for function in functions.chain(module.entry_points.iter_mut().map(|entry| &mut entry.function)) {
        let body = std::mem::take(&mut function.body);
        let mut uses = Uses::of(function, &body, &pure);
        let body = uses.keep_needed(body);
        let live = uses.live;
        function.body = body;
        function.named_expressions.retain(|expression, _| live.contains(expression));
    }
}

/// Returns the functions that change nothing but their own variables, so that a call is needed only
/// for its result.
fn pure_functions(module: &Module) -> HashSet<Handle<Function>> {
    let mut pure = HashSet::new();
    // A function comes after those that it calls.
    for (handle, function) in module.functions.iter() {
        let mut is_pure = true;
        operands::for_each_statement(&function.body, &mut |statement| {
            is_pure &= match statement {
                Statement::Emit(_)
                | Statement::Block(_)
                | Statement::If { .. }
                | Statement::Switch { .. }
                | Statement::Loop { .. }
                | Statement::Break
                | Statement::Continue
                | Statement::Return { .. } => true,
                Statement::Store { pointer, .. } => {
                    operands::local_of_pointer(&function.expressions, *pointer).is_some()
                }
                Statement::Call { function, .. } => pure.contains(function),
                _ => false,
            }
        });
        if is_pure {
            pure.insert(handle);
        }
    }
    pure
}

/// Whether a `break` and a `continue` matter at this place.
#[derive(Clone, Copy)]
struct Leaving {
    by_break: bool,
    by_continue: bool,
}

/// The expressions and variables used by the needed statements of a function. Both sets only grow.
struct Uses<'a> {
    expressions: &'a Arena<Expression>,
    pure: &'a HashSet<Handle<Function>>,
    live: HashSet<Handle<Expression>>,
    read: HashSet<Handle<LocalVariable>>,
}

impl<'a> Uses<'a> {
    fn of(function: &'a Function, body: &Block, pure: &'a HashSet<Handle<Function>>) -> Self {
        let mut uses = Uses { expressions: &function.expressions, pure, live: HashSet::new(), read: HashSet::new() };
        // A store is needed once its variable is read, perhaps by an earlier statement: repeat
        // until nothing is new.
        loop {
            let before = uses.live.len();
            uses.block_is_needed(body, Leaving { by_break: true, by_continue: true });
            if uses.live.len() == before {
                return uses;
            }
        }
    }

    /// Marks an expression and all its operands as live.
    fn mark(&mut self, expression: Handle<Expression>) {
        let mut pending = vec![expression];
        while let Some(expression) = pending.pop() {
            if self.live.insert(expression) {
                if let Expression::LocalVariable(local) = self.expressions[expression] {
                    self.read.insert(local);
                }
                pending.extend(operands::list_of_expression(&self.expressions[expression]));
            }
        }
    }

    /// Whether any statement of the block is needed. Visits every statement, and marks what the
    /// needed ones use.
    fn block_is_needed(&mut self, block: &Block, leaving: Leaving) -> bool {
        let mut needed = false;
        for statement in block.iter() {
            needed |= self.is_needed(statement, leaving);
        }
        needed
    }

    /// Whether any statement of the blocks inside `statement` is needed; marks in the same way.
    fn inside_is_needed(&mut self, statement: &Statement, leaving: Leaving) -> bool {
        let mut needed = false;
        for block in operands::blocks(statement) {
            needed |= self.block_is_needed(block, leaving);
        }
        needed
    }

    /// Whether a statement is needed, as far as is known yet. If it is, marks what it uses.
    fn is_needed(&mut self, statement: &Statement, leaving: Leaving) -> bool {
        let needed = match statement {
            // An emitted expression is needed only by its users.
            Statement::Emit(_) => false,
            Statement::Break => leaving.by_break,
            Statement::Continue => leaving.by_continue,
            Statement::Store { pointer, .. } => match operands::local_of_pointer(self.expressions, *pointer) {
                Some(local) => self.read.contains(&local),
                None => true,
            },
            Statement::Call { function, result, .. } => {
                !self.pure.contains(function) || result.is_some_and(|result| self.live.contains(&result))
            }
            Statement::Block(_) | Statement::If { .. } | Statement::Switch { .. } | Statement::Loop { .. } => {
                let inside = self.leaving_from_inside(statement, leaving);
                self.inside_is_needed(statement, inside)
            }
            _ => true,
        };
        if needed {
            operands::list_of_statement(statement).into_iter().for_each(|operand| self.mark(operand));
        }
        needed
    }

    /// Returns whether a `break` and a `continue` inside a statement matter.
    ///
    /// A `break` out of a switch matters if anything else in the switch does. A `break` or
    /// `continue` of a loop matters if anything else in the loop does. A loop without effect is
    /// assumed to end.
    fn leaving_from_inside(&mut self, statement: &Statement, leaving: Leaving) -> Leaving {
        match statement {
            Statement::Switch { .. } => {
                let quiet = Leaving { by_break: false, ..leaving };
                Leaving { by_break: self.inside_is_needed(statement, quiet), ..leaving }
            }
            Statement::Loop { .. } => {
                let quiet = Leaving { by_break: false, by_continue: false };
                let matters = self.inside_is_needed(statement, quiet);
                Leaving { by_break: matters, by_continue: matters }
            }
            _ => leaving,
        }
    }

    /// Returns the block without the statements that are not needed.
    fn keep_needed(&mut self, block: Block) -> Block {
        self.keep(block, Leaving { by_break: true, by_continue: true })
    }

    fn keep(&mut self, block: Block, leaving: Leaving) -> Block {
        let mut kept = Block::with_capacity(block.len());
        for (mut statement, span) in block.span_into_iter() {
            let emits = matches!(statement, Statement::Emit(_));
            if !emits && !self.is_needed(&statement, leaving) {
                continue;
            }
            let inside = self.leaving_from_inside(&statement, leaving);
            let mut keep = |inner: &mut Block| *inner = self.keep(std::mem::take(inner), inside);
            match &mut statement {
                Statement::Block(block) => keep(block),
                Statement::If { accept, reject, .. } => {
                    keep(accept);
                    keep(reject);
                }
                Statement::Switch { cases, .. } => cases.iter_mut().for_each(|case| keep(&mut case.body)),
                Statement::Loop { body, continuing, .. } => {
                    keep(body);
                    keep(continuing);
                }
                _ => {}
            }
            kept.push(statement, span);
        }
        kept
    }
}

/// Drops the local variables that no expression refers to. The module is compact, so every
/// expression in it is in use.
pub(super) fn drop_unused_locals(module: &mut Module) {
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    for function in functions.chain(module.entry_points.iter_mut().map(|entry| &mut entry.function)) {
        let named = |expression: &Expression| match expression {
            Expression::LocalVariable(local) => Some(*local),
            _ => None,
        };
        let used: HashSet<_> = function.expressions.iter().filter_map(|(_, expression)| named(expression)).collect();
        let mut kept = Arena::new();
        let mut moved = HashMap::new();
        for (handle, local, span) in function.local_variables.drain() {
            if used.contains(&handle) {
                moved.insert(handle, kept.append(local, span));
            }
        }
        function.local_variables = kept;
        for (_, expression) in function.expressions.iter_mut() {
            if let Expression::LocalVariable(local) = expression {
                *local = moved[local];
            }
        }
    }
}

/// Removes the names of unused constants, since naga keeps every named constant.
pub(super) fn forget_unused_constants(module: &mut Module) {
    let mut used = HashSet::new();
    let functions = module.functions.iter().map(|(_, function)| function);
    for function in functions.chain(module.entry_points.iter().map(|entry| &entry.function)) {
        for (_, expression) in function.expressions.iter() {
            if let Expression::Constant(constant) = expression {
                used.insert(*constant);
            }
        }
    }
    let mut pending: Vec<_> = used.iter().map(|constant| module.constants[*constant].init).collect();
    pending.extend(module.global_variables.iter().filter_map(|(_, variable)| variable.init));
    while let Some(expression) = pending.pop() {
        let expression = &module.global_expressions[expression];
        if let Expression::Constant(constant) = *expression
            && used.insert(constant)
        {
            pending.push(module.constants[constant].init);
        }
        pending.extend(operands::list_of_expression(expression));
    }
    for (handle, constant) in module.constants.iter_mut() {
        if !used.contains(&handle) {
            constant.name = None;
        }
    }
}
