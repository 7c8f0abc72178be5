//! `cook` does as its help says.

use lapidary_assay::dispatch;
use lapidary_cookbook as cookbook;
use lapidary_scene::{Material, Object, Scene, glb, gltf};
use lapidary_testing::program::{cook, folder, succeeds};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

fn json(text: &str) -> Vec<Value> {
    match serde_json::from_str(text) {
        Ok(Value::Array(rows)) => rows,
        other => panic!("no JSON array: {other:?}\n{text}"),
    }
}

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

#[test]
fn copied_modules_compile_as_one_file() {
    let folder = folder();
    succeeds(folder.path(), &["copy", "refraction", "fresnel", "--out", "optics.wgsl"]);
    let text = std::fs::read_to_string(folder.path().join("optics.wgsl")).expect("the output");
    dispatch::parse(&text, "optics.wgsl").unwrap_or_else(|error| panic!("{error}"));
    assert!(text.contains("fn refraction_refract(") && text.contains("fn fresnel_dielectric("));
    // Without --out, the same text goes to stdout.
    assert_eq!(succeeds(folder.path(), &["copy", "refraction", "fresnel"]).stdout, text);
}

#[test]
fn a_copied_recipe_holds_its_modules() {
    for recipe in lapidary_wgsl::RECIPES {
        let text = succeeds(folder().path(), &["copy", recipe.name]).stdout;
        let (ir, _) = dispatch::parse(&text, recipe.name).unwrap_or_else(|error| panic!("{error}"));
        assert!(!ir.entry_points.is_empty(), "{}", recipe.name);
    }
}

/// A function comes with what it needs, and with nothing else.
#[test]
fn a_copied_function_holds_what_it_needs() {
    let text = succeeds(folder().path(), &["copy", "refraction::refract"]).stdout;
    assert!(text.starts_with("// refraction: ") && text.contains("struct RefractionHit"), "{text}");
    assert!(text.contains("// Accuracy: ") && !text.contains("fn refraction_radicand("), "{text}");
    dispatch::parse(&text, "refract.wgsl").unwrap_or_else(|error| panic!("{error}"));
    let naive = succeeds(folder().path(), &["copy", "refraction::refract_naive"]).stdout;
    dispatch::parse(&naive, "naive.wgsl").unwrap_or_else(|error| panic!("{error}"));
    assert!(naive.contains("fn refraction_refract_naive("), "{naive}");
    // Of a recipe too.
    let entry = succeeds(folder().path(), &["copy", "gem::gem_vertex", "--effects", "proxy_geometry"]).stdout;
    let (ir, _) = dispatch::parse(&entry, "gem_vertex.wgsl").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(ir.entry_points.len(), 1);
    assert!(!entry.contains("// requires:") && !entry.contains("// screen: "), "{entry}");
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
fn shells_complete_commands_and_options() {
    let folder = folder();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = succeeds(folder.path(), &["completions", shell]).stdout;
        assert!(script.contains("compare") && script.contains("material"), "{shell}: {script}");
    }
}

/// A function that no entry point calls, or none under these settings, comes all the same, also by its short name.
#[test]
fn any_function_of_a_recipe_can_be_copied_under_any_settings() {
    let folder = folder();
    for (name, options, holds) in [
        ("gem_walk::proxy_geometry_image", &[][..], "fn proxy_geometry_image("),
        ("cdrf_shading::fresnel_schlick", &["--set", "SHADOW_FORM=2"], "fn fresnel_schlick("),
        ("gem_walk::dispersion_sellmeier", &["--set", "BOUNCES=8,DISPERSION_FORM=1"], "fn dispersion_sellmeier("),
        ("gem_walk::dispersion_sellmeier", &["--effects", "convex_trace"], "fn dispersion_sellmeier("),
        ("voxelize::words", &[], "fn voxelize_words("),
    ] {
        let text = succeeds(folder.path(), &[&["copy", name], options].concat()).stdout;
        assert!(text.contains(holds), "{name} {options:?}: {text}");
        dispatch::parse(&text, name).unwrap_or_else(|error| panic!("{error}"));
    }
}

