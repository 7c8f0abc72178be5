//! The catalogue of hard cases, on both sides: the stable form keeps to its limit, and the naive
//! form fails by at least the stated error. A case without a failure is not hard.

use lapidary_assay::examination::distance_from_limit;
use lapidary_assay::runner::Runner;
use lapidary_assay::shape::{Scalar, Shape};
use lapidary_cook::check::{self, Source};
use lapidary_cook::formulas;

#[test]
fn each_stable_form_holds_and_each_naive_form_fails() {
    if !lapidary_testing::on_lavapipe("limits and naive errors are stated for it; cook check tests the others") {
        return;
    }
    let gpu = lapidary_testing::gpu();
    let mut faults = Vec::new();
    let mut count = 0;
    for formula in formulas::all() {
        for case in &formula.hard_cases {
            count += 1;
            let name = format!("{}: {}", formula.function, case.name);
            let mut stable = check::kernel(gpu, formula, Source::Cookbook).expect("the cookbook's WGSL compiles");
            let distance = distance_from_limit(&mut stable, formula, &case.arguments, &case.limit).expect("runs");
            // A NaN fails.
            if distance.is_nan() || distance > case.bound {
                faults.push(format!("{name}: the stable form is off by {distance:e}, at most {:e}", case.bound));
            }
            let naive =
                formulas::of_function(case.naive).unwrap_or_else(|| panic!("{name}: no formula `{}`", case.naive));
            assert!(naive.benign.is_some(), "{name}: `{}` is not a naive form", case.naive);
            let mut kernel = check::kernel(gpu, naive, Source::Cookbook).expect("the cookbook's WGSL compiles");
            let error = distance_from_limit(&mut kernel, naive, &case.naive_arguments, &case.limit).expect("runs");
            let fails = if case.naive_error.is_infinite() {
                !error.is_finite()
            } else {
                error.is_nan() || error >= case.naive_error
            };
            if !fails {
                faults.push(format!("{name}: the naive form is off by {error:e} only, stated {:e}", case.naive_error));
            }
        }
    }
    assert!(count >= 40, "the catalogue holds {count} cases");
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn each_module_has_hard_cases() {
    for module in lapidary_cookbook::modules() {
        let count: usize = formulas::all().iter().filter(|f| f.module == module.name).map(|f| f.hard_cases.len()).sum();
        assert!(count > 0, "{} has none", module.name);
    }
}

/// Continuity: moving an input by its last place, up or down, moves the result as the mathematics
/// does.
#[test]
fn beside_each_hard_case_the_stable_form_follows_the_mathematics() {
    let gpu = lapidary_testing::gpu();
    let mut faults = Vec::new();
    for formula in formulas::all() {
        let tolerance = check::tolerance(gpu, formula);
        let scalars: Vec<Scalar> = formula.arguments.iter().flat_map(Shape::scalars).collect();
        let mut kernel = check::kernel(gpu, formula, Source::Cookbook).expect("the cookbook's WGSL compiles");
        for case in &formula.hard_cases {
            for (index, scalar) in scalars.iter().enumerate() {
                let value = f32::from_bits(case.arguments[index]);
                // Zero is exact: it has no last place.
                if *scalar != Scalar::F32 || !value.is_normal() {
                    continue;
                }
                for moved in [value.next_up(), value.next_down()] {
                    let mut arguments = case.arguments.clone();
                    arguments[index] = moved.to_bits();
                    let mut result = Vec::new();
                    kernel.run(&arguments, &mut result).expect("runs");
                    let (mirrored, exact) = (formula.mirrored(&arguments), formula.exact(&arguments));
                    let verdict = tolerance.judge(&arguments, &result, &mirrored, &exact, &*formula.oracle);
                    if !verdict.holds() {
                        faults.push(format!(
                            "{}: {}: word {index} at {moved:?}: {verdict:?}",
                            formula.function, case.name
                        ));
                    }
                }
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}
