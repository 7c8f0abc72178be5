//! The files that a scene is read from.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::limits::MAX_FILE_BYTES;
use super::{container, uri};

/// What may name files.
#[derive(Deserialize)]
struct Parts<'a> {
    #[serde(borrow, default)]
    buffers: Vec<Part<'a>>,
    #[serde(borrow, default)]
    images: Vec<Part<'a>>,
}

#[derive(Deserialize)]
struct Part<'a> {
    #[serde(borrow)]
    uri: Option<Cow<'a, str>>,
}

/// Returns the paths of a glTF file and of all files that its buffers and images name, whether they are drawn or not,
/// and whether they are there or not. What cannot be read is for [`load`](super::load) to tell.
pub(crate) fn sources(path: &Path) -> Vec<PathBuf> {
    let mut all = vec![path.to_owned()];
    let base = path.parent().unwrap_or(Path::new(""));
    let Ok(bytes) = uri::read_file(path, MAX_FILE_BYTES) else { return all };
    let Ok(container) = container::split(&bytes) else { return all };
    let Ok(Parts { buffers, images }) = serde_json::from_slice(container.json) else { return all };
    let named = buffers.iter().chain(&images).filter_map(|part| part.uri.as_deref());
    all.extend(named.filter_map(|uri| uri::file(uri, base)));
    all
}
