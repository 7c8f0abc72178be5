//! Diffusion through bodies, in whole pictures: near random walks, linear in the light, without the
//! grid's pattern.

use glam::{DQuat, DVec3, Vec3};
use lapidary_ladders::translucent;
use lapidary_plan::{Effect, Effects};
use lapidary_reference::random_walk::mesh::Origin;
use lapidary_render as render;
use lapidary_render::{DiffusionOptions, Picture, Settings, WalkOptions};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::surfaces::{rounded_box, sphere};
use lapidary_scene::{Camera, Density, DensityGrid, Environment, Light, Material, Medium, Mesh, Object, Scene};
use lapidary_snapshots::exposure::{distance, exposed_distance};
use lapidary_snapshots::frames::halved;
use lapidary_snapshots::motion::Motion;
use lapidary_snapshots::{EXR_SIDE, WalkedReference};
use lapidary_testing::pixels::{furthest, rays};
use std::sync::Arc;
use {lapidary_fresnel as fresnel, lapidary_half_space as half_space};

/// Draws by a rung, without environment and sheen.
pub(crate) fn drawn(scene: &Scene, rung: &str, side: u32) -> Picture {
    let settings = Settings {
        rung: rung.parse().expect(rung),
        samples: 1,
        without: Effects::of(&[Effect::Environment]).and(Effects::SHEEN),
        ..Settings::of_size(side, side)
    };
    render::render(lapidary_testing::gpu(), scene, &settings).expect("rendered")
}

/// Returns a body of this matter under some lights, seen at these angles.
pub(crate) fn scene_of(mesh: Mesh, medium: Medium, lights: Vec<Light>, (polar, azimuth): (f32, f32)) -> Scene {
    let mut scene = Scene::named("bunny").expect("built in");
    let material = Material { medium: Some(medium), ..scene.objects[0].material.clone() };
    scene.objects = vec![Object::new("body", mesh, material)];
    scene.lights = lights;
    scene.seen_from(polar, azimuth)
}

fn sun(toward: Vec3, irradiance: Vec3) -> Light {
    Light::Directional { toward: toward.normalize(), irradiance }
}

/// A ball of this matter, of a radius of 8, under a sun at its side.
fn ball(medium: Medium) -> Scene {
    let lights = vec![sun(Vec3::new(-0.6, 0.4, 0.7), Vec3::splat(4.0))];
    scene_of(sphere(8.0, 96), medium, lights, (85.0, 10.0))
}

/// The picture by this many random walks a pixel, without the environment.
fn walked(scene: &Scene, walks: u32, side: u32) -> Vec<[f32; 4]> {
    let settings = Settings {
        rung: "reference".parse().expect("a rung"),
        without: Effects::of(&[Effect::Environment]),
        walks: WalkOptions { walks, from: Origin::Lights, ..WalkOptions::default() },
        ..Settings::of_size(side, side)
    };
    render::render(lapidary_testing::gpu(), scene, &settings).expect("walked").linear
}

/// Distances from walks without the flux limiter, and with it.
fn without_and_with_limiter(scene: &Scene, walks: u32) -> [f64; 2] {
    let side = 32;
    let truth = walked(scene, walks, side);
    ["diffusion-64", "diffusion-limited-64"].map(|rung| distance(&halved(&drawn(scene, rung, 2 * side)).linear, &truth))
}

/// Returns each rung with a goal, the goal, and its shares of the distance of Lambert's law with shadows from a picture
/// of this side by random walks: at the best exposures, and at exposure 1.
fn shares(name: &str, scene: &Scene, truth: &[[f32; 4]], side: u32) -> Vec<(&'static str, f64, [f64; 2])> {
    let distances = |rung: &str| {
        let picture = halved(&drawn(scene, rung, 2 * side)).linear;
        [exposed_distance(&picture, truth), distance(&picture, truth)]
    };
    let lambert = distances("lambert-shadowed");
    let share = |(rung, most): (&'static str, f64)| {
        let found = distances(rung);
        let [best, one] = [0, 1].map(|place| found[place] / lambert[place]);
        println!("{name}, {rung}: {best:.2} and {one:.2} of Lambert's distance of {lambert:.3?}");
        (rung, most, [best, one])
    };
    translucent::SHARES.map(share).into()
}

