//! The interface as text: every signature and every promised accuracy, on which users rely. A
//! change of either must be visible in review. `./cook test --refresh` accepts it.

use lapidary_assay::dispatch;
use lapidary_assay::dispatch::signature::Signature;
use lapidary_cook::check::{Row, differing};
use lapidary_cookbook as cookbook;
use lapidary_ladders::{LADDERS, builtins, page};
use lapidary_plan::Effect;
use lapidary_snapshots::browse;
use lapidary_testing::generated;
use lapidary_testing::program::succeeds;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

#[test]
fn signatures_and_accuracies_are_as_they_were() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../../../../snapshots/cookbook");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        for module in cookbook::modules() {
            let (ir, _) = dispatch::parse(module.whole, module.name).expect("the cookbook's WGSL is valid");
            let mut text = String::new();
            for function in &module.functions {
                let signature = Signature::reflect(&ir, &function.name).expect("a function of the module");
                let _ = writeln!(text, "{signature}\n    {}", function.accuracy);
            }
            insta::assert_snapshot!(module.name, text);
        }
    });
}

/// A pasted copy says from which release it is.
#[test]
fn every_module_states_the_release() {
    for module in cookbook::modules() {
        assert_eq!(module.header.version.as_deref(), Some(env!("CARGO_PKG_VERSION")), "{}", module.name);
    }
}

/// The page of drivers shows the values of the records.
#[test]
fn the_drivers_are_as_recorded() {
    let record_of = |folder: &str| -> builtins::Report {
        serde_json::from_str(&read(&format!("docs/measurements/{folder}/builtins.json"))).expect(folder)
    };
    let builtins = builtins::side_by_side(&[
        ("lavapipe", record_of("lavapipe")),
        ("SwiftShader", record_of("swiftshader")),
        ("NVIDIA H200", record_of("nvidia_h200")),
    ]);
    let rows: Vec<Row> = serde_json::from_str(&read("docs/measurements/swiftshader/check.json")).expect("rows");
    let page = read("docs/drivers.md");
    let filled = page::with_table(&page, page::BUILTINS, &builtins).expect("sound marks");
    let filled = page::with_table(&filled, page::DIFFERENCES, &differing::table(&rows)).expect("sound marks");
    assert!(filled.contains(&builtins), "drivers.md has no place for the table `{}`", page::BUILTINS);
    generated::keep("docs/drivers.md", &filled);
}

/// The page of pictures, to be browsed without a build.
#[test]
fn the_pictures_are_listed_with_their_captions() {
    generated::keep("snapshots/README.md", &browse::page());
}

/// The guide to choosing shows the planner's rungs, with the figures of the committed reports.
#[test]
fn the_guide_to_choosing_has_the_planners_rungs() {
    let page = read("docs/choosing.md");
    let part = lapidary_gallery::choices::page();
    let filled = page::with_table(&page, page::CHOICES, &part).expect("sound marks");
    assert!(filled.contains(&part), "choosing.md has no place for the tables `{}`", page::CHOICES);
    generated::keep("docs/choosing.md", &filled);
}

/// The table of modules is the output of `./cook list --markdown`. `./cook test --refresh` rewrites
/// it.
#[test]
fn the_page_of_modules_lists_them() {
    let page = read("docs/modules.md");
    let table = succeeds(Path::new("."), &["list", "--markdown"]).stdout;
    let filled = page::with_table(&page, page::MODULES, &table).expect("sound marks");
    assert!(filled.contains(&table), "modules.md has no place for the table `{}`", page::MODULES);
    generated::keep("docs/modules.md", &filled);
}

