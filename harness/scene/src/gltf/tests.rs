//! Tests of the loader, and of its messages for files that it cannot read.

use glam::Quat;
use serde_json::{Value, json};

use super::diamond::NAME as DIAMOND;
use super::*;
use crate::normals::FALLBACK_NORMAL;
use crate::{Dispersion, Material, Medium, Mineral, glb};

mod animations;
mod cameras;
mod contradictions;
mod example;
mod head;
mod images;
mod instancing;
mod lacking;
mod lights;
mod marked_stones;
mod packed;
mod quantised;
mod refusals;
mod refused_data;
mod sources;
mod sparse;
mod texture_coordinates;
mod textures;
mod transmission;
mod vertex_colors;

/// Returns the three corners of a right triangle, followed by the indices 0 1 2 0 as shorts.
fn binary() -> Vec<u8> {
    let corners: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let indices: [u16; 4] = [0, 1, 2, 0];
    let corners = corners.into_iter().flat_map(f32::to_le_bytes);
    corners.chain(indices.into_iter().flat_map(u16::to_le_bytes)).collect()
}

/// Returns a file with one triangle, which each test modifies.
fn document() -> Value {
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"name": "test", "nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "stone"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "materials": [{"name": "gem"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 8},
        ],
        "buffers": [{"byteLength": 44}],
    })
}

fn file(document: &Value, binary: &[u8]) -> Vec<u8> {
    glb::container(document.to_string().as_bytes(), binary).unwrap()
}

fn load_changed(change: impl FnOnce(&mut Value)) -> Result<Scene, SceneError> {
    let mut document = document();
    change(&mut document);
    parse(&file(&document, &binary()), None)
}

fn only_mesh(scene: &Scene) -> &crate::Mesh {
    assert_eq!(scene.objects.len(), 1);
    &scene.objects[0].mesh
}

#[test]
fn a_triangle_loads_with_names_and_computed_normals() {
    let scene = load_changed(|_| ()).unwrap();
    assert_eq!((scene.name.as_str(), scene.objects[0].name.as_str()), ("test", "stone"));
    assert_eq!(scene.objects[0].material, Material { metallic: 1.0, ..Material::standard() });
    let mesh = only_mesh(&scene);
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(mesh.normals, [Vec3::Z; 3]);
    assert_eq!(mesh.indices, [0, 1, 2]);
}

/// Primitives of one material are one body, which has the node's name if it is the only one.
#[test]
fn primitives_of_one_material_are_one_body() {
    let primitive = |material: usize| json!({"attributes": {"POSITION": 0}, "indices": 1, "material": material});
    let load = |materials: &[usize]| {
        let primitives: Vec<Value> = materials.iter().map(|material| primitive(*material)).collect();
        let scene = load_changed(|d| {
            d["materials"] = json!([{"name": "gem"}, {"name": "gold"}]);
            d["meshes"][0]["primitives"] = primitives.into();
        });
        let objects = scene.expect("a scene").objects;
        let of = |object: &Object| (object.name.clone(), object.material.name.clone(), object.mesh.triangle_count());
        objects.iter().map(of).collect::<Vec<_>>()
    };
    let body = |name: &str, material: &str, triangles| (name.to_owned(), material.to_owned(), triangles);
    assert_eq!(load(&[0, 0, 0]), [body("stone", "gem", 3)]);
    assert_eq!(load(&[0, 1, 0]), [body("stone / 0", "gem", 2), body("stone / 1", "gold", 1)]);
}

/// An index of refraction beyond those of clear bodies is drawn as the nearest, of clear bodies and of others.
#[test]
fn an_index_that_cannot_be_drawn_is_the_nearest_and_said() {
    for (ior, drawn) in [(0.0, 4.0), (0.5, 1.0), (-1.0, 1.0), (5.0, 4.0), (1e39, 4.0)] {
        for transmission in [0, 1] {
            let scene = load_changed(|d| {
                d["meshes"][0]["primitives"][0]["material"] = json!(0);
                d["materials"][0] = json!({
                    "name": "gem",
                    "pbrMetallicRoughness": {"metallicFactor": 0},
                    "extensions": {
                        "KHR_materials_ior": {"ior": ior},
                        "KHR_materials_transmission": {"transmissionFactor": transmission},
                    },
                });
            });
            let scene = scene.expect("a scene");
            assert_eq!(scene.objects[0].material.ior, drawn);
            let clause = format!("index of refraction: `ior` {ior:?} of material `gem` (drawn as {drawn})");
            assert_eq!(scene.lacking.clauses(), [clause]);
        }
    }
}

