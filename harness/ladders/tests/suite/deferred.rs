//! Deferred against forward rendering (the paper's sections 4.3.1 and 4.3.4).

use glam::{Vec3, Vec4};
use lapidary_assay::extremum::larger;
use lapidary_ladders::gem::Errors;
use lapidary_render as render;
use lapidary_render::{GemOptions, Settings};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::{Environment, Scene};

#[test]
fn the_composite_shows_the_forward_picture() {
    for (scene, rung) in [
        ("brilliant", "proxy-1"),
        ("brilliant", "convex-4+tracker"),
        ("sapphire", "bvh-4"),
        ("step_cut", "proxy-4+tracker"),
        ("octahedron", "convex-2+31"),
        ("prism_chain", "bvh-2"),
    ] {
        check(scene, Settings { rung: rung.parse().expect(rung), ..Settings::of_size(256, 256) });
    }
}

#[test]
fn so_it_does_with_a_map() {
    // Bands of light as soft as the studio's.
    let pixel = |k: usize| {
        let turn = (k % 256) as f32 * std::f32::consts::TAU / 256.0;
        [1.0 + (3.0 * turn).sin(), 1.0 + turn.cos(), 0.5 + 0.5 * (2.0 * turn).sin(), 1.0]
    };
    let map = EnvironmentMap { width: 256, height: 128, pixels: (0..256 * 128).map(pixel).collect() };
    let rung = "convex-2+tracker".parse().expect("a rung");
    check("brilliant", Settings { rung, environment: Environment::Map(map), ..Settings::of_size(256, 256) });
}

fn check(scene: &str, settings: Settings) {
    let scene = Scene::named(scene).expect("built in");
    let rung = settings.rung;
    let forward = render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered");
    let deferred = Settings { gem: GemOptions { deferred: true, ..settings.gem }, ..settings };
    let deferred = render::render(lapidary_testing::gpu(), &scene, &deferred).expect("rendered");
    let errors = Errors::between(&deferred, &forward);
    println!("{} {rung}: {errors:?}", scene.name);
    // A normal in half floats is off by up to 2^-11, so a reflection is off by 2^-10 rad. The
    // studio's lights fade over 0.06 rad or more. Such an angle changes them by 1.6 % at the
    // steepest: up to a step of the display's 255, in the mean over their edges.
    assert!(errors.flip <= 0.006, "{} {rung}: {errors:?}", scene.name);
    assert!(errors.rmse <= 0.005, "{} {rung}: {errors:?}", scene.name);
    assert!(errors.energy.abs() <= 0.001, "{} {rung}: {errors:?}", scene.name);
    for (forward, deferred) in forward.linear.iter().zip(&deferred.linear) {
        assert_eq!(forward[3], deferred[3]);
    }
}

/// Precision of a position from 32-bit depth, with the near and far planes about the scene: the
/// rounding of the depth, 2^-24 of its range, and of the matrix product. The error is a few units
/// in the last place of the distance.
#[test]
fn a_position_comes_back_from_depth() {
    for name in ["brilliant", "prism", "bunny_stone"] {
        let scene = Scene::named(name).expect("built in");
        let matrix = lapidary_scene::clip_from_world(&scene, 512, 512);
        let back = matrix.as_dmat4().inverse().as_mat4();
        let mut worst = 0f32;
        for position in scene.objects.iter().flat_map(|object| &object.mesh.positions) {
            let clip = matrix * position.extend(1.0);
            let (x, y, depth) = (clip.x / clip.w, clip.y / clip.w, clip.z / clip.w);
            let world = back * Vec4::new(x, y, depth, 1.0);
            let rebuilt: Vec3 = world.truncate() / world.w;
            worst = larger(worst, rebuilt.distance(*position) / scene.camera.eye.distance(*position));
        }
        println!("{name}: off by {worst:e} of the distance at most");
        assert!(worst <= 16.0 * f32::EPSILON, "{name}: {worst:e}");
    }
}
