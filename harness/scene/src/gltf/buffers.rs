//! Contents of a file's buffers: the binary chunk, base64 in the JSON, or external files.

use std::borrow::Cow;
use std::cell::{Cell, OnceCell};
use std::path::Path;

use ::gltf::json::{Buffer, Root};

use super::draco::Decoded;
use super::error::{GltfError, item};
use super::limits::MAX_FILE_BYTES;
use super::meshopt::Packed;
use super::{meshopt, uri};

/// Contents of all buffers, each exactly as long as the file states.
#[derive(Debug)]
pub(super) struct Buffers<'a> {
    buffers: Vec<Cow<'a, [u8]>>,
    /// The elements of each sparse accessor, once they have been asked for.
    filled: Vec<OnceCell<Vec<u8>>>,
    /// The contents of each compressed bufferView, once they have been asked for.
    unpacked: Vec<OnceCell<Vec<u8>>>,
    /// The decoded primitive of each bufferView, once it has been asked for.
    decoded: Vec<OnceCell<Decoded>>,
    /// Bytes that what is not yet asked for may take.
    left: Cell<u64>,
}

impl<'a> Buffers<'a> {
    pub(super) fn load(root: &Root, binary: Option<&'a [u8]>, base: Option<&Path>) -> Result<Self, GltfError> {
        let mut all = Self {
            buffers: Vec::with_capacity(root.buffers.len()),
            filled: vec![OnceCell::new(); root.accessors.len()],
            unpacked: vec![OnceCell::new(); root.buffer_views.len()],
            decoded: root.buffer_views.iter().map(|_| OnceCell::new()).collect(),
            left: Cell::new(MAX_FILE_BYTES),
        };
        let mut left = MAX_FILE_BYTES;
        for (index, buffer) in root.buffers.iter().enumerate() {
            if meshopt::is_fallback(buffer.extensions.as_ref().map(|all| &all.others)) {
                all.buffers.push(Cow::Borrowed(&[]));
                continue;
            }
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
        self.take(bytes, || format!("accessor {index}, with what was unpacked before it,"))?;
        let elements = fill()?;
        Ok(kept.get_or_init(|| elements))
    }

    /// Reserves the memory for what a file states in fewer bytes than it takes: sparse accessors and what is compressed. Together they
    /// may take [`MAX_FILE_BYTES`]: a small file can state any number of them.
    pub(super) fn take(&self, bytes: u64, what: impl FnOnce() -> String) -> Result<(), GltfError> {
        let left = self.left.get().checked_sub(bytes).ok_or_else(|| GltfError::TooLarge {
            what: what(),
            bytes: (MAX_FILE_BYTES - self.left.get()).saturating_add(bytes),
            limit: MAX_FILE_BYTES,
        })?;
        self.left.set(left);
        Ok(())
    }

    /// Returns the bytes of buffer view `index`, which `user` refers to, unpacked if they are compressed.
    pub(super) fn view(&self, root: &Root, index: usize, user: impl FnOnce() -> String) -> Result<&[u8], GltfError> {
        let view = item(&root.buffer_views, "bufferView", index, user)?;
        let part = || format!("bufferView {index}");
        let wrong = |problem: String| GltfError::part(part(), problem);
        let Some(packed) = Packed::of(view).map_err(wrong)? else {
            let start = view.byte_offset.map_or(0, |offset| offset.0);
            return self.stored(view.buffer.value(), start, view.byte_length.0, part);
        };
        let kept = &self.unpacked[index];
        if let Some(bytes) = kept.get() {
            return Ok(bytes);
        }
        let stream = self.stored(packed.buffer, packed.start, packed.length, part)?;
        self.take(view.byte_length.0, || format!("{}, with what was unpacked before it,", part()))?;
        let damaged = |fault| wrong(format!("its compressed data are damaged: {fault}; export or download it again"));
        let bytes = packed.unpack(stream).map_err(damaged)?;
        Ok(kept.get_or_init(|| bytes))
    }

    /// Returns the primitive in buffer view `index`, which `user` refers to, as decoded when it was first asked for.
    pub(super) fn decoded(&self, root: &Root, index: usize, user: &str) -> Result<&Decoded, GltfError> {
        let stream = self.view(root, index, || user.to_owned())?;
        let kept = &self.decoded[index];
        if let Some(decoded) = kept.get() {
            return Ok(decoded);
        }
        let wrong = |problem: String| GltfError::part(user.to_owned(), problem);
        let what = || format!("{user}, with what was unpacked before it,");
        let decoded = Decoded::of(stream, self.left.get(), wrong, |bytes| self.take(bytes, what))?;
        Ok(kept.get_or_init(|| decoded))
    }

    /// Returns bytes of a buffer, which the bufferView `part` takes.
    fn stored(&self, buffer: usize, start: u64, length: u64, part: impl Fn() -> String) -> Result<&[u8], GltfError> {
        let buffer = item(&self.buffers, "buffer", buffer, &part)?;
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
