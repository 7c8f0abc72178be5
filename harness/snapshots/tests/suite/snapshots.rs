//! The committed pictures: new ones match them, planted errors are seen, and a missing reference
//! fails.

use lapidary_render as render;
use lapidary_render::Picture;
use lapidary_scene::Scene;
use lapidary_snapshots as snapshot;
use lapidary_snapshots::{self, Committed, Comparison, SHOTS, Shot, SnapshotError};
use std::path::Path;

/// Unless the suite is run whole, one picture in this many is spoilt.
const ONE_IN: u64 = 16;

fn source() -> String {
    brilliant().source()
}

fn brilliant() -> &'static Shot {
    SHOTS.iter().find(|shot| shot.name == "brilliant").expect("the shot exists")
}

/// Copies the committed folder, so that a planted failure leaves its pictures elsewhere.
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

/// A displayed picture takes longer to draw than linear radiance, so that fewer are drawn, and of the long ones none unless
/// the suite is run whole.
#[test]
fn pictures_are_as_they_were() {
    let chosen = Committed::all().filter(|committed| lapidary_testing::whole() || !LONG.contains(&committed.name()));
    for committed in lapidary_testing::sampled(chosen, 32) {
        let name = committed.name();
        let pictures = committed.render(lapidary_testing::gpu()).expect("rendered");
        let comparison = snapshot::compare(name, &pictures, &committed.folder()).expect(name);
        println!("{name:28} {comparison:?}");
        assert!(comparison.holds(), "{name}: {comparison:?}; see the new picture and the difference beside it");
    }
}

/// Pictures that take as long as all others together; unless the suite is run whole, one of them, and one in three
/// of the others.
const LONG: [&str; 5] = ["beside_walks", "strip", "chandelier", "vitrine", "ring"];

#[test]
fn linear_radiance_is_as_it_was() {
    let (long, short): (Vec<_>, Vec<_>) = Committed::all().partition(|committed| LONG.contains(&committed.name()));
    assert_eq!(long.len(), LONG.len());
    let short = lapidary_testing::sampled(short, 3);
    for committed in short.into_iter().chain(lapidary_testing::sampled(long, LONG.len() as u64)) {
        let name = committed.name();
        let picture = committed.render_linear(lapidary_testing::gpu()).expect("rendered");
        let rmse = snapshot::compare_linear(name, &picture, &committed.folder()).expect(name);
        println!("{name:28} {rmse}");
        assert!(rmse <= snapshot::MOST_RMSE, "{name}: {rmse}; see the new picture beside it");
    }
}

