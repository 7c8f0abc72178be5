//! Primitives compressed by `KHR_draco_mesh_compression`.

use std::collections::BTreeMap;

use draco_core::{DecodeLimits, DecoderBuffer, ErrorKind, Mesh, MeshDecoder};
use serde_json::{Map, Value};

use super::error::excerpt;
use super::extension::Extension;
use super::limits::MAX_TRIANGLES;
use super::requirement::DRACO;

/// What the extension says of a primitive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reference<'a> {
    /// Index of the bufferView with the stream.
    pub(super) view: usize,
    /// Numbers of the stream's attributes by their names in glTF.
    attributes: Extension<'a>,
}

/// A stream, decoded.
#[derive(Debug)]
pub(super) struct Decoded {
    /// Three vertices for each triangle, as integers of four bytes.
    pub(super) corners: Vec<u8>,
    /// Attributes by their numbers in the stream.
    attributes: BTreeMap<u32, Attribute>,
}

/// Values of an attribute, one for each vertex.
#[derive(Debug)]
pub(super) struct Attribute {
    /// Numbers in a value.
    pub(super) width: usize,
    /// Floats, or integers as floats.
    pub(super) numbers: Vec<u8>,
}

impl<'a> Reference<'a> {
    /// Reads the extension of a primitive; `None` if it has none.
    pub(super) fn of(extensions: Option<&'a Map<String, Value>>) -> Result<Option<Self>, String> {
        if !extensions.is_some_and(|all| all.contains_key(DRACO)) {
            return Ok(None);
        }
        let incomplete = || format!("its {DRACO} has no bufferView or no attributes; export it again");
        let extension = Extension::of(extensions, DRACO)?;
        let view = extension.index("bufferView")?.ok_or_else(incomplete)?;
        let attributes = extension.member("attributes").filter(|value| value.is_object()).ok_or_else(incomplete)?;
        Ok(Some(Self { view, attributes: Extension::inside(attributes) }))
    }

    /// Returns the values of the attribute of this name; `None` if the stream is not said to have them.
    pub(super) fn attribute<'d>(&self, name: &str, decoded: &'d Decoded) -> Result<Option<&'d Attribute>, String> {
        let Some(number) = self.attributes.index(name)? else { return Ok(None) };
        let attribute = u32::try_from(number).ok().and_then(|number| decoded.attributes.get(&number));
        let missing =
            || format!("its {DRACO} says that {name} is attribute {number}, which is not there; export it again");
        attribute.map(Some).ok_or_else(missing)
    }
}

impl Decoded {
    /// Decodes a stream whose values take at most `most` bytes. `take` is asked before as many are allocated as the result has.
    ///
    /// # Errors
    /// The problem, or that of `take`.
    pub(super) fn of<E>(
        stream: &[u8],
        most: u64,
        problem: impl Fn(String) -> E,
        take: impl FnOnce(u64) -> Result<(), E>,
    ) -> Result<Self, E> {
        let limits = DecodeLimits::default().with_max_faces(MAX_TRIANGLES).with_max_decoded_bytes(most);
        let mut mesh = Mesh::new();
        MeshDecoder::new().decode(&mut DecoderBuffer::new(stream).with_limits(limits), &mut mesh).map_err(|error| {
            let reason = excerpt(&error.to_string());
            problem(match error.kind() {
                ErrorKind::LimitExceeded => format!("its {DRACO} is too large: {reason}; decimate it"),
                _ => format!("its {DRACO} cannot be decoded: {reason}; export or download it again"),
            })
        })?;
        let vertices = mesh.num_points();
        let all = || (0..mesh.num_attributes()).map(|place| mesh.attribute(place));
        let width: usize = all().map(|attribute| usize::from(attribute.num_components())).sum();
        take(4 * (width as u64 * vertices as u64 + 3 * mesh.num_faces() as u64))?;
        let corners = mesh.faces().iter().flatten().flat_map(|vertex| vertex.0.to_le_bytes()).collect();
        let attributes = all().map(|attribute| {
            let width = usize::from(attribute.num_components());
            let numbers = attribute.read_f32s(vertices, width).into_iter().flat_map(f32::to_le_bytes).collect();
            (attribute.unique_id(), Attribute { width, numbers })
        });
        Ok(Self { corners, attributes: attributes.collect() })
    }
}
