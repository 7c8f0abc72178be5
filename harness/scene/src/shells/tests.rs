use super::*;
use crate::convex::planes_of_convex;
use crate::cuts::{BrilliantParameters, StepCutParameters, octahedron, round_brilliant, step_cut};
use crate::surfaces::sphere;
use crate::{Averaging, Bounds, MeshDiagnosis};
use glam::{DQuat, Vec3};

mod faults;
mod left;

/// Stones whose facets, cut into triangles, share no vertices, as exporters write flat shading.
fn stones() -> [Mesh; 3] {
    let cuts = [
        round_brilliant(&BrilliantParameters::TOLKOWSKY).unwrap(),
        step_cut(&StepCutParameters::EMERALD).unwrap(),
        octahedron().unwrap(),
    ];
    cuts.map(|cut| flat(&cut.to_mesh(Averaging::Angle)))
}

/// Returns a mesh with a vertex for each corner of each triangle.
fn flat(mesh: &Mesh) -> Mesh {
    let triangles: Vec<[Vec3; 3]> = mesh.triangles().collect();
    let normal = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).normalize_or(Vec3::Y);
    Mesh {
        positions: triangles.iter().flatten().copied().collect(),
        normals: triangles.iter().flat_map(|corners| [normal(*corners); 3]).collect(),
        indices: (0..3 * triangles.len() as u32).collect(),
        ..Mesh::default()
    }
}

fn cube(min: Vec3, side: f32) -> Mesh {
    let corner = |index: u32| min + side * Vec3::new((index & 1) as f32, (index >> 1 & 1) as f32, (index >> 2) as f32);
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices = quads.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
    Mesh::with_shared_normals((0..8).map(corner).collect(), indices, Averaging::Angle)
}

fn joined(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    meshes.iter().for_each(|mesh| all.append(mesh));
    all
}

fn turned(mesh: &Mesh) -> Mesh {
    let mut turned = mesh.clone();
    turned.indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(1, 2));
    turned
}

/// Parts and closes a mesh of which all must become solids.
fn solids(mesh: &Mesh) -> (Vec<Mesh>, Mends) {
    let mut shells = Shells::of(mesh).expect("small");
    shells.close();
    assert_eq!(shells.open.len(), 0, "{}", shells.mends);
    (shells.solids, shells.mends)
}

/// Whether two lists of planes are the same but for their order and a tolerance.
fn same_planes(one: &Mesh, other: &Mesh, tolerance: f64) -> bool {
    let planes = |mesh: &Mesh| planes_of_convex(mesh).expect("convex");
    let (one, other) = (planes(one), planes(other));
    let near = |plane: &crate::polyhedron::Plane, all: &[crate::polyhedron::Plane]| {
        let away = |other: &crate::polyhedron::Plane| {
            plane.normal.distance(other.normal).max((plane.distance - other.distance).abs())
        };
        all.iter().any(|other| away(other) <= tolerance)
    };
    one.len() == other.len() && one.iter().all(|plane| near(plane, &other))
}

/// A mesh that is the same solid as `good`, after a mend that may move corners by rounding.
fn assert_is(mended: &Mesh, good: &Mesh, what: &str) {
    assert!(MeshDiagnosis::of(mended).is_solid(), "{what}: {:?}", MeshDiagnosis::of(mended));
    let (volume, expected) = (mended.volume_and_area().0, good.volume_and_area().0);
    assert!((volume - expected).abs() <= 1e-6 * expected, "{what}: {volume}, not {expected}");
    assert!(same_planes(mended, good, 1e-5), "{what}");
}

#[test]
fn a_sound_stone_is_as_given() {
    for stone in stones() {
        let shells = Shells::of(&stone).expect("small");
        assert!(shells.is_as_given() && shells.solids.len() == 1, "{}", shells.mends);
        assert_eq!(shells.solids[0], stone);
    }
}

#[test]
fn stones_that_touch_at_a_corner_an_edge_or_a_face_are_parted() {
    let first = cube(Vec3::ZERO, 1.0);
    for (what, min) in [("a corner", Vec3::ONE), ("an edge", Vec3::new(1.0, 1.0, 0.0)), ("a face", Vec3::X)] {
        let both = [first.clone(), cube(min, 1.0)];
        let (found, mends) = solids(&joined(&both));
        assert!(mends.is_none(), "{what}: {mends}");
        assert_eq!(found, both, "{what}");
        // So it is if one face is cut into triangles along the other diagonal, and with all corners shared.
        let mut other = both[1].clone();
        for quad in other.indices.chunks_exact_mut(6) {
            let [a, b, c, d] = [quad[0], quad[1], quad[2], quad[5]];
            quad.copy_from_slice(&[b, c, d, b, d, a]);
        }
        let (found, _) = solids(&joined(&[first.clone(), other.clone()]));
        assert_eq!(found, [first.clone(), other], "{what}");
    }
}

#[test]
fn ten_thousand_stones_are_parted_within_seconds() {
    let stone = &stones()[0];
    let place = |k: i32| {
        stone.placed(
            DQuat::from_rotation_y(f64::from(k)),
            glam::DVec3::new(f64::from(k % 100) * 2.5, 0.0, f64::from(k / 100) * 2.5),
        )
    };
    let count = if cfg!(debug_assertions) { 1000 } else { 10_000 };
    let all: Vec<Mesh> = (0..count).map(place).collect();
    let begun = std::time::Instant::now();
    let (found, mends) = solids(&joined(&all));
    assert!(begun.elapsed().as_secs_f64() < 10.0, "{:?}", begun.elapsed());
    assert_eq!(found.len(), all.len(), "{mends}");
    let bounds = Bounds::of(found[1].positions.iter().copied());
    assert!(bounds.radius() < 3.0);
}