/// Reads a file by its path from the repository's folder.
fn read(file: &str) -> String {
    let path = cookbook::repository::place().join(file);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// Words of a Markdown text, code among them, without the targets of its links.
fn words(text: &str) -> usize {
    let mut parts = text.split("](");
    let first = parts.next().unwrap_or_default();
    let rest = parts.map(|part| part.split_once(')').map_or("", |(_, after)| after));
    std::iter::once(first).chain(rest).collect::<String>().split_whitespace().count()
}

/// Who opens the repository reads what this is and what to type; the rest stands in `docs/`.
#[test]
fn the_readme_is_short() {
    assert_eq!(words("a [link to](docs/a page.md) and `./cook list`"), 6);
    let words = words(&read("README.md"));
    assert!(words <= 600, "README.md has {words} words; docs/using.md has room");
}

/// A ladder that the page of ladders leaves out would be found by nobody.
#[test]
fn the_page_of_ladders_names_every_ladder() {
    let page = read("docs/ladders.md");
    for ladder in &LADDERS {
        let command = format!("| `./cook cost {}` |", ladder.name);
        assert!(page.contains(&command), "docs/ladders.md has no row {command}");
    }
}

/// The page of plans says of every effect what calls for it.
#[test]
fn the_page_of_plans_names_every_effect() {
    let page = read("docs/plan.md");
    let names: Vec<&str> = part(&page, "## Which effects").lines().filter_map(|row| row.split('|').nth(1)).collect();
    for effect in Effect::ALL {
        let name = format!("`{effect}`");
        assert!(names.iter().any(|cell| cell.contains(&name)), "docs/plan.md: no row of {name}");
    }
}

/// Where an effect needs an entry; without one, the build or a test fails.
const PLACES_OF_AN_EFFECT: [&str; 8] = [
    "harness/plan/src/effect.rs",
    "harness/plan/src/decision.rs",
    "wgsl/recipes/",
    "harness/render/src/",
    "harness/render/tests/suite/plan.rs",
    "harness/ladders/src/effects.rs",
    "harness/xtask/src/host/sizes.rs",
    "docs/plan.md",
];

#[test]
fn what_an_effect_needs_is_told_and_there() {
    let page = read("CONTRIBUTING.md");
    let part = part(&page, "### An effect of a recipe");
    for place in PLACES_OF_AN_EFFECT {
        assert!(part.contains(&format!("\n| `{place}` |")), "CONTRIBUTING.md does not name {place}");
    }
    let paths = paths(part, &["harness/", "wgsl/", "docs/"]);
    assert!(paths.len() > PLACES_OF_AN_EFFECT.len(), "{paths:?}");
    let gone = gone(&paths);
    assert!(gone.is_empty(), "CONTRIBUTING.md names {gone:?}, which are not there");
}

/// Files of the harness move; the pages that name them follow.
#[test]
fn the_paths_that_pages_name_are_there() {
    let root = cookbook::repository::place();
    let docs = std::fs::read_dir(root.join("docs")).expect("a folder").map(|entry| entry.expect("an entry").path());
    let pages = docs.filter(|path| path.extension().is_some_and(|extension| extension == "md"));
    let pages = pages.chain(["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|file| root.join(file)));
    let mut named = 0;
    for path in pages {
        let text = std::fs::read_to_string(&path).expect("a page");
        let paths = paths(&text, &["harness/", ".ci/"]);
        named += paths.len();
        let gone = gone(&paths);
        assert!(gone.is_empty(), "{} names {gone:?}, which are not there", path.display());
    }
    assert!(named > 20, "{named}");
}

/// Every page's links, pictures among them, lead to files of the repository: a code host follows them, and the site shows
/// one that leads nowhere as plain text.
#[test]
fn every_link_of_a_page_leads_to_a_file() {
    let root = cookbook::repository::place();
    let mut links = 0;
    for page in ["", "crates", "docs", "harness", "snapshots", "studies", "wgsl"]
        .iter()
        .flat_map(|folder| pages(&root.join(folder)))
    {
        let text = std::fs::read_to_string(&page).expect("a page");
        for target in targets(&text) {
            let file = target.split('#').next().unwrap_or_default();
            links += 1;
            assert!(page.with_file_name(file).exists(), "{}: no file {target}", page.display());
        }
    }
    assert!(links > 500, "{links}");
}

/// `./cook test NAME` on a page runs something: a test, or those of a file or a module, has the name.
#[test]
fn the_tests_that_pages_name_are_there() {
    // CONTRIBUTING's own example.
    const EXAMPLE: &str = "plate";
    let root = cookbook::repository::place();
    let mut names = String::new();
    for folder in ["crates", "harness"] {
        for file in with_ending(&root.join(folder), "rs") {
            names.push_str(&file.display().to_string());
            let text = std::fs::read_to_string(&file).expect("a source");
            names.extend(
                text.lines().filter_map(|line| line.trim_start().strip_prefix("fn ")).flat_map(|line| [" ", line]),
            );
        }
    }
    let mut named = 0;
    for page in ["", "docs", "harness"].iter().flat_map(|folder| pages(&root.join(folder))) {
        let text = std::fs::read_to_string(&page).expect("a page").replace('\n', " ");
        for filter in text.split("./cook test ").skip(1) {
            let filter: String = filter
                .chars()
                .take_while(|letter| letter.is_ascii_lowercase() || "_:0123456789".contains(*letter))
                .collect();
            named += usize::from(!filter.is_empty());
            let is_there = filter == EXAMPLE || filter.split("::").all(|part| names.contains(part));
            assert!(is_there, "{}: no test has `{filter}` in its name", page.display());
        }
    }
    assert!(named > 30, "{named}");
}

/// The pages in a folder; below it too, unless it is the repository's.
fn pages(folder: &Path) -> Vec<PathBuf> {
    with_ending(folder, "md")
}

/// The files in a folder with this ending; below it too, unless it is the repository's.
fn with_ending(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let is_root = folder.join("Cargo.lock").is_file() && folder.join("cook").is_file();
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let is_installed = path.ends_with("node_modules") || path.ends_with("target");
        if path.is_dir() && !is_root && !is_installed {
            found.extend(with_ending(&path, ending));
        } else if path.extension().is_some_and(|extension| extension == ending) {
            found.push(path);
        }
    }
    found
}

/// The targets of a text's links that are files, outside of code.
fn targets(text: &str) -> Vec<&str> {
    let mut is_code = false;
    let prose = text.lines().filter(|line| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence && !line.starts_with("    ")
    });
    let spans = prose.flat_map(|line| line.split('`').step_by(2));
    let links = spans.flat_map(|span| span.split("](").skip(1));
    let targets = links.filter_map(|rest| rest.split(')').next());
    targets.filter(|target| !target.contains("://") && !target.starts_with(['#', '<']) && !target.is_empty()).collect()
}

#[test]
fn targets_are_those_of_links_outside_of_code() {
    let text = "[a](b.md#c) and `[d](e)`, [`f`](g/h.png)\n```\n[i](j)\n```\n[k](https://l) [m](#n)";
    assert_eq!(targets(text), ["b.md#c", "g/h.png"]);
}

/// The text below a heading, up to the next one.
fn part<'a>(page: &'a str, heading: &str) -> &'a str {
    let (_, rest) = page.split_once(&format!("{heading}\n")).unwrap_or_else(|| panic!("no heading {heading}"));
    rest.split("\n#").next().unwrap_or_default()
}

/// The paths in a text's `` `code` `` that begin in one of these ways; patterns, such as `crates/<name>/`, are none.
fn paths<'a>(text: &'a str, starts: &[&str]) -> Vec<&'a str> {
    let is_path = |code: &&str| {
        let plain = |letter: char| letter.is_ascii_alphanumeric() || "/._-".contains(letter);
        starts.iter().any(|start| code.starts_with(start)) && code.chars().all(plain)
    };
    text.split('`').filter(is_path).collect()
}

fn gone<'a>(paths: &[&'a str]) -> Vec<&'a str> {
    let root = cookbook::repository::place();
    paths.iter().filter(|path| !root.join(path).exists()).copied().collect()
}
