//! Compiles a function of naga's IR to code on scalars. Calls are inlined; vectors and structs are
//! lists of registers, so splitting and composing them costs nothing.

mod builtin;
mod chain;
mod value;

use super::code::{Code, Float, Label, Op, Register};
use super::site::Site;
use super::stopped::Stopped;
use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{
    BinaryOperator, Block, Expression, Function, Handle, Module, RelationalFunction, ScalarKind, Statement,
    SwitchValue, TypeInner, UnaryOperator,
};
use value::{Value, constant, part, words_of};

/// Compiles `function`; with a seed, chains of sums and of products are reordered.
pub(super) fn compile(
    module: &Module,
    info: &ModuleInfo,
    function: Handle<Function>,
    order: Option<u64>,
) -> Result<Code, Stopped> {
    let code = Code { ops: Vec::new(), registers: Vec::new(), arguments: Vec::new(), result: Vec::new(), loops: false };
    let mut compiler = Compiler { module, info, code, order };
    let arguments: Vec<Value> = module.functions[function]
        .arguments
        .iter()
        .map(|argument| {
            let length = words_of(module, &module.types[argument.ty].inner);
            let start = compiler.fresh(length);
            Value::words(start, length)
        })
        .collect();
    compiler.code.arguments = arguments.iter().flat_map(|value| value.registers().to_vec()).collect();
    compiler.code.result = compiler.call(function, arguments)?;
    Ok(compiler.code)
}

struct Compiler<'a> {
    module: &'a Module,
    info: &'a ModuleInfo,
    code: Code,
    order: Option<u64>,
}

/// One inlined call.
struct Call<'a> {
    handle: Handle<Function>,
    function: &'a Function,
    info: &'a FunctionInfo,
    arguments: Vec<Value>,
    /// Value of each expression, once it is compiled.
    values: Vec<Option<Value>>,
    /// First register of each local variable.
    locals: Vec<Register>,
    result: Vec<Register>,
    /// Jumps to the end of the call.
    returns: Vec<Label>,
    /// Loops and switches around the current statement.
    around: Vec<Around>,
}

/// A loop or a switch: the jumps to its end, and to the continuing block of a loop.
struct Around {
    breaks: Vec<Label>,
    continues: Option<Vec<Label>>,
}

impl Call<'_> {
    fn site(&self, handle: Handle<Expression>) -> Site {
        Site { function: self.handle.index() as u32, expression: handle.index() as u32 }
    }
}

impl<'a> Compiler<'a> {
    /// Allocates `length` consecutive registers and returns the first.
    fn fresh(&mut self, length: usize) -> Register {
        let start = self.code.registers.len() as Register;
        self.code.registers.resize(self.code.registers.len() + length, 0);
        start
    }

    /// Allocates a register that holds `word` and is never overwritten.
    fn constant(&mut self, word: u32) -> Register {
        self.code.registers.push(word);
        self.code.registers.len() as Register - 1
    }

    fn push(&mut self, op: Op) {
        self.code.ops.push(op);
    }

    /// Appends the operation that `op` makes for a new register, and returns the register.
    fn result(&mut self, op: impl FnOnce(Register) -> Op) -> Register {
        let to = self.fresh(1);
        self.push(op(to));
        to
    }

    fn here(&self) -> Label {
        self.code.ops.len()
    }

    /// Appends a jump without a target, and returns its place.
    fn jump(&mut self) -> Label {
        self.push(Op::Jump { target: Label::MAX });
        self.here() - 1
    }

    fn unless(&mut self, condition: Register) -> Label {
        self.push(Op::Unless { condition, target: Label::MAX });
        self.here() - 1
    }

    /// Directs a jump to the next operation.
    fn land(&mut self, jump: Label) {
        let here = self.here();
        match &mut self.code.ops[jump] {
            Op::Jump { target } | Op::Unless { target, .. } | Op::Equal { target, .. } => *target = here,
            other => unreachable!("{other:?} leads nowhere"),
        }
    }

    fn land_all(&mut self, jumps: Vec<Label>) {
        jumps.into_iter().for_each(|jump| self.land(jump));
    }

