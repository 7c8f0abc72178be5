use super::*;
use glam::{DQuat, DVec3, Vec3};
use lapidary_assay::extremum::larger;
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::surfaces::{sphere, torus};
use lapidary_scene::{Camera, Material, Medium, Mesh, Object};
use std::f64::consts::{PI, TAU};
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

fn ends_and_boundaries() -> impl Iterator<Item = (Origin, Boundary)> {
    let boundaries = |origin| [Boundary::Matched, Boundary::Dielectric].map(|boundary| (origin, boundary));
    Origin::ALL.into_iter().flat_map(boundaries)
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
    for (origin, boundary) in ends_and_boundaries() {
        let on = |threads: usize, seed: u64| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| rendered(&scene, &Settings { seed, origin, boundary, ..settings(24, 5) }))
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
    let both = |scene: &Scene| {
        [Boundary::Matched, Boundary::Dielectric]
            .map(|boundary| rendered(scene, &Settings { boundary, ..settings(24, 6) }))
    };
    let sunlit = both(&scene);
    let distance = 1e7;
    scene.lights = vec![Light::Point { position: distance * toward, intensity: distance * distance * irradiance }];
    let lamplit = both(&scene);
    let [sunlit, behind_boundary] = sunlit;
    let [lamplit, other_behind_boundary] = lamplit;
    // Walks from the lights fill in a little, and they differ.
    let [(one, error), (other, other_error)] = [&behind_boundary, &other_behind_boundary].map(totals);
    println!("behind a boundary {one} ± {error}, {other} ± {other_error}");
    assert!((one - other).abs().cmplt(error + other_error).all());
    let pairs = || sunlit.linear.iter().zip(&lamplit.linear).filter(|(a, _)| a[3] > 0.0);
    // The walks are the same: only the direction to the light differs, by 1e-6, and by f32
    // rounding.
    let differ = |(a, b): &(&[f32; 4], &[f32; 4])| !(0..4).all(|k| (a[k] - b[k]).abs() <= 1e-4 * a[k] + 1e-6);
    // However, light that grazes an edge may fall on either side.
    let (compared, different) = (pairs().count(), pairs().filter(differ).count());
    let total = |picture: &Rendering| picture.linear.iter().map(|pixel| pixel[0] + pixel[1] + pixel[2]).sum::<f32>();
    let ratio = total(&lamplit) / total(&sunlit);
    println!("{different} of {compared} pixels differ; in all {ratio}");
    assert!(compared > 150 && different * 50 < compared && (ratio - 1.0).abs() < 1e-3);
}

/// If nothing is absorbed, an image in a white furnace equals its own coverage, however thin the body is.
#[test]
fn white_furnace() {
    let ones = Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[1.0; 4]; 8] });
    let mut scene = named("wax_bunny");
    scene.lights.clear();
    // In mean free paths: half shows what is behind, and hardly anything.
    for (radius, boundary) in [(0.5, Boundary::Matched), (30.0, Boundary::Matched), (2.0, Boundary::Dielectric)] {
        scene.objects[0].mesh = sphere(radius, 128);
        scene.objects[0].material.medium = Some(Medium::isotropic(Vec3::ONE, Vec3::ZERO));
        let scene = scene.seen_from(60.0, 0.0);
        let rendering = rendered(&scene, &Settings { environment: Some(&ones), boundary, ..settings(24, 4) });
        let covered = rendering.linear.iter().filter(|pixel| pixel[3] == 1.0).count();
        let most = rendering.linear.iter().flat_map(|pixel| [0, 1, 2].map(|k| (pixel[k] - pixel[3]).abs()));
        let most = most.fold(0.0, f32::max);
        println!("{radius}, {boundary:?}: {covered} pixels, off by {most:e} at most");
        assert!(covered > 200 && most < 1e-6, "{radius}, {boundary:?}: {most:e}");
    }
}

