//! Every unsupported feature of a file is listed once, by name.

use super::*;
use crate::BUILT_IN;

fn lacking(change: impl FnOnce(&mut Value)) -> Vec<String> {
    let scene = load_changed(|d| {
        d["meshes"][0]["primitives"][0]["material"] = json!(0);
        d["materials"][0]["pbrMetallicRoughness"] = json!({"metallicFactor": 0});
        change(d);
    });
    scene.unwrap().lacking.clauses()
}

/// Returns the unsupported features of a material with these members.
fn of_material(members: Value) -> Vec<String> {
    lacking(|d| {
        for (key, value) in members.as_object().unwrap() {
            d["materials"][0][key] = value.clone();
        }
    })
}

/// Returns the unsupported features of a polished dielectric material with these extensions.
fn of_extensions(extensions: Value) -> Vec<String> {
    let factors = json!({"metallicFactor": 0, "roughnessFactor": 0});
    of_material(json!({"pbrMetallicRoughness": factors, "extensions": extensions}))
}

#[test]
fn plain_files_and_built_in_scenes_lack_nothing() {
    assert_eq!(lacking(|_| ()), [""; 0]);
    for built_in in BUILT_IN {
        assert_eq!(Scene::named(built_in.name).unwrap().lacking.clauses(), [""; 0]);
        // The same holds when the scene is read back from a file.
        let again = parse(&glb::write(&Scene::named(built_in.name).unwrap()).unwrap(), None).unwrap();
        assert_eq!(again.lacking.clauses(), [""; 0], "{}", built_in.name);
    }
}

