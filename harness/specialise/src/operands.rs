//! Visits the expressions that an expression or a statement refers to. naga has such visitors but
//! does not export them.

use naga::{AtomicFunction, Expression, GatherMode, Handle, ImageQuery, RayPipelineFunction, RayQueryFunction};
use naga::{SampleLevel, Statement};

/// Callback for each reference.
type Visit<'a> = &'a mut dyn FnMut(&mut Handle<Expression>);

/// Visits the operands of an expression.
pub(super) fn of_expression(expression: &mut Expression, visit: Visit<'_>) {
    match expression {
        Expression::Literal(_)
        | Expression::Constant(_)
        | Expression::Override(_)
        | Expression::ZeroValue(_)
        | Expression::FunctionArgument(_)
        | Expression::GlobalVariable(_)
        | Expression::LocalVariable(_)
        | Expression::CallResult(_)
        | Expression::AtomicResult { .. }
        | Expression::WorkGroupUniformLoadResult { .. }
        | Expression::RayQueryProceedResult
        | Expression::SubgroupBallotResult
        | Expression::SubgroupOperationResult { .. } => {}
        Expression::Compose { components, ty: _ } => components.iter_mut().for_each(visit),
        Expression::Access { base, index } => {
            visit(base);
            visit(index);
        }
        Expression::AccessIndex { base: operand, index: _ }
        | Expression::Splat { value: operand, size: _ }
        | Expression::Swizzle { vector: operand, size: _, pattern: _ }
        | Expression::Load { pointer: operand }
        | Expression::Unary { expr: operand, op: _ }
        | Expression::Derivative { expr: operand, axis: _, ctrl: _ }
        | Expression::Relational { argument: operand, fun: _ }
        | Expression::As { expr: operand, kind: _, convert: _ }
        | Expression::ArrayLength(operand)
        | Expression::RayQueryVertexPositions { query: operand, committed: _ }
        | Expression::RayQueryGetIntersection { query: operand, committed: _ } => visit(operand),
        Expression::ImageSample {
            image,
            sampler,
            gather: _,
            coordinate,
            array_index,
            offset,
            level,
            depth_ref,
            clamp_to_edge: _,
        } => {
            visit(image);
            visit(sampler);
            visit(coordinate);
            array_index.iter_mut().chain(offset).chain(depth_ref).for_each(&mut *visit);
            match level {
                SampleLevel::Auto | SampleLevel::Zero => {}
                SampleLevel::Exact(level) | SampleLevel::Bias(level) => visit(level),
                SampleLevel::Gradient { x, y } => {
                    visit(x);
                    visit(y);
                }
            }
        }
        Expression::ImageLoad { image, coordinate, array_index, sample, level } => {
            visit(image);
            visit(coordinate);
            array_index.iter_mut().chain(sample).chain(level).for_each(visit);
        }
        Expression::ImageQuery { image, query } => {
            visit(image);
            match query {
                ImageQuery::Size { level } => level.iter_mut().for_each(visit),
                ImageQuery::NumLevels | ImageQuery::NumLayers | ImageQuery::NumSamples => {}
            }
        }
        Expression::Binary { left, right, op: _ } => {
            visit(left);
            visit(right);
        }
        Expression::Select { condition, accept, reject } => {
            visit(condition);
            visit(accept);
            visit(reject);
        }
        Expression::Math { arg, arg1, arg2, arg3, fun: _ } => {
            visit(arg);
            arg1.iter_mut().chain(arg2).chain(arg3).for_each(visit);
        }
        Expression::CooperativeLoad { data, columns: _, rows: _, role: _ } => {
            visit(&mut data.pointer);
            visit(&mut data.stride);
        }
        Expression::CooperativeMultiplyAdd { a, b, c } => {
            visit(a);
            visit(b);
            visit(c);
        }
    }
}

