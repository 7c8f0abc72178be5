//! Signature of a WGSL function, read from naga's IR and compared with the signature that Rust
//! expects.

use crate::shape::{Scalar, Shape};
use std::fmt;

/// A function's name, its arguments with their names, and its result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signature {
    /// Name of the WGSL function.
    pub function: String,
    /// Name and shape of each argument.
    pub arguments: Vec<(String, Shape)>,
    /// Shape of the result.
    pub result: Shape,
}

impl Signature {
    /// Reads the signature of `function` from a naga module.
    pub fn reflect(module: &naga::Module, function: &str) -> Result<Signature, SignatureError> {
        let Some((_, found)) = module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(function)) else {
            return Err(SignatureError::Missing { function: function.to_owned() });
        };
        let unsupported =
            |part: String, reason: String| SignatureError::Unsupported { function: function.to_owned(), part, reason };
        let arguments = found
            .arguments
            .iter()
            .map(|argument| {
                let name = argument.name.clone().unwrap_or_default();
                match of_type(module, argument.ty) {
                    Ok(shape) => Ok((name, shape)),
                    Err(reason) => Err(unsupported(format!("argument `{name}`"), reason)),
                }
            })
            .collect::<Result<_, _>>()?;
        let Some(result) = &found.result else {
            return Err(unsupported("result".to_owned(), "it returns nothing".to_owned()));
        };
        let result = of_type(module, result.ty).map_err(|reason| unsupported("result".to_owned(), reason))?;
        Ok(Signature { function: function.to_owned(), arguments, result })
    }

    /// Returns the names of all structs in the arguments and the result, nested ones included, and
    /// of their members.
    pub fn structs(&self) -> std::collections::BTreeSet<&str> {
        fn collect<'a>(shape: &'a Shape, names: &mut std::collections::BTreeSet<&'a str>) {
            match shape {
                Shape::Struct(name, fields) => {
                    names.insert(name);
                    for (field, shape) in fields {
                        names.insert(field);
                        collect(shape, names);
                    }
                }
                Shape::Array(element, _) => collect(element, names),
                Shape::Scalar(_) | Shape::Vector(..) | Shape::Matrix(..) => {}
            }
        }
        let mut names = std::collections::BTreeSet::new();
        self.arguments
            .iter()
            .map(|(_, shape)| shape)
            .chain([&self.result])
            .for_each(|shape| collect(shape, &mut names));
        names
    }

    /// Checks that this signature, read from WGSL, is the one that the Rust side expects.
    pub fn expect(&self, arguments: &[Shape], result: &Shape) -> Result<(), SignatureError> {
        let mismatch = |part: String, expected: &str, found: &str| SignatureError::Mismatch {
            function: self.function.clone(),
            part,
            expected: expected.to_owned(),
            found: found.to_owned(),
        };
        if arguments.len() != self.arguments.len() {
            return Err(mismatch(
                "number of arguments".to_owned(),
                &arguments.len().to_string(),
                &self.arguments.len().to_string(),
            ));
        }
        for (expected, (name, found)) in arguments.iter().zip(&self.arguments) {
            if let Some((expected, found)) = difference(expected, found) {
                return Err(mismatch(format!("argument `{name}`"), &expected, &found));
            }
        }
        match difference(result, &self.result) {
            None => Ok(()),
            Some((expected, found)) => Err(mismatch("result".to_owned(), &expected, &found)),
        }
    }
}

/// Formats the signature in WGSL syntax.
impl fmt::Display for Signature {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "fn {}(", self.function)?;
        for (index, (name, shape)) in self.arguments.iter().enumerate() {
            write!(f, "{}{name}: {shape}", if index == 0 { "" } else { ", " })?;
        }
        write!(f, ") -> {}", self.result)
    }
}

