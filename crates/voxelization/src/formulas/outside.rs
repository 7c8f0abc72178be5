//! What the functions promise outside of their domains, clause by clause of their `Outside:` lines.

use crate::{VoxelizationColumn, VoxelizationCrossing, VoxelizationGrid};
use glam::{UVec2, UVec3, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{
    Promise, accurate, any_bits, any_finite, any_number, any_numbers, any_vector, finite, holds, nothing, that,
    vector_up_to,
};

/// Every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    const OVERLAPS: &str = "voxelization_overlaps";
    let grid = |draws: &mut Draws<'_>, high: i32| VoxelizationGrid {
        origin: vector_up_to(draws, high),
        spacing: draws.magnitude(-60, high),
        cells: any_number(draws).max(1),
    };
    let crossed = |a: Vec3, b: Vec3, y: f32| (a.y <= y) != (b.y <= y);
    vec![
        holds(
            "voxelization_index",
            "the same, modulo 2^32",
            move |draws| (grid(draws, 10), any_numbers(draws)),
            |(grid, voxel): (VoxelizationGrid, UVec3), index: u32| {
                let [x, y, z] = voxel.to_array();
                let wanted = x.wrapping_add(grid.cells.wrapping_mul(y.wrapping_add(grid.cells.wrapping_mul(z))));
                that(index == wanted, || format!("{index}, not {wanted}"))
            },
        ),
        finite("voxelization_centre", "finite as long as the centre is", move |draws| {
            (grid(draws, 90), any_numbers(draws))
        }),
        nothing("voxelization_local", "infinite or a NaN"),
        holds(
            "voxelization_voxel",
            "some voxel of the grid",
            move |draws| {
                let spacing = any_bits(draws);
                let wild = Vec3::new(any_bits(draws), any_bits(draws), any_bits(draws));
                (VoxelizationGrid { spacing, ..grid(draws, 100) }, wild)
            },
            |(grid, _): (VoxelizationGrid, Vec3), voxel: UVec3| {
                that(voxel.max_element() < grid.cells, || format!("the voxel is {voxel}"))
            },
        ),
        holds(
            "voxelization_between",
            "within the box for a smaller sum too",
            |draws| {
                let small = |draws: &mut Draws<'_>| if draws.below(4) == 0 { 0.0 } else { draws.magnitude(-149, -127) };
                (draws.in_square(), draws.in_square(), small(draws), small(draws))
            },
            |(one, other, ..): (Vec2, Vec2, f32, f32), found: Vec2| {
                let inside = found.cmpge(one.min(other)).all() && found.cmple(one.max(other)).all();
                that(inside, || format!("{found}"))
            },
        ),
        holds(
            "voxelization_crossing",
            "crossed as the comparisons say",
            |draws| (any_vector(draws), any_vector(draws), any_finite(draws)),
            move |(a, b, y): (Vec3, Vec3, f32), crossing: VoxelizationCrossing| {
                that(crossing.crossed == crossed(a, b, y), || format!("crossed: {}", crossing.crossed))
            },
        ),
        holds(
            "voxelization_column",
            "as voxelization_crossing",
            |draws| {
                (
                    any_vector(draws),
                    any_vector(draws),
                    any_vector(draws),
                    Vec2::new(any_finite(draws), any_finite(draws)),
                )
            },
            move |(a, b, c, column): (Vec3, Vec3, Vec3, Vec2), found: VoxelizationColumn| {
                let edges = [(a, b), (b, c), (c, a)].into_iter().filter(|(from, to)| crossed(*from, *to, column.x));
                that(!found.inside || edges.count() == 2, || "inside, though the line crosses no edge".to_owned())
            },
        ),
        accurate("voxelization_first", "none is; from 0 to cells whatever comes in", |draws| {
            (any_finite(draws), draws.below(1 << 22))
        }),
        holds(
            "voxelization_first",
            "none is; from 0 to cells whatever comes in",
            |draws| (any_bits(draws), any_number(draws)),
            |(_, cells): (f32, u32), first: u32| that(first <= cells, || format!("{first} of {cells}")),
        ),
        accurate("voxelization_prefix", "none is", |draws| (any_number(draws),)),
        nothing("voxelization_taxicab", "infinite or a NaN"),
        nothing("voxelization_margin", "infinite or a NaN"),
        holds(
            "voxelization_range",
            "none for low > high + 1",
            |draws| {
                let high = draws.signed(-10, 22);
                (1.001 * (high.max(-high) + 2.0), high, draws.below(1 << 22))
            },
            |_: (f32, f32, u32), range: UVec2| that(range.x == range.y, || format!("from {} to {}", range.x, range.y)),
        ),
        holds(
            "voxelization_range",
            "from 0 to cells whatever comes in",
            |draws| (any_bits(draws), any_bits(draws), any_number(draws)),
            |(_, _, cells): (f32, f32, u32), range: UVec2| {
                that(range.x <= range.y && range.y <= cells, || format!("from {} to {}", range.x, range.y))
            },
        ),
        finite("voxelization_span", "finite for coordinates from 1e-6 to 1e11, or 0", |draws| {
            let coordinate = |draws: &mut Draws<'_>| if draws.below(8) == 0 { 0.0 } else { draws.signed(-19, 35) };
            let vector = |draws: &mut Draws<'_>| Vec3::new(coordinate(draws), coordinate(draws), coordinate(draws));
            (vector(draws), vector(draws), vector(draws), Vec2::new(coordinate(draws), coordinate(draws)))
        }),
        holds(
            OVERLAPS,
            "as long as products of three coordinates are finite",
            |draws| {
                let size = draws.magnitude(0, 39);
                let (a, b, c) = (size * draws.in_cube(), size * draws.in_cube(), size * draws.in_cube());
                // The voxel that holds a corner of the triangle.
                (a, b, c, a.floor())
            },
            |_: (Vec3, Vec3, Vec3, Vec3), overlaps: bool| {
                that(overlaps, || "it misses a corner's own voxel".to_owned())
            },
        ),
    ]
}