/// Visits the operands of a statement, but not those of the statements inside it, the result that
/// it defines, or the expressions that it emits.
pub(super) fn of_statement(statement: &mut Statement, visit: Visit<'_>) {
    match statement {
        Statement::Emit(_)
        | Statement::Block(_)
        | Statement::Break
        | Statement::Continue
        | Statement::Kill
        | Statement::ControlBarrier(_)
        | Statement::MemoryBarrier(_) => {}
        Statement::If { condition, accept: _, reject: _ } => visit(condition),
        Statement::Switch { selector, cases: _ } => visit(selector),
        Statement::Loop { body: _, continuing: _, break_if } => break_if.iter_mut().for_each(visit),
        Statement::Return { value } => value.iter_mut().for_each(visit),
        Statement::Store { pointer, value } => {
            visit(pointer);
            visit(value);
        }
        Statement::ImageStore { image, coordinate, array_index, value } => {
            visit(image);
            visit(coordinate);
            array_index.iter_mut().for_each(&mut *visit);
            visit(value);
        }
        Statement::Atomic { pointer, fun, value, result: _ } => {
            visit(pointer);
            of_atomic(fun, visit);
            visit(value);
        }
        Statement::ImageAtomic { image, coordinate, array_index, fun, value } => {
            visit(image);
            visit(coordinate);
            array_index.iter_mut().for_each(&mut *visit);
            of_atomic(fun, visit);
            visit(value);
        }
        Statement::WorkGroupUniformLoad { pointer, result: _ } => visit(pointer),
        Statement::Call { function: _, arguments, result: _ } => arguments.iter_mut().for_each(visit),
        Statement::RayQuery { query, fun } => {
            visit(query);
            match fun {
                RayQueryFunction::Initialize { acceleration_structure, descriptor } => {
                    visit(acceleration_structure);
                    visit(descriptor);
                }
                RayQueryFunction::GenerateIntersection { hit_t } => visit(hit_t),
                RayQueryFunction::Proceed { result: _ }
                | RayQueryFunction::ConfirmIntersection
                | RayQueryFunction::Terminate => {}
            }
        }
        Statement::RayPipelineFunction(RayPipelineFunction::TraceRay {
            acceleration_structure,
            descriptor,
            payload,
        }) => {
            visit(acceleration_structure);
            visit(descriptor);
            visit(payload);
        }
        Statement::SubgroupBallot { result: _, predicate } => predicate.iter_mut().for_each(visit),
        Statement::SubgroupGather { mode, argument, result: _ } => {
            visit(argument);
            match mode {
                GatherMode::BroadcastFirst | GatherMode::QuadSwap(_) => {}
                GatherMode::Broadcast(lane)
                | GatherMode::Shuffle(lane)
                | GatherMode::ShuffleDown(lane)
                | GatherMode::ShuffleUp(lane)
                | GatherMode::ShuffleXor(lane)
                | GatherMode::QuadBroadcast(lane) => visit(lane),
            }
        }
        Statement::SubgroupCollectiveOperation { op: _, collective_op: _, argument, result: _ } => visit(argument),
        Statement::CooperativeStore { target, data } => {
            visit(target);
            visit(&mut data.pointer);
            visit(&mut data.stride);
        }
    }
}

fn of_atomic(fun: &mut AtomicFunction, visit: Visit<'_>) {
    match fun {
        AtomicFunction::Exchange { compare } => compare.iter_mut().for_each(visit),
        AtomicFunction::Add
        | AtomicFunction::Subtract
        | AtomicFunction::And
        | AtomicFunction::ExclusiveOr
        | AtomicFunction::InclusiveOr
        | AtomicFunction::Min
        | AtomicFunction::Max => {}
    }
}

/// Returns the operands of an expression, in order.
pub(crate) fn list_of_expression(expression: &Expression) -> Vec<Handle<Expression>> {
    let mut operands = Vec::new();
    of_expression(&mut expression.clone(), &mut |operand| operands.push(*operand));
    operands
}

/// Returns the operands of a statement, in order; see [`of_statement`].
pub(super) fn list_of_statement(statement: &Statement) -> Vec<Handle<Expression>> {
    let mut operands = Vec::new();
    // Cloning a statement would also clone the blocks inside it, which a visit must not touch
    // anyway.
    match statement {
        Statement::If { condition, .. } => operands.push(*condition),
        Statement::Switch { selector, .. } => operands.push(*selector),
        Statement::Loop { break_if, .. } => operands.extend(break_if),
        Statement::Block(_) => {}
        simple => of_statement(&mut simple.clone(), &mut |operand| operands.push(*operand)),
    }
    operands
}

/// Returns the blocks inside a statement, in order.
pub(super) fn blocks(statement: &Statement) -> Vec<&naga::Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Switch { cases, .. } => cases.iter().map(|case| &case.body).collect(),
        Statement::Loop { body, continuing, .. } => vec![body, continuing],
        _ => Vec::new(),
    }
}

/// Calls `visit` for each statement of a block and of the blocks inside it.
pub fn for_each_statement(block: &naga::Block, visit: &mut dyn FnMut(&Statement)) {
    for statement in block.iter() {
        visit(statement);
        for inner in blocks(statement) {
            for_each_statement(inner, visit);
        }
    }
}

/// Calls `visit` for each statement of a block and of the blocks inside it; `visit` may change the
/// statement.
pub(super) fn for_each_statement_mut(block: &mut naga::Block, visit: &mut dyn FnMut(&mut Statement)) {
    for statement in block.iter_mut() {
        visit(statement);
        match statement {
            Statement::Block(block) => for_each_statement_mut(block, visit),
            Statement::If { accept, reject, .. } => {
                for_each_statement_mut(accept, visit);
                for_each_statement_mut(reject, visit);
            }
            Statement::Switch { cases, .. } => {
                cases.iter_mut().for_each(|case| for_each_statement_mut(&mut case.body, visit));
            }
            Statement::Loop { body, continuing, .. } => {
                for_each_statement_mut(body, visit);
                for_each_statement_mut(continuing, visit);
            }
            _ => {}
        }
    }
}

/// Returns the local variable that a pointer points into; `None` if it is not one of the function's
/// own.
pub(super) fn local_of_pointer(
    expressions: &naga::Arena<Expression>,
    mut pointer: Handle<Expression>,
) -> Option<Handle<naga::LocalVariable>> {
    loop {
        match expressions[pointer] {
            Expression::LocalVariable(local) => return Some(local),
            // If the base is a value rather than a pointer, the chain ends at something other than
            // a local variable.
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => pointer = base,
            _ => return None,
        }
    }
}
