//! The recipe `cdrf_shading` against the promises of its parts: spheres, whose curvature is known,
//! for every rung; the environment by quadrature; effects that are off; and invalid scenes.

use glam::{DVec3, Vec3};
use lapidary_assay::extremum::{larger, largest};
use lapidary_cdrf::oracle;
use lapidary_plan::{Effect, Effects};
use lapidary_render as render;
use lapidary_render::{Curvature, DiffuseOptions, Picture, RenderError, Settings};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::light::Arrival;
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{Environment, Light, Lobe, Material, Object, Scene};
use lapidary_snapshots::exposure::exposed_distance;
use lapidary_testing::pixels::on_the_ball;
use std::f64::consts::{FRAC_1_PI, PI};

const SIDE: u32 = 160;

fn by(curvature: Curvature) -> DiffuseOptions {
    DiffuseOptions { curvature, ..DiffuseOptions::default() }
}

fn settings(rung: &str) -> Settings {
    let rung = rung.parse().expect(rung);
    Settings {
        rung,
        samples: 1,
        without: Effects::of(&[Effect::Environment]).and(Effects::SHEEN),
        ..Settings::of_size(SIDE, SIDE)
    }
}

fn draw(scene: &Scene, settings: &Settings) -> Picture {
    render::render(lapidary_testing::gpu(), scene, settings).expect("rendered")
}

/// A sphere of this radius and these widths, under a sun and a lamp.
fn ball(radius: f64, sigma0: Vec3) -> Scene {
    let mut scene = Scene::named("skin").expect("built in");
    let material = Material { sigma0: Some(sigma0), ..scene.objects[0].material.clone() };
    scene.objects = vec![Object::new("ball", sphere(radius, 256), material)];
    let lamp = 2.5 * radius as f32 * Vec3::new(0.6, 0.0, 0.8);
    scene.lights = vec![
        Light::Directional { toward: Vec3::new(-0.8, 0.6, 0.0), irradiance: Vec3::new(2.0, 1.5, 1.0) },
        Light::Point { position: lamp, intensity: (radius * radius) as f32 * Vec3::new(0.5, 1.0, 2.0) },
    ];
    scene.seen_from(80.0, 20.0)
}

/// Returns the expected radiance at a point of a ball about the origin, by the oracle's convolution
/// for each light.
fn expected(scene: &Scene, position: DVec3, radius: f64, reflectance: impl Fn(f64, f64) -> f64) -> DVec3 {
    let material = &scene.objects[0].material;
    let normal = position.normalize();
    let mut received = DVec3::ZERO;
    for light in &scene.lights {
        let Arrival { direction: toward, irradiance, .. } = light.arrival(position);
        let sigma = material.sigma0.expect("given").as_dvec3() / radius;
        received +=
            irradiance * DVec3::from_array(sigma.to_array().map(|sigma| reflectance(normal.dot(toward), sigma)));
    }
    material.base_color.as_dvec3() * received * FRAC_1_PI
}

/// Error of the mesh. Normals interpolated over 256 columns are off by (2 pi / 256)^2 / 8 = 7.5e-5
/// in length, and by less in direction. Curvature from derivatives is off by a tenth of a per cent in
/// the median, as in the curvature's own test. Its effect is that error times sigma times the
/// function's largest slope over sigma, 0.4.
const MESH: f64 = 5e-4;

