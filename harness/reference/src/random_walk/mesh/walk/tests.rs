use super::*;

use crate::generator::generator;
use crate::random_walk::{BINS, Profile, in_disc, isotropic, profile};
use glam::{DQuat, Vec3};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::surfaces::{sphere, torus};
use lapidary_scene::{Averaging, Camera, Material, Mesh};
use rand::RngExt as _;
use rand::rngs::Xoshiro256PlusPlus;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Returns a box between these two corners.
pub(super) fn cuboid(least: Vec3, greatest: Vec3) -> Mesh {
    let corner = |k: u8| Vec3::select(glam::BVec3::new(k & 1 > 0, k & 2 > 0, k & 4 > 0), greatest, least);
    let faces: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices = faces.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
    Mesh::with_shared_normals((0..8).map(corner).collect(), indices, Averaging::Angle)
}

pub(super) fn scene(bodies: Vec<(Mesh, Medium)>, lights: Vec<Light>) -> Scene {
    let object = |(mesh, medium)| {
        let material = Material { medium: Some(medium), ..Material::standard() };
        Object::new("body", mesh, material)
    };
    let camera = Camera::framing([Vec3::ZERO].into_iter(), Vec3::Z, 0.5);
    Scene {
        name: "test".to_owned(),
        objects: bodies.into_iter().map(object).collect(),
        lights,
        light_radii: Vec::new(),
        environment: lapidary_scene::BuiltInEnvironment::Studio,
        camera,
        lacking: lapidary_scene::Lacking::default(),
    }
}

/// Returns a medium whose lengths are in mean free paths.
pub(super) fn grey(albedo: f32) -> Medium {
    Medium::isotropic(Vec3::splat(albedo), Vec3::splat(1.0 - albedo))
}

pub(super) fn sun(toward: DVec3) -> Light {
    Light::Directional { toward: toward.as_vec3(), irradiance: Vec3::ONE }
}

/// Returns the mean of a sample and its standard error.
pub(super) fn estimate(
    count: u32,
    seed: u64,
    sample: impl Fn(&mut Xoshiro256PlusPlus) -> DVec3 + Sync,
) -> (DVec3, DVec3) {
    const BATCHES: u32 = 16;
    let batch = |batch: u32| {
        let mut random = generator(seed, batch.into());
        (0..count / BATCHES).fold((DVec3::ZERO, DVec3::ZERO), |(sum, squares), _| {
            let value = sample(&mut random);
            (sum + value, squares + value * value)
        })
    };
    let parts: Vec<(DVec3, DVec3)> = (0..BATCHES).into_par_iter().map(batch).collect();
    let (sum, squares) = parts.into_iter().fold((DVec3::ZERO, DVec3::ZERO), |a, b| (a.0 + b.0, a.1 + b.1));
    let count = f64::from(count / BATCHES * BATCHES);
    let mean = sum / count;
    (mean, ((squares / count - mean * mean).max(DVec3::ZERO) / count).map(f64::sqrt))
}

/// Returns the outcome of a ray: its radiance, and its throughput if nothing scatters it.
pub(super) fn seen(matter: &Matter<'_>, origin: DVec3, direction: DVec3, random: &mut Xoshiro256PlusPlus) -> Outcome {
    let Some(hit) = matter.enter(origin, direction) else { return Outcome::default() };
    let outcome = matter.walk(Ray { position: origin, direction }, hit, Beginnings::All, random);
    assert!(!outcome.lost);
    outcome
}

/// Returns the light from the lights at a point in the first body, times the phase function.
fn direct(matter: &Matter<'_>, from: DVec3, random: &mut Xoshiro256PlusPlus) -> DVec3 {
    let mut sum = DVec3::ZERO;
    let ray = Ray { position: from, direction: DVec3::X };
    matter.connect(Targets::Lights(&matter.lights), ray, 0, random, &mut |_, value| sum += value).expect("no gap");
    sum
}

