//! Copies of a stone in one draw call: their pictures, and what a host uploads when they move.

use glam::{Quat, Vec3};
use lapidary_assay::extremum::larger;
use lapidary_plan::{Effect, Effects, Rung};
use lapidary_render::frame::{Executor, Frame, Pass, ResourceKind};
use lapidary_render::{Picture, Settings, frame, render};
use lapidary_scene::{Copies, Object, Place, Scene};
use lapidary_testing::gpu;

fn settings() -> Settings {
    Settings { rung: Rung::ByMaterial, samples: 1, ..Settings::of_size(160, 160) }
}

fn ring() -> Scene {
    Scene::named("pave_ring").expect("built in")
}

/// Returns the ring turned about its own axis.
fn turned(scene: &Scene, degrees: f32) -> Scene {
    let turn = Quat::from_rotation_z(degrees.to_radians());
    let mut scene = scene.clone();
    let object = scene.objects.remove(0);
    let Copies { shape, places } = object.copies.expect("copies");
    let place =
        |place: &Place| Place { rotation: turn * place.rotation, translation: turn * place.translation, ..*place };
    let copies = Copies { shape, places: places.iter().map(place).collect() };
    scene.objects.push(Object::of_copies(object.name, copies, object.material));
    scene
}

fn drawn(scene: &Scene) -> Frame {
    frame(Some(gpu()), scene, &settings()).expect("a frame")
}

/// Returns the share of the pixels that differ by more than a thousandth.
fn differing(one: &Picture, other: &Picture) -> f64 {
    let differs = |(one, other): (&[f32; 4], &[f32; 4])| {
        let scale = one.iter().chain(other).map(|part| part.abs()).fold(1.0, larger);
        one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, larger) > 1e-3 * scale
    };
    let count = one.linear.iter().zip(&other.linear).filter(|pair| differs((pair.0, pair.1))).count();
    count as f64 / one.linear.len() as f64
}

#[test]
fn two_hundred_stones_are_one_draw_call_of_eighty_bytes_each() {
    let frame = drawn(&ring());
    let scene = frame.passes.iter().filter_map(|pass| match pass {
        Pass::Render(pass) if pass.name == "scene" => Some(&pass.draws),
        _ => None,
    });
    let draws: Vec<u32> = scene.flatten().map(|draw| draw.instances).collect();
    assert_eq!(draws, [200]);
    let instances = frame.resources.iter().find(|resource| resource.name == "stones/instances").expect("instances");
    assert_eq!(instances.bytes(), 200 * 80);
    let ResourceKind::Buffer { layout: Some((name, layout)), .. } = &instances.kind else { panic!("a buffer") };
    assert_eq!((*name, layout.size), ("GemInstance", 80));
}

/// The frame of the turned ring needs nothing but other matrices: those of the copies and, since its
/// near and far planes follow the scene, that of the view. With them the first frame's resources
/// draw the second frame's picture.
#[test]
fn a_turning_ring_uploads_its_places_alone() {
    let scenes = [ring(), turned(&ring(), 7.0)];
    let [first, second] = [drawn(&scenes[0]), drawn(&scenes[1])];
    let changes = first.changes(&second).expect("the same work");
    let names: Vec<&str> = changes.iter().map(|(buffer, _)| first.name(*buffer)).collect();
    assert_eq!(names, ["stones/instances", "view"]);
    assert_eq!(changes.iter().map(|(_, contents)| contents.len()).sum::<usize>(), 200 * 80 + 80);
    let linear = |executor: &Executor<'_>| {
        let mut picture = Vec::<u8>::new();
        executor
            .run(|read, texels| {
                if read.picture == "linear picture" {
                    picture.extend(texels)
                }
            })
            .expect("run");
        picture
    };
    let executor = Executor::new(gpu(), first.clone()).expect("made");
    let before = linear(&executor);
    for (buffer, contents) in changes {
        executor.write_buffer(buffer, contents).expect("written");
        // Places for fewer stones are no places for all of them.
        let error = executor.write_buffer(buffer, &contents[16..]).expect_err("too few").to_string();
        assert!(error.contains(first.name(buffer)) && error.contains(&contents.len().to_string()), "{error}");
    }
    let moved = linear(&executor);
    let anew = linear(&Executor::new(gpu(), second).expect("made"));
    assert!(moved == anew && moved != before);
    assert!(!moved.is_empty());
}

#[test]
fn a_frame_of_other_work_is_no_change() {
    let first = drawn(&ring());
    let mut fewer = ring();
    let copies = fewer.objects[0].copies.as_mut().expect("copies");
    copies.places.truncate(100);
    assert!(first.changes(&drawn(&fewer)).is_none());
    assert!(first.changes(&drawn(&Scene::named("brilliant").expect("built in"))).is_none());
    assert_eq!(first.changes(&first).map(|changes| changes.len()), Some(0));
}

/// Each stone as an object of its own, and all stones of one colour as one mesh, show what the
/// copies show, but for the rounding of rays at edges.
#[test]
fn copies_show_what_bodies_apart_show() {
    let apart = Effects::of(&[Effect::Nested, Effect::Behind]);
    let without = apart.and(Effects::of(&[Effect::Instances]));
    let scene = ring();
    let settings = || Settings { without: apart, ..settings() };
    let copies = render(gpu(), &scene, &settings()).expect("rendered");
    let bodies = Scene { objects: scene.objects[0].apart(), ..scene.clone() };
    let separate = render(gpu(), &bodies, &settings()).expect("rendered");
    assert!(differing(&copies, &separate) < 0.01, "{}", differing(&copies, &separate));
    // Asked not to draw by instances, the renderer takes the stones apart by itself.
    let asked = Settings { without, ..settings() };
    let left_out = frame(None, &scene, &asked).expect("a frame");
    assert!(left_out.resources.iter().all(|resource| !resource.name.ends_with("instances")));
    let mut plain = scene;
    let mut object = plain.objects.remove(0);
    let copies = object.copies.as_mut().expect("copies");
    copies.places.iter_mut().for_each(|place| place.attenuation_color = None);
    plain.objects.push(object);
    let bvh = |settings: Settings| Settings { rung: "bvh-4".parse().expect("a rung"), ..settings };
    let [by_copies, joined] = [bvh(settings()), bvh(asked)].map(|case| render(gpu(), &plain, &case).expect("rendered"));
    assert!(differing(&by_copies, &joined) < 0.02, "{}", differing(&by_copies, &joined));
}

/// A stone far from the origin is as exact as one at it: rays run in its own space.
#[test]
fn a_copy_far_away_shows_the_same() {
    let stone = Scene::named("brilliant").expect("built in");
    let shown_at = |translation: Vec3| {
        let mut scene = stone.clone();
        let Object { name, mesh, material, .. } = scene.objects.remove(0);
        let copies = Copies { shape: mesh, places: vec![Place { translation, ..Place::IDENTITY }] };
        scene.objects.push(Object::of_copies(name, copies, material));
        scene.camera.eye += translation;
        scene.camera.target += translation;
        render(gpu(), &scene, &settings()).expect("rendered")
    };
    let near = render(gpu(), &stone, &settings()).expect("rendered");
    assert_eq!(differing(&near, &shown_at(Vec3::ZERO)), 0.0);
    // The eye's and the corners' own world positions are rounded to 2^-14 of the stone's radius.
    let share = differing(&near, &shown_at(Vec3::new(1000.0, 0.0, -500.0)));
    assert!(share < 0.05, "{share}");
}
