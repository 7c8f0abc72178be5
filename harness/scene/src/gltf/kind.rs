//! Types that an accessor may have for each use.

use ::gltf::json::accessor::{ComponentType, Type};

/// Types that an accessor may have for one use.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kind {
    types: &'static [Type],
    /// Types of its components. Integers must be normalised, those of scalars excepted.
    components: &'static [ComponentType],
    quantised: Quantised,
    /// What is needed, in words.
    pub(super) description: &'static str,
}

/// Integers that `KHR_mesh_quantization` allows as well.
#[derive(Debug, Clone, Copy)]
enum Quantised {
    /// None: the extension does not concern this use.
    None,
    /// Normalised ones with a sign.
    Directions,
    /// Bytes and shorts, normalised or as they are.
    Any,
}

/// Times of keys.
pub(super) const SCALARS: Kind = Kind {
    types: &[Type::Scalar],
    components: &[ComponentType::F32],
    quantised: Quantised::None,
    description: "SCALAR of float",
};

/// Vectors of instances and of keys.
pub(super) const VECTORS: Kind = Kind {
    types: &[Type::Vec3],
    components: &[ComponentType::F32],
    quantised: Quantised::None,
    description: "VEC3 of float",
};

/// Positions of vertices.
pub(super) const POSITIONS: Kind = Kind { quantised: Quantised::Any, ..VECTORS };

/// Normals of vertices.
pub(super) const NORMALS: Kind = Kind { quantised: Quantised::Directions, ..VECTORS };

/// Texture coordinates. Normalised integers are fractions of the largest.
pub(super) const TEXTURE_COORDINATES: Kind = Kind {
    types: &[Type::Vec2],
    components: &[ComponentType::F32, ComponentType::U8, ComponentType::U16],
    quantised: Quantised::Any,
    description: "VEC2 of float, or of normalised unsigned byte or short,",
};

/// Colours of vertices, with or without alpha. Integers are fractions of the largest.
pub(super) const COLORS: Kind = Kind {
    types: &[Type::Vec3, Type::Vec4],
    components: &[ComponentType::F32, ComponentType::U8, ComponentType::U16],
    quantised: Quantised::None,
    description: "VEC3 or VEC4 of float, or of normalised unsigned byte or short,",
};

/// Rotations of instances. Integers are fractions of the largest.
pub(super) const ROTATIONS: Kind = Kind {
    types: &[Type::Vec4],
    components: &[ComponentType::F32, ComponentType::I8, ComponentType::I16],
    quantised: Quantised::None,
    description: "VEC4 of float, or of normalised byte or short,",
};

/// Indices.
pub(super) const INDICES: Kind = Kind {
    types: &[Type::Scalar],
    components: &[ComponentType::U8, ComponentType::U16, ComponentType::U32],
    quantised: Quantised::None,
    description: "SCALAR of unsigned byte, short or int",
};

impl Kind {
    /// Whether an accessor of this type is one of the kind.
    pub(super) fn has(&self, type_: Type, component: ComponentType, normalized: bool) -> bool {
        // Integers that represent fractions must be marked as normalised.
        let is_marked = normalized || component == ComponentType::F32 || type_ == Type::Scalar;
        self.types.contains(&type_) && self.components.contains(&component) && is_marked
    }

    /// Whether it is one by `KHR_mesh_quantization` alone.
    pub(super) fn has_quantised(&self, type_: Type, component: ComponentType, normalized: bool) -> bool {
        use ComponentType::{I8, I16, U8, U16};
        let is_allowed = match self.quantised {
            Quantised::None => false,
            Quantised::Directions => normalized && matches!(component, I8 | I16),
            Quantised::Any => matches!(component, I8 | U8 | I16 | U16),
        };
        self.types.contains(&type_) && is_allowed
    }
}