/// Returns the first difference between two shapes, down to the member.
pub(crate) fn difference(expected: &Shape, found: &Shape) -> Option<(String, String)> {
    if expected == found {
        return None;
    }
    let spell = |shape: &Shape| match shape {
        Shape::Struct(name, fields) => {
            let fields: Vec<String> = fields.iter().map(|(name, shape)| format!("{name}: {shape}")).collect();
            format!("{name} {{ {} }}", fields.join(", "))
        }
        other => other.to_string(),
    };
    if let (Shape::Struct(name, left), Shape::Struct(other, right)) = (expected, found)
        && name == other
        && left.len() == right.len()
        && left.iter().zip(right).all(|(left, right)| left.0 == right.0)
    {
        return left.iter().zip(right).find_map(|(left, right)| {
            let (expected, found) = difference(&left.1, &right.1)?;
            Some((format!("{name}.{}: {expected}", left.0), format!("{name}.{}: {found}", left.0)))
        });
    }
    Some((spell(expected), spell(found)))
}

/// Reason why a function cannot be dispatched.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SignatureError {
    /// The source has no such function.
    #[error("function `{function}` is missing")]
    Missing {
        /// Its name.
        function: String,
    },
    /// Its types cannot travel through a buffer.
    #[error("function `{function}`: {part}: {reason}")]
    Unsupported {
        /// Its name.
        function: String,
        /// Which argument, or the result.
        part: String,
        /// Reason why it cannot travel.
        reason: String,
    },
    /// WGSL and Rust disagree.
    #[error("function `{function}`: {part}: expected {expected}, found {found}")]
    Mismatch {
        /// Its name.
        function: String,
        /// Which argument, or the result.
        part: String,
        /// Shape or number in the mirror.
        expected: String,
        /// Shape or number in the WGSL.
        found: String,
    },
}

/// Returns the shape of a type in a naga module, or an error that names the part that cannot
/// travel.
pub fn of_type(module: &naga::Module, ty: naga::Handle<naga::Type>) -> Result<Shape, String> {
    let named = |ty: naga::Handle<naga::Type>| {
        module.types[ty].name.clone().unwrap_or_else(|| format!("{:?}", module.types[ty].inner))
    };
    let scalar = |scalar: naga::Scalar| match (scalar.kind, scalar.width) {
        (naga::ScalarKind::Float, 4) => Ok(Scalar::F32),
        (naga::ScalarKind::Sint, 4) => Ok(Scalar::I32),
        (naga::ScalarKind::Uint, 4) => Ok(Scalar::U32),
        (naga::ScalarKind::Bool, _) => Ok(Scalar::Bool),
        _ => Err(format!("{scalar:?} is not a 32-bit scalar")),
    };
    match &module.types[ty].inner {
        // An atomic is read and written as its integer.
        naga::TypeInner::Scalar(inner) | naga::TypeInner::Atomic(inner) => Ok(Shape::Scalar(scalar(*inner)?)),
        naga::TypeInner::Vector { size, scalar: inner } => Ok(Shape::Vector(*size as u8, scalar(*inner)?)),
        naga::TypeInner::Matrix { columns, rows, scalar: inner } => match scalar(*inner)? {
            Scalar::F32 => Ok(Shape::Matrix(*columns as u8, *rows as u8)),
            other => Err(format!("a matrix of {}", other.name())),
        },
        naga::TypeInner::Array { base, size: naga::ArraySize::Constant(length), .. } => {
            Ok(Shape::Array(Box::new(of_type(module, *base)?), length.get()))
        }
        naga::TypeInner::Struct { members, .. } => {
            let fields = members
                .iter()
                .map(|member| Ok((member.name.clone().unwrap_or_default(), of_type(module, member.ty)?)))
                .collect::<Result<_, String>>()?;
            Ok(Shape::Struct(named(ty), fields))
        }
        naga::TypeInner::Image { .. } => Err("a texture cannot be passed through a buffer".to_owned()),
        naga::TypeInner::Sampler { .. } => Err("a sampler cannot be passed through a buffer".to_owned()),
        naga::TypeInner::Pointer { .. } | naga::TypeInner::ValuePointer { .. } => {
            Err("a pointer cannot be passed through a buffer".to_owned())
        }
        _ => Err(format!("`{}` cannot be passed through a buffer", named(ty))),
    }
}
