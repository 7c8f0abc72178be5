//! A homogeneous ball, in which every cheapest way is a straight chord.

use super::{RADIUS, ball, draw, lamp, settings, spot, sun};
use crate::pixels::on_the_ball;
use glam::{DVec3, Vec3};
use lapidary_harness::scene::{Light, Scene};
use lapidary_optical_path::oracle;
use std::f64::consts::PI;

/// Optical depths along the ball's radius.
const DEPTH: f64 = 8.0;
/// Costs beyond this many nats are not compared.
const DEEPEST: f64 = 12.0;

/// What enters the ball at the end of a unit vector.
fn entering(light: &Light, place: DVec3) -> f64 {
    let arrival = light.arrival(RADIUS * place);
    arrival.irradiance.x * place.dot(arrival.direction).max(0.0)
}

/// The most that comes to a point of the ball's surface, a unit vector, along any chord: the best of `places`, then a search about it.
fn along_chords(light: &Light, places: &[(DVec3, f64)], point: DVec3) -> f64 {
    let past = |place: DVec3| (-DEPTH * place.distance(point)).exp();
    let from = |place: DVec3| entering(light, place) * past(place);
    let best = places.iter().max_by(|a, b| (a.1 * past(a.0)).total_cmp(&(b.1 * past(b.0)))).expect("some").0;
    let own = (point, from(point));
    let (mut best, mut most) = if own.1 > from(best) { own } else { (best, from(best)) };
    let mut step = 0.05;
    while step > 1e-5 {
        let (right, up) = best.any_orthonormal_pair();
        let tried =
            [right, -right, up, -up].map(|way| (best + step * way).normalize()).map(|place| (place, from(place)));
        match tried.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((place, value)) if value > most => (best, most) = (place, value),
            _ => step *= 0.5,
        }
    }
    most
}

/// Evenly over the unit sphere: a Fibonacci lattice.
fn lattice(light: &Light) -> Vec<(DVec3, f64)> {
    let count = 4000;
    let place = |index: u32| {
        let z = 1.0 - (2.0 * f64::from(index) + 1.0) / f64::from(count);
        let (sine, cosine) = (f64::from(index) * PI * (3.0 - 5f64.sqrt())).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cosine, radius * sine, z)
    };
    let places = (0..count).map(place).map(|place| (place, entering(light, place)));
    places.filter(|(_, entering)| *entering > 0.0).collect()
}

fn lit_ball(light: Light) -> Scene {
    ball(DEPTH as f32, vec![light])
}

/// The root mean square of the errors in nats where there is a pixel, and the largest relative error where its own light is more than
/// what comes from anywhere else by a tenth.
fn errors(light: Light, wanted: impl Fn(DVec3) -> f64) -> (f64, f64) {
    let scene = lit_ball(light);
    let brightest = lattice(&light).iter().fold(0.0f64, |most, (_, entering)| most.max(*entering));
    let (mut squares, mut sum, mut count, mut worst_lit) = (0.0, 0.0, 0, 0.0f64);
    let (mut lit, mut dark) = (0, 0);
    for (position, found) in on_the_ball(&scene, &draw(&scene, &settings("godunov-64"))).into_iter().step_by(5) {
        assert!(found.x == found.y && found.y == found.z, "grey: {found}");
        let point = position.normalize();
        let (found, wanted, own) = (PI * found.x, wanted(point), entering(&light, point));
        if -(wanted / brightest).ln() > DEEPEST {
            continue;
        }
        squares += (found / wanted).ln().powi(2);
        sum += (found / wanted).ln();
        count += 1;
        if own >= 0.1 * brightest && own >= wanted * (1.0 - 1e-9) {
            worst_lit = worst_lit.max((found / own - 1.0).abs());
            lit += 1;
        }
        dark += i32::from(own == 0.0);
    }
    assert!(lit > 200 && dark > 300, "{lit} lit, {dark} dark of {count} pixels");
    let rms = (squares / f64::from(count)).sqrt();
    let mean = sum / f64::from(count);
    println!("rms {rms:.3} nats, mean {mean:.3}, over {count} pixels; lit ones off by {worst_lit:.1e} at most");
    (rms, worst_lit)
}

/// A pixel's place on the mesh of 256 columns is off the sphere by (2π / 256)² / 8 of its radius, and so are interpolated normals by less; at a cosine of
/// a tenth that is 3e-3 with the slant at which the camera sees it.
const LIT: f64 = 3e-3;

/// Godunov's update is of first order: over what the camera sees, mostly of the dark side, costs are too high by half the optical depth of a voxel or
/// so, 0.26 nats.
const SOLVED: f64 = 0.75 * DEPTH / 31.0;

#[test]
fn a_ball_under_a_sun_is_the_closed_form() {
    for toward in [Vec3::NEG_X, Vec3::Y, Vec3::new(-0.8, 0.6, 0.0)] {
        let light = Light::Directional { toward, irradiance: Vec3::splat(2.0) };
        let wanted = |point: DVec3| 2.0 * (-oracle::ball(DEPTH, DEPTH, point.angle_between(toward.as_dvec3()))).exp();
        let (rms, lit) = errors(light, wanted);
        // Along an axis, where fronts are planes along the grid, and half of the picture is lit.
        let bound = if toward == Vec3::Y { 0.1 } else { SOLVED };
        assert!(rms <= bound, "{toward}: {rms} nats");
        assert!(lit <= LIT, "{toward}: {lit}");
        // The search over chords finds the same.
        let places = lattice(&light);
        for (point, _) in places.iter().step_by(7) {
            let (searched, closed) = (along_chords(&light, &places, -*point), wanted(-*point));
            assert!((searched / closed).ln().abs() < 1e-6, "{searched} {closed}");
        }
    }
}

#[test]
fn balls_under_a_lamp_and_under_a_spot_are_the_best_of_all_chords() {
    for light in [lamp(), spot()] {
        let places = lattice(&light);
        let (rms, lit) = errors(light, |point| along_chords(&light, &places, point));
        assert!(rms <= SOLVED, "{light:?}: {rms} nats");
        assert!(lit <= LIT, "{light:?}: {lit}");
    }
}

/// A finer grid is nearer: what is left is the grid's.
#[test]
fn errors_fall_with_the_voxels() {
    let Light::Directional { toward, irradiance } = sun() else { panic!("a sun") };
    let scene = lit_ball(sun());
    let rms = ["godunov-32", "godunov-64", "godunov-128"].map(|rung| {
        let (mut squares, mut count) = (0.0, 0);
        for (position, found) in on_the_ball(&scene, &draw(&scene, &settings(rung))) {
            let cost = oracle::ball(DEPTH, DEPTH, position.angle_between(toward.as_dvec3()));
            if cost < DEEPEST {
                squares += ((PI * found.x / f64::from(irradiance.x)).ln() + cost).powi(2);
                count += 1;
            }
        }
        (squares / f64::from(count)).sqrt()
    });
    println!("32, 64 and 128 voxels: {rms:.3?} nats");
    assert!(rms[0] > 1.5 * rms[1] && rms[1] > 1.5 * rms[2] && rms[2] <= 0.1, "{rms:?}");
}