/// Walks from either end find the same light. The test compares means over sixteen parts of the
/// image, for plain media, veins with forward scattering, several bodies, and lamps.
#[test]
#[ignore = "long; .ci/full runs it"]
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
        for boundary in [Boundary::Matched, Boundary::Dielectric] {
            let [eye, light] =
                Origin::ALL.map(|origin| rendered(&scene, &Settings { origin, boundary, ..settings(32, 100) }));
            are_the_same(&format!("{}, {boundary:?}", scene.name), &eye, &light);
        }
    }
}

/// Compares sixteen parts of two pictures of 32² pixels.
fn are_the_same(name: &str, one: &Rendering, other: &Rendering) {
    let (side, part) = (32, 8);
    let covered = |picture: &Rendering| picture.linear.iter().map(|pixel| f64::from(pixel[3])).sum::<f64>();
    assert!((covered(one) / covered(other) - 1.0).abs() < 0.01);
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
            let [(a, error_a), (b, error_b)] = [one, other].map(of_part);
            assert!([a, b, error_a, error_b].into_iter().all(f64::is_finite));
            // In an almost black part, too few walks contribute to determine the spread.
            if a.max(b) > 0.05 {
                worst = larger(worst, (a - b).abs() / (error_a + error_b + (1e-3 * a).powi(2)).sqrt());
            }
        }
    }
    println!("{name}: parts differ by {worst:.1} standard errors at most");
    assert!(worst > 0.0 && worst < 4.5, "{name}: {worst}");
}

/// Behind a boundary without effect, connections through it find what straight ones find.
#[test]
fn a_boundary_without_effect_changes_nothing() {
    let mut scene = named("skin_ring");
    for object in &mut scene.objects {
        object.material.ior = 1.000_001;
    }
    for origin in Origin::ALL {
        let [matched, dielectric] = [(Boundary::Matched, 1), (Boundary::Dielectric, 2)]
            .map(|(boundary, seed)| rendered(&scene, &Settings { origin, boundary, seed, ..settings(32, 64) }));
        are_the_same(origin.name(), &matched, &dielectric);
    }
}

/// Sums of a picture's channels, and their standard errors.
fn totals(picture: &Rendering) -> (DVec3, DVec3) {
    let sum: DVec3 = picture.linear.iter().map(|pixel| Vec3::from_slice(pixel).as_dvec3()).sum();
    let variance: DVec3 = picture.standard_error.iter().map(|error| Vec3::from_slice(error).as_dvec3().powf(2.0)).sum();
    (sum, variance.map(f64::sqrt))
}

