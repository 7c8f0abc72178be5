//! Turns (iterations) of loops, counted in the kernel. A driver may end a loop without notice:
//! lavapipe does so after 65,535 turns, counted over all loops of a group of invocations that run
//! together. The result is then not the function's, and an endless loop looks like one that ends.
//! Each kernel with a loop therefore counts its own turns, ends its loops itself a little earlier,
//! and writes the count of each row next to the result.

use super::kernel::ENTRY_POINT;
use lapidary_specialise::for_each_statement;
use naga::{AddressSpace, BinaryOperator, Block, Expression, Handle, Literal, Span, Statement, Type, TypeInner};

/// Most turns of all loops of an invocation together on lavapipe. The margin below lavapipe's own
/// limit exceeds the turns that its compiler adds when it rewrites loops, one or two per loop.
pub(super) const LAVAPIPE_LIMIT: u32 = 65_000;
/// Turns after which lavapipe itself ends loops (Mesa's `LP_MAX_TGSI_LOOP_ITERATIONS`), counted
/// over invocations that run together.
pub(super) const LAVAPIPE_ENDS_AT: u64 = 65_535;
/// Most turns on other devices: a fraction of a second on a GPU, long before its watchdog resets
/// the device.
pub(super) const LIMIT: u32 = 1 << 20;
/// Most lanes that lavapipe runs together; smaller lane counts divide it.
const LANES: u32 = 16;
/// The binding of the counts, in group 0, after the kernel's inputs and outputs.
pub(super) const BINDING: u32 = 2;

/// Makes every loop of `module` count its turns, and the kernel write each row's count at
/// [`BINDING`]. An invocation leaves its loops once they have taken more than `limit` turns.
/// Returns whether there is a loop; a module without one does not change.
pub(super) fn count(module: &mut naga::Module, limit: u32) -> bool {
    if !module.functions.iter().any(|(_, function)| has_loop(&function.body)) {
        return false;
    }
    let scalar = TypeInner::Scalar(naga::Scalar::U32);
    let number = module.types.insert(Type { name: None, inner: scalar }, Span::UNDEFINED);
    let list = TypeInner::Array { base: number, size: naga::ArraySize::Dynamic, stride: 4 };
    let list = module.types.insert(Type { name: None, inner: list }, Span::UNDEFINED);
    let mut variable = |name: &str, space: AddressSpace, binding: Option<u32>, ty: Handle<Type>| {
        let binding = binding.map(|binding| naga::ResourceBinding { group: 0, binding });
        let memory_decorations = naga::MemoryDecorations::empty();
        let variable =
            naga::GlobalVariable { name: Some(name.to_owned()), space, binding, ty, init: None, memory_decorations };
        module.global_variables.append(variable, Span::UNDEFINED)
    };
    let counter = variable("lapidary_kernel_turn", AddressSpace::Private, None, number);
    let access = naga::StorageAccess::LOAD | naga::StorageAccess::STORE;
    let counts = variable("lapidary_kernel_turns", AddressSpace::Storage { access }, Some(BINDING), list);
    for (_, function) in module.functions.iter_mut() {
        let mut body = std::mem::take(&mut function.body);
        count_in(&mut body, &mut function.expressions, counter, limit);
        function.body = body;
    }
    for point in module.entry_points.iter_mut().filter(|point| point.name == ENTRY_POINT) {
        write_count(&mut point.function, counter, counts);
    }
    true
}

/// Makes a kernel work on one row with the whole workgroup, so that no other row's turns are
/// counted with it. If the workgroup were smaller, lavapipe would also run the unused lanes, on a
/// row of zeros.
pub(super) fn one_row_a_workgroup(kernel: &mut naga::EntryPoint) {
    kernel.workgroup_size = [LANES, 1, 1];
    for argument in &mut kernel.function.arguments {
        argument.binding = Some(naga::Binding::BuiltIn(naga::BuiltIn::WorkGroupId));
    }
}

fn has_loop(block: &Block) -> bool {
    let mut found = false;
    for_each_statement(block, &mut |statement| found |= matches!(statement, Statement::Loop { .. }));
    found
}

type Expressions = naga::Arena<Expression>;
type Variable = Handle<naga::GlobalVariable>;

fn count_in(block: &mut Block, expressions: &mut Expressions, counter: Variable, limit: u32) {
    for statement in block.iter_mut() {
        match statement {
            Statement::Loop { body, continuing, .. } => {
                count_in(body, expressions, counter, limit);
                count_in(continuing, expressions, counter, limit);
                // At the start of a turn, so that turns that end in `break` or `continue` also
                // count.
                body.splice(0..0, one_more(expressions, counter, limit));
            }
            Statement::Block(block) => count_in(block, expressions, counter, limit),
            Statement::If { accept, reject, .. } => {
                count_in(accept, expressions, counter, limit);
                count_in(reject, expressions, counter, limit);
            }
            Statement::Switch { cases, .. } => {
                cases.iter_mut().for_each(|case| count_in(&mut case.body, expressions, counter, limit));
            }
            _ => {}
        }
    }
}

/// `counter += 1; if counter > limit { break; }`
fn one_more(expressions: &mut Expressions, counter: Variable, limit: u32) -> Block {
    let mut add = |expression| expressions.append(expression, Span::UNDEFINED);
    let pointer = add(Expression::GlobalVariable(counter));
    let one = add(Expression::Literal(Literal::U32(1)));
    let limit = add(Expression::Literal(Literal::U32(limit)));
    let before = add(Expression::Load { pointer });
    let value = add(Expression::Binary { op: BinaryOperator::Add, left: before, right: one });
    let condition = add(Expression::Binary { op: BinaryOperator::Greater, left: value, right: limit });
    let leave = Block::from_vec(vec![Statement::Break]);
    Block::from_vec(vec![
        Statement::Emit(naga::Range::new_from_bounds(before, condition)),
        Statement::Store { pointer, value },
        Statement::If { condition, accept: leave, reject: Block::new() },
    ])
}

/// Writes `counts[invocation.x] = counter;` at the end of the kernel, whose first argument is the
/// invocation.
fn write_count(kernel: &mut naga::Function, counter: Variable, counts: Variable) {
    let mut add = |expression| kernel.expressions.append(expression, Span::UNDEFINED);
    let invocation = add(Expression::FunctionArgument(0));
    let counter = add(Expression::GlobalVariable(counter));
    let counts = add(Expression::GlobalVariable(counts));
    let index = add(Expression::AccessIndex { base: invocation, index: 0 });
    let place = add(Expression::Access { base: counts, index });
    let value = add(Expression::Load { pointer: counter });
    let write = Block::from_vec(vec![
        Statement::Emit(naga::Range::new_from_bounds(index, value)),
        Statement::Store { pointer: place, value },
    ]);
    // naga ends each function without a result with a `return`.
    let returns = matches!(kernel.body.last(), Some(Statement::Return { .. }));
    let end = kernel.body.len() - usize::from(returns);
    kernel.body.splice(end..end, write);
}
