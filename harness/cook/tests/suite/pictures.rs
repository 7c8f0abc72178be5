//! `cook render` and `cook scene`: what is written, where, and that options change it.

use lapidary_scene::{Scene, glb, gltf};
use lapidary_testing::program::{cook, folder, succeeds};
use std::path::Path;

/// A preset is the material of the scene that is named after it, down to the picture.
#[test]
fn a_brilliant_of_ruby_is_the_ruby() {
    let folder = folder();
    let render = |scene: &str, more: &[&str], out: &str| {
        let usual = ["render", scene, "--size", "96x96", "--samples", "2", "--out", out];
        succeeds(folder.path(), &[&usual, more].concat());
        std::fs::read(folder.path().join(out)).expect("a picture")
    };
    let ruby = render("ruby", &[], "ruby.png");
    assert!(render("brilliant", &["--material", "brilliant=ruby"], "dressed.png") == ruby);
    assert!(render("brilliant", &[], "diamond.png") != ruby);
}

#[test]
fn a_picture_has_the_size_that_was_asked_for_and_is_the_same_again() {
    let folder = folder();
    for name in ["out.png", "out.exr"] {
        let path = folder.path().join(name);
        let render = || {
            succeeds(folder.path(), &["render", "octahedron", "--size", "64x48", "--out", name]);
            std::fs::read(&path).expect("the output")
        };
        let bytes = render();
        assert_eq!(image::image_dimensions(&path).expect("a picture"), (64, 48), "{name}");
        let picture = image::open(&path).expect("a picture").into_rgb32f();
        let first = *picture.get_pixel(0, 0);
        assert!(picture.pixels().any(|pixel| *pixel != first), "{name} is of one colour");
        assert!(picture.pixels().all(|pixel| pixel.0.iter().all(|part| part.is_finite())), "{name}");
        // Byte for byte.
        assert!(render() == bytes, "{name} is not the same again");
    }
}

#[test]
fn a_picture_goes_where_no_name_is_given_to_the_scenes_own() {
    let folder = folder();
    let answer = succeeds(folder.path(), &["render", "octahedron", "--size", "16x16"]);
    assert_eq!(answer.stdout.trim_end(), "octahedron.png");
    assert!(folder.path().join("octahedron.png").is_file());
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 1);
}

/// A file names its scene, but never the place of its picture.
#[test]
fn a_file_does_not_choose_where_its_picture_goes() {
    let folder = folder();
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).expect("a folder");
    let outside = folder.path().join("taken");
    for name in ["../../x", "../taken", &outside.display().to_string(), "a/b", "..", "-"] {
        let scene = Scene { name: name.to_owned(), ..Scene::named("octahedron").expect("built in") };
        std::fs::write(folder.path().join("my stone.glb"), glb::write(&scene).expect("written")).expect("a file");
        let answer = succeeds(&inner, &["render", "../my stone.glb", "--size", "8x8", "--samples", "1"]);
        assert_eq!(answer.stdout, "my stone.png\n", "{name}");
        assert!(inner.join("my stone.png").is_file(), "{name}");
        assert_eq!(std::fs::read_dir(&inner).expect("a folder").count(), 1, "{name}");
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 2, "{name}");
    }
    // An alias of a built-in scene stands for that scene.
    assert_eq!(succeeds(&inner, &["render", "diamond", "--size", "8x8", "--samples", "1"]).stdout, "brilliant.png\n");
}

#[test]
#[cfg(unix)]
fn links_and_the_umask_hold_for_what_is_written() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = folder();
    std::fs::create_dir(folder.path().join("far")).expect("a folder");
    std::os::unix::fs::symlink("far/out.wgsl", folder.path().join("near.wgsl")).expect("a link");
    succeeds(folder.path(), &["copy", "srgb", "--out", "near.wgsl"]);
    assert!(folder.path().join("near.wgsl").is_symlink() && folder.path().join("far/out.wgsl").is_file());
    for (mask, mode) in [("077", 0o600), ("022", 0o644), ("002", 0o664)] {
        let line = format!("umask {mask}; exec \"$0\" copy srgb --out {mask}.wgsl");
        let status = std::process::Command::new("sh")
            .args(["-c", &line, env!("CARGO_BIN_EXE_cook")])
            .current_dir(folder.path())
            .stdout(std::process::Stdio::null())
            .status();
        assert!(status.expect("it starts").success());
        let metadata = std::fs::metadata(folder.path().join(format!("{mask}.wgsl"))).expect("written");
        assert_eq!(metadata.permissions().mode() & 0o777, mode, "umask {mask}");
    }
}