/// A sun found by connections is as bright as a small disc of an environment found by chance,
/// through thin bodies that reflect light at each other and inside.
#[test]
fn a_sun_behind_a_boundary_is_a_disc_met_by_chance() {
    let toward = DVec3::new(-0.5, 0.4, 0.75).normalize();
    let (width, height, radius) = (256u32, 128u32, 0.15f64);
    let direction = |column: f64, row: f64| {
        let (azimuth, polar) = (TAU * ((column + 0.5) / f64::from(width) - 0.5), PI * (row + 0.5) / f64::from(height));
        DVec3::new(polar.sin() * azimuth.cos(), polar.cos(), polar.sin() * azimuth.sin())
    };
    let texel = |place: u32| {
        let is_lit = direction(f64::from(place % width), f64::from(place / width)).dot(toward) > radius.cos();
        if is_lit { [40.0, 20.0, 30.0, 1.0] } else { [0.0, 0.0, 0.0, 1.0] }
    };
    let map = EnvironmentMap { width, height, pixels: (0..width * height).map(texel).collect() };
    let disc = Environment::Map(map);
    // By the middle of 16 parts of each texel; rows are equally spaced angles.
    let fine = 4;
    let (columns, rows) = (fine * width, fine * height);
    let cell = PI / f64::from(rows);
    let irradiance: DVec3 = (0..columns * rows)
        .map(|place| {
            let centre = |index: u32| (f64::from(index) + 0.5) / f64::from(fine) - 0.5;
            let from = direction(centre(place % columns), centre(place / columns));
            let polar = (f64::from(place / columns) + 0.5) * cell;
            disc.radiance(from) * from.dot(toward).max(0.0) * polar.sin() * cell * cell
        })
        .sum();
    let sun = Light::Directional { toward: toward.as_vec3(), irradiance: irradiance.as_vec3() };

    let mut scene = named("skin_ring");
    let medium = Medium::isotropic(Vec3::new(0.9, 0.5, 0.2), Vec3::new(0.05, 0.1, 0.2));
    let material = Material { medium: Some(medium.clone()), ior: 1.4, ..Material::standard() };
    let ring = torus(4.0, 1.0, 48, 24);
    let ball = sphere(1.5, 24).placed(DQuat::IDENTITY, DVec3::new(0.0, 0.0, 0.5));
    scene.objects = [ring, ball].into_iter().map(|mesh| Object::new("body", mesh, material.clone())).collect();
    scene.camera = Camera::framing(
        scene.objects.iter().flat_map(|o| o.mesh.positions.iter().copied()),
        Vec3::new(0.3, 0.9, 0.5).normalize(),
        0.5,
    );
    // What crosses or is reflected without scattering, of which a light shows nothing: that of matter which absorbs all.
    let mut black = scene.clone();
    let absorbing = Medium::isotropic(Vec3::ZERO, medium.scattering + medium.absorption);
    black.objects.iter_mut().for_each(|object| object.material.medium = Some(absorbing.clone()));
    let walked = |scene: &Scene, lights: Vec<Light>, environment, origin, samples| {
        let scene = Scene { lights, ..scene.clone() };
        let settings = Settings { environment, origin, boundary: Boundary::Dielectric, ..settings(16, samples) };
        totals(&rendered(&scene, &settings))
    };
    let (all, all_error) = walked(&scene, Vec::new(), Some(&disc), Origin::Eye, 16384);
    let (straight, straight_error) = walked(&black, Vec::new(), Some(&disc), Origin::Eye, 16384);
    let chance = all - straight;
    let chance_error = (all_error * all_error + straight_error * straight_error).map(f64::sqrt);
    for origin in Origin::ALL {
        let (found, error) = walked(&scene, vec![sun], None, origin, 400);
        println!("from the {}: {found} ± {error}, by chance {chance} ± {chance_error}", origin.name());
        // The disc's width moves the mean by less than a percent.
        let allowed = 4.0 * (error * error + chance_error * chance_error).map(f64::sqrt) + 0.01 * chance;
        assert!((found - chance).abs().cmplt(allowed).all() && chance_error.cmplt(0.035 * chance).all());
    }
}

/// The two ends' shares of light that meets more than one surface before its first scattering, and
/// their product: about what is left out.
#[test]
fn hardly_any_light_begins_indirectly_at_both_ends() {
    for name in ["skin", "skin_bunny", "skin_ring", "wax"] {
        let scene = named(name);
        let matter = matter(&scene, Boundary::Dielectric, None).expect("media");
        let (side, samples) = (32, 64);
        let view = (&View::new(&scene.camera, side, side), side, side);
        let lights = (&scene.lights[..], scene.bounds());
        let pass = |origin: Origin, beginnings| {
            let pass = Pass { origin, beginnings, seed: 3 };
            let mut estimate = match origin {
                Origin::Eye => from_eye(&matter, view, samples, pass, &|| ()),
                Origin::Lights => from_lights::estimate(&matter, lights, view, samples, pass, &|| ()),
            };
            estimate.coverage = vec![1.0; (side * side) as usize];
            totals(&estimate.rendering())
        };
        let (all, _) = pass(Origin::Eye, Beginnings::All);
        let [lights, eye] = [Origin::Lights, Origin::Eye].map(|origin| pass(origin, Beginnings::Indirect));
        let share = |(part, error): (DVec3, DVec3)| (100.0 * part / all, 100.0 * error / all);
        let left_out = (lights.0 / all) * (eye.0 / all);
        println!("{name}: lights {:.2?} %, eye {:.2?} %, product {left_out}", share(lights), share(eye));
        assert!(left_out.cmplt(DVec3::splat(1e-3)).all());
    }
}

