//! Each kind of bad file is refused with one line that describes the problem.

use super::*;

pub(super) fn message(change: impl FnOnce(&mut Value)) -> String {
    one_line(load_changed(change))
}

/// Returns the message of a refusal, which must be one line.
pub(super) fn one_line(refused: Result<Scene, SceneError>) -> String {
    let message = refused.unwrap_err().to_string();
    assert!(!message.contains('\n') && message.len() < 400, "{message}");
    message
}

/// Asserts that the file with `value` at the JSON pointer `place` is refused with the message
/// `says`.
pub(super) fn refused(place: &str, value: Value, says: &str) {
    let message = message(|document| {
        let (parent, key) = place.rsplit_once('/').unwrap();
        match document.pointer_mut(parent).unwrap() {
            Value::Array(list) => list[key.parse::<usize>().unwrap()] = value,
            parent => parent[key] = value,
        }
    });
    assert!(message.contains(says), "{place}: {message}");
}

#[test]
fn files_that_are_not_there_or_not_gltf() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("stone.glb");
    let says = |says: &str| {
        let message = load(&path).unwrap_err().to_string();
        let start = format!("{}: ", path.display());
        assert!(message.starts_with(&start) && message.contains(says), "{message}");
    };
    says("cannot be read");
    for text in ["", "solid stone", "\u{7f}ELF", "[]"] {
        std::fs::write(&path, text).unwrap();
        says("not glTF");
    }
    std::fs::write(&path, "{}").unwrap();
    says("its JSON is not valid glTF");
    std::fs::create_dir(folder.path().join("folder.glb")).unwrap();
    let message = load(&folder.path().join("folder.glb")).unwrap_err().to_string();
    assert!(message.contains("it is a folder"), "{message}");
}

#[test]
fn every_truncation_is_an_error() {
    let whole = file(&document(), &binary());
    for end in 0..whole.len() {
        assert!(parse(&whole[..end], None).is_err(), "cut at {end}");
    }
}

#[test]
fn hostile_container_lengths() {
    for place in [8, 12] {
        for length in [0, 1, 11, 12, 19, 0x7fff_ffff, u32::MAX] {
            let mut bytes = file(&document(), &binary());
            bytes[place..place + 4].copy_from_slice(&length.to_le_bytes());
            let message = parse(&bytes, None).unwrap_err().to_string();
            assert!(message.contains("damaged") || message.contains("JSON"), "{message}");
        }
    }
    let mut bytes = file(&document(), &binary());
    bytes[4] = 1;
    assert!(parse(&bytes, None).unwrap_err().to_string().contains("version 1"));
}

#[test]
fn versions_and_extensions() {
    refused("/asset/version", json!("1.0"), "version 1.0");
    refused("/asset/minVersion", json!("3.0"), "version 3.0");
    refused("/asset/minVersion", json!("2.1"), "version 2.1");
    let unknown = json!(["KHR_materials_ior", "KHR_texture_transform", "VENDOR_y", "EXT_x"]);
    refused("/extensionsRequired", unknown, "supported: VENDOR_y, EXT_x;");
}

/// glTF 1.0 has objects in place of the lists of 2.0; the message states the version, not the place
/// where the JSON differs.
#[test]
fn the_first_version_is_named_also_as_text() {
    let first = |asset: Value| {
        json!({"asset": asset, "scene": "s", "scenes": {"s": {"nodes": ["n"]}}, "nodes": {"n": {"meshes": ["m"]}},
            "meshes": {"m": {"primitives": []}}, "buffers": {"b": {"uri": "b.bin", "byteLength": 3}}})
    };
    for asset in [json!({"version": "1.0"}), json!({"version": "1.1"}), json!({"version": 1.0}), json!({}), Value::Null]
    {
        let message = parse(first(asset).to_string().as_bytes(), None).unwrap_err().to_string();
        assert!(message.starts_with("it is of glTF version 1.") && message.contains("convert it"), "{message}");
    }
    refused("/asset", json!({}), "its JSON is not valid glTF");
}

