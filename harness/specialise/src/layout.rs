//! How a shader lays out its structs in buffers: each field by name, kind and offset, as naga has them.

use naga::{ArraySize, Handle, Module, ScalarKind, Type, TypeInner, VectorSize};

/// A struct in a uniform or storage buffer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StructLayout {
    /// Its size in bytes, which is also the distance between two in an array.
    pub size: usize,
    /// Its fields in order. A field of an inner struct is named `outer.inner`.
    pub fields: Vec<Field>,
}

/// A field of scalars: one, a vector, a matrix, or an array of these.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// The kind of its scalars, which are 32 bits wide.
    pub kind: ScalarKind,
    /// Byte offset of each scalar from the start of the struct, of a matrix column by column.
    pub offsets: Vec<usize>,
}

impl StructLayout {
    /// The layout of the struct called `name`; none if the module has no such struct.
    ///
    /// # Panics
    /// If the module is not valid, or the struct ends in an array of runtime size.
    #[must_use]
    pub fn named(module: &Module, name: &str) -> Option<StructLayout> {
        let (_, ty) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name))?;
        let TypeInner::Struct { span, .. } = ty.inner else { return None };
        let mut fields = Vec::new();
        add_fields(module, ty, "", 0, &mut fields);
        Some(StructLayout { size: span as usize, fields })
    }
}

fn add_fields(module: &Module, ty: &Type, outer: &str, base: usize, fields: &mut Vec<Field>) {
    let TypeInner::Struct { members, .. } = &ty.inner else { unreachable!("only structs have fields") };
    for member in members {
        let name = format!("{outer}{}", member.name.as_deref().unwrap_or_default());
        let (inner, offset) = (&module.types[member.ty], base + member.offset as usize);
        if matches!(inner.inner, TypeInner::Struct { .. }) {
            add_fields(module, inner, &format!("{name}."), offset, fields);
        } else {
            let mut offsets = Vec::new();
            word_offsets(module, member.ty, offset, &mut offsets);
            fields.push(Field { name, kind: kind(module, member.ty), offsets });
        }
    }
}

fn kind(module: &Module, ty: Handle<Type>) -> ScalarKind {
    match module.types[ty].inner {
        TypeInner::Array { base, .. } => kind(module, base),
        ref inner => inner.scalar_kind().unwrap_or_else(|| unreachable!("{inner:?} has no scalars")),
    }
}

/// Adds the byte offset of each word of a type that lies at `base`.
///
/// # Panics
/// If the type is not made of scalars of 32 bits, or has an array of runtime size.
pub fn word_offsets(module: &Module, ty: Handle<Type>, base: usize, offsets: &mut Vec<usize>) {
    match &module.types[ty].inner {
        TypeInner::Scalar(_) | TypeInner::Atomic(_) => offsets.push(base),
        TypeInner::Vector { size, .. } => {
            offsets.extend((0..*size as usize).map(|index| base + 4 * index));
        }
        TypeInner::Matrix { columns, rows, .. } => {
            // WGSL aligns a column of three like one of four.
            let column_stride = if *rows == VectorSize::Bi { 8 } else { 16 };
            for column in 0..*columns as usize {
                offsets.extend((0..*rows as usize).map(|row| base + column * column_stride + 4 * row));
            }
        }
        TypeInner::Array { base: element, size: ArraySize::Constant(length), stride } => {
            for index in 0..length.get() as usize {
                word_offsets(module, *element, base + index * *stride as usize, offsets);
            }
        }
        TypeInner::Struct { members, .. } => {
            for member in members {
                word_offsets(module, member.ty, base + member.offset as usize, offsets);
            }
        }
        other => unreachable!("{other:?} is not made of words"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_lie_where_wgsl_puts_them() {
        let source = "struct Inner { at: vec3f, size: f32, count: u32 }
            struct Outer { turn: mat3x3f, inner: Inner, last: i32, rows: array<vec4f, 2> }
            @group(0) @binding(0) var<uniform> outer: Outer;";
        let (module, _) = crate::parse(source, "layout.wgsl").expect("valid");
        let outer = StructLayout::named(&module, "Outer").expect("there");
        let found: Vec<(&str, ScalarKind, usize, usize)> =
            outer.fields.iter().map(|f| (f.name.as_str(), f.kind, f.offsets[0], f.offsets.len())).collect();
        use ScalarKind::{Float, Sint, Uint};
        let wanted = [
            ("turn", Float, 0, 9),
            ("inner.at", Float, 48, 3),
            ("inner.size", Float, 60, 1),
            ("inner.count", Uint, 64, 1),
            ("last", Sint, 80, 1),
            ("rows", Float, 96, 8),
        ];
        assert_eq!((found, outer.size), (wanted.to_vec(), 128));
        assert_eq!(outer.fields[0].offsets, [0, 4, 8, 16, 20, 24, 32, 36, 40]);
        assert_eq!(StructLayout::named(&module, "Other"), None);
    }
}