#[test]
fn every_rung_shows_the_convolution_on_a_sphere() {
    // The rungs' own largest errors, as in the page's table.
    let rungs = [
        ("lambert", 0.0),
        ("table-256-rgba8", 2.1e-3),
        ("table-257-rgba16f", 6e-4),
        ("table-257-r32f", 6e-4),
        ("cheap", 1.5e-5),
        ("accurate", 1e-6),
        ("quadrature", 1e-6),
        ("spherical", 2e-6),
    ];
    let curvatures = [Curvature::Mean, Curvature::Towards, Curvature::Vertex];
    for (radius, sigma0) in [(10.0, Vec3::new(8.0, 4.0, 1.0)), (0.01, Vec3::new(0.0, 0.001, 0.004))] {
        let scene = ball(radius, sigma0);
        for (rung, error) in rungs {
            for curvature in if rung == "accurate" { &curvatures[..] } else { &curvatures[..1] } {
                let curvature = *curvature;
                let picture = draw(&scene, &Settings { diffuse: by(curvature), ..settings(rung) });
                let mut worst = 0.0f64;
                for (position, found) in on_the_ball(&scene, &picture) {
                    let truth = expected(&scene, position, radius, |cosine, sigma| match rung {
                        "lambert" => cosine.max(0.0),
                        "spherical" => oracle::spherical(cosine, sigma),
                        _ => oracle::accurate(cosine, sigma),
                    });
                    worst = larger(worst, largest((found - truth).abs().to_array()));
                }
                // Both lights together, times the albedo over pi.
                let scale = 1.2;
                println!("{rung} {}, radius {radius}: off by {worst:.1e}", curvature.name());
                assert!(worst <= scale * (error + MESH), "{rung} {curvature:?} {radius}: {worst}");
            }
        }
    }
}

/// Checks a spot, a disc of light with a soft edge, on a ball that a sun also lights: every light
/// of a scene with a spot passes through the cone's lines.
#[test]
fn a_spot_shows_its_cone() {
    let radius = 10.0;
    let mut scene = ball(radius, Vec3::new(3.0, 2.0, 1.0));
    scene.lights[1] = Light::Spot {
        position: Vec3::new(5.0, 20.0, 25.0),
        direction: Vec3::new(-0.25, -0.6, -0.8).normalize(),
        intensity: Vec3::new(900.0, 1500.0, 2500.0),
        inner_angle: 0.1,
        outer_angle: 0.25,
    };
    for rung in ["lambert", "accurate"] {
        let (mut worst, mut brightest, mut soft) = (0.0f64, 0.0f64, 0);
        for (position, found) in on_the_ball(&scene, &draw(&scene, &settings(rung))) {
            let truth = expected(&scene, position, radius, |cosine, sigma| match rung {
                "lambert" => cosine.max(0.0),
                _ => oracle::accurate(cosine, sigma),
            });
            let share = scene.lights[1].arrival(position).irradiance.x
                * position.distance_squared(DVec3::new(5.0, 20.0, 25.0))
                / 900.0;
            soft += u32::from((0.05..0.95).contains(&share));
            worst = larger(worst, largest((found - truth).abs().to_array()));
            brightest = larger(brightest, truth.max_element());
        }
        println!("{rung}: off by {worst:.1e} where the brightest is {brightest:.2}, {soft} pixels of the soft edge");
        // The position of a pixel of a flat triangle is off by (2 pi / 256)^2 / 8 of the radius,
        // 7.5e-4, at a distance of 30. The steepest slope of the share is
        // 2 / (cos .1 - cos .25) sin .25 = 19 per radian.
        assert!(soft > 500 && worst < brightest * (MESH + 1e-3), "{rung}: {worst}");
    }
}

/// The smaller the sphere, the further light creeps past the terminator, and red further than blue.
#[test]
fn light_creeps_further_on_smaller_spheres_and_red_further_than_blue() {
    let radii = [40.0, 24.0, 14.0, 8.0, 5.0];
    let past = radii.map(|radius| {
        let mut scene =
            ball(radius, Scene::named("skin").expect("built in").objects[0].material.sigma0.expect("skin's"));
        scene.lights.truncate(1);
        scene.lights[0] = Light::Directional { toward: Vec3::NEG_X, irradiance: Vec3::ONE };
        let white = Material { base_color: Vec3::ONE, ..scene.objects[0].material.clone() };
        scene.objects[0].material = white;
        let picture = draw(&scene, &settings("accurate"));
        let (sum, count) = on_the_ball(&scene, &picture)
            .into_iter()
            .filter(|(position, _)| (0.2..0.3).contains(&(position.x / radius)))
            .fold((DVec3::ZERO, 0), |(sum, count), (_, found)| (sum + found, count + 1));
        assert!(count > 50);
        PI * sum / f64::from(count)
    });
    println!("share of the sun's light 12 to 17 degrees past the terminator: {past:.3?}");
    assert!(past.windows(2).all(|pair| pair[1].cmpgt(pair[0]).all()), "{past:?}");
    assert!(past.iter().all(|share| share.x > share.y && share.y > share.z), "{past:?}");
}

