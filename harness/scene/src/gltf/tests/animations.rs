//! Nodes at a time of the file's animations.

use std::f32::consts::FRAC_1_SQRT_2;

use super::*;

/// The triangle's file with one channel that moves `path` of its node.
fn animated(path: &str, interpolation: &str, times: &[f32], values: &[f32]) -> (Value, Vec<u8>) {
    let (mut document, mut data) = (document(), binary());
    let (kind, size) = if path == "rotation" { ("VEC4", 4) } else { ("VEC3", 3) };
    for (kind, size, numbers) in [("SCALAR", 1, times), (kind, size, values)] {
        let view = json!({"buffer": 0, "byteOffset": data.len(), "byteLength": 4 * numbers.len()});
        let number = document["bufferViews"].as_array().unwrap().len();
        document["bufferViews"].as_array_mut().unwrap().push(view);
        let accessor =
            json!({"bufferView": number, "componentType": 5126, "count": numbers.len() / size, "type": kind});
        document["accessors"].as_array_mut().unwrap().push(accessor);
        data.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    }
    document["buffers"][0]["byteLength"] = json!(data.len());
    document["animations"] = json!([{
        "channels": [{"sampler": 0, "target": {"node": 0, "path": path}}],
        "samplers": [{"input": 2, "output": 3, "interpolation": interpolation}],
    }]);
    (document, data)
}

fn at((document, data): &(Value, Vec<u8>), time: f32) -> Result<Scene, SceneError> {
    parse_as(&file(document, data), None, &Opening { time: Some(time), ..Opening::default() })
}

/// Position of the triangle's second corner, which is at 1, 0, 0 at rest.
fn corner(file: &(Value, Vec<u8>), time: f32) -> Vec3 {
    only_mesh(&at(file, time).unwrap()).positions[1]
}

#[test]
fn translations_and_scales_follow_their_keys() {
    let times = [1.0, 3.0];
    let moves = [0.0, 0.0, 0.0, 4.0, 8.0, 0.0];
    let linear = animated("translation", "LINEAR", &times, &moves);
    for (time, place) in [(0.0, [1.0, 0.0]), (1.5, [2.0, 2.0]), (3.0, [5.0, 8.0]), (99.0, [5.0, 8.0])] {
        assert_eq!(corner(&linear, time), Vec3::new(place[0], place[1], 0.0), "{time}");
    }
    let step = animated("translation", "STEP", &times, &moves);
    assert_eq!((corner(&step, 2.9), corner(&step, 3.0)), (Vec3::X, Vec3::new(5.0, 8.0, 0.0)));
    let scaled = animated("scale", "LINEAR", &times, &[1.0, 1.0, 1.0, 3.0, 1.0, 1.0]);
    assert_eq!(corner(&scaled, 2.0), Vec3::X * 2.0);
}

/// A spline through cubes of the time, whose tangents are theirs, is that cube.
#[test]
fn a_cubic_spline_gives_a_cubic_back() {
    let cube = |t: f32| [0.0, 3.0 * t * t, 0.0, 0.0, t.powi(3), 0.0, 0.0, 3.0 * t * t, 0.0];
    let keys = [-1.0, 0.5, 2.0];
    // Of each key the tangent before it, its value and the tangent after it.
    let values: Vec<f32> = keys.into_iter().flat_map(cube).collect();
    let spline = animated("translation", "CUBICSPLINE", &keys, &values);
    for time in [0.0_f32, 0.25, 0.75, 1.9] {
        let y = corner(&spline, time).y;
        assert!((y - time.powi(3)).abs() < 4e-6, "{time}: {y}");
    }
}

#[test]
fn rotations_take_the_short_way_at_constant_speed() {
    let quarter = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -FRAC_1_SQRT_2, -FRAC_1_SQRT_2];
    let turned = animated("rotation", "LINEAR", &[0.0, 3.0], &quarter);
    for time in [0.0_f32, 1.0, 2.0, 3.0] {
        let angle = 30.0_f32.to_radians() * time;
        assert!(corner(&turned, time).distance(Vec3::new(angle.cos(), angle.sin(), 0.0)) < 1e-6, "{time}");
    }
}

#[test]
fn without_a_time_bodies_are_at_rest_which_is_said() {
    let (document, data) = animated("translation", "LINEAR", &[0.0], &[4.0, 8.0, 0.0]);
    let scene = parse(&file(&document, &data), None).unwrap();
    assert_eq!(only_mesh(&scene).positions[1], Vec3::X);
    let clause = "animations: 1 of the file (bodies are drawn at rest)".to_owned();
    assert!(scene.lacking.clauses().contains(&clause));
    assert!(!at(&(document, data), 0.0).unwrap().lacking.clauses().contains(&clause));
}

