//! Tests of the workspace structure: dependencies between crates run one way, mirrors need only
//! glam, and folders do not need each other.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Other crates that each crate of the harness may need; see docs/ARCHITECTURE.md.
const ARROWS: [(&str, &[&str]); 22] = [
    ("gpu", &[]),
    ("browser", &[]),
    ("files", &[]),
    ("command", &["files"]),
    ("specialise", &[]),
    ("translate", &["specialise"]),
    ("assay", &["gpu", "specialise"]),
    ("scene", &["files"]),
    ("assets", &["scene"]),
    ("reference", &["scene"]),
    ("plan", &["files", "scene"]),
    ("render", &["files", "gpu", "plan", "reference", "scene", "specialise", "wgsl"]),
    ("flip", &[]),
    ("trials", &["assay", "gpu"]),
    ("cookbook", &["assay", "translate", "wgsl"]),
    ("take", &["assay", "command", "cookbook", "files", "translate", "wgsl"]),
    ("testing", &["assay", "cookbook", "gpu", "render", "scene"]),
    (
        "cook",
        &[
            "assay",
            "browser",
            "command",
            "cookbook",
            "files",
            "flip",
            "gpu",
            "plan",
            "reference",
            "render",
            "scene",
            "take",
            "translate",
            "wgsl",
        ],
    ),
    ("snapshots", &["cookbook", "files", "flip", "gpu", "plan", "reference", "render", "scene", "wgsl"]),
    (
        "ladders",
        &[
            "assay",
            "browser",
            "cook",
            "cookbook",
            "files",
            "gpu",
            "plan",
            "reference",
            "render",
            "scene",
            "snapshots",
            "specialise",
            "wgsl",
        ],
    ),
    (
        "gallery",
        &[
            "assay",
            "cook",
            "cookbook",
            "files",
            "gpu",
            "ladders",
            "plan",
            "render",
            "scene",
            "snapshots",
            "specialise",
            "translate",
            "wgsl",
        ],
    ),
    (
        "xtask",
        &[
            "assay",
            "cook",
            "cookbook",
            "files",
            "gpu",
            "plan",
            "render",
            "scene",
            "snapshots",
            "specialise",
            "testing",
            "translate",
            "wgsl",
        ],
    ),
];

/// Packages that build C or C++.
const COMPILERS: [&str; 3] = ["cc v", "cmake v", "bindgen v"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns the names, without `lapidary-`, in a manifest's `[dependencies]`, and whether each is
/// optional.
fn dependencies(manifest: &Path) -> BTreeMap<String, bool> {
    let text = std::fs::read_to_string(manifest).unwrap_or_else(|error| panic!("{}: {error}", manifest.display()));
    let part = text.split("\n[dependencies]\n").nth(1).unwrap_or_default();
    let lines = part.lines().take_while(|line| !line.starts_with('['));
    let lines = lines.filter(|line| !line.starts_with('#') && !line.is_empty());
    lines
        .map(|line| {
            let name = line.split(['.', ' ', '=']).next().unwrap_or_default();
            // A package's name has hyphens where its folder has underscores.
            (name.trim_start_matches("lapidary-").replace('-', "_"), line.contains("optional = true"))
        })
        .collect()
}

fn folders(folder: &Path) -> BTreeSet<String> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let entries = entries.map(|entry| entry.expect("an entry").path()).filter(|path| path.is_dir());
    entries.map(|path| path.file_name().expect("a name").to_string_lossy().into_owned()).collect()
}

#[test]
fn arrows_between_crates_run_one_way() {
    let modules = folders(&root().join("crates"));
    let known: BTreeSet<&str> = ARROWS.iter().map(|(name, _)| *name).chain(["wgsl"]).collect();
    for (name, allowed) in ARROWS {
        let needed = dependencies(&root().join("harness").join(name).join("Cargo.toml"));
        assert!(!needed.is_empty() || name == "flip", "{name}");
        for other in needed.keys().filter(|other| known.contains(other.as_str())) {
            assert!(allowed.contains(&other.as_str()), "{name} needs {other}");
        }
        // Libraries for general use must not depend on the cookbook.
        if ["gpu", "browser", "files", "command", "specialise", "translate", "assay"].contains(&name) {
            assert!(needed.keys().all(|other| !modules.contains(other)), "{name}");
        }
    }
    let crates: BTreeSet<String> = folders(&root().join("harness"));
    assert_eq!(crates, ARROWS.iter().map(|(name, _)| (*name).to_owned()).collect());
}

#[test]
fn mirrors_stand_on_glam_alone() {
    for module in folders(&root().join("crates")) {
        let needed = dependencies(&root().join("crates").join(&module).join("Cargo.toml"));
        let always: Vec<&String> = needed.iter().filter(|(_, optional)| !**optional).map(|(name, _)| name).collect();
        // A scalar module needs no dependency at all.
        assert!(always.iter().all(|name| *name == "glam"), "{module} needs {always:?}");
    }
}