    /// Inlines a call and returns the registers of its result.
    fn call(&mut self, handle: Handle<Function>, arguments: Vec<Value>) -> Result<Vec<Register>, Stopped> {
        let function = &self.module.functions[handle];
        let length = |ty: Handle<naga::Type>| words_of(self.module, &self.module.types[ty].inner);
        let result = function.result.as_ref().map_or(0, |result| length(result.ty));
        let lengths: Vec<usize> = function.local_variables.iter().map(|(_, local)| length(local.ty)).collect();
        let locals = lengths.iter().map(|length| self.fresh(*length)).collect();
        let start = self.fresh(result);
        let mut call = Call {
            handle,
            function,
            info: &self.info[handle],
            arguments,
            values: vec![None; function.expressions.len()],
            locals,
            result: (start..start + result as Register).collect(),
            returns: Vec::new(),
            around: Vec::new(),
        };
        // Each run of a call in a loop starts with the initial values of its variables.
        for (index, (_, local)) in function.local_variables.iter().enumerate() {
            let zero = self.constant(0);
            let from = match local.init {
                Some(init) => self.value(&mut call, init)?.registers().to_vec(),
                None => vec![zero; lengths[index]],
            };
            let start = call.locals[index];
            from.iter().zip(start..).for_each(|(from, to)| self.push(Op::Copy { to, from: *from }));
        }
        self.block(&mut call, &function.body)?;
        self.land_all(std::mem::take(&mut call.returns));
        Ok(call.result)
    }

    fn block(&mut self, call: &mut Call<'a>, block: &'a Block) -> Result<(), Stopped> {
        block.iter().try_for_each(|statement| self.statement(call, statement))
    }

    fn statement(&mut self, call: &mut Call<'a>, statement: &'a Statement) -> Result<(), Stopped> {
        match statement {
            Statement::Emit(range) => {
                for handle in range.clone() {
                    let value = self.expression(call, handle)?;
                    call.values[handle.index()] = Some(value);
                }
            }
            Statement::Block(inner) => self.block(call, inner)?,
            Statement::If { condition, accept, reject } => {
                let (site, condition) = (call.site(*condition), self.word(call, *condition)?);
                self.push(Op::Decide { condition, site });
                let over = self.unless(condition);
                self.block(call, accept)?;
                if reject.is_empty() {
                    self.land(over);
                } else {
                    let end = self.jump();
                    self.land(over);
                    self.block(call, reject)?;
                    self.land(end);
                }
            }
            Statement::Switch { selector, cases } => self.switch(call, *selector, cases)?,
            Statement::Loop { body, continuing, break_if } => {
                self.code.loops = true;
                let start = self.here();
                call.around.push(Around { breaks: Vec::new(), continues: Some(Vec::new()) });
                self.block(call, body)?;
                let continues = call.around.last_mut().and_then(|around| around.continues.take());
                self.land_all(continues.unwrap_or_default());
                self.block(call, continuing)?;
                match break_if {
                    Some(condition) => {
                        let condition = self.word(call, *condition)?;
                        self.push(Op::Unless { condition, target: start });
                    }
                    None => self.push(Op::Jump { target: start }),
                }
                self.end_around(call);
            }
            Statement::Break => {
                let jump = self.jump();
                call.around.last_mut().expect("naga: a break is inside of a loop or a switch").breaks.push(jump);
            }
            Statement::Continue => {
                let jump = self.jump();
                let inner = call.around.iter_mut().rev().find_map(|around| around.continues.as_mut());
                inner.expect("naga: a continue is inside of a loop").push(jump);
            }
            Statement::Return { value } => {
                if let Some(value) = value {
                    let from = self.value(call, *value)?.registers().to_vec();
                    let to = call.result.clone();
                    from.iter().zip(to).for_each(|(from, to)| self.push(Op::Copy { to, from: *from }));
                }
                let jump = self.jump();
                call.returns.push(jump);
            }
            Statement::Store { pointer, value } => {
                let pointer = self.value(call, *pointer)?;
                let from = self.value(call, *value)?;
                let Value::Pointer { start, offset } = pointer else { unreachable!("naga: a store takes a pointer") };
                for (from, start) in from.registers().to_vec().into_iter().zip(start..) {
                    self.push(match offset {
                        None => Op::Copy { to: start, from },
                        Some(offset) => Op::StoreAt { start, offset, from },
                    });
                }
            }
            Statement::Call { function, arguments, result } => {
                let arguments =
                    arguments.iter().map(|argument| self.value(call, *argument)).collect::<Result<_, _>>()?;
                let registers = self.call(*function, arguments)?;
                if let Some(result) = result {
                    // The next call writes to registers of its own.
                    call.values[result.index()] = Some(Value::Words(registers));
                }
            }
            other => return Err(Stopped(format!("cannot run {other:?} on the CPU"))),
        }
        Ok(())
    }

