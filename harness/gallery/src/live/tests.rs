use super::export::Manifest;
use super::fields;
use super::*;
use base64::Engine as _;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::Read as _;
use std::sync::LazyLock;

fn scene(name: &str) -> &'static LiveScene {
    SCENES.iter().find(|live| live.scene == name).expect("a live scene")
}

/// All scenes, exported once: the site's folder, what the pages need to know, and the bytes of it all.
static EXPORTED: LazyLock<(tempfile::TempDir, BTreeMap<&str, Manifest>, usize)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder");
    let mut store = Store::new(folder.path());
    let manifest = |live: &LiveScene| (live.scene, write_scene(live, &mut store).expect("exported"));
    let manifests = SCENES.iter().map(manifest).collect();
    let bytes = store.bytes();
    (folder, manifests, bytes)
});

/// Reads a stored file as a page does.
fn stored(site: &Path, name: &str) -> Vec<u8> {
    let text = std::fs::read_to_string(site.join(format!("data/live/{name}.js"))).expect("a file");
    let start = format!("gallery.deliver(\"live/{name}\", \"");
    let base64 = text.strip_prefix(&start).and_then(|rest| rest.strip_suffix("\");\n")).expect("a delivery");
    let squeezed = base64::engine::general_purpose::STANDARD.decode(base64).expect("base64");
    let mut bytes = Vec::new();
    flate2::read::GzDecoder::new(&squeezed[..]).read_to_end(&mut bytes).expect("gzip");
    bytes
}

/// A `cook copy` command names effects and overrides that the text has, with values of their types.
fn copies(command: &str) {
    let words: Vec<&str> = command.strip_prefix("./cook copy ").expect("a command").split(' ').collect();
    let [name, "--effects", effects, set @ ..] = &words[..] else { panic!("{command}") };
    let recipe = lapidary_wgsl::RECIPES.iter().find(|recipe| recipe.name == *name).expect("a recipe");
    let effects: Vec<&str> = effects.trim_matches('"').split(',').filter(|effect| !effect.is_empty()).collect();
    let text = lapidary_cookbook::marks::with_effects(recipe, Some(&effects), &[]).expect("a text");
    let pairs = set.iter().filter(|word| **word != "--set").flat_map(|word| word.split(','));
    let pairs = pairs.map(|word| word.split_once('=').expect("a pair"));
    let text = lapidary_translate::fitted::with_constants(&text, &pairs.collect::<Vec<_>>(), &[]);
    let text = text.unwrap_or_else(|error| panic!("{command}: {error}"));
    naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{command}: {error}"));
}

/// Every frame of a scene is whole: all that it names is stored, its shaders are valid, and each field that a slider
/// moves stands in one of its buffers, or the buffer is left out with its effect.
fn is_whole(name: &str) {
    let (folder, manifests, _) = &*EXPORTED;
    let (manifest, live) = (&manifests[name], scene(name));
    assert_eq!(manifest.rungs.len(), live.rungs.len());
    let mut moved: Vec<&str> = Vec::new();
    for (rung, exported) in &manifest.rungs {
        assert!(!exported.frames.is_empty(), "{rung}");
        for (effects, file) in &exported.frames {
            let document: Value = serde_json::from_slice(&stored(folder.path(), file)).expect("JSON");
            let resources = document["resources"].as_array().expect("resources");
            for row in resources.iter().filter(|row| row["contents"].is_string()) {
                let bytes = stored(folder.path(), row["contents"].as_str().expect("a name"));
                assert!(row["kind"] != "buffer" || row["bytes"] == bytes.len(), "{rung} {effects}: {}", row["name"]);
            }
            for row in document["pipelines"].as_array().expect("pipelines") {
                let text = stored(folder.path(), row["wgsl"].as_str().expect("a name"));
                let text = String::from_utf8(text).expect("text");
                naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{rung} {effects}: {error}"));
            }
            let commands = document["pipelines"].as_array().expect("pipelines").iter().map(|row| &row["copy"]);
            let commands: Vec<&str> = commands.filter_map(Value::as_str).collect();
            assert!(!commands.is_empty(), "{rung} {effects}: no text of the cookbook draws it");
            commands.into_iter().for_each(copies);
            // What the camera changes is the scene's pass and what follows, not what was solved before.
            let view = resources.iter().position(|row| row["name"] == "view").expect("a view").to_string();
            let again: Vec<u64> =
                document["again"][&view].as_array().expect("passes").iter().filter_map(Value::as_u64).collect();
            let passes = document["passes"].as_array().expect("passes");
            let first = passes.iter().position(|pass| pass["name"] == "scene").expect("a scene's pass") as u64;
            assert_eq!(again.first(), Some(&first), "{rung} {effects}");
        }
        for movement in &exported.moves {
            let slider = live.sliders.iter().find(|slider| slider.name == movement.slider).expect("a slider");
            let (values, start) = slider.values(&Scene::named(live.scene).expect("built in"));
            assert_eq!(movement.nodes.len(), values.len(), "{rung}: {}", movement.slider);
            assert!(movement.nodes.iter().flatten().all(|value| value.is_finite()), "{rung}: {}", movement.slider);
            assert!(
                movement.nodes.iter().any(|node| *node != movement.nodes[start]),
                "{rung}: {} moves nothing",
                movement.slider
            );
            moved.push(movement.slider);
        }
    }
    for slider in live.sliders {
        assert!(moved.contains(&slider.name), "{} moves nothing by any rung", slider.name);
    }
}

