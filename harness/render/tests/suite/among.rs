//! Clear bodies among other bodies, by the rungs scene-HITS: against closed forms and against the reference.

use glam::{DQuat, DVec3, Vec3};
use lapidary_fresnel::oracle as fresnel;
use lapidary_plan::{Decisions, Effect, Effects};
use lapidary_refraction::oracle as refraction;
use lapidary_render::{Picture, Settings, render};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::normals::Normals;
use lapidary_scene::surfaces::{rounded_box, sphere, torus};
use lapidary_scene::{Camera, Density, Environment, Light, Material, Medium, Mesh, Object, Scene};
use lapidary_testing::gpu;
use std::f64::consts::PI;

mod images;
mod rough;

const SIDE: u32 = 48;

fn of_rung(rung: &str) -> Settings {
    let rung = rung.parse().expect("a rung");
    Settings { rung, samples: 2, environment: even(1.0), ..Settings::of_size(SIDE, SIDE) }
}

/// An environment of the same radiance from everywhere.
fn even(radiance: f32) -> Environment {
    let pixels = vec![[radiance, radiance, radiance, 1.0]; 8];
    Environment::Map(EnvironmentMap { width: 4, height: 2, pixels })
}

fn glass(ior: f32) -> Material {
    Material { transmission: 1.0, thickness: 1.0, roughness: 0.0, ior, ..Material::standard() }
}

/// A matte body; at an index of 1 it reflects nothing else.
fn matte(base_color: Vec3) -> Material {
    Material { base_color, ior: 1.0, ..Material::standard() }
}

fn ball(radius: f64, at: DVec3, material: Material) -> Object {
    Object::new("ball", sphere(radius, 48).placed(DQuat::IDENTITY, at), material)
}

/// The mesh with the normals of its triangles.
fn flat(mesh: &Mesh) -> Mesh {
    let normal = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a);
    let wide: Vec<[Vec3; 3]> = mesh.triangles().filter(|corners| normal(*corners).length() > 1e-6).collect();
    let normals = wide.iter().flat_map(|corners| [normal(*corners).normalize(); 3]).collect();
    let positions: Vec<Vec3> = wide.into_iter().flatten().collect();
    Mesh { indices: (0..positions.len() as u32).collect(), positions, normals, ..Mesh::default() }
}

fn cube(half: f64) -> Mesh {
    flat(&rounded_box(DVec3::splat(half), 0.0, 1))
}

/// The bodies seen from +z at a distance of 5.
fn scene(objects: Vec<Object>) -> Scene {
    let camera = Camera::upright(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, 0.5);
    Scene { objects, camera, lights: Vec::new(), ..Scene::named("octahedron").expect("built in") }
}

fn drawn(scene: &Scene, settings: &Settings) -> Picture {
    render(gpu(), scene, settings).expect("rendered")
}

fn colors(picture: &Picture) -> impl Iterator<Item = DVec3> {
    picture.linear.iter().map(|[red, green, blue, _]| Vec3::new(*red, *green, *blue).as_dvec3())
}

fn middle(picture: &Picture) -> DVec3 {
    let place = (picture.width * (picture.height / 2) + picture.width / 2) as usize;
    colors(picture).nth(place).expect("a pixel")
}

/// Returns the root mean square of the pixels' differences, and the difference that one in `one_in` exceeds.
fn difference(one: &Picture, other: &Picture, one_in: usize) -> (f64, f64) {
    let mut all: Vec<f64> = colors(one).zip(colors(other)).map(|(a, b)| (a - b).abs().max_element()).collect();
    all.sort_by(f64::total_cmp);
    let square: f64 = all.iter().map(|difference| difference * difference).sum();
    ((square / all.len() as f64).sqrt(), all[all.len() - 1 - all.len() / one_in])
}

/// Returns the means of blocks of pixels.
fn blocks(picture: &Picture) -> Vec<DVec3> {
    const BLOCK: u32 = 8;
    let all: Vec<DVec3> = colors(picture).collect();
    let mean = |left: u32, top: u32| {
        let rows = top..top + BLOCK;
        let places = rows.flat_map(|y| (left..left + BLOCK).map(move |x| (y * SIDE + x) as usize));
        places.map(|place| all[place]).sum::<DVec3>() / f64::from(BLOCK * BLOCK)
    };
    let starts = || (0..SIDE / BLOCK).map(|number| number * BLOCK);
    starts().flat_map(|top| starts().map(move |left| mean(left, top))).collect()
}

