//! `wgsl/srgb.wgsl`.

mod outside;

use crate::{self as mirror, oracle};
use glam::Vec3;
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};

const M: &str = "srgb";

/// Light at which the pieces of the encoding meet.
const ENCODE_THRESHOLD: f32 = 0.003_130_8;
/// Code value at which the pieces of the decoding meet.
const DECODE_THRESHOLD: f32 = 0.040_45;

/// Code value at which they meet in the standard's drafts.
const DRAFT_THRESHOLD: f32 = 0.039_28;

/// Decodes with the curve of the drafts, its power from logarithms.
fn decode_of_the_drafts(encoded: f64) -> f64 {
    if encoded <= f64::from(DRAFT_THRESHOLD) { encoded / 12.92 } else { (2.4 * ((encoded + 0.055) / 1.055).ln()).exp() }
}

/// Draws a light or a code value: near a threshold, of any magnitude, in range or out of range.
fn value(draws: &mut Draws<'_>, threshold: f32) -> f32 {
    match draws.below(8) {
        0 => draws.pick(&[0.0, 1.0, 1.0f32.next_up(), -1.0, -1e-20, -1e19, 1e19]),
        1 | 2 => threshold * draws.between(0.95, 1.05),
        3 => draws.nudged(threshold, 4),
        4 => draws.magnitude(-40, 2),
        _ => draws.between(0.0, 1.0),
    }
}

fn color(draws: &mut Draws<'_>, threshold: f32) -> Vec3 {
    Vec3::new(value(draws, threshold), value(draws, threshold), value(draws, threshold))
}

/// Draws a radiance: dark or bright, grey or coloured, near the start of the shoulder or the end of
/// the toe, or negative.
fn radiance(draws: &mut Draws<'_>) -> Vec3 {
    let channel = |draws: &mut Draws<'_>| match draws.below(6) {
        0 => draws.magnitude(-40, 100),
        1 => draws.between(0.0, 0.2),
        2 => draws.between(0.7, 0.9),
        3 => -draws.magnitude(-20, 0),
        _ => draws.magnitude(-6, 6),
    };
    let first = channel(draws);
    match draws.below(4) {
        0 => Vec3::splat(first),
        1 => first * Vec3::new(1.0, draws.between(0.999_99, 1.0), draws.between(0.999_99, 1.0)),
        _ => Vec3::new(first, channel(draws), channel(draws)),
    }
}

/// Returns every function of the module, bound to its mirror and its oracle, with its promises
/// outside its domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [encoding_formulas(), decoding_formulas(), tone_formulas()].into_iter().flatten().collect()
}

fn encoding_formulas() -> Vec<Formula> {
    vec![
        formula(M, "srgb_encode", mirror::encode, oracle::encode, |draws| (value(draws, ENCODE_THRESHOLD),))
            .edge("just below the threshold", |(x,)| (0.99 * ENCODE_THRESHOLD..ENCODE_THRESHOLD).contains(&x))
            .edge("just above the threshold", |(x,)| (ENCODE_THRESHOLD..1.01 * ENCODE_THRESHOLD).contains(&x))
            .edge("negative", |(x,)| x < 0.0)
            .edge("above white", |(x,)| x > 1.0)
            .invariant("a code value", |_, code: f32| near("middle", f64::from(code) - 0.5, 0.0, 0.5 + 6e-6))
            .invariant("decodes to the light", |(x,), code: f32| {
                let light = f64::from(x).clamp(0.0, 1.0);
                near("light", oracle::decode(code.into()), light, 2.4 * 6e-6 * light + 1e-37)
            })
            .pair(
                "rises",
                |(x,)| (x * 1.01,),
                |(x,), code: f32, other: f32| {
                    if (other >= code) == (x >= 0.0) || other == code {
                        Ok(())
                    } else {
                        Err(format!("{code} at {x}, then {other}"))
                    }
                },
            )
            .hard_case("black", (0.0,), (&[0.0], 0.0), ("srgb_encode_naive", 0.05))
            .hard_case("light of -1e-20", (-1e-20,), (&[0.0], 0.0), ("srgb_encode_naive", f64::INFINITY))
            .hard_case("light of 5e-4", (5e-4,), (&[6.46e-3], 1e-8), ("srgb_encode_naive", 0.01))
            .hard_case("light of 1e19", (1e19,), (&[1.0], 2e-6), ("srgb_encode_naive", 1e7))
            .build(),
        formula(M, "srgb_encode_naive", mirror::encode_naive, oracle::encode, |draws| {
            (draws.between(ENCODE_THRESHOLD * 1.01, 1.0),)
        })
        .benign(1e-5)
        .build(),
        formula(M, "srgb_encode_gamma", mirror::encode_gamma, oracle::encode_gamma, |draws| (value(draws, 0.01),))
            .edge("black", |(x,)| x == 0.0)
            .edge("negative", |(x,)| x < 0.0)
            .edge("above white", |(x,)| x > 1.0)
            .build(),
        formula(M, "srgb_encode_color", mirror::encode_color, oracle::encode_color, |draws| {
            (color(draws, ENCODE_THRESHOLD),)
        })
        .edge("channels on both pieces", |(c,)| {
            c.min_element() > 0.0 && c.min_element() < ENCODE_THRESHOLD && c.max_element() > ENCODE_THRESHOLD
        })
        .build(),
    ]
}

