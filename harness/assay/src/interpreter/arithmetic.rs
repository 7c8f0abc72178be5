//! Expressions: access, operators, conversions.

use super::Stopped;
use super::builtin::builtin;
use super::layout::{Frame, part};
use super::machine::{Machine, Slack};
use naga::{BinaryOperator, Expression, Handle, Module, RelationalFunction, ScalarKind, TypeInner, UnaryOperator};

impl Frame<'_> {
    /// Evaluates an expression whose operands have been.
    pub(super) fn evaluate<M: Machine>(
        &mut self,
        module: &Module,
        handle: Handle<Expression>,
        machine: &mut M,
    ) -> Result<(), Stopped> {
        let mut out = self.take_scratch();
        self.append(module, handle, machine, &mut out)?;
        self.keep(handle, out);
        Ok(())
    }

    fn append<M: Machine>(
        &self,
        module: &Module,
        handle: Handle<Expression>,
        machine: &mut M,
        out: &mut Vec<u32>,
    ) -> Result<(), Stopped> {
        match &self.function.expressions[handle] {
            Expression::Compose { components, .. } => {
                components.iter().for_each(|component| out.extend_from_slice(self.words(*component)));
            }
            Expression::Splat { size, value } => out.extend(std::iter::repeat_n(self.word(*value), *size as usize)),
            Expression::Swizzle { size, vector, pattern } => {
                let words = self.words(*vector);
                out.extend(pattern[..*size as usize].iter().map(|component| words[*component as usize]));
            }
            Expression::AccessIndex { base, index } => self.access(module, *base, *index as usize, out),
            Expression::Access { base, index } => {
                // Beyond the end WGSL gives any element: the last, here.
                let count = match &self.layout.place(*base).inner {
                    TypeInner::Vector { size, .. } => *size as usize,
                    TypeInner::Matrix { columns, .. } => *columns as usize,
                    TypeInner::Array { size: naga::ArraySize::Constant(length), .. } => length.get() as usize,
                    _ => 1,
                };
                self.access(module, *base, (self.word(*index) as usize).min(count - 1), out);
            }
            Expression::Load { pointer } => {
                out.extend_from_slice(self.load(*pointer, self.layout.place(handle).length));
            }
            Expression::Unary { op, expr } => {
                let kind = self.layout.place(*expr).kind();
                out.extend(self.words(*expr).iter().map(|word| match (op, kind) {
                    (UnaryOperator::Negate, Some(ScalarKind::Float)) => word ^ 0x8000_0000,
                    (UnaryOperator::Negate, _) => word.wrapping_neg(),
                    (UnaryOperator::LogicalNot, _) => u32::from(*word == 0),
                    (UnaryOperator::BitwiseNot, _) => !word,
                }));
            }
            Expression::Binary { op, left, right } => self.binary(*op, *left, *right, machine, out)?,
            Expression::Select { condition, accept, reject } => {
                let conditions = self.words(*condition);
                let (accept, reject) = (self.words(*accept), self.words(*reject));
                for index in 0..accept.len() {
                    let chosen = conditions[index % conditions.len()] != 0;
                    if index < conditions.len() {
                        machine.decided(self.site(handle), chosen.into());
                    }
                    out.push(if chosen { accept[index] } else { reject[index] });
                }
            }
            Expression::Relational { fun, argument } => {
                let words = self.words(*argument);
                out.push(u32::from(match fun {
                    RelationalFunction::All => words.iter().all(|word| *word != 0),
                    RelationalFunction::Any => words.iter().any(|word| *word != 0),
                    RelationalFunction::IsNan | RelationalFunction::IsInf => false,
                }));
            }
            Expression::As { expr, kind, convert: None } => {
                let _ = kind;
                out.extend_from_slice(self.words(*expr));
            }
            Expression::As { expr, kind, convert: Some(_) } => {
                let from = self.layout.place(*expr).kind();
                for word in self.words(*expr) {
                    let to = convert(from, *kind, *word, machine);
                    if from == Some(ScalarKind::Float) && *kind != ScalarKind::Float {
                        machine.decided(self.site(handle), to);
                    }
                    out.push(to);
                }
            }
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                let arguments: Vec<&[u32]> =
                    [Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten().map(|arg| self.words(arg)).collect();
                let kind = self.layout.place(*arg).kind();
                builtin(*fun, kind, &arguments, self.site(handle), machine, out)?;
            }
            // In place from the start.
            Expression::Literal(_) | Expression::Constant(_) | Expression::ZeroValue(_) => {
                out.extend_from_slice(self.words(handle));
            }
            other => return Err(Stopped(format!("cannot evaluate {other:?} on the CPU"))),
        }
        Ok(())
    }

    fn access(&self, module: &Module, base: Handle<Expression>, index: usize, out: &mut Vec<u32>) {
        let place = self.layout.place(base);
        let (start, length) = part(module, &place.inner, index);
        if place.pointer {
            out.push(self.word(base) + start as u32);
        } else {
            out.extend_from_slice(&self.words(base)[start..start + length]);
        }
    }

    fn binary<M: Machine>(
        &self,
        op: BinaryOperator,
        left: Handle<Expression>,
        right: Handle<Expression>,
        machine: &mut M,
        out: &mut Vec<u32>,
    ) -> Result<(), Stopped> {
        let places = [self.layout.place(left), self.layout.place(right)];
        let Some(kind) = places[0].kind().filter(|_| places[1].kind().is_some()) else {
            return Err(Stopped("cannot multiply matrices on the CPU".to_owned()));
        };
        let (left, right) = (self.words(left), self.words(right));
        for index in 0..left.len().max(right.len()) {
            let (a, b) = (left[index % left.len()], right[index % right.len()]);
            out.push(match kind {
                ScalarKind::Float => float(op, f32::from_bits(a), f32::from_bits(b), machine),
                ScalarKind::Sint => signed(op, a.cast_signed(), b.cast_signed()),
                _ => unsigned(op, a, b),
            });
        }
        Ok(())
    }
}