/// In a body of index 1 a matte one shows its own colour, and a clear one what it lets through.
#[test]
fn a_body_within_a_clear_one_is_seen() {
    let red = Vec3::new(0.8, 0.05, 0.05);
    let block = || Object::new("block", cube(1.0), glass(1.0));
    let within = [matte(red), Material { attenuation_color: red, attenuation_distance: 1.0, ..glass(1.0) }];
    let expected = [red.as_dvec3(), red.as_dvec3()];
    for (material, expected) in within.into_iter().zip(expected) {
        let picture = drawn(&scene(vec![block(), ball(0.5, DVec3::ZERO, material)]), &of_rung("by-material"));
        let seen = middle(&picture);
        assert!((seen - expected).abs().max_element() < 3e-3, "{seen} for {expected}");
        assert!(picture.notes.is_empty(), "{:?}", picture.notes);
    }
}

/// What leaves a convex stone meets the triangles beside it: through a block of index 1 a matte ball looks as without it, under a
/// lamp and a sun whose discs the stone shows too, by copies of the same rung as by bounds.
#[test]
fn a_stone_shows_the_triangles_beside_it() {
    let behind = ball(0.7, DVec3::new(0.1, 0.0, -1.5), matte(Vec3::new(0.9, 0.5, 0.2)));
    let lights = vec![
        Light::Directional { toward: Vec3::new(0.6, 0.8, 0.0), irradiance: Vec3::splat(2.0) },
        Light::Point { position: Vec3::new(-3.0, 2.0, 1.0), intensity: Vec3::new(9.0, 6.0, 3.0) },
    ];
    let lit = |objects| Scene { lights: lights.clone(), ..scene(objects) };
    let alone = drawn(&lit(vec![behind.clone()]), &of_rung("by-material"));
    let block = Object::new("block", cube(0.6), glass(1.0));
    let gem = lapidary_render::GemOptions { outside: Some(lapidary_plan::Outside::Triangles), ..Default::default() };
    let settings = Settings { gem, lights: true, ..of_rung("walk-8+tracker") };
    let through = drawn(&lit(vec![block, behind]), &settings);
    let covered = |pixel: &&[f32; 4]| pixel[3] == 1.0;
    let pairs = alone.linear.iter().zip(&through.linear).filter(|(one, _)| covered(one));
    let channels = pairs.flat_map(|(one, other)| (0..3).map(|channel| (one[channel] - other[channel]).abs()));
    let mut apart: Vec<f32> = channels.collect();
    apart.sort_by(f32::total_cmp);
    // Shares of the largest, in 255 steps of their roots: at most two roots of it times a step, half of which rounding is off.
    let largest = alone.linear.iter().flat_map(|pixel| pixel[..3].to_vec()).fold(0.0, f32::max);
    assert!(apart.len() > 500 && apart[apart.len() * 9 / 10] < largest / 255.0 + 1e-3, "{apart:?} of {largest}");
}

/// Whatever lies within what, light of radiance 1 from everywhere leaves a clear body as it was.
#[test]
fn no_energy_is_lost_or_made() {
    let smooth = |object: Object| {
        let normals = Normals::File;
        Object { material: Material { normals, ..object.material.clone() }, ..object }
    };
    let drop = |index| smooth(ball(0.6, DVec3::new(0.2, 0.0, 0.1), glass(index)));
    let ring = Object::new("ring", torus(0.7, 0.2, 32, 16), glass(1.5));
    let scenes = [
        vec![Object::new("block", cube(0.8), glass(1.5)), drop(2.4)],
        vec![ball(0.9, DVec3::ZERO, glass(1.3)), drop(1.0)],
        vec![smooth(ring), drop(1.5)],
        vec![Object::new("pane", cube(0.7), Material { thickness: 0.0, ..glass(1.5) }), drop(1.7)],
    ];
    for objects in scenes {
        let picture = drawn(&scene(objects), &of_rung("scene-32"));
        for (pixel, [.., coverage]) in colors(&picture).zip(&picture.linear) {
            assert!(*coverage < 1.0 || (pixel - 1.0).abs().max_element() < 2e-3, "{pixel}");
        }
    }
}