/// A required extension is no reason to refuse a file if nothing that is drawn needs it.
#[test]
fn what_nothing_drawn_needs_stops_nothing() {
    let loads = |change: &dyn Fn(&mut Value)| load_changed(change).unwrap_or_else(|error| panic!("{error}"));
    for name in ["MSFT_texture_dds", "KHR_animation_pointer"] {
        let scene = loads(&|d| {
            d["extensionsRequired"] = json!([name]);
            d["extensionsUsed"] = json!([name]);
        });
        let says = format!("extensions: `{name}` of the file (not known)");
        assert!(scene.lacking.clauses().contains(&says), "{:?}", scene.lacking.clauses());
    }
    // As exporters write them, and with members that this program's parser refuses.
    let scene = loads(&|d| {
        d["extensionsRequired"] = json!(["EXT_texture_webp"]);
        d["textures"] = json!([{"sampler": 0, "extensions": {"EXT_texture_webp": {"source": 0}}}]);
        d["images"] = json!([{"bufferView": "x", "mimeType": "image/webp"}]);
        d["skins"] = json!([{"joints": "none"}]);
        d["animations"] = json!([{"channels": [{"target": {"path": 7}}], "samplers": 3}, {}]);
    });
    assert!(
        scene.lacking.clauses().contains(&"animations: 2 of the file (bodies are drawn at rest)".to_owned()),
        "{:?}",
        scene.lacking.clauses()
    );
}

#[test]
fn scenes_without_nodes_show_nothing_and_others_are_drawn() {
    refused("/scenes/0", json!({"name": "empty"}), "shows no triangles");
    let scene = load_changed(|d| d["scenes"] = json!([{"nodes": [0]}, {"name": "empty"}])).unwrap();
    assert_eq!(scene.objects.len(), 1);
    let message = message(|d| d["scene"] = json!("first"));
    assert!(message.contains("its JSON is not valid glTF: invalid type") && message.contains("line 1"), "{message}");
}

#[test]
fn a_byte_order_mark_is_passed_over() {
    use base64::Engine;
    let text = base64::engine::general_purpose::STANDARD.encode(binary());
    let mut document = document();
    document["buffers"][0]["uri"] = json!(format!("data:;base64,{text}"));
    let marked = [&b"\xef\xbb\xbf"[..], document.to_string().as_bytes()].concat();
    assert_eq!(parse(&marked, None).unwrap().triangle_count(), 1);
    assert!(parse(b"\xef\xbb\xbfsolid", None).unwrap_err().to_string().contains("not glTF"));
}

#[test]
fn references_to_what_is_not_there() {
    refused("/scene", json!(7), "the file refers to scene 7, but the file has 1");
    refused("/scenes/0/nodes/0", json!(7), "scene 0 refers to node 7");
    refused("/nodes/0/children", json!([7]), "node 0 refers to node 7");
    refused("/nodes/0/mesh", json!(7), "node 0 \"stone\" refers to mesh 7");
    refused("/nodes/0/camera", json!(7), "node 0 \"stone\" refers to camera 7");
    let primitive = "/meshes/0/primitives/0";
    refused(&format!("{primitive}/material"), json!(7), "primitive 0 refers to material 7");
    refused(&format!("{primitive}/indices"), json!(7), "primitive 0 refers to accessor 7");
    refused("/accessors/0/bufferView", json!(7), "accessor 0 refers to bufferView 7");
    refused("/bufferViews/0/buffer", json!(7), "bufferView 0 refers to buffer 7");
    refused("/nodes/0/mesh", json!(-1), "its JSON is not valid glTF");
}

#[test]
fn nothing_to_show() {
    refused("/nodes/0/mesh", Value::Null, "shows no triangles");
    refused("/scenes/0/nodes", json!([]), "shows no triangles");
    refused("/meshes/0/primitives/0/mode", json!(1), "shows no triangles");
    refused("/meshes/0/primitives/0/mode", json!(99), "shows no triangles");
}

#[test]
fn nodes_that_are_no_tree() {
    refused("/nodes/0/children", json!([0]), "node 0 \"stone\": it is reached twice");
    refused("/nodes", json!([{"children": [1]}, {"children": [0]}]), "node 0: it is reached twice");
    refused("/nodes", json!([{"children": [1, 1]}, {"mesh": 0}]), "node 1: it is reached twice");
}

