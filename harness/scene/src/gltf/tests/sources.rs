//! The files that a scene is read from.

use super::*;
use std::path::PathBuf;

#[test]
fn a_scene_is_read_from_its_file_its_buffers_and_its_images() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("stone.gltf");
    let mut document = document();
    document["buffers"] =
        json!([{"byteLength": 44, "uri": "my%20data.bin"}, {"byteLength": 1, "uri": "data:;base64,AA=="}]);
    document["images"] = json!([{"uri": "stone.png"}, {"bufferView": 0}, {"uri": "../out.png"}]);
    std::fs::write(&path, document.to_string()).unwrap();
    let found = Scene::sources(path.to_str().unwrap());
    let expected: Vec<PathBuf> = ["stone.gltf", "my data.bin", "stone.png"].map(|name| folder.path().join(name)).into();
    assert_eq!(found, expected);
    assert!(Scene::sources("brilliant").is_empty());
    let binary = folder.path().join("stone.glb");
    std::fs::write(&binary, file(&document, &super::binary())).unwrap();
    assert_eq!(Scene::sources(binary.to_str().unwrap()).len(), 3);
    // What cannot be read is told elsewhere.
    let missing = folder.path().join("none.glb");
    assert_eq!(Scene::sources(missing.to_str().unwrap()), [missing]);
}
