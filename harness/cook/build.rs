//! Lists the folder of techniques: a module's formulas are tested once its crate is there.

use std::fmt::Write as _;
use std::path::PathBuf;

fn main() -> std::io::Result<()> {
    let root = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets it"));
    let crates = root.join("../../crates");
    let mut names = Vec::new();
    for entry in std::fs::read_dir(&crates)? {
        let path = entry?.path();
        if path.join("src/formulas.rs").is_file() {
            names.extend(path.file_name().and_then(|name| name.to_str()).map(str::to_owned));
        }
    }
    names.sort();
    let mut text = String::from("/// Every module's formulas.\nfn of_modules() -> Vec<Vec<Formula>> {\n    vec![\n");
    for name in names {
        let _ = writeln!(text, "        lapidary_{name}::formulas::formulas(),");
    }
    text.push_str("    ]\n}\n");
    println!("cargo:rerun-if-changed={}", crates.display());
    std::fs::write(out.join("modules.rs"), text)
}
