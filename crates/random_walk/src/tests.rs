//! Checks the oracle against its definitions, and the statistics of the module.

use super::*;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// Returns the mean of a function over [0, 1] by the midpoints of `count` steps.
fn mean(count: u32, function: impl Fn(f64) -> f64) -> f64 {
    (0..count).map(|k| function((f64::from(k) + 0.5) / f64::from(count))).sum::<f64>() / f64::from(count)
}

#[test]
fn the_phase_function_is_a_density_whose_mean_cosine_is_g() {
    for g in [-0.9, -0.3, 0.0, 0.5, 0.85] {
        let moment = |power: i32| {
            4.0 * PI
                * mean(200_000, |u| {
                    let cosine = 2.0 * u - 1.0;
                    cosine.powi(power) * oracle::phase(cosine, g)
                })
        };
        assert!((moment(0) - 1.0).abs() < 1e-6 && (moment(1) - g).abs() < 1e-6, "{g}: {} {}", moment(0), moment(1));
    }
}

/// Checks that the share of deflections below a cosine is the integral of the phase function up to
/// it.
#[test]
fn deflections_follow_the_phase_function() {
    for g in [-0.8, -0.2, 1e-4, 1e-7, 0.0, 0.4, 0.7] {
        for u in [0.01, 0.3, 0.77, 0.999] {
            let cosine = oracle::deflection(u, g).x;
            let share = TAU * (cosine + 1.0) * mean(100_000, |t| oracle::phase((cosine + 1.0) * t - 1.0, g));
            assert!((share - u).abs() < 1e-6, "{g} {u}: {share}");
        }
    }
}

#[test]
fn both_ways_of_the_oracle_meet() {
    for u in [0.0, 1e-3, 0.4, 0.9999, 1.0] {
        let [below, above] = [0.999_999e-5, 1.000_001e-5].map(|g| oracle::deflection(u, g));
        assert!(below.distance(above) < 2e-10, "{u}: {below} {above}");
    }
}

/// Checks 2^16 numbers of neighbouring counters: mean, variance, correlation of words and of
/// neighbours, all within 4 standard errors.
#[test]
fn random_numbers_are_uniform_and_unrelated() {
    let count = 1u32 << 16;
    let numbers: Vec<[f64; 4]> = (0..count)
        .map(|walk| random(UVec4::new(7, walk, 3, 0)).to_array().map(|number| 12f64.sqrt() * (f64::from(number) - 0.5)))
        .collect();
    let error = 1.0 / f64::from(count).sqrt();
    for a in 0..4 {
        let sum = |term: &dyn Fn(usize) -> f64| (0..numbers.len()).map(term).sum::<f64>() / f64::from(count);
        assert!(sum(&|k| numbers[k][a]).abs() < 4.0 * error);
        // The square of a uniform number, scaled in this way, has the variance 4/5.
        assert!((sum(&|k| numbers[k][a].powi(2)) - 1.0).abs() < 4.0 * error);
        for b in 0..4 {
            let next = sum(&|k| numbers[k][a] * numbers[(k + 1) % numbers.len()][b]);
            let same = if a == b { 0.0 } else { sum(&|k| numbers[k][a] * numbers[k][b]) };
            assert!(next.abs() < 4.0 * error && same.abs() < 4.0 * error, "{a} {b}: {next} {same}");
        }
    }
}

/// Checks that the direction of a long walk keeps its length; without Newton's step it does not.
#[test]
fn a_hundred_thousand_turns_keep_unit_length() {
    let mut direction = Vec3::new(0.6, 0.0, -0.8);
    for step in 0..100_000 {
        let u = random(UVec4::new(1, 2, step, 0));
        direction = turn(direction, deflection(u.z, 0.8), azimuth(u.w));
        assert!((direction.as_dvec3().length() - 1.0).abs() < 1e-6, "{step}: {}", direction.length());
    }
}

/// Checks that Fresnel's reflectance conserves energy: crossing one way at an angle is as likely as
/// the other way at the refracted angle (Stokes).
#[test]
fn a_boundary_is_as_open_both_ways() {
    for index in [1.1, 1.5, 2.4] {
        for sine in [0.0f64, 0.3, 0.7, 0.95] {
            let into = DVec3::new(sine, 0.0, -(1.0 - sine * sine).sqrt());
            let out = oracle::boundary(into, DVec3::Z, index, 1.0).direction;
            let open = |direction: DVec3, index: f64, normal: DVec3| {
                mean(10_000, |u| f64::from(u8::from(oracle::boundary(direction, normal, index, u).crosses)))
            };
            let (there, back) = (open(into, index, DVec3::Z), open(-out, 1.0 / index, DVec3::NEG_Z));
            assert!((there - back).abs() < 2.1e-4, "{index} {sine}: {there} {back}");
        }
    }
}

/// Checks delta tracking through matter of density (1 + sin x)/2: the share that passes is e to the
/// minus the integral, and the mean of ratio tracking is the same.
#[test]
fn tracking_gives_the_mean_transmittance() {
    let (length, majorant) = (6.0f32, 0.7f32);
    let density = |x: f32| 0.5 * majorant * (1.0 + x.sin());
    let depth = 0.5 * f64::from(majorant) * (f64::from(length) + 1.0 - f64::from(length).cos());
    let walks = 200_000u32;
    let (mut passed, mut sum, mut squares) = (0u32, 0.0f64, 0.0f64);
    for walk in 0..walks {
        let (mut x, mut transmittance, mut alive) = (0.0, 1.0, true);
        for step in 0.. {
            let u = random(UVec4::new(5, walk, step, 0));
            x += free_path(u.x, majorant);
            if x >= length {
                break;
            }
            transmittance = ratio(transmittance, density(x), majorant);
            alive &= collision(u.y, 0.5 * density(x), 0.5 * density(x), majorant) == RANDOM_WALK_PASSED;
        }
        passed += u32::from(alive);
        sum += f64::from(transmittance);
        squares += f64::from(transmittance).powi(2);
    }
    let (walks, expected) = (f64::from(walks), (-depth).exp());
    let (delta, ratio) = (f64::from(passed) / walks, sum / walks);
    let errors = [(expected * (1.0 - expected) / walks).sqrt(), ((squares / walks - ratio * ratio) / walks).sqrt()];
    println!("{expected}: delta {delta} ± {}, ratio {ratio} ± {}", errors[0], errors[1]);
    assert!((delta - expected).abs() < 4.0 * errors[0] && (ratio - expected).abs() < 4.0 * errors[1]);
    assert!(errors[1] < errors[0]);
}

/// Checks that the mean of isotropic directions is 0 and the mean of their squares a third.
#[test]
fn isotropic_directions_favour_none() {
    let side = 64;
    let place = |k: u32| (f64::from(k) + 0.5) / f64::from(side);
    let directions = || (0..side * side).map(|k| oracle::isotropic(DVec2::new(place(k % side), place(k / side))));
    let count = f64::from(side * side);
    let (sum, squares) = directions().fold((DVec3::ZERO, DVec3::ZERO), |(sum, squares), v| (sum + v, squares + v * v));
    assert!((sum / count).length() < 1e-12 && (squares / count - 1.0 / 3.0).length() < 1e-4);
}
