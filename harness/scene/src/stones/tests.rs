use super::*;
use crate::built_in::framing::framed;
use crate::convex::planes_of_convex;
use crate::cuts::{BrilliantParameters, StepCutParameters, octahedron, round_brilliant, step_cut};
use crate::{Averaging, Material, Preset};
use glam::{DMat4, DQuat, DVec3, Vec3};

fn cuts() -> [Mesh; 3] {
    let cuts = [
        round_brilliant(&BrilliantParameters::TOLKOWSKY).unwrap(),
        step_cut(&StepCutParameters::EMERALD).unwrap(),
        octahedron().unwrap(),
    ];
    cuts.map(|cut| cut.to_mesh(Averaging::Angle))
}

/// Stones of three cuts around a finger.
fn stones(count: usize) -> Vec<Mesh> {
    let cuts = cuts();
    let stone = |k: usize| {
        let turn = DQuat::from_rotation_z(std::f64::consts::TAU * k as f64 / count as f64);
        let scale = DVec3::splat(1.0 - 0.5 * k as f64 / count as f64);
        let radius = count as f64;
        cuts[k % 3].transformed(DMat4::from_scale_rotation_translation(
            scale,
            turn,
            turn * DVec3::new(radius, 0.0, 0.0),
        ))
    };
    (0..count).map(stone).collect()
}

fn diamond() -> Material {
    Preset::named("diamond").expect("a preset").material(1.0)
}

fn scene(objects: Vec<Object>) -> Scene {
    framed("ring", objects, Vec3::Z)
}

fn joined(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    meshes.iter().for_each(|mesh| all.append(mesh));
    all
}

/// What a node scales by 0 keeps its name, by which it is told that nothing of it is drawn.
#[test]
fn a_body_without_area_stays() {
    let [mesh, ..] = cuts();
    for scale in [Vec3::ZERO, Vec3::X] {
        let mut flat = mesh.clone();
        flat.positions.iter_mut().for_each(|position| *position *= scale);
        let mut scene =
            scene(vec![Object::new("a", flat.clone(), diamond()), Object::new("b", mesh.clone(), diamond())]);
        scene.part_stones(|_| false);
        assert_eq!(scene.objects.len(), 2);
        assert_eq!((&*scene.objects[0].name, &scene.objects[0].mesh), ("a", &flat));
    }
}

#[test]
fn fifty_three_stones_in_one_mesh_are_three_bodies() {
    let stones = stones(53);
    let mut scene = scene(vec![
        Object::new("band", cuts()[2].clone(), Material::standard()),
        Object::new("ring", joined(&stones), diamond()),
    ]);
    let before = scene.objects[1].mesh.volume_and_area().0;
    let parting = scene.part_stones(|_| false);
    let names: Vec<&str> = scene.objects.iter().map(|object| &*object.name).collect();
    assert_eq!(names, ["band", "ring stones 1", "ring stones 2", "ring stones 3"]);
    assert_eq!(parting.origins, [0, 1, 1, 1]);
    let counts: Vec<usize> =
        scene.objects[1..].iter().map(|object| object.copies.as_ref().unwrap().places.len()).collect();
    assert_eq!(counts, [18, 18, 17]);
    let after: f64 = scene.objects[1..].iter().map(|object| object.mesh.volume_and_area().0).sum();
    assert!((after / before - 1.0).abs() < 1e-5, "{after} of {before}");
    for object in &scene.objects[1..] {
        assert!(planes_of_convex(object.shape()).is_some());
        assert!(object.materials().all(|material| material == diamond()));
    }
    let [note] = &parting.notes[..] else { panic!("{:?}", parting.notes) };
    assert_eq!(
        note.to_string(),
        "object `ring`: 53 closed parts in one mesh, drawn as 3 bodies, those of one shape as copies"
    );
    // What is parted stays so.
    let again = scene.clone();
    assert!(scene.part_stones(|_| false).notes.is_empty());
    assert_eq!(scene, again);
}

#[test]
fn stones_of_separate_nodes_are_copies_if_shape_and_material_are_the_same() {
    let other = Preset::named("ruby").expect("a preset").material(1.0);
    let objects = stones(20).into_iter().enumerate().map(|(k, mesh)| {
        let material = if k < 15 { Material { name: format!("gem {k}"), ..diamond() } } else { other.clone() };
        Object::new(format!("stone {k}"), mesh, material)
    });
    let mut scene = scene(objects.collect());
    let parting = scene.part_stones(|object| object.name == "stone 4");
    let counts: Vec<(&str, usize)> = scene
        .objects
        .iter()
        .map(|object| (&*object.name, object.copies.as_ref().map_or(1, |copies| copies.places.len())))
        .collect();
    let expected = [
        ("stone 0", 5),
        ("stone 1", 4),
        ("stone 2", 5),
        ("stone 4", 1),
        ("stone 15", 2),
        ("stone 16", 2),
        ("stone 17", 1),
    ];
    assert_eq!(counts, expected);
    assert_eq!(parting.origins, [0, 1, 2, 4, 15, 16, 17]);
    assert_eq!(parting.notes.len(), 5);
    assert_eq!(
        parting.notes[0].to_string(),
        "5 objects, first `stone 0`: one shape and material, turned and scaled, drawn as 5 copies"
    );
}

