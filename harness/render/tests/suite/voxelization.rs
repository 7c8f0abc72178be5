//! Voxels of meshes on the device, against volumes, winding numbers in f64, the mirror, and one
//! another.

use glam::{DQuat, DVec3, UVec3, Vec3};
use lapidary_render::frame::{Builder, Executor};
use lapidary_render::voxel_grid::VoxelGrid;
use lapidary_render::voxelization::{Status, Voxelizer};
use lapidary_scene::surfaces::{sphere, torus};
use lapidary_scene::{Bounds, Mesh, Scene};
use lapidary_voxelization::{kernels, oracle};
use rayon::prelude::*;

/// Largest distance, in voxels, from a centre to the surface at which rounding and the lattice may
/// decide. In a grid of 64 on lavapipe, vertices are off by 2 units of 2^-18 in each coordinate and
/// by 2^-15 more in y and z, and the depth is off by 6 units: 1.3e-5 + 4.3e-5 + 2.3e-5.
const BAND: f64 = 1e-4;

/// Results of a frame on the device.
struct Voxels {
    grid: VoxelGrid,
    matter: Vec<u32>,
    surface: Vec<u32>,
    status: Status,
}

impl Voxels {
    fn has(&self, bits: &[u32], voxel: UVec3) -> bool {
        let row = voxel.y + self.grid.cells * voxel.z;
        bits[(row * self.grid.words_per_row() + voxel.x / 32) as usize] >> (voxel.x % 32) & 1 == 1
    }

    fn matter(&self, voxel: UVec3) -> bool {
        self.has(&self.matter, voxel)
    }

    /// Returns the indices of the voxels with matter.
    fn filled(&self) -> Vec<usize> {
        (0..self.grid.count()).filter(|index| self.matter(self.grid.voxel(*index))).collect()
    }
}

/// Returns a frame that voxelizes a mesh `times` times in a row.
fn frame(mesh: &Mesh, grid: VoxelGrid, effects: &[(&str, f64)], times: u32) -> (Executor<'static>, Voxelizer) {
    let mut builder = Builder::new(Some(lapidary_testing::gpu()));
    let voxelizer = Voxelizer::new(&mut builder, grid, mesh, effects).expect("the recipe");
    let positions = builder.storage("positions", bytemuck::cast_slice(&mesh.positions));
    let indices = builder.storage("indices", bytemuck::cast_slice(&mesh.indices));
    for _ in 0..times {
        voxelizer.encode(&mut builder, positions, indices);
    }
    (Executor::new(lapidary_testing::gpu(), builder.finish()).expect("made"), voxelizer)
}

fn voxels_with(mesh: &Mesh, grid: VoxelGrid, surface: bool) -> Voxels {
    // Twice: a frame must not depend on the previous one.
    let (executor, voxelizer) = frame(mesh, grid, &[("EFFECT_SURFACE", f64::from(u8::from(surface)))], 2);
    executor.run(|_, _| {}).expect("run");
    let words = |buffer| executor.words(buffer).expect("read back");
    Voxels {
        grid,
        matter: words(voxelizer.matter),
        surface: voxelizer
            .surface
            .map_or_else(|| vec![0; (grid.words_per_row() * grid.cells * grid.cells) as usize], words),
        status: voxelizer.status(&executor).expect("read back"),
    }
}

fn voxels(mesh: &Mesh, grid: VoxelGrid) -> Voxels {
    voxels_with(mesh, grid, true)
}

/// Returns only the voxels whose centre is inside.
fn solid(mesh: &Mesh, grid: VoxelGrid) -> Voxels {
    voxels_with(mesh, grid, false)
}

fn bunny() -> Mesh {
    Scene::named("skin_bunny").expect("built in").objects.swap_remove(0).mesh
}

/// Returns a mesh without normals, which these tests do not read.
fn mesh(positions: Vec<Vec3>, indices: Vec<u32>) -> Mesh {
    Mesh { positions, indices, ..Mesh::default() }
}

fn cuboid(low: Vec3, high: Vec3) -> Mesh {
    let corner = |k: u32| Vec3::select(glam::BVec3::new(k & 1 == 1, k & 2 == 2, k & 4 == 4), high, low);
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices = faces.into_iter().flat_map(|[a, b, c, d]| [a, b, c, a, c, d]).collect();
    mesh((0..8).map(corner).collect(), indices)
}

