use super::super::tests::{cuboid, estimate, grey, h, scene, seen, sun};
use super::*;
use crate::generator::generator;
use crate::random_walk::mesh::Boundary;
use crate::random_walk::{half_space, in_disc, isotropic};
use glam::{UVec3, Vec3};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::surfaces::{sphere, torus};
use lapidary_scene::{DensityGrid, Environment, Light, Medium, Mesh};
use lapidary_veins::VeinsPattern;
use std::f64::consts::PI;
use std::sync::Arc;

fn veins() -> Density {
    Density::Veins(VeinsPattern { frequency: 0.8, width: 0.3, least: 0.3, greatest: 1.6, octaves: 2, seed: 4 })
}

/// Returns a density of 1/2 throughout a body, from a grid that is 1 far away from the body: half
/// of all collisions are null.
fn split_grid(least: Vec3, greatest: Vec3) -> Density {
    let mut densities = vec![0.5; 64];
    densities[63] = 1.0;
    let wide = 4.0 * (greatest - least);
    Density::Grid(Arc::new(DensityGrid::new(least - wide, greatest + wide, UVec3::splat(4), densities).expect("sound")))
}

/// Returns a medium with doubled coefficients and half the density.
fn split(albedo: f32, least: Vec3, greatest: Vec3) -> Medium {
    let medium = grey(albedo);
    Medium {
        scattering: 2.0 * medium.scattering,
        absorption: 2.0 * medium.absorption,
        density: split_grid(least, greatest),
        ..medium
    }
}

fn white_room() -> Environment {
    Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[1.0; 4]; 8] })
}

fn deep_box() -> (Mesh, Vec3, Vec3) {
    let (least, greatest) = (Vec3::new(-400.0, -400.0, -100.0), Vec3::new(400.0, 400.0, 0.0));
    (cuboid(least, greatest), least, greatest)
}

fn towards(cosine: f64) -> DVec3 {
    DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine)
}

/// Tests delta tracking, null collisions and ratio tracking together, by the radiance of a half
/// space lit by a sun.
#[test]
fn a_density_split_by_a_grid_reflects_as_chandrasekhar_has_it() {
    for albedo in [0.5, 0.9, 0.99] {
        for (mu0, mu) in [(1.0, 1.0), (0.6, 0.8)] {
            let (body, least, greatest) = deep_box();
            let scene = scene(vec![(body, split(albedo as f32, least, greatest))], vec![sun(towards(mu0))]);
            let matter = Matter::new(&scene, Boundary::Matched, None).expect("media");
            let eye = towards(mu);
            let aside = DVec3::new(0.31, 0.17, 0.0);
            let (mean, error) = estimate(24_000, 3, |random| seen(&matter, aside + 3.0 * eye, -eye, random).radiance);
            let expected = albedo / (4.0 * PI) * mu0 / (mu + mu0) * h(mu, albedo) * h(mu0, albedo);
            println!("albedo {albedo}, {mu0} to {mu}: {:.5} ± {:.5}, expected {expected:.5}", mean.x, error.x);
            assert!((mean.x - expected).abs() < 4.0 * error.x && error.x < 0.03 * expected);
        }
    }
}

/// Returns the reflectance of a half space, from walks that leave it into a room of radiance 1. The
/// radiance seen along a ray is, in reverse, the reflected share of the light that arrives along
/// it.
fn given_back(medium: Medium, boundary: Boundary, ior: f32, cosine: f64) -> (f64, f64) {
    let (body, ..) = deep_box();
    let mut scene = scene(vec![(body, medium)], Vec::new());
    scene.objects[0].material.ior = ior;
    let room = white_room();
    let matter = Matter::new(&scene, boundary, Some(&room)).expect("media");
    let eye = towards(cosine);
    let (mean, error) = estimate(40_000, 5, |random| {
        let outcome = seen(&matter, DVec3::new(0.31, 0.17, 0.0) + 3.0 * eye, -eye, random);
        outcome.radiance
    });
    (mean.x, error.x)
}

