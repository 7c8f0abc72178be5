//! Function arguments: an argument that is the same constant in every call becomes that constant,
//! and an argument that is never read is no longer passed.

use super::operands;
use super::value::{Globals, Value};
use naga::{Binding, Constant, Expression, Function, FunctionArgument, Handle, Module, Span, Statement};
use std::collections::HashMap;

/// Replaces each argument by its value if every call passes the same constant; returns whether
/// there was any.
///
/// Entry points are left alone, since the pipeline calls them.
pub(super) fn propagate_constant_arguments(module: &mut Module) -> bool {
    let calls = common_arguments(module);
    let mut changed = false;
    for (callee, arguments) in calls {
        for (index, value) in arguments.into_iter().enumerate() {
            let Some(value) = value else { continue };
            let is_argument =
                |expression: &Expression| matches!(expression, Expression::FunctionArgument(i) if *i as usize == index);
            let function = &module.functions[callee];
            if !function.expressions.iter().any(|(_, expression)| is_argument(expression)) {
                continue;
            }
            let constant = match value {
                Value::Literal(literal) => Expression::Literal(literal),
                Value::Constant(constant) => Expression::Constant(constant),
                Value::Zero(ty) => Expression::ZeroValue(ty),
                // The parts of a composite cannot be inserted before it among the function's
                // expressions, so it becomes a constant of the module.
                composite => {
                    let ty = function.arguments[index].ty;
                    let init = composite.write(&mut module.global_expressions);
                    Expression::Constant(module.constants.append(Constant { name: None, ty, init }, Span::UNDEFINED))
                }
            };
            for (_, expression) in module.functions.get_mut(callee).expressions.iter_mut() {
                if is_argument(expression) {
                    *expression = constant.clone();
                }
            }
            changed = true;
        }
    }
    changed
}

/// Returns, for each called function and each of its arguments, the constant that all calls pass;
/// `None` if they differ.
fn common_arguments(module: &Module) -> Vec<(Handle<Function>, Vec<Option<Value>>)> {
    let globals = Globals::of(module);
    let mut common: HashMap<Handle<Function>, Vec<Option<Value>>> = HashMap::new();
    let functions = module.functions.iter().map(|(_, function)| function);
    for caller in functions.chain(module.entry_points.iter().map(|entry| &entry.function)) {
        operands::for_each_statement(&caller.body, &mut |statement| {
            let Statement::Call { function, arguments, .. } = statement else { return };
            let passed = arguments.iter().map(|argument| Value::of(globals, &caller.expressions, *argument));
            match common.get_mut(function) {
                None => {
                    common.insert(*function, passed.collect());
                }
                Some(common) => {
                    for (common, passed) in common.iter_mut().zip(passed) {
                        if !matches!((&common, passed), (Some(common), Some(passed)) if common.is(&passed)) {
                            *common = None;
                        }
                    }
                }
            }
        });
    }
    // Module order, so that the same module always gives the same result.
    let mut common: Vec<_> = common.into_iter().collect();
    common.sort_by_key(|(callee, _)| callee.index());
    common
}

/// Drops the arguments that no expression refers to, from functions and from their calls, and from
/// entry points the built-in values among them; returns whether there was any. The module is
/// compact, so every expression in it is in use.
pub(super) fn drop_unread_arguments(module: &mut Module) -> bool {
    let mut kept: HashMap<Handle<Function>, Vec<usize>> = HashMap::new();
    for (handle, function) in module.functions.iter_mut() {
        if let Some(read) = drop_unread(function, |_| true) {
            kept.insert(handle, read);
        }
    }
    let mut dropped = !kept.is_empty();
    for entry in &mut module.entry_points {
        // A struct is the interface to another stage.
        let is_built_in = |argument: &FunctionArgument| matches!(argument.binding, Some(Binding::BuiltIn(_)));
        dropped |= drop_unread(&mut entry.function, is_built_in).is_some();
    }
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    for caller in functions.chain(module.entry_points.iter_mut().map(|entry| &mut entry.function)) {
        operands::for_each_statement_mut(&mut caller.body, &mut |statement| {
            if let Statement::Call { function, arguments, .. } = statement
                && let Some(kept) = kept.get(function)
            {
                *arguments = kept.iter().map(|index| arguments[*index]).collect();
            }
        });
    }
    dropped
}

/// Drops those arguments of a function that no expression refers to and that `may_go`; returns the
/// indices of the others, or `None` if there was nothing to drop.
fn drop_unread(function: &mut Function, may_go: impl Fn(&FunctionArgument) -> bool) -> Option<Vec<usize>> {
    let read = |index: usize| {
        let names = |expression: &Expression| matches!(expression, Expression::FunctionArgument(number) if *number as usize == index);
        function.expressions.iter().any(|(_, expression)| names(expression))
    };
    let stays = |index: &usize| read(*index) || !may_go(&function.arguments[*index]);
    let kept: Vec<usize> = (0..function.arguments.len()).filter(stays).collect();
    if kept.len() == function.arguments.len() {
        return None;
    }
    function.arguments = kept.iter().map(|index| function.arguments[*index].clone()).collect();
    for (_, expression) in function.expressions.iter_mut() {
        if let Expression::FunctionArgument(index) = expression {
            let position = kept.binary_search(&(*index as usize)).expect("every argument that is named was read");
            *index = u32::try_from(position).expect("moved towards the front");
        }
    }
    Some(kept)
}