/// Two scenes and a light that no constant was chosen by: they were compared once, when all was done.
#[test]
#[ignore = "walks for minutes"]
fn two_scenes_and_a_light_that_were_looked_at_once() {
    let side = 128;
    let drops = Motion::Topology.scene(0.6).expect("built in");
    let lit = Scene {
        lights: vec![sun(Vec3::new(0.6, 0.5, 0.6), Vec3::splat(4.0))],
        ..Scene::named("dragon").expect("built in")
    };
    for (name, scene) in [
        ("jade_ring", Scene::named("jade_ring").expect("built in")),
        ("drops", drops),
        ("dragon, light from the front", lit),
    ] {
        let truth = walked(&scene, 512, side);
        for (rung, most, [best, one]) in shares(name, &scene, &truth, side) {
            // Goals are missed here by up to .11, which docs/diffusion.md says.
            assert!(best.max(one) < most + 0.13, "{name}, {rung}: {best} {one}");
        }
    }
}

/// Matter that scatters forwards is drawn as its similar one, which scatters evenly and less: by g, (1 - g) times as much.
/// Deep inside that is exact; what is scattered a few times keeps its direction, so that walks lie three times as far from the
/// picture as those through the similar matter.
#[test]
#[ignore = "long; .ci/full runs it"]
fn forward_scattering_is_drawn_by_its_similar_matter() {
    let (side, g) = (32, 0.8);
    let even = Medium::isotropic(Vec3::new(0.8, 1.2, 2.0), Vec3::new(0.004, 0.02, 0.1));
    let forward = Medium { scattering: even.scattering / (1.0 - g), anisotropy: g, ..even.clone() };
    let [forward, even] = [forward, even].map(ball);
    let [found, similar] = [&forward, &even].map(|scene| drawn(scene, "diffusion-64", 2 * side));
    let most = furthest(&found.linear, &similar.linear);
    let brightest = similar.linear.iter().map(|pixel| pixel[0]).fold(0.0, f32::max);
    assert!(most < 1e-4 * brightest, "{most} of {brightest}");
    let [evenly, forwards] =
        [&even, &forward].map(|scene| distance(&halved(&found).linear, &walked(scene, 1024, side)));
    println!("distance from walks that scatter evenly {evenly:.3}, forwards {forwards:.3}");
    assert!(evenly < 0.08 && (2.0..5.0).contains(&(forwards / evenly)), "{evenly} {forwards}");
}

/// A ball with a core of extinction 2 about its middle, in matter of another extinction.
fn cored(shell: f32) -> Scene {
    let (core, radius, cells) = (2.0, 8.0, 64u32);
    let density = |index: u32| {
        let voxel = glam::UVec3::new(index % cells, index / cells % cells, index / (cells * cells));
        let place = ((voxel.as_vec3() + 0.5) / cells as f32 * 2.0 - 1.0) * radius;
        let share = (2.6 - place.length()).mul_add(2.0, 0.5).clamp(0.0, 1.0);
        share + (1.0 - share) * shell / core
    };
    let densities = (0..cells.pow(3)).map(density).collect();
    let [least, greatest] = [-radius, radius].map(Vec3::splat);
    let grid = DensityGrid::new(least, greatest, glam::UVec3::splat(cells), densities).expect("a grid");
    ball(Medium {
        density: Density::Grid(Arc::new(grid)),
        ..Medium::isotropic(Vec3::splat(core), Vec3::splat(0.002 * core))
    })
}