/// Checks the environment under the spherical form, summed over all directions.
#[test]
fn the_environment_is_the_integral_of_the_spherical_form() {
    let ones = Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[1.0; 4]; 8] });
    let scene = Scene { lights: Vec::new(), ..ball(10.0, Vec3::new(8.0, 3.0, 0.0)) };
    let albedo = lapidary_plan::thickness::color(&scene.objects[0].material, &[]).as_dvec3();
    for at_vertices in lapidary_testing::sampled([false, true], 2) {
        let lit = |environment: &Environment| Settings {
            without: Effects::SHEEN,
            diffuse: DiffuseOptions { environment_at_vertices: at_vertices, ..DiffuseOptions::default() },
            environment: environment.clone(),
            ..settings("spherical")
        };
        // With uniform radiance, the surface returns its albedo, at any width.
        for (_, found) in on_the_ball(&scene, &draw(&scene, &lit(&ones))) {
            assert!(largest((found - albedo).abs().to_array()) < 1e-5, "{found} {albedo}");
        }
        let picture = draw(&scene, &lit(&Environment::Studio));
        let pixels = on_the_ball(&scene, &picture);
        let (mut worst, mut squares, mut brightest) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        let chosen: Vec<_> = pixels.iter().step_by(pixels.len() / 40).collect();
        for (position, found) in &chosen {
            let truth = albedo * integral(position.normalize(), DVec3::new(0.8, 0.3, 0.0)) * FRAC_1_PI;
            let off = (*found - truth).abs();
            worst = worst.max(off);
            squares += off * off;
            brightest = brightest.max(truth);
        }
        let rms = (squares / chosen.len() as f64).powf(0.5) / brightest;
        println!(
            "at vertices {at_vertices}: widths .8, .3, 0: largest error {:.4}, rms {rms:.4}, of the brightest",
            worst / brightest
        );
        // For one small light alone, the omitted degrees hold up to 0.06. The studio has nine
        // lights and a tent.
        assert!((worst / brightest).max_element() < 0.02, "{worst} {brightest}");
        assert!(rms.x < 0.003 && rms.x < rms.z, "{rms}");
    }
}

/// Returns ∫ f_r L over the sphere for three widths, on a grid of 256 × 512 directions.
fn integral(normal: DVec3, sigma: DVec3) -> DVec3 {
    const ROWS: u32 = 256;
    let mut sum = DVec3::ZERO;
    for row in 0..ROWS {
        let polar = PI * (f64::from(row) + 0.5) / f64::from(ROWS);
        let edges = [row, row + 1].map(|edge| (PI * f64::from(edge) / f64::from(ROWS)).cos());
        let solid_angle = (edges[0] - edges[1]) * PI / f64::from(ROWS);
        for column in 0..2 * ROWS {
            let azimuth = PI * (f64::from(column) + 0.5) / f64::from(ROWS);
            let (sine, height) = polar.sin_cos();
            let direction = DVec3::new(sine * azimuth.cos(), height, sine * azimuth.sin());
            let cosine = normal.dot(direction) as f32;
            let f = sigma.to_array().map(|sigma| f64::from(lapidary_cdrf::spherical(cosine, sigma as f32)));
            sum += solid_angle * DVec3::from_array(f) * lapidary_environment::oracle::studio(direction);
        }
    }
    sum
}