/// Textures that are not read are named by their material.
#[test]
fn textures_of_every_slot_are_named() {
    let texture = json!({"index": 0});
    let found = lacking(|d| {
        d["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(2);
        // The first two coordinates of the corners.
        let uvs = json!({"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2"});
        d["accessors"].as_array_mut().unwrap().push(uvs);
        d["bufferViews"].as_array_mut().unwrap().push(json!({"buffer": 0, "byteLength": 36, "byteStride": 12}));
        d["textures"] = json!([{"source": 0}]);
        d["images"] = json!([{"uri": super::textures::base64(&super::textures::png())}]);
        d["materials"][0] = json!({
            "name": "gem",
            "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0, "baseColorTexture": texture, "metallicRoughnessTexture": texture},
            "normalTexture": texture,
            "occlusionTexture": texture,
            "emissiveTexture": texture,
            "extensions": {
                "KHR_materials_transmission": {"transmissionFactor": 1, "transmissionTexture": texture},
                "KHR_materials_volume": {"thicknessFactor": 1, "thicknessTexture": texture},
                "KHR_materials_diffuse_transmission": {
                    "diffuseTransmissionFactor": 1,
                    "diffuseTransmissionTexture": texture,
                    "diffuseTransmissionColorTexture": texture,
                },
            },
        });
    });
    let not_read = ["diffuseTransmissionColorTexture", "emissiveTexture", "occlusionTexture"];
    let says = |slot: &str| format!("textures: `{slot}` of material `gem` (a factor is drawn alone)");
    assert_eq!(found, not_read.into_iter().map(says).collect::<Vec<_>>());
}

#[test]
fn users_are_counted_and_the_first_is_named() {
    let found = lacking(|d| {
        d["materials"] =
            ["table", "chair", "unused"].map(|name| json!({"name": name, "emissiveFactor": [1, 1, 1]})).into();
        let primitive = |material| json!({"attributes": {"POSITION": 0}, "indices": 1, "material": material});
        d["meshes"][0]["primitives"] = json!([primitive(1), primitive(0), primitive(0)]);
        d["nodes"] = json!([{"mesh": 0, "children": [1]}, {"mesh": 0}]);
    });
    assert_eq!(found, ["emission: `emissiveFactor` of 2 materials, first `table` (nothing shines by itself)"]);
}

#[test]
fn what_a_surface_lacks_is_named() {
    let one = |members: Value, says: &str| assert_eq!(of_material(members), [says]);
    assert_eq!(of_material(json!({"pbrMetallicRoughness": {"metallicFactor": 0.1}})), [""; 0]);
    let in_glass = json!({"KHR_materials_transmission": {"transmissionFactor": 1}});
    one(
        json!({"pbrMetallicRoughness": {"metallicFactor": 0.1}, "extensions": in_glass}),
        "metal: `metallicFactor` above 0 of material `gem` (drawn without metal)",
    );
    assert_eq!(of_material(json!({"alphaMode": "MASK"})), [""; 0]);
    one(
        json!({"emissiveFactor": [0, 0, 1]}),
        "emission: `emissiveFactor` of material `gem` (nothing shines by itself)",
    );
    one(
        json!({"extras": {"lapidary": {"later": [1, 2]}}}),
        "extras: `later` in `extras.lapidary` of material `gem` (not known)",
    );
    for (name, instead) in [
        ("KHR_materials_clearcoat", "the surface below is drawn alone"),
        ("KHR_materials_unlit", "lights and shadows fall on it"),
        ("KHR_materials_volume_scatter", "not known"),
        ("VENDOR_x", "not known"),
    ] {
        one(json!({"extensions": {name: {}}}), &format!("extensions: `{name}` of material `gem` ({instead})"));
    }
    assert_eq!(of_material(json!({"doubleSided": true, "alphaMode": "OPAQUE"})), [""; 0]);
    // A transmissive material is not a metal, although glTF's default is one.
    let clear = json!({"KHR_materials_transmission": {"transmissionFactor": 1}});
    assert_eq!(of_material(json!({"pbrMetallicRoughness": {"roughnessFactor": 0}, "extensions": clear})), [""; 0]);
    // The default material is one.
    let scene = load_changed(|_| ()).unwrap();
    assert!(scene.objects[0].material.is_all_metal() && scene.lacking.clauses().is_empty());
}

/// What a material lacks matters no more once all bodies of it have another; what meshes and the file lack stays.
#[test]
fn what_replaced_materials_lack_is_left_out() {
    let scene = load_changed(|d| {
        let primitive = |material: Option<u32>| match material {
            Some(material) => json!({"attributes": {"POSITION": 0}, "indices": 1, "material": material}),
            None => json!({"attributes": {"POSITION": 0}, "indices": 1, "targets": [{"POSITION": 0}]}),
        };
        // Two materials of one name.
        d["materials"] = json!([
            {"name": "gem", "emissiveFactor": [1, 1, 1]},
            {"name": "gem", "emissiveFactor": [1, 1, 1], "normalTexture": {"index": 0}},
        ]);
        d["meshes"][0]["primitives"] = json!([primitive(Some(0)), primitive(Some(1)), primitive(None)]);
        d["meshes"].as_array_mut().unwrap().push(json!({"primitives": [primitive(Some(0))]}));
        d["nodes"] = json!([{"mesh": 0}, {"mesh": 1}]);
        d["scenes"][0]["nodes"] = json!([0, 1]);
        d["extensionsUsed"] = json!(["MSFT_texture_dds"]);
    });
    let Scene { objects, lacking, .. } = scene.expect("a scene");
    assert_eq!(objects.len(), 4);
    let left = |replaced: &[usize]| {
        let mut lacking = lacking.clone();
        lacking.replace(|body| replaced.contains(&body));
        lacking.clauses()
    };
    let emission = |who: &str| format!("emission: `emissiveFactor` of {who} (nothing shines by itself)");
    let always = [
        "extensions: `MSFT_texture_dds` of the file (not known)",
        "morph targets: `targets` of mesh 0 (the body is drawn without them)",
    ];
    let texture = "textures: a missing `TEXCOORD_0` of mesh 0 (factors are drawn alone)";
    let both = "2 materials, first `gem`";
    let sorted = |clauses: &[&str]| {
        let mut clauses: Vec<String> = clauses.iter().chain(&always).map(|clause| (*clause).to_owned()).collect();
        clauses.sort();
        clauses
    };
    let found = |replaced: &[usize]| {
        let mut clauses = left(replaced);
        clauses.sort();
        clauses
    };
    assert_eq!(found(&[]), sorted(&[&emission(both), texture]));
    // One of the two bodies of the first material.
    assert_eq!(found(&[0, 1]), sorted(&[&emission("material `gem`")]));
    assert_eq!(found(&[0, 3]), sorted(&[&emission("material `gem`"), texture]));
    assert_eq!(found(&[2]), sorted(&[&emission(both), texture]));
    assert_eq!(left(&[0, 1, 2, 3]), always);
}

#[test]
fn light_that_goes_nowhere_is_named() {
    let none = |extensions: Value| assert_eq!(of_extensions(extensions.clone()), [""; 0], "{extensions}");
    let one = |extensions: Value, says: &str| {
        let found = of_extensions(extensions.clone());
        assert!(matches!(&found[..], [clause] if clause.starts_with(says)), "{extensions}: {found:?}");
    };
    let clear = |share: f32| json!({"transmissionFactor": share});
    let diffuse = |share: f32| json!({"diffuseTransmissionFactor": share});
    let solid = json!({"thicknessFactor": 1, "attenuationColor": [0.5, 0.5, 0.5], "attenuationDistance": 1});
    none(
        json!({"KHR_materials_transmission": clear(1.0), "KHR_materials_volume": solid, "KHR_materials_dispersion": {"dispersion": 1}}),
    );
    none(json!({"KHR_materials_diffuse_transmission": diffuse(1.0), "KHR_materials_volume": solid}));
    // If all light passes straight through, none is left to scatter.
    none(json!({"KHR_materials_transmission": clear(1.0), "KHR_materials_diffuse_transmission": diffuse(1.0)}));
    none(json!({"KHR_materials_transmission": clear(0.5)}));
    none(json!({"KHR_materials_diffuse_transmission": diffuse(0.5), "KHR_materials_volume": solid}));
    one(
        json!({"KHR_materials_diffuse_transmission": diffuse(0.5)}),
        "diffuse transmission: `diffuseTransmissionFactor` without a thickness of",
    );
    one(
        json!({"KHR_materials_diffuse_transmission": diffuse(1.0), "KHR_materials_volume": {"thicknessFactor": 1}}),
        "diffuse transmission: `diffuseTransmissionFactor` without an attenuation that scatters of",
    );
    one(json!({"KHR_materials_volume": solid}), "attenuation: `KHR_materials_volume` of");
    one(
        json!({"KHR_materials_transmission": clear(1.0), "KHR_materials_dispersion": {"dispersion": 1}}),
        "dispersion: `KHR_materials_dispersion` without a volume of",
    );
    let both = of_extensions(
        json!({"KHR_materials_transmission": clear(0.5), "KHR_materials_diffuse_transmission": diffuse(1.0)}),
    );
    assert!(both.len() == 1 && both[0].contains("beside a transmission"), "{both:?}");
    let rough = json!({"extensions": {"KHR_materials_transmission": clear(1.0)}});
    assert_eq!(of_material(rough), [""; 0]);
    // An explicit medium uses the light that enters.
    let medium = json!({"lapidary": {"scattering": [1, 1, 1], "absorption": [0, 0, 0]}});
    assert_eq!(of_material(json!({"extensions": {"KHR_materials_volume": solid}, "extras": medium})), [""; 0]);
}

#[test]
fn what_moves_and_what_is_no_triangle_is_named() {
    let found = lacking(|d| {
        let primitive = d["meshes"][0]["primitives"][0].clone();
        let with = |key: &str, value: Value| {
            let mut primitive = primitive.clone();
            primitive[key] = value;
            primitive
        };
        let mut colored = primitive.clone();
        colored["attributes"]["COLOR_0"] = json!(0);
        colored["attributes"]["COLOR_1"] = json!(0);
        let morphed = with("targets", json!([{"POSITION": 0}]));
        d["meshes"][0]["primitives"] = json!([colored, morphed, with("mode", json!(0)), with("mode", json!(3))]);
        d["nodes"][0]["skin"] = json!(0);
        d["skins"] = json!([{"joints": [0]}]);
        d["animations"] = json!([{"channels": [], "samplers": []}, {"channels": [], "samplers": []}]);
        d["extensionsUsed"] = json!(["MSFT_texture_dds", "KHR_texture_transform", "KHR_materials_ior"]);
    });
    assert_eq!(
        found,
        [
            "animations: 2 of the file (bodies are drawn at rest)",
            "extensions: `MSFT_texture_dds` of the file (not known)",
            "morph targets: `targets` of mesh 0 (the body is drawn without them)",
            "points and lines: a primitive of mesh 0 (triangles alone are drawn)",
            "skins: `skin` of node `stone` (the body is drawn at rest)",
            "vertex colours: `COLOR_n` after the first of mesh 0 (the first is drawn alone)",
        ]
    );
}

#[test]
fn lights_cameras_and_instances_are_named() {
    let found = lacking(|d| {
        d["scenes"][0]["nodes"] = json!([0, 1, 2, 3, 4]);
        let light = |index: u32| json!({"KHR_lights_punctual": {"light": index}});
        d["nodes"] = json!([
            {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0, "COLOR_0": 0, "_ID": 1}}}},
            {"camera": 0, "extensions": light(0)},
            {"camera": 1, "extensions": light(1)},
            {"camera": 2, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}},
            {"camera": 1, "extensions": {"VENDOR_x": {}}},
        ]);
        d["cameras"] = json!([
            {"type": "orthographic", "name": "plan", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 9, "znear": 1}},
            {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}},
            {"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}},
        ]);
        let lights = json!([{"type": "point", "range": 3, "name": "desk"}, {"type": "directional", "range": 3}]);
        d["extensions"] = json!({"KHR_lights_punctual": {"lights": lights}});
    });
    assert_eq!(
        found,
        [
            "cameras: a view after the first of 2 cameras, first 1 (the scene is seen through the first)",
            "extensions: `VENDOR_x` of node 4 (not known)",
            "instances: `COLOR_0` of node 0 (all instances look alike)",
            "instances: `EXT_mesh_gpu_instancing` of node 3 (the node has no mesh)",
            "lights: `range` of light `desk` (light falls off by the square of the distance alone)",
        ]
    );
}

#[test]
fn a_hostile_file_gets_a_short_list() {
    let members: serde_json::Map<String, Value> = (0..1000).map(|k| (format!("x{k:03}"), Value::Null)).collect();
    let found = of_material(json!({"extras": {"lapidary": members}}));
    assert_eq!((found.len(), found[64].as_str()), (65, "and 936 more"));
    let found = of_material(json!({"extensions": {"x\n".repeat(100_000): {}}}));
    assert!(found[0].len() < 200 && !found[0].contains('\n'), "{found:?}");
}
