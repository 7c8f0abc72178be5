//! The same on the device: a picture by the whole recipe with an effect left out by the settings is, bit for bit, the
//! picture by the recipe's text without the effect's lines.

use super::cut;
use crate::gpu;
use glam::Vec3;
use lapidary_plan::{Decisions, Effect, Effects};
use lapidary_render::{Settings, render_with};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::{Environment, Light, Medium, Scene};

/// A scene and a rung, and effects of their recipe, each of which is left out in turn.
#[derive(Debug)]
struct Case {
    scene: &'static str,
    rung: &'static str,
    effects: &'static [Effect],
}

const fn case(scene: &'static str, rung: &'static str, effects: &'static [Effect]) -> Case {
    Case { scene, rung, effects }
}

/// Each effect where it is on, by each recipe that has it; and a few where nothing calls for it.
const CASES: [Case; 15] = [
    case("sapphire", "proxy-2+tracker", &[Effect::ProxyGeometry, Effect::Absorption, Effect::Dispersion]),
    case("sapphire", "convex-2+3", &[Effect::ConvexTrace, Effect::Absorption, Effect::Dispersion]),
    case("sapphire", "bvh-2+paper", &[Effect::BvhTrace, Effect::Absorption, Effect::Dispersion]),
    case("sapphire, a map", "proxy-2+tracker", &[Effect::EnvironmentMap]),
    case("sapphire, a map", "convex-2", &[Effect::EnvironmentMap, Effect::Dispersion]),
    case("sapphire, a map", "bvh-2", &[Effect::EnvironmentMap, Effect::Dispersion]),
    case("brilliant, thin", "by-material", &[Effect::ThinWall, Effect::Dispersion]),
    case("skin, a spot", "cheap", &[Effect::Cdrf, Effect::Environment, Effect::Microfacet, Effect::Spot]),
    case("jade, a map", "accurate", &[Effect::Reflection, Effect::EnvironmentMap, Effect::TextureDiffusion]),
    case("skin", "blur", &[Effect::TextureDiffusion, Effect::Microfacet]),
    case("skin, a spot", "lambert-shadowed", &[Effect::Shadow, Effect::Microfacet, Effect::Spot]),
    case("skin_bunny", "blur", &[Effect::Shadow, Effect::TextureDiffusion]),
    case("dragon", "tiled-26-16", &[Effect::OpticalPath, Effect::ExtinctionPerVoxel, Effect::Color]),
    case("jade, a map", "tiled-26-16", &[Effect::Reflection, Effect::EnvironmentMap, Effect::Spot]),
    case("skin, a spot", "tiled-26-16", &[Effect::Environment, Effect::Microfacet, Effect::Spot]),
];

fn scene(name: &str) -> Scene {
    let (name, change) = name.split_once(", ").unwrap_or((name, ""));
    let mut scene = Scene::named(name).expect("built in");
    match change {
        "thin" => scene.objects[0].material.thickness = 0.0,
        "a spot" => {
            let [position, direction] = [Vec3::Y * 300.0, Vec3::NEG_Y];
            let (inner_angle, outer_angle) = (0.2, 0.4);
            let intensity = Vec3::new(3e5, 2e5, 1e5);
            scene.lights.push(Light::Spot { position, direction, intensity, inner_angle, outer_angle });
        }
        _ => {}
    }
    scene
}

fn settings(case: &Case) -> Settings {
    let shadows = case.effects.contains(&Effect::Shadow);
    let rung = case.rung.parse().expect(case.rung);
    let mut settings = Settings { rung, shadows, samples: 1, ..Settings::of_size(64, 48) };
    if case.scene.ends_with("a map") {
        let pixels = (0..8 * 4).map(|pixel| [0.1 + 0.2 * (pixel % 5) as f32, 0.5, 1.0, 1.0]).collect();
        settings.environment = Environment::Map(EnvironmentMap { width: 8, height: 4, pixels });
    }
    settings
}

#[test]
fn a_picture_without_an_effect_is_the_one_by_the_text_without_it() {
    let mut seen = Effects::NONE;
    // The text is proven to be the same for every effect and recipe; here the device is asked.
    for case in crate::sampled(&CASES, 3) {
        let Case { scene: name, rung, effects } = case;
        let scene = scene(name);
        let called = Decisions::of(&scene.objects[0], &scene, &settings(case).request());
        let whole = lapidary_wgsl::recipe_source(called.rung.recipe());
        let draw = |settings: &Settings, source: &str| {
            let picture = render_with(gpu(), &scene, settings, source);
            picture.unwrap_or_else(|error| panic!("{name} by {rung}: {error}")).linear
        };
        let bits = |picture: &[[f32; 4]]| picture.iter().map(|pixel| pixel.map(f32::to_bits)).collect::<Vec<_>>();
        let on = draw(&settings(case), &whole);
        for effect in *effects {
            let settings = Settings { without: Effects::of(&[*effect]), ..settings(case) };
            let off = draw(&settings, &whole);
            let cut = draw(&settings, &cut(&whole, &[effect.name()]));
            assert!(
                off.iter().filter(|pixel| pixel[3] > 0.0 && pixel[0] > 0.0).count() > 200,
                "{name} by {rung} is empty"
            );
            assert!(bits(&off) == bits(&cut), "{name} by {rung} without {effect}: pixels differ");
            // And an effect that is called for is seen.
            assert_eq!(bits(&off) != bits(&on), called.has(*effect), "{name} by {rung} without {effect}");
            if called.has(*effect) {
                seen = seen.and(Effects::of(&[*effect]));
            }
        }
    }
    // Surface is the voxels' recipe's, which has no picture: the suite's SPIR-V and voxels speak for it.
    for effect in Effect::ALL.into_iter().filter(|effect| *effect != Effect::Surface && crate::whole()) {
        assert!(seen.has(effect), "{effect} is left out nowhere");
    }
}

/// Where red, green and blue are alike, one way serves all three.
#[test]
fn a_grey_bodys_picture_is_the_one_by_the_text_without_colour() {
    let mut scene = scene("jade");
    for object in &mut scene.objects {
        object.material.medium = Some(Medium::isotropic(Vec3::ONE, Vec3::splat(0.1)));
    }
    scene.lights = vec![Light::Directional { toward: Vec3::Y, irradiance: Vec3::splat(3.0) }];
    let settings = settings(&case("jade", "tiled-26-16", &[]));
    let whole = lapidary_wgsl::recipe_source(settings.rung.recipe());
    let draw = |source: &str| render_with(gpu(), &scene, &settings, source).expect("drawn").linear;
    assert_eq!(draw(&whole), draw(&cut(&whole, &["color"])));
}
