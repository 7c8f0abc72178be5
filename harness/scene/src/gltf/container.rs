//! The two containers of glTF: plain JSON, and .glb with its chunks.

use super::error::GltfError;

/// Parts of a file.
#[derive(Debug)]
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    /// Binary chunk; `None` for a .gltf or a .glb without one.
    pub(super) binary: Option<&'a [u8]>,
}

/// Splits a .glb into its chunks; a .gltf is JSON as a whole.
///
/// Implemented here because the gltf crate subtracts the header's size from the stated length
/// before it compares them, which overflows for lengths below 12.
pub(super) fn split(bytes: &[u8]) -> Result<Container<'_>, GltfError> {
    if !bytes.starts_with(b"glTF") {
        // Byte-order mark, which editors on Windows put before UTF-8.
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let first = bytes.iter().find(|byte| !byte.is_ascii_whitespace());
        return match first {
            Some(b'{') => Ok(Container { json: bytes, binary: None }),
            _ => Err(GltfError::NotGltf),
        };
    }
    let version = word(bytes, 4, "its header")?;
    if version != 2 {
        return Err(GltfError::Version { version: version.to_string() });
    }
    let stated = word(bytes, 8, "its header")? as usize;
    let bytes =
        bytes.get(..stated).ok_or_else(|| damaged(format!("it states {stated} bytes but has {}", bytes.len())))?;
    let (kind, json, rest) = chunk(bytes, 12)?;
    if kind != b"JSON" {
        return Err(damaged("its first chunk is not JSON".to_owned()));
    }
    if rest == bytes.len() {
        return Ok(Container { json, binary: None });
    }
    // If the first chunk after the JSON is of an unknown kind, the specification says to skip it.
    // The file then has no binary chunk, since that must come second.
    let (kind, data, _) = chunk(bytes, rest)?;
    let binary = (kind == b"BIN\0").then_some(data);
    Ok(Container { json, binary })
}

/// Returns the kind and the data of the chunk at `offset`, and the start of the next one.
fn chunk(bytes: &[u8], offset: usize) -> Result<(&[u8], &[u8], usize), GltfError> {
    let length = word(bytes, offset, "a chunk")? as usize;
    let start = offset + 8;
    let kind = bytes.get(offset + 4..start);
    let end = start.checked_add(length);
    let data = end.and_then(|end| bytes.get(start..end));
    match (kind, data) {
        (Some(kind), Some(data)) => Ok((kind, data, start + length)),
        _ => Err(damaged(format!("the chunk at byte {offset} states {length} bytes but the file ends before"))),
    }
}

fn word(bytes: &[u8], offset: usize, part: &str) -> Result<u32, GltfError> {
    let word = bytes.get(offset..).and_then(|tail| tail.first_chunk());
    let word = word.ok_or_else(|| damaged(format!("it ends at byte {} inside {part}", bytes.len())))?;
    Ok(u32::from_le_bytes(*word))
}

fn damaged(problem: String) -> GltfError {
    GltfError::Container { problem }
}
