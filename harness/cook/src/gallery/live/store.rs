//! Files of the live pages' data: each content once, by its hash.

use super::LiveError;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::{Compression, write::GzEncoder};
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// The folder `data/live` of a site.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    /// The size of each file that was written, by its name.
    files: BTreeMap<String, u64>,
}

impl Store {
    /// Makes the folder in a site's folder.
    pub fn new(site: &Path) -> Result<Self, LiveError> {
        let folder = site.join("data/live");
        std::fs::create_dir_all(&folder).map_err(|error| LiveError::File { path: folder.clone(), error })?;
        Ok(Self { folder, files: BTreeMap::new() })
    }

    /// Stores bytes, squeezed, under their hash, unless they are there already; returns the hash.
    pub fn put(&mut self, bytes: &[u8]) -> Result<String, LiveError> {
        let name = format!("{:016x}", hash(bytes));
        if !self.files.contains_key(&name) {
            let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
            let squeezed = encoder.write_all(bytes).and_then(|()| encoder.finish());
            let squeezed = squeezed.map_err(|error| LiveError::File { path: self.folder.join(&name), error })?;
            self.deliver(&name, &STANDARD.encode(squeezed))?;
        }
        Ok(name)
    }

    /// Writes a script that hands a value to the page.
    pub fn deliver(&mut self, name: &str, value: &impl Serialize) -> Result<(), LiveError> {
        let path = self.folder.join(format!("{name}.js"));
        let name_of = serde_json::to_string(&format!("live/{name}"))?;
        let text = ["gallery.deliver(", &name_of, ", ", &serde_json::to_string(value)?, ");\n"].concat();
        std::fs::write(&path, &text).map_err(|error| LiveError::File { path, error })?;
        self.files.insert(name.to_owned(), text.len() as u64);
        Ok(())
    }

    /// The bytes of all files.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.files.values().sum()
    }
}

/// 64 bits of FNV-1a: names of a few hundred files, which no one means to collide.
fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}