fn joined(bodies: &[&Mesh]) -> Mesh {
    let mut all = Mesh::default();
    bodies.iter().for_each(|body| all.append(body));
    all
}

fn moved(mesh: &Mesh, by: Vec3) -> Mesh {
    let mut mesh = mesh.clone();
    mesh.positions.iter_mut().for_each(|position| *position += by);
    mesh
}

fn about(mesh: &Mesh, cells: u32) -> VoxelGrid {
    VoxelGrid::about(Bounds::of(mesh.positions.iter().copied()), cells)
}

/// Returns the grid of unit voxels about the world's origin.
fn centred(cells: u32) -> VoxelGrid {
    VoxelGrid { origin: Vec3::splat(-0.5 * cells as f32), spacing: 1.0, cells }
}

/// Returns the triangles' corners in the grid's coordinates.
fn triangles(mesh: &Mesh, grid: VoxelGrid) -> Vec<[DVec3; 3]> {
    let local = |p: Vec3| (p.as_dvec3() - grid.origin.as_dvec3()) / f64::from(grid.spacing);
    mesh.triangles().map(|corners| corners.map(local)).collect()
}

/// Returns the winding number of a closed mesh about a point: the sum of its triangles' solid
/// angles over 4π. Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", IEEE
/// Transactions on Biomedical Engineering 30(2), 1983.
fn winding(triangles: &[[DVec3; 3]], point: DVec3) -> f64 {
    let angles = triangles.iter().map(|corners| {
        let [a, b, c] = corners.map(|corner| corner - point);
        let [la, lb, lc] = [a, b, c].map(DVec3::length);
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(below)
    });
    angles.sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// Returns the distance from a point to the nearest of the triangles. Ericson, "Real-Time Collision
/// Detection", 5.1.5.
fn distance(triangles: &[[DVec3; 3]], point: DVec3) -> f64 {
    let to_segment = |a: DVec3, b: DVec3| {
        let share = ((point - a).dot(b - a) / (b - a).length_squared().max(1e-300)).clamp(0.0, 1.0);
        point.distance(a + share * (b - a))
    };
    let to_triangle = |[a, b, c]: [DVec3; 3]| {
        let normal = (b - a).cross(c - a);
        let over = [(a, b), (b, c), (c, a)].iter().all(|(p, q)| (*q - *p).cross(point - *p).dot(normal) >= 0.0);
        let edges = to_segment(a, b).min(to_segment(b, c)).min(to_segment(c, a));
        if over && normal != DVec3::ZERO { edges.min((point - a).dot(normal.normalize()).abs()) } else { edges }
    };
    triangles.iter().map(|triangle| to_triangle(*triangle)).fold(f64::INFINITY, f64::min)
}

fn centre(voxel: UVec3) -> DVec3 {
    voxel.as_dvec3() + 0.5
}

/// Returns a triangle soup without shared vertices.
fn soup(count: u32, size: f32) -> Mesh {
    let number = |k: u32| (k.wrapping_mul(2_654_435_769) >> 8) as f32 / (1 << 24) as f32;
    let positions = (0..3 * count).map(|k| {
        let offset = Vec3::new(number(3 * k), number(3 * k + 1), number(3 * k + 2)) - 0.5;
        let middle = Vec3::new(number(k / 3 + 7), number(k / 3 + 5_000_011), number(k / 3 + 9_000_001)) - 0.5;
        12.0 * middle + size * offset
    });
    mesh(positions.collect(), (0..3 * count).collect())
}

#[test]
fn the_kernels_are_the_mirrors() {
    if !lapidary_testing::on_lavapipe("mirrors are compared on the reference device alone") {
        return;
    }
    let cases = [
        (sphere(6.3, 24), centred(16)),
        (torus(7.0, 3.1, 40, 20), centred(24)),
        (bunny(), about(&bunny(), 40)),
        // Open meshes with small and large triangles, partly outside the grid.
        (soup(200, 3.0), centred(16)),
        (soup(60, 40.0), centred(24)),
        (cuboid(Vec3::new(-20.0, -21.3, -9.2), Vec3::new(13.1, 18.4, 55.0)), centred(40)),
    ];
    for (mesh, grid) in cases {
        for surface in [true, false] {
            let found = voxels_with(&mesh, grid, surface);
            let positions: &[f32] = bytemuck::cast_slice(&mesh.positions);
            let wanted = kernels::frame(grid.into(), positions, &mesh.indices, surface);
            assert_eq!(found.matter, wanted.matter);
            assert_eq!(found.surface, wanted.surface);
            let Status { solid, surface, odd_columns } = found.status;
            assert_eq!([solid, surface, odd_columns], wanted.status);
        }
    }
}

#[test]
fn counts_are_those_of_the_bits() {
    let mesh = bunny();
    for cells in [16, 24, 64, 256] {
        let grid = about(&mesh, cells);
        let (all, inside) = (voxels(&mesh, grid), solid(&mesh, grid));
        let count = |bits: &[u32]| bits.iter().map(|word| word.count_ones()).sum::<u32>();
        assert_eq!(all.status, Status { solid: count(&inside.matter), surface: count(&all.surface), odd_columns: 0 });
        assert_eq!(inside.status, Status { surface: 0, ..all.status });
        let union = inside.matter.iter().zip(&all.surface).map(|(inside, surface)| inside | surface);
        assert!(all.matter.iter().copied().eq(union), "{cells}");
    }
}

/// Only voxels that the surface touches can be wrong, each by its share outside or inside. These
/// are as many numbers between -1 and 1, with mean 0 and a standard deviation of at most 1/2. The
/// probability is 1e-15 that their sum is off by more than 4 times the root of their number. The
/// grid is askew, so that a body's two halves do not both err alike.
#[test]
fn volumes_are_the_meshes() {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.5, 0.7);
    for mesh in [sphere(1.0, 96), torus(20.0, 7.0, 160, 64), bunny(), cuboid(Vec3::NEG_ONE, Vec3::new(0.5, 1.0, 0.2))] {
        let mesh = mesh.placed(turn, DVec3::ZERO);
        let (volume, _) = mesh.volume_and_area();
        for cells in [16, 24, 64, 128, 256] {
            let grid = about(&mesh, cells);
            let grid = VoxelGrid { origin: grid.origin + grid.spacing * Vec3::new(0.13, 0.29, 0.41), ..grid };
            let Status { solid, surface, odd_columns } = voxels(&mesh, grid).status;
            let wanted = volume / f64::from(grid.spacing).powi(3);
            let bound = 4.0 * f64::from(surface).sqrt();
            assert!((f64::from(solid) - wanted).abs() <= bound, "{cells}: {solid}, not {wanted} ± {bound}");
            assert_eq!(odd_columns, 0);
        }
    }
}

