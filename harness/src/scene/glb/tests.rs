use super::*;
use crate::scene::{BUILT_IN, Mineral, gltf};

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

/// The JSON of a scene as it is written.
fn json_of(scene: &Scene) -> Value {
    serde_json::from_slice(chunk(&write(scene).unwrap(), 12).1).unwrap()
}

#[test]
fn every_kind_of_material_survives_writing_and_loading() {
    let mut scene = Scene::named("octahedron").unwrap();
    let standard = Material::standard();
    let measured = Mineral::ALL.map(|mineral| Material {
        ior: mineral.index(),
        dispersion: Dispersion::Sellmeier(mineral),
        ..Material::standard()
    });
    let others = [
        Material { ior: 1.0, base_color: Vec3::ZERO, ..standard.clone() },
        Material { dispersion: Dispersion::Abbe(20.0 / 57.0), ..standard.clone() },
        Material { dispersion: Dispersion::Abbe(f32::MAX), ..standard.clone() },
        Material { attenuation_color: Vec3::new(0.0, 0.1, 1.0), ..standard.clone() },
        Material { attenuation_distance: 1.0 / 3.0, ..standard.clone() },
        Material { attenuation_distance: f32::MIN_POSITIVE, ..standard.clone() },
        Material { attenuation_distance: f32::MAX, attenuation_color: Vec3::splat(0.7), ..standard },
    ];
    for material in measured.into_iter().chain(others) {
        scene.objects[0].material = material;
        let again = gltf::parse(&write(&scene).unwrap(), None).unwrap();
        assert_eq!(again.objects, scene.objects);
    }
}

#[test]
fn materials_are_written_for_other_readers_too() {
    let mut scene = Scene::named("ruby").unwrap();
    let json = json_of(&scene);
    let used =
        json!(["KHR_materials_dispersion", "KHR_materials_ior", "KHR_materials_transmission", "KHR_materials_volume",]);
    assert_eq!(json["extensionsUsed"], used);
    let material = &json["materials"][0];
    assert_eq!(material["extras"], json!({"lapidary": {"sellmeier": "corundum"}}));
    let extensions = &material["extensions"];
    let dispersion = extensions["KHR_materials_dispersion"]["dispersion"].as_f64().unwrap();
    assert!((20.0 / dispersion - 72.3).abs() < 1e-4);
    let volume = &extensions["KHR_materials_volume"];
    assert_eq!(volume["attenuationDistance"], 2.0);
    // Shorter than the stone is wide, longer than half its depth; a 0 would mean a thin wall.
    let thickness = volume["thicknessFactor"].as_f64().unwrap();
    assert!((0.5..1.5).contains(&thickness), "{thickness}");

    scene.objects[0].material = Material::standard();
    let json = json_of(&scene);
    let used = json!(["KHR_materials_ior", "KHR_materials_transmission", "KHR_materials_volume"]);
    assert_eq!(json["extensionsUsed"], used);
    assert_eq!(json["materials"][0]["extras"], Value::Null);
    let volume = &json["materials"][0]["extensions"]["KHR_materials_volume"];
    assert_eq!(volume["attenuationDistance"], Value::Null, "JSON has no infinity");
}

#[test]
fn thickness_is_the_mean_way_through_and_never_nothing() {
    // The regular octahedron with its corners at distance 1: V = 4/3, S = 4√3.
    let octahedron = Scene::named("octahedron").unwrap().objects.remove(0).mesh;
    assert!((thickness(&octahedron) - 4.0 / 27f32.sqrt()).abs() < 1e-6);
    let mut inside_out = octahedron.clone();
    inside_out.indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(0, 1));
    let mut open = octahedron.clone();
    open.indices.truncate(3);
    for mesh in [inside_out, open] {
        assert!((0.1..=2.0 * 3f32.sqrt() + 1e-6).contains(&thickness(&mesh)));
    }
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
    assert!(refused(|s| s.objects[0].material.attenuation_distance = 0.0).contains("attenuation distance"));
    assert!(refused(|s| s.objects[0].material.ior = 2.4).contains("Sellmeier"));
    assert!(refused(|s| s.objects[0].mesh.positions[0].x = f32::NAN).contains("not finite"));
    assert!(refused(|s| s.objects[0].material.ior = f32::NAN).contains("refractive index"));
}