/// On a torus that is curved much more one way than the other, the blur in the texture and the
/// reflectance agree for light along the tube's round. Both are far from Lambert's law.
#[test]
fn the_blur_agrees_with_the_reflectance_on_a_slender_ring() {
    let mut scene = Scene::named("wax_ring").expect("built in");
    scene.objects[0].mesh = lapidary_scene::surfaces::torus(40.0, 4.0, 320, 64);
    scene.objects[0].material.sigma0 = Some(Vec3::splat(2.0));
    scene.lights = vec![Light::Directional { toward: Vec3::Y, irradiance: Vec3::ONE }];
    let scene = scene.seen_from(60.0, 0.0);
    let [lambert, blur, towards] = ["lambert", "blur", "accurate"]
        .map(|rung| draw(&scene, &Settings { diffuse: by(Curvature::Towards), ..settings(rung) }));
    let distance = |picture: &Picture| {
        let squares = picture.linear.iter().zip(&blur.linear).map(|(a, b)| f64::from(a[1] - b[1]).powi(2));
        (squares.sum::<f64>() / picture.linear.iter().filter(|pixel| pixel[3] > 0.0).count() as f64).sqrt()
    };
    let [lambert, towards] = [distance(&lambert), distance(&towards)];
    println!("root mean square from the blur: Lambert {lambert:.4}, the reflectance {towards:.4}");
    assert!(towards < 0.1 * lambert, "{towards} {lambert}");
}

#[test]
fn nothing_that_a_mesh_or_material_may_hold_makes_a_black_or_broken_pixel() {
    let rungs = [
        "lambert",
        "wrap",
        "table-256-rgba8",
        "table-257-rgba16f",
        "table-257-r32f",
        "cheap",
        "accurate",
        "quadrature",
        "spherical",
        "power",
        "drift",
        "blur",
    ];
    let by_rung = rungs.map(|rung| (rung, Curvature::Mean));
    let by_curvature = Curvature::ALL.map(|curvature| ("accurate", curvature));
    for (rung, curvature) in by_rung.into_iter().chain(by_curvature) {
        // Balls side by side, each of a different kind.
        let mut scene = ball(10.0, Vec3::ONE);
        let sound = scene.objects[0].clone();
        let kinds: [(Vec3, Option<Vec3>); 8] = [
            (Vec3::ZERO, None),
            (Vec3::NEG_ONE, None),
            (Vec3::new(f32::NAN, 1.0, f32::NAN), None),
            (Vec3::new(f32::INFINITY, 1.0, 0.0), None),
            (Vec3::splat(1e-40), None),
            (Vec3::splat(1e30), None),
            (Vec3::splat(3.0), Some(Vec3::ZERO)),
            (Vec3::splat(3.0), Some(Vec3::Y)),
        ];
        scene.objects = (0..)
            .zip(kinds)
            .map(|(place, (sigma0, normal))| {
                let offset = DVec3::new(f64::from(place % 3), f64::from(place / 3), 0.0) * 25.0;
                let mut object = Object { mesh: sound.mesh.placed(glam::DQuat::IDENTITY, offset), ..sound.clone() };
                object.material.sigma0 = Some(sigma0);
                if let Some(normal) = normal {
                    object.mesh.normals.fill(normal);
                }
                // One of the triangles has no area.
                object.mesh.indices.extend([0, 0, 0]);
                object
            })
            .collect();
        let picture = draw(
            &scene.seen_from(90.0, 0.0),
            &Settings { without: Effects::SHEEN, half_space: true, diffuse: by(curvature), ..settings(rung) },
        );
        let mut seen = 0;
        for pixel in picture.linear.iter().filter(|pixel| pixel[3] == 1.0) {
            let finite = pixel.iter().all(|value| value.is_finite() && *value >= 0.0);
            assert!(finite && pixel[..3].iter().any(|value| *value > 0.0), "{rung} {curvature:?}: {pixel:?}");
            seen += 1;
        }
        assert!(seen > 5000, "{seen} pixels");
    }
}

#[test]
fn what_is_off_leaves_no_trace() {
    let scene = ball(10.0, Vec3::ZERO);
    let bits = |settings: &Settings| draw(&scene, settings).linear;
    assert_eq!(bits(&settings("accurate")), bits(&settings("lambert")), "no width, no scattering");
    let lit = Settings { without: Effects::SHEEN, ..settings("lambert") };
    assert_ne!(bits(&lit), bits(&settings("lambert")));
    let reflecting = Settings { without: Effects::of(&[Effect::Environment]), ..settings("lambert") };
    assert_ne!(bits(&reflecting), bits(&settings("lambert")));
    let mut matched = ball(10.0, Vec3::ZERO);
    matched.objects[0].material.ior = 1.0;
    assert_eq!(draw(&matched, &reflecting).linear, bits(&settings("lambert")), "an index of 1 reflects nothing");
}

