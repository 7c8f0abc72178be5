//! The white furnace: surrounded by radiance 1, a clear stone shows radiance 1 wherever one looks, for what its surface does not
//! reflect comes from inside, and what a facet does not let out is taken from the environment as well.

use lapidary_harness::render::{self, Environment, Rung, Settings};
use lapidary_harness::scene::Scene;
use lapidary_harness::scene::environment_map::EnvironmentMap;

/// Sums of two or three products whose weights add up to 1, each rounded, over the 16 samples of a pixel.
const BOUND: f32 = 16.0 * f32::EPSILON;

fn ones() -> Environment {
    Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[1.0; 4]; 8] })
}

#[test]
fn a_clear_stone_disappears() {
    for name in ["brilliant", "octahedron", "prism", "bunny_stone"] {
        let scene = Scene::named(name).expect("built in");
        let settings = Settings { environment: ones(), ..Settings::of_size(128, 128) };
        let picture = render::render(super::gpu(), &scene, &settings).expect("rendered");
        let covered: Vec<&[f32; 4]> = picture.linear.iter().filter(|pixel| pixel[3] == 1.0).collect();
        assert!(covered.len() > 1000, "{name}: {} pixels", covered.len());
        for [r, g, b, _] in covered {
            assert!([r, g, b].iter().all(|value| (*value - 1.0).abs() <= BOUND), "{name}: {r} {g} {b}");
        }
    }
}

#[test]
fn the_surface_alone_reflects_less() {
    let scene = Scene::named("brilliant").expect("built in");
    let settings = Settings { environment: ones(), rung: Rung::Surface, ..Settings::of_size(128, 128) };
    let picture = render::render(super::gpu(), &scene, &settings).expect("rendered");
    let covered = picture.linear.iter().filter(|pixel| pixel[3] == 1.0);
    // Diamond reflects 17.2 % at normal incidence and never less.
    assert!(covered.clone().count() > 1000);
    assert!(covered.into_iter().all(|[r, ..]| (0.1719..1.0).contains(r)));
}
