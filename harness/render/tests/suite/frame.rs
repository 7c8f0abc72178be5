//! Frames as files, run by a host that knows nothing of the project.

mod executor;

use lapidary_assay::extremum::larger;
use lapidary_plan::{Rung, Scattering};
use lapidary_render::frame::Executor;
use lapidary_render::{GemOptions, Settings, frame, render};
use lapidary_scene::Scene;
use lapidary_testing::gpu;
use serde_json::Value;

/// Returns the pictures of another host and of the renderer: linear radiance and coverage, and the
/// bytes of the encoded picture.
fn both(name: &str, settings: &Settings) -> [(Vec<f32>, Vec<u8>); 2] {
    let scene = Scene::named(name).expect("built in");
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path().join("frame");
    frame(Some(gpu()), &scene, settings).expect("a frame").write(&folder).expect("written");
    let pictures = executor::run(&gpu().device, &gpu().queue, &folder);
    let picture = render(gpu(), &scene, settings).expect("rendered");
    for (name, (width, height, _)) in &pictures {
        assert_eq!((*width, *height), (settings.width, settings.height), "{name}");
    }
    let covered = picture.linear.iter().filter(|pixel| pixel[3] > 0.0).count();
    assert!(covered > picture.linear.len() / 20, "{name}: {covered} pixels");
    let linear = bytemuck::pod_collect_to_vec(&pictures["linear picture"].2);
    let rendered = (picture.linear.concat(), picture.encoded.concat());
    [(linear, pictures["encoded picture"].2.clone()), rendered]
}

fn by_material() -> Settings {
    Settings { rung: Rung::ByMaterial, ..Settings::of_size(96, 80) }
}

#[test]
fn another_host_draws_the_same_pictures() {
    if !lapidary_testing::on_lavapipe("other drivers compile a text for each host, and round differently") {
        return;
    }
    let by_material = by_material();
    let of_rung = |rung: &str| Settings { rung: rung.parse().expect(rung), ..by_material.clone() };
    let cases = [
        // Eight samples, more than one tile.
        ("brilliant", Settings { samples: 8, width: 300, height: 270, ..by_material.clone() }),
        ("bunny", of_rung("tiled-26-64")),
        ("dragon", of_rung("ping-pong-6-32")),
        ("pave_ring", by_material.clone()),
        ("skin_bunny", Settings { shadows: true, ..of_rung("blur") }),
        ("wax", of_rung("table-257-rgba16f")),
        // Stones over other bodies: a pass that keeps what is there.
        (
            "vitrine",
            Settings {
                scattering: Some(Scattering::Cdrf),
                gem: GemOptions { footprint: true, ..GemOptions::default() },
                ..by_material.clone()
            },
        ),
        ("ruby", Settings { gem: GemOptions { deferred: true, ..GemOptions::default() }, ..of_rung("proxy-2") }),
    ];
    for (name, settings) in cases {
        let [(host, host_encoded), (own_linear, own_encoded)] = both(name, &settings);
        let differing = host.iter().zip(&own_linear).filter(|(host, ours)| host.to_bits() != ours.to_bits()).count();
        assert_eq!((differing, host_encoded == own_encoded), (0, true), "{name}");
    }
}

/// The rounding of Godunov's scheme depends on the order in which tiles are processed. It differs
/// between any two runs, also of the renderer itself.
#[test]
fn another_host_draws_the_bunny_as_near_as_a_second_run_does() {
    let [(host, host_encoded), (own_linear, own_encoded)] = both("bunny", &by_material());
    let relative_difference = |(host, ours): (&f32, &f32)| (host - ours).abs() / ours.abs().max(1e-3);
    let worst = host.iter().zip(&own_linear).map(relative_difference).fold(0.0, larger);
    let steps = host_encoded.iter().zip(&own_encoded).map(|(host, ours)| host.abs_diff(*ours)).max();
    println!("off by {worst:.1e}, {steps:?} steps");
    assert!(worst < 1e-5 && steps <= Some(1), "{worst} {steps:?}");
}

#[test]
fn another_host_is_small() {
    let lines = include_str!("frame/executor.rs").lines().count();
    assert!(lines <= 330, "{lines} lines");
}

/// Everything that a frame refers to is there, contents have their resources' sizes, and fields lie
/// within their structs.
#[test]
fn a_frame_is_whole() {
    let settings = by_material();
    let frame = frame(Some(gpu()), &Scene::named("vitrine").expect("built in"), &settings).expect("a frame");
    let folder = tempfile::tempdir().expect("a folder");
    frame.write(folder.path()).expect("an empty folder is as good as a new one");
    let json = std::fs::read_to_string(folder.path().join("frame.json")).expect("written");
    let json: Value = serde_json::from_str(&json).expect("JSON");
    let mut fields = 0;
    for resource in json["resources"].as_array().expect("a list") {
        let name = resource["name"].as_str().expect("a name");
        if let Some(file) = resource["contents"].as_str() {
            let bytes = std::fs::metadata(folder.path().join(file)).expect(file).len();
            assert!(resource["kind"] != "buffer" || resource["bytes"] == bytes, "{name}");
            // WebGPU fills a texture by copying.
            let usage = resource["usage"].as_array().expect("a list");
            assert!(resource["kind"] == "buffer" || usage.contains(&"COPY_DST".into()), "{name}");
        }
        let Some(layout) = resource["layout"].as_object() else { continue };
        for field in layout["fields"].as_array().expect("a list") {
            assert!(field["offset"].as_u64() < layout["bytes"].as_u64(), "{name}: {field}");
            fields += 1;
        }
    }
    assert!(fields > 50, "{fields}");
    let view = json["resources"].as_array().expect("a list").iter().find(|row| row["name"] == "view").expect("a view");
    let expected = serde_json::json!([
        { "name": "clip_from_world", "type": "mat4x4<f32>", "offset": 0 },
        { "name": "eye", "type": "vec3<f32>", "offset": 64 },
    ]);
    assert_eq!(view["layout"]["fields"], expected);
    // The folder is not empty any more.
    assert!(std::fs::read_dir(folder.path()).expect("a folder").count() == 3, "nothing else is left there");
    let refused = frame.write(folder.path()).expect_err("taken").to_string();
    assert!(refused.ends_with("is there and not empty; name a new folder"), "{refused}");
    // A frame made without a device is for inspection: it is not written, because it cannot be run.
    let table = Settings { rung: "table-256-rgba8".parse().expect("a rung"), ..settings };
    let seen = lapidary_render::frame(None, &Scene::named("wax").expect("built in"), &table).expect("a frame");
    let elsewhere = folder.path().join("elsewhere");
    let refused = seen.write(&elsewhere).expect_err("left out").to_string();
    assert!(refused.contains("was left out: the frame was made without a device"), "{refused}");
    assert!(!elsewhere.exists());
    let refused = Executor::new(gpu(), seen).expect_err("left out").to_string();
    assert!(refused.contains("its contents were left out: the frame was made without a device"), "{refused}");
}

/// What runs frames in a browser reads the version that is written.
#[test]
fn the_browsers_reader_is_of_this_version() {
    let folder = tempfile::tempdir().expect("a folder");
    let made = frame(None, &Scene::named("brilliant").expect("built in"), &Settings::of_size(16, 16)).expect("a frame");
    made.write(&folder.path().join("frame")).expect("written");
    let text = std::fs::read_to_string(folder.path().join("frame/frame.json")).expect("frame.json");
    let written: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let reader = include_str!("../../../../docs/engines/frame.js");
    assert!(reader.contains(&format!("const VERSION = {};", written["version"])), "{}", written["version"]);
}
