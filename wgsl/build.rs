//! Lists the folder: a module, recipe or part exists as soon as its file does.

use std::fmt::Write;
use std::path::{Path, PathBuf};

fn main() -> std::io::Result<()> {
    let root = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets it"));
    let mut text = String::new();
    let more = |name: &str| {
        let [own, naive] = ["", "naive/"].map(|folder| root.join(format!("{folder}{name}.wgsl")));
        let (naive, whole) = match naive.is_file() {
            true => (include(&naive), format!("concat!({}, \"\\n\", {})", include(&own), include(&naive))),
            false => ("\"\"".to_owned(), include(&own)),
        };
        format!(", naive: {naive}, whole: {whole}")
    };
    for file in files(&root, "wgsl")? {
        let name = stem(&file);
        let _ = writeln!(
            text,
            "/// WGSL of the module `{name}`.\npub const {}: &str = {};",
            name.to_uppercase(),
            include(&file)
        );
    }
    list(&mut text, "Every module", "MODULES", "Module", &files(&root, "wgsl")?, more);
    list(&mut text, "Every recipe", "RECIPES", "Recipe", &files(&root.join("recipes"), "wgsl")?, |_| String::new());
    list(&mut text, "Every part", "PARTS", "Part", &files(&root.join("recipes/parts"), "wgsl")?, |_| String::new());
    for folder in ["", "naive", "recipes", "recipes/parts"] {
        println!("cargo:rerun-if-changed={}", root.join(folder).display());
    }
    std::fs::write(out.join("folder.rs"), text)
}

/// Returns the files of a folder with this extension, sorted by name.
fn files(folder: &Path, extension: &str) -> std::io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|ends| ends == extension) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

fn stem(file: &Path) -> &str {
    file.file_stem().and_then(|name| name.to_str()).expect("a name of letters")
}

/// Returns Rust code for the text of the file.
fn include(file: &Path) -> String {
    format!("include_str!({:?})", file.display().to_string())
}

fn list(text: &mut String, what: &str, constant: &str, kind: &str, files: &[PathBuf], more: impl Fn(&str) -> String) {
    let _ = writeln!(text, "/// {what}, in the order of their names.\npub const {constant}: &[{kind}] = &[");
    for file in files {
        let name = stem(file);
        let _ = writeln!(text, "    {kind} {{ name: {name:?}, source: {}{} }},", include(file), more(name));
    }
    let _ = writeln!(text, "];");
}
