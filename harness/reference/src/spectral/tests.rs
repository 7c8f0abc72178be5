use super::*;
use glam::{DQuat, Vec3};
use lapidary_assay::extremum::{larger, largest};
use lapidary_scene::cuts::{PrismParameters, prism};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{Averaging, Dispersion, Light, Material, Mesh, Mineral};
use std::f64::consts::PI;
use trace::Outcome;

fn ones() -> Environment {
    Environment::Map(EnvironmentMap { width: 4, height: 2, pixels: vec![[1.0; 4]; 8] })
}

fn diamond() -> Scene {
    let mut scene = Scene::named("brilliant").unwrap();
    scene.objects[0].material.dispersion = Dispersion::Sellmeier(Mineral::Diamond);
    scene
}

fn rendered(scene: &Scene, settings: &Settings<'_>) -> Rendering {
    render(scene, settings, &|_, _| {}).unwrap()
}

/// Returns the RMS and the largest difference over the channels of covered pixels.
fn difference(a: &Rendering, b: &Rendering) -> (f64, f64) {
    let pairs = a.linear.iter().zip(&b.linear).filter(|(a, _)| a[3] > 0.0);
    let parts = pairs.flat_map(|(a, b)| [0, 1, 2].map(|k| f64::from((a[k] - b[k]).abs())));
    let parts: Vec<f64> = parts.collect();
    let squares: f64 = parts.iter().map(|part| part * part).sum();
    ((squares / parts.len() as f64).sqrt(), parts.iter().copied().fold(0.0, larger))
}

/// Returns the factor from the energy dropped at each wavelength to the greatest deficit of a
/// channel.
fn gain(wavelengths: usize) -> f64 {
    let rows = spectrum::weights(wavelengths).into_iter().map(|wavelength| (wavelength.weights * DVec3::ONE).abs());
    rows.sum::<DVec3>().max_element()
}

/// Surrounded by radiance 1, a clear stone shows 1 minus the dropped energy: with f64 accuracy at
/// each wavelength of each ray, and within the bound in the image.
#[test]
fn white_furnace() {
    let environment = ones();
    for (name, side, samples) in [("brilliant", 24, 2), ("prism", 24, 2), ("octahedron", 24, 2), ("bunny_stone", 12, 1)]
    {
        for geometry in [Geometry::Planes, Geometry::Triangles] {
            let mut scene = Scene::named(name).unwrap();
            scene.objects[0].material.dispersion = Dispersion::Abbe(20.0 / 55.3);
            let settings = Settings {
                environment: &environment,
                geometry,
                samples,
                wavelengths: 5,
                energy_bound: 1e-3,
                ..Settings::of_size(side, side)
            };
            let job = Job::new(&scene, &settings);
            let mut met = 0;
            for (x, y) in (0..side * side).map(|k| (k % side, k / side)) {
                let direction = job.view.direction(f64::from(x) + 0.37, f64::from(y) + 0.61);
                let Some(primary) = job.surroundings.primary(job.view.eye, direction) else { continue };
                met += 1;
                for Band { optics, .. } in &job.spectrum {
                    let Outcome { radiance, lost } = job.surroundings.follow(&primary, optics, &mut generator(1, 0));
                    assert!(
                        largest((radiance + lost - 1.0).abs().to_array()) <= 1e-9,
                        "{name}: {radiance} with {lost} lost"
                    );
                    assert!((0.0..settings.energy_bound).contains(&lost), "{name}: {lost} lost");
                }
            }
            assert!(met > side * side / 8, "{name}: {met}");

            let rendering = rendered(&scene, &settings);
            assert!(rendering.lost.max < settings.energy_bound && rendering.lost.mean <= rendering.lost.max);
            let bound = gain(5) * settings.energy_bound;
            for [red, green, blue, covered] in rendering.linear {
                let channels = [red, green, blue].map(|channel| f64::from(channel - covered).abs());
                assert!(channels.iter().all(|missing| *missing <= bound), "{name}: {channels:?}");
            }
        }
    }
}

