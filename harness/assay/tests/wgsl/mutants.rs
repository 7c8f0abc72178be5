//! Mutation testing with a function's own test.

use super::{NOISE, exact_fade, fade};
use lapidary_assay::{Failure, wgsl};

/// On all of [0, 1] every change is noticed; a test of too small a range lets mutants survive, and
/// names them.
#[test]
fn a_test_of_too_little_lets_mutants_live() -> Result<(), Failure> {
    let test = |high: f32| {
        wgsl(NOISE, "fade")
            .mirror(fade)
            .oracle(exact_fade)
            .draws(move |draws| (draws.between(0.0, high),))
            .within("40 ulp")
    };
    let whole = test(1.0).mutate()?;
    assert!(whole.mutants >= 15, "{whole}");
    assert!(whole.survivors.is_empty(), "{whole}");
    let narrow = test(1e-9).mutate()?;
    assert!(!narrow.survivors.is_empty(), "{narrow}");
    assert!(narrow.to_string().contains("survived: fade | return t * t * t"), "{narrow}");
    Ok(())
}

#[test]
fn a_function_that_fails_its_own_test_has_no_score() {
    let wrong = wgsl(NOISE, "fade").mirror(|t: f32| t).draws(|draws| (draws.between(0.0, 1.0),));
    let message = wrong.mutate().expect_err("wrong").to_string();
    assert!(message.contains("does not pass its own test"), "{message}");
}