/// Samples the hemisphere around a unit normal in proportion to the cosine.
fn diffuse(normal: DVec3, random: &mut Xoshiro256PlusPlus) -> DVec3 {
    let (x, y) = in_disc(random);
    let (a, b) = normal.any_orthonormal_pair();
    x * a + y * b + (1.0 - x * x - y * y).max(0.0).sqrt() * normal
}

/// Compares walks from the eye through a sphere of triangles with walks from the light through a
/// ball: the exitance by the angle from the light.
#[test]
fn spheres_show_what_leaves_them() {
    for (radius, albedo) in [(2.0, 0.9), (2.0, 1.0), (10.0, 0.9), (10.0, 1.0)] {
        let scene = scene(vec![(sphere(radius, 256), grey(albedo))], vec![sun(DVec3::Z)]);
        let matter = Matter::new(&scene, Boundary::Matched, None).expect("media");
        let expected = profile(radius, f64::from(albedo), 400_000, 21);
        let (mut total, mut expected_total, mut variance) = (0.0, 0.0, 0.0);
        let (mut deviations, mut compared) = (Vec::new(), 0);
        for bin in 0..BINS {
            let [greater, less] = Profile::cosines(bin);
            // Radiant exitance is pi times the mean radiance over cosine-distributed directions.
            let (mean, error) = estimate(3200, bin as u64, |random| {
                let cosine = less + (greater - less) * random.random::<f64>();
                let (y, x) = (TAU * random.random::<f64>()).sin_cos();
                let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
                let normal = DVec3::new(sine * x, sine * y, cosine);
                let towards = diffuse(normal, random);
                PI * seen(&matter, radius * (normal + 3.0 * towards), -towards, random).radiance
            });
            let (found, error) = (mean.x, error.x);
            let (exitance, exitance_error) = (expected.exitance[bin], expected.standard_error[bin]);
            let area = 2.0 * (greater - less);
            total += area * found;
            expected_total += area * exitance;
            variance += area * area * (error * error + exitance_error * exitance_error);
            // With fewer than 25 walks, the error is not known.
            if exitance_error < 0.2 * exitance {
                deviations.push((found - exitance) / error.hypot(exitance_error));
                compared += 1;
            }
        }
        let largest = deviations.iter().fold(0.0, |largest: f64, deviation| largest.max(deviation.abs()));
        let squares: f64 = deviations.iter().map(|deviation| deviation * deviation).sum();
        println!(
            "radius {radius}, albedo {albedo}: {compared} bins, largest deviation {largest:.2} errors, rms {:.2}; \
             in all {total:.5}, expected {expected_total:.5} ± {:.5}",
            (squares / f64::from(compared)).sqrt(),
            variance.sqrt()
        );
        assert!(compared >= 15 && largest < 4.0);
        // A sum of squares of n normal deviates is n ± sqrt(2 n).
        assert!(squares < f64::from(compared) + 4.0 * (2.0 * f64::from(compared)).sqrt(), "{deviations:?}");
        assert!((total - expected_total).abs() < 4.0 * variance.sqrt());
    }
}

/// Returns Chandrasekhar's H function of isotropic scattering, after Stibbs and Weir ("On the
/// H-functions for isotropic scattering", 1959).
///
/// ln H = -mu/pi times the integral of ln(1 - albedo phi cot phi) / (cos^2 phi + mu^2 sin^2 phi)
/// over phi from 0 to pi/2.
pub(super) fn h(mu: f64, albedo: f64) -> f64 {
    const STEPS: u32 = 2000;
    let sum: f64 = (0..STEPS)
        .map(|k| FRAC_PI_2 * (f64::from(k) + 0.5) / f64::from(STEPS))
        .map(|phi| (1.0 - albedo * phi / phi.tan()).ln() / (phi.cos().powi(2) + (mu * phi.sin()).powi(2)))
        .sum();
    (-mu / PI * sum * FRAC_PI_2 / f64::from(STEPS)).exp()
}