#[test]
fn stones_are_whole() {
    ["brilliant", "ruby"].into_iter().for_each(is_whole);
}

#[test]
#[ignore = "long; .ci/full runs it"]
fn a_body_with_shadows_is_whole() {
    is_whole("skin_ring");
}

#[test]
fn bodies_that_are_solved_are_whole() {
    ["bunny", "dragon"].into_iter().for_each(is_whole);
}

/// The fields at a step are those of a frame made from a scene that was changed so.
#[test]
fn a_step_is_the_renderers_own_frame() {
    let (manifest, live) = (&EXPORTED.1["bunny"], scene("bunny"));
    let original = Scene::named(live.scene).expect("built in");
    let slider = live.sliders.iter().find(|slider| slider.name == "turn").expect("a slider");
    let (values, _) = slider.values(&original);
    let slider::Moves::Scene(change) = slider.moves else { panic!("a change of the scene") };
    let rung = "godunov-64";
    let mut of_rung = settings(live, rung, |toggle| toggle.on).expect("settings");
    let mut turned = original.clone();
    change(&mut turned, &mut of_rung, values[3]);
    let frame = lapidary_render::frame(None, &turned, &of_rung).expect("a frame");
    let moves: Vec<_> = manifest.rungs[rung].moves.iter().filter(|movement| movement.slider == "turn").collect();
    assert!(!moves.is_empty());
    for movement in moves {
        for place in &movement.at {
            assert_eq!(fields::value(&frame, place), movement.nodes[3], "{place:?}");
        }
    }
}

#[test]
fn all_data_fits_the_site() {
    let bytes = EXPORTED.2;
    assert!(bytes < 8 << 20, "{bytes}");
}

#[test]
fn steps_are_ascending_and_hold_the_scenes_own_value() {
    for live in &SCENES {
        let scene = Scene::named(live.scene).expect("built in");
        for slider in live.sliders {
            let (values, start) = slider.values(&scene);
            assert!(values.is_sorted_by(|a, b| a < b), "{}: {values:?}", slider.name);
            assert_eq!(values[start], (slider.start)(&scene));
        }
    }
}

#[test]
fn the_part_names_every_rung_and_slider_and_its_scripts_end_nowhere_else() {
    for live in &SCENES {
        let text = section(live).expect("a part").0;
        for rung in live.rungs {
            assert_eq!(text.matches(&format!("<option value=\"{rung}\">")).count(), 2, "{rung}");
        }
        for slider in live.sliders {
            assert!(text.contains(&format!("data-slider=\"{}\"", slider.name)));
        }
        assert_eq!(text.matches("</script").count(), 1);
    }
}

/// A measured time is drawn beside the ladder's, so it is of frames of the same size.
#[test]
fn a_timed_frame_is_the_ladders() {
    let (folder, manifests, _) = &*EXPORTED;
    for live in &SCENES {
        let (report, side) = match live.ladder {
            "convex" => (include_str!("../../../../docs/measurements/lavapipe/gem.json"), "side"),
            "cdrf" => (include_str!("../../../../docs/measurements/lavapipe/cdrf.json"), "side"),
            _ => (include_str!("../../../../docs/measurements/lavapipe/translucent.json"), "width"),
        };
        let report: Value = serde_json::from_str(report).expect("JSON");
        assert_eq!(report["settings"][side], live.timed_side, "{}", live.scene);
        for (rung, exported) in &manifests[live.scene].rungs {
            let document: Value = serde_json::from_slice(&stored(folder.path(), &exported.timed)).expect("JSON");
            let size = json!([live.timed_side, live.timed_side]);
            assert!(
                document["pictures"].as_array().expect("pictures").iter().all(|picture| picture["size"] == size),
                "{rung}"
            );
        }
    }
}

#[test]
fn a_menu_begins_with_the_defaults() {
    let menu = scene("brilliant").menu();
    let shown: Vec<_> = menu.iter().map(|(rung, qualities)| (*rung, qualities.as_str())).take(4).collect();
    let expected = [("walk-8+tracker", "good"), ("walk-4", "fast"), ("walk-16+tracker", "best"), ("surface", "")];
    assert_eq!(shown, expected);
}

/// One executor for the examples and the gallery, small enough to read.
#[test]
fn the_executor_has_at_most_500_lines() {
    let executor = include_str!("../../../../docs/engines/frame.js");
    let drawing = include_str!("live.js");
    assert!(executor.lines().count() + drawing.lines().count() <= 500);
}

#[test]
fn a_rung_is_drawn_on_the_page_that_begins_with_it() {
    let page = |ladder: &str, rung: &str| page_of(ladder, rung);
    assert_eq!(page("convex", "walk-8+tracker").as_deref(), Some("live/brilliant.html"));
    assert_eq!(page("convex", "walk-4+tracker").as_deref(), Some("live/brilliant.html#rung=walk-4%2Btracker"));
    // The bunny comes first, and has it too.
    assert_eq!(page("translucent", "diffusion-64").as_deref(), Some("live/dragon.html"));
    assert_eq!(page("translucent", "godunov-32").as_deref(), Some("live/bunny.html#rung=godunov-32"));
    assert_eq!(page("concave", "bvh-8+tracker"), None);
}