/// Bodies of other materials do not change the picture of a body.
#[test]
fn a_polished_and_a_rough_body_do_not_mix() {
    let body = |roughness: f32, place: f64| {
        let mut object = ball(10.0, Vec3::splat(2.0)).objects.remove(0);
        object.material.roughness = roughness;
        object.mesh = object.mesh.placed(glam::DQuat::IDENTITY, DVec3::new(place, 0.0, 0.0));
        object
    };
    let mut scene = ball(10.0, Vec3::ONE);
    scene.objects = vec![body(0.0, -12.0), body(0.4, 12.0)];
    let scene = scene.seen_from(90.0, 0.0);
    let reflecting = Settings { without: Effects::of(&[Effect::Environment]), ..settings("accurate") };
    let both = draw(&scene, &reflecting).linear;
    for keep in 0..2 {
        let alone = Scene { objects: vec![scene.objects[keep].clone()], ..scene.clone() };
        let pixels = draw(&alone, &reflecting).linear;
        let mut seen = 0;
        for (pixel, together) in pixels.iter().zip(&both).filter(|(pixel, _)| pixel[3] == 1.0) {
            let same = pixel.iter().zip(together).all(|(a, b)| (a - b).abs() <= 1e-5 * a.abs().max(1.0));
            assert!(same, "{pixel:?} {together:?}");
            seen += 1;
        }
        assert!(seen > 2000, "{seen}");
    }
}

/// Forms that differ by less than a mesh differs from its sphere are still told apart.
#[test]
fn near_forms_are_as_near_as_their_errors() {
    let scene = ball(10.0, Vec3::new(3.4, 2.5, 1.0));
    let [cheap, accurate, quadrature] =
        ["cheap", "accurate", "quadrature"].map(|rung| draw(&scene, &settings(rung)).linear);
    let difference = |other: &[[f32; 4]]| {
        let pairs = other.iter().flatten().zip(accurate.iter().flatten());
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, larger)
    };
    let (cheap, quadrature) = (difference(&cheap), difference(&quadrature));
    println!("from the accurate form: cheap {cheap:.1e}, quadrature {quadrature:.1e}");
    // The cheap form may be off by 1.5e-5 times the light of both lights after the albedo, the
    // accurate form by a hundredth of that.
    assert!((1e-6..2e-5).contains(&cheap), "{cheap}");
    assert!(quadrature > 0.0 && quadrature < 2e-6, "{quadrature}");
}

#[test]
fn bad_input_is_refused() {
    let refused =
        |scene: &Scene, rung: &str| render::render(lapidary_testing::gpu(), scene, &settings(rung)).expect_err(rung);
    let mut scene = ball(10.0, Vec3::ONE);
    scene.objects[0].mesh.uvs[0].x = 1.5;
    let error = refused(&scene, "blur");
    assert!(matches!(error, RenderError::TextureCoordinatesOutside { .. }), "{error}");
    scene.objects[0].mesh.uvs.clear();
    let error = refused(&scene, "blur");
    assert!(
        matches!(error, RenderError::NoTextureCoordinates { .. }) && error.to_string().contains("TEXCOORD_0"),
        "{error}"
    );
    // Neither a width nor a medium to derive it from.
    (scene.objects[0].material.sigma0, scene.objects[0].material.medium) = (None, None);
    let error = refused(&scene, "accurate");
    assert!(matches!(error, RenderError::NoSigma0 { .. }) && error.to_string().contains("sigma0"), "{error}");
    scene.objects[0].material.medium = None;
    let stone = Scene::named("brilliant").expect("built in");
    assert!(matches!(refused(&stone, "cheap"), RenderError::NoSigma0 { .. }));
}

