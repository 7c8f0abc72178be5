use super::*;
use crate::cuts::{
    BrilliantParameters, PrismParameters, StepCutParameters, octahedron, prism, round_brilliant, step_cut,
};
use crate::polyhedron::Polyhedron;
use crate::{Averaging, Scene};
use glam::Vec3;
use lapidary_assay::extremum::largest;

fn all_cuts() -> [(&'static str, Polyhedron, usize); 4] {
    [
        ("octahedron", octahedron().unwrap(), 8),
        ("brilliant", round_brilliant(&BrilliantParameters::TOLKOWSKY).unwrap(), 73),
        ("step_cut", step_cut(&StepCutParameters::EMERALD).unwrap(), 57),
        ("prism", prism(&PrismParameters::PENTAGONAL).unwrap(), 15),
    ]
}

#[test]
fn every_cut_gives_its_own_planes_back() {
    for (name, solid, count) in all_cuts() {
        let mesh = solid.to_mesh(Averaging::Angle);
        let convex = Convex::of_mesh(&mesh).unwrap();
        let expected = solid.mesh_planes();
        assert_eq!((convex.planes.len(), expected.len()), (count, count), "{name}");
        assert_eq!(convex.face_of_triangle.len(), mesh.triangle_count());
        for plane in &convex.planes {
            let nearest =
                expected.iter().map(|other| largest((*other - *plane).abs().to_array())).fold(f32::MAX, f32::min);
            // Vertices are rounded by 6e-8, and the smallest facets, the girdle's, are .04 high.
            assert!(nearest < 3e-6, "{name}: {plane} is {nearest} from any facet");
            assert!((plane.truncate().length() - 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn every_triangle_lies_in_its_facet() {
    for (name, solid, _) in all_cuts() {
        let mesh = solid.to_mesh(Averaging::Angle);
        let convex = Convex::of_mesh(&mesh).unwrap();
        for (corners, &face) in mesh.triangles().zip(&convex.face_of_triangle) {
            let plane = convex.planes[face as usize];
            for corner in corners {
                assert!((plane.truncate().dot(corner) - plane.w).abs() < 1e-6, "{name}: {corner} off {plane}");
            }
        }
    }
}

#[test]
fn built_in_stones_are_convex_but_for_the_bunny_and_many_prisms_in_one_mesh() {
    for built_in in crate::BUILT_IN {
        let scene = Scene::named(built_in.name).unwrap();
        let mut stones = scene.objects.iter().filter(|object| !object.material.is_opaque());
        let convex = stones.all(|object| planes_of_convex(object.shape()).is_some());
        // Translucent bodies are round.
        let round = scene.objects.iter().any(|object| object.material.medium.is_some());
        let other = round || ["bunny_stone", "prism_chain", "chandelier"].contains(&built_in.name);
        assert_eq!(convex, !other, "{}", built_in.name);
    }
}

#[test]
fn size_and_place_do_not_matter() {
    let mesh = round_brilliant(&BrilliantParameters::TOLKOWSKY).unwrap().to_mesh(Averaging::Angle);
    for (scale, offset) in [(1e-4, 0.0), (1e4, 0.0), (1.0, 100.0)] {
        let mut moved = mesh.clone();
        moved.positions.iter_mut().for_each(|position| *position = *position * scale + offset);
        assert_eq!(planes_of_convex(&moved).map(|planes| planes.len()), Some(73), "{scale} {offset}");
    }
}

#[test]
fn unshared_vertices_and_triangles_without_area_change_nothing() {
    let mut mesh = octahedron().unwrap().to_mesh(Averaging::Angle);
    let planes = planes_of_convex(&mesh).unwrap();
    mesh.positions = mesh.triangles().flatten().collect();
    mesh.normals = vec![Vec3::X; mesh.positions.len()];
    mesh.indices = (0..mesh.positions.len() as u32).collect();
    mesh.indices.extend([0, 1, 1]);
    // The edge 0 to 1, there and back.
    mesh.indices.extend([0, 1, 0]);
    assert_eq!(planes_of_convex(&mesh).unwrap(), planes);
}

#[test]
fn what_is_not_a_closed_convex_body_has_no_planes() {
    let solid = octahedron().unwrap().to_mesh(Averaging::Angle);
    let change = |edit: &dyn Fn(&mut Mesh)| {
        let mut mesh = solid.clone();
        edit(&mut mesh);
        planes_of_convex(&mesh)
    };
    assert!(change(&|_| {}).is_some());
    let open = change(&|mesh| mesh.indices.truncate(21));
    let inside_out = change(&|mesh| mesh.indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(0, 1)));
    // A corner pushed through the body's middle.
    let dented = change(&|mesh| mesh.positions[0] *= -0.1);
    let twice = change(&|mesh| {
        let count = mesh.positions.len() as u32;
        let moved: Vec<Vec3> = mesh.positions.iter().map(|position| *position + 3.0).collect();
        mesh.positions.extend(moved);
        mesh.normals.extend(mesh.normals.clone());
        mesh.indices.extend(mesh.indices.clone().iter().map(|index| index + count));
    });
    assert_eq!((open, inside_out, dented, twice), (None, None, None, None));
    assert_eq!(planes_of_convex(&Mesh::default()), None);
}

#[test]
fn a_shape_is_convex_concave_or_open() {
    let mesh = |name: &str| Scene::named(name).unwrap().objects.remove(0).mesh;
    for (name, shape) in [
        ("brilliant", Shape::Convex),
        ("octahedron", Shape::Convex),
        ("bunny_stone", Shape::Concave),
        ("prism_chain", Shape::Concave),
    ] {
        assert_eq!(Shape::of(&mesh(name)), shape, "{name}");
    }
    let mut open = mesh("octahedron");
    open.indices.truncate(open.indices.len() - 3);
    assert_eq!(Shape::of(&open), Shape::Open);
    // In a mesh turned inside out, no plane has the others below it.
    let mut turned = mesh("octahedron");
    turned.indices.chunks_exact_mut(3).for_each(|corners| corners.swap(1, 2));
    assert_eq!(Shape::of(&turned), Shape::Concave);
}
