//! Cameras of a file, and which one is taken.

use super::*;
use crate::clip_from_world;

fn with_cameras(which: Option<&str>) -> Result<Scene, SceneError> {
    let mut document = document();
    document["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    document["nodes"] = json!([
        {"mesh": 0},
        {"camera": 1, "translation": [0, 0, 5], "scale": [2, 2, 2]},
        {"camera": 2, "name": "Top"},
        {"camera": 0, "translation": [0.25, 0.5, 3], "name": "Front"},
    ]);
    document["cameras"] = json!([
        {"type": "orthographic", "name": "plan", "orthographic": {"xmag": 1, "ymag": 0.75, "zfar": 9, "znear": 1}},
        {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}},
        {"type": "perspective", "name": "close", "perspective": {"yfov": 0.7, "znear": 0.1}},
    ]);
    let opening = Opening { camera: which.map(str::to_owned), ..Opening::default() };
    parse_as(&file(&document, &binary()), None, &opening)
}

#[test]
fn the_first_camera_is_taken() {
    let camera = with_cameras(None).unwrap().camera;
    assert_eq!((camera.eye, camera.up, camera.vertical_fov), (Vec3::Z * 5.0, Vec3::Y, 0.6));
    assert_eq!(camera.target, Vec3::ZERO);
}

#[test]
fn a_camera_is_chosen_by_its_name_its_nodes_or_its_number() {
    for (which, fov) in [("close", 0.7), ("Top", 0.7), ("2", 0.7), ("1", 0.6)] {
        let scene = with_cameras(Some(which)).unwrap();
        assert_eq!(scene.camera.vertical_fov, fov, "{which}");
        assert!(
            scene.lacking.clauses().iter().all(|clause| !clause.starts_with("cameras")),
            "{:?}",
            scene.lacking.clauses()
        );
    }
    let error = with_cameras(Some("side")).unwrap_err().to_string();
    assert_eq!(error, r#"its scene has no camera `side`; it has camera 1, camera 2 "close", camera 0 "plan""#);
    let opening = Opening { camera: Some("0".to_owned()), ..Opening::default() };
    let error = parse_as(&file(&document(), &binary()), None, &opening).unwrap_err().to_string();
    assert_eq!(error, "its scene has no camera `0`; it has none: leave the camera out");
}

/// Off its place by at most half a pixel of 1024, for points within the radius of the scene.
#[test]
fn an_orthographic_camera_shows_no_perspective() {
    let scene = with_cameras(Some("Front")).unwrap();
    let clip = clip_from_world(&scene, 640, 480);
    let centre = scene.bounds().centre();
    let radius = scene.bounds().radius();
    for z in [-radius, 0.0, radius] {
        for (x, y) in [(-0.75, -0.25), (0.25, 0.5), (1.25, 1.25), (0.75, -0.25)] {
            let [right, up] = [(x - 0.25) / (0.75 * 640.0 / 480.0), (y - 0.5) / 0.75];
            let seen = clip.project_point3(Vec3::new(x, y, centre.z + z));
            assert!((seen.x - right).abs() <= 1e-3 && (seen.y - up).abs() <= 1e-3, "{seen} {right} {up}");
        }
    }
}

#[test]
fn an_orthographic_camera_without_height_is_refused() {
    for ymag in [0.0, 1e30] {
        let error = load_changed(|d| {
            d["scenes"][0]["nodes"] = json!([0, 1]);
            d["nodes"] = json!([{"mesh": 0}, {"camera": 0}]);
            d["cameras"] = json!([
                {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": ymag, "zfar": 9, "znear": 1}},
            ]);
        });
        let error = error.unwrap_err().to_string();
        assert!(error.starts_with("camera 0: its ymag is "), "{error}");
    }
}
