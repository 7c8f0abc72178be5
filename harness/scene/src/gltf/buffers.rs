//! Contents of a file's buffers: the binary chunk, base64 in the JSON, or external files.

use std::borrow::Cow;
use std::cell::{Cell, OnceCell};
use std::path::Path;

use ::gltf::json::{Buffer, Root};

use super::error::{GltfError, item};
use super::limits::MAX_FILE_BYTES;
use super::uri;

/// Contents of all buffers, each exactly as long as the file states.
#[derive(Debug)]
pub(super) struct Buffers<'a> {
    buffers: Vec<Cow<'a, [u8]>>,
    /// The elements of each sparse accessor, once they have been asked for.
    filled: Vec<OnceCell<Vec<u8>>>,
    /// Bytes that those not yet asked for may take.
    left: Cell<u64>,
}

impl<'a> Buffers<'a> {
    pub(super) fn load(root: &Root, binary: Option<&'a [u8]>, base: Option<&Path>) -> Result<Self, GltfError> {
        let mut all = Self {
            buffers: Vec::with_capacity(root.buffers.len()),
            filled: vec![OnceCell::new(); root.accessors.len()],
            left: Cell::new(MAX_FILE_BYTES),
        };
        let mut left = MAX_FILE_BYTES;
        for (index, buffer) in root.buffers.iter().enumerate() {
            let length = buffer.byte_length.0;
            left = left.checked_sub(length).ok_or_else(|| GltfError::TooLarge {
                what: format!("buffer {index}, with those before it,"),
                bytes: (MAX_FILE_BYTES - left).saturating_add(length),
                limit: MAX_FILE_BYTES,
            })?;
            let bytes = bytes_of(index, buffer, binary, base)?;
            all.buffers.push(bytes);
        }
        Ok(all)
    }

    /// Returns the elements of the sparse accessor `index`, of so many bytes, as `fill` made them when they were first asked for.
    /// Together they may take [`MAX_FILE_BYTES`]: a small file can state any number of them.
    pub(super) fn filled(
        &self,
        index: usize,
        bytes: u64,
        fill: impl FnOnce() -> Result<Vec<u8>, GltfError>,
    ) -> Result<&[u8], GltfError> {
        let kept = &self.filled[index];
        if let Some(elements) = kept.get() {
            return Ok(elements);
        }
        let left = self.left.get().checked_sub(bytes).ok_or_else(|| GltfError::TooLarge {
            what: format!("accessor {index}, with the sparse ones before it,"),
            bytes: (MAX_FILE_BYTES - self.left.get()).saturating_add(bytes),
            limit: MAX_FILE_BYTES,
        })?;
        self.left.set(left);
        let elements = fill()?;
        Ok(kept.get_or_init(|| elements))
    }

    /// Returns the bytes of buffer view `index`, which `user` refers to.
    pub(super) fn view(&self, root: &Root, index: usize, user: impl FnOnce() -> String) -> Result<&[u8], GltfError> {
        let view = item(&root.buffer_views, "bufferView", index, user)?;
        let part = || format!("bufferView {index}");
        let buffer = item(&self.buffers, "buffer", view.buffer.value(), part)?;
        let (start, length) = (view.byte_offset.map_or(0, |offset| offset.0), view.byte_length.0);
        range(buffer, start, length).ok_or_else(|| {
            let has = buffer.len();
            GltfError::part(
                part(),
                format!("it takes {length} bytes from byte {start} of a buffer of {has}; export it again"),
            )
        })
    }
}

/// Returns the contents of one buffer.
fn bytes_of<'a>(
    index: usize,
    buffer: &Buffer,
    binary: Option<&'a [u8]>,
    base: Option<&Path>,
) -> Result<Cow<'a, [u8]>, GltfError> {
    let wrong = |problem: String| GltfError::part(format!("buffer {index}"), problem);
    // `load` has bounded the length; a GiB fits in a usize even on a 32-bit machine.
    let length = buffer.byte_length.0 as usize;
    let mut bytes = match (&buffer.uri, binary) {
        (None, Some(binary)) if index == 0 => Cow::Borrowed(binary),
        (None, _) => {
            return Err(wrong("it has no uri and no binary chunk; export it again".to_owned()));
        }
        (Some(uri), _) => Cow::Owned(uri::contents(uri, base, &format!("buffer {index}"), length as u64)?),
    };
    if bytes.len() < length {
        let found = bytes.len();
        return Err(wrong(format!("it must have {length} bytes but has {found}; export or download it again")));
    }
    match &mut bytes {
        Cow::Borrowed(slice) => *slice = &slice[..length],
        Cow::Owned(vector) => vector.truncate(length),
    }
    Ok(bytes)
}

/// Returns `length` bytes from `start`, or `None` if there are fewer.
pub(super) fn range(bytes: &[u8], start: u64, length: u64) -> Option<&[u8]> {
    let end = usize::try_from(start.checked_add(length)?).ok()?;
    bytes.get(usize::try_from(start).ok()?..end)
}
