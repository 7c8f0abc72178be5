use super::*;

#[test]
fn every_built_in_opens_by_its_name_and_only_those() {
    for built_in in BUILT_IN {
        let scene = Scene::open(built_in.name).unwrap();
        assert_eq!(scene.name, built_in.name);
        assert!(scene.triangle_count() >= 8);
        assert!(!built_in.description.contains("  "), "{}", built_in.description);
        for object in &scene.objects {
            let mesh = &object.mesh;
            assert_eq!(mesh.normals.len(), mesh.positions.len());
            assert!(mesh.normals.iter().all(|normal| normal.is_normalized()));
            assert_eq!(mesh.triangles().count(), mesh.triangle_count());
        }
    }
}

#[test]
fn built_in_materials_have_their_minerals_indices() {
    for (name, ior) in
        [("brilliant", 2.41749), ("octahedron", 2.41749), ("step_cut", 1.577), ("prism", 1.54428), ("bunny_stone", 1.5)]
    {
        assert_eq!(Scene::named(name).unwrap().objects[0].material.ior, ior);
    }
}

#[test]
fn built_in_cameras_frame_their_stones_tightly() {
    for built_in in BUILT_IN {
        let scene = Scene::named(built_in.name).unwrap();
        let camera = scene.camera;
        let forward = (camera.target - camera.eye).normalize();
        let right = forward.cross(camera.up);
        let half = (0.5 * camera.vertical_fov).tan();
        let seen = |axis: Vec3| {
            let across = vertices(&scene.objects).map(|p| p - camera.eye);
            let across = across.map(|p| p.dot(axis) / (p.dot(forward) * half));
            0.5 * (across.clone().fold(f32::MIN, f32::max) - across.fold(f32::MAX, f32::min))
        };
        let (height, width) = (seen(camera.up), seen(right));
        assert!((0.55..=0.76).contains(&height), "{}: height {height}", built_in.name);
        assert!(width <= 0.91, "{}: width {width}", built_in.name);
        assert!((25.0..30.0).contains(&camera.vertical_fov.to_degrees()));
    }
}

#[test]
fn the_brilliant_is_seen_from_27_degrees_off_its_table() {
    let camera = Scene::named("brilliant").unwrap().camera;
    let back = (camera.eye - camera.target).normalize();
    assert!((back.y.acos().to_degrees() - 27.0).abs() < 0.01);
}

#[test]
fn misspelt_names_get_the_nearest() {
    for (name, nearest) in
        [("briliant", "brilliant"), ("octaeder", "octahedron"), ("stepcut", "step_cut"), ("bunny", "bunny_stone")]
    {
        let message = Scene::open(name).unwrap_err().to_string();
        assert!(message.contains(&format!("did you mean {nearest}?")), "{message}");
    }
    for odd in ["", "\n", "💎"] {
        let message = Scene::open(odd).unwrap_err().to_string();
        assert!(message.starts_with("no scene is called") && !message.contains('\n'));
    }
}

#[test]
fn what_looks_like_a_file_is_opened_as_one() {
    for missing in ["briliant.glb", "./brilliant", "stones/a.GLTF"] {
        let message = Scene::open(missing).unwrap_err().to_string();
        assert!(message.starts_with(&format!("{missing}: the file cannot be read")), "{message}");
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("stone.glb");
    let octahedron = Scene::named("octahedron").unwrap();
    std::fs::write(&path, glb::write(&octahedron).unwrap()).unwrap();
    let opened = Scene::open(path.to_str().unwrap()).unwrap();
    assert_eq!(opened.objects, octahedron.objects);
}

#[test]
fn bounds_hold_everything() {
    let scene = Scene::named("octahedron").unwrap();
    let bounds = scene.bounds();
    assert_eq!((bounds.centre(), bounds.max), (Vec3::ZERO, Vec3::ONE));
    assert!((bounds.radius() - 3f32.sqrt()).abs() < 1e-6);
    assert_eq!(Bounds::of([]).radius(), 0.0);
}
