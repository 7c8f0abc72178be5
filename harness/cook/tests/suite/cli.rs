//! `cook` does as its help says.

use super::json;
use lapidary_cookbook as cookbook;
use lapidary_scene::{Scene, glb};
use lapidary_testing::program::{cook, folder, succeeds};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

#[test]
fn without_arguments_it_prints_help() {
    let answer = cook(folder().path(), &[] as &[&str]);
    assert!(matches!(answer.code, Some(0 | 2)), "{answer:?}");
    let help = answer.stdout + &answer.stderr;
    for command in ["check", "list", "copy", "plan", "frame", "render", "scene", "compare", "corpus", "--adapter"] {
        assert!(help.contains(command), "{command}: {help}");
    }
    let asked = succeeds(folder().path(), &["--help"]);
    assert!(asked.stdout.contains("render"));
}

/// What stays in the repository is named as such, whether the repository is there or not.
#[test]
fn a_command_of_the_repository_is_told_from_an_unknown_one() {
    let program = cook(folder().path(), &["--version"]);
    assert_eq!(program.code, Some(0), "{program:?}");
    let binary = std::env::current_exe().expect("a path").ancestors().nth(2).expect("a folder").join("cook");
    let output = std::process::Command::new(binary).args(["gallery", "--open"]).output().expect("cook runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("`gallery` is a command of the cookbook's repository"), "{said}");
}

#[test]
fn every_command_has_help_with_an_example() {
    for command in ["gallery", "test", "check", "list", "copy", "plan", "render", "scene", "snapshots", "corpus"] {
        let help = succeeds(folder().path(), &[command, "--help"]).stdout;
        assert!(help.contains("Example") && help.contains(&format!("./cook {command}")), "{help}");
    }
}

/// Checks the keys that other programs read, and that they agree with one another.
#[test]
fn plan_prints_one_json_document() {
    let answer = succeeds(folder().path(), &["plan", "vitrine", "--json"]);
    let plan: Value = serde_json::from_str(&answer.stdout).expect("one JSON document");
    let rows = |key: &str| plan[key].as_array().unwrap_or_else(|| panic!("no list {key}: {plan}")).clone();
    let text = |row: &Value, key: &str| row[key].as_str().unwrap_or_else(|| panic!("no {key}: {row}")).to_owned();
    let effects = rows("effects");
    assert!(effects.iter().all(|row| row["on"].is_boolean() && !text(row, "reason").is_empty()));
    let on = |material: &str| {
        let drawn = effects.iter().filter(|row| row["material"] == material && row["on"] == true);
        drawn.map(|row| text(row, "effect")).collect::<Vec<_>>()
    };
    assert_eq!(on("diamond"), ["convex_trace", "dispersion", "bounds_trace", "light"]);
    assert_eq!(on("ruby"), ["convex_trace", "absorption", "bounds_trace", "light"]);
    assert_eq!(on("clear glass"), ["bvh_trace", "bounds_trace", "light"]);
    for row in rows("objects") {
        // Slate and bronze have one rung and no ladder.
        let measured = !["slate", "bronze"].contains(&text(&row, "material").as_str());
        let number = |key: &str| row[key].as_f64().is_some_and(|value| value > 0.0);
        assert!(row["quality"] == "good" && number("error") == measured && number("worst_error") == measured, "{row}");
        assert!(number("times_fast") == measured && row["error_measure"].is_string() == measured, "{row}");
    }
    assert_eq!(on("slate"), ["shadow", "colored_shadow", "environment", "microfacet"]);
    let jade = ["cdrf", "half_space", "shadow", "translucent_shadow", "colored_shadow", "environment", "microfacet"];
    assert_eq!(on("jade"), jade);
    assert_eq!(on("paraffin"), ["diffusion", "shadow", "environment", "dielectric", "microfacet"]);
    let marble = ["diffusion", "extinction_per_voxel", "shadow", "environment", "dielectric", "microfacet"];
    assert_eq!(on("veined marble"), marble);
    let pipelines: BTreeSet<String> = rows("pipelines").iter().map(|row| text(row, "name")).collect();
    assert!(rows("pipelines").iter().all(|row| row["overrides"].is_object() && !text(row, "recipe").is_empty()));
    let resources: BTreeSet<String> = rows("resources").iter().map(|row| text(row, "name")).collect();
    assert!(rows("resources").iter().all(|row| row["bytes"].is_u64()));
    for pass in rows("passes") {
        assert!(pipelines.contains(&text(&pass, "pipeline")) && !text(&pass, "name").is_empty(), "{pass}");
        let bound = pass["resources"].as_array().expect("a list").clone();
        assert!(bound.iter().all(|name| name.as_str().is_some_and(|name| resources.contains(name))), "{pass}");
    }
    // The same with effects left out on request, and with a requested technique.
    let plan = |arguments: &[&str]| succeeds(folder().path(), &[&["plan"], arguments].concat()).stdout;
    assert!(plan(&["brilliant", "--without", "dispersion"]).contains("left out on request"));
    assert!(plan(&["bunny", "--with", "cdrf"]).contains("by rung drift of recipe cdrf_shading"));
    assert!(plan(&["wax", "--with", "optical_path"]).contains("asked for, whatever its thickness"));
    let shadowed = plan(&["wax", "--with", "cdrf,shadow"]);
    assert!(
        shadowed.contains("by rung drift") && shadowed.contains("reflective shadow maps for shadows"),
        "{shadowed}"
    );
    assert!(plan(&["bunny", "--rung", "lambert-shadowed"]).contains("it may stand in its own light"));
}

#[test]
fn check_prints_one_json_document() {
    let answer = succeeds(folder().path(), &["check", "refraction::reflect", "--cases", "1000", "--json"]);
    let rows = json(&answer.stdout);
    assert_eq!(rows.len(), 1);
    let row = &rows[0];
    for (field, value) in [("module", "refraction"), ("function", "refraction_reflect")] {
        assert_eq!(row[field], value);
    }
    assert_eq!((row["failed"].as_u64(), row["nonfinite"].as_u64()), (Some(0), Some(0)));
    // The hard cases are in addition to the random ones.
    assert!(row["cases"].as_u64().is_some_and(|cases| cases >= 1000), "{row}");
    for field in ["max_ulp", "p99_ulp", "median_ulp", "seconds"] {
        assert!(row[field].as_f64().is_some_and(|number| number >= 0.0), "{field}: {row}");
    }
    assert!(
        row["max_ulp"].as_f64() >= row["p99_ulp"].as_f64() && row["p99_ulp"].as_f64() >= row["median_ulp"].as_f64(),
        "{row}"
    );
    assert!(row["worst_input"].as_str().is_some_and(|input| input.contains('(')), "{row}");
    assert!(
        row.as_object().is_some_and(|row| row.contains_key("shrunk_input")) && row["shrunk_input"].is_null(),
        "{row}"
    );
}

/// Returns the cookbook's refraction with a changed reflection.
fn changed_copy() -> String {
    let source = cookbook::module("refraction").expect("a module").source;
    assert_eq!(source.matches("2.0f * dot").count(), 1);
    source.replace("2.0f * dot", "1.9f * dot")
}

#[test]
fn a_changed_copy_fails_and_names_an_input() {
    let folder = folder();
    std::fs::write(folder.path().join("mine.wgsl"), changed_copy()).expect("a file");
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/lapidary/failures/refraction_reflect.txt");
    let before = std::fs::read(&kept).ok();
    let arguments = ["check", "refraction::reflect", "--wgsl", "mine.wgsl", "--cases", "1000"];
    let answer = cook(folder.path(), &arguments);
    assert_eq!(answer.code, Some(1), "{answer:?}");
    assert!(answer.stdout.contains("FAIL refraction_reflect"), "{answer:?}");
    // The user's failures are not stored as the cookbook's.
    assert_eq!(std::fs::read(&kept).ok(), before);
    let rows = json(&cook(folder.path(), &[arguments.as_slice(), &["--json"]].concat()).stdout);
    assert!(rows[0]["failed"].as_u64().is_some_and(|failed| failed > 100), "{rows:?}");
    assert!(rows[0]["shrunk_input"].is_string() && rows[0]["reason"].is_string(), "{rows:?}");
}

#[test]
fn an_unchanged_copy_passes() {
    let folder = folder();
    let source = cookbook::module("refraction").expect("a module").source;
    std::fs::write(folder.path().join("mine.wgsl"), source).expect("a file");
    succeeds(folder.path(), &["check", "refraction::reflect", "--wgsl", "mine.wgsl", "--cases", "1000"]);
}

#[test]
fn the_seed_decides_the_inputs() {
    let worst = |seed: &str| {
        let answer =
            succeeds(folder().path(), &["check", "refraction::reflect", "--cases", "1000", "--json", "--seed", seed]);
        json(&answer.stdout)[0]["worst_input"].clone()
    };
    assert_eq!(worst("1"), worst("1"));
    assert_ne!(worst("1"), worst("2"));
}

#[test]
fn list_holds_every_function() {
    let rows = json(&succeeds(folder().path(), &["list", "--json"]).stdout);
    let text = |row: &Value, field: &str| row[field].as_str().unwrap_or_else(|| panic!("{field}: {row}")).to_owned();
    let listed: BTreeSet<(String, String)> =
        rows.iter().map(|row| (text(row, "module"), text(row, "function"))).collect();
    let wanted: BTreeSet<(String, String)> = cookbook::modules()
        .iter()
        .flat_map(|module| module.functions.iter().map(|function| (module.name.to_owned(), function.name.clone())))
        .collect();
    assert_eq!(listed, wanted);
    let refract = rows.iter().find(|row| row["function"] == "refraction_refract").expect("it is listed");
    let signature = "fn refraction_refract(incident: vec3f, normal: vec3f, relative_index: f32) -> RefractionHit";
    assert_eq!(text(refract, "signature"), signature);
    assert!(text(refract, "accuracy").starts_with("lavapipe direction "), "{refract}");
    let table = succeeds(folder().path(), &["list"]).stdout;
    assert!(table.contains(signature));
}

/// What `list` names is what the options take.
#[test]
fn listed_names_are_those_that_the_options_take() {
    let folder = folder();
    let names = |what: &str, key: &str| -> Vec<String> {
        let rows: Vec<serde_json::Value> =
            serde_json::from_str(&succeeds(folder.path(), &["list", what, "--json"]).stdout).expect("JSON");
        rows.iter().map(|row| row[key].as_str().expect("a name").to_owned()).collect()
    };
    let scenes = names("--scenes", "name");
    assert!(scenes.len() > 30 && scenes.iter().all(|name| lapidary_scene::Scene::named(name).is_ok()), "{scenes:?}");
    let rungs = names("--rungs", "rung");
    assert!(rungs.len() > 50 && rungs.iter().all(|name| name.parse::<lapidary_plan::Rung>().is_ok()), "{rungs:?}");
    let materials = names("--materials", "name");
    let asked = "diamond, ruby, sapphire, emerald, quartz, moissanite, zirconia, gold, yellow_gold, rose_gold, white_gold, \
                 silver, platinum, copper, steel, jade, marble, wax, skin";
    assert_eq!(materials.join(", "), asked);
    for name in materials {
        let plan = succeeds(folder.path(), &["plan", "octahedron", "--material", &name, "--json"]).stdout;
        let plan: serde_json::Value = serde_json::from_str(&plan).expect("JSON");
        assert_eq!(plan["objects"][0]["material"], *name);
    }
    // The table for people holds the same.
    let text = succeeds(folder.path(), &["list", "--rungs"]).stdout;
    assert!(text.lines().any(|line| line.contains("walk-8+tracker") && line.ends_with("good")), "{text}");
}

/// A node's own material and rung count for it alone.
#[test]
fn a_node_may_have_a_material_and_a_rung_of_its_own() {
    let folder = folder();
    let objects = |options: &[&str]| -> Vec<(String, String, String)> {
        let arguments = [&["plan", "tray", "--json"], options].concat();
        let plan: serde_json::Value = serde_json::from_str(&succeeds(folder.path(), &arguments).stdout).expect("JSON");
        let text = |row: &serde_json::Value, key: &str| row[key].as_str().expect("a name").to_owned();
        let rows = plan["objects"].as_array().expect("a list");
        rows.iter().map(|row| (text(row, "object"), text(row, "material"), text(row, "rung"))).collect()
    };
    let usual = objects(&[]);
    let changed = objects(&[
        "--material",
        "ball=jade",
        "--material",
        "diamond=ruby",
        "--rung",
        "diamond=convex-3",
        "--rung",
        "ball=godunov-32",
    ]);
    for (before, after) in usual.iter().zip(&changed) {
        let expected = match before.0.as_str() {
            "ball" => ("ball", "jade", "godunov-32"),
            "diamond" => ("diamond", "ruby", "convex-3"),
            _ => (before.0.as_str(), before.1.as_str(), before.2.as_str()),
        };
        assert_eq!((after.0.as_str(), after.1.as_str(), after.2.as_str()), expected);
    }
    // The one for all gives way to a node's own.
    let all = objects(&["--material", "diamond=quartz", "--material", "emerald"]);
    assert!(all.iter().all(|(object, material, _)| material == if object == "diamond" { "quartz" } else { "emerald" }));
}

#[test]
fn shells_complete_commands_and_options() {
    let folder = folder();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = succeeds(folder.path(), &["completions", shell]).stdout;
        assert!(script.contains("compare") && script.contains("material"), "{shell}: {script}");
    }
}

