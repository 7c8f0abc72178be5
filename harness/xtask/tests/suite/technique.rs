//! `cook new` writes all files of a technique or none. `.ci/full` builds and tests one.

use lapidary_cookbook::header::{parse_functions, parse_header};
use lapidary_cookbook::repository;
use lapidary_testing::program::{cook, cook_in, folder, succeeds};
use lapidary_xtask::lint::lint;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Copies the files of the cookbook that `cook new` changes.
fn cookbook() -> tempfile::TempDir {
    let copy = folder();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for file in ["Cargo.toml", "harness/cook/Cargo.toml", "CHANGELOG.md"] {
        let to = copy.path().join(file);
        std::fs::create_dir_all(to.parent().expect("a folder")).expect("made");
        std::fs::copy(root.join(file), to).expect("copied");
    }
    copy
}

/// Returns every file below a folder, with its text.
fn files(folder: &Path) -> BTreeMap<PathBuf, String> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            let text = std::fs::read_to_string(&path).expect("text");
            found.insert(path, text);
        }
    }
    found
}

#[test]
fn a_new_technique_keeps_the_contract_and_is_known_to_cargo() {
    let copy = cookbook();
    let before = files(copy.path()).len();
    let said = succeeds(copy.path(), &["new", "thin_film", "--in", "."]).stdout;
    let read = |file: &str| std::fs::read_to_string(copy.path().join(file)).unwrap_or_else(|e| panic!("{file}: {e}"));
    assert_eq!(files(copy.path()).len(), before + 8, "{said}");
    let source = read("wgsl/thin_film.wgsl");
    let naive = read("wgsl/naive/thin_film.wgsl");
    let findings = lint("thin_film", &source, &naive);
    assert!(findings.is_empty(), "{}", findings.iter().map(ToString::to_string).collect::<String>());
    assert_eq!(parse_header(&source).expect("a header").name, "thin_film");
    assert_eq!(parse_functions(&(source + &naive)).expect("comments").len(), 2);
    for (file, line) in [
        ("Cargo.toml", "lapidary-thin-film = { path = \"crates/thin_film\", version = \"0.2.0\" }"),
        ("harness/cook/Cargo.toml", "lapidary-thin-film = { workspace = true, features = [\"formulas\"] }"),
    ] {
        let text = read(file);
        let lines: Vec<&str> = text.lines().collect();
        let place = lines.iter().position(|found| *found == line).unwrap_or_else(|| panic!("{file}:\n{text}"));
        let name = |line: &str| line.split([' ', '.']).next().unwrap_or_default().to_owned();
        assert!(name(lines[place - 1]) < name(line) && name(line) < name(lines[place + 1]), "{file}:\n{text}");
    }
    let changes = read("CHANGELOG.md");
    assert!(changes.contains("### New\n\n- `thin_film`: a new module.\n- `"), "{changes}");
    assert!(files(copy.path()).values().all(|text| !text.contains("NAME")), "a name is left open");
}

#[test]
fn what_cannot_be_a_technique_leaves_nothing_behind() {
    let copy = cookbook();
    succeeds(copy.path(), &["new", "mine", "--in", "."]);
    let before = files(copy.path());
    for (arguments, said) in [
        (&["new", "mine", "--in", "."][..], "wgsl/mine.wgsl: is there already"),
        (&["new", "Thin", "--in", "."], "does not begin with a small letter"),
        (&["new", "thin-film", "--in", "."], "other characters than a to z"),
        (&["new", "thin__film", "--in", "."], "two underscores in a row"),
        (&["new", "thin_", "--in", "."], "one at its end"),
        (&["new", "gem", "--in", "."], "is a recipe"),
        (&["new", "scene", "--in", "."], "there is a crate `lapidary-scene` already"),
        (&["new", "cook", "--in", "."], "there is a crate `lapidary-cook` already"),
        (&["new", "other", "--in", "nowhere"], "nowhere/Cargo.toml: cannot be read"),
        (&["new", "other", "--in", "harness"], "Cargo.toml: cannot be read"),
        (&["new"], "<NAME>"),
    ] {
        let answer = cook(copy.path(), arguments);
        assert_eq!(answer.code, Some(2), "{arguments:?}: {answer:?}");
        assert!(answer.stderr.contains(said), "{arguments:?}: {}", answer.stderr);
        assert_eq!(files(copy.path()), before, "{arguments:?}");
    }
}

/// A clone may be mounted elsewhere than where the program was built: the launcher says where it stands.
#[test]
fn the_clone_that_is_run_is_the_one_that_changes() {
    let (copy, elsewhere) = (cookbook(), folder());
    let before = files(copy.path()).len();
    let root = copy.path().to_str().expect("UTF-8");
    let answer = cook_in(elsewhere.path(), &["new", "thin_film"], &[(repository::VARIABLE, root)]);
    assert_eq!(answer.code, Some(0), "{}", answer.stderr);
    assert_eq!(files(copy.path()).len(), before + 8);
    let launcher = std::fs::read_to_string(repository::place().join("cook")).expect("the launcher");
    assert!(launcher.contains(&format!("export {}=$cd_root", repository::VARIABLE)), "the launcher says nothing");
}

/// A name as long as the longest of the cookbook's leaves no line wider than a page.
#[test]
fn long_names_fit_on_a_page() {
    let copy = cookbook();
    let longest = lapidary_cookbook::modules().iter().map(|module| module.name.len()).max().expect("modules");
    let name = "n".repeat(longest);
    succeeds(copy.path(), &["new", &name, "--in", "."]);
    for file in [format!("wgsl/{name}.wgsl"), format!("wgsl/naive/{name}.wgsl")] {
        let text = std::fs::read_to_string(copy.path().join(&file)).expect("written");
        let wide = text.lines().find(|line| line.chars().count() > 120);
        assert_eq!(wide, None, "{file}");
    }
}
