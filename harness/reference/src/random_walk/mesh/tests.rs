use super::*;
use glam::Vec3;
use lapidary_assay::extremum::larger;
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{Light, Material, Medium, Mesh, Object};
use std::time::Instant;

fn settings(side: u32, samples_per_pixel: u32) -> Settings<'static> {
    Settings {
        width: side,
        height: side,
        samples_per_pixel,
        origin: Origin::Eye,
        seed: 1,
        environment: None,
        boundary: Boundary::Matched,
    }
}

fn rendered(scene: &Scene, settings: &Settings<'_>) -> Rendering {
    render(scene, settings, &|_, _| {}).expect("rendered")
}

fn named(name: &str) -> Scene {
    Scene::named(name).expect("built in")
}

#[test]
fn a_seed_gives_the_same_picture_on_any_number_of_threads() {
    let scene = named("jade_ring");
    for origin in Origin::ALL {
        let on = |threads: usize, seed: u64| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| rendered(&scene, &Settings { seed, origin, ..settings(24, 5) }))
        };
        let one = on(1, 7);
        assert_eq!(one, on(3, 7));
        assert_ne!(one.linear, on(1, 8).linear);
    }
}

/// The further away a point light, the more parallel its rays.
#[test]
fn a_far_point_light_is_a_directional_one() {
    let mut scene = named("wax_bunny");
    let [Light::Directional { toward, irradiance }] = scene.lights[..] else { panic!("one sun") };
    let sunlit = rendered(&scene, &settings(24, 6));
    let distance = 1e7;
    scene.lights = vec![Light::Point { position: distance * toward, intensity: distance * distance * irradiance }];
    let lamplit = rendered(&scene, &settings(24, 6));
    let pairs = || sunlit.linear.iter().zip(&lamplit.linear).filter(|(a, _)| a[3] > 0.0);
    // The walks are the same: only the direction to the light differs, by 1e-6, and by f32
    // rounding.
    let apart = |(a, b): &(&[f32; 4], &[f32; 4])| !(0..4).all(|k| (a[k] - b[k]).abs() <= 1e-4 * a[k] + 1e-6);
    // However, light that grazes an edge may fall on either side.
    let (compared, different) = (pairs().count(), pairs().filter(apart).count());
    let total = |picture: &Rendering| picture.linear.iter().map(|pixel| pixel[0] + pixel[1] + pixel[2]).sum::<f32>();
    let ratio = total(&lamplit) / total(&sunlit);
    println!("{different} of {compared} pixels differ; in all {ratio}");
    assert!(compared > 150 && different * 50 < compared && (ratio - 1.0).abs() < 1e-3);
}

/// If nothing is absorbed and nothing shows through, an image in a white furnace equals its own
/// coverage.
#[test]
fn white_furnace() {
    let ones = Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[1.0; 4]; 8] });
    let mut scene = named("wax_bunny");
    let mesh = sphere(30.0, 128);
    scene.objects[0].mesh = mesh;
    scene.objects[0].material.medium = Some(Medium::isotropic(Vec3::ONE, Vec3::ZERO));
    scene.lights.clear();
    let scene = scene.seen_from(60.0, 0.0);
    let rendering = rendered(&scene, &Settings { environment: Some(&ones), ..settings(24, 4) });
    let inner = rendering.linear.iter().zip(&rendering.standard_error).filter(|(pixel, _)| pixel[3] == 1.0);
    let whole = inner.clone().filter(|([red, green, blue, _], error)| {
        // Some of the light from behind may show through near the rim and is left out.
        let all = [red, green, blue].iter().all(|channel| (**channel - 1.0).abs() < 1e-6);
        assert!(all || error[0] > 0.0);
        all
    });
    let (whole, inner) = (whole.count(), inner.count());
    println!("{whole} of {inner} pixels are white");
    assert!(whole > 200 && whole * 10 > inner * 9);
    assert!(rendering.linear.iter().all(|pixel| pixel[0] <= pixel[3] + 1e-6));
}

