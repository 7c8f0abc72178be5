//! The property tests of every formula, at the default number of cases, and of every naive form on its benign domain.

use lapidary_harness::check::{self, Source};
use lapidary_harness::formulas;
use lapidary_harness::property::Settings;

#[test]
fn every_formula_holds_over_its_domain() {
    let gpu = super::gpu();
    let mut faults = Vec::new();
    for formula in formulas::all() {
        let row = check::run(gpu, formula, Source::Cookbook, Settings::default()).expect("the check runs");
        assert!(row.cases >= Settings::default().cases);
        if !row.passed() {
            faults.push(format!(
                "{}: {} failed, {:?}, worst {}, shrunk {:?}, missed {:?}, {:?}",
                row.function,
                row.failed,
                row.reason,
                row.worst_input,
                row.shrunk_input,
                row.missed_edges,
                row.broken_hard_cases
            ));
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}
