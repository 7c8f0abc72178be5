//! The examples for engines: what can be held without npm, a browser or another target folder. `.ci/full` runs
//! them.

use lapidary_testing::generated;
use lapidary_testing::program::succeeds;
use std::path::{Path, PathBuf};

fn engines() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/engines")
}

/// The page has shaders in it, as `cook copy` prints them.
#[test]
fn the_shaders_in_the_page_are_those_of_copy() {
    let page = std::fs::read_to_string(engines().join("webgpu/gem.html")).expect("the page");
    let mut filled = String::new();
    let mut rest = page.as_str();
    let mut count = 0;
    while let Some((before, marked)) = rest.split_once("<!-- generated: cook ") {
        let (command, marked) = marked.split_once(" -->\n").expect("a mark");
        let (_, after) = marked.split_once("<!-- end -->").expect("an end");
        let words: Vec<&str> = command.split(' ').collect();
        let text = succeeds(Path::new("."), &words).stdout;
        let id = words[1];
        filled.push_str(&format!(
            "{before}<!-- generated: cook {command} -->\n<script type=\"text/wgsl\" id=\"{id}\">\n{text}</script>\n<!-- end -->"
        ));
        (rest, count) = (after, count + 1);
    }
    filled.push_str(rest);
    assert_eq!(count, 2, "the recipe and the display");
    generated::keep("docs/engines/webgpu/gem.html", &filled);
}

/// Each example has what its readers look for.
#[test]
fn every_example_has_a_page_a_picture_and_one_command() {
    let index = std::fs::read_to_string(engines().join("README.md")).expect("the index");
    let mut count = 0;
    for entry in std::fs::read_dir(engines()).expect("a folder") {
        let folder = entry.expect("an entry").path();
        if !folder.is_dir() {
            continue;
        }
        let name = folder.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        let page = std::fs::read_to_string(folder.join("README.md")).expect("a page");
        assert!(page.contains(&format!("docs/engines/{name}/run")), "{name}: its page names no command");
        assert!(folder.join("run").is_file(), "{name}: no run");
        assert!(index.contains(&format!("{name}/README.md")), "{name} is not in the index");
        // The comparison with drei has tables.
        if name != "drei" {
            let shown = page.lines().any(|line| line.contains(".png)"));
            assert!(shown, "{name}: its page shows no picture");
        }
        count += 1;
    }
    assert_eq!(count, 5);
}
