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
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let read = |name: &str| std::fs::read_to_string(docs.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let of = |folder: &str| -> builtins::Report {
        serde_json::from_str(&read(&format!("measurements/{folder}/builtins.json"))).expect(folder)
    };
    let builtins = builtins::side_by_side(&[
        ("lavapipe", of("lavapipe")),
        ("SwiftShader", of("swiftshader")),
        ("NVIDIA H200", of("nvidia_h200")),
    ]);
    let rows: Vec<Row> = serde_json::from_str(&read("measurements/swiftshader/check.json")).expect("rows");
    let page = read("drivers.md");
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
    let path = lapidary_cookbook::repository::place().join("docs/choosing.md");
    let page = std::fs::read_to_string(path).expect("the page");
    let part = lapidary_gallery::choices::page();
    let filled = page::with_table(&page, page::CHOICES, &part).expect("sound marks");
    assert!(filled.contains(&part), "choosing.md has no place for the tables `{}`", page::CHOICES);
    generated::keep("docs/choosing.md", &filled);
}

/// The README's table is the output of `./cook list --markdown`. `./cook test --refresh` rewrites
/// it.
#[test]
fn the_readme_lists_the_modules() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md");
    let page = std::fs::read_to_string(&path).expect("the page");
    let table = succeeds(std::path::Path::new("."), &["list", "--markdown"]).stdout;
    let filled = page::with_table(&page, page::MODULES, &table).expect("sound marks");
    assert!(filled.contains(&table), "README.md has no place for the table `{}`", page::MODULES);
    generated::keep("README.md", &filled);
}