/// An environment without light.
fn night() -> Environment {
    Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[0.0, 0.0, 0.0, 1.0]; 8] })
}

/// A ball that spreads no light, of skin's matter, and settings that draw it by the law of a half space:
/// index-matched, or polished with a boundary, in which nothing is reflected.
fn half_spaces() -> [(Scene, Settings, f64); 2] {
    let scene = ball(10.0, Vec3::ZERO);
    let mut polished = scene.clone();
    polished.objects[0].material.roughness = 0.0;
    let index = f64::from(polished.objects[0].material.ior);
    let law = Settings { half_space: true, ..settings("lambert") };
    let dark = Effects::of(&[Effect::Environment]);
    let behind = Settings { without: dark, environment: night(), ..law.clone() };
    [(scene, law, 1.0), (polished, behind, index)]
}

/// The radiance at each pixel of a ball is that of the law, between the boundary's shares that pass.
#[test]
fn a_surface_sends_back_what_the_law_of_a_half_space_says() {
    use lapidary_fresnel::oracle::dielectric;
    use lapidary_half_space as half_space;
    for (scene, settings, index) in half_spaces() {
        let material = &scene.objects[0].material;
        let albedo = lapidary_plan::thickness::albedo(material).expect("a medium");
        let eye = scene.camera.eye.as_dvec3();
        let edge = half_space::edge(index as f32);
        let (mut worst, mut brightest) = (0.0f64, 0.0f64);
        for (position, found) in on_the_ball(&scene, &draw(&scene, &settings)) {
            let (normal, toward) = (position.normalize(), (eye - position).normalize());
            let mut truth = DVec3::ZERO;
            for light in &scene.lights {
                let Arrival { direction, irradiance, .. } = light.arrival(position);
                let (seen, lit) = (normal.dot(toward), normal.dot(direction).max(0.0));
                for channel in 0..3 {
                    let gamma = half_space::gamma(albedo[channel], 0.0);
                    let gain = half_space::gain(gamma, edge);
                    let law = half_space::dielectric(seen as f32, lit as f32, gamma, index as f32, edge, gain);
                    let color = f64::from(material.base_color[channel] / half_space::reflectance(gamma));
                    let passed = (1.0 - dielectric(seen, index)) * (1.0 - dielectric(lit, index));
                    truth[channel] += color * passed * lit * f64::from(law) * irradiance[channel];
                }
            }
            worst = larger(worst, largest((found - truth).abs().to_array()));
            brightest = larger(brightest, truth.max_element());
        }
        println!("index {index}: off by {worst:.1e} where the brightest is {brightest:.2}");
        // Near the terminator the boundary's share rises with a slope of ten.
        assert!(worst < 10.0 * MESH * brightest, "{index}: {worst} {brightest}");
        assert_ne!(
            draw(&scene, &settings).linear,
            draw(&scene, &Settings { half_space: false, ..settings.clone() }).linear
        );
    }
}

