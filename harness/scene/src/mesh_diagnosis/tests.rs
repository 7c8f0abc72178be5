use super::*;
use crate::surfaces::{sphere, torus};
use crate::{Averaging, BUILT_IN, Scene};
use glam::Vec3;

#[test]
fn seams_and_poles_are_no_openings() {
    for mesh in [sphere(40.0, 64), torus(20.0, 7.0, 40, 20)] {
        assert_eq!(open_edges(&mesh), 0);
        // A comparison of bits alone would leave openings.
        assert!(
            mesh.positions.iter().any(|p| {
                p.abs().max_element() > 1.0 && p.abs().min_element() > 0.0 && p.abs().min_element() < 1e-10
            })
        );
    }
}

#[test]
fn every_built_in_is_sound() {
    for built_in in BUILT_IN {
        for object in Scene::named(built_in.name).expect("built in").objects {
            let found = MeshDiagnosis::of(&object.mesh);
            if built_in.name.ends_with("head") {
                // A scan as it is: closed, with a few triangles without an area or twice.
                let expected = MeshDiagnosis { doubled: 2, degenerate: 7, ..MeshDiagnosis::of(&sphere(1.0, 8)) };
                assert_eq!(found, expected, "{}", built_in.name);
                continue;
            }
            assert!(found.is_solid(), "{} {}: {found:?}", built_in.name, object.name);
            assert_eq!(found.clauses(), [""; 0], "{} {}", built_in.name, object.name);
        }
    }
}

/// Some edges of the dragon belong to four or more triangles, always as many on one side as on the
/// other.
#[test]
fn an_edge_with_an_even_number_of_triangles_is_no_opening() {
    let mesh = &Scene::named("dragon").expect("built in").objects[0].mesh;
    let mut triangles: HashMap<(u32, u32), u32> = HashMap::new();
    for triangle in mesh.indices.chunks_exact(3) {
        for k in 0..3 {
            let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
            *triangles.entry((from.min(to), from.max(to))).or_default() += 1;
        }
    }
    assert!(triangles.values().any(|&count| count > 2) && triangles.values().all(|count| count % 2 == 0));
    assert_eq!(open_edges(mesh), 0);
    let mut opened = mesh.clone();
    opened.indices.truncate(mesh.indices.len() - 3);
    assert_eq!(open_edges(&opened), 3);
}

fn ball() -> Mesh {
    sphere(1.0, 32)
}

#[test]
fn a_missing_triangle_opens_edges_and_a_turned_one_turns_them() {
    let mut mesh = ball();
    let last = mesh.indices.split_off(mesh.indices.len() - 3);
    let opened = MeshDiagnosis::of(&mesh);
    assert_eq!(opened, MeshDiagnosis { open_edges: 3, ..MeshDiagnosis::default() });
    assert!(!opened.is_closed() && opened.clauses() == ["3 edges are open"]);
    mesh.indices.extend([last[0], last[2], last[1]]);
    let turned = MeshDiagnosis::of(&mesh);
    assert_eq!(turned, MeshDiagnosis { turned_edges: 3, ..MeshDiagnosis::default() });
    assert!(!turned.is_closed() && turned.clauses() == ["3 edges join triangles of opposite winding"]);
    assert_eq!((open_edges(&mesh), open_edges(&Mesh::default())), (3, 0));
}

#[test]
fn parts_that_are_inside_out_are_counted_and_cavities_are_not() {
    let inverted = |mesh: &Mesh| {
        let indices = mesh.indices.chunks_exact(3).flat_map(|t| [t[0], t[2], t[1]]).collect();
        Mesh { indices, ..mesh.clone() }
    };
    let found = MeshDiagnosis::of(&inverted(&ball()));
    assert_eq!(found, MeshDiagnosis { inverted_parts: 1, ..MeshDiagnosis::default() });
    assert!(found.is_closed() && !found.is_solid() && found.clauses() == ["1 part is inside out"]);
    let mut hollow = ball();
    hollow.append(&inverted(&sphere(0.5, 32)));
    assert_eq!(MeshDiagnosis::of(&hollow), MeshDiagnosis::default());
    // Far from the origin, where rounding loses a volume measured about it, and next to a sound
    // part.
    let far = |mesh: &Mesh| mesh.placed(glam::DQuat::IDENTITY, DVec3::splat(3000.0));
    let mut two = ball();
    two.append(&far(&inverted(&ball())));
    assert_eq!(MeshDiagnosis::of(&two).inverted_parts, 1);
}

#[test]
fn doubled_degenerate_and_flat_meshes_are_told_apart() {
    let good = ball();
    let mut doubled = good.clone();
    doubled.append(&good);
    let found = MeshDiagnosis::of(&doubled);
    assert_eq!(found, MeshDiagnosis { doubled: good.triangle_count(), ..MeshDiagnosis::default() });
    assert!(found.is_closed() && !found.is_solid());

    let mut degenerate = good.clone();
    let [a, b, _] = [0, 1, 2].map(|k| good.indices[3 * 100 + k]);
    degenerate.indices.extend([a, b, b, a, a, a, a, b, a]);
    let found = MeshDiagnosis::of(&degenerate);
    assert_eq!(found, MeshDiagnosis { degenerate: 3, ..MeshDiagnosis::default() });
    assert!(found.is_solid() && found.clauses() == ["3 triangles have no area"]);

    // A slanted sheet, once without and once with a back; and an empty mesh.
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.3], [1.0, 1.0, 0.7], [0.0, 1.0, 0.4]].map(Vec3::from_array);
    let sheet = |indices: &[u32]| Mesh::with_shared_normals(corners.to_vec(), indices.to_vec(), Averaging::Angle);
    let found = MeshDiagnosis::of(&sheet(&[0, 1, 2, 0, 2, 3]));
    assert!(found.is_flat && found.open_edges == 4 && found.clauses() == ["all corners lie in one plane"], "{found:?}");
    let found = MeshDiagnosis::of(&sheet(&[0, 1, 2, 0, 2, 3, 0, 2, 1, 0, 3, 2]));
    assert!(found.is_flat && found.open_edges == 0 && found.doubled == 2 && !found.is_closed(), "{found:?}");
    assert!(MeshDiagnosis::of(&Mesh::default()).is_flat);
}

#[test]
fn hostile_meshes_are_diagnosed_too() {
    let bent = |positions: Vec<Vec3>, indices: Vec<u32>| {
        let normals = vec![Vec3::Y; positions.len()];
        MeshDiagnosis::of(&Mesh { positions, normals, indices, ..Mesh::default() })
    };
    assert!(bent(vec![Vec3::ZERO; 3], vec![0, 1, 2]).is_flat);
    assert!(bent(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![0, 1, 9]).is_flat);
    let huge = 1e9f32;
    let far = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|p| huge * p).to_vec();
    assert!(bent(far.clone(), vec![0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]).is_solid());
    let tiny = far.iter().map(|p| *p * 1e-30).collect();
    assert!(bent(tiny, vec![0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]).is_solid());
}