/// A half space lit at the cosine mu0 by light of irradiance E, measured perpendicular to the
/// light, shows at the cosine mu the radiance I = albedo E / (4 pi) mu0 / (mu + mu0) H(mu) H(mu0)
/// (Chandrasekhar, "Radiative Transfer", on principles of invariance, with pi F for E).
///
/// A thin layer dt added on top changes nothing. It removes (1/mu + 1/mu0) I dt along both paths
/// and scatters the same amount, albedo E / (4 pi mu) dt for the direct light. The light returned
/// by the half space multiplies this by H(mu0) on the way in and by H(mu) on the way to the eye.
#[test]
fn a_wide_deep_box_reflects_as_chandrasekhar_has_it() {
    let mut deviations = Vec::new();
    for (albedo, normal) in [(0.5, 0.115226), (0.9, 0.414947), (0.99, 0.752721)] {
        assert!((1.0 - h(1.0, albedo) * (1.0 - albedo).sqrt() - normal).abs() < 1e-5);
        let body = cuboid(Vec3::new(-400.0, -400.0, -100.0), Vec3::new(400.0, 400.0, 0.0));
        for (mu0, mu, azimuth) in [(1.0, 1.0, 0.0), (0.6, 1.0, 0.0), (0.3, 0.8, 2.0), (0.9, 0.2, 1.0)] {
            let towards = |cosine: f64, azimuth: f64| {
                let (sine, (y, x)) = ((1.0 - cosine * cosine).sqrt(), f64::sin_cos(azimuth));
                DVec3::new(sine * x, sine * y, cosine)
            };
            let scene = scene(vec![(body.clone(), grey(albedo as f32))], vec![sun(towards(mu0, 0.0))]);
            let matter = Matter::new(&scene, Boundary::Matched, None).expect("media");
            let eye = towards(mu, azimuth);
            let aside = DVec3::new(0.31, 0.17, 0.0);
            let (mean, error) = estimate(16_000, deviations.len() as u64, |random| {
                seen(&matter, aside + 3.0 * eye, -eye, random).radiance
            });
            let expected = albedo / (4.0 * PI) * mu0 / (mu + mu0) * h(mu, albedo) * h(mu0, albedo);
            println!("albedo {albedo}, {mu0} to {mu}: {:.5} ± {:.5}, expected {expected:.5}", mean.x, error.x);
            assert!((mean.x - expected).abs() < 4.0 * error.x && error.x < 0.02 * expected);
            deviations.push((mean.x / expected - 1.0, error.x / expected));
        }
    }
    // Together, the deviations determine the scale better than each alone.
    let count = deviations.len() as f64;
    let deviation = deviations.iter().map(|(deviation, _)| deviation).sum::<f64>() / count;
    let error = deviations.iter().map(|(_, error)| error * error).sum::<f64>().sqrt() / count;
    println!("in the mean off by {deviation:.5} ± {error:.5}");
    assert!(deviation.abs() < 4.0 * error && error < 0.003);
}

/// A medium without absorption shows a radiance of 1 under a radiance of 1 from all sides, whatever
/// its shape: each walk with f64 accuracy in the mean over its channels, and each channel in the
/// mean over the walks.
#[test]
fn white_furnace() {
    let ones = Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[1.0; 4]; 8] });
    let white = |scattering| Medium::isotropic(scattering, Vec3::ZERO);
    let ring = torus(4.0, 1.5, 64, 32);
    let ball = sphere(2.0, 64);
    let bodies = vec![(ring, white(Vec3::new(0.5, 1.0, 2.0))), (ball, white(Vec3::new(3.0, 0.2, 1.0)))];
    let scene = scene(bodies, Vec::new());
    let matter = Matter::new(&scene, Boundary::Matched, Some(&ones)).expect("media");
    let sample = |random: &mut Xoshiro256PlusPlus| {
        // Rays come from all sides and pass through one body or both.
        let (towards, around) = (isotropic(random), isotropic(random));
        loop {
            let through = 5.0 * random.random::<f64>() * isotropic(random);
            let origin = through + 20.0 * (towards + 0.1 * around);
            let direction = (through - origin).normalize();
            let outcome = seen(&matter, origin, direction, random);
            let all = outcome.radiance;
            if all != DVec3::ZERO {
                assert!((all.element_sum() - 3.0).abs() < 1e-9, "{all}");
                return all;
            }
        }
    };
    let (mean, error) = estimate(40_000, 3, sample);
    println!("{mean} ± {error}");
    assert!((mean - 1.0).abs().cmplt(4.0 * error).all() && error.max_element() < 0.01);
}