#[test]
fn materials_and_cameras_out_of_range() {
    for part in [-0.1, 1.5, 1e39] {
        let message = message(|d| {
            d["meshes"][0]["primitives"][0]["material"] = json!(0);
            d["materials"][0]["pbrMetallicRoughness"] = json!({"baseColorFactor": [part, 0, 0, 1]});
        });
        assert!(message.contains("each part must lie from 0 to 1"), "{message}");
    }
    for (fov, scale, says) in [(0.0, 1, "yfov is 0"), (4.0, 1, "yfov is 4"), (0.5, 0, "no direction")] {
        let message = message(|d| {
            d["scenes"][0]["nodes"] = json!([0, 1]);
            d["nodes"] = json!([{"mesh": 0}, {"camera": 0, "scale": [scale, scale, scale]}]);
            d["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": fov, "znear": 1}}]);
        });
        assert!(message.contains(says), "{message}");
    }
}

/// Asserts that a material with this `extensions` or `extras` is refused with the message `says`.
fn material_refused(key: &str, value: Value, says: &str) {
    let message = message(|d| {
        d["meshes"][0]["primitives"][0]["material"] = json!(0);
        d["materials"][0][key] = value.clone();
    });
    assert!(message.starts_with("material 0 \"gem\": its "), "{value}: {message}");
    assert!(message.contains(says) && message.len() < 300, "{value}: {message}");
}

#[test]
fn volumes_and_dispersions_out_of_range() {
    let volume = |key: &str, value: Value, says: &str| {
        material_refused("extensions", json!({"KHR_materials_volume": {key: value}}), says);
    };
    for (distance, says) in [
        (json!(0), "its attenuationDistance is 0.0, but must be above 0"),
        (json!(-1.5), "is -1.5, but must be above 0"),
        (json!(1e39), "finite in single precision"),
        (json!(1e-40), "is 1e-40, but must be above 0"),
        (json!("2"), "its attenuationDistance is a string, but must be a number"),
        (json!([1]), "its attenuationDistance is an array of something else, but must be a number"),
    ] {
        volume("attenuationDistance", distance, says);
    }
    for (color, says) in [
        (json!([0.5, 0.5, 1.5]), "its attenuationColor is [0.5, 0.5, 1.5], but each part must lie from 0 to 1"),
        (json!([0.5, -1e-9, 0.5]), "each part must lie from 0 to 1"),
        (json!([0.5, 0.5]), "its attenuationColor is an array of something else, but must be three numbers"),
        (json!([0.5, 0.5, 0.5, 1.0]), "but must be three numbers"),
        (json!([0.5, "0.5", 0.5]), "but must be three numbers"),
        (json!(1), "its attenuationColor is a number, but must be three numbers"),
    ] {
        volume("attenuationColor", color, says);
    }
    let dispersion = |value: Value, says: &str| {
        material_refused("extensions", json!({"KHR_materials_dispersion": {"dispersion": value}}), says);
    };
    dispersion(json!(-0.1), "its dispersion is -0.1, but must be at least 0 and finite: 20/V_d");
    dispersion(json!(1e39), "at least 0 and finite");
    dispersion(json!([0.1]), "its dispersion is an array of something else, but must be a number");
    for name in ["KHR_materials_volume", "KHR_materials_dispersion"] {
        material_refused("extensions", json!({name: [1]}), &format!("its {name} is an array of something else"));
        material_refused("extensions", json!({name: true}), "is true or false, but must be an object");
    }
}

#[test]
fn names_that_are_not_known_and_equations_that_do_not_agree() {
    let sellmeier = |value: Value, says: &str| {
        material_refused("extras", json!({"lapidary": {"sellmeier": value}}), says);
    };
    sellmeier(json!("diamant"), "its extras.lapidary.sellmeier is \"diamant\", but must be one of \"diamond\", ");
    sellmeier(json!("x\n".repeat(100_000)), "but must be one of");
    sellmeier(json!(2.4), "sellmeier is 2.4, but must be one of");
    sellmeier(json!(["diamond"]), "but must be one of");
    sellmeier(Value::Null, "sellmeier is null, but must be one of");
    let environment = |value: Value, says: &str| {
        refused("/scenes/0/extras", json!({"lapidary": {"environment": value}}), says);
    };
    environment(json!("tent"), "its extras.lapidary.environment is \"tent\", but must be studio or jeweller");
    environment(Value::Null, "environment is null, but must be studio or jeweller");
    material_refused(
        "extras",
        json!({"lapidary": "diamond"}),
        "its extras.lapidary is \"diamond\", but must be an object",
    );
    let message = message(|d| {
        d["meshes"][0]["primitives"][0]["material"] = json!(0);
        d["materials"][0] = json!({
            "extensions": {"KHR_materials_ior": {"ior": 1.77}},
            "extras": {"lapidary": {"sellmeier": "diamond"}},
        });
    });
    let says = "material 0: its ior is 1.77, but the Sellmeier equation of diamond in its extras gives 2.41749; ";
    assert!(message.starts_with(says), "{message}");
}

