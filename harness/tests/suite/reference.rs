//! The reference against the GPU, where both follow the same light: what a stone's surface reflects. That holds camera,
//! sample places, environment and reflectance of one to those of the other.

use lapidary_harness::reference;
use lapidary_harness::render::{self, Environment, Rung, Settings};
use lapidary_harness::scene::environment_map::EnvironmentMap;
use lapidary_harness::scene::{Dispersion, Scene};

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
            // The surface rung reflects by one index.
            for object in &mut scene.objects {
                object.material.dispersion = Dispersion::None;
            }
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

/// The committed pictures are what the reference sees: a crop of each through the middle of the stone, rendered again.
#[test]
fn the_committed_references_are_remade() {
    for view in lapidary_harness::cost::views::VIEWS {
        let scene = view.open().expect("built in");
        let picture = view.reference(super::gpu()).unwrap_or_else(|error| panic!("{error}"));
        let window = reference::Window { left: 124, top: 120, width: 8, height: 4 };
        let settings =
            reference::Settings { window: Some(window), ..reference::Settings::of_size(picture.width, picture.height) };
        let crop = reference::render(&scene, &settings, &|_, _| {}).expect("rendered");
        for (row, line) in (window.top..).zip(crop.linear.chunks_exact(window.width as usize)) {
            let start = (row * picture.width + window.left) as usize;
            for (found, expected) in line.iter().zip(&picture.linear[start..]) {
                // Half floats keep 11 bits; another processor's f64 functions may send a ray to the other side of an edge.
                let apart =
                    (0..4).map(|k| (found[k] - expected[k]).abs() / expected[k].abs().max(0.01)).fold(0.0, f32::max);
                assert!(apart <= 0.002, "{} row {row}: {found:?}, committed {expected:?}", view.name);
            }
        }
    }
}