/// Under light from everywhere, as suns or as an environment, a surface sends back its base color in the
/// mean over all directions; with a boundary, what the boundary lets through.
#[test]
fn the_law_of_a_half_space_keeps_the_energy() {
    use lapidary_half_space as half_space;
    const SUNS: u32 = 600;
    const BINS: usize = 16;
    let suns = (0..SUNS).map(|sun| {
        // Fibonacci's lattice on the sphere.
        let height = 1.0 - (2.0 * sun as f32 + 1.0) / SUNS as f32;
        let azimuth = 2.399_963_2 * sun as f32;
        let across = (1.0 - height * height).sqrt();
        let toward = Vec3::new(across * azimuth.cos(), height, across * azimuth.sin());
        Light::Directional { toward, irradiance: Vec3::splat(4.0 * std::f32::consts::PI / SUNS as f32) }
    });
    let suns: Vec<Light> = suns.collect();
    let white = Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[1.0; 4]; 8] });
    for (scene, settings, index) in half_spaces() {
        let material = &scene.objects[0].material;
        let albedo = lapidary_plan::thickness::albedo(material).expect("a medium");
        let expected = |channel: usize| {
            let gamma = half_space::gamma(albedo[channel], 0.0);
            let edge = half_space::edge(index as f32);
            let entered = half_space::entered(gamma, edge) * (1.0 - edge * edge) * (index * index) as f32;
            f64::from(material.base_color[channel] * entered / half_space::reflectance(gamma))
        };
        let by_suns = (Scene { lights: suns.clone(), ..scene.clone() }, settings.clone());
        let without = Effects::SHEEN;
        let around = Settings { without, environment: white.clone(), ..settings.clone() };
        let by_environment = (Scene { lights: Vec::new(), ..scene.clone() }, around);
        // The environment would also be reflected by a boundary, and is compared without one.
        let cases = if index == 1.0 { vec![by_suns, by_environment] } else { vec![by_suns] };
        for (scene, settings) in cases {
            let eye = scene.camera.eye.as_dvec3();
            // Equal intervals of the squared cosine have equal weights; the outermost is hardly seen.
            let mut bins = [(DVec3::ZERO, 0.0); BINS];
            for (position, found) in on_the_ball(&scene, &draw(&scene, &settings)) {
                let cosine = position.normalize().dot((eye - position).normalize());
                let (sum, count) = &mut bins[((cosine * cosine * BINS as f64) as usize).min(BINS - 1)];
                *sum += found;
                *count += 1.0;
            }
            assert!(bins.iter().all(|(_, count)| *count > 20.0), "{bins:?}");
            let mean = bins.iter().map(|(sum, count)| *sum / *count).sum::<DVec3>() / BINS as f64;
            for channel in 0..3 {
                let share = mean[channel] / expected(channel);
                println!("index {index}, {} lights, channel {channel}: {share:.4} of the light", scene.lights.len());
                assert!((share - 1.0).abs() < 0.01, "{index}: {mean} {channel}");
            }
        }
    }
}

/// On a ball, light drifts away from the sun: the drift brightens the lit side beside the terminator and
/// all of the dark, where the widths alone take as much from the lit side as they add to the dark.
#[test]
fn the_drift_and_the_power_law_are_those_of_the_module() {
    use lapidary_cdrf as cdrf;
    let mut scene = ball(10.0, Vec3::ONE);
    scene.lights.truncate(1);
    let material = scene.objects[0].material.clone();
    let albedo = lapidary_plan::thickness::albedo(&material).expect("a medium");
    let path = lapidary_plan::thickness::free_path(&material).expect("a medium");
    for rung in ["power", "drift"] {
        for curvature in [Curvature::Mean, Curvature::Vertex] {
            let mut worst = 0.0f64;
            for (position, found) in
                on_the_ball(&scene, &draw(&scene, &Settings { diffuse: by(curvature), ..settings(rung) }))
            {
                let Arrival { direction, irradiance, .. } = scene.lights[0].arrival(position);
                let cosine = position.normalize().dot(direction) as f32;
                for channel in 0..3 {
                    let reflectance = if rung == "power" {
                        cdrf::cheap(cosine, cdrf::sigma_power(path[channel], 0.1))
                    } else {
                        let drift = cdrf::drift(path[channel], 0.1, (1.0 - albedo[channel]).sqrt());
                        drift.share * cdrf::cheap(cdrf::shifted(cosine, drift.shift), drift.sigma)
                    };
                    let truth = f64::from(material.base_color[channel] * reflectance) * irradiance[channel] * FRAC_1_PI;
                    worst = larger(worst, (found[channel] - truth).abs());
                }
            }
            println!("{rung}, curvature {}: off by {worst:.1e}", curvature.name());
            assert!(worst < 1.2 * MESH, "{rung} {curvature:?}: {worst}");
        }
    }
    // Without a medium, the mean free path is that of the matter with this base color and sigma0.
    let none = Material { medium: None, ..material };
    let derived = lapidary_plan::thickness::free_path(&none).expect("sigma0");
    assert!((derived * (0.5 + 4.3 * albedo) - 1.0).abs().max_element() < 0.01, "{derived}");
}

