//! Notes about a picture.

use super::{ball, coarse, draw, stone, sun};
use glam::Vec3;
use lapidary_plan::Note;
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{Scene, glb};
use lapidary_testing::program::{cook, folder, succeeds};

/// Returns the ball without its far right part: columns along x cross the remainder once.
fn open() -> Scene {
    let mut scene = ball(1.0, vec![sun()]);
    scene.objects[0].mesh = sphere(10.0, 64);
    let mesh = &mut scene.objects[0].mesh;
    let left = |triangle: &&[u32]| mesh.positions[triangle[0] as usize].x < 6.0;
    mesh.indices = mesh.indices.chunks_exact(3).filter(left).flatten().copied().collect();
    scene
}

#[test]
fn a_hole_is_told_of_by_object() {
    let mut scene = open();
    let mut closed = stone("closed", sphere(4.0, 64), Vec3::ONE);
    closed.mesh = closed.mesh.placed(glam::DQuat::IDENTITY, glam::DVec3::new(30.0, 0.0, 0.0));
    scene.objects.insert(0, closed);
    let notes = draw(&scene, &coarse()).notes;
    let [Note::Open { object, odd_columns, columns: 1024 }] = &notes[..] else { panic!("{notes:?}") };
    assert!(object == "ball" && *odd_columns > 0, "{notes:?}");
}

#[test]
fn a_sound_scene_is_not_talked_about() {
    assert_eq!(draw(&ball(1.0, vec![sun()]), &coarse()).notes, []);
}

#[test]
fn render_says_it_in_one_line_and_goes_on() {
    let folder = folder();
    let render = |scene: &Scene, name: &str| {
        std::fs::write(folder.path().join(name), glb::write(scene).expect("written")).expect("a file");
        ["render", name, "--rung", "godunov-16", "--size", "24x24", "--out", "out.png"].map(str::to_owned)
    };
    let answer = cook(folder.path(), &render(&open(), "open.glb"));
    assert_eq!((answer.code, answer.stdout.as_str()), (Some(0), "out.png\n"), "{answer:?}");
    let lines: Vec<&str> = answer.stderr.lines().collect();
    let [line] = lines[..] else { panic!("{answer:?}") };
    assert!(line.starts_with("cook: object `ball` is not closed: ") && line.contains("of the 256 columns"), "{line}");
    assert!(folder.path().join("out.png").exists());
    let closed = render(&ball(1.0, vec![sun()]), "closed.glb");
    succeeds(folder.path(), &closed.each_ref().map(String::as_str));
}
