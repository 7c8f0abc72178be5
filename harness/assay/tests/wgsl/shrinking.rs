//! A counterexample is simple, whatever the source of its inputs; and no test passes because
//! nothing was tested.

use super::NOISE;
use glam::IVec2;
use lapidary_assay::{Outcome, wgsl};
use proptest::prelude::*;

const STEP: &str = "fn step_from(x: i32, y: i32) -> i32 { if (x >= 700) { return y + 1; } return y; }";

/// proptest shrinks integers by halving: down to the edge itself only if each step back is tested
/// too.
#[test]
fn an_integer_of_a_strategy_shrinks_to_the_edge() {
    let test = wgsl(STEP, "step_from").mirror(|_: i32, y: i32| y).inputs((0i32..100_000, -50i32..50));
    let message = test.run().expect_err("wrong from 700 on").to_string();
    assert!(message.contains("step_from(i32(700), i32(0)) = i32(1)"), "{message}");
    assert!(message.contains("to keep it: .case((700, 0))"), "{message}");
}

#[test]
fn draws_shrink_to_the_edge() {
    let inputs = |draws: &mut lapidary_assay::draws::Draws<'_>| (draws.below(100_000).cast_signed(), 0);
    let test = wgsl(STEP, "step_from").mirror(|_: i32, y: i32| y).draws(inputs);
    let message = test.run().expect_err("wrong from 700 on").to_string();
    let x = message.split(".case((").nth(1).and_then(|rest| rest.split(',').next()?.parse::<i32>().ok());
    assert!(x.is_some_and(|x| (700..800).contains(&x)), "{message}");
}

#[test]
fn no_cases_are_no_test() {
    let corners = (any::<i32>(), any::<i32>()).prop_map(|(x, y)| (IVec2::new(x, y),));
    let message = wgsl(NOISE, "hash").mirror(super::hash).inputs(corners).cases(0).run().expect_err("nothing");
    assert!(message.to_string().contains("nothing would be tested"), "{message}");
}

#[test]
fn an_oracle_of_other_types_is_one_line() {
    let test = wgsl(NOISE, "fade").mirror(super::fade).oracle(|x: f64, _: f64| x).draws(|draws| (draws.unit() as f32,));
    let message = test.run().expect_err("two arguments").to_string();
    assert_eq!(message, "fade: the oracle is (f32, f32) -> f32 with f64 for f32, the mirror (f32) -> f32");
}

/// Run by the two tests below, which ask for another adapter.
#[test]
fn the_hash_alone() -> Outcome {
    let corners = (any::<i32>(), any::<i32>()).prop_map(|(x, y)| (IVec2::new(x, y),));
    wgsl(NOISE, "hash").mirror(super::hash).inputs(corners).cases(100).run()
}

fn without_an_adapter(skip: bool) -> (bool, String) {
    let mut command = std::process::Command::new(std::env::current_exe().expect("this program"));
    command.args(["the_hash_alone", "--exact", "shrinking::the_hash_alone"]);
    command.env("LAPIDARY_ADAPTER", "no such adapter").env_remove("ASSAY_WITHOUT_ADAPTER");
    if skip {
        command.env("ASSAY_WITHOUT_ADAPTER", "skip");
    }
    let output = command.output().expect("it runs");
    let text = [output.stdout, output.stderr].concat();
    (output.status.success(), String::from_utf8_lossy(&text).into_owned())
}

#[test]
fn without_an_adapter_a_test_fails_and_says_what_to_do() {
    let (passed, text) = without_an_adapter(false);
    assert!(!passed && text.contains("hash: no adapter matches `no such adapter`"), "{text}");
    assert!(text.contains("LAPIDARY_ADAPTER"), "{text}");
}

#[test]
fn a_skip_is_asked_for_and_seen() {
    let (passed, text) = without_an_adapter(true);
    assert!(passed && text.contains("assay: hash was not tested: no adapter"), "{text}");
}
