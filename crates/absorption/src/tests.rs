//! Tests of the mirror against the oracle, and of the oracle against the standard library, known
//! values and the numbers of docs/absorption.md.

use super::*;
use glam::DVec3;
use lapidary_assay::extremum::larger;
use lapidary_assay::tolerance::ulp_of;

#[test]
fn the_oracle_is_the_logarithm_and_the_exponential() {
    for step in 0..20_000 {
        let transmittance = f64::from(f32::MIN_POSITIVE).powf(f64::from(step) / 20_000.0);
        let depth = oracle::optical_depth(transmittance);
        assert!((depth + transmittance.ln()).abs() <= 1e-14 * depth, "{transmittance:e} gives {depth}");
        let left = oracle::transmittance(DVec3::splat(depth), 1.0).x;
        assert!((left / transmittance - 1.0).abs() < 1e-12, "{depth} gives {left:e}");
    }
    let nearly_clear = 1.0 - f64::from(f32::EPSILON) / 2.0;
    assert!((oracle::optical_depth(nearly_clear) / -nearly_clear.ln() - 1.0).abs() < 1e-14);
}

#[test]
fn optical_depths_keep_their_digits_at_every_magnitude() {
    let mut worst: f64 = 0.0;
    let mut check = |transmittance: f32| {
        let exact = oracle::optical_depth(f64::from(transmittance));
        worst = larger(worst, (f64::from(optical_depth(transmittance)) - exact).abs() / ulp_of(exact));
    };
    // Every float just below 1, then every 997th float down to the smallest normal one.
    (1..100_000).for_each(|steps| check(f32::from_bits(1.0f32.to_bits() - steps)));
    (f32::MIN_POSITIVE.to_bits()..=1.0f32.to_bits()).step_by(997).for_each(|bits| check(f32::from_bits(bits)));
    assert!(worst <= 4.0, "{worst} ulp");
    assert_eq!(optical_depth(1.0).to_bits(), 0);
    assert_eq!(optical_depth(2.0), 0.0);
    assert_eq!(optical_depth(0.0), optical_depth(f32::MIN_POSITIVE));
    assert_eq!(optical_depth(-1.0), optical_depth(0.0));
}

#[test]
fn a_medium_shows_its_colour_at_its_distance() {
    let color = Vec3::new(0.9, 0.5, 0.01);
    for distance in [1e-4, 0.3, 1.0, 1e4] {
        let left = transmittance(coefficient(color, distance), distance);
        assert!((left / color - 1.0).abs().cmplt(Vec3::splat(1e-6)).all(), "{left}");
    }
}

#[test]
fn nothing_is_absorbed_where_nothing_can_be() {
    let dark = Vec3::new(0.5, 0.1, 0.0);
    for distance in [0.0, -0.0, -1.0, 1e30, f32::MAX, f32::INFINITY] {
        assert_eq!(coefficient(dark, distance), Vec3::ZERO);
    }
    assert_eq!(coefficient(Vec3::ONE, 1e-30), Vec3::ZERO);
    assert_eq!(transmittance(Vec3::ZERO, 1e6), Vec3::ONE);
    assert_eq!(transmittance(coefficient(dark, 1e-30), 0.0), Vec3::ONE);
    assert_eq!(transmittance(coefficient(dark, 1e-30), -1.0), Vec3::ONE);
}

#[test]
fn black_is_black_and_finite() {
    let coefficient = coefficient(Vec3::ZERO, 1e-37);
    assert!(coefficient.is_finite());
    assert_eq!(transmittance(coefficient, 1.0), Vec3::ZERO);
}
