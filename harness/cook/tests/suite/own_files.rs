//! A person's own files, as a jeweller has them.

use super::json;
use lapidary_scene::{Material, Object, Scene, glb};
use lapidary_testing::program::{cook, folder, succeeds};
use serde_json::Value;
use std::path::Path;

/// Two stones of white plastic in one mesh: `plan` says what they look like, `--jewellery` makes them copies of a diamond, and
/// the node's rung is for what it became.
#[test]
fn jewellery_makes_white_plastic_stones() {
    let folder = folder();
    let mut scene = Scene::named("brilliant").expect("built in");
    let mut mesh = scene.objects[0].mesh.clone();
    let mut other = mesh.clone();
    other.positions.iter_mut().for_each(|position| position.x += 3.0);
    mesh.append(&other);
    let white = Material { name: "Material.001".to_owned(), ..Material::standard() };
    scene.objects = vec![Object::new("node", mesh, white)];
    std::fs::write(folder.path().join("plastic.glb"), glb::write(&scene).expect("glTF")).expect("written");
    let plan = |more: &[&str]| -> Value {
        let answer = succeeds(folder.path(), &[&["plan", "plastic.glb", "--json"], more].concat());
        serde_json::from_str(&answer.stdout).expect("JSON")
    };
    let usual = plan(&[]);
    let said = |plan: &Value, what: &str| plan["notes"].to_string().contains(what);
    assert_eq!(usual["objects"][0]["material"], "Material.001");
    assert!(
        said(&usual, "looks like a stone, diamond") && said(&usual, "--material 'Material.001=diamond'"),
        "{usual}"
    );
    let asked = plan(&["--jewellery", "--rung", "node=walk-3"]);
    assert_eq!((&asked["objects"][0]["material"], &asked["objects"][0]["rung"]), (&"diamond".into(), &"walk-3".into()));
    assert!(said(&asked, "2 closed parts in one mesh, drawn as 1 body"), "{asked}");
    let instances = asked["effects"].as_array().expect("a list").iter().find(|row| row["effect"] == "instances");
    assert_eq!(instances.expect("a row")["reason"], "2 copies of one shape");
    // What is named keeps its material.
    assert_eq!(plan(&["--jewellery", "--material", "node=ruby"])["objects"][0]["material"], "ruby");
}

/// Writes `gem.glb`: a ruby that asks for an index of 0 and for emission.
fn write_lacking_gem(folder: &Path) {
    let written = glb::write(&Scene::named("ruby").expect("built in")).expect("glTF");
    let length = u32::from_le_bytes([12, 13, 14, 15].map(|place| written[place])) as usize;
    let mut document: Value = serde_json::from_slice(&written[20..20 + length]).expect("JSON");
    document["materials"][0]["extensions"]["KHR_materials_ior"] = serde_json::json!({"ior": 0});
    document["materials"][0]["extras"]["lapidary"].as_object_mut().expect("extras").remove("sellmeier");
    document["materials"][0]["emissiveFactor"] = serde_json::json!([1, 1, 1]);
    let file = glb::container(document.to_string().as_bytes(), &written[28 + length..]).expect("glTF");
    std::fs::write(folder.join("gem.glb"), file).expect("written");
}

/// Of a turn, what the file lacks and each note are told with the first picture.
#[test]
fn what_a_turn_lacks_is_told_once() {
    let folder = folder();
    write_lacking_gem(folder.path());
    let usual = ["render", "gem.glb", "--size", "16", "--samples", "1", "--turntable", "3", "--out", "gem.png"];
    let answer = cook(folder.path(), &[&usual[..], &["--rung", "proxy-2", "--exposure", "50"]].concat());
    assert_eq!(answer.code, Some(0), "{}", answer.stderr);
    let mut lines: Vec<&str> = answer.stderr.lines().collect();
    let told = lines.len();
    assert!(answer.stderr.contains("emissiveFactor") && told >= 3, "{}", answer.stderr);
    lines.sort_unstable();
    lines.dedup();
    assert_eq!(lines.len(), told, "{}", answer.stderr);
}

/// `ior` 0 of a clear body is said, unless a preset takes the place of its material, as is what else that lacks.
#[test]
fn what_a_preset_replaces_is_not_told() {
    let folder = folder();
    write_lacking_gem(folder.path());
    let lacking = |more: &[&str]| -> Value {
        let answer = succeeds(folder.path(), &[&["plan", "gem.glb", "--json"], more].concat());
        serde_json::from_str::<Value>(&answer.stdout).expect("JSON")["lacking"].clone()
    };
    let usual = lacking(&[]).to_string();
    assert!(usual.contains("`ior` 0.0 of material") && usual.contains("emissiveFactor"), "{usual}");
    assert_eq!(lacking(&["--material", "sapphire"]), serde_json::json!([]));
}

/// A row for each file, the others after one that cannot be read; the table as JSON and the pictures in a folder.
#[test]
fn a_corpus_has_a_row_for_each_file() {
    let folder = folder();
    let inside = folder.path().join("rings/more");
    std::fs::create_dir_all(&inside).expect("made");
    let write = |scene: &str, file: &str| {
        let written = glb::write(&Scene::named(scene).expect("built in")).expect("glTF");
        std::fs::write(folder.path().join("rings").join(file), written).expect("written");
    };
    write("brilliant", "stone.glb");
    write("jade", "more/ball.glb");
    let all = ["corpus", "rings", "--out", "pictures", "--size", "32x32"];
    let answer = succeeds(folder.path(), &all);
    let lines: Vec<&str> = answer.stdout.lines().collect();
    let [head, ball, stone] = lines[..] else { panic!("{answer:?}") };
    assert!(head.split_whitespace().eq(["file", "stones", "walked", "convex", "lacking", "seconds"]), "{head}");
    assert!(ball.starts_with("more/ball.glb") && ball.ends_with("more/ball.glb.png"), "{ball}");
    assert_eq!(stone.split_whitespace().take(5).collect::<Vec<_>>(), ["stone.glb", "1", "1", "1.00", "0"], "{stone}");
    for picture in ["stone.glb.png", "more/ball.glb.png"] {
        assert!(folder.path().join("pictures").join(picture).is_file(), "{picture}");
    }
    std::fs::write(inside.join("bad.gltf"), "{").expect("written");
    let answer = cook(folder.path(), &all);
    assert_eq!(answer.code, Some(1), "{answer:?}");
    assert!(answer.stderr.contains("1 of 3 files could not be read or drawn"), "{answer:?}");
    let table = std::fs::read_to_string(folder.path().join("pictures/corpus.json")).expect("a table");
    let rows = json(&table);
    let errors: Vec<bool> = rows.iter().map(|row| row["error"].is_string()).collect();
    assert_eq!(errors, [true, false, false], "{table}");
    assert_eq!((&rows[2]["found"]["walked"], &rows[2]["picture"]), (&1.into(), &"stone.glb.png".into()), "{table}");
}