fn float(op: BinaryOperator, a: f32, b: f32, machine: &mut impl Machine) -> u32 {
    let (x, y) = (f64::from(a), f64::from(b));
    let value = match op {
        BinaryOperator::Add => machine.round(x + y, Slack::Rounded),
        BinaryOperator::Subtract => machine.round(x - y, Slack::Rounded),
        BinaryOperator::Multiply => machine.round(x * y, Slack::Rounded),
        BinaryOperator::Divide => machine.round(x / y, Slack::Ulps(2.5)),
        BinaryOperator::Modulo => a % b,
        BinaryOperator::Equal => return u32::from(a == b),
        BinaryOperator::NotEqual => return u32::from(a != b),
        BinaryOperator::Less => return u32::from(a < b),
        BinaryOperator::LessEqual => return u32::from(a <= b),
        BinaryOperator::Greater => return u32::from(a > b),
        BinaryOperator::GreaterEqual => return u32::from(a >= b),
        _ => f32::NAN,
    };
    value.to_bits()
}

fn signed(op: BinaryOperator, a: i32, b: i32) -> u32 {
    let value = match op {
        BinaryOperator::Divide => a.checked_div(b).unwrap_or(a),
        BinaryOperator::Modulo => a.checked_rem(b).unwrap_or(0),
        BinaryOperator::ShiftRight => a.wrapping_shr(b.cast_unsigned()),
        BinaryOperator::Less => return u32::from(a < b),
        BinaryOperator::LessEqual => return u32::from(a <= b),
        BinaryOperator::Greater => return u32::from(a > b),
        BinaryOperator::GreaterEqual => return u32::from(a >= b),
        // In two's complement the sign makes no difference to the others.
        _ => return unsigned(op, a.cast_unsigned(), b.cast_unsigned()),
    };
    value.cast_unsigned()
}

fn unsigned(op: BinaryOperator, a: u32, b: u32) -> u32 {
    match op {
        BinaryOperator::Add => a.wrapping_add(b),
        BinaryOperator::Subtract => a.wrapping_sub(b),
        BinaryOperator::Multiply => a.wrapping_mul(b),
        BinaryOperator::Divide => a.checked_div(b).unwrap_or(a),
        BinaryOperator::Modulo => a.checked_rem(b).unwrap_or(0),
        BinaryOperator::Equal => u32::from(a == b),
        BinaryOperator::NotEqual => u32::from(a != b),
        BinaryOperator::Less => u32::from(a < b),
        BinaryOperator::LessEqual => u32::from(a <= b),
        BinaryOperator::Greater => u32::from(a > b),
        BinaryOperator::GreaterEqual => u32::from(a >= b),
        BinaryOperator::And | BinaryOperator::LogicalAnd => a & b,
        BinaryOperator::ExclusiveOr => a ^ b,
        BinaryOperator::InclusiveOr | BinaryOperator::LogicalOr => a | b,
        BinaryOperator::ShiftLeft => a.wrapping_shl(b),
        BinaryOperator::ShiftRight => a.wrapping_shr(b),
    }
}

fn convert(from: Option<ScalarKind>, to: ScalarKind, word: u32, machine: &mut impl Machine) -> u32 {
    match (from, to) {
        (Some(ScalarKind::Float), ScalarKind::Sint) => (f32::from_bits(word) as i32).cast_unsigned(),
        (Some(ScalarKind::Float), ScalarKind::Uint) => f32::from_bits(word) as u32,
        (Some(ScalarKind::Float), ScalarKind::Bool) => u32::from(f32::from_bits(word) != 0.0),
        (Some(ScalarKind::Float), _) => word,
        (Some(ScalarKind::Sint), ScalarKind::Float) => {
            machine.round(f64::from(word.cast_signed()), Slack::Rounded).to_bits()
        }
        (_, ScalarKind::Float) => machine.round(f64::from(word), Slack::Rounded).to_bits(),
        (_, ScalarKind::Bool) => u32::from(word != 0),
        _ => word,
    }
}
