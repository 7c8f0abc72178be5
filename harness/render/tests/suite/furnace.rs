//! The white furnace. Surrounded by radiance 1, a clear stone shows radiance 1 everywhere: light
//! that its surface does not reflect comes from inside, and the light still inside at the end of a
//! ray is taken from the environment as well.

use glam::Vec3;
use lapidary_plan::{Effect, Effects, Rung};
use lapidary_render as render;
use lapidary_render::Settings;
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{Camera, Environment, Light, Material, Medium, Object, Scene};
use std::f32::consts::PI;

/// Returns a bound on the rounding of sums of products with weights that add up to 1: one product
/// for every hit, over the 16 samples of a pixel.
fn bound(rung: Rung) -> f32 {
    (16 + 8 * rung.hits()) as f32 * f32::EPSILON
}

fn ones() -> Environment {
    Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[1.0; 4]; 8] })
}

#[test]
fn a_clear_stone_disappears() {
    for (name, rungs) in [
        ("brilliant", &["proxy-0", "proxy-1", "proxy-1+paper", "proxy-8+tracker", "convex-8+tracker", "bvh-4"][..]),
        ("octahedron", &["proxy-1", "convex-4+3", "triangles-2+tracker"]),
        ("prism", &["proxy-2+31", "convex-2+31"]),
        ("bunny_stone", &["proxy-1", "bvh-2+tracker"]),
    ] {
        let scene = Scene::named(name).expect("built in");
        for rung in rungs {
            let rung: Rung = rung.parse().expect(rung);
            let settings = Settings { environment: ones(), rung, ..Settings::of_size(128, 128) };
            let picture = render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered");
            let covered: Vec<&[f32; 4]> = picture.linear.iter().filter(|pixel| pixel[3] == 1.0).collect();
            assert!(covered.len() > 1000, "{name}: {} pixels", covered.len());
            for [r, g, b, _] in covered {
                assert!(
                    [r, g, b].iter().all(|value| (*value - 1.0).abs() <= bound(rung)),
                    "{name} {rung}: {r} {g} {b}"
                );
            }
        }
    }
}

#[test]
fn the_surface_alone_reflects_less() {
    let scene = Scene::named("brilliant").expect("built in");
    let settings = Settings { environment: ones(), rung: Rung::Surface, ..Settings::of_size(128, 128) };
    let picture = render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered");
    let covered = picture.linear.iter().filter(|pixel| pixel[3] == 1.0);
    // Diamond reflects 17.2 % at normal incidence and never less.
    assert!(covered.clone().count() > 1000);
    assert!(covered.into_iter().all(|[r, ..]| (0.1719..1.0).contains(r)));
}

/// Coefficients decide a body's colour whatever its base colour says: balls with radii of 40 and 4 mean free paths under a
/// sun have the colours that random walks give them.
#[test]
fn coefficients_decide_the_color() {
    let albedo = Vec3::new(0.98, 0.9, 0.6);
    let medium = Medium::isotropic(albedo, Vec3::ONE - albedo);
    let mean = |radius: f64, base_color: Vec3, rung: &str| {
        let material = Material { medium: Some(medium.clone()), base_color, ior: 1.0, ..Material::standard() };
        let ball = Object::new("ball", sphere(radius, 64), material);
        let camera = Camera::upright(Vec3::new(0.0, 0.0, 5.0 * radius as f32), Vec3::ZERO, 0.3);
        let lights = vec![Light::Directional { toward: Vec3::Z, irradiance: Vec3::splat(PI) }];
        let scene = Scene { objects: vec![ball], lights, camera, ..Scene::named("wax").expect("built in") };
        let without = Effects::of(&[Effect::Environment]);
        let rung: Rung = rung.parse().expect("a rung");
        let settings = Settings { without, half_space: true, rung, ..Settings::of_size(32, 32) };
        let picture = render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered");
        let covered = picture.linear.iter().filter(|pixel| pixel[3] == 1.0);
        let covered: Vec<Vec3> = covered.map(|[r, g, b, _]| Vec3::new(*r, *g, *b)).collect();
        covered.iter().sum::<Vec3>() / covered.len() as f32
    };
    let rungs: [(f64, &[&str]); 2] =
        [(40.0, &["by-material", "drift", "accurate", "diffusion-64", "godunov-64"]), (4.0, &["by-material"])];
    for (radius, rungs) in rungs {
        let truth = mean(radius, Vec3::ONE, "reference");
        for rung in rungs {
            let seen = mean(radius, Vec3::ONE, rung);
            println!("radius {radius}, {rung}: {seen}, by walks {truth}");
            assert!((seen - truth).abs().max_element() < 0.02, "radius {radius}, {rung}: {seen} for {truth}");
            assert_eq!(mean(radius, Vec3::new(0.2, 0.5, 0.9), rung), seen, "{rung}");
        }
    }
}
