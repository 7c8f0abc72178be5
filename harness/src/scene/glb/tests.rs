use super::*;
use crate::scene::{BUILT_IN, gltf};

fn chunk(bytes: &[u8], at: usize) -> (&[u8], &[u8]) {
    let length = u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    (&bytes[at + 4..at + 8], &bytes[at + 8..at + 8 + length])
}

#[test]
fn every_built_in_scene_survives_writing_and_loading() {
    for built_in in BUILT_IN {
        let scene = Scene::named(built_in.name).unwrap();
        let again = gltf::parse(&write(&scene).unwrap(), None).unwrap();
        assert_eq!(again.name, scene.name);
        assert_eq!(again.objects, scene.objects);
        let (a, b) = (again.camera, scene.camera);
        assert_eq!(a.vertical_fov, b.vertical_fov);
        assert_eq!(a.eye, b.eye);
        let look = |camera: Camera| (camera.target - camera.eye).normalize();
        assert!(look(a).distance(look(b)) < 1e-6 && a.up.distance(b.up) < 1e-6);
    }
}

#[test]
fn the_container_is_aligned_and_complete() {
    let scene = Scene::named("brilliant").unwrap();
    let bytes = write(&scene).unwrap();
    assert_eq!(bytes, write(&scene).unwrap());
    assert_eq!(&bytes[..8], b"glTF\x02\0\0\0");
    let total = u32::from_le_bytes(bytes[8..12].try_into().unwrap());
    assert_eq!(total as usize, bytes.len());
    let (kind, json) = chunk(&bytes, 12);
    assert_eq!((kind, json.len() % 4), (&b"JSON"[..], 0));
    let (kind, binary) = chunk(&bytes, 20 + json.len());
    assert_eq!((kind, binary.len() % 4), (&b"BIN\0"[..], 0));

    let json: Value = serde_json::from_slice(json).unwrap();
    assert_eq!(json["asset"]["generator"], "Lapidary");
    let extensions = &json["materials"][0]["extensions"];
    assert_eq!(extensions["KHR_materials_transmission"]["transmissionFactor"], 1.0);
    assert_eq!(extensions["KHR_materials_ior"]["ior"].as_f64().unwrap() as f32, 2.41749);
    assert_eq!(json["accessors"][0]["max"][0], 1.0);
    let length = json["buffers"][0]["byteLength"].as_u64().unwrap() as usize;
    assert!(binary.len() - length < 4);
}

#[test]
fn what_gltf_forbids_is_refused() {
    let good = Scene::named("octahedron").unwrap();
    let refused = |change: fn(&mut Scene)| {
        let mut scene = good.clone();
        change(&mut scene);
        write(&scene).unwrap_err().to_string()
    };
    assert!(refused(|s| s.objects.clear()).contains("no objects"));
    assert!(refused(|s| s.camera.vertical_fov = f32::NAN).contains("camera"));
    assert!(refused(|s| s.camera.eye.x = f32::INFINITY).contains("camera"));
    assert!(refused(|s| s.objects[0].mesh.indices.clear()).contains("no triangles"));
    assert!(refused(|s| s.objects[0].mesh.indices.truncate(4)).contains("multiple of three"));
    assert!(refused(|s| s.objects[0].mesh.indices[0] = 99).contains("past its last"));
    assert!(refused(|s| s.objects[0].mesh.normals.truncate(1)).contains("one normal"));
    assert!(refused(|s| s.objects[0].mesh.positions[0].x = f32::NAN).contains("not finite"));
    assert!(refused(|s| s.objects[0].material.ior = f32::NAN).contains("refractive index"));
}
