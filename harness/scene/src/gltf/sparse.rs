//! Sparse accessors: the elements of a bufferView, or zeros, some of which are replaced.

use ::gltf::json::Root;
use ::gltf::json::accessor::sparse::Sparse;
use ::gltf::json::validation::Checked;

use super::buffers::Buffers;
use super::error::GltfError;
use super::stored::{Stored, little_endian};

/// Returns the elements of the accessor with this index and name, one after the other. `elements` are their size and number,
/// `replaced` their bytes before the replacement and the distance of one from the next; without them, they are 0.
pub(super) fn filled<'a>(
    root: &Root,
    buffers: &'a Buffers<'_>,
    (index, name): (usize, &str),
    sparse: &Sparse,
    (size, count): (usize, u64),
    replaced: Option<(&[u8], usize)>,
) -> Result<&'a [u8], GltfError> {
    let wrong = |problem: String| GltfError::part(name.to_owned(), problem);
    let stored = |part: &str, view: usize, start: u64, size: usize| {
        let (bytes, stride) = Stored { part, view, start, size, count: sparse.count.0 }.find(root, buffers)?;
        Ok::<_, GltfError>(bytes.chunks(stride).map(move |element| &element[..size]))
    };
    if count == 0 {
        return Err(wrong("it has no elements; export it again".to_owned()));
    }
    buffers.filled(index, count.saturating_mul(size as u64), || {
        let Checked::Valid(component) = sparse.indices.component_type else {
            return Err(wrong("the componentType of its sparse indices is not one of glTF's".to_owned()));
        };
        let Sparse { indices, values, .. } = sparse;
        let places =
            stored(&format!("{name}, sparse indices"), indices.buffer_view.value(), indices.byte_offset.0, component.0.size())?;
        let values = stored(&format!("{name}, sparse values"), values.buffer_view.value(), values.byte_offset.0, size)?;
        let mut filled = match replaced {
            Some((bytes, stride)) => bytes.chunks(stride).flat_map(|element| &element[..size]).copied().collect(),
            None => vec![0; count as usize * size],
        };
        let mut next = 0;
        for (place, value) in places.map(little_endian).zip(values) {
            let (place, last) = (u64::from(place), count - 1);
            if place < next || place > last {
                return Err(wrong(format!(
                    "its sparse indices must rise, from 0 to {last} at most, but {place} stands where {next} or more must; export it again"
                )));
            }
            next = place + 1;
            filled[place as usize * size..][..size].copy_from_slice(value);
        }
        Ok(filled)
    })
}
