//! What users rely on in text: every signature and every promised accuracy. A change of either is a change of the cookbook's
//! interface, and is to be seen in review. `./cook test --refresh` accepts it.

use crate::program::succeeds;
use lapidary_assay::dispatch;
use lapidary_assay::dispatch::signature::Signature;
use lapidary_cook::cookbook;
use lapidary_cook::cost::page;
use std::fmt::Write as _;

#[test]
fn signatures_and_accuracies_are_as_they_were() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../../../../snapshots/cookbook");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        for module in cookbook::modules() {
            let (ir, _) = dispatch::parse(module.source, module.name).expect("the cookbook's WGSL is valid");
            let mut text = String::new();
            for function in &module.functions {
                let signature = Signature::reflect(&ir, &function.name).expect("a function of the module");
                let _ = writeln!(text, "{signature}\n    {}", function.accuracy);
            }
            insta::assert_snapshot!(module.name, text);
        }
    });
}

/// The README's table is what `./cook list --markdown` prints. `./cook test --refresh` writes it anew.
#[test]
fn the_readme_lists_the_modules() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md");
    let page = std::fs::read_to_string(&path).expect("the page");
    let table = succeeds(std::path::Path::new("."), &["list", "--markdown"]).stdout;
    let filled = page::with_table(&page, page::MODULES, &table).expect("sound marks");
    assert!(filled.contains(&table), "README.md has no place for the table `{}`", page::MODULES);
    if filled != page {
        assert!(std::env::var_os("LAPIDARY_REFRESH_PAGES").is_some(), "README.md: ./cook test --refresh\n{table}");
        std::fs::write(&path, filled).expect("the page is written");
    }
}
