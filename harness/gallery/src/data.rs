//! What pages load on demand: values in scripts that hand them over, which a browser takes from a file too.

use base64::Engine as _;
use flate2::{Compression, write::GzEncoder};
use serde::Serialize;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

/// Why a value was not written.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot be written: {source}", path.display())]
pub struct DataError {
    path: PathBuf,
    source: io::Error,
}

/// Writes `data/NAME.js` of a site's folder, which hands a value to the page that asks for NAME; returns its bytes.
///
/// # Errors
/// Returns an error if the value is no JSON or the file cannot be written.
pub fn deliver(site: &Path, name: &str, value: &impl Serialize) -> Result<usize, DataError> {
    let path = site.join("data").join([name, ".js"].concat());
    let write = || -> io::Result<usize> {
        let (name, value) = (serde_json::to_string(name)?, serde_json::to_string(value)?);
        let script = ["gallery.deliver(", &name, ", ", &value, ");\n"].concat();
        fs::create_dir_all(path.parent().unwrap_or(site))?;
        fs::write(&path, &script)?;
        Ok(script.len())
    };
    write().map_err(|source| DataError { path: path.clone(), source })
}

/// Returns bytes as gzip in base64, as `gallery.bytes` unpacks them.
pub fn packed(bytes: &[u8]) -> String {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    let squeezed = written.unwrap_or_else(|error| unreachable!("a vector takes all bytes: {error}"));
    base64::engine::general_purpose::STANDARD.encode(squeezed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_handed_over_under_its_name() {
        let site = tempfile::tempdir().expect("temporary folder");
        let bytes = deliver(site.path(), "source/a", &"fn \"f\"").expect("written");
        let script = fs::read_to_string(site.path().join("data/source/a.js")).expect("readable");
        assert_eq!((script.as_str(), script.len()), ("gallery.deliver(\"source/a\", \"fn \\\"f\\\"\");\n", bytes));
    }

    #[test]
    fn a_folder_that_is_a_file_is_named() {
        let site = tempfile::tempdir().expect("temporary folder");
        fs::write(site.path().join("data"), "").expect("writable");
        let error = deliver(site.path(), "a", &1).expect_err("no folder").to_string();
        assert!(error.contains("data") && error.contains("cannot be written"), "{error}");
    }
}
