//! What an expression is compiled to, and how many words its type has.

use crate::interpreter::code::Register;
use naga::{ArraySize, Expression, Handle, Literal, Module, ScalarKind, TypeInner};

/// The registers of a value, or the place that a pointer names.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Words(Vec<Register>),
    /// The first register, and one that holds how many words beyond it.
    Pointer {
        start: Register,
        offset: Option<Register>,
    },
}

impl Value {
    /// So many registers in a row.
    pub(super) fn words(start: Register, length: usize) -> Value {
        Value::Words((start..start + length as Register).collect())
    }

    pub(super) fn registers(&self) -> &[Register] {
        match self {
            Value::Words(registers) => registers,
            Value::Pointer { .. } => unreachable!("naga: a pointer is no operand"),
        }
    }
}

/// What a pointer's type points to; any other type itself.
pub(super) fn pointee(module: &Module, inner: &TypeInner) -> TypeInner {
    match inner {
        TypeInner::Pointer { base, .. } => module.types[*base].inner.clone(),
        TypeInner::ValuePointer { size: Some(size), scalar, .. } => TypeInner::Vector { size: *size, scalar: *scalar },
        TypeInner::ValuePointer { size: None, scalar, .. } => TypeInner::Scalar(*scalar),
        inner => inner.clone(),
    }
}

/// The kind of a type's scalars; none of a struct's or an array's.
pub(super) fn kind(inner: &TypeInner) -> Option<ScalarKind> {
    match inner {
        TypeInner::Scalar(scalar) | TypeInner::Vector { scalar, .. } => Some(scalar.kind),
        _ => None,
    }
}

/// How many words a value of a type has.
pub(super) fn words_of(module: &Module, inner: &TypeInner) -> usize {
    match inner {
        TypeInner::Vector { size, .. } => *size as usize,
        TypeInner::Matrix { columns, rows, .. } => *columns as usize * *rows as usize,
        TypeInner::Array { base, size: ArraySize::Constant(length), .. } => {
            words_of(module, &module.types[*base].inner) * length.get() as usize
        }
        TypeInner::Struct { members, .. } => {
            members.iter().map(|member| words_of(module, &module.types[member.ty].inner)).sum()
        }
        _ => 1,
    }
}

/// Where part `index` of a composite lies in it, and how long it is.
pub(super) fn part(module: &Module, inner: &TypeInner, index: usize) -> (usize, usize) {
    match inner {
        TypeInner::Matrix { rows, .. } => (index * *rows as usize, *rows as usize),
        TypeInner::Array { base, .. } => {
            let length = words_of(module, &module.types[*base].inner);
            (index * length, length)
        }
        TypeInner::Struct { members, .. } => {
            let length = |member: &naga::StructMember| words_of(module, &module.types[member.ty].inner);
            (members[..index].iter().map(length).sum(), length(&members[index]))
        }
        _ => (index, 1),
    }
}

/// The words of an expression that is constant.
pub(super) fn constant(
    module: &Module,
    expressions: &naga::Arena<Expression>,
    handle: Handle<Expression>,
) -> Option<Vec<u32>> {
    Some(match &expressions[handle] {
        Expression::Literal(literal) => vec![match *literal {
            Literal::F32(value) => value.to_bits(),
            Literal::U32(value) => value,
            Literal::I32(value) => value.cast_unsigned(),
            Literal::Bool(value) => value.into(),
            Literal::AbstractInt(value) => value as u32,
            Literal::AbstractFloat(value) => (value as f32).to_bits(),
            _ => return None,
        }],
        Expression::Constant(of) => constant(module, &module.global_expressions, module.constants[*of].init)?,
        Expression::ZeroValue(ty) => vec![0; words_of(module, &module.types[*ty].inner)],
        Expression::Compose { components, .. } => {
            let parts = components.iter().map(|part| constant(module, expressions, *part));
            parts.collect::<Option<Vec<_>>>()?.concat()
        }
        Expression::Splat { size, value } => constant(module, expressions, *value)?.repeat(*size as usize),
        _ => return None,
    })
}