/// A recipe's function takes a host's own eye, group and vertex stage, and needs nothing else of the recipe.
#[test]
fn a_copied_function_fits_a_host_of_its_own() {
    let folder = folder();
    let copy = |more: &[&str]| {
        let usual = ["copy", "gem_walk::gem_radiance", "--effects", "convex_trace,dispersion"];
        succeeds(folder.path(), &[&usual, more].concat()).stdout
    };
    let text = copy(&["--set", "BOUNCES=8,DISPERSION_FORM=1", "--private", "view", "--group", "2"]);
    assert!(text.contains("const BOUNCES: u32 = 8u;") && !text.contains("fn gem_vertex("), "{text}");
    let host = "
struct Eye {
    position: vec3f,
}

@group(0) @binding(0) var<uniform> eye: Eye;

@fragment
fn main(
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat) normal: vec3f,
    @location(2) @interpolate(flat) face: u32,
) -> @location(0) vec4f {
    view.eye = eye.position;
    let radiance = gem_radiance(GemVertex(clip, position, normal, face), true);
    return vec4f(radiance.surface + radiance.inside, 1.0f);
}
";
    let (ir, _) = dispatch::parse(&(text.clone() + host), "host.wgsl").unwrap_or_else(|error| panic!("{error}"));
    let mut bound: Vec<(u32, u32, &str)> = ir
        .global_variables
        .iter()
        .filter_map(|(_, variable)| Some((variable.binding?, variable.name.as_deref()?)))
        .map(|(binding, name)| (binding.group, binding.binding, name))
        .collect();
    bound.sort_unstable();
    let expected = [(0, 0, "eye"), (2, 0, "material"), (2, 1, "planes"), (2, 2, "facet_map"), (2, 3, "stone")];
    assert_eq!(bound, expected);
    // A preprocessor's name stands where the number does.
    let named = copy(&["--private", "view", "--group", "#{MATERIAL}", "--set", "BOUNCES=8,DISPERSION_FORM=1"]);
    assert_eq!(named.replace("#{MATERIAL}", "2"), text);
}

#[test]
fn functions_of_several_modules_are_copied_together() {
    let text =
        succeeds(folder().path(), &["copy", "fresnel::normal_incidence", "refraction", "fresnel::schlick"]).stdout;
    let (ir, _) = dispatch::parse(&text, "optics.wgsl").unwrap_or_else(|error| panic!("{error}"));
    let names: Vec<&str> = ir.functions.iter().filter_map(|(_, function)| function.name.as_deref()).collect();
    for name in ["fresnel_schlick", "fresnel_normal_incidence", "refraction_reflect", "refraction_refract"] {
        assert!(names.contains(&name), "{names:?}");
    }
    assert!(!names.contains(&"fresnel_dielectric"), "{names:?}");
}

#[test]
fn copies_are_written_in_other_languages() {
    let folder = folder();
    for (name, language, holds) in [
        ("refraction", "hlsl", "refraction_refract"),
        ("refraction", "msl", "refraction_refract"),
        ("refraction::refract", "glsl", "refraction_refract"),
        ("refraction::refract", "glsl-es", "refraction_refract"),
        ("refraction::refract", "wgsl", "refraction_refract"),
        ("voxelization", "glsl", "voxelization_column"),
        ("display::display_fragment", "glsl-es", "display_fragment"),
        ("gem", "hlsl", "refraction_refract"),
        ("gem", "msl", "refraction_refract"),
    ] {
        let text = succeeds(folder.path(), &["copy", name, "--to", language]).stdout;
        assert!(text.contains(holds), "{name} in {language}");
    }
    for name in ["refraction::refract", "gem"] {
        succeeds(folder.path(), &["copy", name, "--to", "spirv", "--out", "out.spv"]);
        let bytes = std::fs::read(folder.path().join("out.spv")).expect("the output");
        // SPIR-V's magic number, little endian.
        assert_eq!(bytes[..4], [0x03, 0x02, 0x23, 0x07], "{name}");
    }
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
