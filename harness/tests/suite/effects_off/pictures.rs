//! The same on the device: a picture by the whole recipe with an effect switched off by the settings is, bit for bit, the
//! picture by the recipe's text without the effect's lines.
//!
//! Three effects no setting switches off in their own recipe, so that the SPIR-V alone speaks for them: `convex_trace` and
//! `bvh_trace`, in whose place rung `surface` draws with the recipe `gem`, and `optical_path`.

use super::cut;
use crate::gpu;
use glam::Vec3;
use lapidary_harness::cookbook;
use lapidary_harness::render::{Settings, render_with};
use lapidary_harness::scene::{Light, Medium, Scene};

/// A scene and a rung that draw with the recipe's effect off.
struct Case {
    scene: &'static str,
    rung: &'static str,
    effect: &'static str,
}

const fn case(scene: &'static str, rung: &'static str, effect: &'static str) -> Case {
    Case { scene, rung, effect }
}

/// Effects without a binding of their own.
const WITHOUT_BINDINGS: [Case; 7] = [
    case("sapphire", "proxy-2+tracker", "absorption"),
    case("sapphire", "convex-2+3", "absorption"),
    case("sapphire", "bvh-2+paper", "absorption"),
    case("skin", "accurate", "spot"),
    case("skin", "cheap", "microfacet"),
    case("jade", "tiled-26-16", "spot"),
    case("skin", "tiled-26-16", "microfacet"),
];

/// Effects whose bindings go with them.
const WITH_BINDINGS: [Case; 16] = [
    case("brilliant", "surface", "proxy_geometry"),
    case("sapphire", "proxy-2", "dispersion"),
    case("sapphire", "convex-2", "dispersion"),
    case("sapphire", "bvh-2", "dispersion"),
    case("sapphire", "proxy-2+3", "environment_map"),
    case("sapphire", "convex-2", "environment_map"),
    case("sapphire", "bvh-2+tracker", "environment_map"),
    case("skin", "lambert", "cdrf"),
    case("skin", "accurate", "texture_diffusion"),
    case("skin", "accurate", "environment"),
    case("jade", "accurate", "environment_map"),
    case("skin", "tiled-26-16", "environment"),
    case("jade", "tiled-26-16", "extinction_per_voxel"),
    case("grey jade", "tiled-26-16", "color"),
    case("jade", "tiled-26-16", "reflection"),
    case("jade", "accurate", "reflection"),
];

fn scene(name: &str) -> Scene {
    let mut scene = Scene::named(name.trim_start_matches("grey ")).expect("built in");
    if name.starts_with("grey ") {
        for object in &mut scene.objects {
            object.material.medium = Some(Medium::isotropic(Vec3::ONE, Vec3::splat(0.1)));
        }
        scene.lights = vec![Light::Directional { toward: Vec3::Y, irradiance: Vec3::splat(3.0) }];
    }
    scene
}

fn check(cases: &[Case]) {
    for Case { scene: name, rung, effect } in cases {
        let scene = scene(name);
        let settings = Settings {
            rung: rung.parse().expect(rung),
            samples: 1,
            absorption: *effect != "absorption",
            reflection: !["reflection", "microfacet"].contains(effect),
            light_from_environment: *effect != "environment",
            ..Settings::of_size(64, 48)
        };
        let whole = cookbook::recipe_source(settings.rung.recipe());
        let without = cut(&whole, &[effect]);
        let draw = |source: &str| {
            render_with(gpu(), &scene, &settings, source, &mut |_, _| {})
                .unwrap_or_else(|error| panic!("{name} by {rung} without {effect}: {error}"))
        };
        let [off, cut] = [&whole, &without].map(|source| draw(source).linear);
        assert!(off.iter().filter(|pixel| pixel[3] > 0.0 && pixel[0] > 0.0).count() > 200, "{name} by {rung} is empty");
        let differs = off.iter().zip(&cut).filter(|(off, cut)| off.map(f32::to_bits) != cut.map(f32::to_bits)).count();
        assert_eq!(differs, 0, "{name} by {rung} without {effect}: pixels that differ");
    }
}

#[test]
fn a_picture_without_an_effect_is_the_one_by_the_text_without_it() {
    check(&WITHOUT_BINDINGS);
}

#[test]
#[ignore = "pipelines are bound by position as yet, not by what is left of their bindings"]
fn a_picture_without_an_effects_bindings_is_the_one_by_the_text_without_them() {
    check(&WITH_BINDINGS);
}
