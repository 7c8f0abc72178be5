//! The `Outside:` lines: each clause is a promise that is tested, with every formula, or is
//! declared to promise nothing. A false promise is detected.

use lapidary_assay::accuracy_line::Accuracy;
use lapidary_assay::outside::{Promise, accurate, any_bits, finite, holds, like};
use lapidary_assay::property::promises::broken;
use lapidary_cook::check::{self, Source};
use lapidary_cook::formulas;
use lapidary_cookbook as cookbook;

#[test]
fn every_clause_of_every_outside_line_is_a_promise_or_is_said_to_be_none() {
    let mut faults = Vec::new();
    let mut tested = 0;
    for module in cookbook::modules() {
        for function in module.functions.iter().filter(|function| !matches!(function.accuracy, Accuracy::Naive)) {
            let mut promises: Vec<&Promise> =
                formulas::of_function(&function.name).expect("a formula").promises.iter().collect();
            tested += promises.iter().filter(|promise| promise.is_tested()).count();
            // The longer ones first: `finite` may be a part of another.
            promises.sort_by_key(|promise| std::cmp::Reverse(promise.says.len()));
            let mut left = function.outside.clone();
            let mut said: Vec<&str> = promises.iter().map(|promise| promise.says).collect();
            said.dedup();
            for clause in said {
                if !left.contains(clause) {
                    faults.push(format!("{}: `{clause}` is no part of its line `{}`", function.name, function.outside));
                }
                left = left.replacen(clause, "", 1);
            }
            if left.chars().any(char::is_alphanumeric) {
                faults.push(format!(
                    "{}: neither tested nor said to promise nothing: `{}`",
                    function.name,
                    left.trim()
                ));
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
    println!("{tested} promises outside of domains are tested");
    assert!(tested >= 140, "{tested}");
}

/// Checks one promise of each kind, all false.
#[test]
fn a_promise_that_does_not_hold_is_noticed() {
    const FUNCTION: &str = "cdrf_lambert";
    let gpu = lapidary_testing::gpu();
    let formula = formulas::of_function(FUNCTION).expect("a formula");
    let mut kernel = check::kernel(gpu, formula, Source::Cookbook).expect("compiles");
    let tolerance = check::tolerance(gpu, formula);
    let root = formulas::of_function("refraction_relative_index").expect("a formula");
    let mut quotient = check::kernel(gpu, root, Source::Cookbook).expect("compiles");
    let of_quotient = check::tolerance(gpu, root);
    let mut faults_of = |promise: Promise| {
        let found = if promise.function == FUNCTION {
            broken(&mut kernel, formula, &tolerance, &[promise], 1)
        } else {
            broken(&mut quotient, root, &of_quotient, &[promise], 1)
        };
        found.expect("runs")
    };
    let faults = faults_of(finite(root.function, "finite", |_| (0.0f32, 1.0f32)));
    assert_eq!(faults.len(), 1);
    assert!(
        faults[0].contains("`finite`") && faults[0].contains("refraction_relative_index(0.0f, 1.0f)"),
        "{faults:?}"
    );
    assert_eq!(faults_of(accurate(root.function, "accurate", |draws| (any_bits(draws), any_bits(draws)))).len(), 1);
    let shifted = like(FUNCTION, "like", |draws| (draws.between(0.1, 0.5),), |(cosine,): (f32,)| (cosine + 0.1,));
    assert_eq!(faults_of(shifted).len(), 1);
    let wrong = holds(
        FUNCTION,
        "holds",
        |draws| (draws.between(0.1, 0.5),),
        |(cosine,): (f32,), result: f32| {
            if result > cosine { Ok(()) } else { Err("no".to_owned()) }
        },
    );
    assert_eq!(faults_of(wrong).len(), 1);
    // One that is true.
    assert!(faults_of(finite(FUNCTION, "finite", |draws| (draws.between(0.1, 0.5),))).is_empty());
}
