//! Compiled values of expressions, and the number of words of each type.

use crate::interpreter::code::Register;
use naga::{ArraySize, Expression, Handle, Literal, Module, ScalarKind, TypeInner};

/// The registers of a value, or the place to which a pointer refers.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Words(Vec<Register>),
    /// First register, and a register with the offset from it in words.
    Pointer {
        start: Register,
        offset: Option<Register>,
    },
}

impl Value {
    /// Returns the value in `length` consecutive registers.
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

/// Returns the pointee of a pointer type, or any other type itself.
pub(super) fn pointee(module: &Module, inner: &TypeInner) -> TypeInner {
    match inner {
        TypeInner::Pointer { base, .. } => module.types[*base].inner.clone(),
        TypeInner::ValuePointer { size: Some(size), scalar, .. } => TypeInner::Vector { size: *size, scalar: *scalar },
        TypeInner::ValuePointer { size: None, scalar, .. } => TypeInner::Scalar(*scalar),
        inner => inner.clone(),
    }
}

/// Returns the kind of a type's scalars, or `None` for a matrix, a struct or an array.
pub(super) fn kind(inner: &TypeInner) -> Option<ScalarKind> {
    match inner {
        TypeInner::Scalar(scalar) | TypeInner::Vector { scalar, .. } => Some(scalar.kind),
        _ => None,
    }
}

/// Returns the number of words in a value of a type.
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

/// Returns the offset and the length of part `index` of a composite, in words.
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

/// Returns the words of a constant expression.
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
        Expression::Constant(named) => constant(module, &module.global_expressions, module.constants[*named].init)?,
        Expression::ZeroValue(ty) => vec![0; words_of(module, &module.types[*ty].inner)],
        Expression::Compose { components, .. } => {
            let parts = components.iter().map(|part| constant(module, expressions, *part));
            parts.collect::<Option<Vec<_>>>()?.concat()
        }
        Expression::Splat { size, value } => constant(module, expressions, *value)?.repeat(*size as usize),
        _ => return None,
    })
}
