//! The library as its README presents it: a function from outside the cookbook, tested by a plain
//! `cargo test`, and the message of a broken one.

mod kernels;
mod mutants;
mod readme;
mod shrinking;

use glam::Vec2;
use lapidary_assay::{Outcome, wgsl};

/// Parts of a noise function: a lattice's hash, a fade and a rotation.
const NOISE: &str = "
fn hash(corner: vec2i) -> u32 {
    var bits = u32(corner.x) * 0x9e3779b9u + u32(corner.y) * 0x85ebca6bu;
    bits = (bits ^ (bits >> 15u)) * 0x2c1b3c6du;
    return bits ^ (bits >> 12u);
}
fn fade(t: f32) -> f32 {
    return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}
fn rotated(point: vec2f, turns: f32) -> vec2f {
    let angle = 6.2831853f * turns;
    return vec2f(cos(angle) * point.x - sin(angle) * point.y, sin(angle) * point.x + cos(angle) * point.y);
}";

fn hash(corner: glam::IVec2) -> u32 {
    let bits = corner
        .x
        .cast_unsigned()
        .wrapping_mul(0x9e37_79b9)
        .wrapping_add(corner.y.cast_unsigned().wrapping_mul(0x85eb_ca6b));
    let bits = (bits ^ (bits >> 15)).wrapping_mul(0x2c1b_3c6d);
    bits ^ (bits >> 12)
}

fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

fn exact_fade(t: f64) -> f64 {
    t.powi(3) * (t * (t * 6.0 - 15.0) + 10.0)
}

#[test]
fn a_hash_is_its_mirrors_to_the_bit() -> Outcome {
    let corners = (proptest::num::i32::ANY, proptest::num::i32::ANY);
    let corners = proptest::strategy::Strategy::prop_map(corners, |(x, y)| (glam::IVec2::new(x, y),));
    wgsl(NOISE, "hash").mirror(hash).inputs(corners).run()
}

#[test]
fn fading_is_the_polynomial() -> Outcome {
    wgsl(NOISE, "fade")
        .mirror(fade)
        .oracle(exact_fade)
        .draws(|draws| (draws.between(0.0, 1.0),))
        .edge("near an end", |(t,)| t < 0.001)
        // Four roundings in each of two products of three factors, and a sum that cancels to a
        // tenth at t = 1.
        .within("40 ulp")
        .invariant(
            "between 0 and 1",
            |_, faded: f32| {
                if (0.0..=1.000_01).contains(&faded) { Ok(()) } else { Err(format!("{faded}")) }
            },
        )
        .case((1.0,))
        .run()
}

/// A wrong sign between two products is found, and the message gives an input to paste.
#[test]
fn a_broken_shader_fails_with_an_input_to_paste() {
    let mirror = |point: Vec2, turns: f32| Vec2::from_angle(std::f32::consts::TAU * turns).rotate(point);
    let inputs = || {
        proptest::strategy::Strategy::prop_map((-4.0f32..4.0, -4.0f32..4.0, 0.0f32..1.0), |(x, y, turns)| {
            (Vec2::new(x, y), turns)
        })
    };
    let right = wgsl(NOISE, "rotated").mirror(mirror).inputs(inputs()).within("1e-4 abs").run();
    assert_eq!(right, Ok(()));
    let broken = NOISE.replace("cos(angle) * point.x - sin", "cos(angle) * point.x + sin");
    let message = wgsl(broken, "rotated").mirror(mirror).inputs(inputs()).within("1e-4 abs").run().expect_err("broken");
    let message = message.to_string();
    for said in [
        "rotated: ",
        " inputs failed",
        "rotated(vec2f(",
        "expected vec2f(",
        "allowed ± ",
        "in Rust: rotated(Vec2::new(",
        "ASSAY_SEED=",
    ] {
        assert!(message.contains(said), "`{said}` is not in:\n{message}");
    }
}

#[test]
fn what_cannot_be_tested_is_said_in_a_line() {
    let one = |t: f32| (t,);
    let said = |source: &str, function: &'static str, within: &str| {
        let test =
            wgsl(source, function).mirror(|t: f32| t).draws(move |draws| one(draws.unit() as f32)).within(within);
        test.run().expect_err("refused").to_string()
    };
    for (source, function, within, part) in [
        ("fn f(t: f32) -> f32 { return t }", "f", "0 ulp", "expected"),
        ("fn f(t: f32) -> f32 { return t; }", "g", "0 ulp", "function `g` is missing"),
        ("fn f(t: vec2f) -> f32 { return t.x; }", "f", "0 ulp", "argument `t`: expected f32, found vec2f"),
        ("fn f(t: f32) -> f32 { return t; }", "f", "4 upl", "within: "),
        ("fn f(t: f32) -> f32 { return t; }", "f", "x 4 ulp", "within: bounds are for x"),
    ] {
        let message = said(source, function, within);
        assert!(message.contains(part), "{message}");
    }
}

/// An edge that no input reaches is a fault of the inputs.
#[test]
fn an_edge_that_is_not_reached_fails() {
    let test =
        wgsl("fn f(t: f32) -> f32 { return t; }", "f").mirror(|t: f32| t).draws(|draws| (draws.between(0.0, 1.0),));
    let message = test.edge("beyond", |(t,)| t > 2.0).run().expect_err("never reached").to_string();
    assert!(message.contains("no input reached `beyond`"), "{message}");
}
