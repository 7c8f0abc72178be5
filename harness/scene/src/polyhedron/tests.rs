use std::collections::HashMap;

use super::triangulation::SLIVERS;
use super::*;
use crate::cuts::{
    BrilliantParameters, PrismParameters, StepCutParameters, octahedron, prism, round_brilliant, step_cut,
};

fn plane(x: f64, y: f64, z: f64, distance: f64) -> Plane {
    Plane { normal: DVec3::new(x, y, z), distance }
}

fn cube() -> Vec<Plane> {
    [DVec3::X, DVec3::Y, DVec3::Z]
        .into_iter()
        .flat_map(|axis| [axis, -axis])
        .map(|normal| Plane { normal, distance: 1.0 })
        .collect()
}

fn all_cuts() -> Vec<Polyhedron> {
    vec![
        Polyhedron::from_planes(&cube()).unwrap(),
        octahedron().unwrap(),
        round_brilliant(&BrilliantParameters::TOLKOWSKY).unwrap(),
        step_cut(&StepCutParameters::EMERALD).unwrap(),
        prism(&PrismParameters::PENTAGONAL).unwrap(),
    ]
}

#[test]
fn a_cube_has_a_cubes_parts() {
    let cube = Polyhedron::from_planes(&cube()).unwrap();
    let counts = (cube.faces().len(), cube.vertices().len(), cube.edge_count());
    assert_eq!(counts, (6, 8, 12));
}

#[test]
fn euler_holds_and_every_corner_lies_inside_every_plane() {
    for solid in all_cuts() {
        let euler = solid.vertices().len() + solid.faces().len() - solid.edge_count();
        assert_eq!(euler, 2);
        for (plane, face) in solid.planes().iter().zip(solid.faces()) {
            for (k, &corner) in solid.vertices().iter().enumerate() {
                let height = plane.height(corner);
                assert!(height < 1e-9, "corner {k} is {height} outside");
                assert_eq!(height > -1e-9, face.contains(&k), "corner {k} at {height}");
            }
        }
    }
}

#[test]
fn meshes_wind_outwards_and_are_closed_with_unit_normals() {
    for solid in all_cuts() {
        let mesh = solid.to_mesh(Averaging::Angle);
        assert_eq!(mesh.positions.len(), mesh.normals.len());
        assert!(mesh.normals.iter().all(|normal| normal.is_normalized()));
        let mut volume = 0.0;
        for [a, b, c] in mesh.triangles() {
            let outward = (b - a).cross(c - a);
            assert!(outward.dot(a + b + c) > 0.0);
            volume += outward.dot(a) / 6.0;
        }
        assert!(volume > 0.1);
        for edge in mesh.indices.chunks_exact(3).flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]) {
            let opposite =
                mesh.indices.chunks_exact(3).filter(|t| [(t[1], t[0]), (t[2], t[1]), (t[0], t[2])].contains(&edge));
            assert_eq!(opposite.count(), 1);
        }
    }
}

#[test]
fn mesh_planes_touch_the_mesh() {
    for solid in all_cuts() {
        let mesh = solid.to_mesh(Averaging::Angle);
        for plane in solid.mesh_planes() {
            let heights = mesh.positions.iter().map(|p| plane.truncate().dot(*p) - plane.w);
            let on = heights.clone().filter(|height| height.abs() < 1e-6).count();
            assert!(on >= 3 && heights.fold(f32::MIN, f32::max) < 1e-6);
        }
    }
}

#[test]
fn triangulation_does_not_enter_the_shared_normals() {
    for solid in all_cuts() {
        let by_face = solid.to_mesh(Averaging::Angle);
        // The average by angle over a triangle soup has the same sums, except at inner vertices,
        // where both give the face's own normal.
        let by_triangle =
            Mesh::with_shared_normals(by_face.positions.clone(), by_face.indices.clone(), Averaging::Angle);
        for (a, b) in by_face.normals.iter().zip(&by_triangle.normals) {
            assert!(a.distance(*b) < 1e-5, "{a} and {b}");
        }
    }
}

#[test]
fn a_face_has_its_centroid_as_inner_vertex() {
    let solid = round_brilliant(&BrilliantParameters::TOLKOWSKY).unwrap();
    let mesh = solid.to_mesh(Averaging::Plain);
    let inner = &mesh.positions[solid.vertices().len()..];
    assert_eq!(inner.len(), 1, "only the table has more than four corners");
    assert!(inner[0].distance(Vec3::Y * 0.343) < 1e-3);
    assert!(mesh.normals.last().unwrap().distance(Vec3::Y) < 1e-6);
}

/// Returns all triangulations of all cuts, and of a flat-ended prism with 64 corners at each end.
fn triangulated() -> Vec<(Mesh, [Mesh; 3])> {
    let flat = prism(&PrismParameters { sides: 64, cap_degrees: 0.0, ..PrismParameters::PENTAGONAL }).unwrap();
    let five = prism(&PrismParameters { cap_degrees: 0.0, ..PrismParameters::PENTAGONAL }).unwrap();
    let solids = all_cuts().into_iter().chain([flat, five]);
    let others = [Triangulation::Fan, Triangulation::Strip, Triangulation::Sliver];
    solids
        .map(|solid| {
            let with = |triangulation| solid.to_mesh_with(Averaging::Angle, triangulation);
            assert_eq!(with(Triangulation::Centroid), solid.to_mesh(Averaging::Angle));
            (solid.to_mesh(Averaging::Angle), others.map(with))
        })
        .collect()
}