/// Light that diffuses out of a dense core streams through thin matter around it. Diffusion lets it flow faster than light
/// itself, so that the core is too dark; the flux limiter does not. In even matter it makes no difference, since at the
/// surface the flux is limited already.
#[test]
#[ignore = "long; .ci/full runs it"]
fn a_core_in_thin_matter_is_nearer_to_walks_with_the_flux_limiter() {
    for (shell, most, [least_gain, most_gain]) in
        [(0.01, 0.36, [0.2, 0.45]), (0.05, 0.24, [0.02, 0.3]), (0.2, 0.1, [-0.05, 0.05])]
    {
        let [linear, limited] = without_and_with_limiter(&cored(shell), 2048);
        println!("extinction 2 in {shell}: distance {linear:.3}, with the limiter {limited:.3}");
        let gain = 1.0 - limited / linear;
        assert!(linear < most && (least_gain..most_gain).contains(&gain), "{shell}: {linear} {limited}");
    }
}

/// Thin matter shows single scattering alone: what a half space would add belongs to light that would have collided.
#[test]
fn thin_balls_are_as_bright_as_walks() {
    for optical_radius in lapidary_testing::sampled([0.05f32, 0.3, 1.0, 3.0], 4) {
        let medium = Medium::isotropic(Vec3::splat(optical_radius / 8.0), Vec3::ZERO);
        let [linear, limited] = without_and_with_limiter(&ball(medium), 1024);
        println!("optical radius {optical_radius}: distance {linear:.3}, with the limiter {limited:.3}");
        // Of the thinnest the walks' own noise is most.
        let most = if optical_radius < 0.5 { 0.25 } else { 0.14 };
        assert!(linear < most && (limited - linear).abs() < 0.01, "{optical_radius}: {linear} {limited}");
    }
}

/// The goals of docs/diffusion.md: the share of the distance of Lambert's law with shadows, at the
/// best exposures and at exposure 1.
#[test]
fn pictures_are_nearer_to_random_walks_than_lambert_with_shadows_by_half() {
    for reference in lapidary_testing::sampled(WalkedReference::of("optical_path"), 4) {
        let truth = reference.picture(lapidary_testing::gpu()).expect(reference.scene).linear;
        let scene = Scene::named(reference.scene).expect("built in");
        for (rung, most, [best, one]) in shares(reference.scene, &scene, &truth, EXR_SIDE) {
            assert!(best <= most && one <= most, "{}, {rung}: {best} {one}", reference.scene);
        }
    }
}

#[test]
fn light_adds_up_and_absorption_only_darkens() {
    let medium = |absorption: f32| Medium::isotropic(Vec3::new(6.0, 4.0, 8.0), absorption * Vec3::new(1.0, 2.0, 0.5));
    let lights = [
        sun(Vec3::new(1.0, 0.5, 0.2), Vec3::new(1.0, 0.4, 0.2)),
        Light::Point { position: Vec3::new(-1.5, 1.0, 1.0), intensity: Vec3::new(0.5, 1.0, 2.0) },
    ];
    let picture = |lights: Vec<Light>, absorption: f32| {
        drawn(&scene_of(sphere(1.0, 64), medium(absorption), lights, (80.0, 10.0)), "diffusion-32", 64).linear
    };
    let [one, other] = lights.map(|light| picture(vec![light], 0.02));
    let both = picture(lights.to_vec(), 0.02);
    let brightest = both.iter().flat_map(|pixel| &pixel[..3]).fold(0.0f32, |most, value| most.max(*value));
    let mut worst = 0.0f32;
    for ((both, one), other) in both.iter().zip(&one).zip(&other) {
        for channel in 0..3 {
            worst = worst.max((both[channel] - one[channel] - other[channel]).abs());
        }
    }
    // Fluence is kept to 16 bits of its fourth root, and light in whole units.
    assert!(worst < 2e-3 * brightest, "{worst} of {brightest}");
    // No pixel gets brighter, but for the fluence's last digit.
    let mut brighter = 0.0f32;
    for absorption in [0.04, 0.4] {
        let darker = picture(lights.to_vec(), absorption);
        for channel in 0..3 {
            let sum = |picture: &[[f32; 4]]| picture.iter().map(|pixel| f64::from(pixel[channel])).sum::<f64>();
            assert!(sum(&darker) < sum(&both), "{absorption}, {channel}");
            for (clear, dark) in both.iter().zip(&darker) {
                assert!(dark[channel] <= 1.002 * clear[channel], "{dark:?} {clear:?}");
                brighter = brighter.max(dark[channel] / clear[channel].max(1e-3 * brightest));
            }
        }
    }
    println!("with more absorption a pixel is {brighter:.3} of what it was at most");
}

