use super::*;
use glam::Vec3;
use lapidary_scene::Mesh;
use std::collections::HashMap;
use std::f64::consts::PI;

/// Measured properties of a mesh from a net.
#[derive(Debug)]
pub(crate) struct Survey {
    /// Smallest angle of a triangle, in degrees.
    pub(crate) least_angle: f64,
    /// Fraction of corners whose normal points into their triangle.
    pub(crate) turned: f64,
    /// Number of bodies that no triangle connects.
    pub(crate) bodies: usize,
}

/// Surveys a mesh, asserting that it is closed, manifold, right side out, and has unit normals.
pub(crate) fn survey(mesh: &Mesh) -> Survey {
    assert!(mesh.positions.len() == mesh.normals.len() && mesh.uvs.is_empty() && mesh.halo.is_empty());
    assert!(mesh.normals.iter().all(|normal| normal.is_normalized()) && mesh.volume_and_area().0 > 0.0);
    // For each vertex, the counter-clockwise successor of each of its neighbours. A directed edge
    // occurs once.
    let mut next: HashMap<[u32; 2], u32> = HashMap::new();
    let mut neighbours = vec![0; mesh.positions.len()];
    let mut first = vec![u32::MAX; mesh.positions.len()];
    for triangle in mesh.indices.chunks_exact(3) {
        for k in 0..3 {
            let [vertex, one, other] = [0, 1, 2].map(|turn| triangle[(k + turn) % 3]);
            assert!(next.insert([vertex, one], other).is_none(), "two triangles on one side of an edge");
            neighbours[vertex as usize] += 1;
            first[vertex as usize] = one;
        }
    }
    for (vertex, &start) in (0..).zip(&first) {
        let around = std::iter::successors(next.get(&[vertex, start]), |one| next.get(&[vertex, **one]));
        let count = 1 + around.take_while(|one| **one != start).count();
        assert_eq!(count, neighbours[vertex as usize], "more than one fan of triangles, or an open one, at a vertex");
        assert!(count >= 3);
    }
    let (mut least_angle, mut turned) = (f64::INFINITY, 0);
    for triangle in mesh.indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|k| mesh.positions[triangle[k] as usize].as_dvec3());
        for [a, b, c] in [[a, b, c], [b, c, a], [c, a, b]] {
            least_angle = least_angle.min((b - a).angle_between(c - a).to_degrees());
        }
        let across = (b - a).cross(c - a).as_vec3();
        turned += triangle.iter().filter(|&&corner| mesh.normals[corner as usize].dot(across) <= 0.0).count();
    }
    Survey { least_angle, turned: turned as f64 / mesh.indices.len() as f64, bodies: bodies(mesh) }
}

fn bodies(mesh: &Mesh) -> usize {
    let mut parent: Vec<usize> = (0..mesh.positions.len()).collect();
    fn root(parent: &mut [usize], mut vertex: usize) -> usize {
        while parent[vertex] != vertex {
            parent[vertex] = parent[parent[vertex]];
            vertex = parent[vertex];
        }
        vertex
    }
    for edge in mesh.indices.chunks_exact(3).flat_map(|t| [[t[0], t[1]], [t[1], t[2]]]) {
        let [a, b] = edge.map(|vertex| root(&mut parent, vertex as usize));
        parent[a] = b;
    }
    (0..parent.len()).filter(|&vertex| parent[vertex] == vertex).count()
}

fn box_grid(half: f64, width: f64) -> Grid {
    Grid::uniform(DVec3::splat(-half), DVec3::splat(half), width)
}

#[test]
fn a_sphere_has_its_volume_its_area_and_its_normals() {
    let ball = |point: DVec3| point.length() - 10.0;
    let mesh = surface(&ball, &box_grid(12.3, 0.9));
    let survey = survey(&mesh);
    println!("{} triangles, {survey:?}", mesh.triangle_count());
    assert!(survey.least_angle > 24.0 && survey.turned == 0.0 && survey.bodies == 1);
    for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
        assert!((position.length() - 10.0).abs() < 1e-5 && normal.distance(*position / 10.0) < 1e-5);
    }
    let (volume, area) = mesh.volume_and_area();
    // The sagitta of a chord of .9 is at most (.9 / 2)² / (2 · 10), on a radius of 10.
    assert!((volume / (4.0 / 3.0 * PI * 1000.0) - 1.0).abs() < 4e-3, "{volume}");
    assert!((area / (4.0 * PI * 100.0) - 1.0).abs() < 4e-3, "{area}");
}