#[test]
fn every_triangulation_is_closed_and_encloses_the_same() {
    for (usual, others) in triangulated() {
        let (volume, area) = usual.volume_and_area();
        for other in others {
            assert_eq!(other.positions.len(), other.normals.len());
            let mut edges = HashMap::new();
            for triangle in other.indices.chunks_exact(3) {
                for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(k, l)| (triangle[k], triangle[l])) {
                    *edges.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { 1_000 };
                }
            }
            assert!(edges.values().all(|&count| count == 1_001), "each edge runs once each way");
            // Positions are rounded to f32; the surface can differ only at the inner ones.
            let (other_volume, other_area) = other.volume_and_area();
            assert!((other_volume - volume).abs() < 1e-6 * volume, "{other_volume} is not {volume}");
            assert!((other_area - area).abs() < 1e-6 * area, "{other_area} is not {area}");
            for [a, b, c] in other.triangles() {
                assert!((b - a).cross(c - a).dot(a + b + c) > 0.0, "a triangle without area, or inside out");
            }
        }
    }
}

#[test]
fn every_triangulation_has_its_own_shape() {
    let least_angle = |mesh: &Mesh, triangle: usize| {
        let [a, b, c] = mesh.triangles().nth(triangle).unwrap().map(Vec3::as_dvec3);
        let angles = [interior_angle(a, b, c), interior_angle(b, c, a), interior_angle(c, a, b)];
        angles.into_iter().fold(f64::MAX, f64::min).to_degrees()
    };
    let solid = round_brilliant(&BrilliantParameters::TOLKOWSKY).unwrap();
    let [fan, strip, sliver] = [Triangulation::Fan, Triangulation::Strip, Triangulation::Sliver]
        .map(|triangulation| solid.to_mesh_with(Averaging::Angle, triangulation));
    let corners_used = |mesh: &Mesh| {
        let mut uses = HashMap::new();
        mesh.indices[..18].iter().for_each(|&vertex| *uses.entry(vertex).or_insert(0) += 1);
        uses.into_values().max().unwrap()
    };
    assert_eq!((corners_used(&fan), corners_used(&strip)), (6, 3));
    assert_eq!(sliver.positions.len(), solid.vertices().len() + 6 * SLIVERS);
    // Every angle of the octagon's fan is an inscribed angle of at least 22.5°.
    assert!((0..6).all(|k| (least_angle(&fan, k) - 22.5).abs() < 1e-3));
    let mut needles: Vec<f64> = (0..150).map(|k| least_angle(&sliver, k)).collect();
    needles.sort_by(f64::total_cmp);
    assert!(needles[0] > 0.1 && needles[75] < 5.0 && needles[119] < 10.0, "{needles:?}");
}

#[test]
fn kites_are_cut_along_their_axis() {
    let solid = round_brilliant(&BrilliantParameters::TOLKOWSKY).unwrap();
    let kites: Vec<_> = solid
        .faces()
        .iter()
        .filter(|face| face.len() == 4)
        .map(|face| [0, 1, 2, 3].map(|k| solid.vertices()[face[k]]))
        .filter(|corner| corner[0].z - corner[2].z > 0.1)
        .collect();
    assert_eq!(kites.len(), 16);
    for [top, left, bottom, right] in kites {
        let axis = bottom - top;
        assert!(axis.dot(left - right).abs() < 1e-9);
    }
}

#[test]
fn useless_and_repeated_planes_are_dropped() {
    let mut planes = cube();
    planes.push(plane(2.0, 0.0, 0.0, 2.0));
    planes.push(plane(1.0, 1.0, 1.0, 9.0));
    planes.push(plane(1.0, 1.0, 0.0, 2.0)); // touches an edge
    planes.push(plane(1.0, 1.0, 1.0, 3.0)); // touches a corner
    let solid = Polyhedron::from_planes(&planes).unwrap();
    assert_eq!(solid.planes(), Polyhedron::from_planes(&cube()).unwrap().planes());
}

#[test]
fn planes_that_enclose_nothing_are_refused() {
    let cube = cube();
    let error = |planes: &[Plane]| Polyhedron::from_planes(planes).unwrap_err();
    assert_eq!(error(&[]), PolyhedronError::Empty);
    assert_eq!(error(&cube[..4]), PolyhedronError::Empty);
    assert_eq!(error(&cube[..5]), PolyhedronError::Unbounded);
    let mut split = cube.clone();
    split[0].distance = -2.0;
    assert_eq!(error(&split), PolyhedronError::Empty);
    split[0].distance = -1.0;
    assert_eq!(error(&split), PolyhedronError::Empty);
    split[0].normal = DVec3::ZERO;
    assert_eq!(error(&split), PolyhedronError::BadPlane { plane: 0 });
    split[0].normal = DVec3::NAN;
    assert_eq!(error(&split), PolyhedronError::BadPlane { plane: 0 });
    let many = vec![cube[0]; MAX_PLANES + 1];
    assert_eq!(error(&many), PolyhedronError::TooManyPlanes { planes: MAX_PLANES + 1 });
}

#[test]
fn size_does_not_matter() {
    for scale in [1e-6, 1e6] {
        let mut planes = cube();
        planes.iter_mut().for_each(|plane| plane.distance *= scale);
        assert_eq!(Polyhedron::from_planes(&planes).unwrap().faces().len(), 6);
    }
}
