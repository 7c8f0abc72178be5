//! The layout of a shader's structs in buffers, taken from naga: name, kind and offset of each
//! field.

use naga::{ArraySize, Handle, Module, ScalarKind, Type, TypeInner, VectorSize};

/// A struct in a uniform or storage buffer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StructLayout {
    /// Size in bytes, which is also the stride in an array.
    pub size: usize,
    /// Fields in order. A field of an inner struct is named `outer.inner`.
    pub fields: Vec<Field>,
}

/// A field made of scalars: a scalar, a vector, a matrix, or an array of these.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Name of the field.
    pub name: String,
    /// Type in WGSL notation: `vec3<f32>`.
    pub ty: String,
    /// Kind of the scalars, which are 32 bits wide.
    pub kind: ScalarKind,
    /// Byte offset of each scalar from the start of the struct; a matrix is listed column by
    /// column.
    pub offsets: Vec<usize>,
}

impl StructLayout {
    /// Returns the name and layout of each struct in a module that consists of 32-bit scalars.
    pub fn all(module: &Module) -> impl Iterator<Item = (&str, StructLayout)> {
        module.types.iter().filter_map(|(_, ty)| {
            let TypeInner::Struct { span, .. } = ty.inner else { return None };
            let mut fields = Vec::new();
            add_fields(module, ty, "", 0, &mut fields)?;
            Some((ty.name.as_deref()?, StructLayout { size: span as usize, fields }))
        })
    }
}

/// Adds the fields of a struct; `None` if one of them does not consist of 32-bit scalars.
fn add_fields(module: &Module, ty: &Type, outer: &str, base: usize, fields: &mut Vec<Field>) -> Option<()> {
    let TypeInner::Struct { members, .. } = &ty.inner else { return None };
    for member in members {
        let name = format!("{outer}{}", member.name.as_deref().unwrap_or_default());
        let (inner, offset) = (&module.types[member.ty], base + member.offset as usize);
        if matches!(inner.inner, TypeInner::Struct { .. }) {
            add_fields(module, inner, &format!("{name}."), offset, fields)?;
        } else {
            let (kind, offsets) = (kind(module, member.ty)?, word_offsets(module, member.ty, offset)?);
            fields.push(Field { name, ty: type_name(module, member.ty)?, kind, offsets });
        }
    }
    Some(())
}

fn kind(module: &Module, ty: Handle<Type>) -> Option<ScalarKind> {
    match module.types[ty].inner {
        TypeInner::Array { base, .. } => kind(module, base),
        ref inner => inner.scalar_kind(),
    }
}

/// Returns a type of 32-bit scalars in WGSL notation; `None` for any other type.
fn type_name(module: &Module, ty: Handle<Type>) -> Option<String> {
    let scalar = |kind: ScalarKind| match kind {
        ScalarKind::Float => Some("f32"),
        ScalarKind::Sint => Some("i32"),
        ScalarKind::Uint => Some("u32"),
        _ => None,
    };
    let inner = &module.types[ty].inner;
    Some(match *inner {
        TypeInner::Scalar(_) => scalar(inner.scalar_kind()?)?.to_owned(),
        TypeInner::Vector { size, .. } => format!("vec{}<{}>", size as u32, scalar(inner.scalar_kind()?)?),
        TypeInner::Matrix { columns, rows, .. } => format!("mat{}x{}<f32>", columns as u32, rows as u32),
        TypeInner::Array { base, size: ArraySize::Constant(length), .. } => {
            format!("array<{}, {length}>", type_name(module, base)?)
        }
        _ => return None,
    })
}

/// Returns the byte offset of each word of a type at offset `base`; `None` if the type does not
/// consist of 32-bit scalars, or has an array of runtime size.
pub fn word_offsets(module: &Module, ty: Handle<Type>, base: usize) -> Option<Vec<usize>> {
    let of_parts = |parts: &mut dyn Iterator<Item = (Handle<Type>, usize)>| {
        parts
            .map(|(ty, offset)| word_offsets(module, ty, base + offset))
            .collect::<Option<Vec<_>>>()
            .map(|it| it.concat())
    };
    match &module.types[ty].inner {
        TypeInner::Scalar(_) | TypeInner::Atomic(_) => Some(vec![base]),
        TypeInner::Vector { size, .. } => Some((0..*size as usize).map(|index| base + 4 * index).collect()),
        TypeInner::Matrix { columns, rows, .. } => {
            // WGSL aligns a column of three like one of four.
            let column_stride = if *rows == VectorSize::Bi { 8 } else { 16 };
            let column = |column: usize| (0..*rows as usize).map(move |row| base + column * column_stride + 4 * row);
            Some((0..*columns as usize).flat_map(column).collect())
        }
        TypeInner::Array { base: element, size: ArraySize::Constant(length), stride } => {
            of_parts(&mut (0..length.get()).map(|index| (*element, (index * stride) as usize)))
        }
        TypeInner::Struct { members, .. } => {
            of_parts(&mut members.iter().map(|member| (member.ty, member.offset as usize)))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_lie_where_wgsl_puts_them() {
        let source = "struct Inner { at: vec3f, size: f32, count: u32 }
            struct Outer { turn: mat3x3f, inner: Inner, last: i32, rows: array<vec4f, 2> }
            struct Endless { count: u32, rest: array<u32> }
            @group(0) @binding(0) var<uniform> outer: Outer;
            @group(0) @binding(1) var<storage, read> endless: Endless;";
        let (module, _) = crate::parse(source, "layout.wgsl").expect("valid");
        let all: Vec<(&str, StructLayout)> = StructLayout::all(&module).collect();
        assert_eq!(all.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["Inner", "Outer"]);
        let outer = &all[1].1;
        let found: Vec<(&str, &str, ScalarKind, usize, usize)> =
            outer.fields.iter().map(|f| (&*f.name, &*f.ty, f.kind, f.offsets[0], f.offsets.len())).collect();
        use ScalarKind::{Float, Sint, Uint};
        let wanted = [
            ("turn", "mat3x3<f32>", Float, 0, 9),
            ("inner.at", "vec3<f32>", Float, 48, 3),
            ("inner.size", "f32", Float, 60, 1),
            ("inner.count", "u32", Uint, 64, 1),
            ("last", "i32", Sint, 80, 1),
            ("rows", "array<vec4<f32>, 2>", Float, 96, 8),
        ];
        assert_eq!((found, outer.size), (wanted.to_vec(), 128));
        assert_eq!(outer.fields[0].offsets, [0, 4, 8, 16, 20, 24, 32, 36, 40]);
    }
}