    fn end_around(&mut self, call: &mut Call<'a>) {
        let around = call.around.pop().expect("as many ends as beginnings");
        self.land_all(around.breaks);
    }

    fn switch(
        &mut self,
        call: &mut Call<'a>,
        selector: Handle<Expression>,
        cases: &'a [naga::SwitchCase],
    ) -> Result<(), Stopped> {
        let selector = self.word(call, selector)?;
        call.around.push(Around { breaks: Vec::new(), continues: None });
        let mut entries: Vec<Option<Label>> = Vec::new();
        for case in cases {
            let value = match case.value {
                SwitchValue::I32(value) => Some(value.cast_unsigned()),
                SwitchValue::U32(value) => Some(value),
                SwitchValue::Default => None,
            };
            entries.push(value.map(|value| {
                self.push(Op::Equal { selector, value, target: Label::MAX });
                self.here() - 1
            }));
        }
        // If no case matches, the default or the end follows.
        let otherwise = self.jump();
        let mut has_default = false;
        for (case, entry) in cases.iter().zip(entries) {
            match entry {
                Some(entry) => self.land(entry),
                None => {
                    self.land(otherwise);
                    has_default = true;
                }
            }
            self.block(call, &case.body)?;
            if !case.fall_through {
                let jump = self.jump();
                call.around.last_mut().expect("pushed above").breaks.push(jump);
            }
        }
        if !has_default {
            self.land(otherwise);
        }
        self.end_around(call);
        Ok(())
    }

    /// Returns the compiled value of an expression; constants, arguments and variables are compiled
    /// at their first use.
    fn value(&mut self, call: &mut Call<'a>, handle: Handle<Expression>) -> Result<Value, Stopped> {
        if let Some(value) = &call.values[handle.index()] {
            return Ok(value.clone());
        }
        let value = self.expression(call, handle)?;
        call.values[handle.index()] = Some(value.clone());
        Ok(value)
    }

    /// Returns the register of a scalar.
    fn word(&mut self, call: &mut Call<'a>, handle: Handle<Expression>) -> Result<Register, Stopped> {
        Ok(self.value(call, handle)?.registers()[0])
    }

    /// Returns the type of an expression, or the pointee for a pointer.
    fn inner(&self, call: &Call<'a>, handle: Handle<Expression>) -> TypeInner {
        value::pointee(self.module, call.info[handle].ty.inner_with(&self.module.types))
    }

    fn kind(&self, call: &Call<'a>, handle: Handle<Expression>) -> Option<ScalarKind> {
        value::kind(&self.inner(call, handle))
    }

