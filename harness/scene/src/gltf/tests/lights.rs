//! Lights from `KHR_lights_punctual`.

use super::refusals::message;
use super::*;
use crate::Light;

/// Adds `light` to the file, at a second node with `transform`.
fn add_light(document: &mut Value, light: &Value, transform: &Value) {
    document["extensionsRequired"] = json!(["KHR_lights_punctual"]);
    document["extensions"] = json!({"KHR_lights_punctual": {"lights": [light]}});
    let mut node = transform.clone();
    node["extensions"] = json!({"KHR_lights_punctual": {"light": 0}});
    document["scenes"][0]["nodes"] = json!([0, 1]);
    document["nodes"].as_array_mut().unwrap().push(node);
}

fn light_of(light: Value, transform: Value) -> Light {
    let scene = load_changed(|d| add_light(d, &light, &transform)).unwrap();
    assert_eq!(scene.lights.len(), 1);
    assert_eq!(scene.lights[0].problem(), None);
    scene.lights[0]
}

#[test]
fn a_directional_light_shines_along_its_nodes_negative_z() {
    let unturned = light_of(json!({"type": "directional"}), json!({}));
    assert_eq!(unturned, Light::Directional { toward: Vec3::Z, irradiance: Vec3::ONE });

    let turn = Quat::from_rotation_y(0.3) * Quat::from_rotation_x(-0.9);
    let turned = light_of(
        json!({"type": "directional", "color": [1, 0.5, 0], "intensity": 3, "range": 7}),
        // Position and scale have no effect.
        json!({"rotation": turn.to_array(), "scale": [1, 2, 30], "translation": [1e30, 0, 0]}),
    );
    let Light::Directional { toward, irradiance } = turned else { panic!("{turned:?}") };
    assert!(toward.distance(turn * Vec3::Z) < 1e-6);
    assert_eq!(irradiance, Vec3::new(3.0, 1.5, 0.0));
}

#[test]
fn a_point_light_stands_where_its_node_is() {
    let lamp = json!({"type": "point", "name": "lamp", "color": [0.25, 1, 0.5], "intensity": 4, "range": 1});
    let scene = load_changed(|d| {
        add_light(d, &lamp, &json!({"translation": [1, 2, 3], "rotation": [0.6, 0, 0, 0.8]}));
        // A second lamp of the same kind, moved and scaled by its parent.
        let second = json!({"children": [3], "translation": [10, 0, 0], "scale": [2, 2, 2]});
        let child = json!({"translation": [0, 1, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}});
        d["nodes"].as_array_mut().unwrap().extend([second, child]);
        d["scenes"][0]["nodes"] = json!([0, 1, 2]);
    });
    let intensity = Vec3::new(1.0, 4.0, 2.0);
    let point = |x, y, z| Light::Point { position: Vec3::new(x, y, z), intensity };
    assert_eq!(scene.unwrap().lights, [point(1.0, 2.0, 3.0), point(10.0, 2.0, 0.0)]);
}

#[test]
fn a_spot_light_stands_where_its_node_is_and_shines_along_its_negative_z() {
    let turn = Quat::from_rotation_y(0.3) * Quat::from_rotation_x(-0.9);
    let cone = json!({"innerConeAngle": 0.25, "outerConeAngle": 0.5});
    let found = light_of(
        json!({"type": "spot", "color": [1, 0.5, 0], "intensity": 3, "range": 7, "spot": cone}),
        // The scale has no effect.
        json!({"rotation": turn.to_array(), "scale": [1, 2, 30], "translation": [1, 2, 3]}),
    );
    let Light::Spot { position, direction, intensity, inner_angle, outer_angle } = found else { panic!("{found:?}") };
    assert_eq!((position, inner_angle, outer_angle), (Vec3::new(1.0, 2.0, 3.0), 0.25, 0.5));
    assert!(direction.distance(turn * Vec3::NEG_Z) < 1e-6);
    assert_eq!(intensity, Vec3::new(3.0, 1.5, 0.0));
}

#[test]
fn cones_have_gltfs_default_angles() {
    use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};
    for (cone, angles) in [
        (json!({}), (0.0, FRAC_PI_4)),
        (json!({"innerConeAngle": 0.5}), (0.5, FRAC_PI_4)),
        (json!({"outerConeAngle": 0.5}), (0.0, 0.5)),
        // The f32 nearest to pi/2 lies slightly above it.
        (json!({"outerConeAngle": f64::from(FRAC_PI_2)}), (0.0, FRAC_PI_2)),
    ] {
        let found = light_of(json!({"type": "spot", "spot": cone}), json!({}));
        let Light::Spot { inner_angle, outer_angle, .. } = found else { panic!("{found:?}") };
        assert_eq!((inner_angle, outer_angle), angles);
    }
    let bare = light_of(json!({"type": "spot"}), json!({}));
    assert_eq!(bare, light_of(json!({"type": "spot", "spot": {}}), json!({})));
}

