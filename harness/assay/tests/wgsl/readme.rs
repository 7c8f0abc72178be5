//! The tutorial's code comes from the example project.

use std::path::Path;

#[test]
fn every_block_of_code_is_the_examples() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |path: &str| std::fs::read_to_string(root.join(path)).unwrap_or_else(|error| panic!("{path}: {error}"));
    let page = read("README.md");
    let mut blocks = 0;
    for (language, files) in [
        ("rust", &["example/tests/noise.rs", "example/src/lib.rs"][..]),
        ("wgsl", &["example/src/noise.wgsl"]),
        ("toml", &["example/Cargo.toml"]),
    ] {
        let texts: Vec<String> = files.iter().map(|path| read(path)).collect();
        for block in page.split(&format!("```{language}\n")).skip(1) {
            let code = block.split("```").next().unwrap_or_default();
            assert!(texts.iter().any(|text| text.contains(code)), "not in {files:?}:\n{code}");
            blocks += 1;
        }
    }
    assert!(blocks >= 7, "{blocks}");
}