    fn expression(&mut self, call: &mut Call<'a>, handle: Handle<Expression>) -> Result<Value, Stopped> {
        let site = call.site(handle);
        let function = call.function;
        Ok(match &function.expressions[handle] {
            Expression::Literal(_) | Expression::Constant(_) | Expression::ZeroValue(_) => {
                let words = constant(self.module, &function.expressions, handle);
                let words = words.ok_or_else(|| Stopped("cannot hold such a constant on the CPU".to_owned()))?;
                Value::Words(words.into_iter().map(|word| self.constant(word)).collect())
            }
            Expression::FunctionArgument(index) => call.arguments[*index as usize].clone(),
            Expression::LocalVariable(local) => Value::Pointer { start: call.locals[local.index()], offset: None },
            Expression::Compose { components, .. } => {
                let mut registers = Vec::new();
                for component in components {
                    registers.extend_from_slice(self.value(call, *component)?.registers());
                }
                Value::Words(registers)
            }
            Expression::Splat { size, value } => Value::Words(vec![self.word(call, *value)?; *size as usize]),
            Expression::Swizzle { size, vector, pattern } => {
                let vector = self.value(call, *vector)?;
                let component = |component: &naga::SwizzleComponent| vector.registers()[*component as usize];
                Value::Words(pattern[..*size as usize].iter().map(component).collect())
            }
            Expression::AccessIndex { base, index } => {
                let (start, length) = part(self.module, &self.inner(call, *base), *index as usize);
                match self.value(call, *base)? {
                    Value::Pointer { start: from, offset } => {
                        Value::Pointer { start: from + start as Register, offset }
                    }
                    Value::Words(registers) => Value::Words(registers[start..start + length].to_vec()),
                }
            }
            Expression::Access { base, index } => self.access(call, *base, *index)?,
            Expression::Load { pointer } => {
                let length = words_of(self.module, &self.inner(call, *pointer));
                let Value::Pointer { start, offset } = self.value(call, *pointer)? else {
                    unreachable!("naga: a load takes a pointer")
                };
                self.load(start, offset, length)
            }
            Expression::Unary { op, expr } => {
                let kind = self.kind(call, *expr);
                let from = self.value(call, *expr)?;
                let zero = self.constant(0);
                let each = from.registers().to_vec().into_iter().map(|from| {
                    self.result(|to| match (op, kind) {
                        (UnaryOperator::Negate, Some(ScalarKind::Float)) => Op::Negate { to, from },
                        (UnaryOperator::Negate, _) => {
                            Op::Unsigned { op: BinaryOperator::Subtract, to, a: zero, b: from }
                        }
                        (UnaryOperator::LogicalNot, _) => Op::Not { to, from },
                        (UnaryOperator::BitwiseNot, _) => Op::Complement { to, from },
                    })
                });
                Value::Words(each.collect())
            }
            Expression::Binary { op, left, right } => match self.reordered(call, handle)? {
                Some(value) => value,
                None => self.binary(call, *op, [*left, *right], site)?,
            },
            Expression::Select { condition, accept, reject } => {
                let condition = self.value(call, *condition)?.registers().to_vec();
                let (accept, reject) = (self.value(call, *accept)?, self.value(call, *reject)?);
                let sides = accept.registers().to_vec().into_iter().zip(reject.registers().to_vec());
                let each = sides.enumerate().map(|(index, (accept, reject))| {
                    let site = (index < condition.len()).then_some(site);
                    let condition = condition[index % condition.len()];
                    self.result(|to| Op::Select { to, condition, accept, reject, site })
                });
                Value::Words(each.collect())
            }
            Expression::Relational { fun, argument } => {
                let op = match fun {
                    RelationalFunction::All => BinaryOperator::And,
                    RelationalFunction::Any => BinaryOperator::InclusiveOr,
                    RelationalFunction::IsNan | RelationalFunction::IsInf => {
                        return Err(Stopped(format!("cannot evaluate {fun:?} on the CPU")));
                    }
                };
                let words = self.value(call, *argument)?.registers().to_vec();
                let all = words.into_iter().reduce(|a, b| self.result(|to| Op::Unsigned { op, to, a, b }));
                Value::Words(all.into_iter().collect())
            }
            Expression::As { expr, convert: None, .. } => {
                // Reinterpreted bits no longer count as a product.
                let zero = self.constant(0);
                let from = self.value(call, *expr)?.registers().to_vec();
                let op = BinaryOperator::InclusiveOr;
                let each = from.into_iter().map(|a| self.result(|to| Op::Unsigned { op, to, a, b: zero }));
                Value::Words(each.collect())
            }
            Expression::As { expr, kind, convert: Some(_) } => {
                let Some(from_kind) = self.kind(call, *expr) else {
                    return Err(Stopped("cannot convert matrices on the CPU".to_owned()));
                };
                let from = self.value(call, *expr)?.registers().to_vec();
                let kinds = [from_kind, *kind];
                let each = from.into_iter().map(|from| self.result(|to| Op::Convert { kinds, to, from, site }));
                Value::Words(each.collect())
            }
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                let mut arguments = Vec::new();
                for argument in [Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten() {
                    arguments.push(self.value(call, argument)?.registers().to_vec());
                }
                let kind = self.kind(call, *arg);
                Value::Words(self.builtin(*fun, kind, &arguments, site)?)
            }
            other => return Err(Stopped(format!("cannot evaluate {other:?} on the CPU"))),
        })
    }