#[test]
fn lights_that_no_node_shows_are_not_lit() {
    let scene = load_changed(|d| {
        add_light(d, &json!({"type": "area"}), &json!({}));
        d["scenes"][0]["nodes"] = json!([0]);
    });
    assert_eq!(scene.unwrap().lights, []);
}

#[test]
fn lights_that_cannot_be_read() {
    for (light, says) in [
        (json!({"type": "spot", "spot": 7}), "its spot is a number, but must be an object"),
        (json!({"type": "spot", "spot": {"innerConeAngle": "wide"}}), "its innerConeAngle is a string"),
        (json!({"type": "spot", "spot": {"outerConeAngle": null}}), "its outerConeAngle is null"),
        (
            json!({"type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.5}}),
            "are 0.5 and 0.5, but the inner",
        ),
        (json!({"type": "spot", "spot": {"innerConeAngle": 0.8}}), "less than the outer"),
        (json!({"type": "spot", "spot": {"innerConeAngle": -0.1}}), "must be at least 0"),
        (json!({"type": "spot", "spot": {"outerConeAngle": 1.571}}), "the outer at most pi/2"),
        (json!({"type": "spot", "spot": {"outerConeAngle": 1e-50}}), "less than the outer"),
        (json!({"type": "spot", "spot": {"outerConeAngle": 1e39}}), "the outer at most pi/2"),
        (json!({"type": "area"}), "its type is \"area\", but must be \"directional\", \"point\" or \"spot\""),
        (json!({}), "its type is null, but must be"),
        (json!(7), "its type is null, but must be"),
        (json!({"type": "x".repeat(100_000)}), "but must be \"directional\""),
        (json!({"type": "point", "intensity": -1}), "its intensity is -1.0, but must be at least 0"),
        (json!({"type": "point", "intensity": 1e39}), "finite in single precision"),
        (json!({"type": "point", "intensity": "NaN"}), "its intensity is a string, but must be a number"),
        (json!({"type": "point", "intensity": null}), "its intensity is null, but must be a number"),
        (
            json!({"type": "point", "color": [1, -0.5, 1]}),
            "its color is [1.0, -0.5, 1.0], but each part must be at least 0",
        ),
        (json!({"type": "directional", "color": [1, null, 1]}), "but must be three numbers"),
        (json!({"type": "directional", "color": [1, 1]}), "but must be three numbers"),
        (json!({"type": "directional", "color": [1e30, 1, 1], "intensity": 1e30}), "finite in single precision"),
    ] {
        let message = message(|d| add_light(d, &light, &json!({})));
        assert!(message.starts_with("light 0: ") && message.contains(says) && message.len() < 300, "{message}");
    }
    let message = message(|d| add_light(d, &json!({"type": "area", "name": "desk"}), &json!({})));
    assert!(message.starts_with("light 0 \"desk\": its type"), "{message}");
}

#[test]
fn lights_that_are_nowhere() {
    for (kind, transform) in [
        ("directional", json!({"scale": [1, 1, 0]})),
        ("spot", json!({"scale": [1, 1, 0]})),
        ("spot", json!({"translation": [0, 2e9, 0]})),
        ("point", json!({"translation": [2e9, 0, 0]})),
        ("point", json!({"translation": [1e39, 0, 0]})),
    ] {
        let message = message(|d| add_light(d, &json!({"type": kind}), &transform));
        assert!(message.starts_with("node 1: its light has no direction or place"), "{message}");
    }
}

#[test]
fn references_to_lights_that_are_not_there() {
    let changed = |change: fn(&mut Value)| {
        message(|d| {
            add_light(d, &json!({"type": "point"}), &json!({}));
            change(d);
        })
    };
    let nodes = |d: &mut Value, reference: Value| d["nodes"][1]["extensions"]["KHR_lights_punctual"] = reference;
    assert_eq!(
        changed(|d| d["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = json!(7)),
        "node 1 refers to light 7, but the file has 1; export it again"
    );
    for reference in [json!({"light": -1}), json!({"light": 0.5}), json!({"light": "0"}), json!({})] {
        let message = message(|d| {
            add_light(d, &json!({"type": "point"}), &json!({}));
            nodes(d, reference);
        });
        assert!(message.starts_with("node 1: its KHR_lights_punctual names no light by number"), "{message}");
    }
    assert!(changed(|d| d["nodes"][1]["extensions"]["KHR_lights_punctual"] = json!(1)).contains("must be an object"));
    assert!(changed(|d| d["extensions"] = json!({})).contains("node 1 refers to light 0, but the file has 0"));
    let message = changed(|d| d["extensions"]["KHR_lights_punctual"] = json!([1]));
    assert!(message.starts_with("the file: its KHR_lights_punctual is an array of something else"), "{message}");
    let message = changed(|d| d["extensions"]["KHR_lights_punctual"]["lights"] = json!({"type": "point"}));
    assert!(message.starts_with("the file: its lights is an object, but must be an array"), "{message}");
}