/// With the best single exposure for each, the reflectance is nearer to the random walks than
/// Lambert's law.
#[test]
fn the_reflectance_is_nearer_to_random_walks_than_lambert() {
    use lapidary_snapshots::{EXR_SIDE, WalkedReference};
    for reference in WalkedReference::of("cdrf") {
        let truth = reference.picture(lapidary_testing::gpu()).expect(reference.scene).linear;
        let scene = Scene::named(reference.scene).expect("built in");
        for shadows in [false, true] {
            let distance = |rung: &str| {
                let usual = Settings { shadows, ..settings(rung) };
                let settings =
                    Settings { width: EXR_SIDE, height: EXR_SIDE, samples: 4, diffuse: by(Curvature::Vertex), ..usual };
                exposed_distance(&draw(&scene, &settings).linear, &truth)
            };
            let [lambert, accurate] = ["lambert", "accurate"].map(distance);
            println!(
                "{}, shadows {shadows}: root mean square from the walks, of theirs: Lambert {lambert:.3}, accurate {accurate:.3}",
                reference.scene
            );
            assert!(accurate < lambert, "{}: {accurate} {lambert}", reference.scene);
        }
    }
}

/// Two lobes are the mean of the pictures with either, by weight, and so keep the energy that they keep.
#[test]
fn a_highlight_of_two_lobes_is_the_mean_of_both() {
    let mut scene = ball(10.0, Vec3::splat(2.0));
    let picture_of = |roughness: f32, second: Option<Lobe>, scene: &mut Scene| {
        scene.objects[0].material.roughness = roughness;
        scene.objects[0].material.second_lobe = second;
        draw(scene, &Settings { without: Effects::of(&[Effect::Environment]), ..settings("accurate") }).linear
    };
    let [wide, narrow] = [0.5, 0.2].map(|roughness| picture_of(roughness, None, &mut scene));
    let both = picture_of(0.5, Some(Lobe { roughness: 0.2, weight: 0.3 }), &mut scene);
    let mut most = 0.0f32;
    for ((wide, narrow), both) in wide.iter().zip(&narrow).zip(&both) {
        for channel in 0..3 {
            let mean = 0.7 * wide[channel] + 0.3 * narrow[channel];
            // Sums of three, of which each is rounded.
            assert!((mean - both[channel]).abs() <= 1e-5 * mean.max(1e-3), "{mean} {}", both[channel]);
            most = most.max((wide[channel] - both[channel]).abs());
        }
    }
    assert!(most > 0.1, "{most}");
}

/// Between a silhouette and the far edge of its triangle, interpolated normals face away from the eye, and through a
/// boundary nothing comes at grazing angles. Of a coarse ball under an even sky hardly a pixel is darker than a third of its
/// middle: those of triangles that are seen nearly edge-on. By the normal's own cosine a rim is black.
#[test]
fn a_coarse_mesh_has_no_black_rim() {
    for rung in ["drift", "diffusion-32", "godunov-32"] {
        let mut scene = ball(10.0, Vec3::splat(2.0));
        scene.objects[0].mesh = sphere(10.0, 12);
        scene.objects[0].material.ior = 1.5;
        scene.objects[0].material.roughness = 0.4;
        // A light for the boundary's sake, too weak to be seen.
        scene.lights = vec![Light::Directional { toward: Vec3::Y, irradiance: Vec3::splat(1e-6) }];
        let white = Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[1.0; 4]; 8] });
        let settings = Settings { half_space: true, without: Effects::NONE, environment: white, ..settings(rung) };
        let picture = draw(&scene, &settings);
        let covered: Vec<f32> = picture.linear.iter().filter(|pixel| pixel[3] > 0.99).map(|pixel| pixel[1]).collect();
        let middle = picture.linear[(SIDE * SIDE / 2 + SIDE / 2) as usize][1];
        let dark = covered.iter().filter(|green| **green < 0.33 * middle).count() as f64 / covered.len() as f64;
        println!("{rung}: {dark:.4} of {} pixels are dark", covered.len());
        assert!(covered.len() > 5000 && dark < 0.003, "{rung}: {dark}");
    }
}
