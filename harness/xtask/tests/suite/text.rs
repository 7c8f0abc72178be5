//! The interface as text: every signature and every promised accuracy, on which users rely. A
//! change of either must be visible in review. `./cook test --refresh` accepts it.

use lapidary_assay::dispatch;
use lapidary_assay::dispatch::signature::Signature;
use lapidary_cook::check::{Row, difference};
use lapidary_cookbook as cookbook;
use lapidary_ladders::builtins;
use lapidary_ladders::page;
use lapidary_snapshots::browse;
use lapidary_testing::generated;
use lapidary_testing::program::succeeds;
use std::fmt::Write as _;
use std::path::Path;

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

/// The page of drivers shows the values of the records.
#[test]
fn the_drivers_are_as_recorded() {
    let of = |folder: &str| -> builtins::Report {
        serde_json::from_str(&read(&format!("docs/measurements/{folder}/builtins.json"))).expect(folder)
    };
    let builtins = builtins::side_by_side(&[
        ("lavapipe", of("lavapipe")),
        ("SwiftShader", of("swiftshader")),
        ("NVIDIA H200", of("nvidia_h200")),
    ]);
    let rows: Vec<Row> = serde_json::from_str(&read("docs/measurements/swiftshader/check.json")).expect("rows");
    let page = read("docs/drivers.md");
    let filled = page::with_table(&page, page::BUILTINS, &builtins).expect("sound marks");
    let filled = page::with_table(&filled, page::DIFFERENCES, &difference::table(&rows)).expect("sound marks");
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