    fn load(&mut self, start: Register, offset: Option<Register>, length: usize) -> Value {
        let each = (start..start + length as Register).map(|from| {
            self.result(|to| match offset {
                None => Op::Copy { to, from },
                Some(offset) => Op::LoadAt { to, start: from, offset },
            })
        });
        Value::Words(each.collect())
    }

    /// Returns an element with an index known only at run time.
    fn access(
        &mut self,
        call: &mut Call<'a>,
        base: Handle<Expression>,
        index: Handle<Expression>,
    ) -> Result<Value, Stopped> {
        let inner = self.inner(call, base);
        // For an index beyond the end, WGSL allows any element: here the last.
        let count = match &inner {
            TypeInner::Vector { size, .. } => *size as u32,
            TypeInner::Matrix { columns, .. } => *columns as u32,
            TypeInner::Array { size: naga::ArraySize::Constant(length), .. } => length.get(),
            _ => 1,
        };
        let (_, length) = part(self.module, &inner, 0);
        let index = self.word(call, index)?;
        let (start, from, is_pointer) = match self.value(call, base)? {
            Value::Pointer { start, offset } => (start, offset, true),
            Value::Words(registers) => {
                // Consecutive, so that an index can address them.
                let start = self.fresh(registers.len());
                registers.into_iter().zip(start..).for_each(|(from, to)| self.push(Op::Copy { to, from }));
                (start, None, false)
            }
        };
        let from = from.unwrap_or_else(|| self.constant(0));
        let offset = self.result(|to| Op::Offset { to, from, index, last: count - 1, stride: length as u32 });
        Ok(if is_pointer {
            Value::Pointer { start, offset: Some(offset) }
        } else {
            self.load(start, Some(offset), length)
        })
    }

    fn binary(
        &mut self,
        call: &mut Call<'a>,
        op: BinaryOperator,
        [left, right]: [Handle<Expression>; 2],
        site: Site,
    ) -> Result<Value, Stopped> {
        let Some(kind) = self.kind(call, left).filter(|_| self.kind(call, right).is_some()) else {
            return Err(Stopped("cannot multiply matrices on the CPU".to_owned()));
        };
        let left = self.value(call, left)?.registers().to_vec();
        let right = self.value(call, right)?.registers().to_vec();
        let components = (0..left.len().max(right.len())).map(|index| {
            let (a, b) = (left[index % left.len()], right[index % right.len()]);
            match kind {
                ScalarKind::Float => self.float(op, a, b, site),
                ScalarKind::Sint => self.result(|to| Op::Signed { op, to, a, b }),
                _ => self.result(|to| Op::Unsigned { op, to, a, b }),
            }
        });
        Ok(Value::Words(components.collect()))
    }

    fn float(&mut self, op: BinaryOperator, a: Register, b: Register, site: Site) -> Register {
        match op {
            BinaryOperator::Modulo => {
                // x - y * trunc(x / y)
                let quotient = self.result(|to| Op::Divide { to, a, b });
                let whole = self.result(|to| Op::Float { fun: Float::Trunc, to, operands: [quotient, quotient], site });
                let product = self.result(|to| Op::Multiply { to, a: b, b: whole });
                self.result(|to| Op::Subtract { to, a, b: product })
            }
            _ => self.result(|to| match op {
                BinaryOperator::Add => Op::Add { to, a, b },
                BinaryOperator::Subtract => Op::Subtract { to, a, b },
                BinaryOperator::Multiply => Op::Multiply { to, a, b },
                BinaryOperator::Divide => Op::Divide { to, a, b },
                _ => Op::Compare { op, to, a, b },
            }),
        }
    }
}
