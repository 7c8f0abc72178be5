//! The property tests of every formula, at the default number of cases, and of every naive form on
//! its benign domain: from the suite's seed, and from a second one.

use lapidary_assay::property::{Check, DEFAULT_CASES, Settings};
use lapidary_cook::check::{self, Source};
use lapidary_cook::formulas;
use lapidary_testing::seed::SuiteSeed;

/// Returns a line for each formula that does not hold. It ends with the command that runs the same
/// inputs again.
fn faults(seed: u64) -> Vec<String> {
    let gpu = lapidary_testing::gpu();
    let mut faults = Vec::new();
    for formula in formulas::all() {
        let run = |cases| {
            let settings = Settings { cases, seed };
            check::run(gpu, formula, Source::Cookbook, settings).expect("the check runs")
        };
        let mut row = run(DEFAULT_CASES);
        if row.failed == 0 && !row.missed_edges.is_empty() {
            // A rare edge, which a seed may miss by chance.
            row = run(16 * DEFAULT_CASES);
        }
        assert!(row.cases >= DEFAULT_CASES);
        if !row.passed() {
            faults.push(format!(
                "{}: {} failed, {:?}, worst {}, shrunk {:?}, missed {:?}, {:?}, {:?}, {:?}; again with: {}",
                row.function,
                row.failed,
                row.reason,
                row.worst_input,
                row.shrunk_input,
                row.missed_edges,
                row.broken_hard_cases,
                row.broken_promises,
                row.broken_branches,
                row.reproduce
            ));
        }
    }
    faults
}

#[test]
fn every_formula_holds_over_its_domain() {
    let faults = faults(lapidary_testing::seed());
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

/// Checks the random inputs only: promises and branches do not depend on a rare input.
#[test]
#[ignore = "long; .ci/full runs it"]
fn every_formula_holds_over_its_domain_from_a_second_seed() {
    lapidary_testing::seed();
    let gpu = lapidary_testing::gpu();
    let second = SuiteSeed::of_environment().expect("read above").second();
    let mut faults = Vec::new();
    for formula in formulas::all() {
        let mut kernel = check::kernel(gpu, formula, Source::Cookbook).expect("the cookbook's WGSL compiles");
        let tolerance = check::tolerance(gpu, formula);
        let settings = Settings { cases: DEFAULT_CASES, seed: second };
        let report = Check { formula, runner: &mut kernel, tolerance: &tolerance }.run(settings, &[]).expect("runs");
        if report.failed > 0 {
            let name = format!("{}::{}", formula.module, formula.function);
            faults.push(format!("{} failed: ./cook check {name} --seed {second}", report.failed));
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}