/// The same with the settings of `cook render`: 31 wavelengths and a bound of 1e-4.
#[test]
fn white_furnace_as_rendered() {
    let environment = ones();
    for name in ["brilliant", "sapphire", "prism"] {
        let mut scene = Scene::named(name).unwrap();
        scene.objects[0].material.attenuation_color = glam::Vec3::ONE;
        let settings = Settings { environment: &environment, samples: 1, ..Settings::of_size(16, 16) };
        let rendering = rendered(&scene, &settings);
        assert!(rendering.lost.max < 1e-4, "{name}: {:?}", rendering.lost);
        let covered = rendering.linear.iter().filter(|pixel| pixel[3] > 0.0);
        for [red, green, blue, alpha] in covered.clone() {
            let channels = [red, green, blue].map(|channel| f64::from(channel - alpha).abs());
            assert!(channels.iter().all(|missing| *missing <= gain(31) * 1e-4), "{name}: {channels:?}");
        }
        assert!(covered.count() > 30);
    }
}

/// Two stones, one in front of the other. Light that leaves one stone and enters the other is also
/// followed.
#[test]
fn white_furnace_of_several_bodies() {
    let mut scene = Scene::named("octahedron").unwrap();
    let away = scene.camera.target - scene.camera.eye;
    let mut second = scene.objects[0].clone();
    second.mesh.positions.iter_mut().for_each(|position| *position += 2.2 * away.normalize());
    second.material.ior = 1.5;
    scene.objects.push(second);
    let environment = ones();
    let settings = Settings { environment: &environment, samples: 1, wavelengths: 3, ..Settings::of_size(24, 24) };
    let both = rendered(&scene, &settings);
    assert!(both.lost.max < settings.energy_bound);
    let near = |pixel: &[f32; 4]| (0..3).all(|k| f64::from(pixel[k] - pixel[3]).abs() <= gain(3) * 1e-4);
    assert!(both.linear.iter().all(near));
    // The stone behind is seen through the one in front: in the studio, this makes a difference.
    let settings = Settings { environment: &Environment::Studio, ..settings };
    let with = rendered(&scene, &settings);
    scene.objects.pop();
    assert!(difference(&rendered(&scene, &settings), &with).0 > 0.05);
}

#[test]
fn twice_as_many_wavelengths_change_little() {
    let scene = diamond();
    let window = Window { left: 24, top: 24, width: 16, height: 16 };
    let settings = Settings { window: Some(window), samples: 2, ..Settings::of_size(64, 64) };
    let coarse = rendered(&scene, &settings);
    let fine = rendered(&scene, &Settings { wavelengths: 61, ..settings });
    let (rms, largest) = difference(&coarse, &fine);
    let mean = fine.linear.iter().flat_map(|pixel| &pixel[..3]).sum::<f32>() / (3 * fine.linear.len()) as f32;
    println!("31 against 61 wavelengths: rms {rms:.4}, largest {largest:.4}, of a mean of {mean:.3}");
    // Compared with nine wavelengths, to show that the number matters at all.
    let few = difference(&rendered(&scene, &Settings { wavelengths: 9, ..settings }), &fine).0;
    println!("9 against 61 wavelengths: rms {few:.4}");
    assert!(rms < 0.02 && 2.0 * rms < few);
}

#[test]
fn without_dispersion_the_spectrum_plays_no_part() {
    let mut scene = Scene::named("step_cut").unwrap();
    scene.objects[0].material.dispersion = Dispersion::None;
    let settings = Settings { samples: 1, wavelengths: 3, ..Settings::of_size(16, 16) };
    let gain = gain(3) + gain(31);
    let few = rendered(&scene, &settings);
    let all = rendered(&scene, &Settings { wavelengths: 31, ..settings });
    assert!(difference(&few, &all).1 < 20.0 * gain * settings.energy_bound);
    // The base colour acts by channel: a stone that admits only blue shows more than its surface
    // only in blue.
    scene.objects[0].material.base_color = glam::Vec3::Z;
    let blue = rendered(&scene, &settings);
    scene.objects[0].material.base_color = glam::Vec3::ZERO;
    let surface = rendered(&scene, &settings);
    let total = |rendering: &Rendering, k: usize| rendering.linear.iter().map(|pixel| pixel[k]).sum::<f32>();
    assert!((total(&blue, 0) - total(&surface, 0)).abs() < 1e-3);
    assert!(total(&blue, 2) > 2.0 * total(&surface, 2));
}

