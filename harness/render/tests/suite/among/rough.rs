//! Rough and partly clear bodies.

use super::*;
use lapidary_scene::Coverage;

fn rough(ior: f32, roughness: f32) -> Material {
    Material { roughness, ..glass(ior) }
}

/// Light of radiance 1 from everywhere leaves rough and partly clear bodies as it was: it goes on from facet to facet.
#[test]
fn rough_and_partly_clear_bodies_lose_no_light() {
    let smooth = |material: Material| Material { normals: Normals::File, ..material };
    let partly = |material: Material| Material { transmission: 0.4, ..material };
    let pane = Material { thickness: 0.0, ..rough(1.5, 0.5) };
    let scenes = [
        vec![ball(0.9, DVec3::ZERO, smooth(rough(1.5, 0.4)))],
        vec![Object::new("block", cube(0.7), rough(2.4, 1.0)), ball(0.3, DVec3::ZERO, glass(1.3))],
        vec![Object::new("block", cube(0.7), partly(rough(1.5, 0.7)))],
        vec![Object::new("block", cube(0.7), partly(glass(1.5)))],
        vec![Object::new("pane", cube(0.7), pane.clone()), ball(0.5, DVec3::ZERO, rough(1.5, 0.3))],
        vec![Object::new("pane", cube(0.7), partly(pane))],
    ];
    for (number, objects) in lapidary_testing::sampled(scenes.into_iter().enumerate(), 3) {
        for rung in ["scene-64", "reference"] {
            let picture = drawn(&scene(objects.clone()), &of_rung(rung));
            for (pixel, [.., coverage]) in colors(&picture).zip(&picture.linear) {
                let error = (pixel - 1.0).abs().max_element();
                assert!(*coverage < 1.0 || error < 2e-3, "scene {number}, {rung}: {pixel}, {:?}", picture.lost);
            }
        }
    }
}

/// A surface that is clear in part mixes what comes through with a matt surface of the same colour.
#[test]
fn a_partly_clear_surface_is_a_mixture() {
    let color = Vec3::new(0.8, 0.4, 0.1);
    for share in [0.25, 0.75] {
        let shell = Material { transmission: share, base_color: color, ..glass(1.0) };
        let objects = vec![Object::new("block", cube(1.0), shell), ball(0.5, DVec3::ZERO, matte(Vec3::splat(0.5)))];
        let expected = color.as_dvec3() * (f64::from(share) * 0.5 + f64::from(1.0 - share));
        for rung in ["by-material", "reference"] {
            let seen = middle(&drawn(&scene(objects.clone()), &of_rung(rung)));
            assert!((seen - expected).abs().max_element() < 3e-3, "{share}, {rung}: {seen} for {expected}");
        }
    }
}

/// Frosted glass before a matte ball and a sky with a horizon. A block's mean is one of 4096 trees of rays and of 65536 of
/// the reference's paths, each of at most 1: three standard errors are below 0.024 and 0.006.
#[test]
fn frosted_glass_is_as_the_reference_shows_it() {
    let pixels = (0..32).map(|place| if place < 16 { [1.0; 4] } else { [0.1, 0.2, 0.3, 1.0] }).collect();
    let environment = Environment::Map(EnvironmentMap { width: 2, height: 16, pixels });
    let behind = ball(0.4, DVec3::new(0.5, -0.4, -1.2), matte(Vec3::new(0.9, 0.1, 0.1)));
    let stretched = |material| Object::new("slab", cube(0.8), material);
    let smooth = Material { normals: Normals::File, ..rough(1.5, 0.35) };
    let pane = Material { thickness: 0.0, base_color: Vec3::new(0.6, 0.9, 1.0), ..rough(1.5, 0.5) };
    let partly = Material { transmission: 0.5, ..pane.clone() };
    let ball = ball(0.8, DVec3::ZERO, smooth);
    let bodies = [stretched(rough(1.5, 0.6)), ball, stretched(pane), stretched(partly)];
    for (number, body) in lapidary_testing::sampled(bodies.into_iter().enumerate(), 2) {
        let scene = scene(vec![body, behind.clone()]);
        let settings = |rung| Settings { environment: environment.clone(), samples: 8, ..of_rung(rung) };
        let [rung, truth] = ["scene-32", "reference"].map(|rung| blocks(&drawn(&scene, &settings(rung))));
        let error = rung.iter().zip(&truth).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f64::max);
        assert!(error < 0.03, "scene {number}: {error}");
    }
}

/// A surface that covers a share of what is behind it shows the rest: a matte one by itself, by the samples that it covers,
/// and one that a clear body shows.
#[test]
fn what_is_not_covered_is_seen() {
    let color = Vec3::new(0.8, 0.4, 0.1);
    let seen_with = |coverage, objects: fn(Object) -> Vec<Object>, rung: &str| {
        let screen = Material { coverage, ..matte(color) };
        let screen = Object::new("screen", cube(1.0).placed(DQuat::IDENTITY, -1.5 * DVec3::Z), screen);
        let settings = Settings { samples: 4, ..of_rung(rung) };
        middle(&drawn(&scene(objects(screen)), &settings))
    };
    let alone: fn(Object) -> Vec<Object> = |screen| vec![screen, ball(0.9, -4.0 * DVec3::Z, matte(Vec3::splat(0.5)))];
    let behind_glass: fn(Object) -> Vec<Object> = |screen| {
        let pane = Object::new("pane", cube(0.3), Material { thickness: 0.0, ..glass(1.0) });
        vec![pane, screen, ball(0.9, -4.0 * DVec3::Z, matte(Vec3::splat(0.5)))]
    };
    let blend = |share| Some(Coverage { share, cutoff: None });
    let mask = |share| Some(Coverage { share, cutoff: Some(0.5) });
    let covers = [(None, 1.0), (blend(0.25), 0.25), (blend(0.75), 0.75), (mask(0.4), 0.0), (mask(0.6), 1.0)];
    for (coverage, share) in lapidary_testing::sampled(covers, 3) {
        let expected = share * color.as_dvec3() + (1.0 - share) * 0.5;
        let of_scattering: fn(Object) -> Vec<Object> = |screen| {
            let far = Material { sigma0: Some(Vec3::ONE), ..matte(Vec3::splat(0.5)) };
            let pane = Object::new("pane", cube(0.3), Material { thickness: 0.0, ..glass(1.0) });
            vec![pane, screen, ball(0.9, -4.0 * DVec3::Z, far)]
        };
        let glazed = [(behind_glass, "scene-8"), (of_scattering, "scene-8"), (behind_glass, "reference")];
        for (objects, rung) in [(alone, "by-material")].into_iter().chain(glazed) {
            let seen = seen_with(coverage, objects, rung);
            assert!((seen - expected).abs().max_element() < 3e-3, "{coverage:?}, {rung}: {seen} for {expected}");
        }
    }
}
