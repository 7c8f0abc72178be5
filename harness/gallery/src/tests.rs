use super::live::SCENES;
use super::*;
use lapidary_cookbook as cookbook;
use lapidary_cookbook::repository;
use std::collections::BTreeSet;

/// A PNG of one pixel.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\0\0\0\0\x3a\x7e\x9b\x55\0\0\0\nIDATx\x9cc`\0\0\0\x02\0\x01\x48\xaf\xa4\x71\0\0\0\0IEND\xaeB`\x82";

fn source(folder: &Path, name: &str) -> Source {
    let file = folder.join([name, ".source.png"].concat());
    fs::write(&file, PNG).expect("writable");
    Source {
        name: name.to_owned(),
        folder: "gem".to_owned(),
        title: ["Step <", name, ">"].concat(),
        caption: "What <b>it</b> shows, by `refraction_refract`.".to_owned(),
        command: "./cook render \"brilliant\" && true".to_owned(),
        rung: "walk-8".to_owned(),
        samples: "16 samples a pixel".to_owned(),
        file,
        source: None,
    }
}

/// A gallery without a device: without ladders' pictures, live pages and property rows' pages.
fn pages_of(pictures: &[Source], folder: &Path) -> Result<Vec<(Page, String)>, GalleryError> {
    let shown = pictures::place(pictures, "llvmpipe <LLVM 15>", folder)?;
    let root = repository::place();
    let parts = Parts {
        adapter: "llvmpipe <LLVM 15>",
        places: Places::new(&shown),
        pictures: shown,
        docs: docs(&root)?,
        mirrors: mirrors(&root)?,
        takes: choices::all().iter().map(take::take).collect::<Result<_, _>>()?,
        diagrams: diagrams(&root)?,
        ladders: BTreeMap::new(),
        editors: BTreeMap::new(),
        live: Vec::new(),
        rustdoc: false,
    };
    let pages = pages::all(&parts);
    let html = (0..pages.len()).map(|index| pages::html(&parts, &pages, index)).collect::<Vec<_>>();
    Ok(pages.into_iter().zip(html).collect())
}

/// Returns the values of an attribute.
fn values<'a>(html: &'a str, mark: &'static str) -> impl Iterator<Item = &'a str> {
    html.split(mark).skip(1).filter_map(|rest| rest.split('"').next())
}

#[test]
fn every_link_leads_to_a_page_and_an_anchor_that_are_there() {
    let around = tempfile::tempdir().expect("temporary folder");
    let pages = pages_of(&[source(around.path(), "brilliant_exact")], around.path()).expect("made");
    let anchors: BTreeMap<&str, BTreeSet<&str>> =
        pages.iter().map(|(page, html)| (page.path.as_str(), values(html, " id=\"").collect())).collect();
    for (page, html) in &pages {
        let ids: Vec<&str> = values(html, " id=\"").collect();
        assert_eq!(ids.len(), anchors[page.path.as_str()].len(), "{}: an id is there twice: {ids:?}", page.path);
        for link in values(html, " href=\"").filter(|link| !link.starts_with("http")) {
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let folder = page.path.rsplit_once('/').map_or("", |(folder, _)| folder);
            let target = match file.strip_prefix("../") {
                _ if file.is_empty() => page.path.clone(),
                Some(rest) => rest.to_owned(),
                None if folder.is_empty() => file.to_owned(),
                None => [folder, "/", file].concat(),
            };
            if !target.ends_with(".html") {
                assert!(target.starts_with("assets/") || target.starts_with("images/"), "{}: {link}", page.path);
                continue;
            }
            // The suite looks at those of a whole site, whose scenes take a device to draw.
            if let Some(name) = target.strip_prefix("live/") {
                assert!(
                    SCENES.iter().any(|live| name.strip_suffix(".html") == Some(live.scene)),
                    "{}: {link}",
                    page.path
                );
                continue;
            }
            let there = anchors.get(target.as_str()).unwrap_or_else(|| panic!("{}: no page {link}", page.path));
            let of_picture = anchor.starts_with("picture=") || anchor.starts_with("ladder-");
            assert!(anchor.is_empty() || of_picture || there.contains(anchor), "{}: no anchor {link}", page.path);
        }
    }
}

