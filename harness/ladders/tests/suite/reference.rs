//! The reference against the GPU where both follow the same light: the reflection by a stone's
//! surface. This checks that both agree on camera, sample positions, environment and reflectance.

use lapidary_assay::extremum::larger;
use lapidary_ladders::gem::views::{CONCAVE, SHOWN, VIEWS};
use lapidary_plan::Rung;
use lapidary_reference::spectral;
use lapidary_render as render;
use lapidary_render::{GemOptions, Picture, Settings};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::{Dispersion, Environment, Scene};

const SIDE: u32 = 96;

/// Returns a map with a different colour in every texel, none bright enough for an edge to matter
/// more than a facet.
fn map() -> Environment {
    let texel = |k: u32| [0, 7, 13].map(|shift| ((k * 37 + shift * 11) % 64) as f32 / 64.0);
    let pixels = (0..128).map(texel).map(|[red, green, blue]| [red, green, blue, 1.0]);
    Environment::Map(EnvironmentMap { width: 16, height: 8, pixels: pixels.collect() })
}

/// Checks that all values are finite. A NaN never differs by more than a bound, and counts as light
/// or as no light by chance.
fn require_finite(drawn: &[[f32; 4]], followed: &[[f32; 4]]) {
    for (which, pixels) in [("the GPU's", drawn), ("the reference's", followed)] {
        let broken = pixels.iter().position(|pixel| !pixel.iter().all(|value| value.is_finite()));
        assert!(broken.is_none(), "{which} pixel {} is {:?}", broken.unwrap_or(0), broken.map(|index| pixels[index]));
    }
}

/// Plants one non-finite value, in either picture and in several channels.
#[test]
fn what_is_no_number_is_seen() {
    let sound = [[0.5; 4]; 9];
    require_finite(&sound, &sound);
    for (value, channel) in [(f32::NAN, 0), (f32::NAN, 3), (f32::INFINITY, 1)] {
        let mut planted = sound;
        planted[7][channel] = value;
        for pair in [[&planted, &sound], [&sound, &planted]] {
            std::panic::catch_unwind(|| require_finite(pair[0], pair[1])).expect_err("seen");
        }
    }
}

#[test]
fn surfaces_reflect_alike() {
    for environment in [Environment::Studio, map()] {
        for name in ["brilliant", "octahedron", "step_cut", "prism"] {
            let mut scene = Scene::named(name).expect("built in");
            // The surface rung uses one index for all channels.
            for object in &mut scene.objects {
                object.material.dispersion = Dispersion::None;
            }
            let settings =
                Settings { rung: Rung::Surface, environment: environment.clone(), ..Settings::of_size(SIDE, SIDE) };
            let drawn = render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered");
            // Nothing comes out of a black stone.
            for object in &mut scene.objects {
                object.material.base_color = glam::Vec3::ZERO;
            }
            let settings = spectral::Settings {
                environment: &environment,
                wavelengths: lapidary_scene::spectrum::FEWEST,
                ..spectral::Settings::of_size(SIDE, SIDE)
            };
            let followed = spectral::render(&scene, &settings, &|_, _| {}).expect("rendered");
            let pairs = || drawn.linear.iter().zip(&followed.linear);
            let covered = pairs().filter(|(drawn, _)| drawn[3] > 0.0).count();
            // A sample on an edge may fall to either side; the rasteriser rounds corners to 1/256
            // of its pixels.
            let differ = |&(drawn, followed): &(&[f32; 4], &[f32; 4])| {
                !(0..4).all(|k| (drawn[k] - followed[k]).abs() <= 1e-4 * followed[k].abs().max(1.0))
            };
            require_finite(&drawn.linear, &followed.linear);
            let edges = pairs().filter(differ).count();
            println!("{name}: {edges} of {covered} pixels differ");
            assert!(covered > 1000 && edges * 200 < covered, "{name}: {edges} of {covered} pixels differ");
        }
    }
}

