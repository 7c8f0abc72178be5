//! The committed pictures: new ones are the same, planted errors are seen, and a missing reference fails.

use lapidary_harness::scene::Scene;
use lapidary_harness::snapshot::{self, Committed, Comparison, SHOTS, Shot, SnapshotError};
use std::path::Path;

fn source() -> String {
    brilliant().source()
}

fn brilliant() -> &'static Shot {
    SHOTS.iter().find(|shot| shot.name == "brilliant").expect("the shot exists")
}

/// The committed folder's copy, so that a planted failure leaves its pictures elsewhere.
fn copy_of(folder: &Path) -> tempfile::TempDir {
    let copy = tempfile::tempdir().expect("a folder");
    for entry in std::fs::read_dir(folder).expect("the committed pictures") {
        let entry = entry.expect("an entry");
        if entry.path().is_dir() {
            continue;
        }
        std::fs::copy(entry.path(), copy.path().join(entry.file_name())).expect("copied");
    }
    copy
}

#[test]
fn every_picture_is_as_it_was() {
    for committed in Committed::all() {
        let name = committed.name();
        let pictures = committed.render(super::gpu()).expect("rendered");
        let comparison = snapshot::compare(name, &pictures, &committed.folder()).expect(name);
        assert!(comparison.holds(), "{name}: {comparison:?}; see the new picture and the difference beside it");
    }
}

/// Compares a picture with something wrong in it; its new picture and the difference must be left beside the reference.
fn planted(scene: &Scene, source: &str) -> Comparison {
    let copy = copy_of(&brilliant().folder());
    let pictures = snapshot::render_scene(super::gpu(), brilliant(), scene, source).expect("rendered");
    let comparison = snapshot::compare("brilliant", &pictures, copy.path()).expect("compared");
    for kind in ["new", "difference"] {
        assert_eq!(copy.path().join(format!("brilliant.{kind}.png")).exists(), !comparison.holds(), "{kind}");
    }
    comparison
}

#[test]
fn a_literal_equation_3_is_seen() {
    let literal = source().replace("return closest_point_centre(", "return closest_point_centre_literal(");
    assert_ne!(literal, source());
    let comparison = planted(&Scene::named("brilliant").expect("built in"), &literal);
    assert!(!comparison.holds(), "{comparison:?}");
}

#[test]
fn a_turn_of_one_degree_is_seen() {
    let mut scene = Scene::named("brilliant").expect("built in");
    let turn = glam::Quat::from_rotation_y(1f32.to_radians());
    scene.camera.eye = turn * scene.camera.eye;
    scene.camera.target = turn * scene.camera.target;
    scene.camera.up = turn * scene.camera.up;
    let comparison = planted(&scene, &source());
    assert!(!comparison.holds(), "{comparison:?}");
}

#[test]
fn swapped_channels_are_seen() {
    let swapped = source().replace(
        "vec4f(radiance.surface + radiance.inside, 1.0f)",
        "vec4f((radiance.surface + radiance.inside).bgr, 1.0f)",
    );
    assert_ne!(swapped, source());
    let comparison = planted(&Scene::named("brilliant").expect("built in"), &swapped);
    assert!(!comparison.holds(), "{comparison:?}");
}

#[test]
fn a_missing_reference_fails_and_is_not_made() {
    let empty = tempfile::tempdir().expect("a folder");
    let pictures = snapshot::render_shot(super::gpu(), brilliant()).expect("rendered");
    let error = snapshot::compare("brilliant", &pictures, empty.path()).expect_err("no reference");
    assert!(matches!(error, SnapshotError::Missing(_)), "{error}");
    assert_eq!(std::fs::read_dir(empty.path()).expect("the folder").count(), 0);
}

#[test]
fn an_unreadable_reference_fails() {
    let copy = copy_of(&brilliant().folder());
    std::fs::write(copy.path().join("brilliant.png"), b"not a picture").expect("written");
    let pictures = snapshot::render_shot(super::gpu(), brilliant()).expect("rendered");
    let error = snapshot::compare("brilliant", &pictures, copy.path()).expect_err("no picture");
    assert!(matches!(error, SnapshotError::Unreadable { .. }), "{error}");
}

#[test]
fn the_committed_pictures_are_small() {
    // By name, since another test may have left a failure's pictures beside them.
    let files = Committed::all().flat_map(|committed| {
        ["png", "exr"].map(|extension| committed.folder().join(format!("{}.{extension}", committed.name())))
    });
    let sizes: Vec<u64> = files.map(|file| std::fs::metadata(file).expect("a committed picture").len()).collect();
    assert_eq!(sizes.len(), 2 * Committed::COUNT);
    assert!(sizes.iter().all(|size| *size <= snapshot::LARGEST_FILE));
    assert!(sizes.iter().sum::<u64>() <= 24 << 20);
}

/// What the gallery shows as a picture's command leaves out nothing that nothing calls for, which `cook` refuses.
#[test]
fn the_pictures_commands_are_taken() {
    let mut left_out = 0;
    for shot in &snapshot::SHOTS {
        let command = shot.command();
        let words: Vec<&str> = command.split(' ').collect();
        let value = |flag: &str| words.iter().position(|word| *word == flag).map(|place| words[place + 1]);
        let (Some(rung), Some(without)) = (value("--rung"), value("--without")) else { continue };
        let arguments = ["plan", shot.scene, "--size", "8x8", "--rung", rung, "--without", without, "--json"];
        crate::program::succeeds(crate::program::folder().path(), &arguments);
        left_out += 1;
    }
    assert!(left_out > 5, "{left_out} commands leave anything out");
}
