//! Bounds-checked reading of accessors.

use ::gltf::json::Root;
use ::gltf::json::accessor::{ComponentType, Type};
use ::gltf::json::validation::Checked;

use super::buffers::Buffers;
use super::error::{GltfError, item};
use super::requirement::{DRACO, MESHOPT, QUANTIZATION};
use super::sparse;
use super::stored::{Stored, little_endian};

/// Elements of an accessor, verified to lie within their buffer.
#[derive(Debug, Clone, Copy)]
pub(super) struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
    component: ComponentType,
}

/// Types that an accessor may have for one use.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kind {
    types: &'static [Type],
    components: &'static [ComponentType],
    description: &'static str,
}

/// Positions and normals.
pub(super) const VECTORS: Kind =
    Kind { types: &[Type::Vec3], components: &[ComponentType::F32], description: "VEC3 of float" };

/// Texture coordinates. Integers are normalised: the largest represents 1.
pub(super) const TEXTURE_COORDINATES: Kind = Kind {
    types: &[Type::Vec2],
    components: &[ComponentType::F32, ComponentType::U8, ComponentType::U16],
    description: "VEC2 of float, or of normalised unsigned byte or short,",
};

/// Colours of vertices, with or without alpha. Integers are normalised: the largest represents 1.
pub(super) const COLORS: Kind = Kind {
    types: &[Type::Vec3, Type::Vec4],
    components: &[ComponentType::F32, ComponentType::U8, ComponentType::U16],
    description: "VEC3 or VEC4 of float, or of normalised unsigned byte or short,",
};

/// Rotations of instances. Integers are normalised: the largest represents 1.
pub(super) const ROTATIONS: Kind = Kind {
    types: &[Type::Vec4],
    components: &[ComponentType::F32, ComponentType::I8, ComponentType::I16],
    description: "VEC4 of float, or of normalised byte or short,",
};

/// Times of keys.
pub(super) const SCALARS: Kind =
    Kind { types: &[Type::Scalar], components: &[ComponentType::F32], description: "SCALAR of float" };

/// Indices.
pub(super) const INDICES: Kind = Kind {
    types: &[Type::Scalar],
    components: &[ComponentType::U8, ComponentType::U16, ComponentType::U32],
    description: "SCALAR of unsigned byte, short or int",
};

impl<'a> Elements<'a> {
    /// Returns the elements of accessor `index`, which `user` refers to. All lengths and offsets
    /// are compared in 64 bits, and no memory is allocated.
    pub(super) fn of(
        root: &Root,
        buffers: &'a Buffers<'_>,
        index: usize,
        kind: Kind,
        user: &str,
    ) -> Result<Self, GltfError> {
        let accessor = item(&root.accessors, "accessor", index, || user.to_owned())?;
        let name = format!("accessor {index}");
        let wrong = |problem: String| GltfError::part(name.clone(), problem);

        let component = match accessor.component_type {
            Checked::Valid(generic) => generic.0,
            Checked::Invalid => {
                return Err(wrong("its componentType is not one of glTF's".to_owned()));
            }
        };
        let type_ = match accessor.type_ {
            Checked::Valid(type_) => Some(type_),
            Checked::Invalid => None,
        };
        let type_ = type_.filter(|type_| kind.types.contains(type_) && kind.components.contains(&component));
        // Integers that represent fractions must be marked as normalised.
        let must_be_normalised = |type_: &Type| *type_ != Type::Scalar && component != ComponentType::F32;
        let Some(type_) = type_.filter(|type_| accessor.normalized || !must_be_normalised(type_)) else {
            let needs = format!("{user} needs {} there", kind.description);
            let is_quantised =
                root.extensions_used.iter().chain(&root.extensions_required).any(|name| name == QUANTIZATION);
            return Err(wrong(if is_quantised {
                format!(
                    "{needs}, and these are quantised by {QUANTIZATION}; export without quantisation, or undo it (`gltf-transform \
                     dequantize in.glb out.glb` does)"
                )
            } else {
                format!("{needs}; export without quantisation or compression")
            }));
        };
        let size = component.size() * type_.multiplicity();
        let count = accessor.count.0;
        let view = accessor.buffer_view.map(|view| {
            let start = accessor.byte_offset.map_or(0, |offset| offset.0);
            Stored { part: &name, view: view.value(), start, size, count }.find(root, buffers)
        });
        if let Some(sparse) = &accessor.sparse {
            let bytes = sparse::filled(root, buffers, (index, &name), sparse, (size, count), view.transpose()?)?;
            return Ok(Self { bytes, stride: size, size, count: bytes.len() / size, component });
        }
        let Some(view) = view else {
            let has = |name: &str| root.extensions_used.iter().any(|used| used == name);
            let by = std::iter::once(DRACO).chain(MESHOPT).find(|name| has(name));
            return Err(wrong(by.map_or_else(
                || "it has no bufferView, so no data; export it again".to_owned(),
                |name| {
                    format!(
                        "it has no bufferView, so its data are those of {name}, which is not read; export without compression, or unpack it \
                         (`gltf-transform copy in.glb out.glb` does)"
                    )
                },
            )));
        };
        let (bytes, stride) = view?;
        // What lies in a buffer fits in a usize.
        Ok(Self { bytes, stride, size, count: count as usize, component })
    }

