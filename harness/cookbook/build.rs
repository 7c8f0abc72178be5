//! Lists the folder of techniques: a module's page is shown once its WGSL is there.

use std::fmt::Write as _;
use std::path::PathBuf;

fn main() -> std::io::Result<()> {
    let root = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets it"));
    let (docs, modules) = (root.join("../../docs"), root.join("../../wgsl"));
    let mut pages = String::from(
        "/// Returns a module's page in Markdown.\nfn page(name: &str) -> &'static str {\n    match name {\n",
    );
    for entry in std::fs::read_dir(&modules)? {
        let path = entry?.path();
        let Some(name) = path.file_stem().and_then(|name| name.to_str()) else { continue };
        if path.extension().is_some_and(|extension| extension == "wgsl") {
            let page = docs.join(format!("{name}.md"));
            let _ = writeln!(pages, "        {name:?} => include_str!({:?}),", page.display().to_string());
        }
    }
    pages.push_str("        _ => \"\",\n    }\n}\n");
    println!("cargo:rerun-if-changed={}", modules.display());
    std::fs::write(out.join("pages.rs"), pages)
}
