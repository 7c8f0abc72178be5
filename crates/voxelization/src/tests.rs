//! Tests of the parity of whole meshes, in exact counts.

use crate::{VOXELIZATION_LATTICE, column, column_naive};
use glam::{Vec2, Vec3};
use lapidary_assay::draws::Draws;

/// Returns two fans with a common outline, around vertices that columns pass through exactly. Each
/// edge belongs to two triangles.
fn bipyramid(sides: u32, radius: f32) -> Vec<[Vec3; 3]> {
    let rim = |k: u32| {
        let angle = std::f32::consts::TAU * (k % sides) as f32 / sides as f32;
        Vec3::new(0.0, radius * angle.cos(), radius * angle.sin())
    };
    let ends = [Vec3::new(2.0, 0.5, 0.5), Vec3::new(-3.0, 0.25, -0.375)];
    (0..sides).flat_map(|k| [[ends[0], rim(k), rim(k + 1)], [ends[1], rim(k + 1), rim(k)]]).collect()
}

/// Returns columns through vertices, through the middles of edges, and anywhere within `reach` in y
/// and z.
fn columns(mesh: &[[Vec3; 3]], reach: f32) -> Vec<Vec2> {
    let flat = |v: Vec3| Vec2::new(v.y, v.z);
    let corners = mesh.iter().flatten().map(|corner| flat(*corner));
    let middles = mesh.iter().map(|[a, b, _]| 0.5 * (flat(*a) + flat(*b)));
    let spread = (0..4000).map(|k| {
        let k = k as f32;
        Vec2::new((k * 0.618_034).fract(), (k * 0.754_877_7).fract()) * 2.0 * reach - reach
    });
    corners.chain(middles).chain(spread).collect()
}

#[test]
fn every_column_is_crossed_an_even_number_of_times() {
    let (mut met, mut odd_naive) = (0, 0);
    for sides in 3..60 {
        let radius = 0.1 * sides as f32;
        let mesh = bipyramid(sides, radius);
        for point in columns(&mesh, 1.2 * radius) {
            let count = |test: fn(Vec3, Vec3, Vec3, Vec2) -> crate::VoxelizationColumn| {
                mesh.iter().filter(|[a, b, c]| test(*a, *b, *c, point).inside).count()
            };
            let exact = count(column);
            assert!(exact.is_multiple_of(2), "{sides} sides, column {point}: {exact}");
            met += usize::from(exact > 0);
            odd_naive += count(column_naive) % 2;
        }
    }
    assert!(met > 50_000, "{met} columns met anything");
    assert!(odd_naive > 0, "the usual form leaks nowhere");
}

/// Returns the faces of tetrahedra. The mesh is closed by construction: each tetrahedron has its
/// four faces, and any number of tetrahedra may meet, inside out or flat.
fn tetrahedra(corners: &[Vec3]) -> Vec<[Vec3; 3]> {
    corners
        .chunks_exact(4)
        .flat_map(|v| [[v[0], v[1], v[2]], [v[1], v[0], v[3]], [v[2], v[1], v[3]], [v[3], v[0], v[2]]])
        .collect()
}

#[test]
fn flat_and_tiny_triangles_leak_nowhere() {
    let mut draws = Draws::of_row(1, 0);
    let (mut met, mut flat) = (0, 0);
    for (count, step) in
        [(3, VOXELIZATION_LATTICE.recip()), (5, VOXELIZATION_LATTICE.recip()), (4, 1.0), (7, 0.3), (3, 5000.0)]
    {
        for _ in 0..2_000 {
            let corners: Vec<Vec3> =
                (0..12).map(|_| Vec3::from([0.0; 3].map(|_| step * (draws.below(count) as f32 - 1.0)))).collect();
            let mesh = tetrahedra(&corners);
            let mut half = || draws.below(2 * count) as f32 / 2.0 - 1.0;
            let place = step * Vec2::new(half(), half());
            let crossed = mesh.iter().filter(|[a, b, c]| column(*a, *b, *c, place).inside).count();
            assert!(crossed.is_multiple_of(2), "{corners:?}, column {place}: {crossed}");
            met += usize::from(crossed > 0);
            let area = |[a, b, c]: &[Vec3; 3]| (*b - *a).cross(*c - *a).x;
            flat += mesh.iter().filter(|triangle| area(triangle) == 0.0).count();
        }
    }
    assert!(met > 3_000 && flat > 30_000, "{met} met anything, {flat} triangles were flat");
}