/// A thin wall, aslant in the grid and lit from behind, is as bright everywhere; a grid that showed
/// would make stripes.
#[test]
fn a_thin_wall_lit_from_behind_shows_no_voxels() {
    let turn = DQuat::from_rotation_y(0.35) * DQuat::from_rotation_x(0.25);
    let wall = rounded_box(DVec3::new(1.0, 1.0, 0.03), 0.01, 2).placed(turn, DVec3::ZERO);
    let medium = Medium::isotropic(Vec3::splat(12.0), Vec3::splat(0.01));
    let normal = (turn * DVec3::Z).as_vec3();
    let lights = vec![sun(-normal, Vec3::ONE)];
    let scene = scene_of(wall, medium, lights, (90.0, 0.0));
    let side = 128;
    let spread = |rung: &str| {
        let picture = drawn(&scene, rung, side).linear;
        // The middle of the wall, where its edges do not show.
        let middle = (side / 4)..(3 * side / 4);
        let values: Vec<f64> = middle
            .clone()
            .flat_map(|y| middle.clone().map(move |x| (y * side + x) as usize))
            .map(|place| f64::from(picture[place][1]))
            .collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
        assert!(mean > 0.0, "{rung}: black");
        square.sqrt() / mean
    };
    let [paths, coarse, fine] = ["godunov-64", "diffusion-32", "diffusion-64"].map(spread);
    println!("spread over the wall: godunov-64 {paths:.3}, diffusion-32 {coarse:.3}, diffusion-64 {fine:.3}");
    // What is left falls with the second power of the spacing: it is the fluence's bend between nodes.
    assert!(fine < 0.02 && fine < 0.5 * coarse, "{coarse} {fine}");
}

/// A wide slab of this matter, its upper side at a height of 0, whose middle no edge reaches.
fn slab(medium: Medium, ior: f32, lights: Vec<Light>, eye_cosine: f32) -> Scene {
    let half = DVec3::new(60.0, 15.0, 60.0);
    // Aslant in the grid, so that cells are cut at all shares.
    let turn = DQuat::from_rotation_x(0.09) * DQuat::from_rotation_z(0.07);
    let mesh = rounded_box(half, 0.5, 2).placed(turn, -half.y * (turn * DVec3::Y));
    let mut scene = scene_of(mesh, medium, lights, (80.0, 10.0));
    scene.objects[0].material.ior = ior;
    let up = (turn * DVec3::Y).as_vec3();
    let aside = (turn * DVec3::new(0.6, 0.0, 0.8)).as_vec3();
    let toward = eye_cosine * up + (1.0 - eye_cosine * eye_cosine).sqrt() * aside;
    scene.camera = Camera::upright(500.0 * toward, Vec3::ZERO, 0.02);
    scene
}

/// Returns a direction whose cosine with the slab's upper side is this.
fn above(cosine: f32) -> Vec3 {
    let turn = DQuat::from_rotation_x(0.09) * DQuat::from_rotation_z(0.07);
    (turn * DVec3::Y).as_vec3() * cosine + (1.0 - cosine * cosine).sqrt() * (turn * DVec3::X).as_vec3()
}

/// Mean radiance of a picture in each channel.
fn mean(picture: &Picture) -> Vec3 {
    let sum = picture.linear.iter().map(|pixel| Vec3::from_slice(&pixel[..3])).sum::<Vec3>();
    sum / picture.linear.len() as f32
}