/// Leaving out an effect that nothing calls for is accepted and changes nothing.
#[test]
fn what_nothing_calls_for_may_be_left_out() {
    let folder = folder();
    let picture = |extra: &[&str]| {
        let arguments = ["render", "octahedron", "--size", "16x16", "--samples", "1", "--out", "out.png"];
        succeeds(folder.path(), &[&arguments, extra].concat());
        std::fs::read(folder.path().join("out.png")).expect("written")
    };
    assert!(picture(&[]) == picture(&["--without", "absorption,cdrf"]));
    picture(&["--rung", "reference", "--without", "absorption"]);
    succeeds(folder.path(), &["plan", "octahedron", "--without", "optical_path"]);
}

/// An environment with negative parts, as lossy compression leaves them, is used, and both commands
/// state their number.
#[test]
fn negative_radiance_is_told_and_taken_as_none() {
    let folder = folder();
    let pixels = image::ImageBuffer::from_fn(8, 4, |x, _| image::Rgb([0.5f32, if x == 2 { -1e-4 } else { 0.5 }, 0.5]));
    image::DynamicImage::ImageRgb32F(pixels).save(folder.path().join("sky.exr")).expect("written");
    let asked = ["octahedron", "--size", "8x8", "--environment", "sky.exr"];
    let answer = cook(folder.path(), &[&["render"], &asked[..]].concat());
    let note = "sky.exr: 4 pixels have negative parts, down to -1.0e-4, which count as 0";
    assert_eq!((answer.code, answer.stderr.as_str()), (Some(0), format!("cook: {note}\n").as_str()), "{answer:?}");
    assert!(succeeds(folder.path(), &[&["plan"], &asked[..]].concat()).stdout.contains(note));
}

/// A thousand bodies share everything that is equal. Each adds only its own mesh and material.
#[test]
#[cfg(target_os = "linux")]
fn a_thousand_gems_take_little_memory() {
    if !lapidary_testing::on_lavapipe("other drivers take memory of their own") {
        return;
    }
    let folder = folder();
    let scene = Scene::named("octahedron").expect("built in");
    let placed = |number: u32| {
        let place = glam::UVec3::new(number % 10, number / 10 % 10, number / 100).as_dvec3() * 3.0;
        let object = scene.objects[0].clone();
        lapidary_scene::Object { mesh: object.mesh.placed(glam::DQuat::IDENTITY, place), ..object }
    };
    let many = Scene { objects: (0..1000).map(placed).collect(), ..scene.clone() }.seen_from(60.0, 20.0);
    std::fs::write(folder.path().join("many.glb"), glb::write(&many).expect("written")).expect("a file");
    for (rung, name) in [("convex-8", "many.glb"), ("proxy-1", "many.glb"), ("bvh-2", "many.glb")] {
        let arguments = ["render", name, "--rung", rung, "--size", "64x64", "--samples", "1", "--out", "out.png"];
        let peak = peak_kib(folder.path(), &arguments);
        println!("{name} by {rung}: {} MiB at most", peak / 1024);
        // One gem takes about 110 MiB, for the driver and its compiler. Without sharing, each body
        // took another 3 MiB.
        assert!(peak > 0 && peak <= 200 * 1024, "{name} by {rung}: {peak} KiB");
    }
}