#[test]
fn half_spaces_give_back_what_is_known() {
    for (albedo, normal) in [(0.5, 0.115226), (0.9, 0.414947), (0.99, 0.752721)] {
        let (_, least, greatest) = deep_box();
        let (mean, error) = given_back(split(albedo as f32, least, greatest), Boundary::Matched, 1.5, 1.0);
        println!("albedo {albedo}: {mean:.5} ± {error:.5}, expected {normal}");
        assert!((mean - normal).abs() < 4.0 * error);
    }
    for (albedo, index, cosine) in [(0.9f32, 1.5f32, 1.0), (0.99, 1.4, 0.4)] {
        let (mean, error) = given_back(grey(albedo), Boundary::Dielectric, index, cosine);
        let expected = half_space::reflectance_behind(cosine, albedo.into(), index.into());
        println!("albedo {albedo} behind {index}: {mean:.5} ± {error:.5}, expected {expected:.5}");
        assert!((mean - expected).abs() < 4.0 * error);
    }
}

/// If scattering goes deep, g matters only through 1 - g.
#[test]
fn forward_scattering_is_like_less_scattering() {
    let medium =
        |g: f32| Medium { anisotropy: g, ..Medium::isotropic(Vec3::splat(1.0 / (1.0 - g)), Vec3::splat(0.002)) };
    let (isotropic, error) = given_back(medium(0.0), Boundary::Matched, 1.0, 0.6);
    let (forwards, other) = given_back(medium(0.7), Boundary::Matched, 1.0, 0.6);
    println!("{isotropic:.4} ± {error:.4}, {forwards:.4} ± {other:.4}");
    assert!((forwards / isotropic - 1.0).abs() < 0.02 + 4.0 * error.hypot(other) / isotropic);
    let (unlike, _) = given_back(
        Medium { anisotropy: 0.7, ..Medium::isotropic(Vec3::ONE, Vec3::splat(0.02)) },
        Boundary::Matched,
        1.0,
        0.6,
    );
    assert!(unlike < 0.9 * isotropic);
}

/// The mean transmittance of a path through veins is e to the minus the optical depth.
#[test]
fn the_mean_transmittance_of_veins_is_beers() {
    let coefficients = Vec3::new(0.4, 0.9, 0.1);
    let medium = Medium { density: veins(), ..Medium::isotropic(Vec3::ZERO, coefficients) };
    let scene = scene(vec![(cuboid(Vec3::splat(-2.0), Vec3::splat(2.0)), medium)], Vec::new());
    let matter = Matter::new(&scene, Boundary::Matched, None).expect("media");
    let (from, steps) = (DVec3::new(0.3, 0.2, -2.0), 20_000);
    let depth: f64 = (0..steps)
        .map(|k| from + 4.0 * (f64::from(k) + 0.5) / f64::from(steps) * DVec3::Z)
        .map(|position| 4.0 / f64::from(steps) * f64::from(veins().at(position.as_vec3())))
        .sum();
    let expected = (-depth * coefficients.as_dvec3()).exp();
    let ray = Ray { position: from, direction: DVec3::Z };
    let by_ratio = estimate(40_000, 6, |random| matter.transmittance(0, ray, 4.0, random));
    let by_walks = estimate(80_000, 7, |random| seen(&matter, from - DVec3::Z, DVec3::Z, random).straight);
    for (mean, error) in [by_ratio, by_walks] {
        println!("{mean} ± {error}, expected {expected}");
        assert!((mean - expected).abs().cmplt(4.0 * error + 1e-4).all() && error.max_element() < 0.01);
    }
}

/// A medium without absorption shows a radiance of 1 under a radiance of 1 from all sides, whatever
/// its density, phase function and boundary.
#[test]
fn white_furnace() {
    let room = white_room();
    let white = |scattering: Vec3, anisotropy: f32, density: Density| Medium {
        anisotropy,
        density,
        ..Medium::isotropic(scattering, Vec3::ZERO)
    };
    for boundary in [Boundary::Matched, Boundary::Dielectric] {
        let ring = (torus(4.0, 1.5, 64, 32), white(Vec3::new(0.5, 1.0, 2.0), 0.6, veins()));
        let ball = (sphere(2.0, 64), white(Vec3::new(3.0, 0.2, 1.0), -0.5, Density::Uniform));
        let scene = scene(vec![ring, ball], Vec::new());
        let matter = Matter::new(&scene, boundary, Some(&room)).expect("media");
        let (mean, error) = estimate(160_000, 12, |random| {
            loop {
                let origin = 20.0 * isotropic(random);
                let through = 5.0 * random.random::<f64>() * isotropic(random);
                let direction = (through - origin).normalize();
                let Some(hit) = matter.enter(origin, direction) else { continue };
                let outcome = matter.walk(Ray { position: origin, direction }, hit, Beginnings::All, random);
                let all = outcome.radiance;
                assert!(outcome.lost || (all.element_sum() - 3.0).abs() < 1e-9, "{all}");
                break if outcome.lost { DVec3::ONE } else { all };
            }
        });
        println!("{boundary:?}: {mean} ± {error}");
        assert!((mean - 1.0).abs().cmplt(4.0 * error + 1e-12).all() && error.max_element() < 0.005);
    }
}

