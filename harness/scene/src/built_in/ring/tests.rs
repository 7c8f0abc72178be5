use super::*;
use crate::convex::{is_closed, planes_of_convex};
use crate::{Bounds, Mesh};

fn scene() -> Scene {
    Scene::named("ring").expect("built in")
}

/// Returns all stones of the scene.
fn stones(scene: &Scene) -> Vec<&Mesh> {
    scene.objects.iter().filter(|object| object.material.is_clear()).map(|object| &object.mesh).collect()
}

#[test]
fn no_metal_and_no_other_stone_reaches_into_a_stone() {
    let scene = scene();
    let stones = stones(&scene);
    assert_eq!(stones.len(), 1 + 2 * band::STONES.len());
    for (number, stone) in stones.iter().enumerate() {
        let planes = planes_of_convex(stone).expect("convex");
        // A convex body has a point outside if one of its planes has.
        let inside =
            |point: &Vec3| planes.iter().all(|plane| plane.normal.dot(point.as_dvec3()) <= plane.distance - 1e-3);
        for metal in &scene.objects[1..3] {
            assert_eq!(
                metal.mesh.positions.iter().find(|point| inside(point)),
                None,
                "{} in stone {number}",
                metal.name
            );
        }
        for (other, mesh) in stones.iter().enumerate().filter(|(other, _)| *other != number) {
            assert_eq!(mesh.positions.iter().find(|point| inside(point)), None, "stone {other} in stone {number}");
        }
    }
}

#[test]
fn prongs_hold_the_stone() {
    let scene = scene();
    let planes = planes_of_convex(&scene.objects[3].mesh).expect("convex");
    let beyond = |point: &Vec3| {
        planes.iter().map(|plane| plane.normal.dot(point.as_dvec3()) - plane.distance).fold(f64::MIN, f64::max)
    };
    let nearest = scene.objects[2].mesh.positions.iter().map(beyond).fold(f64::MAX, f64::min);
    assert!(nearest < 0.06, "{nearest} mm from the stone");
}

#[test]
fn surfaces_are_closed_and_their_normals_point_outwards() {
    let scene = scene();
    for object in &scene.objects {
        assert!(is_closed(&object.mesh), "{}", object.name);
        assert!(object.mesh.normals.iter().all(|normal| normal.is_normalized()), "{}", object.name);
        for triangle in object.mesh.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| object.mesh.positions[triangle[corner] as usize]);
            let mean: Vec3 = triangle.iter().map(|vertex| object.mesh.normals[*vertex as usize]).sum();
            assert!((b - a).cross(c - a).dot(mean) > 0.0, "{}: {a} {b} {c}", object.name);
        }
    }
}

#[test]
fn the_ring_rests_in_the_cloth() {
    let scene = scene();
    let bounds = |number: usize| Bounds::of(scene.objects[number].mesh.positions.iter().copied());
    let (cloth, band) = (&scene.objects[0].mesh, bounds(1));
    let upper = cloth.positions.iter().zip(&cloth.normals).filter(|(_, normal)| normal.y > 0.0);
    let below = upper.filter(|(point, _)| point.x.hypot(point.z) < 1.0).map(|(point, _)| point.y);
    let middle = below.clone().sum::<f32>() / below.count() as f32;
    assert!(band.min.y < middle && band.min.y > middle - 1.5, "{} and {middle}", band.min.y);
    // Nothing else touches it.
    assert!(bounds(3).min.y > bounds(0).max.y);
}
