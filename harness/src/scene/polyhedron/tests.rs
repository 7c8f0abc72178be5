use super::*;
use crate::scene::cuts::{
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
        // A triangle soup by angle adds up to the same, except at inner vertices, where both give
        // the face's own normal.
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
    assert_eq!(error(&many), PolyhedronError::TooManyPlanes { planes: 257 });
}

#[test]
fn size_does_not_matter() {
    for scale in [1e-6, 1e6] {
        let mut planes = cube();
        planes.iter_mut().for_each(|plane| plane.distance *= scale);
        assert_eq!(Polyhedron::from_planes(&planes).unwrap().faces().len(), 6);
    }
}
