use super::*;

/// A PNG of one pixel.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\0\0\0\0\x3a\x7e\x9b\x55\0\0\0\nIDATx\x9cc`\0\0\0\x02\0\x01\x48\xaf\xa4\x71\0\0\0\0IEND\xaeB`\x82";

fn picture(folder: &Path, title: &str) -> Picture {
    let file = folder.join(format!("{}.source", text::slug(title)));
    fs::write(&file, PNG).expect("writable");
    Picture {
        title: title.to_owned(),
        file,
        paragraph: "What <b>it</b> shows, by `refraction_refract`.".to_owned(),
        command: "./cook render \"brilliant\" && true".to_owned(),
        size: (1, 1),
    }
}

fn site<'a>(pictures: &'a [Picture], figures: &'a [(String, Picture)]) -> Site<'a> {
    Site { adapter: "llvmpipe <LLVM 15>".to_owned(), pictures, figures }
}

#[test]
fn the_gallery_is_one_page_with_its_pictures_and_nothing_from_elsewhere() {
    let around = tempfile::tempdir().expect("temporary folder");
    let pictures =
        [picture(around.path(), "Brilliant"), picture(around.path(), "Step <cut>"), picture(around.path(), "Step cut")];
    let figures = [("fresnel".to_owned(), picture(around.path(), "Error"))];
    let index = write(&around.path().join("out"), &site(&pictures, &figures)).expect("written");
    let html = fs::read_to_string(&index).expect("readable");
    for name in ["brilliant", "step-cut", "step-cut-2", "fresnel-error"] {
        assert!(html.contains(&format!("src=\"images/{name}.png\"")), "{name}");
        let copy = index.with_file_name("images").join(format!("{name}.png"));
        assert_eq!(fs::read(copy).expect("copied"), PNG);
    }
    for part in [
        "Step &lt;cut&gt;",
        "llvmpipe &lt;LLVM 15&gt;",
        "What &lt;b&gt;it&lt;/b&gt; shows, by <code>",
        "&amp;&amp; true",
    ] {
        assert!(html.contains(part), "{part}");
    }
    for module in crate::cookbook::modules() {
        assert!(html.contains(&format!("<section id=\"{}\"", module.name)), "{}", module.name);
        assert!(html.contains(&highlight::wgsl(module.source)), "the WGSL of {}", module.name);
        for function in &module.functions {
            assert!(html.contains(&format!("id=\"{}\"", function.name)), "{}", function.name);
        }
    }
    for recipe in lapidary_wgsl::RECIPES {
        assert!(
            html.contains(&highlight::wgsl(&crate::cookbook::marks::without(recipe, &[]).expect("well formed"))),
            "the WGSL of {}",
            recipe.name
        );
    }
    for fetched in ["src=\"http", "url(", "@import", "<link rel=\"stylesheet\"", "fetch("] {
        assert!(!html.contains(fetched), "{fetched}");
    }
}

#[test]
fn anchors_are_unique_and_every_link_within_the_page_leads_to_one() {
    let html = page::page("adapter", &[]);
    let after = |mark: &'static str| html.split(mark).skip(1).filter_map(|rest| rest.split('"').next());
    let mut names = HashSet::new();
    for name in after(" id=\"") {
        assert!(names.insert(name), "`{name}` is there twice");
    }
    for target in after("href=\"#") {
        assert!(names.contains(target), "nothing is called `{target}`");
    }
}

#[test]
fn the_same_site_gives_the_same_bytes() {
    let around = tempfile::tempdir().expect("temporary folder");
    let pictures = [picture(around.path(), "Prism")];
    let bytes = |name: &str| {
        let index = write(&around.path().join(name), &site(&pictures, &[])).expect("written");
        fs::read(index).expect("readable")
    };
    assert_eq!(bytes("a"), bytes("b"));
    assert_eq!(bytes("a"), bytes("b"), "on top of an older one");
}

#[test]
fn a_missing_picture_is_named_and_leaves_nothing() {
    let around = tempfile::tempdir().expect("temporary folder");
    let mut lost = picture(around.path(), "Octahedron");
    fs::remove_file(&lost.file).expect("there");
    lost.file = around.path().join("lost.png");
    let error = write(&around.path().join("out"), &site(&[lost], &[])).expect_err("no such file").to_string();
    assert!(error.contains("`Octahedron`") && error.contains("lost.png") && error.contains("./cook render"), "{error}");
    assert_eq!(fs::read_dir(around.path()).expect("readable").count(), 0, "nothing is left");
}

#[test]
fn a_folder_of_something_else_is_refused() {
    let around = tempfile::tempdir().expect("temporary folder");
    fs::write(around.path().join("thesis.tex"), "years").expect("writable");
    let error = write(around.path(), &site(&[], &[])).expect_err("foreign").to_string();
    assert!(error.contains("thesis.tex") && error.contains("--out"), "{error}");
    assert_eq!(fs::read_to_string(around.path().join("thesis.tex")).expect("kept"), "years");
}

#[test]
fn a_figure_of_no_module_is_refused() {
    let around = tempfile::tempdir().expect("temporary folder");
    let figures = [("fresnell".to_owned(), picture(around.path(), "Error"))];
    let error = write(&around.path().join("out"), &site(&[], &figures)).expect_err("no such module").to_string();
    assert!(error.contains("`fresnell`"), "{error}");
}
