//! Faults inflicted on good stones: the mend gives the stone back.

use super::*;
use proptest::prelude::*;

/// Applies a fault to each stone, at several triangles, and returns what comes of it.
fn with_fault(what: &str, fault: impl Fn(&Mesh, usize) -> Mesh, is_mended: impl Fn(Mends) -> bool) {
    for good in stones() {
        for triangle in [0, good.triangle_count() / 2, good.triangle_count() - 1] {
            let (found, mends) = solids(&fault(&good, triangle));
            assert!(is_mended(mends), "{what}: {mends}");
            assert_eq!(found.len(), 1, "{what}");
            assert_is(&found[0], &good, what);
        }
    }
}

#[test]
fn a_doubled_triangle_is_left_out() {
    let doubled = |good: &Mesh, triangle: usize| {
        let mut mesh = good.clone();
        let again = mesh.indices[3 * triangle..3 * triangle + 3].to_vec();
        mesh.indices.extend(again);
        mesh
    };
    with_fault("doubled", doubled, |mends| mends == Mends { doubled: 1, ..Mends::default() });
}

#[test]
fn a_doubled_triangle_of_the_other_winding_is_left_out() {
    for first in [false, true] {
        let doubled = |good: &Mesh, triangle: usize| {
            let mut mesh = good.clone();
            let [a, b, c] = [0, 1, 2].map(|k| mesh.indices[3 * triangle + k]);
            let again = [a, c, b];
            if first {
                mesh.indices.splice(0..0, again);
            } else {
                mesh.indices.extend(again);
            }
            mesh
        };
        with_fault("doubled and flipped", doubled, |mends| mends == Mends { doubled: 1, ..Mends::default() });
    }
}

#[test]
fn a_stone_with_a_back_for_each_triangle_loses_the_backs() {
    let two_sided = |good: &Mesh, _: usize| joined(&[good.clone(), turned(good)]);
    with_fault("two-sided", two_sided, |mends| mends.doubled > 7);
    let backs_first = |good: &Mesh, _: usize| joined(&[turned(good), good.clone()]);
    with_fault("two-sided, backs first", backs_first, |mends| mends.doubled > 7 && mends.inverted == 1);
}

#[test]
fn a_flipped_triangle_is_turned() {
    let flipped = |good: &Mesh, triangle: usize| {
        let mut mesh = good.clone();
        mesh.indices.swap(3 * triangle + 1, 3 * triangle + 2);
        mesh
    };
    with_fault("flipped", flipped, |mends| mends == Mends { turned: 1, ..Mends::default() });
}

#[test]
fn a_stone_inside_out_is_turned_with_its_normals() {
    let inverted = |good: &Mesh, _: usize| {
        let mesh = turned(good);
        Mesh { normals: mesh.normals.iter().map(|normal| -*normal).collect(), ..mesh }
    };
    with_fault("inside out", inverted, |mends| mends == Mends { inverted: 1, ..Mends::default() });
    for good in stones() {
        assert_eq!(solids(&inverted(&good, 0)).0[0].normals, good.normals);
        // Right normals on turned triangles stay.
        assert_eq!(solids(&turned(&good)).0[0].normals, good.normals);
    }
}

#[test]
fn a_sheet_inside_a_stone_is_left_out() {
    let sheet = |good: &Mesh, _: usize| {
        let mut mesh = good.clone();
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([Vec3::new(0.1, 0.05, 0.0), Vec3::new(-0.1, 0.1, 0.0), Vec3::new(0.0, -0.1, 0.0)]);
        mesh.normals.extend([Vec3::Z; 3]);
        mesh.indices.extend([first, first + 1, first + 2]);
        mesh
    };
    with_fault("sheet", sheet, |mends| mends == Mends { inner: 1, ..Mends::default() });
}