    /// Number of elements, at least one.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Iterates over the elements as vectors. Intended for [`VECTORS`].
    pub(super) fn vectors(self) -> impl Iterator<Item = [f32; 3]> + 'a {
        self.elements().map(|bytes| {
            let mut components = bytes.chunks_exact(4).map(little_endian).map(f32::from_bits);
            std::array::from_fn(|_| components.next().unwrap_or(0.0))
        })
    }

    /// Iterates over the elements as pairs. Intended for [`TEXTURE_COORDINATES`].
    pub(super) fn pairs(self) -> impl Iterator<Item = [f32; 2]> + 'a {
        self.fractions()
    }

    /// Iterates over the elements as red, green and blue. Intended for [`COLORS`].
    pub(super) fn colors(self) -> impl Iterator<Item = [f32; 3]> + 'a {
        self.fractions()
    }

    /// Iterates over the elements as single numbers. Intended for [`SCALARS`].
    pub(super) fn numbers(self) -> impl Iterator<Item = [f32; 1]> + 'a {
        self.fractions()
    }

    /// Iterates over the first components of the elements.
    fn fractions<const N: usize>(self) -> impl Iterator<Item = [f32; N]> + 'a {
        let component = self.component;
        let number = move |bytes: &[u8]| match component {
            ComponentType::U8 => little_endian(bytes) as f32 / 255.0,
            ComponentType::U16 => little_endian(bytes) as f32 / 65535.0,
            _ => f32::from_bits(little_endian(bytes)),
        };
        self.elements().map(move |bytes| {
            let mut components = bytes.chunks_exact(component.size()).map(number);
            std::array::from_fn(|_| components.next().unwrap_or(0.0))
        })
    }

    /// Iterates over the elements as quaternions, not yet normalised. Intended for [`ROTATIONS`].
    pub(super) fn quaternions(self) -> impl Iterator<Item = [f32; 4]> + 'a {
        let component = self.component;
        // In glTF the lowest integer, which would map below -1, represents -1.
        let number = move |bytes: &[u8]| match component {
            ComponentType::I8 => (f32::from(little_endian(bytes) as i8) / 127.0).max(-1.0),
            ComponentType::I16 => (f32::from(little_endian(bytes) as i16) / 32767.0).max(-1.0),
            _ => f32::from_bits(little_endian(bytes)),
        };
        self.elements().map(move |bytes| {
            let mut components = bytes.chunks_exact(component.size()).map(number);
            std::array::from_fn(|_| components.next().unwrap_or(0.0))
        })
    }

    /// Iterates over the elements as unsigned integers. Intended for [`INDICES`].
    pub(super) fn indices(self) -> impl Iterator<Item = u32> + 'a {
        self.elements().map(little_endian)
    }

    fn elements(self) -> impl Iterator<Item = &'a [u8]> {
        let chunks = self.bytes.chunks(self.stride).take(self.count);
        chunks.map(move |chunk| &chunk[..self.size])
    }
}
