//! Translucent stone as a whole, from the mesh to the picture: against closed forms, ray queries
//! and itself, and with difficult bodies.

mod ball;
mod hard;
mod media;
mod notes;
mod shadows;

use glam::Vec3;
use lapidary_assay::extremum::larger;
use lapidary_plan::{Effect, Effects};
use lapidary_render as render;
use lapidary_render::{OpticalPathOptions, Picture, Settings};
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{Light, Material, Medium, Mesh, Object, Scene};

/// Side of pictures that are compared pixel by pixel.
const SIDE: u32 = 160;
/// Radius of the balls.
const RADIUS: f64 = 10.0;

/// Returns settings for paths and lights only: no environment, no reflecting surface. Media are not
/// scaled.
fn settings(rung: &str) -> Settings {
    Settings {
        rung: rung.parse().expect(rung),
        samples: 1,
        without: Effects::of(&[Effect::Environment]).and(Effects::SHEEN),
        optical_path: OpticalPathOptions { extinction_scale: 1.0 },
        ..Settings::of_size(SIDE, SIDE)
    }
}

/// Returns the same with a coarse grid and a small picture, for tests of soundness only.
fn coarse() -> Settings {
    Settings { width: 64, height: 64, ..settings("godunov-32") }
}

fn draw(scene: &Scene, settings: &Settings) -> Picture {
    render::render(lapidary_testing::gpu(), scene, settings).expect("rendered")
}

/// Returns a white body, so that radiance times π is the irradiance that arrives.
fn stone(name: &str, mesh: Mesh, extinction: Vec3) -> Object {
    let skin = Scene::named("skin").expect("built in").objects.swap_remove(0);
    let medium = Some(Medium::isotropic(extinction, Vec3::ZERO));
    let material = Material { base_color: Vec3::ONE, sigma0: None, medium, ..skin.material };
    Object::new(name, mesh, material)
}

fn scene(objects: Vec<Object>, lights: Vec<Light>) -> Scene {
    Scene { objects, lights, ..Scene::named("skin").expect("built in") }.seen_from(80.0, 20.0)
}

/// Returns a ball about the origin of a grey medium, with a radius of `depth` optical depths.
fn ball(depth: f32, lights: Vec<Light>) -> Scene {
    scene(vec![stone("ball", sphere(RADIUS, 256), Vec3::splat(depth / RADIUS as f32))], lights)
}

fn sun() -> Light {
    Light::Directional { toward: Vec3::new(-0.8, 0.6, 0.0), irradiance: Vec3::splat(2.0) }
}

/// Returns a lamp at one and a half radii from the ball.
fn lamp() -> Light {
    Light::Point { position: Vec3::new(-20.0, 12.0, 9.0), intensity: Vec3::splat(800.0) }
}

/// Returns a spot at the same place, directed at a part of the ball.
fn spot() -> Light {
    let position = Vec3::new(-20.0, 12.0, 9.0);
    Light::Spot {
        position,
        direction: (Vec3::new(-2.0, 3.0, 8.0) - position).normalize(),
        intensity: Vec3::splat(800.0),
        inner_angle: 0.1,
        outer_angle: 0.3,
    }
}

/// Returns the number of pixels that show a body. No value may be negative, infinite or NaN.
fn covered(what: &str, picture: &Picture) -> usize {
    for pixel in &picture.linear {
        assert!(pixel.iter().all(|value| value.is_finite() && *value >= 0.0), "{what}: {pixel:?}");
    }
    picture.linear.iter().filter(|pixel| pixel[3] == 1.0).count()
}

/// Returns the largest difference of two pictures' channels, relative to the second's and to a
/// thousandth of its brightest.
fn apart(one: &Picture, other: &Picture) -> f32 {
    let channels = |picture: &Picture| picture.linear.iter().flat_map(|pixel| pixel[..3].to_vec()).collect::<Vec<_>>();
    let (one, other) = (channels(one), channels(other));
    assert!(one.iter().chain(&other).all(|value| value.is_finite()), "not finite");
    assert_eq!(one.len(), other.len());
    let brightest = other.iter().copied().fold(0.0, larger);
    assert!(brightest > 0.0, "nothing to compare");
    one.iter().zip(&other).map(|(one, other)| (one - other).abs() / other.max(1e-3 * brightest)).fold(0.0, larger)
}
