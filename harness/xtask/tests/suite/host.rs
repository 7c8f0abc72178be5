//! The pages for hosts: generated from the recipes and from frames, whose sizes their formulas give.

use lapidary_cookbook::marks;
use lapidary_cookbook::repository;
use lapidary_testing::generated;
use lapidary_xtask::host;
use std::collections::BTreeSet;
use std::sync::LazyLock;

/// Returns the pages, made once for all tests.
fn pages() -> &'static [(String, String)] {
    static PAGES: LazyLock<Vec<(String, String)>> =
        LazyLock::new(|| host::pages().unwrap_or_else(|error| panic!("{error}")));
    &PAGES
}

/// `./cook test --refresh` rewrites them.
#[test]
fn the_pages_are_those_of_the_recipes_and_frames() {
    for (name, text) in pages() {
        generated::keep(&format!("docs/recipes/{name}"), text);
    }
    let names: BTreeSet<&str> = pages().iter().map(|(name, _)| name.as_str()).collect();
    for entry in std::fs::read_dir(repository::place().join("docs/recipes")).expect("a folder") {
        let name = entry.expect("an entry").file_name();
        assert!(
            name.to_str().is_some_and(|name| names.contains(name)),
            "docs/recipes/{}: of no recipe",
            name.display()
        );
    }
}

/// A page that left out a binding or an override would pass unnoticed.
#[test]
fn every_binding_and_override_stands_on_its_page() {
    for recipe in lapidary_wgsl::RECIPES {
        let (_, page) = pages().iter().find(|(name, _)| *name == format!("{}.md", recipe.name)).expect("a page");
        // Without what none of its entry points reaches.
        let source = marks::without(recipe, &[]).unwrap_or_else(|fault| panic!("{}", fault.message));
        for line in source.lines() {
            let code = line.split("//").next().unwrap_or_default();
            if let Some((_, rest)) = code.split_once("@binding(") {
                let name = rest.split(':').next().and_then(|rest| rest.rsplit(' ').next()).expect("a name");
                let row = page
                    .lines()
                    .find(|row| row.contains(&format!("| `{name}` |")))
                    .unwrap_or_else(|| panic!("{}: {name}", recipe.name));
                // A size and, but for plain names, a comment.
                assert!(!row.contains("| – |"), "{}: `{name}` has no size: {row}", recipe.name);
            }
            if let Some(rest) = code.strip_prefix("override ") {
                let name = rest.split(':').next().expect("a name");
                assert!(page.contains(&format!("| `{name}` |")), "{}: {name}", recipe.name);
            }
        }
    }
}

/// The tables that people have written say no other sizes.
#[test]
fn the_written_tables_have_the_recipes_sizes() {
    let docs = repository::place().join("docs");
    let mut count = 0;
    for (page, start) in
        [("gem", "gem"), ("cdrf_shading", "cdrf_shading"), ("optical_path_shading", "optical_path_shading")]
    {
        let text = std::fs::read_to_string(docs.join(format!("{page}.md"))).expect("a page");
        for row in text.lines().filter(|line| line.starts_with("| ")) {
            // `name`, storage, 48 bytes each
            let what = row.split(" | ").nth(1).unwrap_or_default();
            let Some((before, _)) = what.split_once(" bytes") else { continue };
            let Some((rest, bytes)) = before.rsplit_once(", ") else { continue };
            let Ok(bytes) = bytes.parse::<u32>() else { continue };
            let name = rest.split('`').rev().nth(1).expect("a name in backquotes");
            let sizes = pages().iter().filter(|(file, _)| file.starts_with(start)).filter_map(|(_, text)| {
                let row = text.lines().find(|line| line.contains(&format!("| `{name}` | ")))?;
                row.split(" | ").nth(4)?.split(' ').next()?.parse::<u32>().ok()
            });
            let sizes: Vec<u32> = sizes.collect();
            // Of corners the page gives a corner's size, the recipe's a triangle's.
            let has = |size: &u32| *size == bytes || name == "corners" && *size == 3 * bytes;
            assert!(sizes.iter().any(has), "docs/{page}.md: `{name}` of {bytes} bytes, and the recipes have {sizes:?}");
            count += 1;
        }
    }
    assert!(count > 12, "{count} sizes");
}
