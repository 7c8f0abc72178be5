//! Which bodies of a scene get exact facets.

use glam::{Quat, Vec3};

use super::*;
use crate::cuts::{BrilliantParameters, round_brilliant};
use crate::surfaces::sphere;
use crate::{Averaging, Bounds, Material, Place};

/// Returns a mesh whose corners are rounded to 12 bits of its box.
fn rounded(mut mesh: Mesh) -> Mesh {
    let bounds = Bounds::of(mesh.positions.iter().copied());
    let step = (bounds.max - bounds.min) / 4095.0;
    mesh.positions.iter_mut().for_each(|p| *p = bounds.min + ((*p - bounds.min) / step).round() * step);
    mesh
}

fn brilliant() -> Mesh {
    rounded(round_brilliant(&BrilliantParameters::TOLKOWSKY).unwrap().to_mesh(Averaging::Angle))
}

/// Returns a mesh with each triangle's normal at its corners, to a byte.
fn flat(mesh: &Mesh) -> Mesh {
    let positions: Vec<Vec3> = mesh.triangles().flatten().collect();
    let normal = |[a, b, c]: [Vec3; 3]| ((b - a).cross(c - a).normalize_or_zero() * 127.0).round() / 127.0;
    let normals = mesh.triangles().flat_map(|corners| [normal(corners); 3]).map(|n| n.normalize_or(Vec3::Y)).collect();
    Mesh { normals, indices: (0..positions.len() as u32).collect(), positions, ..Mesh::default() }
}

fn scene(mesh: Mesh, material: Material) -> Scene {
    let mut scene = Scene::named("brilliant").unwrap();
    scene.objects = vec![Object::new("stone", mesh, material)];
    scene
}

fn glass() -> Material {
    Scene::named("brilliant").unwrap().objects.remove(0).material
}

#[test]
fn rounded_cuts_become_convex_with_averaged_and_with_flat_normals() {
    for mesh in [brilliant(), flat(&brilliant())] {
        assert_eq!(planes_of_convex(&mesh), None);
        let mut scene = scene(mesh, glass());
        let notes = scene.recover_stones();
        assert_eq!(planes_of_convex(&scene.objects[0].mesh).map(|planes| planes.len()), Some(73));
        let line = notes.iter().map(ToString::to_string).collect::<String>();
        assert!(line.starts_with("object `stone`: convex but for rounding, drawn with 73 exact facets"), "{line}");
        assert_eq!(scene.recover_stones(), []);
    }
}

#[test]
fn copies_share_the_recovered_shape() {
    let place =
        Place { rotation: Quat::from_rotation_x(0.3), scale: 2.0, translation: Vec3::splat(5.0), ..Place::IDENTITY };
    let copies = Copies { shape: brilliant(), places: vec![Place::IDENTITY, place] };
    let mut scene = scene(Mesh::default(), glass());
    scene.objects = vec![Object::of_copies("pair", copies, glass())];
    assert_eq!(scene.recover_stones().len(), 1);
    let pair = &scene.objects[0];
    assert_eq!(planes_of_convex(pair.shape()).map(|planes| planes.len()), Some(73));
    assert_eq!(pair.mesh, pair.copies.as_ref().unwrap().joined());
}

#[test]
fn round_opaque_and_painted_bodies_stay() {
    let round = rounded(sphere(1.0, 24));
    for (mesh, material) in [
        (round, glass()),
        (brilliant(), Material::standard()),
        (brilliant(), Material { normals: Normals::File, ..glass() }),
        (Mesh { colors: vec![Vec3::ONE; brilliant().positions.len()], ..brilliant() }, glass()),
    ] {
        let mut scene = scene(mesh.clone(), material);
        assert_eq!(scene.recover_stones(), []);
        assert_eq!(scene.objects[0].mesh, mesh);
    }
}

/// What is nearly convex and keeps its mesh is named, with the reason; a round body is not.
#[test]
fn what_is_nearly_convex_and_stays_is_told() {
    let dented = |mut mesh: Mesh| {
        // The highest corner, by a fiftieth of the diagonal, so that no hull of it is near.
        let highest = mesh.positions.iter().copied().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap();
        mesh.positions.iter_mut().filter(|p| **p == highest).for_each(|p| p.y -= 0.05);
        mesh
    };
    let told = |meshes: Vec<Mesh>| {
        let mut scene = scene(Mesh::default(), glass());
        scene.objects = meshes.into_iter().map(|mesh| Object::new("stone", mesh, glass())).collect();
        scene.recover_stones().iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let mesh = flat(&dented(brilliant()));
    let why = recover(&mesh).unwrap_err();
    assert!(why.is_nearly(), "{why}");
    let line =
        format!("2 objects, first `stone`: nearly convex, but drawn as modelled, at several times the time: {why}");
    assert_eq!(told(vec![mesh.clone(), mesh]), [line]);
    let round = dented(sphere(1.0, 24));
    assert!(recover(&round).unwrap_err().is_nearly());
    assert!(told(vec![round]).is_empty());
}
