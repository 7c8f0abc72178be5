//! Promises of the functions outside their domains, for each clause of their `Outside:` lines.

use crate::{VoxelizationColumn, VoxelizationEdge, VoxelizationGrid, VoxelizationInteger, oracle};
use glam::{DVec3, IVec2, UVec2, UVec3, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{
    Promise, accurate, any_bits, any_finite, any_number, any_numbers, any_vector, finite, holds, nothing, that,
    vector_up_to,
};

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    const OVERLAPS: &str = "voxelization_overlaps";
    let grid = |draws: &mut Draws<'_>, high: i32| VoxelizationGrid {
        origin: vector_up_to(draws, high),
        spacing: draws.magnitude(-60, high),
        cells: any_number(draws).max(1),
    };
    let point = |draws: &mut Draws<'_>| IVec2::new(any_number(draws).cast_signed(), any_number(draws).cast_signed());
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
            "a voxel of the grid",
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
            "voxelization_lattice",
            "the lattice's last point, on the position's side",
            |draws| (Vec2::new(any_finite(draws), any_finite(draws)),),
            |(position,): (Vec2,), found: IVec2| {
                let wanted = oracle::lattice(position.as_dvec2());
                that(found == wanted, || format!("{found}, not {wanted}"))
            },
        ),
        holds(
            "voxelization_cross",
            "any number, with low from 0 to 2^30 - 1",
            move |draws| (point(draws), point(draws)),
            |_: (IVec2, IVec2), found: VoxelizationInteger| {
                that((0..1 << 30).contains(&found.low), || format!("{found:?}"))
            },
        ),
        holds(
            "voxelization_edge",
            "turn from -1 to 1, area from 0 to 2^62",
            move |draws| (point(draws), point(draws)),
            |_: (IVec2, IVec2), found: VoxelizationEdge| {
                let within = (-1..=1).contains(&found.turn) && (0.0..=2f32.powi(62)).contains(&found.area);
                that(within, || format!("{found:?}"))
            },
        ),
        holds(
            "voxelization_column",
            "inside as for the lattice's last points",
            |draws| {
                (
                    any_vector(draws),
                    any_vector(draws),
                    any_vector(draws),
                    Vec2::new(any_finite(draws), any_finite(draws)),
                )
            },
            |(a, b, c, column): (Vec3, Vec3, Vec3, Vec2), found: VoxelizationColumn| {
                // The x coordinates make no difference.
                let [a, b, c] = [a, b, c].map(|corner| DVec3::new(0.0, corner.y.into(), corner.z.into()));
                let wanted = oracle::column(a, b, c, column.as_dvec2());
                that(found.inside == wanted.inside, || format!("inside: {}", found.inside))
            },
        ),
        accurate("voxelization_first", "nothing; from 0 to cells for any input", |draws| {
            (any_finite(draws), draws.below(1 << 22))
        }),
        holds(
            "voxelization_first",
            "nothing; from 0 to cells for any input",
            |draws| (any_bits(draws), any_number(draws)),
            |(_, cells): (f32, u32), first: u32| that(first <= cells, || format!("{first} of {cells}")),
        ),
        accurate("voxelization_prefix", "nothing", |draws| (any_number(draws),)),
        nothing("voxelization_taxicab", "infinite or a NaN"),
        nothing("voxelization_margin", "infinite or a NaN"),
        holds(
            "voxelization_range",
            "no voxel for low > high + 1",
            |draws| {
                let high = draws.signed(-10, 22);
                (1.001 * (high.max(-high) + 2.0), high, draws.below(1 << 22))
            },
            |_: (f32, f32, u32), range: UVec2| that(range.x == range.y, || format!("from {} to {}", range.x, range.y)),
        ),
        holds(
            "voxelization_range",
            "from 0 to cells for any input",
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
                // The voxel that contains a corner of the triangle.
                (a, b, c, a.floor())
            },
            |_: (Vec3, Vec3, Vec3, Vec3), overlaps: bool| {
                that(overlaps, || "it misses a corner's own voxel".to_owned())
            },
        ),
    ]
}