/// Walks from either end find the same light. The test compares means over sixteen parts of the
/// image, for plain media, veins with forward scattering, several bodies, and lamps.
#[test]
fn walks_from_the_lights_show_what_walks_from_the_eye_show() {
    let mut veined = named("dragon");
    veined.objects[0].material.medium.as_mut().expect("a medium").anisotropy = 0.6;
    let lamp = Light::Point { position: Vec3::new(10.0, 60.0, 80.0), intensity: Vec3::new(9e3, 6e3, 3e3) };
    let spot = Light::Spot {
        position: Vec3::new(-90.0, 20.0, 60.0),
        direction: Vec3::new(0.9, -0.1, -0.6).normalize(),
        intensity: Vec3::splat(2e4),
        inner_angle: 0.1,
        outer_angle: 0.5,
    };
    for (scene, lights) in [(named("jade"), vec![]), (named("jade_ring"), vec![]), (veined, vec![lamp, spot])] {
        let scene = Scene { lights: [&scene.lights[..], &lights].concat(), ..scene };
        let (side, part) = (32, 8);
        let of = |origin: Origin| rendered(&scene, &Settings { origin, ..settings(side, 100) });
        let [eye, light] = Origin::ALL.map(of);
        let covered = |picture: &Rendering| picture.linear.iter().map(|pixel| f64::from(pixel[3])).sum::<f64>();
        assert!((covered(&eye) / covered(&light) - 1.0).abs() < 0.01);
        let mut worst = 0.0f64;
        for (row, column) in (0..4).flat_map(|row| (0..4).map(move |column| (row, column))) {
            for channel in 0..3 {
                let of_part = |picture: &Rendering| {
                    let pixels = (0..).zip(picture.linear.iter().zip(&picture.standard_error));
                    let inside = |place: u32| place / side / part == row && place % side / part == column;
                    let inside = pixels.filter(|(place, _)| inside(*place));
                    inside.fold((0.0, 0.0), |(sum, variance), (_, (pixel, error))| {
                        (sum + f64::from(pixel[channel]), variance + f64::from(error[channel]).powi(2))
                    })
                };
                let [(a, error_a), (b, error_b)] = [&eye, &light].map(of_part);
                assert!([a, b, error_a, error_b].into_iter().all(f64::is_finite));
                // In an almost black part, too few walks contribute to determine the spread.
                if a.max(b) > 0.05 {
                    worst = larger(worst, (a - b).abs() / (error_a + error_b + (1e-3 * a).powi(2)).sqrt());
                }
            }
        }
        println!("{}: parts differ by {worst:.1} standard errors at most", scene.name);
        assert!(worst > 0.0 && worst < 4.5, "{}: {worst}", scene.name);
    }
}

/// Images of different seeds differ by their standard errors and no more: the strata can only help.
#[test]
fn errors_are_what_they_are_said_to_be() {
    for origin in Origin::ALL {
        let [found, said] = variances(origin);
        println!("from the {}, variance over what is said: {}", origin.name(), found / said);
        assert!((found / said).cmpgt(DVec3::splat(0.75)).all() && (found / said).cmplt(DVec3::splat(1.15)).all());
    }
}

/// Returns the variance between images of many seeds, and the variance that the images state.
fn variances(origin: Origin) -> [DVec3; 2] {
    let scene = named("skin_ring");
    let pictures: Vec<Rendering> =
        (0..64).map(|seed| rendered(&scene, &Settings { seed, origin, ..settings(10, 12) })).collect();
    let count = pictures.len() as f64;
    let (mut found, mut said) = (DVec3::ZERO, DVec3::ZERO);
    for pixel in (0..100).filter(|&pixel| pictures.iter().all(|picture| picture.linear[pixel][3] == 1.0)) {
        for channel in 0..3 {
            let values = || pictures.iter().map(|picture| f64::from(picture.linear[pixel][channel]));
            let mean = values().sum::<f64>() / count;
            found[channel] += values().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
            let squares = pictures.iter().map(|picture| f64::from(picture.standard_error[pixel][channel]).powi(2));
            said[channel] += squares.sum::<f64>() / count;
        }
    }
    [found, said]
}

