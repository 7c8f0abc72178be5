//! Constant values: read from one arena of expressions, written to another, compared, and computed
//! by naga's own constant evaluator, so that WGSL's rules are not implemented twice.

use super::operands;
use naga::proc::{ConstantEvaluator, Emitter, ExpressionKindTracker, HashableLiteral, Layouter};
use naga::{Arena, Constant, Expression, Handle, Literal, Module, ScalarKind, Span, Type, TypeInner, UnaryOperator};
use naga::{UniqueArena, VectorSize};

/// A constant, independent of the arena it was found in. A scalar is always a `Literal`.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Literal(Literal),
    Zero(Handle<Type>),
    Constant(Handle<Constant>),
    Compose(Handle<Type>, Vec<Value>),
    Splat(VectorSize, Box<Value>),
}

/// The parts of a module in which constants are looked up.
#[derive(Clone, Copy)]
pub(super) struct Globals<'a> {
    types: &'a UniqueArena<Type>,
    constants: &'a Arena<Constant>,
    expressions: &'a Arena<Expression>,
}

impl<'a> Globals<'a> {
    pub(super) fn of(module: &'a Module) -> Self {
        Globals { types: &module.types, constants: &module.constants, expressions: &module.global_expressions }
    }

    /// Returns the zero of a scalar type; `None` for any other type.
    pub(super) fn zero(self, ty: Handle<Type>) -> Option<Literal> {
        match self.types[ty].inner {
            TypeInner::Scalar(scalar) => Literal::zero(scalar),
            _ => None,
        }
    }
}

impl Value {
    /// Returns the value of an expression; `None` if it is not a constant, or if not all its parts
    /// are written out.
    pub(super) fn of(
        globals: Globals<'_>,
        expressions: &Arena<Expression>,
        expression: Handle<Expression>,
    ) -> Option<Value> {
        Some(match &expressions[expression] {
            Expression::Literal(literal) => Value::Literal(*literal),
            Expression::ZeroValue(ty) => globals.zero(*ty).map_or(Value::Zero(*ty), Value::Literal),
            Expression::Constant(constant) => {
                let init = globals.constants[*constant].init;
                match Value::of(globals, globals.expressions, init) {
                    Some(scalar @ Value::Literal(_)) => scalar,
                    // Refer to it by name, so that a table stays a single table.
                    _ => Value::Constant(*constant),
                }
            }
            Expression::Compose { ty, components } => {
                let parts = components.iter().map(|part| Value::of(globals, expressions, *part));
                Value::Compose(*ty, parts.collect::<Option<_>>()?)
            }
            Expression::Splat { size, value } => {
                Value::Splat(*size, Box::new(Value::of(globals, expressions, *value)?))
            }
            _ => return None,
        })
    }

    /// Returns the value of a scalar expression; `None` if it is not known.
    pub(super) fn scalar(
        globals: Globals<'_>,
        expressions: &Arena<Expression>,
        expression: Handle<Expression>,
    ) -> Option<Literal> {
        match Value::of(globals, expressions, expression)? {
            Value::Literal(literal) => Some(literal),
            _ => None,
        }
    }

    /// Appends expressions that produce the value, operands first, and returns the last one.
    pub(super) fn write(&self, expressions: &mut Arena<Expression>) -> Handle<Expression> {
        let expression = match self {
            Value::Literal(literal) => Expression::Literal(*literal),
            Value::Zero(ty) => Expression::ZeroValue(*ty),
            Value::Constant(constant) => Expression::Constant(*constant),
            Value::Compose(ty, parts) => {
                Expression::Compose { ty: *ty, components: parts.iter().map(|part| part.write(expressions)).collect() }
            }
            Value::Splat(size, value) => Expression::Splat { size: *size, value: value.write(expressions) },
        };
        expressions.append(expression, Span::UNDEFINED)
    }

    /// Whether both values are identical to the bit: 0 and -0 differ.
    pub(super) fn is(&self, other: &Value) -> bool {
        match (self, other) {
            (Value::Literal(left), Value::Literal(right)) => same_bits(*left, *right),
            (Value::Zero(left), Value::Zero(right)) => left == right,
            (Value::Constant(left), Value::Constant(right)) => left == right,
            (Value::Compose(left_type, left), Value::Compose(right_type, right)) => {
                left_type == right_type
                    && left.len() == right.len()
                    && left.iter().zip(right).all(|(left, right)| left.is(right))
            }
            (Value::Splat(left_size, left), Value::Splat(right_size, right)) => {
                left_size == right_size && left.is(right)
            }
            _ => false,
        }
    }
}

/// Whether two literals have the same type and bit pattern.
pub(super) fn same_bits(left: Literal, right: Literal) -> bool {
    HashableLiteral::from(left) == HashableLiteral::from(right)
}

/// Evaluates an expression whose operands are constants; `None` unless the result is a scalar that
/// all devices agree on. That is a bool, an integer, or a float that is selected from the operands
/// or negated. Sums and functions of floats are left to the device, whose rounding may differ.
pub(super) fn evaluate(
    module: &mut Module,
    expressions: &Arena<Expression>,
    expression: &Expression,
) -> Option<Literal> {
    let picks = match expression {
        Expression::Unary { op: UnaryOperator::Negate, .. }
        | Expression::Access { .. }
        | Expression::AccessIndex { .. }
        | Expression::Select { .. } => true,
        Expression::Unary { .. }
        | Expression::Binary { .. }
        | Expression::Math { .. }
        | Expression::Relational { .. }
        | Expression::As { .. } => false,
        _ => return None,
    };
    let mut scratch = Arena::new();
    let mut expression = expression.clone();
    let mut constant = true;
    operands::of_expression(
        &mut expression,
        &mut |operand| match Value::of(Globals::of(module), expressions, *operand) {
            Some(value) => *operand = value.write(&mut scratch),
            None => constant = false,
        },
    );
    if !constant {
        return None;
    }
    let mut kinds = ExpressionKindTracker::from_arena(&scratch);
    let (mut layouter, mut emitter, mut block) = (Layouter::default(), Emitter::default(), naga::Block::new());
    let result = ConstantEvaluator::for_wgsl_function(
        module,
        &mut scratch,
        &mut kinds,
        &mut layouter,
        &mut emitter,
        &mut block,
        true,
    )
    // Whatever WGSL forbids in a constant, such as overflow, and whatever naga cannot evaluate is
    // left to the device.
    .try_eval_and_append(expression, Span::UNDEFINED)
    .ok()?;
    let literal = Value::scalar(Globals::of(module), &scratch, result)?;
    let exact = matches!(literal.scalar().kind, ScalarKind::Bool | ScalarKind::Sint | ScalarKind::Uint);
    (exact || picks).then_some(literal)
}
