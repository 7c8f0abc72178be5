//! The shape of a value on its way to the GPU: a WGSL type, and its mirror in Rust.
//!
//! A value of any shape flattens into 32-bit words, one per scalar in declaration order.
//! Comparison, shrinking, storage of failing inputs and reports all work on words; only the upload
//! knows offsets.

use std::fmt;

/// A 32-bit scalar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scalar {
    /// IEEE 754 binary32.
    F32,
    /// Signed.
    I32,
    /// Unsigned.
    U32,
    /// Sent as a `u32` of 0 or 1, since WGSL has no bool in buffers.
    Bool,
}

impl Scalar {
    /// Returns the WGSL keyword.
    pub const fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::I32 => "i32",
            Self::U32 => "u32",
            Self::Bool => "bool",
        }
    }
}

/// A WGSL type: scalars, vectors and matrices, and arrays and structs of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shape {
    /// One scalar.
    Scalar(Scalar),
    /// `vecN<T>`, N from 2 to 4.
    Vector(u8, Scalar),
    /// `matCxR<f32>`: columns, rows.
    Matrix(u8, u8),
    /// `array<T, N>`.
    Array(Box<Shape>, u32),
    /// A struct: its name, and the name and shape of each member in order.
    Struct(String, Vec<(String, Shape)>),
}

impl Shape {
    /// Returns the number of 32-bit words in a value.
    pub fn words(&self) -> usize {
        match self {
            Self::Scalar(_) => 1,
            Self::Vector(size, _) => usize::from(*size),
            Self::Matrix(columns, rows) => usize::from(*columns) * usize::from(*rows),
            Self::Array(element, length) => element.words() * *length as usize,
            Self::Struct(_, fields) => fields.iter().map(|(_, shape)| shape.words()).sum(),
        }
    }

    /// Returns whether there is a bool anywhere inside, so that the type cannot be in a buffer as
    /// it is.
    pub fn holds_bool(&self) -> bool {
        match self {
            Self::Scalar(scalar) | Self::Vector(_, scalar) => *scalar == Scalar::Bool,
            Self::Matrix(..) => false,
            Self::Array(element, _) => element.holds_bool(),
            Self::Struct(_, fields) => fields.iter().any(|(_, shape)| shape.holds_bool()),
        }
    }

    /// Returns the scalar of each word, in order.
    pub fn scalars(&self) -> Vec<Scalar> {
        self.leaves().iter().flat_map(|leaf| std::iter::repeat_n(leaf.scalar, leaf.length)).collect()
    }

    /// Returns the scalars, vectors and matrix columns of the value, in the order of their words.
    pub fn leaves(&self) -> Vec<Leaf> {
        let mut leaves = Vec::new();
        self.collect_leaves(String::new(), &mut leaves);
        leaves
    }

    fn collect_leaves(&self, path: String, leaves: &mut Vec<Leaf>) {
        let start = leaves.last().map_or(0, |leaf| leaf.start + leaf.length);
        match self {
            Self::Scalar(scalar) => leaves.push(Leaf { path, scalar: *scalar, start, length: 1 }),
            Self::Vector(size, scalar) => {
                leaves.push(Leaf { path, scalar: *scalar, start, length: usize::from(*size) });
            }
            Self::Matrix(columns, rows) => {
                for column in 0..*columns {
                    Self::Vector(*rows, Scalar::F32).collect_leaves(format!("{path}[{column}]"), leaves);
                }
            }
            Self::Array(element, length) => {
                for index in 0..*length {
                    element.collect_leaves(format!("{path}[{index}]"), leaves);
                }
            }
            Self::Struct(_, fields) => {
                for (name, shape) in fields {
                    let dot = if path.is_empty() { "" } else { "." };
                    shape.collect_leaves(format!("{path}{dot}{name}"), leaves);
                }
            }
        }
    }
}

/// A scalar, vector or matrix column inside a value: the unit of comparison, since a vector's error
/// is measured by its largest component.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// Path of the leaf, as `field.member[index]`; empty if the leaf is the whole value.
    pub path: String,
    /// Type of its scalars.
    pub scalar: Scalar,
    /// Index of its first word.
    pub start: usize,
    /// Number of words.
    pub length: usize,
}

/// Formats the type as in WGSL.
impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letter = |scalar: &Scalar| match scalar {
            Scalar::F32 => "f",
            Scalar::I32 => "i",
            Scalar::U32 => "u",
            Scalar::Bool => "<bool>",
        };
        match self {
            Self::Scalar(scalar) => f.write_str(scalar.name()),
            Self::Vector(size, scalar) => write!(f, "vec{size}{}", letter(scalar)),
            Self::Matrix(columns, rows) => write!(f, "mat{columns}x{rows}f"),
            Self::Array(element, length) => write!(f, "array<{element}, {length}>"),
            Self::Struct(name, _) => f.write_str(name),
        }
    }
}