/// A solid that its node makes flat, or a point, is no thin wall: its mesh is at fault.
#[test]
fn a_solid_of_scale_0_stays_a_solid() {
    for scale in [[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0]] {
        let scene = load_changed(|d| {
            d["nodes"][0]["scale"] = json!(scale);
            d["meshes"][0]["primitives"][0]["material"] = json!(0);
            d["materials"][0]["extensions"] = json!({
                "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 2},
            });
        });
        assert!(scene.expect("a scene").objects[0].material.has_clear_inside(), "{scale:?}");
    }
}

#[test]
fn buffers_may_be_base64_or_files_beside() {
    use base64::Engine;
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("my data.bin"), binary()).unwrap();
    let text = base64::engine::general_purpose::STANDARD.encode(binary());
    let inline = format!("data:application/octet-stream;base64,{text}");
    for uri in ["my%20data.bin", "./my data.bin", &inline, inline.trim_end_matches('=')] {
        let mut document = document();
        document["buffers"][0]["uri"] = json!(uri);
        document["scenes"][0]["name"] = Value::Null;
        let path = folder.path().join("stone.gltf");
        std::fs::write(&path, document.to_string()).unwrap();
        let scene = load(&path).unwrap();
        assert_eq!(scene.name, "stone");
        assert_eq!(only_mesh(&scene).indices, [0, 1, 2]);
    }
}

#[test]
fn strips_and_fans_become_lists_without_turning_points() {
    let strip = load_changed(|d| {
        d["meshes"][0]["primitives"][0]["mode"] = json!(5);
        d["accessors"][1]["count"] = json!(4);
    });
    // The second triangle is 1 0 2, wound the other way.
    assert_eq!(only_mesh(&strip.unwrap()).indices, [0, 1, 2, 1, 0, 2]);
    let fan = load_changed(|d| {
        d["meshes"][0]["primitives"][0]["mode"] = json!(6);
        d["accessors"][1]["count"] = json!(4);
    });
    assert_eq!(only_mesh(&fan.unwrap()).indices, [1, 2, 0]);
    let plain = load_changed(|d| {
        let primitive = d["meshes"][0]["primitives"][0].as_object_mut().unwrap();
        primitive.remove("indices");
    });
    assert_eq!(only_mesh(&plain.unwrap()).indices, [0, 1, 2]);
}