/// Returns the rectangle of this size nearest to the picture's centre that a stone covers wholly.
fn covered(picture: &Picture, width: u32, height: u32) -> spectral::Window {
    let full = |left: u32, top: u32| {
        let pixels = (top..top + height).flat_map(|row| (left..left + width).map(move |column| (row, column)));
        pixels.into_iter().all(|(row, column)| picture.linear[(row * picture.width + column) as usize][3] == 1.0)
    };
    let places = (0..picture.height - height).flat_map(|top| (0..picture.width - width).map(move |left| (left, top)));
    let off = |&(left, top): &(u32, u32)| {
        (2 * left + width).abs_diff(picture.width).pow(2) + (2 * top + height).abs_diff(picture.height).pow(2)
    };
    let (left, top) = places.filter(|&(left, top)| full(left, top)).min_by_key(off).expect("a covered rectangle");
    spectral::Window { left, top, width, height }
}

/// The reference reproduces the committed pictures. A crop of each, as near to the centre as the
/// stone allows, is rendered again.
#[test]
fn the_committed_references_are_remade() {
    for view in VIEWS.into_iter().chain(CONCAVE).chain(SHOWN) {
        let scene = view.open().expect("built in");
        let picture = view.reference(lapidary_testing::gpu()).unwrap_or_else(|error| panic!("{error}"));
        let window = covered(&picture, 8, 4);
        let settings = spectral::Settings { window: Some(window), ..view.reference_settings() };
        let crop = spectral::render(&scene, &settings, &|_, _| {}).expect("rendered");
        for (row, line) in (window.top..).zip(crop.linear.chunks_exact(window.width as usize)) {
            let start = (row * picture.width + window.left) as usize;
            let expected_line = &picture.linear[start..][..line.len()];
            require_finite(line, expected_line);
            for (found, expected) in line.iter().zip(expected_line) {
                // Half floats keep 11 bits; the f64 functions of another processor may send a ray
                // to the other side of an edge.
                let difference =
                    (0..4).map(|k| (found[k] - expected[k]).abs() / expected[k].abs().max(0.01)).fold(0.0, larger);
                assert!(difference <= 0.002, "{} row {row}: {found:?}, committed {expected:?}", view.name);
            }
        }
    }
}

/// Transmission agrees, too. With enough hits, the exact planes with separate wavelengths on the
/// GPU show the same as the reference, although one is a loop in f32 and the other a tree in f64.
#[test]
fn stones_transmit_alike() {
    if !lapidary_testing::on_lavapipe("rays of 64 hits part where a driver fuses products with sums") {
        return;
    }
    for name in ["brilliant", "step_cut", "sapphire", "quartz", "octahedron"] {
        let scene = Scene::named(name).expect("built in");
        let rung = "convex-64+7".parse().expect("a rung");
        let drawn = Settings {
            rung,
            samples: 1,
            gem: GemOptions { limit_throughput: Some(false), ..GemOptions::default() },
            ..Settings::of_size(48, 48)
        };
        let drawn = render::render(lapidary_testing::gpu(), &scene, &drawn).expect("rendered");
        let settings = spectral::Settings { samples: 1, wavelengths: 7, ..spectral::Settings::of_size(48, 48) };
        let followed = spectral::render(&scene, &settings, &|_, _| {}).expect("rendered");
        let relative_error = |(drawn, followed): (&[f32; 4], &[f32; 4])| {
            (0..3).map(|k| (drawn[k] - followed[k]).abs() / followed[k].abs().max(0.1)).fold(0.0, larger)
        };
        require_finite(&drawn.linear, &followed.linear);
        let pairs = drawn.linear.iter().zip(&followed.linear).filter(|(drawn, _)| drawn[3] > 0.0);
        let mut errors: Vec<f32> = pairs.map(relative_error).collect();
        errors.sort_by(f32::total_cmp);
        let quantile = |share: f64| errors[(share * (errors.len() - 1) as f64) as usize];
        println!("{name}: {} pixels, median {:e}, nine of ten {:e}", errors.len(), quantile(0.5), quantile(0.9));
        // The reference drops less than 1e-4 of a ray, or 2e-3 under a light of 20. A pixel differs
        // if its rays part at edges or are caught for more than 64 hits. That is rare at an index
        // of 1.5, but not in a diamond.
        assert!(errors.len() > 500 && quantile(0.5) <= 5e-4 && quantile(0.9) <= 0.02, "{name}");
    }
}
