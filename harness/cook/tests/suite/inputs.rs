//! What a command reads, it never overwrites, by whatever name or link it is told to.

use lapidary_scene::{Scene, glb};
use lapidary_testing::program::{cook, folder};
use serde_json::{Value, json};
use std::path::Path;

/// Writes a stone as .gltf with its data and a picture beside it, named as the default picture of the scene.
fn write(folder: &Path) {
    let bytes = glb::write(&Scene::named("octahedron").expect("built in")).expect("glTF");
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize;
    let mut document: Value = serde_json::from_slice(&bytes[20..20 + length]).expect("JSON");
    document["buffers"][0]["uri"] = json!("stone.bin");
    document["images"] = json!([{"uri": "stone.png"}]);
    std::fs::write(folder.join("stone.bin"), &bytes[28 + length..]).expect("written");
    std::fs::write(folder.join("stone.gltf"), document.to_string()).expect("written");
    image::RgbImage::from_pixel(4, 4, image::Rgb([9, 8, 7])).save(folder.join("stone.png")).expect("written");
    image::Rgb32FImage::from_pixel(4, 2, image::Rgb([1.0; 3])).save(folder.join("env.exr")).expect("written");
}

#[test]
fn an_output_is_never_an_input() {
    let folder = folder();
    let folder = folder.path();
    write(folder);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("stone.gltf", folder.join("link.png")).expect("a link");
        std::fs::hard_link(folder.join("stone.bin"), folder.join("hard.png")).expect("a link");
    }
    let read = |name: &str| std::fs::read(folder.join(name)).expect(name);
    let inputs = ["stone.gltf", "stone.bin", "stone.png", "env.exr"];
    let before = inputs.map(read);
    let refused = |out: &str, says: &str| {
        let arguments = ["render", "stone.gltf", "--size", "8x8", "--environment", "env.exr", "--out", out];
        let answer = cook(folder, &arguments);
        assert_eq!(answer.code, Some(2), "{out}: {}", answer.stderr);
        assert!(answer.stderr.contains(says) && answer.stderr.lines().count() == 1, "{out}: {}", answer.stderr);
    };
    refused("env.exr", "env.exr: the command reads it, and would overwrite it");
    refused("./stone.png", "stone.png: the command reads it");
    if cfg!(unix) {
        refused("link.png", "link.png: the command reads it as stone.gltf");
        refused("hard.png", "hard.png: the command reads it as stone.bin");
    }
    // Without a name, the picture takes one that is free.
    let answer = cook(folder, &["render", "stone.gltf", "--size", "8x8"]);
    assert_eq!((answer.code, answer.stdout.trim()), (Some(0), "stone.picture.png"), "{}", answer.stderr);
    assert_eq!(inputs.map(read), before);
}

/// What cannot be told anybody ends nothing.
#[test]
#[cfg(target_os = "linux")]
fn a_full_stderr_ends_no_command() {
    let folder = folder();
    let full = || std::fs::OpenOptions::new().write(true).open("/dev/full").expect("a device");
    let program = lapidary_testing::program::program(None);
    for (arguments, code) in [(["list", "nothing"], 2), (["plan", "nothing"], 2), (["plan", "ruby"], 0)] {
        let status = std::process::Command::new(&program)
            .args(arguments)
            .current_dir(folder.path())
            .stdout(std::process::Stdio::null())
            .stderr(full())
            .status()
            .expect("it runs");
        assert_eq!(status.code(), Some(code), "{arguments:?}");
    }
}