#[test]
fn absorption_takes_the_other_colors() {
    let mut scene = Scene::named("brilliant").unwrap();
    let environment = ones();
    let settings = Settings { environment: &environment, samples: 1, ..Settings::of_size(16, 16) };
    let material = &mut scene.objects[0].material;
    // With dispersion, path lengths differ between wavelengths, and a channel's colour no longer
    // follows a single coefficient.
    material.dispersion = Dispersion::None;
    material.attenuation_color = glam::Vec3::new(0.9, 0.2, 0.3);
    material.attenuation_distance = 2.0;
    let near = rendered(&scene, &settings);
    scene.objects[0].material.attenuation_distance = 20.0;
    let far = rendered(&scene, &settings);
    for (near, far) in near.linear.iter().zip(&far.linear).filter(|(near, _)| near[3] == 1.0) {
        assert!(near[0] > near[1] && near[0] > near[2], "{near:?}");
        assert!((0..3).all(|k| near[k] < far[k] && far[k] < 1.0), "{near:?} {far:?}");
    }
}

#[test]
fn a_window_is_a_crop_and_every_run_the_same() {
    let scene = diamond();
    let settings = Settings { samples: 1, wavelengths: 7, ..Settings::of_size(40, 24) };
    let whole = rendered(&scene, &settings);
    assert_eq!(whole, rendered(&scene, &settings));
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert_eq!(whole, alone.install(|| rendered(&scene, &settings)));
    let window = Window { left: 13, top: 5, width: 9, height: 11 };
    let part = rendered(&scene, &Settings { window: Some(window), ..settings });
    assert_eq!((part.width, part.height), (9, 11));
    for (k, pixel) in part.linear.iter().enumerate() {
        assert_eq!(*pixel, whole.linear[(5 + k / 9) * 40 + 13 + k % 9]);
    }
    assert!(whole.linear.contains(&[0.0; 4]) && whole.linear.iter().any(|pixel| pixel[3] == 1.0));
}

/// A stone's facets as planes and as triangles differ by the f32 rounding of the corners, 6e-8:
/// light that passes near an edge may then take another path.
#[test]
fn planes_and_triangles_show_the_same_stone() {
    let scene = diamond();
    let settings = Settings { samples: 1, wavelengths: 5, ..Settings::of_size(48, 48) };
    let planes = rendered(&scene, &settings);
    let triangles = rendered(&scene, &Settings { geometry: Geometry::Triangles, ..settings });
    let covered = planes.linear.iter().filter(|pixel| pixel[3] > 0.0).count();
    let pairs = planes.linear.iter().zip(&triangles.linear);
    let different = pairs.filter(|(a, b)| !(0..4).all(|k| (a[k] - b[k]).abs() <= 1e-3)).count();
    println!("{different} of {covered} pixels differ; rms and largest {:?}", difference(&planes, &triangles));
    assert!(covered > 800 && different * 100 <= covered, "{different} of {covered}");
}

#[test]
fn progress_counts_every_row_once() {
    let scene = Scene::named("octahedron").unwrap();
    let seen = std::sync::Mutex::new(Vec::new());
    let settings = Settings { samples: 1, wavelengths: 3, ..Settings::of_size(4, 6) };
    render(&scene, &settings, &|done, total| seen.lock().unwrap().push((done, total))).unwrap();
    let mut seen = seen.into_inner().unwrap();
    seen.sort_unstable();
    assert_eq!(seen, (1..=6).map(|row| (row, 6)).collect::<Vec<_>>());
}

