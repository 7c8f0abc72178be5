use glam::Vec2;

use lapidary_scene::{Encoding, Texels, Texture};

use super::*;

#[test]
fn the_hand_written_seed_reaches_what_it_says() {
    let [_, document, _] = seeds().unwrap();
    let scene = gltf::parse(&document, None).unwrap();
    assert_eq!(scene.lights.len(), 3);
    let textured = scene.objects.iter().filter(|object| !object.mesh.uvs.is_empty());
    // Two of the mesh's three primitives, at two nodes.
    assert_eq!((scene.objects.len(), textured.count()), (6, 4));
    assert!(scene.objects.iter().any(|object| object.material.medium.is_some() && object.material.sigma0.is_some()));
}

#[test]
fn the_textured_seed_has_what_it_says() {
    let [.., textured] = seeds().unwrap();
    let scene = gltf::parse(&textured, None).unwrap();
    let object = &scene.objects[0];
    assert!(!object.mesh.colors.is_empty() && object.material.textures().count() == 5);
    let sizes = object.material.textures().map(|(_, texture)| (texture.texels.width(), texture.texels.height()));
    assert_eq!(sizes.filter(|size| *size == (16, 8)).count(), 2, "two textures are in JPEG");
}

/// What is packed is read: no seed loses its image, or has an extension that is not known.
#[test]
fn the_packed_seeds_have_what_they_say() {
    let scenes: Vec<Scene> = packed().unwrap().iter().map(|seed| gltf::parse(seed, None).unwrap()).collect();
    assert!(scenes.iter().all(|scene| scene.lacking.clauses().is_empty()));
    let with_images = scenes.iter().filter(|scene| scene.objects[0].material.base_color_texture.is_some());
    assert_eq!((scenes.len(), with_images.count()), (11, 6));
}

#[test]
fn seeds_are_valid() {
    for seed in seeds().unwrap().into_iter().chain(packed().unwrap()) {
        assert_eq!(check(&seed), Ok(true), "{:?}", gltf::parse(&seed, None));
    }
}

#[test]
fn loader_survives_mutated_bytes() {
    let tally = run(SUITE_CASES).unwrap();
    assert_eq!(tally.loaded + tally.refused, SUITE_CASES);
    // A fuzzer whose files all fail at the first check, or never fail, checks nothing.
    assert!(tally.loaded > SUITE_CASES / 20, "{tally:?}");
    assert!(tally.refused > SUITE_CASES / 4, "{tally:?}");
}

#[test]
#[ignore = "minutes"]
fn loader_survives_many_mutated_bytes() {
    let tally = run(LONG_CASES).unwrap();
    assert_eq!(tally.loaded + tally.refused, LONG_CASES);
}

#[test]
fn every_kind_of_edit_changes_the_file() {
    let [seed, ..] = seeds().unwrap();
    let mut runner = TestRunner::deterministic();
    let mut kinds = std::collections::HashMap::new();
    for _ in 0..500 {
        let tree = proptest::strategy::Strategy::new_tree(&edits(), &mut runner).unwrap();
        for edit in proptest::strategy::ValueTree::current(&tree) {
            let changed = mutate(&seed, std::slice::from_ref(&edit)) != seed;
            *kinds.entry(std::mem::discriminant(&edit)).or_insert(0) += i32::from(changed);
        }
    }
    assert_eq!(kinds.len(), 5);
    assert!(kinds.values().all(|&changes| changes > 20), "{kinds:?}");
}

#[test]
fn a_scene_that_breaks_a_promise_is_noticed() {
    let good = Scene::named("octahedron").unwrap();
    assert_eq!(check_scene(&good, 1_000), Ok(()));
    let crowd = vec![good.objects[0].clone(); gltf::MAX_OBJECTS as usize + 1];
    assert!(check_scene(&Scene { objects: crowd, ..good.clone() }, 1_000).unwrap_err().contains("bytes of mesh"));
    let broken = |change: fn(&mut Scene)| {
        let mut scene = good.clone();
        change(&mut scene);
        check_scene(&scene, 1_000).is_err()
    };
    assert!(broken(|scene| scene.objects[0].mesh.indices[0] = 6));
    assert!(broken(|scene| scene.objects[0].mesh.positions[0].x = f32::NAN));
    assert!(broken(|scene| scene.camera.target = scene.camera.eye));
    assert!(broken(|scene| scene.objects[0].material.attenuation_distance = 0.0));
    assert!(broken(|scene| scene.objects[0].mesh.uvs = vec![Vec2::ZERO]));
    assert!(broken(|scene| scene.objects[0].mesh.uvs = vec![Vec2::NAN; scene.objects[0].mesh.positions.len()]));
    assert!(broken(|scene| scene.objects[0].mesh.colors = vec![Vec3::ONE]));
    assert!(
        broken(|scene| scene.objects[0].mesh.colors = vec![2.0 * Vec3::ONE; scene.objects[0].mesh.positions.len()])
    );
    assert!(broken(|scene| {
        let texels = Texels::new(1, 1, vec![0; 4]).unwrap();
        scene.objects[0].material.normal_texture = Some(Texture::new(texels.into(), Encoding::Linear));
    }));
    assert!(broken(|scene| scene.lights = vec![Light::Directional { toward: Vec3::ZERO, irradiance: Vec3::ONE }]));
}