#[test]
fn what_cannot_be_followed_is_refused() {
    let scene = named("skin_bunny");
    let refused = |scene: &Scene, settings: &Settings<'_>| {
        let error = render(scene, settings, &|_, _| {}).expect_err("refused");
        assert!(!error.to_string().contains('\n') && error.to_string().len() > 20);
        error
    };
    let wide = Settings { width: LARGEST_SIDE + 1, ..settings(8, 2) };
    assert_eq!(refused(&scene, &wide), WalkError::Size { width: LARGEST_SIDE + 1, height: 8 });
    assert_eq!(refused(&scene, &settings(0, 2)), WalkError::Size { width: 0, height: 0 });
    assert_eq!(refused(&scene, &settings(8, 1)), WalkError::Samples(1));
    assert_eq!(refused(&scene, &settings(8, MOST_SAMPLES + 1)), WalkError::Samples(MOST_SAMPLES + 1));

    let ones = Environment::Map(EnvironmentMap { width: 2, height: 1, pixels: vec![[1.0; 4]; 2] });
    let lights = Settings { origin: Origin::Lights, ..settings(8, 2) };
    assert_eq!(refused(&scene, &Settings { environment: Some(&ones), ..lights }), WalkError::Environment);
    assert_eq!(refused(&scene, &Settings { boundary: Boundary::Dielectric, ..lights }), WalkError::Dielectric);
    let spot = Light::Spot {
        position: Vec3::ZERO,
        direction: Vec3::Y,
        intensity: Vec3::ONE,
        inner_angle: 0.1,
        outer_angle: 0.2,
    };
    let spotlit = Scene { lights: vec![scene.lights[0], spot], ..scene.clone() };
    let dielectric = Settings { boundary: Boundary::Dielectric, ..settings(8, 2) };
    assert_eq!(refused(&spotlit, &dielectric), WalkError::Point { light: 1 });

    let with = |change: &dyn Fn(&mut Object)| {
        let mut scene = scene.clone();
        change(&mut scene.objects[0]);
        refused(&scene, &settings(8, 2))
    };
    let object = || "bunny".to_owned();
    assert_eq!(with(&|body| body.material = Material::standard()), WalkError::NoMedium { object: object() });
    let open = with(&|body| body.mesh.indices.truncate(body.mesh.indices.len() - 3));
    assert_eq!(open, WalkError::Open { object: object(), edges: 3 });
    let turned = with(&|body| body.mesh.indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(1, 2)));
    assert_eq!(turned, WalkError::InsideOut { object: object() });
    assert_eq!(with(&|body| body.mesh = Mesh::default()), WalkError::InsideOut { object: object() });
}

#[test]
fn progress_counts_rows_and_batches() {
    for (origin, parts) in Origin::ALL.into_iter().zip([6, 64 + 6]) {
        let seen = std::sync::Mutex::new(Vec::new());
        let note = |done, all| seen.lock().expect("no panic").push((done, all));
        render(&named("skin"), &Settings { origin, ..settings(6, 2) }, &note).expect("rendered");
        let mut seen = seen.into_inner().expect("no panic");
        seen.sort_unstable();
        assert_eq!(seen, (1..=parts).map(|done| (done, parts)).collect::<Vec<_>>());
    }
}

/// Prints speed and noise, and counts the walks that slip through a surface: almost none.
#[test]
fn hardly_a_walk_is_lost() {
    for name in ["skin_bunny", "jade_ring", "wax"] {
        let scene = named(name);
        let start = Instant::now();
        let (side, samples) = (48, 16);
        let rendering = rendered(&scene, &settings(side, samples));
        let seconds = start.elapsed().as_secs_f64();
        let covered = || rendering.linear.iter().zip(&rendering.standard_error).filter(|(pixel, _)| pixel[3] == 1.0);
        let mean = covered().map(|(pixel, _)| pixel[1]).sum::<f32>() / covered().count() as f32;
        let mut errors: Vec<f32> = covered().map(|(_, error)| error[1]).collect();
        errors.sort_by(f32::total_cmp);
        println!(
            "{name}: {:.0} walks/s, {:.1} scatterings a walk, {} of {} walks lost; median standard error {:.1} % of the mean green",
            rendering.walks as f64 / seconds,
            rendering.scatterings as f64 / rendering.walks as f64,
            rendering.lost,
            rendering.walks,
            100.0 * errors[errors.len() / 2] / mean,
        );
        assert!(rendering.walks > 4000 && rendering.lost * 10_000 <= rendering.walks);
    }
}
