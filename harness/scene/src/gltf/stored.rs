//! Elements as a bufferView has them.

use ::gltf::json::Root;

use super::buffers::{Buffers, range};
use super::error::{GltfError, item};

/// Elements in a bufferView.
pub(super) struct Stored<'a> {
    /// The accessor, for messages.
    pub(super) part: &'a str,
    /// Index of the bufferView.
    pub(super) view: usize,
    /// Byte in it where they begin.
    pub(super) start: u64,
    /// Bytes of an element.
    pub(super) size: usize,
    /// Number of elements.
    pub(super) count: u64,
}

impl Stored<'_> {
    /// Returns the bytes from the first element to the end of the last, and the bytes from one to the next.
    pub(super) fn find<'a>(&self, root: &Root, buffers: &'a Buffers<'_>) -> Result<(&'a [u8], usize), GltfError> {
        let &Self { part, view: index, start, size, count } = self;
        let wrong = |problem: String| GltfError::part(part.to_owned(), problem);
        let view = item(&root.buffer_views, "bufferView", index, || part.to_owned())?;
        let view_bytes = buffers.view(root, index, || part.to_owned())?;
        let stride = view.byte_stride.map_or(size, |stride| stride.0);
        if !(size..=252).contains(&stride) {
            return Err(wrong(format!(
                "its elements of {size} bytes lie {stride} apart, but must lie {size} to 252 apart"
            )));
        }
        // The last element may end before its full stride.
        let length = count.checked_sub(1).and_then(|steps| steps.checked_mul(stride as u64)?.checked_add(size as u64));
        let bytes = length.and_then(|length| range(view_bytes, start, length)).ok_or_else(|| {
            let has = view_bytes.len();
            wrong(format!(
                "it has {count} elements of {size} bytes, {stride} apart from byte {start}, in a \
                 bufferView of {has} bytes; export it again"
            ))
        })?;
        Ok((bytes, stride))
    }
}

/// Decodes an integer of up to four bytes, which need not be aligned.
pub(super) fn little_endian(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |number, &byte| number << 8 | u32::from(byte))
}
