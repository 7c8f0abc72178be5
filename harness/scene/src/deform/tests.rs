use super::*;
use crate::MeshDiagnosis;
use crate::normals::{Averaging, shared_normals};
use crate::surfaces::torus;
use glam::{DQuat, dvec2};
use lapidary_assay::extremum::larger;

/// Returns a tilted ring, off the axis.
fn ring() -> Mesh {
    torus(20.0, 7.0, 160, 64).placed(DQuat::from_rotation_x(1.1), dvec3(6.0, 3.0, -4.0))
}

#[test]
fn a_twist_keeps_the_volume_and_turns_by_height() {
    let ring = ring();
    let (axis, base, rate) = (dvec2(2.0, -1.0), -10.0, 0.05);
    let twisted = twisted(&ring, axis, base, rate);
    let (before, after) = (ring.volume_and_area(), twisted.volume_and_area());
    println!("volume {} and {}, area {} and {}", before.0, after.0, before.1, after.1);
    assert!((after.0 / before.0 - 1.0).abs() < 1e-3 && after.1 > 1.01 * before.1);
    let place = |point: glam::Vec3| dvec2(point.x.into(), point.z.into()) - axis;
    for (old, new) in ring.positions.iter().zip(&twisted.positions) {
        assert_eq!(old.y, new.y);
        // From +z towards +x, like rotations about y.
        let turned = DVec2::from_angle(-rate * (f64::from(old.y) - base)).rotate(place(*old));
        assert!(turned.distance(place(*new)) < 1e-5, "{turned} {}", place(*new));
    }
}

#[test]
fn normals_of_a_twisted_body_are_its_own() {
    let (ring, axis) = (ring(), dvec2(2.0, -1.0));
    let twisted = twisted(&ring, axis, 0.0, 0.05);
    let expected = shared_normals(&twisted.positions, &twisted.indices, Averaging::Angle);
    let off = |normals: &[glam::Vec3]| normals.iter().zip(&expected).map(|(a, b)| a.distance(*b)).fold(0.0, larger);
    let turned: Vec<_> = ring
        .normals
        .iter()
        .zip(&ring.positions)
        .map(|(normal, p)| glam::Quat::from_rotation_y(0.05 * p.y) * *normal)
        .collect();
    println!("by the inverse transpose off by {}, turned alone by {}", off(&twisted.normals), off(&turned));
    assert!(twisted.normals.iter().all(|normal| normal.is_normalized()));
    // The error of shared normals of facets 1.2 wide on a tube of radius 7.
    assert!(off(&twisted.normals) < 0.03 && off(&turned) > 0.3);
}

#[test]
fn a_twist_comes_and_goes() {
    let ring = ring();
    let twist = |time: f64| twisting(&ring, dvec2(0.0, 0.0), [-20.0, 20.0], time);
    let deviation =
        |a: &Mesh, b: &Mesh| a.positions.iter().zip(&b.positions).map(|(a, b)| a.distance(*b)).fold(0.0, larger);
    assert!(
        deviation(&twist(0.0), &ring) < 1e-5
            && deviation(&twist(0.5), &ring) < 1e-4
            && deviation(&twist(1.0), &ring) < 1e-4
    );
    assert!(deviation(&twist(0.25), &ring) > 10.0 && deviation(&twist(0.25), &twist(0.75)) > 10.0);
    // A quarter turn at the top.
    let mut top =
        Mesh { positions: vec![glam::Vec3::new(3.0, 20.0, 0.0)], normals: vec![glam::Vec3::X], ..Mesh::default() };
    top = twisting(&top, dvec2(0.0, 0.0), [-20.0, 20.0], 0.25);
    assert!(top.positions[0].distance(glam::Vec3::new(0.0, 20.0, -3.0)) < 1e-5);
}

/// Returns the number of bodies, from the ends of the triangles along x.
fn bodies(mesh: &Mesh) -> usize {
    let mut spans: Vec<[f32; 2]> = mesh
        .triangles()
        .map(|corners| [corners[0].min(corners[1]).min(corners[2]).x, corners[0].max(corners[1]).max(corners[2]).x])
        .collect();
    spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut reach = spans[0][1];
    let mut count = 1;
    for [from, to] in spans {
        count += usize::from(from > reach);
        reach = reach.max(to);
    }
    count
}

#[test]
fn two_drops_become_one() {
    let mut counts = Vec::new();
    let mut volumes = Vec::new();
    for step in 0..=20 {
        let mesh = merging(f64::from(step) / 20.0);
        assert!(MeshDiagnosis::of(&mesh).is_solid(), "{step}: {:?}", MeshDiagnosis::of(&mesh));
        let expected = shared_normals(&mesh.positions, &mesh.indices, Averaging::Angle);
        let off = mesh.normals.iter().zip(&expected).map(|(a, b)| a.distance(*b)).fold(0.0, larger);
        // A neck that has just formed bends within a triangle.
        assert!(off < 0.2 && mesh.normals.iter().all(|normal| normal.is_normalized()), "{step}: {off}");
        counts.push(bodies(&mesh));
        volumes.push(mesh.volume_and_area().0);
    }
    println!("{counts:?}\n{volumes:.0?}");
    assert_eq!((counts[0], counts[20]), (2, 1));
    assert!(counts.windows(2).all(|pair| pair[1] <= pair[0]), "{counts:?}");
    let met = counts.iter().filter(|count| **count == 2).count();
    assert!((6..=10).contains(&met), "{counts:?}");
    // Two whole balls at first.
    let balls = 4.0 / 3.0 * PI * (14f64.powi(3) + 10f64.powi(3));
    assert!((volumes[0] / balls - 1.0).abs() < 0.01, "{volumes:?} {balls}");
    assert_eq!(merging(-1.0), merging(0.0));
}
