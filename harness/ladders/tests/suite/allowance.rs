//! Bounds from theory: the largest error of every operation, propagated to the result to first
//! order, against the bound of each `Accuracy:` line. For any device the errors are those that WGSL
//! allows; for the reference device, the measured errors of its built-ins.

use lapidary_assay::interpreter::Program;
use lapidary_assay::property::{DEFAULT_CASES, Settings};
use lapidary_assay::slack::allowance::{self, Accuracy, Field, Wgsl};
use lapidary_assay::tolerance::Tolerance;
use lapidary_cook::check::{self, On, documentation};
use lapidary_cook::formulas;
use lapidary_cookbook as cookbook;
use lapidary_ladders::builtins::Lavapipe;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Bounds that are over 8 times the first-order allowance: function, field and reason. A line that
/// is no longer true fails.
const WIDE: [(&str, &str, &str); 2] = [
    ("bvh_trace_triangle", "barycentrics", "all fields allow the same backward error, and the distance needs it"),
    ("voxelization_span", "", "few triangles are so nearly edge-on that half a width of 64 is taken from as much"),
];

/// Unless the suite is run whole, one function in this many.
const ONE_IN: u64 = 4;

/// Returns the fields whose bound is below the largest allowance, or over 8 times the allowance that
/// includes the method's error, from a fixed seed.
fn unfitting(
    accuracy: &dyn Accuracy,
    tolerance: impl Fn(&lapidary_assay::formula::Formula) -> Tolerance,
) -> Vec<(String, Field)> {
    let settings = Settings { cases: DEFAULT_CASES / 4, ..Settings::default() };
    let mut found = Vec::new();
    // Those whose bounds are known to be wide are always looked at.
    let (wide, others): (Vec<_>, Vec<_>) =
        formulas::promised().partition(|formula| WIDE.iter().any(|(function, ..)| *function == formula.function));
    for formula in wide.into_iter().chain(lapidary_testing::sampled(others, ONE_IN)) {
        let module = cookbook::module(formula.module).expect("its module");
        let program = Program::new(module.whole, module.name, formula.function).expect("valid");
        let allowance = allowance::of_formula(&program, formula, &tolerance(formula), accuracy, settings);
        let allowance = allowance.expect("the interpreter runs it");
        assert!(allowance.rows > 0 || formula.arguments.is_empty(), "{}: first order says nothing", formula.function);
        let fields = allowance.fields.into_iter().filter(|field| !field.is_fitting());
        found.extend(fields.map(|field| (formula.function.to_owned(), field)));
    }
    found
}

fn fault(found: &[(String, Field)]) -> String {
    let mut text = String::new();
    let mut wide: BTreeSet<(&str, &str)> = WIDE.iter().map(|(function, field, _)| (*function, *field)).collect();
    for (function, Field { name, largest, with_method, .. }) in found {
        if *largest > 1.0 || !wide.remove(&(function.as_str(), name.as_str())) {
            let _ = writeln!(text, "{function} {name}: {largest:.3} of its bound, {with_method:.3} with the method");
        }
    }
    for (function, field) in wide {
        let _ = writeln!(text, "{function} {field}: not wide any more; take its line out");
    }
    text
}

#[test]
fn portable_bounds_are_what_wgsl_allows() {
    let on = On::Slack(lapidary_assay::slack::Reassociation::Written);
    let found = unfitting(&Wgsl, |formula| check::tolerance(on, formula));
    let fault = fault(&found);
    assert!(fault.is_empty(), "\n{fault}");
}

#[test]
fn lavapipe_bounds_are_what_its_record_allows() {
    let record = Lavapipe::recorded().expect("a record");
    let bounds_of = |formula: &lapidary_assay::formula::Formula| {
        lapidary_assay::examination::tolerance(formula, &documentation(formula).accuracy, true).expect("bounds")
    };
    let found = unfitting(&record, bounds_of);
    let fault = fault(&found);
    assert!(fault.is_empty(), "\n{fault}");
}
