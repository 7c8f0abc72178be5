//! Visible edges of bright facets: the brightness on an edge lies between that of its two sides.

use lapidary_render as render;
use lapidary_render::{Picture, ReferenceOptions, Settings};
use lapidary_scene::Scene;

/// Least change across a strong edge, in display light as a share of white: within three pixels and
/// in one direction.
const STRONG: f32 = 0.5;
/// Least share of this change between two neighbouring pixels that counts as a step.
const STEP: f32 = 0.9;

/// Returns the number of strong edges along rows and columns, and the number of steps among them.
fn edges(picture: &Picture) -> (usize, usize) {
    let light = |pixel: &[u8; 4]| {
        let color = glam::Vec3::from_array([0, 1, 2].map(|k| f32::from(pixel[k]) / 255.0));
        lapidary_srgb::luminance(lapidary_srgb::decode_color(color))
    };
    let (width, height) = (picture.width as usize, picture.height as usize);
    let light: Vec<f32> = picture.encoded.iter().map(light).collect();
    let (mut strong, mut steps) = (0, 0);
    let mut look = |line: &[f32]| {
        for four in line.windows(4) {
            let whole = four[3] - four[0];
            let [before, step, after] = [0, 1, 2].map(|k| whole.signum() * (four[k + 1] - four[k]));
            // The largest change is in the middle, so that each edge counts once.
            if whole.abs() >= STRONG && before >= 0.0 && after >= 0.0 && step >= before && step > after {
                strong += 1;
                steps += usize::from(step >= STEP * whole.abs());
            }
        }
    };
    (0..height).for_each(|row| look(&light[row * width..][..width]));
    for column in 0..width {
        look(&light.iter().skip(column).step_by(width).copied().collect::<Vec<f32>>());
    }
    (strong, steps)
}

fn share(name: &str, picture: &Picture) -> f64 {
    let (strong, steps) = edges(picture);
    let share = steps as f64 / strong as f64;
    println!("{name}: {steps} of {strong} strong edges are steps, {share:.3}");
    assert!(strong > 500, "{name}: {strong}");
    share
}

/// A pixel on a straight edge mixes the two sides by coverage. If the edge runs along the rows of
/// pixels, the coverage is uniform from 0 to 1. Then one of two changes, to the pixel or from it,
/// is 0.9 of the whole for a fifth of all edges. A slanted edge crosses more pixels and has fewer
/// steps. Sixteen samples resolve the coverage to a quarter at worst: then only a coverage of 0
/// makes a step, for a quarter of all edges.
const MOST_STEPS: f64 = 0.25;

#[test]
fn bright_edges_are_no_staircases() {
    let scenes = [
        ("brilliant", "convex-8+tracker", 1.0),
        ("chandelier", "proxy-2+tracker", 1.0),
        ("vitrine", "by-material", 0.25),
    ];
    for (name, rung, exposure) in lapidary_testing::sampled(scenes, 3) {
        let scene = Scene::named(name).expect("built in");
        let rung = rung.parse().expect("a rung");
        let settings = |samples| Settings { rung, exposure, samples, ..Settings::of_size(384, 384) };
        let picture = render::render(lapidary_testing::gpu(), &scene, &settings(4)).expect("rendered");
        assert!(share(name, &picture) <= MOST_STEPS, "{name}");
        // One sample per pixel gives a staircase. Means of sixteen samples, tone-mapped afterwards,
        // nearly give one. The measure detects both.
        let one = render::render(lapidary_testing::gpu(), &scene, &settings(1)).expect("rendered");
        assert!(share(&format!("{name}, one sample"), &one) > 0.5, "{name}");
        if name != "vitrine" {
            let late = render::render_means(lapidary_testing::gpu(), &scene, &settings(4)).expect("rendered");
            assert!(share(&format!("{name}, averaged before the curve"), &late) > 0.35, "{name}");
        }
    }
}

/// Checks eight samples a side, and the reference.
#[test]
#[ignore = "long; .ci/full runs it"]
fn so_it_is_with_more_samples_and_with_the_reference() {
    let scene = Scene::named("brilliant").expect("built in");
    let rung = "convex-8+tracker".parse().expect("a rung");
    let settings = Settings { rung, samples: 8, ..Settings::of_size(192, 192) };
    let picture = render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered");
    assert!(share("eight samples", &picture) <= MOST_STEPS);
    let rung = "reference".parse().expect("a rung");
    let settings = Settings {
        rung,
        reference: ReferenceOptions { wavelengths: 3, energy_bound: 0.02 },
        ..Settings::of_size(128, 128)
    };
    let picture = render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered");
    assert!(share("reference", &picture) <= MOST_STEPS);
}

#[test]
fn samples_have_a_range() {
    let scene = Scene::named("octahedron").expect("built in");
    for samples in [0, 9, u32::MAX] {
        let error = render::render(lapidary_testing::gpu(), &scene, &Settings { samples, ..Settings::of_size(8, 8) });
        assert!(error.expect_err("no picture").to_string().contains("1 to 8"));
    }
}
