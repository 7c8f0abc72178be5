//! What light that leaves a stone meets: other bodies as the picture shows them, by their bounds or by their triangles.

use lapidary_ladders::gem::Errors;
use lapidary_plan::{Effect, Effects, Outside, Rung};
use lapidary_render as render;
use lapidary_render::{GemOptions, Picture, Settings};
use lapidary_scene::{Object, Scene};
use lapidary_testing::gpu;

/// All ways but the environment alone.
const WAYS: [Outside; 3] = [Outside::Bodies, Outside::Screen, Outside::Triangles];

fn settings(outside: Outside) -> Settings {
    let gem = GemOptions { outside: Some(outside), ..GemOptions::default() };
    Settings { rung: Rung::ByMaterial, samples: 2, gem, ..Settings::of_size(160, 120) }
}

fn drawn(scene: &Scene, settings: &Settings) -> Picture {
    render::render_means(gpu(), scene, settings).expect("rendered")
}

/// With light that meets the other bodies, stones come closer to the reference, which follows it
/// exactly; and the other bodies look as before.
#[test]
fn what_is_met_is_nearer_to_the_reference() {
    for (name, most) in [("tray", [0.8, 0.8, 0.8]), ("solitaire", [0.95, 0.97, 0.9])] {
        let scene = Scene::named(name).expect("built in");
        let exact = Settings { rung: Rung::Reference, ..settings(Outside::Environment) };
        let reference = drawn(&scene, &exact);
        let flip = |outside| Errors::between(&drawn(&scene, &settings(outside)), &reference).flip;
        let alone = flip(Outside::Environment);
        let shares = WAYS.map(|outside| flip(outside) / alone);
        println!("{name}: FLIP {alone:.3}, of it {shares:.2?} with {WAYS:?}");
        assert!(shares.iter().zip(most).all(|(share, most)| *share <= most), "{name}: {shares:?} of {alone}");
        let matte = |object: &&Object| !object.material.is_clear();
        let others: Vec<Object> = scene.objects.iter().filter(matte).cloned().collect();
        let others = drawn(&Scene { objects: others, ..scene.clone() }, &settings(Outside::Environment));
        let [alone, met] = [Outside::Environment, Outside::Screen].map(|outside| drawn(&scene, &settings(outside)));
        let bare = |pixel: &usize| alone.linear[*pixel] == others.linear[*pixel];
        let bare: Vec<usize> = (0..met.linear.len()).filter(bare).collect();
        assert!(bare.len() > met.linear.len() / 2, "{name}: {} pixels without a stone", bare.len());
        assert!(bare.iter().all(|pixel| met.linear[*pixel] == others.linear[*pixel]), "{name}: others changed");
    }
}

/// A stone alone, and one with the effects left out, is drawn to the bit as without them.
#[test]
fn without_other_bodies_nothing_changes() {
    let stone = Scene::named("brilliant").expect("built in");
    let alone = drawn(&stone, &settings(Outside::Environment));
    for outside in WAYS {
        assert_eq!(alone, drawn(&stone, &settings(outside)), "{outside}");
    }
    let tray = Scene::named("tray").expect("built in");
    let environment = drawn(&tray, &settings(Outside::Environment));
    let effects = [Effect::BoundsTrace, Effect::ScreenTrace, Effect::Around];
    for (outside, effect) in WAYS.into_iter().zip(effects) {
        let without = Settings { without: Effects::of(&[effect]), ..settings(outside) };
        assert_eq!(environment, drawn(&tray, &without), "{outside}");
    }
}

/// Edges are smoothed in stones that meet other bodies as well.
#[test]
fn smoothed_edges_and_the_picture_go_together() {
    let tray = Scene::named("tray").expect("built in");
    for outside in WAYS {
        let plain = Settings { samples: 1, ..settings(outside) };
        let smooth = Settings { gem: GemOptions { footprint: true, ..plain.gem }, ..plain.clone() };
        let many = Settings { samples: 8, ..plain.clone() };
        let many = drawn(&tray, &many);
        let distance = |settings: &Settings| Errors::between(&drawn(&tray, settings), &many).rmse;
        let [plain, smooth] = [distance(&plain), distance(&smooth)];
        println!("{outside}: RMSE to 64 samples {plain:.3}, {smooth:.3} with smoothed edges");
        assert!(smooth < 0.8 * plain, "{outside}: {smooth} of {plain}");
    }
}