#[test]
fn settings_out_of_range_are_refused() {
    let scene = Scene::named("octahedron").unwrap();
    let good = Settings::of_size(8, 8);
    let window = |left, top, width, height| Some(Window { left, top, width, height });
    let wrong = [
        Settings { width: 0, ..good },
        Settings { height: LARGEST_SIDE + 1, ..good },
        Settings { window: window(0, 0, 0, 8), ..good },
        Settings { window: window(4, 0, 5, 8), ..good },
        Settings { window: window(0, u32::MAX, 1, 1), ..good },
        Settings { wavelengths: 2, ..good },
        Settings { wavelengths: MOST_WAVELENGTHS + 1, ..good },
        Settings { samples: 0, ..good },
        Settings { samples: MOST_SAMPLES + 1, ..good },
        Settings { energy_bound: 0.0, ..good },
        Settings { energy_bound: f64::NAN, ..good },
        Settings { energy_bound: 1.0, ..good },
    ];
    for settings in wrong {
        let message = render(&scene, &settings, &|_, _| {}).unwrap_err().to_string();
        assert!(!message.contains('\n') && message.contains("range") || message.contains("within"), "{message}");
    }
}

#[test]
fn a_body_without_triangles_changes_nothing() {
    let mut scene = Scene::named("octahedron").unwrap();
    let settings = Settings { samples: 1, wavelengths: 3, ..Settings::of_size(8, 8) };
    let alone = rendered(&scene, &settings);
    scene.objects.insert(0, Object { mesh: lapidary_scene::Mesh::default(), ..scene.objects[0].clone() });
    assert_eq!(rendered(&scene, &settings).linear, alone.linear);
    scene.objects.truncate(1);
    assert!(rendered(&scene, &settings).linear.iter().all(|pixel| *pixel == [0.0; 4]));
}

fn matte(mesh: Mesh, base_color: Vec3) -> Object {
    Object::new("matte", mesh, Material { base_color, ..Material::standard() })
}

/// Returns a level square plate with its upper side at height `top` and its corners 3 from the
/// vertical axis.
fn plate(top: f32) -> Mesh {
    let square = PrismParameters { sides: 4, radius: 3.0, half_length: 0.05, cap_degrees: 0.0 };
    let mesh = prism(&square).unwrap().to_mesh(Averaging::Angle);
    mesh.placed(DQuat::IDENTITY, DVec3::new(0.0, f64::from(top) - 0.05, 0.0))
}

/// Yields the middle of each cell of a latitude-longitude map with so many rows, row by row from
/// the zenith, with the cell's solid angle.
fn cells(rows: u32) -> impl Iterator<Item = (DVec3, f64)> {
    let step = PI / f64::from(rows);
    (0..2 * rows * rows).map(move |cell| {
        let [row, column] = [cell / (2 * rows), cell % (2 * rows)].map(|index| f64::from(index) + 0.5);
        let (across, along) = (row * step).sin_cos();
        let (z, x) = (column * step - PI).sin_cos();
        (DVec3::new(across * x, along, across * z), 2.0 * (0.5 * step).sin() * across * step)
    })
}

/// A white matte body in radiance 1 has radiance 1 too, to the accuracy of the harmonics: it is not
/// seen, neither directly nor through a stone.
#[test]
fn white_furnace_with_a_matte_body() {
    let environment = ones();
    let mut scene = Scene::named("brilliant").unwrap();
    let below = scene.bounds().min.y;
    scene.objects.push(matte(plate(below - 0.1), Vec3::ONE));
    let settings = Settings { environment: &environment, samples: 1, wavelengths: 3, ..Settings::of_size(24, 24) };
    let job = Job::new(&scene, &settings);
    let mut met = [0, 0];
    for (x, y) in (0..24 * 24u32).map(|k| (k % 24, k / 24)) {
        let direction = job.view.direction(f64::from(x) + 0.37, f64::from(y) + 0.61);
        let Some(primary) = job.surroundings.primary(job.view.eye, direction) else { continue };
        met[usize::from(matches!(primary, Primary::Matte(_)))] += 1;
        for Band { optics, .. } in &job.spectrum {
            let Outcome { radiance, lost } = job.surroundings.follow(&primary, optics, &mut generator(1, 0));
            assert!(largest((radiance + lost - 1.0).abs().to_array()) <= 5e-5, "{radiance} with {lost} lost");
        }
    }
    assert!(met[0] > 50 && met[1] > 50, "{met:?}");

    let rendering = rendered(&scene, &settings);
    assert!(rendering.lost.max < settings.energy_bound);
    let bound = gain(3) * (settings.energy_bound + 5e-5);
    let near = |pixel: &[f32; 4]| (0..3).all(|k| f64::from(pixel[k] - pixel[3]).abs() <= bound);
    assert!(rendering.linear.iter().all(near));
}