/// Liquid in a glass: beside a gap of air total reflection hides it; where it touches the wall, and where
/// it overlaps a wall that comes first, it is seen as in solid glass.
#[test]
fn liquid_touches_its_glass_or_overlaps_it_or_leaves_a_gap() {
    let wall = |priority| {
        let mut mesh = cube(0.9);
        let mut inner = cube(0.7);
        inner.indices.chunks_exact_mut(3).for_each(|corners| corners.swap(0, 1));
        mesh.append(&inner);
        Object::new("glass", mesh, Material { priority, ..glass(1.5) })
    };
    let liquid = |half| {
        let tint = Vec3::new(0.2, 0.5, 0.9);
        Object::new("water", cube(half), Material { attenuation_color: tint, attenuation_distance: 1.0, ..glass(1.33) })
    };
    let seen = |objects: Vec<Object>| {
        let camera = Camera::upright(Vec3::new(2.0, 1.7, 4.0), Vec3::ZERO, 0.5);
        drawn(
            &Scene { camera, ..scene(objects) },
            &Settings { environment: Environment::Studio, ..of_rung("scene-32") },
        )
    };
    let solid = seen(vec![Object::new("glass", cube(0.9), glass(1.5)), liquid(0.7)]);
    let touching = seen(vec![wall(0), liquid(0.7)]);
    let overlapping = seen(vec![wall(1), liquid(0.8)]);
    let gap = seen(vec![wall(0), liquid(0.6)]);
    for (name, picture) in [("touching", &touching), ("overlapping", &overlapping)] {
        // Surfaces that are not there take hits as well.
        let (_, most) = difference(&solid, picture, 10);
        assert!(most < 0.05, "{name}: {most}");
    }
    let (_, most) = difference(&solid, &gap, 10);
    assert!(most > 0.2, "{most}");
}

/// An environment of black and white squares.
fn checkers() -> Environment {
    const CHECKER: usize = 32;
    let (width, height) = (512, 256);
    let light = |x: usize, y: usize| if (x / CHECKER + y / CHECKER).is_multiple_of(2) { 1.0 } else { 0.0 };
    let pixels = (0..width * height).map(|place| [light(place % width, place / width); 3]);
    let pixels = pixels.map(|[r, g, b]| [r, g, b, 1.0]).collect();
    let map = EnvironmentMap { width: width as u32, height: height as u32, pixels };
    Environment::Map(map)
}

/// A ball of index 1.5 shows checkers as the closed form does: the two issues of a coarse mesh, its normals
/// and its places, are mended by the curved surface between its corners.
#[test]
fn a_smooth_ball_is_round() {
    let environment = checkers();
    for (columns, most) in [(24, 0.02), (96, 0.005)] {
        let ball = Object::new("ball", sphere(1.0, columns), glass(1.5));
        let mut settings = Settings { environment: environment.clone(), samples: 1, ..of_rung("by-material") };
        let scene = scene(vec![ball]);
        for rung in ["by-material", "reference"] {
            settings.rung = rung.parse().expect("a rung");
            let picture = drawn(&scene, &settings);
            let (mut square, mut count) = (0.0, 0);
            for (place, seen) in colors(&picture).enumerate() {
                let at = |place: usize| 2.0 * (place as f64 + 0.5) / f64::from(SIDE) - 1.0;
                let half = f64::from(0.5 * scene.camera.vertical_fov).tan();
                let [x, y] = [place % SIDE as usize, place / SIDE as usize].map(at);
                let direction = DVec3::new(half * x, -half * y, -1.0).normalize();
                let eye = 5.0 * DVec3::Z;
                if eye.cross(direction).length() < 0.85 {
                    let error = seen.x - through_ball(eye, direction, &environment);
                    square += error * error;
                    count += 1;
                }
            }
            let error = (square / f64::from(count)).sqrt();
            assert!(error <= most, "{columns} columns, {rung}: {error}");
        }
    }
}

