//! The reference against the GPU, where both follow the same light: what a stone's surface reflects. That holds camera,
//! sample places, environment and reflectance of one to those of the other.

use lapidary_harness::reference;
use lapidary_harness::render::{self, Environment, Rung, Settings};
use lapidary_harness::scene::Scene;
use lapidary_harness::scene::environment_map::EnvironmentMap;

const SIDE: u32 = 96;

/// A map with a different colour in every texel, none so bright that an edge matters more than a facet.
fn map() -> Environment {
    let texel = |k: u32| [0, 7, 13].map(|shift| ((k * 37 + shift * 11) % 64) as f32 / 64.0);
    let pixels = (0..128).map(texel).map(|[red, green, blue]| [red, green, blue, 1.0]);
    Environment::Map(EnvironmentMap { width: 16, height: 8, pixels: pixels.collect() })
}

#[test]
fn surfaces_reflect_alike() {
    for environment in [Environment::Studio, map()] {
        for name in ["brilliant", "octahedron", "step_cut", "prism"] {
            let mut scene = Scene::named(name).expect("built in");
            let settings =
                Settings { rung: Rung::Surface, environment: environment.clone(), ..Settings::of_size(SIDE, SIDE) };
            let drawn = render::render(super::gpu(), &scene, &settings).expect("rendered");
            // Nothing comes out of a black stone.
            for object in &mut scene.objects {
                object.material.base_color = glam::Vec3::ZERO;
            }
            let settings = reference::Settings {
                environment: &environment,
                wavelengths: reference::spectrum::FEWEST,
                ..reference::Settings::of_size(SIDE, SIDE)
            };
            let followed = reference::render(&scene, &settings, &|_, _| {}).expect("rendered");
            let pairs = || drawn.linear.iter().zip(&followed.linear);
            let covered = pairs().filter(|(drawn, _)| drawn[3] > 0.0).count();
            // A sample on an edge may fall to either side; the rasteriser rounds corners to 1/256 of its pixels.
            let apart = |&(drawn, followed): &(&[f32; 4], &[f32; 4])| {
                (0..4).any(|k| (drawn[k] - followed[k]).abs() > 1e-4 * followed[k].abs().max(1.0))
            };
            let edges = pairs().filter(apart).count();
            println!("{name}: {edges} of {covered} pixels differ");
            assert!(covered > 1000 && edges * 200 < covered, "{name}: {edges} of {covered} pixels differ");
        }
    }
}