/// A clear cube of half a side 1 with a ball of a third inside, both in radiance 1.
fn with_inclusion(index: f32, inclusion: Material) -> Scene {
    let mut scene = Scene::named("octahedron").unwrap();
    let cube = PrismParameters { sides: 4, radius: 1.4, half_length: 1.0, cap_degrees: 0.0 };
    let cube = prism(&cube).unwrap().to_mesh(Averaging::Angle);
    let clear = Material { transmission: 1.0, thickness: 1.0, roughness: 0.0, ior: index, ..Material::standard() };
    scene.objects = vec![Object::new("block", cube, clear), Object::new("inclusion", sphere(0.33, 64), inclusion)];
    scene.seen_from(65.0, 20.0)
}

/// Whatever lies in a block, light is neither lost nor gained, and a block of index 1 is not seen.
#[test]
fn a_body_within_another_is_seen_and_keeps_the_energy() {
    let environment = ones();
    let settings = Settings { environment: &environment, samples: 1, wavelengths: 3, ..Settings::of_size(24, 24) };
    let clear = |ior, base_color| Material {
        transmission: 1.0,
        thickness: 1.0,
        roughness: 0.0,
        ior,
        base_color,
        ..Material::standard()
    };
    for index in [1.0, 1.5, 2.4] {
        for inclusion in [Material::standard(), clear(1.0, Vec3::ONE), clear(1.3, Vec3::ONE), clear(2.4, Vec3::ONE)] {
            let job = Job::new(&with_inclusion(index, inclusion.clone()), &settings);
            let mut met = 0;
            for (x, y) in (0..24 * 24u32).map(|k| (k % 24, k / 24)) {
                let direction = job.view.direction(f64::from(x) + 0.37, f64::from(y) + 0.61);
                let Some(primary) = job.surroundings.primary(job.view.eye, direction) else { continue };
                met += 1;
                for Band { optics, .. } in &job.spectrum {
                    let Outcome { radiance, lost } = job.surroundings.follow(&primary, optics, &mut generator(1, 0));
                    // The harmonics of a matte ball's light are that accurate.
                    let off = largest((radiance + lost - 1.0).abs().to_array());
                    assert!(off <= 5e-5, "{index} {}: {radiance} with {lost} lost", inclusion.ior);
                }
            }
            assert!(met > 150, "{met}");
        }
    }
    let middle = |scene: &Scene| rendered(scene, &settings).linear[12 * 24 + 12];
    let red = Vec3::new(0.8, 0.05, 0.05);
    let matte = middle(&with_inclusion(1.0, Material { base_color: red, ..Material::standard() }));
    assert!((0..3).all(|k| (matte[k] - red[k]).abs() < 1e-3), "{matte:?}");
    // A clear ball that dyes light shows its colour but for what its surface reflects.
    let mut dyed = with_inclusion(1.0, clear(1.5, red));
    let within = middle(&dyed);
    dyed.objects.remove(0);
    let alone = middle(&dyed);
    assert!((0..4).all(|k| (within[k] - alone[k]).abs() < 1e-6) && within[1] < 0.2, "{within:?} {alone:?}");
}