/// The folders at the root of every crate's sources have an order in which each names only earlier
/// ones.
#[test]
fn no_circles_among_folders() {
    for (name, _) in ARROWS {
        let sources = root().join("harness").join(name).join("src");
        let all = folders(&sources);
        let mut arrows: BTreeMap<&String, BTreeSet<&String>> = BTreeMap::new();
        for folder in &all {
            let mut texts = texts(&sources.join(folder));
            texts.extend(std::fs::read_to_string(sources.join(folder).with_extension("rs")));
            let named: BTreeSet<String> = texts.iter().flat_map(|text| named(text)).collect();
            arrows.insert(folder, all.iter().filter(|other| *other != folder && named.contains(*other)).collect());
        }
        while let Some(free) = arrows.iter().find(|(_, needs)| needs.is_empty()).map(|(folder, _)| *folder) {
            arrows.remove(free);
            arrows.values_mut().for_each(|needs| {
                needs.remove(free);
            });
        }
        assert!(arrows.is_empty(), "{name}: these need each other: {arrows:?}");
    }
}

/// Returns the modules at the crate root that a source names: `crate::a::…`, and all of
/// `crate::{a::…, b::{…}, c}`.
fn named(source: &str) -> Vec<String> {
    let identifier = |text: &str| -> String {
        text.trim_start().chars().take_while(|letter| letter.is_alphanumeric() || *letter == '_').collect()
    };
    let mut found = Vec::new();
    for rest in source.split("crate::").skip(1) {
        let Some(list) = rest.strip_prefix('{') else {
            found.push(identifier(rest));
            continue;
        };
        let (mut depth, mut start) = (0, 0);
        for (place, letter) in list.char_indices() {
            match letter {
                '{' => depth += 1,
                '}' | ',' if depth == 0 => {
                    found.push(identifier(&list[start..place]));
                    start = place + 1;
                    if letter == '}' {
                        break;
                    }
                }
                '}' => depth -= 1,
                _ => {}
            }
        }
    }
    found
}

#[test]
fn names_are_read_from_lists_too() {
    let source = "use crate::{a, b::{c, d}, e::F};\nuse crate::g::h;\nfn f() { crate::i() }";
    assert_eq!(named(source), ["a", "b", "e", "g", "i"]);
}

/// Returns the packages from which a package is built, without its tests. `edges` is in the syntax
/// of `cargo tree`.
fn packages(package: &str, features: &[&str], edges: &str) -> BTreeSet<String> {
    let mut command = std::process::Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(["tree", "--package", package, "--edges", edges, "--prefix", "none", "--format", "{p}"]);
    let output = command.args(["--offline", "--locked"]).args(features).current_dir(root()).output();
    let output = output.expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let names = text.lines().filter_map(|line| line.split(" (").next()).filter(|line| !line.is_empty());
    names.map(str::to_owned).collect()
}

/// The lock files of the projects outside the workspace follow its crates and their versions.
/// `./cook test --refresh` brings them up to date.
#[test]
fn the_projects_outside_are_locked() {
    let cargo = |arguments: &[&str], project: &str| {
        let mut command = std::process::Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        command.args(arguments).arg("--offline").args(["--manifest-path", project]).current_dir(root());
        command.output().expect("cargo runs")
    };
    for project in ["studies/Cargo.toml", "harness/assay/example/Cargo.toml"] {
        if std::env::var_os("LAPIDARY_REFRESH_PAGES").is_some() {
            cargo(&["update", "--workspace"], project);
        }
        let output = cargo(&["tree", "--locked"], project);
        assert!(output.status.success(), "{project}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

/// Users of the libraries take on no more packages than the READMEs state, and none that a C or C++
/// compiler builds.
#[test]
fn the_libraries_stay_small() {
    for (package, features, most) in [
        ("lapidary-assay", &[][..], 80),
        ("lapidary-assay", &["--no-default-features"], 2),
        ("lapidary-specialise", &[], 30),
    ] {
        let needed = packages(package, features, "normal");
        assert!(needed.len() <= most, "{package} {features:?}: {} packages: {needed:?}", needed.len());
        let built = packages(package, features, "normal,build");
        assert!(!built.iter().any(|name| COMPILERS.iter().any(|one| name.starts_with(one))), "{built:?}");
    }
}

/// A user of the cookbook builds few packages besides its own, and none that a C or C++ compiler builds.
#[test]
fn the_tool_stays_small() {
    let mut needed = packages("lapidary-cook", &[], "normal,build");
    needed.retain(|name| !name.starts_with("lapidary-"));
    // Six of them decode what files compress: Draco, WebP (with one more) and Basis Universal with Zstandard (with one more).
    assert!(needed.len() <= 140, "{} packages: {needed:?}", needed.len());
    assert!(!needed.iter().any(|name| COMPILERS.iter().any(|one| name.starts_with(one))), "{needed:?}");
}

/// One who copies a shader builds no device, no picture and no scene.
#[test]
fn what_copies_stays_smaller() {
    let needed = packages("lapidary-take", &[], "normal,build");
    let others = needed.iter().filter(|name| !name.starts_with("lapidary-"));
    assert!(others.clone().count() <= 60, "{needed:?}");
    for refused in ["wgpu", "image", "exr", "gltf", "lapidary-scene", "lapidary-gpu"] {
        assert!(!needed.iter().any(|name| name.starts_with(refused)), "{refused}: {needed:?}");
    }
}

/// Returns the texts of a folder's Rust sources, without test files.
fn texts(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let is_test = path.file_stem().is_some_and(|stem| stem == "tests");
        if is_test {
            continue;
        }
        if path.is_dir() {
            found.extend(texts(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = std::fs::read_to_string(&path).expect("a source");
            found.push(text.split("#[cfg(test)]").next().unwrap_or_default().to_owned());
        }
    }
    found
}
