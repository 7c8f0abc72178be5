//! Buffer views compressed by `EXT_meshopt_compression` or `KHR_meshopt_compression`.
//!
//! Streams and filters follow the extensions' appendix "Bitstream": attributes of versions 0 and 1, triangles and indices of
//! version 1. What a stream can make a decoder allocate is bounded by its own length: a byte stands for at most 1024.

use ::gltf::json::buffer::View;
use serde_json::{Map, Value};

use super::extension::Extension;
use super::requirement::MESHOPT;

mod attributes;
mod filter;
mod indices;
mod stream;

use filter::Filter;

/// What the extension says of a buffer view.
#[derive(Debug, Clone, Copy)]
pub(super) struct Packed {
    /// Index of the buffer, and the bytes in it.
    pub(super) buffer: usize,
    pub(super) start: u64,
    pub(super) length: u64,
    count: u64,
    stride: u64,
    mode: Mode,
}

#[derive(Debug, Clone, Copy)]
enum Mode {
    Attributes(Filter),
    Triangles,
    Indices,
}

/// Whether a buffer is only there for readers that do not know the extension, so that it may have no data.
pub(super) fn is_fallback(extensions: Option<&Map<String, Value>>) -> bool {
    let mut all = MESHOPT.into_iter().filter_map(|name| extensions?.get(name));
    all.any(|extension| extension.get("fallback") == Some(&Value::Bool(true)))
}

impl Packed {
    /// Reads what the extension says of `view`; `None` if it is not compressed.
    pub(super) fn of(view: &View) -> Result<Option<Self>, String> {
        let all = view.extensions.as_ref().map(|all| &all.others);
        let has = |name: &&str| all.is_some_and(|all| all.contains_key(*name));
        let Some(name) = MESHOPT.into_iter().find(has) else { return Ok(None) };
        Self::read(Extension::of(all, name)?, view.byte_length.0)
            .map(Some)
            .map_err(|problem| format!("{problem}, by its {name}; export it again"))
    }

    fn read(extension: Extension<'_>, unpacked: u64) -> Result<Self, String> {
        let needed = |key: &str| extension.index(key)?.ok_or_else(|| format!("its {key} is missing"));
        let text = |key: &str| extension.member(key).and_then(Value::as_str);
        let (count, stride) = (needed("count")? as u64, needed("byteStride")? as u64);
        let filter = text("filter").unwrap_or("NONE");
        let mode = match (text("mode").unwrap_or_default(), filter) {
            ("ATTRIBUTES", _) => Mode::Attributes(
                Filter::of(filter)
                    .filter(|filter| filter.fits(stride))
                    .ok_or("its filter is unknown or does not fit")?,
            ),
            ("TRIANGLES", "NONE") if count.is_multiple_of(3) => Mode::Triangles,
            ("INDICES", "NONE") => Mode::Indices,
            _ => return Err("its mode, filter and count do not fit one another".to_owned()),
        };
        let is_sound = match mode {
            Mode::Attributes(_) => stride.is_multiple_of(4) && (4..=256).contains(&stride),
            Mode::Triangles | Mode::Indices => stride == 2 || stride == 4,
        };
        if !is_sound {
            return Err(format!("its elements cannot have {stride} bytes"));
        }
        if count.checked_mul(stride) != Some(unpacked) {
            return Err(format!("its {count} elements of {stride} bytes do not take {unpacked} bytes"));
        }
        let (start, length) = (extension.index("byteOffset")?.unwrap_or(0) as u64, needed("byteLength")? as u64);
        Ok(Self { buffer: needed("buffer")?, start, length, count, stride, mode })
    }

    /// Decodes the view's bytes. `view` has bounded their number.
    ///
    /// # Errors
    /// The fault of a stream that is damaged.
    pub(super) fn unpack(&self, stream: &[u8]) -> Result<Vec<u8>, &'static str> {
        // Bounded by a buffer's greatest length.
        let (count, stride) = (self.count as usize, self.stride as usize);
        match self.mode {
            Mode::Attributes(filter) => {
                let mut elements = attributes::decode(stream, count, stride)?;
                filter.undo(&mut elements, stride);
                Ok(elements)
            }
            Mode::Triangles => indices::triangles(stream, count, stride),
            Mode::Indices => indices::sequence(stream, count, stride),
        }
    }
}

#[cfg(test)]
mod tests;