#[test]
fn a_graded_grid_meshes_finer_where_its_cells_are_smaller() {
    let pole = |point: DVec3| limb(point, DVec3::new(1.0, -10.0, 2.0), DVec3::new(1.0, 10.0, 2.0), [4.0, 4.0]);
    let axis = glam::dvec2(1.0, 2.0);
    let grid = Grid::graded(axis, glam::dvec2(9.0, 9.0), [-17.0, 17.0], 1.0, |y| 1.0 - 0.03 * y, |_| 1.0);
    let mesh = surface(&pole, &grid);
    let survey = survey(&mesh);
    assert!(survey.least_angle > 20.0 && survey.turned == 0.0 && survey.bodies == 1, "{survey:?}");
    let near = |height: f32| mesh.positions.iter().filter(|p| (p.y - height).abs() < 3.0).count();
    assert!(near(7.0) as f64 > 1.8 * near(-7.0) as f64, "{} {}", near(7.0), near(-7.0));
}

#[test]
fn a_body_that_leaves_the_grid_is_cut_off_and_closed() {
    let endless = |point: DVec3| glam::dvec2(point.x, point.z).length() - 3.0;
    let mesh = surface(&endless, &box_grid(5.0, 0.8));
    assert_eq!(survey(&mesh).bodies, 1);
}

/// Two spheres touch in the middle of a cell, at all positions within a cell: each keeps its own
/// vertices, or they are one body.
#[test]
fn nothing_that_passes_a_cell_together_shares_a_vertex() {
    for step in 0..20 {
        let shift = f64::from(step) * 0.05;
        let gap = 0.02 * f64::from(step % 5);
        let two = move |point: DVec3| {
            let along = DVec3::new(1.0, 0.7, 0.4).normalize() * (3.0 + 0.5 * gap);
            let point = point - DVec3::splat(shift);
            ((point - along).length() - 3.0).min((point + along).length() - 3.0)
        };
        let bodies = survey(&surface(&two, &box_grid(8.0, 1.0))).bodies;
        assert!(bodies == 1 || bodies == 2);
    }
}

#[test]
fn a_surface_is_the_same_each_time() {
    let body = |point: DVec3| union(ellipsoid(point, DVec3::new(3.0, 2.0, 4.0)), point.distance(DVec3::X) - 2.5, 0.7);
    let grid = box_grid(6.0, 0.5);
    assert_eq!(surface(&body, &grid), surface(&body, &grid));
}

#[test]
fn nothing_has_no_surface() {
    assert_eq!(surface(&|_| 1.0, &box_grid(2.0, 0.5)), Mesh::default());
}

#[test]
fn fields_are_distances_where_they_say_so() {
    let (from, to) = (DVec3::new(-1.0, 2.0, 0.5), DVec3::new(3.0, -1.0, 1.0));
    let capsule = |point| limb(point, from, to, [0.5, 0.5]);
    let normal = (to - from).any_orthogonal_vector().normalize();
    for (point, distance) in [
        (from.lerp(to, 0.3) + 2.0 * normal, 1.5),
        (from - 2.0 * (to - from).normalize(), 1.5),
        (to + (to - from).normalize(), 0.5),
        (from.midpoint(to), -0.5),
    ] {
        assert!((capsule(point) - distance).abs() < 1e-12);
    }
    // To first order: on the axes at small distances.
    let radii = DVec3::new(1.0, 2.0, 3.0);
    for axis in 0..3 {
        for distance in [-1e-3, 0.0, 1e-3] {
            let mut point = DVec3::ZERO;
            point[axis] = radii[axis] + distance;
            assert!((ellipsoid(point, radii) - distance).abs() < 2e-6);
        }
    }
    assert_eq!(ellipsoid(DVec3::ZERO, radii), -1.0);
}

#[test]
fn joins_flow_together_within_their_width_alone() {
    for (a, b) in [(0.3, -0.2), (-0.4, 0.5), (0.1, 0.1), (-2.0, 3.0)] {
        assert_eq!((union(a, b, 0.0), intersection(a, b, 0.0), difference(a, b, 0.0)), (a.min(b), a.max(b), a.max(-b)));
        assert_eq!(union(a, b, 0.4), union(b, a, 0.4));
        let flown = a.min(b) - union(a, b, 0.4);
        assert!((0.0..0.1 + 1e-12).contains(&flown) && (flown > 0.0) == ((a - b).abs() < 0.4), "{a} {b}: {flown}");
    }
    // Continuous at the start of the blend.
    assert!((union(0.0, 0.4 - 1e-9, 0.4) - 0.0).abs() < 1e-12);
}

#[test]
fn vertices_have_the_fields_own_normals() {
    let body = |point: DVec3| ellipsoid(point, DVec3::new(6.0, 3.0, 4.0));
    let mesh = surface(&body, &box_grid(7.0, 0.8));
    for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
        let exact = (*position / Vec3::new(36.0, 9.0, 16.0)).normalize();
        assert!(normal.distance(exact) < 1e-5, "{normal} {exact}");
    }
}
