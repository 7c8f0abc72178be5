//! The vitrine: each body by what its material calls for, all in view.

use lapidary_plan::Decisions;
use lapidary_render::Settings;
use lapidary_render::pixel::Viewer;
use lapidary_scene::{Object, Scene};

/// The rule decides from the ball's thickness, and from measurements of the candle and the figure.
#[test]
fn each_body_is_drawn_as_its_material_calls_for() {
    let scene = Scene::named("vitrine").expect("built in");
    let settings = Settings { rung: lapidary_plan::Rung::ByMaterial, ..Settings::of_size(4, 3) };
    let decisions = Decisions::all(&scene, &settings.request());
    let rungs: Vec<String> = decisions.iter().map(|decisions| decisions.rung.to_string()).collect();
    let (stone, through) = ("walk-8+tracker", "diffusion-64");
    assert_eq!(
        rungs,
        [
            "lambert",
            stone,
            stone,
            through,
            through,
            "bvh-8+tracker",
            "drift",
            "lambert",
            "lambert",
            "lambert",
            "lambert"
        ]
    );
}

/// Uses a 4:3 picture, with a ray through every tenth pixel of 640 by 480.
#[test]
fn the_camera_sees_every_body() {
    let (columns, rows) = (64, 48);
    let scene = Scene::named("vitrine").expect("built in");
    let viewer = Viewer::new(&scene, columns, rows);
    let mut seen = vec![0; scene.objects.len()];
    let mut at_an_edge = vec![false; scene.objects.len()];
    for (column, row) in (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row))) {
        let distance = |object: &Object| {
            let found = viewer.see(&object.mesh, f64::from(column) + 0.5, f64::from(row) + 0.5);
            found.map(|point| point.position.distance(scene.camera.eye))
        };
        let found = scene.objects.iter().enumerate().filter_map(|(k, object)| Some((distance(object)?, k)));
        if let Some((_, nearest)) = found.min_by(|a, b| a.0.total_cmp(&b.0)) {
            seen[nearest] += 1;
            at_an_edge[nearest] |= column == 0 || column + 1 == columns || row == 0 || row + 1 == rows;
        }
    }
    let shares: Vec<_> = scene.objects.iter().zip(&seen).map(|(o, n)| (&o.name, f64::from(*n) / 3072.0)).collect();
    println!("{shares:?}");
    // The parts of the stand are thin.
    let least = |name: &str| if ["foot", "post", "arm", "hook"].contains(&name) { 0.0 } else { 0.008 };
    assert!(shares.iter().all(|(name, share)| *share > least(name)), "{shares:?}");
    // The table extends beyond the picture.
    assert!(at_an_edge.iter().enumerate().all(|(place, at_an_edge)| *at_an_edge == (place == 0)), "{at_an_edge:?}");
}
