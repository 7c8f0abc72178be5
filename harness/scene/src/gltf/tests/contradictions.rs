//! Files that contradict themselves are refused, with the part that does.

use super::refusals::refused;
use super::*;

#[test]
fn a_node_has_a_matrix_or_its_parts() {
    let identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
    for (part, value) in
        [("translation", json!([0, 0, 0])), ("rotation", json!([0, 0, 0, 1])), ("scale", json!([2, 2, 2]))]
    {
        let node = json!({"mesh": 0, "name": "stone", "matrix": identity, part: value});
        refused("/nodes/0", node, &format!("node 0 \"stone\": it has a matrix and a {part}"));
    }
    for place in [3, 7, 11, 15] {
        let mut matrix = identity.map(f64::from);
        matrix[place] += 0.5;
        refused("/nodes/0", json!({"mesh": 0, "matrix": matrix}), "node 0: its matrix has the last row");
        // The rounding of a product of matrices.
        matrix[place] = identity[place] as f64 + 1e-8;
        let scene = load_changed(|d| d["nodes"][0] = json!({"mesh": 0, "matrix": matrix})).unwrap();
        assert_eq!(only_mesh(&scene).positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    }
}

#[test]
fn a_rotation_has_a_direction() {
    refused("/nodes/0", json!({"mesh": 0, "rotation": [0, 0, 0, 0]}), "node 0: its rotation is 0, 0, 0, 0");
    // Whatever its length.
    let scene = load_changed(|d| d["nodes"][0]["rotation"] = json!([0, 1e-30, 0, 1e-30])).unwrap();
    assert!(only_mesh(&scene).positions[1].abs_diff_eq(Vec3::NEG_Z, 1e-6));
}

#[test]
fn a_camera_sees_something_between_near_and_far() {
    let with = |znear: f32, zfar: f32| {
        load_changed(|d| {
            d["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": znear, "zfar": zfar}}]);
            d["nodes"][0]["camera"] = json!(0);
        })
    };
    for zfar in [0.5, 1.0] {
        let message = with(1.0, zfar).unwrap_err().to_string();
        assert!(
            message.starts_with(&format!("camera 0: its zfar is {zfar}, but must be above its znear, 1")),
            "{message}"
        );
    }
    with(1.0, 2.0).unwrap();
}