/// A ball whose top is cut off and polished flat: normals are those of the ball, but on the facet.
fn drop_with_a_facet() -> Mesh {
    const COLUMNS: u32 = 32;
    let round = sphere(0.9, COLUMNS);
    // Five rings below the pole.
    let height = 0.9 * (2.0 * 5.0 * std::f32::consts::PI / COLUMNS as f32).cos();
    let is_cut = |corners: [Vec3; 3]| corners.iter().all(|corner| corner.y > height - 1e-4);
    let mut mesh = Mesh::default();
    for triangle in round.indices.chunks_exact(3) {
        let corners = [0, 1, 2].map(|corner| round.positions[triangle[corner] as usize]);
        for (position, index) in corners.into_iter().zip(triangle) {
            mesh.indices.push(mesh.positions.len() as u32);
            mesh.positions.push(Vec3 { y: position.y.min(height), ..position });
            mesh.normals.push(if is_cut(corners) { Vec3::Y } else { round.normals[*index as usize] });
        }
    }
    mesh
}

/// Smooth bodies that are no balls: what refracts by interpolated normals does so in the reference too, and a
/// facet with a hard edge stays flat.
#[test]
fn smooth_bodies_are_as_the_reference_shows_them() {
    let mut egg = sphere(0.6, 48);
    for (position, normal) in egg.positions.iter_mut().zip(&mut egg.normals) {
        let stretch = Vec3::new(1.4, 0.8, 1.0);
        (*position, *normal) = (*position * stretch, (*normal / stretch).normalize());
    }
    let turn = DQuat::from_rotation_x(0.9);
    for (name, mesh) in [("ellipsoid", egg), ("torus", torus(0.6, 0.3, 48, 24)), ("drop", drop_with_a_facet())] {
        let body = Object::new(name, mesh.placed(turn, DVec3::ZERO), glass(1.5));
        assert!(lapidary_plan::is_smooth(&body), "{name}");
        let scene = scene(vec![body]);
        let settings = |rung| Settings { environment: checkers(), samples: 1, ..of_rung(rung) };
        let [seen, truth] = ["scene-64", "reference"].map(|rung| drawn(&scene, &settings(rung)));
        let (error, most) = difference(&seen, &truth, 50);
        assert!(error < 0.02 && most < 0.01, "{name}: {error} {most}");
    }
}

/// Radiance seen in a unit ball of index 1.5 about the origin, by the closed form.
fn through_ball(eye: DVec3, direction: DVec3, environment: &Environment) -> f64 {
    let about = eye.dot(direction);
    let mut point = eye - (about + (1.0 - eye.cross(direction).length_squared()).sqrt()) * direction;
    let cosine = -point.dot(direction);
    let reflectance = fresnel::dielectric(cosine, 1.5);
    let mirrored = direction + 2.0 * cosine * point;
    let mut radiance = reflectance * environment.radiance(mirrored).x;
    let mut inside = refraction::refract(direction, point, 1.5).direction;
    let mut carried = 1.0 - reflectance;
    while carried > 1e-5 {
        point = (point - 2.0 * point.dot(inside) * inside).normalize();
        let reflectance = fresnel::dielectric(point.dot(inside), 1.0 / 1.5);
        let leaving = refraction::refract(inside, -point, 1.0 / 1.5);
        radiance += carried * (1.0 - reflectance) * environment.radiance(leaving.direction).x;
        carried *= reflectance;
        inside -= 2.0 * point.dot(inside) * point;
    }
    radiance
}

/// Through a block of index 1 a lamp is seen as it is: what all pixels get from it is its irradiance at the eye.
#[test]
fn a_lamp_is_seen_through_a_clear_body_with_all_its_energy() {
    let block = Object::new("block", cube(1.0), glass(1.0));
    let lamp = Light::Point { position: Vec3::new(0.1, 0.05, -3.0), intensity: Vec3::new(8.0, 4.0, 2.0) };
    let lit = |radius| Scene { lights: vec![lamp], light_radii: vec![Some(radius)], ..scene(vec![block.clone()]) };
    let expected = lamp.arrival(5.0 * DVec3::Z).irradiance;
    // The larger disc has many samples, the smaller one less than one.
    for (radius, most) in [(0.4, 0.02), (1e-4, 0.35)] {
        for rung in ["by-material", "scene-8", "reference"] {
            if rung == "reference" && radius < 0.1 {
                // Its samples have no footprint.
                continue;
            }
            let settings = Settings { environment: even(0.0), samples: 4, ..of_rung(rung) };
            let half = f64::from(0.5 * lit(radius).camera.vertical_fov).tan();
            let picture = drawn(&lit(radius), &settings);
            let sum: DVec3 = colors(&picture).sum();
            let sum = sum * (2.0 * half / f64::from(SIDE)).powi(2);
            let error = (sum / expected - 1.0).abs().max_element();
            assert!(error < most, "{rung}, radius {radius}: {sum} for {expected}");
        }
    }
}