/// Returns bodies crossed by rays along z: one of two parts around one of another medium.
pub(super) fn layers() -> Vec<(Mesh, Medium)> {
    let layer = |from: f32, to: f32| cuboid(Vec3::new(-1.0, -1.0, from), Vec3::new(1.0, 1.0, to));
    let mut outer = layer(0.0, 1.0);
    outer.append(&layer(4.0, 6.0));
    let medium = |scattering, absorption| Medium::isotropic(scattering, absorption);
    vec![
        (outer, medium(Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.01, 0.0, 0.05))),
        (layer(2.0, 3.0), medium(Vec3::new(0.3, 0.1, 0.0), Vec3::ZERO)),
    ]
}

/// From z = 0.25, inside the first part, the path crosses 0.75 of the first medium, 1 of the second
/// and 2 of the first again. Toward a light, only the matter before the light counts.
#[test]
fn light_is_weakened_by_all_matter_on_its_way() {
    let [first, second] = [DVec3::new(0.11, 0.2, 0.35), DVec3::new(0.3, 0.1, 0.0)];
    let lamp = |z: f32| Light::Point { position: Vec3::new(0.125, 0.25, z), intensity: Vec3::ONE };
    // On its axis, a spot is a point light.
    let spot = |direction| Light::Spot {
        position: Vec3::new(0.125, 0.25, 5.0),
        direction,
        intensity: Vec3::ONE,
        inner_angle: 0.1,
        outer_angle: 0.2,
    };
    let cases = [
        (spot(Vec3::NEG_Z), 4.75, 1.75 * first + second),
        (sun(DVec3::Z), 1.0, 2.75 * first + second),
        (sun(-DVec3::Z), 1.0, 0.25 * first),
        (lamp(10.0), 9.75, 2.75 * first + second),
        (lamp(5.0), 4.75, 1.75 * first + second),
        (lamp(3.5), 3.25, 0.75 * first + second),
        (lamp(2.5), 2.25, 0.75 * first + 0.5 * second),
        (lamp(1.5), 1.25, 0.75 * first),
        (lamp(0.5), 0.25, 0.25 * first),
    ];
    for (light, distance, depth) in cases {
        let scene = scene(layers(), vec![light]);
        let matter = Matter::new(&scene, Boundary::Matched, None).expect("media");
        let from = DVec3::new(0.125, 0.25, 0.25);
        let found = direct(&matter, from, &mut generator(1, 0));
        let expected = (-depth).exp() / (4.0 * PI * distance * distance);
        assert!((found / expected - 1.0).abs().max_element() < 1e-6, "{light:?}: {found}, expected {expected}");
    }
    let away = scene(layers(), vec![spot(Vec3::Z)]);
    let from = DVec3::new(0.125, 0.25, 0.25);
    let matter = Matter::new(&away, Boundary::Matched, None).expect("media");
    assert_eq!(direct(&matter, from, &mut generator(1, 0)), DVec3::ZERO);
}

/// Beyond the depth up to which a way out is always searched for, the mean is the same.
#[test]
fn a_deep_point_gets_its_light_in_the_mean() {
    let body = cuboid(Vec3::splat(-8.0), Vec3::splat(8.0));
    let medium = Medium::isotropic(Vec3::new(0.3, 0.4, 0.2), Vec3::ZERO);
    let lamp = Light::Point { position: Vec3::new(0.0, 0.0, -7.0), intensity: Vec3::splat(49.0) };
    for (light, way) in [(sun(DVec3::Z), 8.0), (lamp, 7.0)] {
        let scene = scene(vec![(body.clone(), medium.clone())], vec![light]);
        let matter = Matter::new(&scene, Boundary::Matched, None).expect("media");
        let from = DVec3::new(0.1, 0.2, 0.0);
        let (mean, error) = estimate(40_000, 9, |random| direct(&matter, from, random));
        let expected = (-way * medium.scattering.as_dvec3()).exp() / (4.0 * PI);
        println!("{mean} ± {error}, expected {expected}");
        // The lamp is slightly off the axis.
        assert!((mean - expected).abs().cmplt(4.0 * error + 2e-3 * expected).all());
    }
}