/// Both commands give the same notes, in the plan's JSON too.
#[test]
fn render_and_plan_say_the_same_of_a_scene() {
    let folder = folder();
    let mut scene = Scene::named("octahedron").expect("built in");
    // Two neighbours: an opening that is not flat, so that it is not mended.
    scene.objects[0].mesh.indices.truncate(18);
    std::fs::write(folder.path().join("open.glb"), glb::write(&scene).expect("written")).expect("a file");
    let asked = ["open.glb", "--size", "8x8", "--rung", "bvh-2"];
    let rendered = cook(folder.path(), &[&["render"], &asked[..]].concat());
    assert_eq!(rendered.code, Some(0), "{rendered:?}");
    let note = "object `octahedron`: rung `bvh-2` takes a mesh for the surface of a solid, but 4 edges are open; mend the mesh, or light inside \
                goes astray";
    assert_eq!(rendered.stderr, format!("cook: {note}\n"));
    let plan = succeeds(folder.path(), &[&["plan"], &asked[..]].concat()).stdout;
    assert!(
        plan.contains(&format!("\nnotes\n  {note}\n")) || plan.ends_with(&format!("\nnotes\n  {note}\n")),
        "{plan}"
    );
    let plan = succeeds(folder.path(), &[&["plan", "--json"], &asked[..]].concat()).stdout;
    let plan: Value = serde_json::from_str(&plan).expect("one JSON document");
    assert_eq!(plan["notes"], serde_json::json!([note]));
}