/// Compares a picture that has an error. If the comparison fails, the new picture and the
/// difference must be left next to the reference.
fn planted(scene: &Scene, source: &str) -> Comparison {
    let copy = copy_of(&brilliant().folder());
    let pictures = snapshot::render_scene(lapidary_testing::gpu(), brilliant(), scene, source).expect("rendered");
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

/// Returns a committed picture as it was rendered, from its files.
fn committed(name: &str, folder: &Path) -> [Picture; 2] {
    let open = |extension: &str| image::open(folder.join(format!("{name}.{extension}"))).expect(name);
    let [seen, linear] = [open("png"), open("exr")];
    [seen.clone(), linear].map(|image| Picture {
        width: image.width(),
        height: image.height(),
        linear: image.to_rgba32f().pixels().map(|pixel| pixel.0).collect(),
        encoded: seen.to_rgba8().pixels().map(|pixel| pixel.0).collect(),
        lost: None,
        walked: None,
        notes: Vec::new(),
    })
}

/// Spoils the committed pictures and compares them with the originals.
fn spoilt(name: &str, folder: &Path, spoil: impl Fn(&mut [Picture; 2])) -> Result<Comparison, SnapshotError> {
    let copy = tempfile::tempdir().expect("a folder");
    for extension in ["png", "exr"] {
        let file = format!("{name}.{extension}");
        std::fs::copy(folder.join(&file), copy.path().join(&file)).expect("copied");
    }
    let mut pictures = committed(name, folder);
    spoil(&mut pictures);
    snapshot::compare(name, &pictures, copy.path())
}

/// Returns the upper left corner of the brightest square with this side.
fn brightest(picture: &Picture, side: usize) -> (usize, usize) {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let places =
        (0..height - side).step_by(8).flat_map(|top| (0..width - side).step_by(8).map(move |left| (left, top)));
    let light = |&(left, top): &(usize, usize)| -> u64 {
        let rows = (top..top + side).flat_map(|row| &picture.encoded[row * width + left..][..side]);
        rows.flat_map(|pixel| &pixel[..3]).map(|code| u64::from(*code)).sum()
    };
    places.max_by_key(light).expect("a square")
}

/// The eye cannot miss a hole in the displayed picture, although it covers only 1/256 of the
/// picture and the linear radiance has none.
#[test]
fn a_black_square_is_seen() {
    for picture in lapidary_testing::sampled(Committed::all(), ONE_IN) {
        let (name, folder) = (picture.name(), picture.folder());
        let comparison = spoilt(name, &folder, |[seen, _]| {
            // A sixteenth of the width, and at least 32.
            let (width, side) = (seen.width as usize, (seen.width as usize / 16).max(32));
            let (left, top) = brightest(seen, side);
            for row in top..top + side {
                seen.encoded[row * width + left..][..side].fill([0, 0, 0, 255]);
            }
        });
        let comparison = comparison.expect(name);
        println!("{name:28} {comparison:?}");
        assert!(!comparison.holds(), "{name}: {comparison:?}");
    }
}

#[test]
fn what_is_no_number_is_refused() {
    let (brilliant, folder) = (brilliant().name, brilliant().folder());
    for which in [0, 1] {
        for (value, channel) in [(f32::NAN, 0), (f32::INFINITY, 2), (f32::NAN, 3)] {
            let planted = spoilt(brilliant, &folder, |pictures| pictures[which].linear[1234][channel] = value);
            let error = planted.expect_err("not finite");
            assert!(matches!(error, SnapshotError::NotFinite { .. }), "{error}");
        }
    }
    // Such a picture is no valid reference either, and is not accepted as one.
    let copy = copy_of(&folder);
    let before = std::fs::read(copy.path().join("brilliant.exr")).expect("a reference");
    let mut pictures = committed(brilliant, &folder);
    pictures[1].linear[1234][1] = f32::NAN;
    let error = snapshot::accept(brilliant, &pictures, copy.path()).expect_err("not finite");
    assert!(matches!(error, SnapshotError::NotFinite { .. }), "{error}");
    assert!(std::fs::read(copy.path().join("brilliant.exr")).expect("a reference") == before);
    lapidary_render::file::write(&pictures[1], &copy.path().join("brilliant.exr")).expect("written");
    let sound = committed(brilliant, &folder);
    let error = snapshot::compare(brilliant, &sound, copy.path()).expect_err("not finite");
    assert!(error.to_string().contains("brilliant.exr: pixel (210, 4)"), "{error}");
}

/// Coverage is 1 even if the body is dark. With coverage in the reference's power, light of the
/// wrong strength hardly counted.
#[test]
fn dim_light_is_compared_by_itself() {
    for picture in lapidary_testing::sampled(Committed::all(), ONE_IN) {
        let (name, folder) = (picture.name(), picture.folder());
        let comparison = spoilt(name, &folder, |[_, linear]| {
            linear.linear.iter_mut().flat_map(|pixel| &mut pixel[..3]).for_each(|value| *value *= 0.95);
        });
        let comparison = comparison.expect(name);
        assert!(!comparison.holds() && (comparison.rmse - 0.05).abs() < 1e-3, "{name}: {comparison:?}");
    }
}

/// Checks every picture, as displayed and in linear radiance alone. A picture without colour has no
/// channels to swap.
#[test]
fn channels_are_told_apart() {
    for picture in lapidary_testing::sampled(Committed::all(), ONE_IN) {
        let (name, folder) = (picture.name(), picture.folder());
        let seen = spoilt(name, &folder, |[seen, _]| seen.encoded.iter_mut().for_each(|pixel| pixel.swap(0, 2)));
        let linear = spoilt(name, &folder, |[_, linear]| linear.linear.iter_mut().for_each(|pixel| pixel.swap(0, 2)));
        let [seen, linear] = [seen, linear].map(|comparison| comparison.expect(name));
        println!("{name:28} {seen:?} {linear:?}");
        assert!(!seen.holds() && !linear.holds(), "{name}: {seen:?} {linear:?}");
    }
}

/// Another driver may snap vertices to another grid, and place samples 1/256 of their distance away
/// from ours.
#[test]
fn another_drivers_samples_pass() {
    let mut failed = Vec::new();
    // The rungs with the most edges per pixel, and one of each other recipe.
    let chosen =
        ["brilliant", "brilliant_separate", "exact_separate", "bunny_stone", "prism", "skin_bunny", "jade", "bunny"];
    for shot in lapidary_testing::sampled(SHOTS.iter().filter(|shot| chosen.contains(&shot.name)), ONE_IN) {
        let mut scene = shot.open().expect("built in");
        let per_sample = scene.camera.vertical_fov / (snapshot::EXR_SIDE * shot.samples) as f32;
        let turn = glam::Quat::from_axis_angle(glam::Vec3::new(0.6, 0.64, 0.48).normalize(), per_sample / 256.0);
        let camera = &mut scene.camera;
        camera.target = camera.eye + turn * (camera.target - camera.eye);
        camera.up = turn * camera.up;
        let copy = copy_of(&shot.folder());
        let pictures = [shot.side, snapshot::EXR_SIDE]
            .map(|side| render::render(lapidary_testing::gpu(), &scene, &shot.settings(side)).expect("rendered"));
        let comparison = snapshot::compare(shot.name, &pictures, copy.path()).expect("compared");
        println!("{:28} {comparison:?}", shot.name);
        if !comparison.holds() {
            failed.push((shot.name, comparison));
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
}

#[test]
fn a_missing_reference_fails_and_is_not_made() {
    let empty = tempfile::tempdir().expect("a folder");
    let pictures = snapshot::render_shot(lapidary_testing::gpu(), brilliant()).expect("rendered");
    let error = snapshot::compare("brilliant", &pictures, empty.path()).expect_err("no reference");
    assert!(matches!(error, SnapshotError::Missing(_)), "{error}");
    assert_eq!(std::fs::read_dir(empty.path()).expect("the folder").count(), 0);
}

#[test]
fn an_unreadable_reference_fails() {
    let copy = copy_of(&brilliant().folder());
    std::fs::write(copy.path().join("brilliant.png"), b"not a picture").expect("written");
    let pictures = snapshot::render_shot(lapidary_testing::gpu(), brilliant()).expect("rendered");
    let error = snapshot::compare("brilliant", &pictures, copy.path()).expect_err("no picture");
    assert!(matches!(error, SnapshotError::Unreadable { .. }), "{error}");
}

#[test]
fn the_committed_pictures_are_small() {
    // By name, because another test may have left the pictures of a failure in the folder.
    let files = Committed::all().flat_map(|committed| {
        ["png", "exr"].map(|extension| committed.folder().join(format!("{}.{extension}", committed.name())))
    });
    let sizes: Vec<u64> = files.map(|file| std::fs::metadata(file).expect("a committed picture").len()).collect();
    assert_eq!(sizes.len(), 2 * Committed::COUNT);
    assert!(sizes.iter().all(|size| *size <= snapshot::LARGEST_FILE));
    assert!(sizes.iter().sum::<u64>() <= 24 << 20);
}

/// The gallery shows a command for each picture. The command must not leave out an effect that the
/// scene does not need, because `cook` refuses that.
#[test]
fn the_pictures_commands_are_taken() {
    let mut left_out = 0;
    for shot in &snapshot::SHOTS {
        let command = shot.command();
        let words: Vec<&str> = command.split(' ').collect();
        let value = |flag: &str| words.iter().position(|word| *word == flag).map(|place| words[place + 1]);
        let (Some(rung), Some(without)) = (value("--rung"), value("--without")) else { continue };
        let arguments = ["plan", shot.scene, "--size", "8x8", "--rung", rung, "--without", without, "--json"];
        lapidary_testing::program::succeeds(lapidary_testing::program::folder().path(), &arguments);
        left_out += 1;
    }
    assert!(left_out > 5, "{left_out} commands leave anything out");
}