/// Connections through the boundary give the radiance of a half space lit by a sun, and by a lamp
/// so far away that it is a sun; light and eye may change places.
#[test]
fn half_spaces_behind_glass_shine_as_is_known() {
    for (albedo, index) in [(0.5f32, 1.5f32), (0.9, 1.4), (0.99, 1.4)] {
        for (mu0, mu) in [(1.0, 1.0), (0.4, 0.8), (0.8, 0.4)] {
            let (body, least, greatest) = deep_box();
            let far = 1e6 * towards(mu0);
            let lamp = Light::Point { position: far.as_vec3(), intensity: Vec3::splat(1e12) };
            for (light, medium) in [(sun(towards(mu0)), split(albedo, least, greatest)), (lamp, grey(albedo))] {
                let mut scene = scene(vec![(body.clone(), medium)], vec![light]);
                scene.objects[0].material.ior = index;
                let matter = Matter::new(&scene, Boundary::Dielectric, None).expect("media");
                let eye = DVec3::new(0.0, towards(mu).x, mu);
                let aside = DVec3::new(0.31, 0.17, 0.0);
                let sample = |random: &mut _| seen(&matter, aside + 3.0 * eye, -eye, random).radiance;
                let (mean, error) = estimate(24_000, 5, sample);
                let expected = mu0 * half_space::radiance_behind(mu, mu0, albedo.into(), index.into());
                println!(
                    "albedo {albedo} behind {index}, {mu0} to {mu}: {:.5} ± {:.5}, expected {expected:.5}",
                    mean.x, error.x
                );
                assert!((mean.x - expected).abs() < 4.0 * error.x && error.x < 0.03 * expected);
            }
        }
    }
}

/// A ball that absorbs nothing sends out what enters it and is scattered on its first way through.
/// The share that is scattered only after reflections inside is left to walks from the light.
#[test]
fn what_enters_a_ball_comes_out() {
    let index = 1.4;
    for radius in [0.5, 3.0] {
        let mut scene = scene(vec![(sphere(radius, 128), grey(1.0))], vec![sun(DVec3::Z)]);
        scene.objects[0].material.ior = index as f32;
        let matter = Matter::new(&scene, Boundary::Dielectric, None).expect("media");
        // Power that leaves: radiance times projected area, over all directions.
        let area = PI * radius * radius;
        let (mean, error) = estimate(60_000, 5, |random| {
            let (x, y) = in_disc(random);
            let toward = isotropic(random);
            let (a, b) = toward.any_orthonormal_pair();
            let origin = radius * (x * a + y * b) + 3.0 * radius * toward;
            4.0 * PI * area * seen(&matter, origin, -toward, random).radiance
        });
        let count = 2000;
        let expected: f64 = (0..count)
            .map(|k| (f64::from(k) + 0.5) / f64::from(count))
            .map(|sine| {
                let cosine = (1.0 - sine * sine).sqrt();
                let chord = 2.0 * radius * (1.0 - sine * sine / (index * index)).sqrt();
                let enters = 1.0 - lapidary_fresnel::oracle::dielectric(cosine, index);
                2.0 * area * sine / f64::from(count) * enters * -(-chord).exp_m1()
            })
            .sum();
        println!("radius {radius}: {:.4} ± {:.4}, expected {expected:.4}", mean.x, error.x);
        // The ball of triangles is smaller by a fraction of a percent.
        assert!((mean.x - expected).abs() < 4.0 * error.x + 3e-3 * expected && error.x < 0.02 * expected);
    }
}

#[test]
fn a_seed_gives_the_same_walk() {
    let scene = scene(vec![(sphere(3.0, 64), Medium { density: veins(), ..grey(0.9) })], vec![sun(DVec3::Z)]);
    let matter = Matter::new(&scene, Boundary::Matched, None).expect("media");
    let walk = |seed| seen(&matter, DVec3::new(0.0, 0.0, 9.0), DVec3::NEG_Z, &mut generator(seed, 0)).radiance;
    assert_eq!(walk(4), walk(4));
    assert_ne!(walk(4), walk(5));
}