#[test]
fn every_module_recipe_and_guide_has_a_page_with_its_text() {
    let around = tempfile::tempdir().expect("temporary folder");
    let pages = pages_of(&[source(around.path(), "cut")], around.path()).expect("made");
    let html = |path: &str| &pages.iter().find(|(page, _)| page.path == path).expect(path).1;
    for module in cookbook::modules() {
        let html = html(&["modules/", module.name, ".html"].concat());
        for function in &module.functions {
            assert!(html.contains(&format!("id=\"{}\"", function.name)), "{}", function.name);
        }
        assert!(html.contains(&format!("data-source=\"source/{}\"", module.name)), "{}", module.name);
    }
    for recipe in lapidary_wgsl::RECIPES {
        assert!(html(&["recipes/", recipe.name, ".html"].concat()).contains(&["source/recipe_", recipe.name].concat()));
    }
    let pictures = html("pictures.html");
    for part in [
        "Step &lt;cut&gt;",
        "llvmpipe &lt;LLVM 15&gt;",
        "What &lt;b&gt;it&lt;/b&gt; shows, by <code>",
        "&amp;&amp; true",
    ] {
        assert!(pictures.contains(part), "{part}");
    }
}

#[test]
fn a_page_is_small_and_fetches_nothing_from_elsewhere() {
    let around = tempfile::tempdir().expect("temporary folder");
    for (page, html) in pages_of(&[], around.path()).expect("made") {
        assert!(html.len() < 500_000, "{}: {} bytes", page.path, html.len());
        for fetched in ["src=\"http", "@import", "rel=\"stylesheet\" href=\"http", "fetch("] {
            assert!(!html.contains(fetched), "{}: {fetched}", page.path);
        }
    }
    for (name, bytes) in ASSETS.iter().filter(|(name, _)| name.ends_with(".css")) {
        let text = String::from_utf8_lossy(bytes);
        assert!(!text.contains("url(\"http") && !text.contains("@import"), "{name}");
    }
}

#[test]
fn the_same_site_gives_the_same_bytes() {
    let around = tempfile::tempdir().expect("temporary folder");
    let pictures = [source(around.path(), "prism")];
    let bytes =
        || pages_of(&pictures, around.path()).expect("made").into_iter().map(|(_, html)| html).collect::<Vec<_>>();
    assert_eq!(bytes(), bytes());
}

#[test]
fn a_missing_picture_is_named_and_leaves_nothing() {
    let around = tempfile::tempdir().expect("temporary folder");
    let mut lost = source(around.path(), "octahedron");
    fs::remove_file(&lost.file).expect("there");
    lost.file = around.path().join("lost.png");
    let root = repository::place();
    let site = Site { root: &root, adapter: String::new(), pictures: vec![lost], rustdoc: None, device: None };
    let error = write(&around.path().join("out"), &site).expect_err("no such file").to_string();
    assert!(error.contains("octahedron") && error.contains("lost.png") && error.contains("./cook render"), "{error}");
    assert_eq!(fs::read_dir(around.path()).expect("readable").count(), 0, "nothing is left");
}

#[test]
fn a_folder_of_something_else_is_refused() {
    let around = tempfile::tempdir().expect("temporary folder");
    fs::write(around.path().join("thesis.tex"), "years").expect("writable");
    let root = repository::place();
    let site = Site { root: &root, adapter: String::new(), pictures: Vec::new(), rustdoc: None, device: None };
    let error = write(around.path(), &site).expect_err("foreign").to_string();
    assert!(error.contains("thesis.tex") && error.contains("--out"), "{error}");
    assert_eq!(fs::read_to_string(around.path().join("thesis.tex")).expect("kept"), "years");
}

#[test]
fn an_adapter_is_named_once() {
    let long = "llvmpipe (LLVM 15.0.6, 256 bits) (llvmpipe Mesa 22.3.6 (LLVM 15.0.6), Vulkan)";
    assert_eq!(short(long), "llvmpipe Mesa 22.3.6 (LLVM 15.0.6), Vulkan");
    for whole in ["NVIDIA H200 (NVIDIA 580.159.04, Vulkan)", "Apple M1", "Apple M1 (Metal)"] {
        assert_eq!(short(whole), whole);
    }
}