/// A purely absorbing medium sends out no scattered light; light passes through it by the
/// Beer-Lambert law.
#[test]
fn what_goes_straight_through_is_weakened_and_no_more() {
    let scene = scene(layers(), vec![sun(DVec3::X)]);
    let matter = Matter::new(&scene, Boundary::Matched, None).expect("media");
    let origin = DVec3::new(0.1, 0.2, -5.0);
    let (mean, error) = estimate(40_000, 2, |random| seen(&matter, origin, DVec3::Z, random).straight);
    let expected = (-3.0 * DVec3::new(0.11, 0.2, 0.35) - DVec3::new(0.3, 0.1, 0.0)).exp();
    println!("{mean} ± {error}, expected {expected}");
    assert!((mean - expected).abs().cmplt(4.0 * error).all());

    let absorbing = Medium::isotropic(Vec3::ZERO, Vec3::new(0.0, 1.0, 0.2));
    let bodies = vec![(cuboid(Vec3::NEG_ONE, Vec3::ONE), absorbing.clone())];
    let scene = self::scene(bodies, vec![sun(DVec3::X)]);
    let matter = Matter::new(&scene, Boundary::Matched, None).expect("media");
    let (mean, error) = estimate(40_000, 4, |random| {
        let outcome = seen(&matter, origin, DVec3::Z, random);
        assert_eq!(outcome.radiance, DVec3::ZERO);
        outcome.straight
    });
    let expected = (-2.0 * absorbing.absorption.as_dvec3()).exp();
    println!("{mean} ± {error}, expected {expected}");
    assert!((mean - expected).abs().cmplt(4.0 * error).all());
}

/// One walk of three channels gives the same means as a walk for each channel. In a grey medium,
/// the statistics of a walk are those of each channel.
#[test]
fn channels_do_not_mix() {
    let medium = Medium::isotropic(Vec3::new(0.74, 0.88, 1.5), Vec3::new(0.032, 0.17, 2.0));
    let body = torus(4.0, 1.5, 64, 32).placed(DQuat::from_rotation_x(0.7), DVec3::ZERO);
    let lamp = Light::Point { position: Vec3::new(0.0, 0.0, 0.5), intensity: Vec3::splat(10.0) };
    let mean = |medium: &Medium| {
        let scene = scene(vec![(body.clone(), medium.clone())], vec![sun(DVec3::new(0.6, 0.8, 0.0)), lamp]);
        let matter = Matter::new(&scene, Boundary::Matched, None).expect("media");
        estimate(100_000, 17, |random| {
            let (x, y) = in_disc(random);
            seen(&matter, DVec3::new(6.0 * x, 6.0 * y, 20.0), DVec3::NEG_Z, random).radiance
        })
    };
    let (all, all_error) = mean(&medium);
    for channel in 0..3 {
        let only = |color: Vec3| Vec3::splat(color[channel]);
        let (one, error) = mean(&Medium::isotropic(only(medium.scattering), only(medium.absorption)));
        println!(
            "channel {channel}: {:.5} ± {:.5}, alone {:.5} ± {:.5}",
            all[channel], all_error[channel], one[channel], error[channel]
        );
        assert!((one.max_element() - one.min_element()).abs() < 1e-9 * one.x);
        let error = all_error[channel].hypot(error[channel]);
        assert!((all[channel] - one[channel]).abs() < 4.0 * error && error < 0.02 * one[channel]);
    }
}
