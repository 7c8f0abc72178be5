//! The shape of a value that travels to the GPU: a WGSL type, and its mirror in Rust.
//!
//! A value of any shape flattens into 32-bit words, one per scalar in declaration order. Comparison, shrinking,
//! storage of failing inputs and reports all work on words; only the upload knows offsets.

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
    /// Travels as a `u32` of 0 or 1, since WGSL has no bool in buffers.
    Bool,
}

impl Scalar {
    /// Its WGSL keyword.
    pub const fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::I32 => "i32",
            Self::U32 => "u32",
            Self::Bool => "bool",
        }
    }
}

/// A WGSL type of scalars, vectors, matrices, arrays and structs of those.
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
    /// A struct: its name, and name and shape of each member in order.
    Struct(String, Vec<(String, Shape)>),
}

impl Shape {
    /// How many 32-bit words a value flattens to.
    pub fn words(&self) -> usize {
        match self {
            Self::Scalar(_) => 1,
            Self::Vector(size, _) => usize::from(*size),
            Self::Matrix(columns, rows) => usize::from(*columns) * usize::from(*rows),
            Self::Array(element, length) => element.words() * *length as usize,
            Self::Struct(_, fields) => fields.iter().map(|(_, shape)| shape.words()).sum(),
        }
    }

    /// Whether a bool is anywhere inside, so that the type cannot stand in a buffer as it is.
    pub fn holds_bool(&self) -> bool {
        match self {
            Self::Scalar(scalar) | Self::Vector(_, scalar) => *scalar == Scalar::Bool,
            Self::Matrix(..) => false,
            Self::Array(element, _) => element.holds_bool(),
            Self::Struct(_, fields) => fields.iter().any(|(_, shape)| shape.holds_bool()),
        }
    }

    /// The scalar of each word, in order.
    pub fn scalars(&self) -> Vec<Scalar> {
        self.leaves().iter().flat_map(|leaf| std::iter::repeat_n(leaf.scalar, leaf.length)).collect()
    }

    /// The scalars, vectors and matrix columns that the value is made of, in order of their words.
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

/// A scalar, vector or matrix column inside a value: the unit of comparison, since a vector's error is measured by its
/// largest component.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// Where it is, as `field.member[index]`; empty where the whole value is the leaf.
    pub path: String,
    /// What it is made of.
    pub scalar: Scalar,
    /// Its first word.
    pub start: usize,
    /// How many words.
    pub length: usize,
}

/// As WGSL writes the type.
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