/// In radiance 1 a stone shows 1; what leaves it towards a black plate is missing.
#[test]
fn a_black_plate_darkens_the_stone_above_it() {
    let environment = ones();
    let mut scene = Scene::named("quartz").unwrap();
    scene.objects[0].material.dispersion = Dispersion::None;
    let settings = Settings { environment: &environment, samples: 1, wavelengths: 3, ..Settings::of_size(24, 24) };
    let alone = rendered(&scene, &settings);
    // The mean of the pixels that show the stone.
    let mean = |rendering: &Rendering| {
        let shown = alone.linear.iter().zip(&rendering.linear).filter(|(alone, _)| alone[3] == 1.0);
        let values: Vec<f64> = shown.flat_map(|(_, pixel)| &pixel[..3]).map(|value| f64::from(*value)).collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    let below = scene.bounds().min.y;
    let [near, far] = [0.1, 20.0].map(|gap| {
        let mut scene = scene.clone();
        scene.objects.push(matte(plate(below - gap), Vec3::ZERO));
        1.0 - mean(&rendered(&scene, &settings))
    });
    println!("a plate takes {near:.4} of the light from nearby, {far:.4} from far away");
    assert!((1.0 - mean(&alone)).abs() < 1e-3);
    assert!(near > 0.03 && near > 2.0 * far && far > -1e-3, "{near} {far}");
}

/// A light and a matte body without triangles leave a picture of a stone as it is.
#[test]
fn what_no_ray_meets_changes_nothing() {
    let mut scene = Scene::named("octahedron").unwrap();
    let settings = Settings { samples: 1, wavelengths: 3, ..Settings::of_size(12, 12) };
    let alone = rendered(&scene, &settings);
    scene.lights.push(Light::Directional { toward: Vec3::Y, irradiance: Vec3::ONE });
    assert_eq!(rendered(&scene, &settings), alone);
    scene.objects.push(matte(Mesh::default(), Vec3::ONE));
    assert_eq!(rendered(&scene, &settings).linear, alone.linear);
}

#[test]
fn a_matte_body_in_front_hides_the_stone() {
    let mut scene = Scene::named("brilliant").unwrap();
    let away = (scene.camera.target - scene.camera.eye).as_dvec3();
    // Seen under .3 radians from its middle, and the stone under less.
    let ball = sphere(0.5 * away.length() * f64::sin(0.3), 64);
    let ball = ball.placed(DQuat::IDENTITY, scene.camera.eye.as_dvec3() + 0.5 * away);
    let settings = Settings { samples: 1, wavelengths: 3, ..Settings::of_size(24, 24) };
    scene.objects.push(matte(ball, Vec3::new(0.2, 0.5, 0.9)));
    let both = rendered(&scene, &settings);
    assert_eq!((both.lost.max, both.lost.mean), (0.0, 0.0));
    scene.objects.remove(0);
    let ball = rendered(&scene, &settings);
    let mut pairs = ball.linear.iter().zip(&both.linear);
    assert!(pairs.all(|(ball, both)| (0..4).all(|k| (ball[k] - both[k]).abs() <= 1e-6)));
    assert!(both.linear.iter().filter(|pixel| pixel[3] == 1.0).count() > 300);
}

/// A stone that lets nothing in reflects the environment, or the matte body in front of it.
#[test]
fn the_first_reflection_shows_a_matte_body() {
    let mut scene = Scene::named("octahedron").unwrap();
    scene.objects[0].material.base_color = Vec3::ZERO;
    let environment = ones();
    let settings = Settings { environment: &environment, samples: 1, wavelengths: 3, ..Settings::of_size(8, 8) };
    let normal = DVec3::ONE.normalize();
    let seen = |scene: &Scene| {
        let job = Job::new(scene, &settings);
        let primary = job.surroundings.primary(2.0 * normal, -normal).expect("met");
        job.surroundings.follow(&primary, &job.spectrum[job.spectrum.len() / 2].optics, &mut generator(1, 0)).radiance
    };
    let index = scene.objects[0].material.index_at(550.0);
    let reflectance = ((index - 1.0) / (index + 1.0)).powi(2);
    assert!(seen(&scene).abs_diff_eq(DVec3::splat(reflectance), 1e-3), "{}", seen(&scene));
    let color = Vec3::new(0.0, 0.5, 1.0);
    scene.objects.push(matte(sphere(1.0, 32).placed(DQuat::IDENTITY, 4.0 * normal), color));
    let expected = reflectance * color.as_dvec3();
    assert!(seen(&scene).abs_diff_eq(expected, 1e-3), "{}, not {expected}", seen(&scene));
}

/// A ball under a constant and a linear environment and a sun, against a direct sum over the
/// directions of the light. Its facets are large: the interpolated normal on the way to the middle
/// is exactly the way's direction, which no facet's normal is.
#[test]
fn a_matte_body_sends_what_falls_on_it() {
    let pixel = |(direction, _): (DVec3, f64)| {
        let [red, green, blue] = (DVec3::ONE + 0.5 * direction).as_vec3().to_array();
        [red, green, blue, 1.0]
    };
    let linear = EnvironmentMap { width: 128, height: 64, pixels: cells(64).map(pixel).collect() };
    let base_color = Vec3::new(0.5, 0.25, 1.0);
    let toward = DVec3::new(2.0, 3.0, -6.0) / 7.0;
    let sun = Light::Directional { toward: toward.as_vec3(), irradiance: Vec3::new(3.0, 2.0, 1.0) };
    let mut scene = Scene::named("octahedron").unwrap();
    scene.objects = vec![matte(sphere(1.0, 16), base_color)];
    scene.lights.push(sun);
    let normals = [DVec3::X, DVec3::NEG_Z, toward, DVec3::new(0.48, 0.6, 0.64), DVec3::new(-0.64, -0.6, 0.48)];
    for environment in [ones(), Environment::Map(linear)] {
        let settings = Settings { environment: &environment, wavelengths: 3, ..Settings::of_size(8, 8) };
        let sent = |scene: &Scene, settings: &Settings<'_>, normal: DVec3| {
            let job = Job::new(scene, settings);
            let Some(Primary::Matte(radiance)) = job.surroundings.primary(5.0 * normal, -normal) else {
                panic!("the ball is met")
            };
            radiance
        };
        for normal in normals {
            let parts = cells(96).map(|(direction, solid_angle)| {
                solid_angle * direction.dot(normal).max(0.0) * environment.radiance(direction)
            });
            let lit = toward.dot(normal).max(0.0) * DVec3::new(3.0, 2.0, 1.0);
            let expected = base_color.as_dvec3() / PI * (parts.sum::<DVec3>() + lit);
            let found = sent(&scene, &settings, normal);
            assert!(found.abs_diff_eq(expected, 2e-3), "{normal}: {found}, not {expected}");
            let by_sun = sent(&scene, &Settings { lit_by_environment: false, ..settings }, normal);
            assert!(by_sun.abs_diff_eq(base_color.as_dvec3() / PI * lit, 2e-6), "{normal}: {by_sun}");
        }
    }
}