#[test]
fn media_and_widths_that_are_no_lengths() {
    let good = json!([0.1, 0, 2]);
    for name in ["sigma0", "scattering", "absorption"] {
        for bad in [
            json!([0.1, -1e-9, 0.1]),
            json!([0.1, "NaN", 0.1]),
            json!([0.1, null, 0.1]),
            json!([0.1, 1e39, 0.1]),
            json!([0.1, 0.1]),
            json!([0.1, 0.1, 0.1, 0.1]),
            json!(0.1),
            json!("x\n".repeat(100_000)),
            Value::Null,
        ] {
            let mut members = json!({"scattering": good, "absorption": good, "sigma0": good});
            members[name] = bad;
            let says = "but must be three numbers of at least 0, finite in single precision";
            material_refused("extras", json!({"lapidary": members}), says);
            material_refused("extras", json!({"lapidary": members}), &format!("its extras.lapidary.{name} is "));
        }
    }
    let media = |name: &str, value: Value| {
        let mut members = json!({"scattering": good, "absorption": good});
        members[name] = value;
        json!({"lapidary": members})
    };
    for bad in [json!(1), json!(-1.5), json!("x"), json!([0.5]), Value::Null] {
        material_refused("extras", media("anisotropy", bad), "its extras.lapidary.anisotropy is ");
    }
    let veins = json!({"frequency": 0.2, "width": 0.1, "least": 0.5, "greatest": 2, "octaves": 3, "seed": 1});
    for (name, bad) in [
        ("frequency", json!(0)),
        ("width", json!(0)),
        ("least", json!(-1)),
        ("greatest", json!(1e9)),
        ("octaves", json!(9)),
        ("octaves", json!(1.5)),
        ("seed", json!(-1)),
        ("seed", Value::Null),
        ("colour", json!(1)),
    ] {
        let mut veins = veins.clone();
        veins[name] = bad;
        material_refused("extras", media("veins", veins), "its extras.lapidary.veins is ");
    }
    material_refused("extras", media("veins", json!(3)), "its extras.lapidary.veins is 3");
    let says = "its extras.lapidary has anisotropy or veins but neither scattering nor absorption; give both";
    material_refused("extras", json!({"lapidary": {"veins": veins}}), says);
    let says = "its extras.lapidary has scattering but no absorption; give both or neither";
    material_refused("extras", json!({"lapidary": {"scattering": good}}), says);
    let says = "its extras.lapidary has absorption but no scattering; give both or neither";
    material_refused("extras", json!({"lapidary": {"absorption": good, "sigma0": good}}), says);
}

#[test]
fn factors_out_of_range() {
    for factor in [-0.1, 1.5, 1e39] {
        for name in ["roughnessFactor", "metallicFactor"] {
            material_refused("pbrMetallicRoughness", json!({name: factor}), &format!("its {name} is "));
        }
        for (extension, name) in [
            ("KHR_materials_transmission", "transmissionFactor"),
            ("KHR_materials_diffuse_transmission", "diffuseTransmissionFactor"),
        ] {
            let says = format!("its {name} is {factor:?}, but must lie from 0 to 1");
            material_refused("extensions", json!({extension: {name: factor}}), &says);
            let says = format!("its {name} is null, but must be a number");
            material_refused("extensions", json!({extension: {name: null}}), &says);
        }
    }
    let diffuse = json!({"KHR_materials_diffuse_transmission": {"diffuseTransmissionColorFactor": [0, 2, 0]}});
    material_refused("extensions", diffuse, "diffuseTransmissionColorFactor is [0.0, 2.0, 0.0], but each part");
    for (thickness, says) in [
        (json!(-1), "its thicknessFactor is -1.0, but must be at least 0"),
        (json!(1e39), "finite in single precision"),
        (json!(null), "its thicknessFactor is null, but must be a number"),
    ] {
        material_refused("extensions", json!({"KHR_materials_volume": {"thicknessFactor": thickness}}), says);
    }
    material_refused(
        "extensions",
        json!({"KHR_materials_ior": {"ior": null}}),
        "its ior is null, but must be a number",
    );
    material_refused("alphaMode", json!("HALF"), "its alphaMode is not one of glTF's");
}