/// Behind a thin pane a clear body is seen, below what the pane's two interfaces reflect.
#[test]
fn a_clear_body_is_seen_behind_a_pane() {
    let tint = Vec3::new(0.9, 0.6, 0.3);
    let pane = Material { thickness: 0.0, base_color: tint, ..glass(1.5) };
    let mut flat = cube(1.0);
    for position in &mut flat.positions {
        position.z = 1.5 + 0.01 * position.z;
    }
    let color = Vec3::new(0.2, 0.5, 0.8);
    let behind = Material { attenuation_color: color, attenuation_distance: 1.0, ..glass(1.0) };
    let objects = vec![Object::new("pane", flat, pane), ball(0.5, DVec3::ZERO, behind)];
    let once = fresnel::dielectric(1.0, 1.5);
    let reflectance = 2.0 * once / (1.0 + once);
    let expected = reflectance + (1.0 - reflectance) * tint.as_dvec3() * color.as_dvec3();
    for rung in ["by-material", "reference"] {
        let seen = middle(&drawn(&scene(objects.clone()), &of_rung(rung)));
        assert!((seen - expected).abs().max_element() < 3e-3, "{rung}: {seen} for {expected}");
    }
}

fn octahedron() -> Object {
    Object::new("stone", flat(&Scene::named("octahedron").expect("built in").objects[0].mesh), glass(1.5))
}

/// An opaque bar, by its half sides and its middle.
fn bar(half: Vec3, at: Vec3) -> Object {
    let mesh = cube(1.0);
    let positions = mesh.positions.iter().map(|position| *position * half + at).collect();
    Object::new("bar", Mesh { positions, ..mesh }, matte(Vec3::new(0.9, 0.3, 0.1)))
}

/// A prong in a stone is met by rays inside, and a band around it by what leaves: by the planes of its facets the stone looks as by
/// the triangles of all bodies. Both follow the same rays, which end with less than a hundredth of the light.
#[test]
fn a_stone_in_its_setting_is_walked_as_it_is_by_triangles() {
    let within = bar(Vec3::new(0.1, 0.6, 0.1), 0.75 * Vec3::X);
    let behind = bar(Vec3::new(2.0, 2.0, 0.1), -1.4 * Vec3::Z);
    let scene = scene(vec![octahedron(), within, behind]);
    let settings = |rung: &str| Settings { environment: Environment::Studio, ..of_rung(rung) };
    let chosen = drawn(&scene, &settings("by-material"));
    assert!(chosen.notes.is_empty() || !chosen.notes[0].to_string().contains("alone"), "{:?}", chosen.notes);
    let by_triangles = drawn(&scene, &settings("scene-32"));
    let (walked, _) = difference(&drawn(&scene, &settings("walk-16")), &by_triangles, 20);
    let (unmet, _) = {
        let without = Effects::of(&[Effect::Nested]);
        difference(&drawn(&scene, &Settings { without, ..settings("walk-16") }), &by_triangles, 20)
    };
    assert!(walked < 0.02 && unmet > 3.0 * walked, "{walked}, and {unmet} without the prong");
}

/// A body that reaches through a convex stone, and one that lies within it, are met by rays inside as by all triangles.
#[test]
fn what_reaches_deep_into_a_stone_is_walked_as_it_is_by_triangles() {
    for half in [Vec3::new(2.0, 0.1, 0.1), Vec3::splat(0.15)] {
        let scene = scene(vec![octahedron(), bar(half, Vec3::ZERO)]);
        let settings = |rung: &str| Settings { environment: Environment::Studio, ..of_rung(rung) };
        let decided = Decisions::of(&scene.objects[0], &scene, &settings("by-material").request());
        assert!(!decided.rung.is_among() && decided.has(Effect::Nested), "{half}: {}", decided.reason);
        let [walked, by_triangles] = ["walk-16", "scene-32"].map(|rung| drawn(&scene, &settings(rung)));
        let (error, _) = difference(&walked, &by_triangles, 20);
        assert!(error < 0.02, "{half}: {error}");
    }
}