/// A white metal in radiance 1 is not seen, however rough, and one of a constant half is darker by what its facets take.
#[test]
fn white_furnace_with_a_metal() {
    let environment = ones();
    let mut scene = Scene { lights: Vec::new(), ..Scene::named("jade").unwrap() };
    for roughness in [0.0, 0.4, 1.0] {
        for object in &mut scene.objects {
            object.material = Material { metallic: 1.0, roughness, ..Material::standard() };
        }
        let settings = Settings { environment: &environment, samples: 1, ..Settings::of_size(16, 16) };
        let rendering = rendered(&scene, &settings);
        let most = rendering.linear.iter().map(|pixel| (pixel[0] - pixel[3]).abs()).fold(0.0, f32::max);
        assert!(most < 2e-4, "roughness {roughness}: {most}");
    }
    // Half of a metal is matte.
    for object in &mut scene.objects {
        object.material = Material { metallic: 0.5, base_color: Vec3::splat(0.5), ..Material::standard() };
    }
    let settings = Settings { environment: &environment, samples: 4, ..Settings::of_size(8, 8) };
    let covered = |rendering: &Rendering| -> (f32, f32) {
        rendering.linear.iter().fold((0.0, 0.0), |sum, pixel| (sum.0 + pixel[0], sum.1 + pixel[3]))
    };
    let (sum, share) = covered(&rendered(&scene, &settings));
    for object in &mut scene.objects {
        object.material.metallic = 1.0;
    }
    let (metal, _) = covered(&rendered(&scene, &settings));
    assert!((sum - 0.5 * (metal + 0.5 * share)).abs() < 0.01 * sum, "{sum} {metal} {share}");
}
