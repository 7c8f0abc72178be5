//! Data that a URI refers to: base64 in the URI itself, or a file in the glTF file's folder.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::error::{GltfError, excerpt};

/// Some writers pad base64 and some do not; both forms are unambiguous.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Returns the data of `uri`, which `part` of the file refers to; of a file, at most `most` bytes.
pub(super) fn contents(uri: &str, base: Option<&Path>, part: &str, most: u64) -> Result<Vec<u8>, GltfError> {
    let wrong = |problem: String| GltfError::part(part.to_owned(), problem);
    if let Some(data) = uri.strip_prefix("data:") {
        return decode(data).map_err(wrong);
    }
    let file = resolve(uri, base).map_err(wrong)?;
    inside(&file, base).map_err(wrong)?;
    read_up_to(&file, format!("{part}'s file {:?}", file.display().to_string()), most)
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

/// Path of the file that `uri` refers to; `None` if it holds the data itself, or is no path that is read.
pub(super) fn file(uri: &str, base: &Path) -> Option<PathBuf> {
    if uri.starts_with("data:") { None } else { resolve(uri, Some(base)).ok() }
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

/// Refuses devices and pipes, which may never end.
fn read_up_to(path: &Path, what: String, limit: u64) -> Result<Vec<u8>, GltfError> {
    let unreadable = |reason: String| GltfError::Unreadable { what: what.clone(), reason };
    // Checked before the file is opened, because opening a pipe waits for the other end.
    let metadata = std::fs::metadata(path).map_err(|error| unreadable(error.to_string()))?;
    if !metadata.is_file() {
        return Err(unreadable(lapidary_files::not_a_file(&metadata).to_owned()));
    }
    let file = File::open(path).map_err(|error| unreadable(error.to_string()))?;
    let mut bytes = Vec::new();
    match file.take(limit).read_to_end(&mut bytes) {
        Ok(_) => Ok(bytes),
        Err(error) => Err(unreadable(error.to_string())),
    }
}