/// Images of different seeds differ by their standard errors and no more: the strata can only help.
#[test]
#[ignore = "long; .ci/full runs it"]
fn errors_are_what_they_are_said_to_be() {
    for (origin, boundary) in ends_and_boundaries() {
        let [found, said] = variances(origin, boundary);
        println!("{boundary:?}, from the {}, variance over what is said: {}", origin.name(), found / said);
        assert!((found / said).cmpgt(DVec3::splat(0.75)).all() && (found / said).cmplt(DVec3::splat(1.15)).all());
    }
}

/// Returns the variance between images of many seeds, and the variance that the images state.
fn variances(origin: Origin, boundary: Boundary) -> [DVec3; 2] {
    let scene = named("skin_ring");
    let pictures: Vec<Rendering> =
        (0..64).map(|seed| rendered(&scene, &Settings { seed, origin, boundary, ..settings(10, 12) })).collect();
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
    let spot = Light::Spot {
        position: Vec3::ZERO,
        direction: Vec3::Y,
        intensity: Vec3::ONE,
        inner_angle: 0.1,
        outer_angle: 0.2,
    };
    let position = scene.objects[0].mesh.positions[0] * 100.0;
    let outside = Light::Point { position, intensity: Vec3::ONE };
    let spotlit = Scene { lights: vec![scene.lights[0], outside, spot], ..scene.clone() };
    let dielectric = Settings { boundary: Boundary::Dielectric, ..settings(8, 2) };
    assert_eq!(refused(&spotlit, &dielectric), WalkError::Inside { light: 2 });
    rendered(&spotlit, &settings(8, 2));

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
    for ((origin, boundary), parts) in ends_and_boundaries().zip([6, 6 + 64, 64 + 6, 64 + 6]) {
        let seen = std::sync::Mutex::new(Vec::new());
        let note = |done, all| seen.lock().expect("no panic").push((done, all));
        render(&named("skin"), &Settings { origin, boundary, ..settings(6, 2) }, &note).expect("rendered");
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
        for (origin, boundary) in ends_and_boundaries() {
            let start = Instant::now();
            let (side, samples) = (48, 16);
            let rendering = rendered(&scene, &Settings { origin, boundary, ..settings(side, samples) });
            let seconds = start.elapsed().as_secs_f64();
            // Root mean squares of the errors and of the picture.
            let square = |value: &f32| f64::from(*value).powi(2);
            let variance: f64 = rendering.standard_error.iter().flatten().map(square).sum();
            let power: f64 = rendering.linear.iter().flat_map(|pixel| &pixel[..3]).map(square).sum();
            println!(
                "{name}, {boundary:?}, from the {}: {:.0} walks/s, {:.1} scatterings a walk, {} of {} walks lost; {:.1} µs for each sample of a pixel; standard error {:.1} % of the picture",
                origin.name(),
                rendering.walks as f64 / seconds,
                rendering.scatterings as f64 / rendering.walks as f64,
                rendering.lost,
                rendering.walks,
                1e6 * seconds / f64::from(side * side * samples),
                100.0 * (variance / power).sqrt(),
            );
            assert!(rendering.walks > 4000 && rendering.lost * 10_000 <= rendering.walks);
        }
    }
}

/// A scan's eyelids cross themselves: two faces there lead to one another without an end.
#[test]
fn walks_through_a_surface_that_crosses_itself_come_to_an_end() {
    let rendering = rendered(&named("skin_head"), &settings(48, 16));
    assert!(
        rendering.walks > 1000 && rendering.lost < rendering.walks / 1000,
        "{} of {}",
        rendering.lost,
        rendering.walks
    );
}
