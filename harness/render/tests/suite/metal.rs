//! Metals as they are drawn, from the blurred environment and the table, beside the reference, which follows light from facet to
//! facet.

use glam::Vec3;
use lapidary_plan::{Effect, Effects, Rung};
use lapidary_render as render;
use lapidary_render::Settings;
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{Camera, Environment, Light, Material, Metal, Object, Scene};
use std::f32::consts::PI;

/// Side of a picture, and of the blocks whose means are compared: a path tracer's noise is less in them.
const SIDE: u32 = 64;
const BLOCK: u32 = 8;

/// Returns a ball of a metal that fills the picture.
fn ball(base_color: Vec3, roughness: f32, lights: Vec<Light>) -> Scene {
    let material = Material { base_color, roughness, metallic: 1.0, ..Material::standard() };
    let object = Object::new("ball", sphere(1.0, 96), material);
    let camera = Camera::upright(Vec3::new(0.0, 0.0, 6.0), Vec3::ZERO, 0.34);
    Scene { objects: vec![object], lights, camera, ..Scene::named("wax").expect("built in") }
}

fn settings(rung: &str, environment: Environment) -> Settings {
    Settings { environment, rung: rung.parse::<Rung>().expect("a rung"), ..Settings::of_size(SIDE, SIDE) }
}

fn drawn(scene: &Scene, settings: &Settings) -> Vec<[f32; 4]> {
    render::render(lapidary_testing::gpu(), scene, settings).expect("rendered").linear
}

/// Returns the means over blocks that the ball covers wholly.
fn blocks(linear: &[[f32; 4]]) -> Vec<Vec3> {
    let across = SIDE / BLOCK;
    let block = |number: u32| {
        let pixels = (0..BLOCK * BLOCK).map(|pixel| {
            let [x, y] = [number % across * BLOCK + pixel % BLOCK, number / across * BLOCK + pixel / BLOCK];
            linear[(y * SIDE + x) as usize]
        });
        let covered: Vec<Vec3> =
            pixels.filter(|pixel| pixel[3] == 1.0).map(|[r, g, b, _]| Vec3::new(r, g, b)).collect();
        (covered.len() as u32 == BLOCK * BLOCK).then(|| covered.iter().sum::<Vec3>() / covered.len() as f32)
    };
    (0..across * across).filter_map(block).collect()
}

/// Returns the mean error and the root mean square error of blocks, as shares of the mean radiance.
fn errors(scene: &Scene, environment: &Environment, without: Effects) -> [f32; 2] {
    let [seen, truth] = ["by-material", "reference"].map(|rung| {
        let settings = Settings { without, ..settings(rung, environment.clone()) };
        blocks(&drawn(scene, &settings))
    });
    assert!(truth.len() > 20 && truth.len() == seen.len());
    let mean = |values: &mut dyn Iterator<Item = f32>| values.sum::<f32>() / (3 * truth.len()) as f32;
    let level = mean(&mut truth.iter().flat_map(Vec3::to_array));
    let differences = || seen.iter().zip(&truth).flat_map(|(seen, truth)| (seen - truth).to_array());
    [
        mean(&mut differences()) / level,
        mean(&mut differences().map(|difference| difference * difference)).sqrt() / level,
    ]
}

fn ones() -> Environment {
    Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[1.0; 4]; 8] })
}

/// A white metal in radiance 1 is not seen, and one that reflects half head on is as bright as the reference says.
#[test]
fn furnace() {
    for roughness in lapidary_testing::sampled([0.0, 0.05, 0.3, 0.6, 1.0], 4) {
        let linear = drawn(&ball(Vec3::ONE, roughness, Vec::new()), &settings("by-material", ones()));
        let covered = linear.iter().filter(|pixel| pixel[3] == 1.0);
        let most = covered.flat_map(|[r, g, b, _]| [r, g, b]).map(|value| (value - 1.0).abs()).fold(0.0, f32::max);
        // Table and environment have half floats, whose steps are 2^-11 and cancel in the table.
        assert!(most < 1e-3, "roughness {roughness}: {most}");
        let scene = ball(Vec3::splat(0.5), roughness, Vec::new());
        let [mean, _] = errors(&scene, &ones(), Effects::NONE);
        println!("roughness {roughness}: white {most:.1e}, half {:+.2} %", 100.0 * mean);
        // What the compensation errs at 1/2, by docs/split_sum.md.
        assert!(mean.abs() < 0.025, "roughness {roughness}: {mean}");
    }
}

/// The rows of the table of docs/split_sum.md.
#[test]
fn what_is_drawn_beside_the_reference() {
    let page = include_str!("../../../../docs/split_sum.md");
    let sun = Light::Directional { toward: Vec3::new(0.4, 0.5, 1.0).normalize(), irradiance: Vec3::splat(PI) };
    for roughness in lapidary_testing::sampled([0.0, 0.1, 0.3, 0.5, 0.7, 1.0], 4) {
        let percent = |[mean, blocks]: [f32; 2]| format!("{:+.0} | {:.0}", 100.0 * mean, 100.0 * blocks);
        let around =
            errors(&ball(Metal::Gold.base_color(), roughness, Vec::new()), &Environment::Studio, Effects::NONE);
        let lit = if roughness > 0.0 {
            let black = Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[0.0, 0.0, 0.0, 1.0]; 8] });
            let scene = ball(Metal::Gold.base_color(), roughness, vec![sun]);
            percent(errors(&scene, &black, Effects::of(&[Effect::Shadow])))
        } else {
            "– | –".to_owned()
        };
        let row = format!("\n| {roughness} | {} | {lit} |\n", percent(around));
        assert!(page.contains(&row), "docs/split_sum.md should hold:{row}");
    }
}
