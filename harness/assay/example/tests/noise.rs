//! Tests of the shader against the Rust code: a function to the bit, one within bounds, a kernel,
//! and a broken copy that must fail.

use glam::{IVec2, Vec2};
use lapidary_assay::{Failure, Outcome, kernel, mirror_struct, wgsl};
use proptest::prelude::*;
use value_noise::{corner, hash, sample};

const NOISE: &str = include_str!("../src/noise.wgsl");

#[derive(Clone, Copy, Debug)]
struct Sample {
    value: f32,
    slope: Vec2,
}

mirror_struct!(Sample { value, slope });

fn mirrored(place: Vec2) -> Sample {
    let value_noise::Sample { value, slope } = sample(place);
    Sample { value, slope }
}

fn places() -> impl Strategy<Value = (Vec2,)> {
    (-1000.0f32..1000.0, -1000.0f32..1000.0).prop_map(|(x, y)| (Vec2::new(x, y),))
}

#[test]
fn hashes_agree_to_the_bit() -> Outcome {
    wgsl(NOISE, "noise_hash")
        .mirror(hash)
        .inputs((any::<i32>(), any::<i32>()).prop_map(|(x, y)| (IVec2::new(x, y),)))
        .run()
}

#[test]
fn corners_are_in_their_range() -> Outcome {
    wgsl(NOISE, "noise_corner")
        .mirror(corner)
        .inputs((any::<i32>(), any::<i32>()).prop_map(|(x, y)| (IVec2::new(x, y),)))
        .invariant(
            "in [0, 1)",
            |_, value: f32| {
                if (0.0..1.0).contains(&value) { Ok(()) } else { Err(format!("{value}")) }
            },
        )
        .run()
}

/// A device may fuse products and sums: about twelve roundings of terms up to 2, and of slopes up
/// to 4.
const BOUNDS: &str = "value 2e-6 abs, slope 8e-6 abs";

#[test]
fn noise_is_within_rounding() -> Outcome {
    wgsl(NOISE, "noise_sample")
        .mirror(mirrored)
        .inputs(places())
        .edge("left of the origin", |(place,)| place.x < 0.0)
        .edge("near a corner", |(place,)| (place - place.round()).abs().max_element() < 0.01)
        .within(BOUNDS)
        .run()
}

#[test]
fn noise_holds_on_every_device() -> Outcome {
    wgsl(NOISE, "noise_sample")
        .mirror(mirrored)
        .inputs(places())
        .within_anywhere("value 4e-6 abs, slope 1.6e-5 abs")
        .run_anywhere()
}

#[test]
fn a_row_of_heights_is_filled() -> Outcome {
    kernel(NOISE, "fill")
        .mirror(|(scale, heights): &mut (f32, Vec<f32>)| {
            for (index, height) in heights.iter_mut().enumerate() {
                *height = sample(Vec2::new(index as f32 * *scale, 0.5)).value;
            }
        })
        .inputs((0.01f32..0.5, prop::collection::vec(Just(0.0f32), 1..300)))
        .edge("more than a workgroup", |(_, heights)| heights.len() > 64)
        .workgroups(|(_, heights)| [heights.len().div_ceil(64) as u32, 1, 1])
        .within("heights", "2e-6 abs")
        .run()
}

/// The copy truncates instead of rounding down. Right of the origin both agree; the test reports a
/// place at which they differ.
#[test]
fn a_broken_copy_fails_with_a_place_to_paste() {
    let broken = NOISE.replace("floor(place)", "trunc(place)");
    let failure = wgsl(broken, "noise_sample").mirror(mirrored).inputs(places()).within(BOUNDS).run();
    let message = failure.expect_err("it is broken").to_string();
    println!("{message}");
    assert!(message.contains("noise_sample(vec2f("), "{message}");
    assert!(message.contains("to keep it: .case((Vec2::new("), "{message}");
}

/// The tests above would notice every change to the hash.
#[test]
fn every_change_to_the_hash_is_noticed() -> Result<(), Failure> {
    let corners = (any::<i32>(), any::<i32>()).prop_map(|(x, y)| (IVec2::new(x, y),));
    let score = wgsl(NOISE, "noise_hash").mirror(hash).inputs(corners).mutate()?;
    println!("{score}");
    assert!(score.survivors.is_empty(), "{score}");
    Ok(())
}
