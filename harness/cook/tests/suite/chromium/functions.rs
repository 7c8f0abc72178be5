//! Every function in Chromium, to its portable bounds: Tint's translation on SwiftShader, a second compiler and a second driver.

use super::{browser, found};
use lapidary_assay::property::Settings;
use lapidary_browser::Browser;
use lapidary_cook::check::{self, On, Row, Source};
use lapidary_cook::formulas;

/// Enough to meet every branch of most functions; `.ci/full` asks about many more.
const CASES: u64 = 1_024;

#[test]
fn every_function_holds_in_chromium() {
    let gpu = crate::gpu();
    let names = formulas::all().iter().filter(|formula| formula.benign.is_none());
    let count = names.clone().count();
    let Some(browser) = found(browser().as_ref().map_err(String::as_str), &format!("{count} functions")) else {
        return;
    };
    let settings = Settings { cases: CASES, seed: crate::seed() };
    let mut faults = Vec::new();
    for formula in names {
        let row =
            check::run(On::Browser(browser, gpu), formula, Source::Cookbook, settings).expect("the browser runs it");
        if !row.passed() {
            faults.push(format!(
                "{}: {} failed, {:?}, {:?}, {:?}, {:?}; {}",
                row.function,
                row.failed,
                row.reason,
                row.broken_hard_cases,
                row.broken_promises,
                row.broken_branches,
                row.reproduce
            ));
        }
    }
    assert!(faults.is_empty(), "{}:\n{}", browser.adapter(), faults.join("\n"));
}

/// A function that Tint and SwiftShader are bound to compute otherwise than the cookbook says is found, in bits and against the bound.
#[test]
fn another_function_is_told_from_the_cookbooks() {
    let Some(browser) = found(browser().as_ref().map_err(String::as_str), "a changed function") else { return };
    let formula = formulas::of_function("fresnel_schlick").expect("a formula");
    let module = lapidary_cook::cookbook::module("fresnel").expect("a module");
    let settings = Settings { cases: CASES, ..Settings::default() };
    let run = |browser: &Browser, source: Source<'_>| -> Row {
        check::run(On::Browser(browser, crate::gpu()), formula, source, settings).expect("runs")
    };
    assert!(run(browser, Source::Cookbook).passed());
    let changed = module.source.replacen("1.0f - ", "1.001f - ", usize::MAX);
    let row = run(browser, Source::Copy("mine.wgsl", &changed));
    assert!(!row.passed() && row.failed > CASES / 2, "{} failed", row.failed);
}