/// Numbers from 0 to 1 that follow from a seed (splitmix64).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }
}

/// Clear and matte bodies of several shapes at random places, some within others.
fn mixed(seed: u64) -> Scene {
    let mut numbers = Numbers(seed);
    let mut objects = Vec::new();
    for number in 0..5 {
        let size = 0.25 + 0.5 * numbers.next();
        let at = 1.2 * (numbers.vector() - 0.5);
        let turn = DQuat::from_axis_angle((numbers.vector() - 0.5).normalize(), 2.0 * PI * numbers.next());
        let octahedron = || flat(&Scene::named("octahedron").expect("built in").objects[0].mesh);
        let mesh = match number {
            0 => cube(size),
            1 | 2 => sphere(size, 32),
            3 => octahedron(),
            _ => torus(size, 0.4 * size, 32, 16),
        };
        let color = numbers.vector().as_vec3();
        let material = if numbers.next() < 0.65 {
            let ior = 1.0 + numbers.next() as f32;
            Material { attenuation_color: color, attenuation_distance: 1.0, ..glass(ior) }
        } else {
            matte(color)
        };
        objects.push(Object::new(format!("body {number}"), mesh.placed(turn, at), material));
    }
    let toward = (numbers.vector() - 0.5).normalize().as_vec3();
    let lights = vec![Light::Directional { toward, irradiance: Vec3::ONE }];
    Scene { lights, light_radii: vec![Some(0.2)], ..scene(objects) }
}

/// Few pixels differ from the reference, and fewer with more hits.
#[test]
fn mixed_scenes_agree_with_the_reference() {
    let seeds: Vec<u64> = (1..=10).collect();
    for seed in lapidary_testing::sampled(seeds, 3) {
        let scene = mixed(seed);
        let settings = |rung| Settings { environment: Environment::Studio, samples: 1, ..of_rung(rung) };
        let truth = drawn(&scene, &settings("reference"));
        let [few, many] =
            ["scene-16", "scene-64"].map(|rung| difference(&drawn(&scene, &settings(rung)), &truth, 20).1);
        assert!(many <= few + 1e-3 && many < 0.01, "seed {seed}: {few} and {many}");
    }
}

/// The same with bodies in which light scatters, thicker than twenty mean free paths: through clear bodies they look as right as
/// without them.
#[test]
fn mixed_scenes_with_scattering_bodies_agree_with_the_reference() {
    let seeds: Vec<u64> = (1..=10).collect();
    for seed in lapidary_testing::sampled(seeds, 2) {
        let mut scene = mixed(seed);
        let mut numbers = Numbers(seed + 100);
        for object in scene.objects.iter_mut().skip(1).step_by(2) {
            let albedo = 0.6 + 0.38 * numbers.vector().as_vec3();
            let (scattering, absorption) = (100.0 * albedo, 100.0 * (1.0 - albedo));
            let medium = Medium { scattering, absorption, anisotropy: 0.0, density: Density::Uniform };
            object.material = Material { medium: Some(medium), ..matte(Vec3::ONE) };
        }
        // The reference has no shadows.
        let without = Effects::of(&[Effect::Shadow, Effect::TranslucentShadow, Effect::ColoredShadow]);
        let settings = |rung| Settings {
            environment: Environment::Studio,
            samples: 2,
            without,
            half_space: true,
            ..of_rung(rung)
        };
        let error = |scene: &Scene| {
            let [truth, seen] = ["reference", "scene-64"].map(|rung| blocks(&drawn(scene, &settings(rung))));
            let squares: f64 = seen.iter().zip(&truth).map(|(a, b)| (*a - *b).length_squared() / 3.0).sum();
            (squares / truth.len() as f64).sqrt()
        };
        let mut bare = scene.clone();
        bare.objects.retain(|object| !object.material.is_clear());
        let [seen, alone] = [&scene, &bare].map(error);
        // A block has 4096 walks, and light in its mean a fifth of its deviation, or less.
        assert!(seen < 1.25 * alone + 0.003, "seed {seed}: {seen}, without the clear bodies {alone}");
        assert!(seen < 0.02, "seed {seed}: {seen}");
    }
}
