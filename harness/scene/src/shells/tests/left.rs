//! What is no fault, or none of which the mend is certain, is left as it is.

use super::*;

fn left(mesh: &Mesh) -> Shells {
    let mut shells = Shells::of(mesh).expect("small");
    shells.close();
    shells
}

#[test]
fn a_hollow_body_keeps_its_cavity() {
    let outer = cube(Vec3::splat(-1.0), 2.0);
    let inner = cube(Vec3::splat(-0.5), 1.0);
    for inner in [inner.clone(), turned(&inner)] {
        let hollow = joined(&[outer.clone(), inner]);
        let shells = left(&hollow);
        assert!(shells.is_as_given(), "{}", shells.mends);
        assert_eq!(shells.solids, [hollow]);
    }
    // Inside out, both shells are turned, so that the cavity stays one.
    let hollow = joined(&[outer, turned(&inner)]);
    let shells = left(&turned(&hollow));
    assert_eq!((shells.mends, shells.solids.len()), (Mends { inverted: 1, ..Mends::default() }, 1));
    assert!((shells.solids[0].volume_and_area().0 - 7.0).abs() < 1e-6);
}

#[test]
fn an_opening_that_is_not_flat_stays_open() {
    for good in stones() {
        // A facet and a neighbour over an edge.
        let facets = crate::Convex::of_mesh(&good).expect("convex");
        let corners: Vec<[Vec3; 3]> = good.triangles().collect();
        let first = facets.face_of_triangle[0];
        let shared = |one: &[Vec3; 3], other: &[Vec3; 3]| one.iter().filter(|corner| other.contains(corner)).count();
        let beyond = corners.iter().zip(&facets.face_of_triangle);
        let mut beyond = beyond.filter(|(other, face)| **face != first && shared(&corners[0], other) == 2);
        let second = *beyond.next().expect("a neighbour").1;
        let mut mesh = good.clone();
        let shares = |face: u32| face == first || face == second;
        let kept = good.indices.chunks_exact(3).zip(&facets.face_of_triangle).filter(|(_, face)| !shares(**face));
        mesh.indices = kept.flat_map(|(corners, _)| corners).copied().collect();
        let shells = left(&mesh);
        assert!(shells.mends.is_none() && shells.solids.is_empty() && !shells.open.is_empty(), "{}", shells.mends);
    }
}

#[test]
fn a_pane_is_no_solid() {
    let mut pane = cube(Vec3::ZERO, 1.0);
    pane.indices.truncate(6);
    let shells = left(&pane);
    assert!(shells.mends.is_none() && shells.solids.is_empty() && shells.open.len() == 1);
}

/// A bowl of one surface: closed by a disc it would not be convex.
#[test]
fn a_bowl_is_not_filled() {
    let mut bowl = joined(&[sphere(1.0, 16), turned(&sphere(0.9, 16))]);
    let corners =
        |triangle: &[u32]| triangle.iter().map(|&corner| bowl.positions[corner as usize].y).fold(f32::MIN, f32::max);
    bowl.indices = bowl.indices.chunks_exact(3).filter(|triangle| corners(triangle) < 0.3).flatten().copied().collect();
    let shells = left(&bowl);
    assert_eq!((shells.mends.closed, shells.solids.len()), (0, 0), "{}", shells.mends);
}

/// A sheet through the surface is no inner face.
#[test]
fn a_sheet_through_a_stone_stays() {
    for good in stones() {
        let mut mesh = good.clone();
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([Vec3::new(0.0, 0.05, 0.0), Vec3::new(-9.0, 0.1, 0.0), Vec3::new(0.0, -0.1, 0.0)]);
        mesh.normals.extend([Vec3::Z; 3]);
        mesh.indices.extend([first, first + 1, first + 2]);
        let shells = left(&mesh);
        assert!(shells.mends.is_none());
        assert_eq!((shells.solids, shells.open.len()), (vec![good], 1));
    }
}
