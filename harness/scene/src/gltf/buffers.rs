//! Contents of a file's buffers: the binary chunk, base64 in the JSON, or external files.

use std::borrow::Cow;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use ::gltf::json::{Buffer, Root};
use base64::Engine;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::MAX_FILE_BYTES;
use super::error::{GltfError, excerpt};

/// Contents of all buffers, each exactly as long as the file states.
#[derive(Debug)]
pub(super) struct Buffers<'a> {
    buffers: Vec<Cow<'a, [u8]>>,
}

/// Some writers pad base64 and some do not; both forms are unambiguous.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

impl<'a> Buffers<'a> {
    pub(super) fn load(root: &Root, binary: Option<&'a [u8]>, base: Option<&Path>) -> Result<Self, GltfError> {
        let mut all = Self { buffers: Vec::with_capacity(root.buffers.len()) };
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

    pub(super) fn list(&self) -> &[Cow<'a, [u8]>] {
        &self.buffers
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
        (Some(uri), _) => Cow::Owned(match uri.strip_prefix("data:") {
            Some(data) => decode(data).map_err(wrong)?,
            None => {
                let file = resolve(uri, base).map_err(wrong)?;
                inside(&file, base).map_err(wrong)?;
                read_named(&file, &format!("buffer {index}"), length as u64)?
            }
        }),
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

/// Decodes a `data:` URI, given the part after its scheme.
fn decode(data: &str) -> Result<Vec<u8>, String> {
    let (kind, text) = data.split_once(',').ok_or("its data: URI has no comma; export it again")?;
    if !kind.ends_with(";base64") {
        return Err("its data: URI is not base64; export it as base64".to_owned());
    }
    let decoded = BASE64.decode(text);
    decoded.map_err(|error| format!("its base64 is damaged: {error}; export it again"))
}

/// Path of the file that a relative URI refers to.
fn resolve(uri: &str, base: Option<&Path>) -> Result<PathBuf, String> {
    let shown = excerpt(uri);
    let name = percent_decoded(uri).ok_or_else(|| format!("its uri {shown:?} is not valid; rename the file"))?;
    let scheme = name.split_once(':').map_or("", |(scheme, _)| scheme);
    let absolute = name.starts_with(['/', '\\']) || Path::new(&name).is_absolute();
    // A colon in a later path segment is part of a file name.
    if absolute || (!scheme.is_empty() && !scheme.contains('/')) {
        return Err(format!("its uri {shown:?} is not a relative path; put the file beside the .gltf"));
    }
    if name.split(['/', '\\']).any(|part| part == "..") {
        return Err(format!("its uri {shown:?} leads out of the file's folder; put the file beside the .gltf"));
    }
    let base = base
        .ok_or_else(|| format!("its uri {shown:?} names a file, but the data did not come from a file; use a .glb"))?;
    Ok(base.join(name))
}

/// Checks that a file, if it exists, lies in the folder, with symbolic links resolved.
fn inside(file: &Path, base: Option<&Path>) -> Result<(), String> {
    // The parent of a bare file name is empty.
    let base = base.filter(|base| !base.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match (file.canonicalize(), base.canonicalize()) {
        (Ok(file), Ok(base)) if !file.starts_with(&base) => {
            let shown = excerpt(&file.display().to_string());
            Err(format!("its uri leads by a link to {shown:?}, out of the file's folder; put the file itself there"))
        }
        // A missing file is reported when it is opened.
        _ => Ok(()),
    }
}

fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let digit = |byte: Option<u8>| char::from(byte?).to_digit(16);
                let value = 16 * digit(rest.next())? + digit(rest.next())?;
                value as u8
            }
            _ => byte,
        });
    }
    String::from_utf8(bytes).ok().filter(|name| !name.contains('\0'))
}

/// Reads all bytes of the glTF file at `path`.
pub(super) fn read_file(path: &Path, limit: u64) -> Result<Vec<u8>, GltfError> {
    let too_large = |bytes| GltfError::TooLarge { what: "the file".to_owned(), bytes, limit };
    let bytes = read_up_to(path, "the file".to_owned(), limit.saturating_add(1))?;
    let length = bytes.len() as u64;
    if length > limit { Err(too_large(length)) } else { Ok(bytes) }
}

/// Reads at most `length` bytes of a buffer's file.
fn read_named(path: &Path, buffer: &str, length: u64) -> Result<Vec<u8>, GltfError> {
    let what = format!("{buffer}'s file {:?}", path.display().to_string());
    read_up_to(path, what, length)
}

/// Refuses devices and pipes, which may never end.
fn read_up_to(path: &Path, what: String, limit: u64) -> Result<Vec<u8>, GltfError> {
    let unreadable = |reason: String| GltfError::Unreadable { what: what.clone(), reason };
    // Checked before the file is opened, because opening a pipe waits for the other end.
    let metadata = std::fs::metadata(path).map_err(|error| unreadable(error.to_string()))?;
    if !metadata.is_file() {
        return Err(unreadable(crate::not_a_file(&metadata).to_owned()));
    }
    let file = File::open(path).map_err(|error| unreadable(error.to_string()))?;
    let mut bytes = Vec::new();
    match file.take(limit).read_to_end(&mut bytes) {
        Ok(_) => Ok(bytes),
        Err(error) => Err(unreadable(error.to_string())),
    }
}
