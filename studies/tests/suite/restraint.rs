//! Rays that end once their contribution is invisible: the bound on the picture's error, and its
//! assumptions.

use glam::{DVec3, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::extremum::larger;
use lapidary_environment as environment;
use lapidary_plan::{Rung, Spectrum};
use lapidary_render as render;
use lapidary_render::pixel::Shading;
use lapidary_render::restraint::{LEAST_DIFFERENCE, STUDIO_LARGEST, largest_radiance, largest_weight};
use lapidary_render::{GemOptions, Picture, Settings};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::{Environment, Scene, spectrum};
use lapidary_studies::restraint::facets;

const SIDE: u32 = 96;
/// Comparison of the recipe.
const COMPARISON: &str = ">= material.throughput_limit";
/// Comparison that never ends a ray. It is compiled the same way, so both pictures use the same
/// numbers until a ray ends.
const NEVER: &str = ">= 0.0f * material.throughput_limit";

fn settings(rung: &str, rest_from_environment: bool) -> Settings {
    let rung = rung.parse().expect(rung);
    let usual = Settings::of_size(SIDE, SIDE);
    let gem = GemOptions { rest_from_environment, limit_throughput: Some(true), ..GemOptions::default() };
    Settings { rung, samples: 1, exposure: 0.5, gem, ..usual }
}

fn rendered(scene: &Scene, settings: &Settings, comparison: &str) -> Picture {
    let source = lapidary_wgsl::recipe_source(settings.rung.recipe());
    assert_eq!(source.matches(COMPARISON).count(), 1);
    let source = source.replace(COMPARISON, comparison);
    render::render_with(lapidary_testing::gpu(), scene, settings, &source).expect("rendered")
}

/// Returns a bound on the rounding error. The sum and product of each ray round once per followed
/// hit, and about ten times outside of the hits. The rounded values are at most the largest
/// radiance times the sum of the weights' magnitudes. The rays are added up.
fn rounding(scene: &Scene, settings: &Settings) -> f64 {
    let rung = settings.rung;
    let rays = if let Spectrum::Separate(count) = rung.spectrum() { count } else { 1 };
    let weight = largest_weight(&scene.objects[0].material, rung.spectrum());
    let largest = f64::from(settings.exposure) * f64::from(STUDIO_LARGEST) * weight;
    f64::from(2 * rung.hits() + rays + 16) * f64::from(f32::EPSILON) * largest
}

/// Returns the largest and the least difference of radiance times exposure (below 0 if light is
/// lost), and the share of covered pixels that differ.
fn difference(one: &Picture, other: &Picture, exposure: f32) -> (f64, f64, f64) {
    let (mut largest, mut least, mut changed, mut covered) = (0f64, 0f64, 0, 0);
    for (a, b) in one.linear.iter().zip(&other.linear).filter(|(a, _)| a[3] > 0.0) {
        let differences: Vec<f64> = (0..3).map(|k| f64::from(exposure) * (f64::from(b[k]) - f64::from(a[k]))).collect();
        assert!(differences.iter().all(|difference| difference.is_finite()));
        largest = differences.iter().copied().fold(largest, larger);
        least = differences.iter().copied().fold(least, f64::min);
        covered += 1;
        changed += usize::from(a != b);
    }
    assert!(covered > 500, "{covered}");
    (largest, least, f64::from(changed as u32) / f64::from(covered))
}

const CASES: [(&str, &str); 12] = [
    ("brilliant", "proxy-8"),
    ("brilliant", "proxy-8+tracker"),
    ("brilliant", "convex-16"),
    ("brilliant", "convex-16+tracker"),
    ("brilliant", "convex-16+paper"),
    ("brilliant", "convex-16+3"),
    ("brilliant", "convex-16+7"),
    ("ruby", "convex-16+tracker"),
    ("ruby", "bvh-16"),
    ("prism", "bvh-16+tracker"),
    ("prism", "convex-16+3"),
    ("bunny_stone", "bvh-16"),
];

#[test]
fn the_picture_differs_by_less_than_can_be_seen() {
    for (name, rung) in CASES {
        let scene = Scene::named(name).expect("built in");
        for rest_from_environment in [true, false] {
            let settings = settings(rung, rest_from_environment);
            let unlimited = rendered(&scene, &settings, NEVER);
            let limited = rendered(&scene, &settings, COMPARISON);
            let (largest, least, changed) = difference(&unlimited, &limited, settings.exposure);
            let bound = LEAST_DIFFERENCE + rounding(&scene, &settings);
            println!(
                "{name:12} {rung:18} rest {rest_from_environment:5}: {:+.3} to {:+.3} bounds, {:.1} % changed",
                least / bound,
                largest / bound,
                100.0 * changed
            );
            assert!(largest <= bound && -least <= bound, "{name} {rung}: {least:e} to {largest:e}, {bound:e}");
            // Dropped light can only be missing, except with wavelengths that have a negative
            // weight in a channel.
            if !rest_from_environment && !matches!(settings.rung.spectrum(), Spectrum::Separate(4..)) {
                assert!(largest <= rounding(&scene, &settings), "{name} {rung}: {largest:e}");
            }
            assert!(changed > 0.02, "{name} {rung}: {changed}");
            // Without the override there is no limit, and the picture is the same as with a limit
            // that no ray falls below.
            let without =
                Settings { gem: GemOptions { limit_throughput: Some(false), ..settings.gem }, ..settings.clone() };
            let without = render::render(lapidary_testing::gpu(), &scene, &without).expect("rendered");
            let (largest, least, _) = difference(&without, &limited, settings.exposure);
            assert!(largest <= bound && -least <= bound, "{name} {rung}: {least:e} to {largest:e}, {bound:e}");
        }
        let unlimited = settings(rung, true);
        let unlimited = Settings { gem: GemOptions { limit_throughput: Some(false), ..unlimited.gem }, ..unlimited };
        let [few, many] = [&settings(rung, true), &unlimited].map(|settings| facets(&scene, settings).expect("drawn"));
        println!("{name:12} {rung:18} {many:.2} facets, {few:.2} with the limit");
        assert!(few < 0.98 * many, "{name} {rung}: {few} {many}");
    }
}

/// The bound is not a formality: rays that end at thirty times the permitted remainder exceed it.
#[test]
fn a_limit_too_large_is_seen() {
    for rung in ["convex-16", "convex-16+tracker", "convex-16+3"] {
        let scene = Scene::named("brilliant").expect("built in");
        let settings = settings(rung, true);
        let unlimited = rendered(&scene, &settings, NEVER);
        let limited = rendered(&scene, &settings, ">= 30.0f * material.throughput_limit");
        let (largest, least, _) = difference(&unlimited, &limited, settings.exposure);
        println!("{rung}: {least:e} to {largest:e}");
        assert!(largest.max(-least) > 2.0 * (LEAST_DIFFERENCE + rounding(&scene, &settings)), "{rung}");
    }
}

/// Returns directions spread evenly over the sphere.
fn directions(count: u32) -> impl Iterator<Item = Vec3> {
    (0..count).map(move |k| {
        let y = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(count);
        let (sin, cos) = (f64::from(k) * std::f64::consts::PI * (3.0 - 5f64.sqrt())).sin_cos();
        let radius = (1.0 - y * y).sqrt();
        DVec3::new(radius * cos, y, radius * sin).as_vec3()
    })
}

#[test]
fn the_studio_is_nowhere_brighter_than_stated() {
    // The smallest light is 0.18 wide with its soft edges; neighbouring directions are 0.006 apart.
    let largest = directions(400_000).map(|direction| environment::studio(direction).max_element()).fold(0.0, larger);
    println!("{largest}");
    assert!(largest <= STUDIO_LARGEST && largest > 0.98 * STUDIO_LARGEST, "{largest}");
}

#[test]
fn a_map_is_nowhere_brighter_than_its_largest_texel() {
    let mut draws = Draws::of_row(5, 0);
    let pixels: Vec<[f32; 4]> = (0..16 * 8)
        .map(|_| [draws.between(0.0, 3.0), draws.between(0.0, 3.0), draws.between(0.0, 3.0), 100.0])
        .collect();
    let texels = pixels.iter().flat_map(|texel| &texel[..3]).copied().fold(0.0, larger);
    let map = Environment::Map(EnvironmentMap { width: 16, height: 8, pixels });
    assert_eq!(largest_radiance(&map), texels);
    let scene = Scene::named("brilliant").expect("built in");
    let settings = Settings { environment: map, ..Settings::of_size(8, 8) };
    let shading = Shading::new(&scene.objects[0].material, &settings);
    let found = directions(100_000).map(|direction| shading.environment(direction).max_element()).fold(0.0, larger);
    println!("{found} of {texels}");
    // A mix rounds three times, and two follow each other.
    assert!(found <= texels * (1.0 + 6.0 * f32::EPSILON) && found > 0.98 * texels, "{found} {texels}");
}

/// A map brighter than the studio ends fewer rays, and darkness ends all of them.
#[test]
fn the_limit_goes_by_environment_and_exposure() {
    let scene = Scene::named("brilliant").expect("built in");
    let counted = |radiance: f32, exposure: f32| {
        let map = EnvironmentMap { width: 2, height: 2, pixels: vec![[radiance; 4]; 4] };
        let usual = settings("convex-16", true);
        facets(&scene, &Settings { environment: Environment::Map(map), exposure, ..usual }).expect("drawn")
    };
    let [dim, bright, exposed, dark] = [counted(1.0, 1.0), counted(1e4, 1.0), counted(1.0, 1e4), counted(0.0, 1.0)];
    println!("{dim} {bright} {exposed} {dark}");
    assert!(dim < 0.95 * bright && bright == exposed && dark == 1.0, "{dim} {bright} {exposed} {dark}");
}

/// Each row of all matrices together sums to 1, so its magnitudes sum to more if an entry is
/// negative.
#[test]
fn weights_of_wavelengths_add_up_to_more_than_one() {
    let scene = Scene::named("brilliant").expect("built in");
    let weight = |spectrum| largest_weight(&scene.objects[0].material, spectrum);
    assert_eq!([Spectrum::One, Spectrum::Tracker, Spectrum::Paper, Spectrum::Separate(3)].map(weight), [1.0; 4]);
    for count in [7, 31] {
        let rows = spectrum::weights(count as usize).iter().fold(DVec3::ZERO, |sum, wavelength| {
            let [x, y, z] = [wavelength.weights.x_axis, wavelength.weights.y_axis, wavelength.weights.z_axis];
            sum + x.abs() + y.abs() + z.abs()
        });
        let found = weight(Spectrum::Separate(count));
        println!("{count}: {found}");
        assert!((found - rows.max_element()).abs() < 1e-5 && found > 1.5, "{count}: {found} {rows}");
    }
}

/// White surroundings stay white: the remainder of a ray at its end is taken from the environment.
#[test]
fn the_white_furnace_stays_white() {
    let ones = || Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[1.0; 4]; 8] });
    let scene = Scene::named("brilliant").expect("built in");
    for rung in ["convex-16", "convex-16+tracker"] {
        let settings = Settings { environment: ones(), ..settings(rung, true) };
        let picture = render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered");
        let rung: Rung = settings.rung;
        let bound = (16 + 8 * rung.hits()) as f32 * f32::EPSILON;
        let covered = picture.linear.iter().filter(|pixel| pixel[3] == 1.0);
        let worst = covered.flat_map(|pixel| &pixel[..3]).map(|value| (value - 1.0).abs()).fold(0.0, larger);
        assert!(worst <= bound, "{rung}: {worst:e}");
    }
}