#[test]
fn numbers_beyond_all_range() {
    // JSON has no number larger than the f64 range.
    let text = document().to_string().replace("\"name\":\"gem\"", "\"extras\":{},\"emissiveFactor\":[1e999,0,0]");
    let message = parse(text.as_bytes(), None).unwrap_err().to_string();
    assert!(message.contains("its JSON is not valid glTF: number out of range at line 1"), "{message}");
}

#[test]
fn members_that_contradict_one_another() {
    for other in ["KHR_materials_unlit", "KHR_materials_pbrSpecularGlossiness"] {
        for physical in ["KHR_materials_ior", "KHR_materials_volume", "KHR_materials_clearcoat"] {
            let says = format!("its {other} excludes its {physical}, by glTF's rules; remove one");
            material_refused("extensions", json!({other: {}, physical: {}}), &says);
        }
    }
    for dispersion in [0.0, 0.1, 0.4] {
        let message = message(|d| {
            d["meshes"][0]["primitives"][0]["material"] = json!(0);
            d["materials"][0] = json!({
                "extensions": {"KHR_materials_dispersion": {"dispersion": dispersion}},
                "extras": {"lapidary": {"sellmeier": "corundum"}},
            });
        });
        let says = format!(
            "material 0: its dispersion is {dispersion:?}, but the Sellmeier equation of corundum in its extras gives 0.277"
        );
        assert!(message.starts_with(&says), "{message}");
    }
}

#[test]
fn second_lobes_out_of_range() {
    for bad in [
        json!({"roughness": 0, "weight": 0.5}),
        json!({"roughness": 1.01, "weight": 0.5}),
        json!({"roughness": 0.3, "weight": 0}),
        json!({"roughness": 0.3, "weight": 1}),
        json!({"roughness": 0.3}),
        json!({"weight": 0.3}),
        json!({"roughness": 0.3, "weight": 0.3, "rough": 1}),
        json!({"roughness": "0.3", "weight": 0.3}),
        json!([0.3, 0.3]),
        json!(0.3),
        Value::Null,
    ] {
        let says = "but must be an object with a roughness above 0 and at most 1, and a weight above 0 and below 1";
        material_refused("extras", json!({"lapidary": {"secondLobe": bad}}), says);
    }
}

#[test]
fn solvers_that_draw_no_scattering() {
    let with = |solver: Value| json!({"lapidary": {"sigma0": [1, 1, 1], "solver": solver}});
    let names = ["convex-8", "reference", "surface", "proxy-1+tracker", "godunov-65", "Accurate", ""];
    let others = [json!(1), json!(null), json!(["accurate"]), json!("x\n".repeat(100_000))];
    for bad in names.map(Value::from).into_iter().chain(others) {
        material_refused("extras", with(bad.clone()), "its extras.lapidary.solver is ");
        material_refused("extras", with(bad), "such as lambert, accurate, blur or godunov-64; ");
    }
    let says = "its extras.lapidary has a solver, but nothing there scatters light";
    material_refused("extras", json!({"lapidary": {"solver": "accurate"}}), says);
    let clear = json!({"lapidary": {"solver": "godunov-64", "sellmeier": "quartz"}});
    material_refused("extras", clear, says);
}

#[test]
fn long_names_are_not_copied_whole() {
    let name = "x\n".repeat(100_000);
    let scene = load_changed(|d| d["nodes"][0]["name"] = json!(name)).unwrap();
    assert!(scene.objects[0].name.len() < 100);
    let message = message(|d| {
        d["nodes"][0]["name"] = json!(name);
        d["nodes"][0]["mesh"] = json!(7);
    });
    assert!(message.len() < 300, "{message}");
}