/// The number of centres in a half-open box is a product; faces pass through centres exactly.
#[test]
fn a_box_has_the_voxels_that_a_product_says() {
    for (low, high) in [
        (Vec3::splat(-4.5), Vec3::splat(3.5)),
        (Vec3::new(-7.5, -3.0, 0.5), Vec3::new(-2.5, 6.25, 7.5)),
        (Vec3::splat(-31.5), Vec3::splat(31.5)),
        (Vec3::new(-0.25, -30.0, -30.0), Vec3::new(0.25, 30.0, 30.0)),
    ] {
        let grid = centred(64);
        let inside = |voxel: UVec3| {
            let centre = grid.centre(voxel);
            centre.cmpge(low).all() && centre.cmplt(high).all()
        };
        let found = solid(&cuboid(low, high), grid);
        assert!((0..grid.count()).all(|index| found.matter(grid.voxel(index)) == inside(grid.voxel(index))));
        assert_eq!(found.status.odd_columns, 0);
    }
}

#[test]
fn centres_are_inside_as_winding_numbers_say() {
    for mesh in [bunny(), torus(20.0, 7.0, 60, 24)] {
        let grid = about(&mesh, 64);
        let (inside, all) = (solid(&mesh, grid), voxels(&mesh, grid));
        let local = triangles(&mesh, grid);
        // Every other sample lies near the surface.
        let near: Vec<usize> = (0..grid.count()).filter(|index| all.has(&all.surface, grid.voxel(*index))).collect();
        let wrong: Vec<(UVec3, f64)> = (0..20_000usize)
            .into_par_iter()
            .filter_map(|sample| {
                let number = sample.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 20;
                let index = if sample % 2 == 0 { near[number % near.len()] } else { number % grid.count() };
                let voxel = grid.voxel(index);
                let is_inside = winding(&local, centre(voxel)) > 0.5;
                (inside.matter(voxel) != is_inside).then(|| (voxel, distance(&local, centre(voxel))))
            })
            .collect();
        assert!(wrong.iter().all(|(_, distance)| *distance <= BAND), "{wrong:?}");
    }
}