#[test]
fn opaque_bodies_and_panes_are_left_alone() {
    let all = joined(&stones(6));
    let pane = Material { thickness: 0.0, ..diamond() };
    let mut scene =
        scene(vec![Object::new("metal", all.clone(), Material::standard()), Object::new("pane", all, pane)]);
    let before = scene.clone();
    assert!(scene.part_stones(|_| false).notes.is_empty());
    assert_eq!(scene, before);
}

#[test]
fn primitives_that_close_one_another_are_one_stone() {
    let [stone, ..] = cuts();
    let is_crown = |corners: &&[u32]| corners.iter().any(|&corner| stone.positions[corner as usize].y > 0.1);
    let (crown, pavilion): (Vec<&[u32]>, Vec<&[u32]>) = stone.indices.chunks_exact(3).partition(is_crown);
    let half = |triangles: Vec<&[u32]>| Mesh { indices: triangles.concat(), ..stone.clone() };
    let named = |name: &str| Material { name: name.to_owned(), ..diamond() };
    let mut scene = scene(vec![
        Object::new("stone / 0", half(crown.clone()), named("crown")),
        Object::new("stone / 1", half(pavilion), named("pavilion")),
        Object::new("open / 0", half(crown[..crown.len() / 2].to_vec()), named("crown")),
    ]);
    let parting = scene.part_stones(|_| false);
    assert_eq!(scene.objects.len(), 2, "{:?}", parting.notes);
    assert_eq!(planes_of_convex(&scene.objects[0].mesh).map(|planes| planes.len()), Some(73));
    assert!(
        parting
            .notes
            .iter()
            .any(|note| note.to_string().starts_with("2 objects, first `stone / 0`: open, of materials"))
    );
}

/// Many different shapes in one mesh stay one body.
#[test]
fn a_mesh_of_many_shapes_stays_together() {
    let [_, _, stone] = cuts();
    let place = |k: usize| {
        let scale = DVec3::new(1.0, 1.0 + 0.01 * k as f64, 2.0 - 0.003 * k as f64);
        stone.transformed(DMat4::from_scale_rotation_translation(scale, DQuat::IDENTITY, DVec3::X * 5.0 * k as f64))
    };
    let all: Vec<Mesh> = (0..=MOST_BODIES).map(place).collect();
    let mut many = scene(vec![Object::new("many", joined(&all), diamond())]);
    many.part_stones(|_| false);
    assert_eq!(many.objects.len(), 1);
    let mut fewer = scene(vec![Object::new("fewer", joined(&all[1..]), diamond())]);
    fewer.part_stones(|_| false);
    assert_eq!((fewer.objects.len(), &*fewer.objects[9].name), (MOST_BODIES, "fewer stone 10"));
}

/// Coordinates of up to 100 are rounded by 4e-6, which is too much for planes: the mean of many has less.
#[test]
fn stones_far_from_the_origin_are_convex_by_their_mean() {
    let [brilliant, ..] = cuts();
    let place = |k: usize| {
        let (k, turn) = (k as f64, DQuat::from_euler(glam::EulerRot::ZXY, 0.3 * k as f64, 0.7 * k as f64, 0.0));
        let at = DVec3::new(3.0 * (k % 32.0), 0.0, 3.0 * (k / 32.0).floor());
        brilliant.transformed(DMat4::from_rotation_translation(turn, at))
    };
    let all: Vec<Mesh> = (0..1024).map(place).collect();
    // About a corner of its own, hardly one is convex any more.
    let own = |mesh: &Mesh| mesh.transformed(DMat4::from_translation(-mesh.positions[0].as_dvec3()));
    let convex = all.iter().filter(|mesh| planes_of_convex(&own(mesh)).is_some()).count();
    assert!(convex < all.len() / 2, "{convex}");
    let mut scene = scene(vec![Object::new("field", joined(&all), diamond())]);
    scene.part_stones(|_| false);
    let copies = scene.objects[0].copies.as_ref().expect("copies");
    let shape = &copies.shape;
    assert_eq!(
        (copies.places.len(), planes_of_convex(shape).map(|planes| planes.len())),
        (1024, Some(73)),
        "{}",
        crate::convex::obstacle(shape)
    );
}
