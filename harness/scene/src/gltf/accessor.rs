//! Bounds-checked reading of accessors.

use ::gltf::json::Root;
use ::gltf::json::accessor::{Accessor, ComponentType, Type};
use ::gltf::json::validation::Checked;

use super::buffers::Buffers;
use super::draco::Attribute;
use super::error::{GltfError, item};
use super::kind::Kind;
use super::requirement::{MESHOPT, QUANTIZATION};
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
    /// The number that represents 1; `None` if numbers are as they stand.
    largest: Option<f32>,
}

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
        let (type_, component) = checked(root, accessor, kind, user).map_err(wrong)?;
        let largest = largest(component, accessor.normalized);
        let size = component.size() * type_.multiplicity();
        let count = accessor.count.0;
        let view = accessor.buffer_view.map(|view| {
            let start = accessor.byte_offset.map_or(0, |offset| offset.0);
            Stored { part: &name, view: view.value(), start, size, count }.find(root, buffers)
        });
        if let Some(sparse) = &accessor.sparse {
            let bytes = sparse::filled(root, buffers, (index, &name), sparse, (size, count), view.transpose()?)?;
            return Ok(Self { bytes, stride: size, size, count: bytes.len() / size, component, largest });
        }
        let view = view.unwrap_or_else(|| Err(wrong("it has no bufferView, so no data; export it again".to_owned())));
        let (bytes, stride) = view?;
        // What lies in a buffer fits in a usize.
        Ok(Self { bytes, stride, size, count: count as usize, component, largest })
    }

    /// Returns the values of an unpacked attribute as the elements of accessor `index`, which says what they are.
    pub(super) fn of_unpacked(
        root: &Root,
        attribute: &'a Attribute,
        index: usize,
        kind: Kind,
        user: &str,
    ) -> Result<Self, GltfError> {
        let accessor = item(&root.accessors, "accessor", index, || user.to_owned())?;
        let wrong = |problem: String| GltfError::part(format!("accessor {index}"), problem);
        let (type_, component) = checked(root, accessor, kind, user).map_err(wrong)?;
        let Attribute { width, numbers } = attribute;
        if *width != type_.multiplicity() {
            let problem = format!("its type has {} components, but {width} are compressed", type_.multiplicity());
            return Err(wrong(format!("{problem}; export it again")));
        }
        let largest = largest(component, accessor.normalized);
        let size = 4 * width;
        Ok(Self {
            bytes: numbers,
            stride: size,
            size,
            count: numbers.len() / size,
            component: ComponentType::F32,
            largest,
        })
    }

    /// Returns unpacked vertex indices of four bytes as elements.
    pub(super) fn of_corners(corners: &'a [u8]) -> Self {
        Self {
            bytes: corners,
            stride: 4,
            size: 4,
            count: corners.len() / 4,
            component: ComponentType::U32,
            largest: None,
        }
    }

    /// Number of elements, at least one.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Iterates over the first `N` components of the elements as numbers. Normalised integers become fractions of the largest, and
    /// the lowest, which would lie below -1, becomes -1.
    pub(super) fn numbers<const N: usize>(self) -> impl Iterator<Item = [f32; N]> + 'a {
        let Self { component, largest, .. } = self;
        let number = move |bytes: &[u8]| {
            let bits = little_endian(bytes);
            let number = match component {
                ComponentType::I8 => f32::from(bits as i8),
                ComponentType::I16 => f32::from(bits as i16),
                ComponentType::U8 | ComponentType::U16 | ComponentType::U32 => bits as f32,
                ComponentType::F32 => f32::from_bits(bits),
            };
            largest.map_or(number, |largest| (number / largest).max(-1.0))
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

/// Returns the type of an accessor, if `user` can have it there.
fn checked(root: &Root, accessor: &Accessor, kind: Kind, user: &str) -> Result<(Type, ComponentType), String> {
    let Checked::Valid(component) = accessor.component_type else {
        return Err("its componentType is not one of glTF's".to_owned());
    };
    let Checked::Valid(type_) = accessor.type_ else {
        return Err("its type is not one of glTF's".to_owned());
    };
    let (component, normalized) = (component.0, accessor.normalized);
    let needs = || format!("{user} needs {} there", kind.description);
    if kind.has(type_, component, normalized) {
        return Ok((type_, component));
    }
    if !kind.has_quantised(type_, component, normalized) {
        return Err(format!("{}; export it as such", needs()));
    }
    // Writers that compress by meshopt leave the other extension out.
    let is_declared = |name: &String| name == QUANTIZATION || MESHOPT.contains(&name.as_str());
    if root.extensions_used.iter().chain(&root.extensions_required).any(is_declared) {
        Ok((type_, component))
    } else {
        Err(format!("{}, or {QUANTIZATION} in extensionsUsed; export it again", needs()))
    }
}

/// The integer that represents 1; `None` if numbers stand for themselves.
fn largest(component: ComponentType, normalized: bool) -> Option<f32> {
    let largest = match component {
        ComponentType::I8 => 127.0,
        ComponentType::U8 => 255.0,
        ComponentType::I16 => 32767.0,
        ComponentType::U16 => 65535.0,
        ComponentType::U32 | ComponentType::F32 => return None,
    };
    normalized.then_some(largest)
}