/// Returns whether a triangle touches the voxel, or `None` if rounding decides: then a voxel that
/// is smaller by a thousandth and one that is larger give different answers.
fn clearly_touched(triangles: &[[DVec3; 3]], voxel: UVec3) -> Option<bool> {
    let touched = |margin: f64| triangles.iter().any(|t| oracle::touches(*t, voxel.as_dvec3(), margin));
    let (narrow, wide) = (touched(-1e-3), touched(1e-3));
    (narrow == wide).then_some(wide)
}

#[test]
fn the_surface_is_what_clipping_leaves() {
    let mesh = torus(20.0, 7.0, 40, 16);
    let grid = about(&mesh, 24);
    let found = voxels(&mesh, grid);
    let local = triangles(&mesh, grid);
    let mut decided = 0;
    for voxel in (0..grid.count()).map(|index| grid.voxel(index)) {
        if let Some(touched) = clearly_touched(&local, voxel) {
            assert_eq!(found.has(&found.surface, voxel), touched, "{voxel}");
            decided += 1;
        }
    }
    assert!(decided > grid.count() * 99 / 100, "{decided}");
}

/// Returns all 48 symmetries of a cube: the order of the axes, and which of them are reversed.
fn symmetries() -> Vec<([usize; 3], [bool; 3])> {
    let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [1, 0, 2], [0, 2, 1], [2, 1, 0]];
    orders.into_iter().flat_map(|order| (0..8).map(move |k| (order, [k & 1 == 1, k & 2 == 2, k & 4 == 4]))).collect()
}

#[test]
fn turned_and_mirrored_meshes_have_turned_and_mirrored_voxels() {
    let grid = centred(32);
    let shape = bunny();
    let extent = Bounds::of(shape.positions.iter().copied());
    let scale = 28.0 / (extent.max - extent.min).max_element();
    // On multiples of 2^-12, so that positions are exact in the grid's coordinates for every
    // symmetry.
    let place = |p: &Vec3| (scale * (*p - extent.centre()) * 4096.0).round() / 4096.0;
    let upright = mesh(shape.positions.iter().map(place).collect(), shape.indices.clone());
    let [inside, all] = [solid(&upright, grid), voxels(&upright, grid)];
    let local = triangles(&upright, grid);
    let mut differ = 0;
    for (order, flips) in symmetries() {
        let turn = |p: &Vec3| Vec3::from_array([0, 1, 2].map(|k| if flips[k] { -p[order[k]] } else { p[order[k]] }));
        let turned = mesh(upright.positions.iter().map(turn).collect(), upright.indices.clone());
        let turn_voxel = |v: UVec3| {
            UVec3::from_array([0, 1, 2].map(|k| if flips[k] { grid.cells - 1 - v[order[k]] } else { v[order[k]] }))
        };
        let [turned_inside, turned_all] = [solid(&turned, grid), voxels(&turned, grid)];
        for voxel in (0..grid.count()).map(|index| grid.voxel(index)) {
            if inside.matter(voxel) != turned_inside.matter(turn_voxel(voxel)) {
                differ += 1;
                let distance = distance(&local, centre(voxel));
                assert!(distance < BAND, "{order:?} {flips:?}: {voxel}, {distance}");
            }
            if all.has(&all.surface, voxel) != turned_all.has(&turned_all.surface, turn_voxel(voxel)) {
                differ += 1;
                assert_eq!(clearly_touched(&local, voxel), None, "{order:?} {flips:?}: {voxel}");
            }
        }
    }
    assert!(differ <= 48, "{differ} voxels");
}

#[test]
fn an_open_mesh_makes_no_streaks() {
    for cells in [16, 64] {
        let closed = sphere(1.0, 48);
        let grid = about(&closed, cells);
        let mut open = closed.clone();
        let triangles: Vec<u32> = closed.indices.chunks_exact(3).skip(5).step_by(3).flatten().copied().collect();
        open.indices = triangles;
        let (whole, torn) = (voxels(&closed, grid), voxels(&open, grid));
        assert!(torn.matter.iter().zip(&whole.matter).all(|(torn, whole)| torn & !whole == 0));
        assert!(torn.status.odd_columns > cells * cells / 10, "{:?}", torn.status);
        assert!(torn.status.solid < whole.status.solid);
        // A single sheet: every column that meets it is odd, and only the sheet remains.
        let sheet = mesh(vec![Vec3::ZERO, Vec3::Y, Vec3::Z], vec![0, 1, 2]);
        let found = voxels(&sheet, grid);
        assert!(found.status.solid == 0 && found.status.odd_columns > 0, "{:?}", found.status);
        assert_eq!(found.matter, found.surface);
    }
}

