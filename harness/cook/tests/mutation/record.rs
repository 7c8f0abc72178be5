//! Record of the last whole run: for each module, a hash of everything that its score depends on.
//! If the hash is the same, the score is the same.

use lapidary_gpu::Gpu;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Dependencies of every score in addition to a module's own: the engine, this program, and the
/// versions of everything.
const ENGINE: [&str; 12] = [
    "Cargo.lock",
    "Cargo.toml",
    "harness/assay/Cargo.toml",
    "harness/assay/src",
    "harness/cook/src/check.rs",
    "harness/cookbook/src",
    "harness/cook/tests/mutation/main.rs",
    "harness/cook/tests/mutation/record.rs",
    "harness/gpu/Cargo.toml",
    "harness/gpu/src",
    "harness/specialise/Cargo.toml",
    "harness/specialise/src",
];

/// Record of a whole run.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Record {
    /// Device of the run.
    pub(crate) adapter: String,
    /// Hash of the engine's sources.
    pub(crate) engine: String,
    /// Modules by name.
    pub(crate) modules: BTreeMap<String, Module>,
}

/// Record of a module in a whole run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Module {
    /// Hash of its WGSL, its crate, the crates of its formulas, and its listed mutants.
    pub(crate) hash: String,
    /// Number of its mutants.
    pub(crate) mutants: usize,
    /// Number of its mutants that are listed as equivalent.
    pub(crate) listed: usize,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn file() -> PathBuf {
    root().join("docs/measurements/lavapipe/mutation.json")
}

impl Record {
    /// Returns the committed record, or an empty one if there is no file.
    pub(crate) fn committed() -> Self {
        let Ok(text) = std::fs::read_to_string(file()) else { return Self::default() };
        serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", file().display()))
    }

    /// Returns the record of a whole run on the current sources, without the counts. `listed` holds
    /// the lines of each module's equivalent mutants.
    pub(crate) fn of_sources(gpu: &Gpu, modules: &[&str], listed: &BTreeMap<&str, String>) -> Self {
        let engine = hash(&ENGINE.map(|path| root().join(path)));
        let module = |name: &&str| {
            let crates = crates_of(name);
            let mut texts = vec![root().join(format!("wgsl/{name}.wgsl"))];
            let of_crate =
                |name: &String| ["Cargo.toml", "src"].map(|part| root().join("crates").join(name).join(part));
            texts.extend(crates.iter().flat_map(of_crate));
            let hash = text_hash(&(hash(&texts) + listed.get(name).map_or("", String::as_str)));
            ((*name).to_owned(), Module { hash, mutants: 0, listed: 0 })
        };
        Self { adapter: gpu.describe(), engine, modules: modules.iter().map(module).collect() }
    }

    /// Returns whether the engine and the device are the same as in `other`.
    pub(crate) fn is_of_the_engine_of(&self, other: &Self) -> bool {
        self.adapter == other.adapter && self.engine == other.engine
    }

    /// Returns whether a module's own part is the same as in `other`.
    pub(crate) fn agrees(&self, other: &Self, module: &str) -> bool {
        let hash = |record: &Self| record.modules.get(module).map(|module| module.hash.clone());
        hash(self).is_some() && hash(self) == hash(other)
    }

    pub(crate) fn write(&self) {
        let text = serde_json::to_string_pretty(self).expect("plain data") + "\n";
        let beside = file().with_extension("new");
        let written = std::fs::write(&beside, text).and_then(|()| std::fs::rename(&beside, file()));
        written.unwrap_or_else(|error| panic!("{}: {error}", file().display()));
        println!("recorded in {}", file().display());
    }
}

/// Returns the module's crate and the crates that its formulas need.
fn crates_of(module: &str) -> Vec<String> {
    let manifest = root().join("crates").join(module).join("Cargo.toml");
    let text = std::fs::read_to_string(&manifest).unwrap_or_else(|error| panic!("{}: {error}", manifest.display()));
    let is_crate = |name: &&str| root().join("crates").join(name).is_dir();
    let needed = text.lines().filter_map(|line| line.strip_prefix("lapidary-")?.split([' ', '.']).next());
    let mut crates: Vec<String> = needed.filter(is_crate).chain([module]).map(str::to_owned).collect();
    crates.sort();
    crates.dedup();
    crates
}

/// Hash of a text (FNV-1a, 64 bits); line endings are ignored.
fn text_hash(text: &str) -> String {
    let bytes = text.lines().flat_map(|line| line.bytes().chain([0]));
    let hash =
        bytes.fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    format!("{hash:016x}")
}

/// Returns one hash of all files below these paths, with their names.
fn hash(paths: &[PathBuf]) -> String {
    let mut text = String::new();
    paths.iter().for_each(|path| collect(path, &mut text));
    text_hash(&text)
}

fn collect(path: &Path, text: &mut String) {
    if path.is_dir() {
        let entries = std::fs::read_dir(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut entries: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
        entries.sort();
        entries.iter().for_each(|entry| collect(entry, text));
        return;
    }
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    text.push_str(&name);
    text.push('\n');
    text.push_str(&std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())));
}