/// Returns the peak memory of a run in KiB, as the kernel reports it.
#[cfg(target_os = "linux")]
fn peak_kib(folder: &Path, arguments: &[&str]) -> u64 {
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_cook"))
        .args(arguments)
        .current_dir(folder)
        .env("XDG_RUNTIME_DIR", folder)
        .stdout(std::process::Stdio::null())
        .spawn()
        .expect("the binary starts");
    let mut peak = 0;
    while child.try_wait().expect("it runs").is_none() {
        let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kib = line.and_then(|line| line.split_whitespace().next()).and_then(|word| word.parse().ok());
        peak = peak.max(kib.unwrap_or(0));
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    assert!(child.wait().expect("it ended").success(), "{arguments:?}");
    peak
}

#[test]
fn a_written_scene_is_the_built_in() {
    let folder = folder();
    succeeds(folder.path(), &["scene", "brilliant", "--out", "stone.glb"]);
    let read = gltf::load(&folder.path().join("stone.glb")).unwrap_or_else(|error| panic!("{error}"));
    let built_in = Scene::named("brilliant").expect("a built-in scene");
    assert_eq!(read.objects[0].mesh, built_in.objects[0].mesh);
    assert_eq!(read.objects[0].material, built_in.objects[0].material);
    succeeds(folder.path(), &["render", "stone.glb", "--size", "16x16", "--out", "stone.png"]);
}

#[test]
fn rungs_and_exposure_change_the_picture() {
    let folder = folder();
    let picture = |extra: &[&str]| {
        let arguments = [["render", "octahedron", "--size", "32x32", "--out", "out.png"].as_slice(), extra].concat();
        succeeds(folder.path(), &arguments);
        std::fs::read(folder.path().join("out.png")).expect("the output")
    };
    let usual = picture(&[]);
    assert!(usual == picture(&["--rung", "walk-8+tracker", "--exposure", "1", "--centre", "stable"]));
    assert!(usual == picture(&["--quality", "good"]));
    assert!(picture(&["--quality", "fast"]) == picture(&["--rung", "walk-4"]));
    assert!(usual != picture(&["--quality", "fast"]) && usual != picture(&["--quality", "best"]));
    assert!(usual != picture(&["--rung", "surface"]));
    assert!(usual != picture(&["--exposure", "2"]));
    assert!(usual != picture(&["--from", "20,11"]));
    assert!(usual != picture(&["--rest", "dropped"]));
    assert!(usual != picture(&["--distance-limit", "1"]));
    assert!(picture(&["--rung", "proxy-1+paper"]) != picture(&["--rung", "proxy-1+paper", "--strength", "0.01"]));
    assert!(usual != picture(&["--rung", "reference"]));
}

#[test]
fn absorption_can_be_left_out() {
    let folder = folder();
    let picture = |extra: &[&str]| {
        let arguments = [["render", "ruby", "--size", "32x32", "--out", "out.png"].as_slice(), extra].concat();
        succeeds(folder.path(), &arguments);
        std::fs::read(folder.path().join("out.png")).expect("the output")
    };
    assert!(picture(&[]) != picture(&["--without", "absorption"]));
}

#[test]
fn the_committed_brilliant_is_what_the_command_writes() {
    let scene = lapidary_scene::Scene::named("brilliant").expect("built in");
    let written = lapidary_scene::glb::write(&scene).expect("glTF can hold it");
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/brilliant.glb");
    assert!(std::fs::read(path).expect("the asset") == written, "`./cook scene brilliant --out {path}` remakes it");
}

/// With one sample per pixel, edges are smoothed unless something else is asked for.
#[test]
fn one_sample_is_smoothed_by_default() {
    let folder = folder();
    let render = |name: &str, more: &[&str]| {
        let arguments = ["render", "octahedron", "--size", "48x48", "--samples", "1", "--out", name];
        succeeds(folder.path(), &[&arguments[..], more].concat());
        std::fs::read(folder.path().join(name)).expect("written")
    };
    let usual = render("usual.exr", &[]);
    assert!(usual == render("asked.exr", &["--footprint"]));
    let plain = render("plain.exr", &["--without", "footprint"]);
    assert!(usual != plain);
    assert!(plain == render("named.exr", &["--rung", "walk-8+tracker"]));
    let fast = render("fast.exr", &["--quality", "fast"]);
    assert!(fast == render("fast_plain.exr", &["--quality", "fast", "--without", "footprint"]));
    assert!(fast != render("fast_asked.exr", &["--quality", "fast", "--footprint"]));
}