/// A half space has a closed form: Chandrasekhar's law, and with a boundary the module's.
#[test]
#[ignore = "long; .ci/full runs it"]
fn a_wide_slab_is_as_bright_as_a_half_space() {
    // Mean free paths of .25 to 2, albedos of .99 to .7; the grid's spacing is 3.8 at 32 cells.
    let [scattering, absorption] = [Vec3::new(1.98, 0.98, 0.35), Vec3::new(0.02, 0.02, 0.15)];
    let medium = Medium::isotropic(scattering, absorption);
    let gamma = (absorption / (scattering + absorption)).map(f32::sqrt);
    let mut worst = 0.0f32;
    for ior in [1.0f32, 1.4] {
        let edge = half_space::edge(ior);
        for eye in [1.0f32, 0.6, 0.25] {
            for light in [1.0f32, 0.5, 0.2] {
                let scene = slab(medium.clone(), ior, vec![sun(above(light), Vec3::ONE)], eye);
                let without = Effects::of(&[Effect::Environment, Effect::Microfacet, Effect::Reflection]);
                let settings = Settings {
                    rung: "diffusion-64".parse().expect("a rung"),
                    samples: 1,
                    without,
                    diffusion: DiffusionOptions { cycles: 12, most_cycles: 12, ..DiffusionOptions::default() },
                    ..Settings::of_size(16, 16)
                };
                let found = mean(&render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered"));
                let passed = [eye, light].map(|cosine| 1.0 - fresnel::dielectric(cosine, ior));
                let expected = gamma.map(|gamma| {
                    let gain = half_space::gain(gamma, edge);
                    light * passed[0] * passed[1] * half_space::dielectric(eye, light, gamma, ior, edge, gain)
                });
                let off = (found / expected - 1.0).abs().max_element();
                println!("index {ior}, eye {eye}, light {light}: {:.3}", found / expected);
                worst = worst.max(off);
            }
        }
    }
    println!("worst {worst:.3}");
    // A model of the grid in one dimension errs by 4 % where a spacing is 3.75 mean free paths, as here in red:
    // by the fluence's bend between nodes, which a finer grid shows.
    assert!(worst < 0.055, "{worst}");
}

/// Where nothing is absorbed, a body under a radiance of 1 from all around sends 1 back, with what its surface reflects,
/// rough or polished, whatever its optical depth.
#[test]
fn a_white_body_in_a_white_room_cannot_be_seen() {
    let (width, height) = (8, 4);
    let pixels = vec![[1.0, 1.0, 1.0, 1.0]; 32];
    let room = Environment::Map(EnvironmentMap { width, height, pixels });
    let cases = [
        (20.0, 1.0f32, 0.5),
        (3.0, 1.0, 0.5),
        (0.5, 1.0, 0.5),
        (20.0, 1.5, 0.5),
        (3.0, 1.5, 0.1),
        (3.0, 1.5, 1.0),
        (3.0, 1.5, 0.0),
    ];
    for (extinction, ior, roughness) in cases {
        let medium = Medium::isotropic(Vec3::splat(extinction), Vec3::ZERO);
        let mut scene = scene_of(sphere(1.0, 96), medium, Vec::new(), (80.0, 10.0));
        scene.objects[0].material.ior = ior;
        scene.objects[0].material.roughness = roughness;
        let settings = Settings {
            rung: "diffusion-32".parse().expect("a rung"),
            samples: 1,
            environment: room.clone(),
            diffusion: DiffusionOptions { cycles: 12, most_cycles: 12, ..DiffusionOptions::default() },
            ..Settings::of_size(64, 64)
        };
        let picture = render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered");
        let eye = scene.camera.eye.as_dvec3();
        let mut worst = 0.0f32;
        for (pixel, (direction, _)) in picture.linear.iter().zip(rays(&scene, &picture)) {
            let aside = eye.reject_from(direction).length();
            if aside > 0.97 {
                continue;
            }
            worst = worst.max(Vec3::from_slice(&pixel[..3]).map(|part| (part - 1.0).abs()).max_element());
        }
        println!("extinction {extinction}, index {ior}, roughness {roughness}: off by {worst:.4}");
        assert!(worst < 0.02, "extinction {extinction}, index {ior}, roughness {roughness}: {worst}");
    }
}