#[test]
fn transforms_compose_and_mirrors_turn_the_winding() {
    let turn = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2).to_array();
    let scene = load_changed(|d| {
        d["scenes"][0]["nodes"] = json!([1]);
        d["nodes"] = json!([
            {"mesh": 0, "translation": [0, 0, 1], "rotation": turn, "scale": [2, 1, 1]},
            {"children": [0], "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]},
        ]);
        d["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(2);
        // The corners reused as normals: zero, +x, +y.
        let corners = d["accessors"][0].clone();
        d["accessors"].as_array_mut().unwrap().push(corners);
    });
    let scene = scene.unwrap();
    let mesh = only_mesh(&scene);
    let near = |a: Vec3, b: Vec3| assert!(a.distance(b) < 1e-6, "{a} is not {b}");
    near(mesh.positions[0], Vec3::new(5.0, 0.0, 1.0));
    near(mesh.positions[1], Vec3::new(5.0, 0.0, -1.0));
    near(mesh.positions[2], Vec3::new(5.0, 1.0, 1.0));
    assert_eq!(mesh.indices, [0, 2, 1]);
    // The first normal has no direction, so the triangle's own normal is used.
    near(mesh.normals[0], Vec3::NEG_X);
    near(mesh.normals[1], Vec3::NEG_Z);
    near(mesh.normals[2], Vec3::Y);
}

#[test]
fn an_uneven_scale_keeps_normals_at_right_angles() {
    let scene = load_changed(|d| {
        d["nodes"][0]["scale"] = json!([1, 0.25, 3]);
        d["nodes"][0]["rotation"] = json!([0.2, 0.4, 0.4, 0.8]);
    });
    let mesh = only_mesh(scene.as_ref().unwrap()).clone();
    let [a, b, c] = mesh.triangles().next().unwrap();
    let across = (b - a).cross(c - a).normalize();
    assert!(mesh.normals.iter().all(|normal| normal.distance(across) < 1e-6));
}

#[test]
fn a_normal_without_length_is_replaced_by_the_shared_one() {
    let mut data = binary();
    for normal in [Vec3::ZERO, Vec3::new(0.0, 3.0, 4.0), Vec3::splat(f32::NAN)] {
        data.extend(normal.to_array().into_iter().flat_map(f32::to_le_bytes));
    }
    let mut document = document();
    document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(2);
    let accessors = document["accessors"].as_array_mut().unwrap();
    accessors.push(json!({"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC3"}));
    document["bufferViews"].as_array_mut().unwrap().push(json!({"buffer": 0, "byteOffset": 44, "byteLength": 36}));
    document["buffers"][0]["byteLength"] = json!(80);
    let scene = parse(&file(&document, &data), None).unwrap();
    assert_eq!(only_mesh(&scene).normals, [Vec3::Z, Vec3::new(0.0, 0.6, 0.8), Vec3::Z]);
}

#[test]
fn flattened_bodies_load() {
    let scene = load_changed(|d| d["nodes"][0]["scale"] = json!([0, 0, 0])).unwrap();
    assert_eq!(only_mesh(&scene).normals, [FALLBACK_NORMAL; 3]);
    assert_ne!(scene.camera.eye, scene.camera.target);
}

/// Returns the material of a file whose only primitive has `material`.
fn material_of(material: Value) -> Result<Material, SceneError> {
    let scene = load_changed(|d| {
        d["extensionsRequired"] = json!(KNOWN_EXTENSIONS);
        d["meshes"][0]["primitives"][0]["material"] = json!(0);
        d["materials"][0] = material;
    });
    Ok(scene?.objects.remove(0).material)
}

#[test]
fn materials_say_colour_roughness_index_dispersion_attenuation_and_scattering() {
    let material = material_of(json!({
        "name": "ruby",
        "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.1, 0.2, 1.0], "roughnessFactor": 0.25},
        "extensions": {
            "KHR_materials_ior": {"ior": 1.768},
            "KHR_materials_dispersion": {"dispersion": 0.1},
            "KHR_materials_transmission": {"transmissionFactor": 0.75},
            "KHR_materials_diffuse_transmission":
                {"diffuseTransmissionFactor": 0.5, "diffuseTransmissionColorFactor": [0.5, 0, 1]},
            "KHR_materials_volume": {
                "thicknessFactor": 3.0,
                "attenuationColor": [1, 0.25, 0],
                "attenuationDistance": 0.5,
            },
        },
        "extras": {"someone": "else's", "lapidary": {
            "later": [1, 2],
            "sigma0": [4.5, 0, 1],
            "scattering": [0.74, 0.88, 1.01],
            "absorption": [0.032, 0.17, 0],
            "solver": "tiled-18-128",
        }},
    }));
    let expected = Material {
        name: "ruby".to_owned(),
        base_color: Vec3::new(0.9, 0.1, 0.2),
        ior: 1.768,
        dispersion: Dispersion::Abbe(0.1),
        attenuation_color: Vec3::new(1.0, 0.25, 0.0),
        attenuation_distance: 0.5,
        transmission: 0.75,
        diffuse_transmission: 0.5,
        diffuse_transmission_color: Vec3::new(0.5, 0.0, 1.0),
        thickness: 3.0,
        roughness: 0.25,
        sigma0: Some(Vec3::new(4.5, 0.0, 1.0)),
        medium: Some(Medium::isotropic(Vec3::new(0.74, 0.88, 1.01), Vec3::new(0.032, 0.17, 0.0))),
        solver: Some("tiled-18-128".parse().unwrap()),
        ..Material::standard()
    };
    assert_eq!(material.unwrap(), expected);
}

#[test]
fn what_a_material_leaves_out_has_gltfs_default() {
    let extensions = json!({"KHR_materials_volume": {}, "KHR_materials_dispersion": {}, "KHR_materials_ior": {},
        "KHR_materials_transmission": {}, "KHR_materials_diffuse_transmission": {}});
    let none = json!({"KHR_materials_dispersion": {"dispersion": 0}});
    // A value too small for f32 also means no dispersion.
    let tiny = json!({"KHR_materials_dispersion": {"dispersion": 1e-60}});
    for extensions in [extensions, none, tiny, json!({})] {
        for extras in [json!({}), json!([1, {"lapidary": 2}]), json!("text"), json!({"lapidary": {}}), Value::Null] {
            let material = material_of(json!({"name": "default", "extensions": extensions, "extras": extras}));
            let expected = Material { metallic: 1.0, ..Material::standard() };
            assert_eq!(material.unwrap(), expected, "{extensions} {extras}");
        }
    }
}

#[test]
fn a_scale_changes_no_coefficient() {
    let extras = json!({"lapidary": {"sigma0": [1, 2, 3], "scattering": [4, 5, 6], "absorption": [7, 8, 9]}});
    let scene = load_changed(|d| {
        d["nodes"][0]["scale"] = json!([10, 10, 10]);
        d["meshes"][0]["primitives"][0]["material"] = json!(0);
        d["materials"][0]["extras"] = extras;
    });
    let material = scene.unwrap().objects.remove(0).material;
    let medium = Medium::isotropic(Vec3::new(4.0, 5.0, 6.0), Vec3::new(7.0, 8.0, 9.0));
    assert_eq!((material.sigma0, material.medium), (Some(Vec3::new(1.0, 2.0, 3.0)), Some(medium)));
}

#[test]
fn a_measured_equation_is_named_in_the_extras() {
    for mineral in Mineral::ALL {
        let name = mineral.name();
        let index = (mineral.index() * 100.0).round() / 100.0;
        let dispersion = 20.0 / mineral.abbe_number().round();
        for extensions in [
            json!({}),
            json!({"KHR_materials_ior": {"ior": mineral.index()}}),
            // Rounded as in tables, with the values that renderers without the equation need.
            json!({"KHR_materials_ior": {"ior": index}, "KHR_materials_dispersion": {"dispersion": dispersion}}),
        ] {
            let material = material_of(json!({
                "extensions": extensions,
                "extras": {"before": {"lapidary": 1}, "lapidary": {"sellmeier": name}},
            }));
            let material = material.unwrap();
            assert_eq!((material.ior, material.dispersion), (mineral.index(), Dispersion::Sellmeier(mineral)));
        }
    }
}

#[test]
fn a_material_with_large_extras_is_read_once() {
    // A megabyte of extras used by a thousand primitives: a gigabyte if each read them again.
    let extras: Vec<u32> = (0..150_000).collect();
    let scene = load_changed(|d| {
        let primitive = json!({"attributes": {"POSITION": 0}, "indices": 1, "material": 0});
        d["meshes"][0]["primitives"] = vec![primitive; 1_000].into();
        d["materials"][0]["extras"] = json!({"numbers": extras, "lapidary": {"sellmeier": "quartz"}});
    });
    let scene = scene.unwrap();
    assert_eq!((scene.objects.len(), only_mesh(&scene).triangle_count()), (1, 1_000));
    assert_eq!(scene.objects[0].material.ior, Mineral::Quartz.index());
}

#[test]
fn a_file_without_scenes_shows_its_roots() {
    let scene = load_changed(|d| {
        let root = d.as_object_mut().unwrap();
        root.remove("scene");
        root.remove("scenes");
        root["nodes"] = json!([{"mesh": 0}, {"children": [0]}]);
    });
    let scene = scene.unwrap();
    assert_eq!((scene.name.as_str(), scene.objects.len()), ("scene", 1));
}

#[test]
fn a_deep_hierarchy_needs_no_stack() {
    let depth = 100_000;
    let scene = load_changed(|d| {
        let chain = (1..depth).map(|child| json!({"children": [child]}));
        d["nodes"] = chain.chain([json!({"mesh": 0})]).collect();
    });
    assert_eq!(scene.unwrap().objects.len(), 1);
}

#[test]
fn ten_thousand_roots_load_as_so_many_bodies() {
    let scene = load_changed(|d| {
        d["nodes"] = vec![json!({"mesh": 0, "name": "one of many"}); 10_000].into();
        d["scenes"][0]["nodes"] = (0..10_000).collect();
    });
    let scene = scene.unwrap();
    assert_eq!((scene.objects.len(), scene.lacking.clauses().len()), (10_000, 0));
}

#[test]
fn interleaved_and_unaligned_data_is_read() {
    let mut data = vec![7];
    for corner in binary()[..36].chunks(12) {
        data.extend(corner);
        data.extend([9; 5]);
    }
    data.extend([0, 1, 2]);
    let mut document = document();
    document["bufferViews"] = json!([
        {"buffer": 0, "byteOffset": 1, "byteLength": 46, "byteStride": 17},
        {"buffer": 0, "byteOffset": 52, "byteLength": 3},
    ]);
    document["accessors"][1]["componentType"] = json!(5121);
    document["buffers"][0]["byteLength"] = json!(data.len());
    let scene = parse(&file(&document, &data), None).unwrap();
    assert_eq!(only_mesh(&scene).positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
}