fn decoding_formulas() -> Vec<Formula> {
    vec![
        formula(M, "srgb_decode", mirror::decode, oracle::decode, |draws| (value(draws, DECODE_THRESHOLD),))
            .edge("just below the threshold", |(x,)| (0.99 * DECODE_THRESHOLD..DECODE_THRESHOLD).contains(&x))
            .edge("just above the threshold", |(x,)| (DECODE_THRESHOLD..1.01 * DECODE_THRESHOLD).contains(&x))
            .edge("negative", |(x,)| x < 0.0)
            .edge("above white", |(x,)| x > 1.0)
            .invariant("display light", |_, light: f32| near("middle", f64::from(light) - 0.5, 0.0, 0.5 + 6e-6))
            .hard_case(
                "a code between the two thresholds",
                (0.04,),
                (&[0.04 / 12.92], 1e-8),
                ("srgb_decode_naive", 4e-7),
            )
            .hard_case("a code of -0.06", (-0.06,), (&[0.0], 0.0), ("srgb_decode_naive", 4e-3))
            .hard_case("a code of 1e19", (1e19,), (&[1.0], 2e-6), ("srgb_decode_naive", f64::INFINITY))
            .build(),
        // Compared with the curve that it implements, the one with the drafts' threshold. Its
        // difference from the standard is a hard case above.
        formula(M, "srgb_decode_naive", mirror::decode_naive, decode_of_the_drafts, |draws| {
            (match draws.below(4) {
                0 => draws.nudged(DRAFT_THRESHOLD, 1),
                1 => draws.between(0.001, 0.042),
                _ => draws.between(0.042, 1.0),
            },)
        })
        .benign(1e-5)
        .build(),
        formula(M, "srgb_decode_color", mirror::decode_color, oracle::decode_color, |draws| {
            (color(draws, DECODE_THRESHOLD),)
        })
        .edge("channels on both pieces", |(c,)| {
            c.min_element() > 0.0 && c.min_element() < DECODE_THRESHOLD && c.max_element() > DECODE_THRESHOLD
        })
        .build(),
    ]
}

fn tone_formulas() -> Vec<Formula> {
    vec![
        formula(M, "srgb_luminance", mirror::luminance, oracle::luminance, |draws| (radiance(draws).max(Vec3::ZERO),))
            .edge("white", |(c,)| c.x == c.y && c.y == c.z && c.x > 0.0)
            .edge("black", |(c,)| c == Vec3::ZERO)
            .invariant("between the smallest and the largest channel", |(c,), luminance: f32| {
                let (low, high) = (f64::from(c.min_element()), f64::from(c.max_element()));
                let value = f64::from(luminance);
                if value >= low * (1.0 - 1e-6) && value <= high * (1.0 + 1e-6) {
                    Ok(())
                } else {
                    Err(format!("{value} of {c}"))
                }
            })
            .build(),
        formula(M, "srgb_tone_curve", mirror::tone_curve, oracle::tone_curve, |draws| (radiance(draws),))
            .edge("in the toe", |(c,)| c.min_element() > 0.0 && c.min_element() < 0.08)
            .edge("on the shoulder", |(c,)| c.max_element() > 0.8)
            .edge("negative channels", |(c,)| c.min_element() < 0.0)
            .edge("very bright", |(c,)| c.max_element() > 1e20)
            .invariant("display light", |_, light: Vec3| {
                near("smallest", light.min_element().min(0.0).into(), 0.0, 0.0)?;
                near("largest", light.max_element().max(1.0).into(), 1.0, 3e-6)
            })
            .invariant_at_nearest("greys stay grey", |(c,), light: Vec3| {
                if c.x == c.y && c.y == c.z {
                    near("spread", f64::from(light.max_element() - light.min_element()), 0.0, 0.0)
                } else {
                    Ok(())
                }
            })
            .hard_case(
                "a grey of 1e-5",
                (Vec3::splat(1e-5),),
                (&[6.25e-10; 3], 1e-15),
                ("srgb_tone_curve_naive", 1e-13),
            )
            .hard_case(
                "a grey of 1e-8",
                (Vec3::splat(1e-8),),
                (&[6.25e-16; 3], 1e-21),
                ("srgb_tone_curve_naive", 1e-16),
            )
            .hard_case("a grey of -1", (Vec3::splat(-1.0),), (&[0.0; 3], 0.0), ("srgb_tone_curve_naive", 0.9))
            .build(),
        formula(M, "srgb_tone_curve_naive", mirror::tone_curve_naive, oracle::tone_curve, |draws| {
            let channel = |draws: &mut Draws<'_>| match draws.below(3) {
                0 => draws.between(0.02, 0.12),
                1 => draws.between(0.7, 1.0),
                _ => draws.between(0.02, 20.0),
            };
            (Vec3::new(channel(draws), channel(draws), channel(draws)),)
        })
        .benign(2e-5)
        .build(),
    ]
}