#[test]
fn no_mesh_leaves_nothing() {
    for mesh in [Mesh::default(), mesh(vec![Vec3::ZERO; 3], Vec::new())] {
        let found = voxels(&mesh, centred(16));
        assert_eq!(found.status, Status { solid: 0, surface: 0, odd_columns: 0 });
        assert!(found.matter.iter().all(|word| *word == 0));
    }
}

/// A body on the grid's border equals the same body in a larger grid, cut off. This also holds on
/// the low side, where its columns begin outside.
#[test]
fn what_lies_outside_is_cut_off() {
    let ball = sphere(6.2, 32);
    let places = symmetries()
        .into_iter()
        .filter(|(order, _)| *order == [0, 1, 2])
        .map(|(_, flips)| Vec3::from_array(flips.map(|flip| if flip { -8.25 } else { 8.25 })));
    let axes = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z].map(|axis| 8.25 * axis);
    for place in places.chain(axes) {
        let ball = moved(&ball, place);
        let (cut, whole) = (voxels(&ball, centred(16)), voxels(&ball, centred(64)));
        assert!(cut.status.solid > 50 && cut.status.solid < whole.status.solid, "{place}");
        assert_eq!(cut.status.odd_columns, 0, "{place}");
        for voxel in (0..cut.grid.count()).map(|index| cut.grid.voxel(index)) {
            assert_eq!(cut.matter(voxel), whole.matter(voxel + 24), "{place}: {voxel}");
        }
    }
    let away = voxels(&moved(&ball, Vec3::new(0.0, 400.0, 0.0)), centred(16));
    assert_eq!(away.status, Status { solid: 0, surface: 0, odd_columns: 0 });
    let before = voxels(&moved(&ball, Vec3::new(-400.0, 0.0, 0.0)), centred(16));
    assert_eq!(before.status, Status { solid: 0, surface: 0, odd_columns: 0 });
    let around = voxels(&cuboid(Vec3::splat(-1e6), Vec3::splat(1e6)), centred(16));
    assert_eq!(around.status, Status { solid: 4096, surface: 0, odd_columns: 0 });
}

/// Vertices beyond the lattice bend the triangles that reach them, but open no holes.
#[test]
fn a_vertex_beyond_the_lattice_opens_nothing() {
    let near = [Vec3::new(-3.1, -2.2, -4.3), Vec3::new(4.4, -1.1, -3.7), Vec3::new(0.3, 4.9, 5.1)];
    for far in [Vec3::new(3.0, 4e4, -7e4), Vec3::new(-1e6, -1e6, 2e5), Vec3::new(0.1, 1e30, 0.2)] {
        let corners = [near[0], near[1], near[2], far];
        let spike = mesh(corners.to_vec(), vec![0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3]);
        let found = solid(&spike, centred(16));
        assert!(found.status.solid > 10, "{far}: {:?}", found.status);
        assert_eq!(found.status.odd_columns, 0, "{far}");
    }
}

/// There are more vertices than threads in one dimension of a dispatch: each thread takes several.
#[test]
fn the_last_of_many_vertices_is_met() {
    let body = cuboid(Vec3::splat(-4.5), Vec3::splat(3.5));
    let many = 65_535 * 64 + 100;
    let mut positions = vec![Vec3::ZERO; many];
    positions.extend(&body.positions);
    let indices = body.indices.iter().map(|index| index + many as u32).collect();
    let (found, wanted) = (solid(&mesh(positions, indices), centred(16)), solid(&body, centred(16)));
    assert_eq!(found.matter, wanted.matter);
    assert_eq!(found.status.solid, 512);
}

#[test]
fn parts_thinner_than_a_voxel_survive() {
    // Between centres on all sides.
    let plate = cuboid(Vec3::new(-6.0, 0.1, -6.0), Vec3::new(6.0, 0.2, 6.0));
    let found = voxels(&plate, centred(16));
    assert_eq!((found.status.solid, found.status.odd_columns), (0, 0));
    assert!((0..12).all(|x| (0..12).all(|z| found.matter(UVec3::new(x + 2, 8, z + 2)))));
    let needle = cuboid(Vec3::new(-6.4, 0.1, 0.3), Vec3::new(6.4, 0.101, 0.302));
    let found = voxels(&needle, centred(16));
    assert_eq!(found.filled().len(), 14, "x from -7 to 7");
    let grain = cuboid(Vec3::splat(0.3), Vec3::splat(0.301));
    assert_eq!(voxels(&grain, centred(16)).filled().len(), 1);
}