/// A wall along edges of the surface, where three triangles then meet.
#[test]
fn a_wall_between_edges_of_the_surface_is_left_out() {
    let good = flat(&octahedron().unwrap().to_mesh(Averaging::Angle));
    let level: Vec<Vec3> = {
        let mut around: Vec<Vec3> = good.positions.iter().copied().filter(|at| at.y.abs() < 1e-6).collect();
        around.sort_by(|one, other| one.z.atan2(one.x).total_cmp(&other.z.atan2(other.x)));
        around.dedup();
        around
    };
    assert_eq!(level.len(), 4);
    for corners in [[0, 1, 2, 0, 2, 3], [0, 2, 1, 0, 3, 2]] {
        let mut mesh = good.clone();
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(&level);
        mesh.normals.extend([Vec3::Y; 4]);
        mesh.indices.extend(corners.map(|corner| first + corner));
        let (found, mends) = solids(&mesh);
        assert_eq!(mends, Mends { inner: 2, ..Mends::default() });
        assert_is(&found[0], &good, "wall");
    }
}

/// Each facet in turn is missing.
#[test]
fn a_missing_facet_is_closed() {
    for good in stones() {
        let facets = crate::Convex::of_mesh(&good).expect("convex");
        for facet in 0..facets.planes.len() as u32 {
            let mut mesh = good.clone();
            let kept = good.indices.chunks_exact(3).zip(&facets.face_of_triangle).filter(|(_, face)| **face != facet);
            mesh.indices = kept.flat_map(|(corners, _)| corners).copied().collect();
            let (found, mends) = solids(&mesh);
            assert_eq!(mends, Mends { closed: 1, ..Mends::default() }, "facet {facet}");
            assert_is(&found[0], &good, "facet");
            // So it is inside out.
            let (found, _) = solids(&turned(&mesh));
            assert_is(&found[0], &good, "facet, inside out");
        }
    }
}

/// A triangle with a corner on the neighbour's edge.
#[test]
fn a_corner_on_an_edge_is_stitched() {
    let cut = |good: &Mesh, triangle: usize| {
        let mut mesh = good.clone();
        let [a, b, c] = [0, 1, 2].map(|k| mesh.indices[3 * triangle + k]);
        let middle = mesh.positions.len() as u32;
        mesh.positions.push(0.5 * (mesh.positions[a as usize] + mesh.positions[b as usize]));
        mesh.normals.push(mesh.normals[a as usize]);
        mesh.indices.splice(3 * triangle..3 * triangle + 3, [a, middle, c, middle, b, c]);
        mesh
    };
    for good in stones() {
        let (found, mends) = solids(&cut(&good, 3));
        assert_eq!(mends, Mends { closed: 1, ..Mends::default() });
        let (volume, expected) = (found[0].volume_and_area().0, good.volume_and_area().0);
        assert!((volume - expected).abs() < 1e-6 * expected);
        assert!(planes_of_convex(&found[0]).is_some());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Each corner of each triangle is moved by itself: as rounding does, and by up to 2^-16 of the size.
    #[test]
    fn corners_apart_are_welded(seed in any::<u64>(), which in 0usize..3, rough in any::<bool>()) {
        let good = &stones()[which];
        let mut state = seed;
        let mut noise = || {
            // Knuth's generator, whose upper bits are even.
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1 << 23) as f32 - 1.0
        };
        let step = if rough { 2f32.powi(-16) } else { 2f32.powi(-24) };
        let mut mesh = good.clone();
        mesh.positions.iter_mut().for_each(|at| *at += step * Vec3::new(noise(), noise(), noise()));
        let (found, mends) = solids(&mesh);
        prop_assert!(mends.welded > 0 && Mends { welded: 0, ..mends }.is_none(), "{}", mends);
        let found = &found[0];
        prop_assert!(crate::convex::is_closed(found));
        let (volume, expected) = (found.volume_and_area().0, good.volume_and_area().0);
        // By at most the area times the step along each axis.
        prop_assert!((volume - expected).abs() <= 2.0 * f64::from(step) * good.volume_and_area().1);
        if !rough {
            prop_assert!(same_planes(found, good, 1e-4));
        }
    }
}
