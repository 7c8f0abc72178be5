//! Inputs of the module: every magnitude, the ends, and beyond.

use glam::{Vec2, Vec3};
use lapidary_assay::draws::Draws;

/// Draws an alpha: every magnitude down to the clamp and below it, the ends, and beyond.
pub(super) fn alpha(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[1.0, 0.001, 0.0, -0.5, 2.0, 1.0f32.next_down()]),
        1..=3 => draws.magnitude(-12, -1),
        _ => draws.between(0.001, 1.0),
    }
}

/// Draws a cosine: every magnitude, the ends, and out of range.
pub(super) fn cosine(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => draws.pick(&[1.0, 0.0, -0.5, 1.5, f32::MIN_POSITIVE]),
        1 => draws.magnitude(-126, -1),
        2 => draws.magnitude(-24, -1),
        _ => draws.between(0.0, 1.0),
    }
}

/// Draws a metal's colour: black, white, and any.
pub(super) fn colour(draws: &mut Draws<'_>) -> Vec3 {
    match draws.below(6) {
        0 => draws.pick(&[Vec3::ZERO, Vec3::ONE, Vec3::splat(0.5), Vec3::X]),
        1 => Vec3::ONE - draws.magnitude(-24, -1),
        _ => Vec3::from_array([(); 3].map(|()| draws.between(0.0, 1.0))),
    }
}

/// Draws a unit vector, also along z and across it.
pub(super) fn axis(draws: &mut Draws<'_>) -> Vec3 {
    match draws.below(8) {
        0 => draws.pick(&[Vec3::Z, Vec3::NEG_Z, Vec3::X]),
        1 => draws.unit_vector().with_z(0.0).normalize_or(Vec3::Y),
        _ => draws.unit_vector(),
    }
}

/// Draws a random number as the shader has it: a multiple of 2^-24 in [0, 1).
pub(super) fn random(draws: &mut Draws<'_>) -> f32 {
    let u = match draws.below(6) {
        0 => draws.pick(&[0.0, 1.0f32.next_down(), 0.5]),
        1 => draws.magnitude(-23, -1),
        2 => 1.0 - draws.magnitude(-23, -1),
        _ => draws.between(0.0, 1.0),
    };
    (u * 16_777_216.0).floor().min(16_777_215.0) / 16_777_216.0
}

/// Draws the cosine and sine of any angle.
pub(super) fn azimuth(draws: &mut Draws<'_>) -> Vec2 {
    let turns = std::f64::consts::TAU * draws.unit();
    Vec2::new(turns.cos() as f32, turns.sin() as f32)
}