#[test]
fn triangles_without_area_change_nothing_inside() {
    let ball = sphere(6.2, 32);
    let grid = centred(16);
    let wanted = solid(&ball, grid);
    let mut more = ball.clone();
    let count = ball.positions.len() as u32;
    // Points, and lines there and back.
    more.indices.extend((0..count).flat_map(|k| [k, k, k]));
    more.indices.extend((1..count).flat_map(|k| [k, k - 1, k]));
    let found = solid(&more, grid);
    assert_eq!((&found.matter, found.status), (&wanted.matter, wanted.status));
}

#[test]
fn positions_that_are_no_numbers_stay_within_the_buffers() {
    let mut ball = sphere(6.2, 32);
    for (place, value) in [(40, f32::NAN), (90, f32::INFINITY), (150, -3e38)] {
        ball.positions[place] = Vec3::new(1.0, value, -value);
    }
    let found = voxels(&ball, centred(16));
    assert!(found.status.solid <= 4096 && found.status.surface <= 4096, "{:?}", found.status);
}

/// Parity adds up: separate bodies stand side by side, an overlap of two is hollow, and a shared
/// face disappears.
#[test]
fn bodies_that_meet() {
    let grid = centred(32);
    let ball = sphere(6.2, 32);
    for offset in [7.0, 4.0, 1.0] {
        let (left, right) = (moved(&ball, Vec3::X * -offset), moved(&ball, Vec3::new(offset, 0.3, 0.1)));
        let both = solid(&joined(&[&left, &right]), grid);
        let (left, right) = (solid(&left, grid), solid(&right, grid));
        let sum = left.matter.iter().zip(&right.matter).map(|(left, right)| left ^ right);
        assert!(both.matter.iter().copied().eq(sum), "{offset}");
    }
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        let (low, high) = (Vec3::splat(-3.5), Vec3::splat(4.5));
        let one = cuboid(low, high);
        let whole = cuboid(low, high + 8.0 * axis);
        let both = joined(&[&one, &moved(&one, 8.0 * axis)]);
        assert_eq!(solid(&both, grid).matter, solid(&whole, grid).matter, "{axis}");
    }
}

/// Returns the least and the median time of 40 frames, in milliseconds.
fn time(mesh: &Mesh, cells: u32, constants: &[(&str, f64)]) -> [f64; 2] {
    let (executor, _) = frame(mesh, about(mesh, cells), constants, 1);
    let frame = || {
        let start = std::time::Instant::now();
        executor.run(|_, _| {}).expect("run");
        lapidary_testing::gpu().device.poll(wgpu::PollType::wait_indefinitely()).expect("the device");
        start.elapsed().as_secs_f64() * 1e3
    };
    let mut times: Vec<f64> = (0..40).map(|_| frame()).collect();
    times.sort_by(f64::total_cmp);
    [times[0], times[20]]
}

/// Measures the times in docs/voxelization.md.
#[test]
#[ignore = "measures times"]
fn how_long_a_frame_takes() {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.5, 0.7);
    let straight = cuboid(Vec3::NEG_ONE, Vec3::ONE);
    let turned = straight.placed(turn, DVec3::ZERO);
    let mut one = bunny();
    one.indices.truncate(3);
    println!("the bunny has {} triangles", bunny().triangle_count());
    for (name, mesh) in [("bunny", bunny()), ("one of its triangles", one), ("box", straight), ("turned box", turned)] {
        for cells in [16, 32, 64, 128, 256] {
            let all = time(&mesh, cells, &[]);
            let inside = time(&mesh, cells, &[("EFFECT_SURFACE", 0.0)]);
            let shared = time(&mesh, cells, &[("VOXELIZE_LARGE", 0.0)]);
            let alone = time(&mesh, cells, &[("VOXELIZE_LARGE", 1e9)]);
            println!(
                "{name} {cells}: {all:.2?} ms, no surface {inside:.2?}, all shared {shared:.2?}, each alone {alone:.2?}"
            );
        }
    }
}
