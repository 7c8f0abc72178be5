//! Files of the live pages' data: each content once, by its hash.

use super::super::data::{self, DataError};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The folder `data/live` of a site.
#[derive(Debug)]
pub struct Store {
    site: PathBuf,
    /// The bytes of each file that was written, by its name.
    files: BTreeMap<String, usize>,
}

impl Store {
    /// The store of a site's folder.
    pub fn new(site: &Path) -> Self {
        Self { site: site.to_owned(), files: BTreeMap::new() }
    }

    /// Stores bytes under their hash, unless they are there already; returns the hash.
    pub fn put(&mut self, bytes: &[u8]) -> Result<String, DataError> {
        let name = format!("{:016x}", hash(bytes));
        if !self.files.contains_key(&name) {
            self.deliver(&name, &data::packed(bytes))?;
        }
        Ok(name)
    }

    /// Writes a value for the page that asks for `live/NAME`.
    pub fn deliver(&mut self, name: &str, value: &impl Serialize) -> Result<(), DataError> {
        let bytes = data::deliver(&self.site, &["live/", name].concat(), value)?;
        self.files.insert(name.to_owned(), bytes);
        Ok(())
    }

    /// The bytes of all files.
    #[cfg(test)]
    pub fn bytes(&self) -> usize {
        self.files.values().sum()
    }
}

/// 64 bits of FNV-1a: names of a few hundred files, which no one means to collide.
fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}
