//! Every function in Chromium, to its portable bounds: Tint's translation on SwiftShader, a second
//! compiler and a second driver.

use super::{browser, found};
use lapidary_assay::dispatch::KernelText;
use lapidary_assay::formula::Words;
use lapidary_assay::property::{Check, Settings};
use lapidary_assay::slack::Reassociation;
use lapidary_browser::Browser;
use lapidary_cook::check::in_browser::InBrowser;
use lapidary_cook::check::{self, On, Row, Source};
use lapidary_cook::formulas;
use lapidary_cookbook as cookbook;

/// Random inputs per function, besides the hard cases: a brief look at each. `.ci/full` runs
/// `./cook check --browser` with 65,536 inputs, promises and branches.
const CASES: u64 = 1_024;

#[test]
fn every_function_holds_in_chromium() {
    let names = lapidary_testing::sampled(formulas::promised(), super::ONE_IN);
    let count = names.len();
    let Some(browser) = found(browser(), &format!("{count} functions")) else { return };
    let settings = Settings { cases: CASES, seed: lapidary_testing::seed() };
    let mut faults = Vec::new();
    for formula in names {
        let module = cookbook::module(formula.module).expect("its module");
        let text = KernelText::of_function(module.whole, module.name, formula.function).expect("the cookbook's WGSL");
        let tolerance = check::tolerance(On::Slack(Reassociation::Written), formula);
        let hard: Vec<Words> = formula.hard_cases.iter().map(|case| case.arguments.clone()).collect();
        let mut runner = InBrowser::new(&browser, text);
        let check = Check { formula, runner: &mut runner, tolerance: &tolerance }.run(settings, &hard);
        let report = check.unwrap_or_else(|error| panic!("{}: {error}", formula.function));
        if report.failed > 0 {
            faults.push(format!(
                "{} failed, {:?}; ./cook check {}::{} --browser --seed {} --cases {CASES}",
                report.failed, report.reason, formula.module, formula.function, settings.seed
            ));
        }
    }
    assert!(faults.is_empty(), "{}:\n{}", browser.adapter(), faults.join("\n"));
}

/// A copy that computes something else fails in Chromium too.
#[test]
fn another_function_is_told_from_the_cookbooks() {
    let Some(browser) = found(browser(), "a changed function") else { return };
    let formula = formulas::of_function("fresnel_schlick").expect("a formula");
    let module = lapidary_cookbook::module("fresnel").expect("a module");
    let settings = Settings { cases: CASES, ..Settings::default() };
    let run = |browser: &Browser, source: Source<'_>| -> Row {
        check::run(On::Browser(browser, lapidary_testing::gpu()), formula, source, settings).expect("runs")
    };
    assert!(run(&browser, Source::Cookbook).passed());
    let changed = module.source.replacen("1.0f - ", "1.001f - ", usize::MAX);
    let row = run(&browser, Source::Copy("mine.wgsl", &changed));
    assert!(!row.passed() && row.failed > CASES / 4, "{} failed", row.failed);
}