#[test]
fn channels_of_extensions_are_passed_over() {
    let mut file = animated("translation", "LINEAR", &[0.0], &[4.0, 8.0, 0.0]);
    let pointer = json!({"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {}}}});
    file.0["animations"][0]["channels"].as_array_mut().unwrap().push(pointer);
    assert_eq!(corner(&file, 0.0), Vec3::new(5.0, 8.0, 0.0));
    file.0["animations"] = json!([{"channels": 5}]);
    assert!(at(&file, 0.0).unwrap().lacking.clauses().contains(&MOVES_NOTHING.to_owned()));
}

const MOVES_NOTHING: &str = "animations: 1 of the file (none moves a node; bodies are drawn at rest)";

#[test]
fn a_time_without_a_motion_is_told() {
    let mut file = animated("translation", "LINEAR", &[0.0], &[4.0, 8.0, 0.0]);
    file.0["animations"][0]["channels"][0]["target"]["path"] = json!("weights");
    assert!(at(&file, 0.0).unwrap().lacking.clauses().contains(&MOVES_NOTHING.to_owned()));
    file.0.as_object_mut().unwrap().remove("animations");
    let message = at(&file, 0.0).unwrap_err().to_string();
    assert_eq!(message, "the file: it has no animation, so that a time (--time) changes nothing; leave it out");
}

/// What a sampler gives is named by its animation and the node, not by what it does to vertices.
#[test]
fn values_that_are_none_are_told_by_their_animation() {
    let zero = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    let far = |bad: f32| [0.0, 0.0, 0.0, bad, 0.0, 0.0];
    for (path, way, values, time, what) in [
        ("rotation", "LINEAR", &zero[..], 0.5, "rotation is undefined, since a key is 0, 0, 0, 0 or not finite"),
        ("rotation", "STEP", &zero[..], 1.0, "rotation is undefined, since a key is 0, 0, 0, 0 or not finite"),
        ("translation", "LINEAR", &far(f32::INFINITY)[..], 0.5, "translation is undefined, since a key is not finite"),
        ("scale", "STEP", &far(f32::NAN)[..], 1.5, "scale is undefined, since a key is not finite"),
    ] {
        let mut file = animated(path, way, &[0.0, 1.0], values);
        file.0["animations"][0]["name"] = json!("spin");
        let message = at(&file, time).unwrap_err().to_string();
        assert_eq!(message, format!("animation 0 \"spin\", node 0 \"stone\": at {time} s its {what}; mend the keys"));
        // Another time needs that key no more.
        assert!(way == "LINEAR" || at(&file, 0.5).is_ok(), "{path}");
    }
}

#[test]
fn animations_that_contradict_themselves_are_refused() {
    let good = animated("translation", "LINEAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, 4.0, 8.0, 0.0]);
    let refused = |change: &dyn Fn(&mut Value)| {
        let mut changed = good.clone();
        change(&mut changed.0);
        at(&changed, 0.5).unwrap_err().to_string()
    };
    for (change, message) in [
        (
            &(|d: &mut Value| d["animations"][0]["samplers"][0]["interpolation"] = json!("CUBICSPLINE"))
                as &dyn Fn(&mut Value),
            "animation 0: a sampler has 2 keys and 2 values, but must have 6 values; export it again",
        ),
        (
            &|d| d["animations"][0]["samplers"][0]["interpolation"] = json!("SINE"),
            "animation 0: an interpolation is none of glTF's; export it again",
        ),
        (
            &|d| d["animations"][0]["channels"][0]["target"]["path"] = json!("colour"),
            "animation 0: a channel's path is none of glTF's; export it again",
        ),
        (
            &|d| d["nodes"][0]["matrix"] = json!(glam::Mat4::IDENTITY.to_cols_array()),
            "node 0 \"stone\": it has a matrix and is animated, which exclude each other; remove one",
        ),
        (&|d| d["animations"][0]["channels"][0]["target"]["node"] = json!(7), "animation 0 refers to node 7"),
        (&|d| d["animations"][0]["channels"][0]["sampler"] = json!(7), "animation 0 refers to sampler 7"),
    ] {
        let found = refused(change);
        assert!(found.starts_with(message), "{found}");
    }
}
