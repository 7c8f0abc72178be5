//! `wgsl/voxelization.wgsl`.

mod outside;

use crate::{self as mirror, VoxelizationColumn, VoxelizationEdge, VoxelizationGrid, VoxelizationInteger, oracle};
use glam::{DVec3, IVec2, UVec3, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;

mirror_struct!(crate, VoxelizationGrid { origin, spacing, cells });
mirror_struct!(crate, VoxelizationInteger { high, low });
mirror_struct!(crate, VoxelizationEdge { turn, area });
mirror_struct!(crate, VoxelizationColumn { inside, depth });

const M: &str = "voxelization";

type Triangle = (Vec3, Vec3, Vec3);

fn cells(draws: &mut Draws<'_>) -> u32 {
    8 * (2 + draws.below(31))
}

/// Draws a grid anywhere, or one whose faces f32 represents exactly.
fn grid(draws: &mut Draws<'_>) -> VoxelizationGrid {
    let cells = cells(draws);
    if draws.below(2) == 0 {
        let origin = Vec3::new(whole(draws, 64), whole(draws, 64), whole(draws, 64));
        return VoxelizationGrid { origin, spacing: draws.pick(&[1.0, 0.5, 0.125, 4.0]), cells };
    }
    let spacing = draws.magnitude(-20, 10);
    VoxelizationGrid { origin: cells as f32 * spacing * draws.in_cube(), spacing, cells }
}

/// Draws a whole number from -n to n.
fn whole(draws: &mut Draws<'_>, n: u32) -> f32 {
    draws.below(2 * n + 1) as f32 - n as f32
}

fn in_grid(draws: &mut Draws<'_>, cells: u32) -> UVec3 {
    let mut number = || if draws.below(4) == 0 { draws.pick(&[0, cells - 1]) } else { draws.below(cells) };
    UVec3::new(number(), number(), number())
}

/// Draws half of a small whole number; f32 computes sums of products of these exactly.
fn step(draws: &mut Draws<'_>) -> f32 {
    0.5 * whole(draws, 6)
}

fn steps(draws: &mut Draws<'_>) -> Vec3 {
    Vec3::new(step(draws), step(draws), step(draws))
}

fn is_step(value: f32) -> bool {
    (2.0 * value).fract() == 0.0 && value.abs() <= 8.0
}

fn all_steps(points: &[Vec3]) -> bool {
    points.iter().all(|point| point.to_array().into_iter().all(is_step))
}

/// Draws a triangle of size `size` around `middle`, at least 1/8 as thick as long.
fn fat_triangle(draws: &mut Draws<'_>, middle: DVec3, size: f64) -> Triangle {
    let first = draws.unit_vector().as_dvec3().normalize();
    let second = draws.perpendicular(first);
    let thickness = 0.25 + 0.75 * draws.unit();
    let lean = draws.unit() - 0.5;
    let corners = [-0.5 * first, 0.5 * first, lean * first + thickness * second];
    let shift = (corners[0] + corners[1] + corners[2]) / 3.0;
    let [a, b, c] = corners.map(|corner| (middle + size * (corner - shift)).as_vec3());
    if draws.below(2) == 0 { (a, b, c) } else { (a, c, b) }
}

/// Draws a position in a grid, away from its origin, so that the last place of one coordinate shows
/// the precision of all.
fn place(draws: &mut Draws<'_>) -> DVec3 {
    150.0 + 80.0 * draws.in_cube().as_dvec3()
}

/// Draws a lattice point near the column, or as far away as points can be.
fn point(draws: &mut Draws<'_>) -> IVec2 {
    const MOST: i32 = 1 << 29;
    let mut coordinate = || match draws.below(4) {
        0 => draws.below(5) as i32 - 2,
        1 => draws.pick(&[-MOST, MOST, 1 - MOST, MOST - 1, 1 << 15, (1 << 15) - 1, -(1 << 15)]),
        _ => {
            let size = 1 << draws.below(30);
            draws.below(2 * size + 1) as i32 - size as i32
        }
    };
    IVec2::new(coordinate(), coordinate())
}

/// Draws two lattice points whose difference is within the lattice: anywhere, or nearly on a line
/// through the column.
fn edge(draws: &mut Draws<'_>) -> (IVec2, IVec2) {
    let beside = |draws: &mut Draws<'_>| IVec2::new(draws.below(3) as i32 - 1, draws.below(3) as i32 - 1);
    let far = point(draws);
    let near = far / 2;
    let (one, other) = match draws.below(8) {
        0 | 1 => (far, near + beside(draws)),
        2 => (near, point(draws) / 2),
        3 => (near, near),
        // With ratios whose products stay exact.
        _ => {
            let (over, under) = draws.pick(&[(1, 1), (-1, 1), (1, 2), (-1, 2), (2, 3), (-3, 4), (0, 1)]);
            (near, near / (4 * under) * over + beside(draws))
        }
    };
    if draws.below(2) == 0 { (one, other) } else { (other, one) }
}

/// Draws a triangle and a column: with coordinates from `step`, aimed at the inside, an edge, a
/// corner or beside the triangle, on a few lattice points, or as wide as the lattice.
fn column_case(draws: &mut Draws<'_>) -> (Vec3, Vec3, Vec3, Vec2) {
    let aimed = match draws.below(8) {
        0..3 => return (steps(draws), steps(draws), steps(draws), Vec2::new(step(draws), step(draws))),
        3 => {
            let near = draws.pick(&[0.0, 0.5, 100.0]);
            let mut few = || near + whole(draws, 3) / mirror::VOXELIZATION_LATTICE;
            let flat = [few(), few(), few(), few(), few(), few(), few(), few()];
            let mut corner = |k: usize| Vec3::new(draws.signed(-10, 10), flat[2 * k], flat[2 * k + 1]);
            return (corner(0), corner(1), corner(2), Vec2::new(flat[6], flat[7]));
        }
        4 => {
            let (a, b, c) = (draws.in_cube(), draws.in_cube(), draws.in_cube());
            let share = Vec3::new(draws.between(0.0, 1.0), draws.between(0.0, 1.0), draws.between(0.0, 1.0));
            let position = (share.x * a + share.y * b + share.z * c) / share.element_sum().max(0.1);
            let [a, b, c, position] = [a, b, c, position].map(|corner| mirror::VOXELIZATION_REACH * corner);
            return (a, b, c, Vec2::new(position.y, position.z));
        }
        aimed => aimed,
    };
    let middle = place(draws);
    let size = f64::from(draws.magnitude(-3, 6));
    let (a, b, c) = fat_triangle(draws, middle, size);
    let (v, w) = match aimed {
        5 => draws.pick(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5)]),
        6 => (2.0 * draws.unit() - 0.5, 2.0 * draws.unit() - 0.5),
        _ => {
            let (v, w) = (draws.unit(), draws.unit());
            if v + w > 1.0 { (1.0 - v, 1.0 - w) } else { (v, w) }
        }
    };
    let [p, q, r] = [a, b, c].map(Vec3::as_dvec3);
    let position = (p + v * (q - p) + w * (r - p)).as_vec3();
    (a, b, c, Vec2::new(position.y, position.z))
}

/// Draws a triangle and a column: away from edges, or with coordinates from `step` and an area as
/// seen along x.
fn benign_case(draws: &mut Draws<'_>) -> (Vec3, Vec3, Vec3, Vec2) {
    if draws.below(2) == 0 {
        // Small triangles, so that areas are small too.
        let scale = draws.pick(&[1.0, 1.0 / 16.0]);
        let (a, b, c) = (scale * steps(draws), scale * steps(draws), scale * steps(draws));
        let column = scale * Vec2::new(step(draws), step(draws));
        let flat = |v: Vec3| Vec2::new(v.y, v.z);
        if flat(b - a).perp_dot(flat(c - a)) != 0.0 && a.min_element() > 0.0 && b.x > 0.0 && c.x > 0.0 {
            return (a, b, c, column);
        }
    }
    let mut corner = |y: f32, z: f32| Vec3::new(draws.between(1.0, 2.0), y, z);
    let (a, b, c) = (corner(0.0, 0.0), corner(4.0, 1.0), corner(-1.0, 3.0));
    (a, b, c, Vec2::new(draws.between(0.5, 1.5), draws.between(1.0, 1.5)))
}

/// Draws a triangle and a voxel: with coordinates from `step`, aimed at the voxel's corners and
/// faces, or anywhere near.
fn overlap_case(draws: &mut Draws<'_>) -> (Vec3, Vec3, Vec3, Vec3) {
    if draws.below(2) == 0 {
        let corner = Vec3::new(whole(draws, 1), whole(draws, 1), whole(draws, 1));
        let (a, b, c) = (steps(draws), steps(draws), steps(draws));
        return match draws.below(16) {
            0 => (a, a, a, corner),
            1 => (a, b, b, corner),
            _ => (a, b, c, corner),
        };
    }
    let corner = place(draws).floor();
    let share = |draws: &mut Draws<'_>| if draws.below(2) == 0 { draws.pick(&[0.0, 1.0]) } else { draws.unit() };
    let target = corner + DVec3::new(share(draws), share(draws), share(draws));
    let size = f64::from(draws.magnitude(-3, 4));
    let (a, b, c) = fat_triangle(draws, DVec3::ZERO, size);
    // Moves a corner of the triangle, a point on an edge or a point of the inside to the target or
    // near it.
    let (v, w) = match draws.below(4) {
        0 => (0.0, 0.0),
        1 => (draws.unit(), 0.0),
        _ => (0.5 * draws.unit(), 0.5 * draws.unit()),
    };
    let [p, q, r] = [a, b, c].map(Vec3::as_dvec3);
    let aside = if draws.below(3) == 0 { draws.in_cube().as_dvec3() } else { DVec3::ZERO };
    let shift = target + aside - (p + v * (q - p) + w * (r - p));
    ((p + shift).as_vec3(), (q + shift).as_vec3(), (r + shift).as_vec3(), corner.as_vec3())
}

fn exact_triangle((a, b, c): Triangle) -> [DVec3; 3] {
    [a, b, c].map(Vec3::as_dvec3)
}

/// Returns every function of the module, bound to its mirror and its oracle, with its promises
/// outside its domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [grid_formulas(), column_formulas(), row_formulas(), surface_formulas()].into_iter().flatten().collect()
}

fn grid_formulas() -> Vec<Formula> {
    vec![
        formula(M, "voxelization_index", mirror::index, oracle::index, |draws| {
            let grid = grid(draws);
            (grid, in_grid(draws, grid.cells))
        })
        .edge("the first", |(_, voxel)| voxel == UVec3::ZERO)
        .edge("the last of the largest grid", |(grid, voxel)| grid.cells == 256 && voxel.min_element() == 255)
        .build(),
        formula(M, "voxelization_centre", mirror::centre, oracle::centre, |draws| {
            let grid = grid(draws);
            (grid, in_grid(draws, grid.cells))
        })
        .edge("the first", |(_, voxel)| voxel == UVec3::ZERO)
        .edge("near the world's origin", |(grid, voxel)| {
            mirror::centre(grid, voxel).abs().max_element() < 2.0 * grid.spacing
        })
        .build(),
        formula(M, "voxelization_local", mirror::local, oracle::local, |draws| {
            let grid = grid(draws);
            (grid, grid.origin + 2.0 * grid.cells as f32 * grid.spacing * draws.in_cube())
        })
        .edge("before the grid", |(grid, position)| position.cmplt(grid.origin).all())
        .build(),
        formula(M, "voxelization_voxel", mirror::voxel, oracle::voxel, |draws| {
            let grid = grid(draws);
            if grid.origin.fract() == Vec3::ZERO {
                // A face, an edge or a corner between voxels, exactly.
                let face = |draws: &mut Draws<'_>| whole(draws, grid.cells + 4) * 0.5 * grid.spacing;
                return (grid, grid.origin + Vec3::new(face(draws), face(draws), face(draws)));
            }
            let extent = grid.cells as f32 * grid.spacing;
            (grid, grid.origin + extent * (Vec3::splat(0.5) + 0.6 * draws.in_cube()))
        })
        .edge("outside on both sides", |(grid, position)| {
            let local = mirror::local(grid, position);
            local.min_element() < 0.0 && local.max_element() > grid.cells as f32
        })
        .edge("on a face", |(grid, position)| mirror::local(grid, position).x.fract() == 0.0)
        .invariant_at_nearest("on faces that f32 holds all is exact", |(grid, position), voxel: UVec3| {
            if grid.origin.fract() != Vec3::ZERO {
                return Ok(());
            }
            let exact = oracle::VoxelizationGrid {
                origin: grid.origin.as_dvec3(),
                spacing: grid.spacing.into(),
                cells: grid.cells,
            };
            let wanted = oracle::voxel(exact, position.as_dvec3());
            if voxel == wanted { Ok(()) } else { Err(format!("{voxel}, not {wanted}")) }
        })
        .build(),
    ]
}

fn column_formulas() -> Vec<Formula> {
    // The triangle under the diagonal of the square from (0, 0) to (4, 4), with two columns; a column
    // at an apex; a triangle seen edge-on.
    let corner = |y: f32, z: f32| Vec3::new(2.0, y, z);
    let under = (corner(0.0, 0.0), corner(4.0, 0.0), corner(4.0, 4.0), Vec2::splat(1.5));
    let closed_end = (corner(0.0, 0.0), corner(4.0, 0.0), corner(4.0, 4.0), Vec2::new(4.0, 1.5));
    let apex = (corner(1.5, 2.5), corner(0.0, 0.0), corner(3.0, 0.0), Vec2::new(1.5, 2.5));
    let edge_on = (Vec3::new(1.0, 0.0, 0.0), Vec3::new(2.0, 1.0, 1.0), Vec3::new(3.0, 2.0, 2.0), Vec2::splat(0.5));
    let naive = "voxelization_column_naive";
    vec![
        formula(M, "voxelization_lattice", mirror::lattice, oracle::lattice, |draws| {
            let mut coordinate = || match draws.below(4) {
                0 => (whole(draws, 99) + 0.5) / mirror::VOXELIZATION_LATTICE,
                1 => {
                    let between = whole(draws, 400) + 0.5 / mirror::VOXELIZATION_LATTICE;
                    draws.nudged(between, 1)
                }
                2 => draws.between(-mirror::VOXELIZATION_REACH, mirror::VOXELIZATION_REACH),
                _ => draws.signed(-30, 13),
            };
            (Vec2::new(coordinate(), coordinate()),)
        })
        .edge("between two points", |(position,)| {
            (mirror::VOXELIZATION_LATTICE * position).fract().abs().max_element() == 0.5
        })
        .edge("before the origin", |(position,)| position.max_element() < 0.0)
        .edge("a hundred voxels away", |(position,)| position.abs().min_element() > 100.0)
        .build(),
        formula(M, "voxelization_cross", mirror::cross, oracle::cross, |draws| (point(draws), point(draws)))
            .edge("negative and small", |(p, q)| mirror::cross(p, q).high == -1)
            .edge("above 2^57", |(p, q)| mirror::cross(p, q).high > 1 << 27)
            .edge("below -2^57", |(p, q)| mirror::cross(p, q).high < -(1 << 27))
            .pair(
                "the other way round it changes its sign",
                |(p, q)| (q, p),
                |_, one: VoxelizationInteger, other: VoxelizationInteger| {
                    let [one, other] = [one, other].map(|part| (i64::from(part.high) << 30) + i64::from(part.low));
                    if one == -other { Ok(()) } else { Err(format!("{one}, {other}")) }
                },
            )
            .build(),
        formula(M, "voxelization_edge", mirror::edge, oracle::edge, edge)
            .edge("without length", |(p, q)| p == q)
            .edge("on the column", |(p, q)| p != q && oracle::edge(p, q).area == 0.0)
            .edge("on the column and along y", |(p, q)| p.y == 0 && q.y == 0 && p.x != q.x)
            .edge("small of large parts", |(p, q)| {
                let area = mirror::cross(p, q);
                area.high == -1 && area.low > 1_073_741_000 && p.abs().max_element() > 1 << 20
            })
            .pair(
                "the other way round it turns the other way",
                |(p, q)| (q, p),
                |_, one: VoxelizationEdge, other: VoxelizationEdge| {
                    if one.turn == -other.turn { Ok(()) } else { Err(format!("{one:?}, {other:?}")) }
                },
            )
            .build(),
        formula(M, "voxelization_column", mirror::column, oracle::column, column_case)
            .edge("inside", |(a, b, c, column)| mirror::column(a, b, c, column).inside)
            .edge("outside", |(a, b, c, column)| !mirror::column(a, b, c, column).inside)
            .edge("at a corner", |(a, _, _, column)| a.y == column.x && a.z == column.y)
            .edge("seen edge-on", |(a, b, c, _)| {
                let (p, q) = (b - a, c - a);
                p.y * q.z == p.z * q.y && p.y != q.y
            })
            .edge("across x", |(a, b, c, column)| a.x == b.x && b.x == c.x && mirror::column(a, b, c, column).inside)
            .edge("of a few points, inside", |(a, b, c, column)| {
                let size = a.max(b).max(c) - a.min(b).min(c);
                size.y.max(size.z) < 1e-3 && mirror::column(a, b, c, column).inside
            })
            .edge("as wide as the lattice, inside", |(a, b, c, column)| {
                let size = a.max(b).max(c) - a.min(b).min(c);
                size.y.min(size.z) > mirror::VOXELIZATION_REACH && mirror::column(a, b, c, column).inside
            })
            .invariant("the depth is the triangle's", |(a, b, c, _), found: VoxelizationColumn| {
                let extent = a.x.min(b.x).min(c.x)..=a.x.max(b.x).max(c.x);
                if !found.inside || extent.contains(&found.depth) { Ok(()) } else { Err(format!("{found:?}")) }
            })
            .pair(
                "the corners may be named in any order",
                |(a, b, c, column)| (c, b, a, column),
                |(a, b, c, _), one: VoxelizationColumn, other: VoxelizationColumn| {
                    // Errors of three weights, of the products and their sum, of the sum of the
                    // weights and of the quotient, in either order.
                    let most = f64::from(a.x.abs().max(b.x.abs()).max(c.x.abs())) * 24.0 * 2f64.powi(-23);
                    near("depth", one.depth.into(), other.depth.into(), most)?;
                    if one.inside == other.inside { Ok(()) } else { Err(format!("{one:?}, {other:?}")) }
                },
            )
            .hard_case("on a shared edge: the other triangle's", under, (&[0.0, 0.0], 0.0), (naive, 1.0))
            .hard_case("on an edge at the upper end", closed_end, (&[0.0, 0.0], 0.0), (naive, 1.0))
            .hard_case("at a corner that points up in z", apex, (&[0.0, 0.0], 0.0), (naive, 1.0))
            .hard_case("seen edge-on", edge_on, (&[0.0, 0.0], 0.0), (naive, f64::INFINITY))
            .build(),
        formula(M, "voxelization_column_naive", mirror::column_naive, oracle::column_naive, benign_case)
            .benign(1e-6)
            .build(),
    ]
}

fn row_formulas() -> Vec<Formula> {
    vec![
        formula(M, "voxelization_first", mirror::first, oracle::first, |draws| {
            let cells = cells(draws);
            let coordinate = match draws.below(4) {
                0 => {
                    let half = whole(draws, cells + 2) * 0.5 + 0.5 * cells as f32;
                    draws.nudged(half, 1)
                }
                1 => draws.signed(-30, 40),
                _ => draws.between(-1.0, cells as f32 + 1.0),
            };
            (coordinate, cells)
        })
        .edge("at a centre", |(x, _)| x > 0.0 && x.fract() == 0.5)
        .edge("just behind a centre", |(x, _)| x > 1.0 && x.next_down().fract() == 0.5)
        .edge("just before the last centre", |(x, cells)| x.next_up() == cells as f32 - 0.5)
        .edge("behind the last centre", |(x, cells)| x > cells as f32 - 0.5)
        .edge("far before", |(x, _)| x < -1e9)
        .edge("just before the first centre", |(x, _)| x == 0.5f32.next_down())
        .build(),
        formula(M, "voxelization_prefix", mirror::prefix, oracle::prefix, |draws| {
            let all = draws.bits();
            (if draws.below(4) == 0 { 1 << (all % 32) } else { all },)
        })
        .edge("the least bit alone", |(bits,)| bits == 1)
        .edge("the last bit alone", |(bits,)| bits == 1 << 31)
        .build(),
        formula(M, "voxelization_range", mirror::range, oracle::range, |draws| {
            let cells = cells(draws);
            let end = |draws: &mut Draws<'_>| match draws.below(4) {
                0 => 0.5 * whole(draws, cells) + 0.5 * cells as f32,
                1 => draws.signed(-30, 40),
                _ => draws.between(-2.0, cells as f32 + 2.0),
            };
            let (one, other) = (end(draws), end(draws));
            let other = if draws.below(4) == 0 { one } else { other };
            (one.min(other), one.max(other), cells)
        })
        .edge("before the grid", |(_, high, _)| high < 0.0)
        .edge("behind the grid", |(low, _, cells)| low > cells as f32)
        .edge("ends at a face", |(_, high, _)| high > 0.0 && high.fract() == 0.0)
        .edge("begins at a face", |(low, high, cells)| {
            low > 0.0 && low < cells as f32 && low.fract() == 0.0 && high > low
        })
        .edge("a point", |(low, high, cells)| low == high && low > 0.0 && low < cells as f32)
        .edge("all of it", |(low, high, cells)| low < 0.0 && high > cells as f32)
        .build(),
    ]
}

fn surface_formulas() -> Vec<Formula> {
    vec![
        formula(M, "voxelization_taxicab", mirror::taxicab, oracle::taxicab, |draws| {
            (draws.magnitude(-20, 20) * draws.in_cube(),)
        })
        .build(),
        formula(M, "voxelization_margin", mirror::margin, oracle::margin, |draws| {
            let size = draws.magnitude(-10, 10);
            (size * draws.in_cube(), size * draws.in_cube(), size * draws.in_cube())
        })
        .edge("within a voxel", |(a, b, c)| a.abs().max(b.abs()).max(c.abs()).max_element() < 0.1)
        .edge("a large negative coordinate", |(a, b, c)| {
            -a.min(b).min(c).min_element() > 100.0 && a.max(b).max(c).max_element() < 50.0
        })
        .build(),
        formula(M, "voxelization_span", mirror::span, oracle::span, |draws| {
            let (a, b, c, corner) = overlap_case(draws);
            (a, b, c, Vec2::new(corner.y, corner.z))
        })
        .edge("seen edge-on", |(a, b, c, _)| (b - a).cross(c - a).x == 0.0 && (b - a).cross(c - a) != Vec3::ZERO)
        .edge("no area", |(a, b, c, _)| (b - a).cross(c - a) == Vec3::ZERO)
        .edge("passed by", |(a, b, c, corner)| {
            let span = mirror::span(a, b, c, corner);
            span.x > span.y
        })
        .edge("shorter than the extent", |(a, b, c, corner)| {
            let span = mirror::span(a, b, c, corner);
            span.x > a.x.min(b.x).min(c.x) && span.y < a.x.max(b.x).max(c.x) && span.x < span.y
        })
        .invariant("no voxel that the triangle touches is left out", |(a, b, c, corner), span: Vec2| {
            let low = a.x.min(b.x).min(c.x).floor() - 1.0;
            let voxels = (0..40).map(|step| low + step as f32);
            let missed = voxels.filter(|x| x + 1.0 < span.x || *x > span.y).find(|x| {
                let voxel = DVec3::new(f64::from(*x), corner.x.into(), corner.y.into());
                oracle::touches(exact_triangle((a, b, c)), voxel, 0.0)
            });
            missed.map_or(Ok(()), |x| Err(format!("the voxel at {x}")))
        })
        .build(),
        formula(M, "voxelization_overlaps", mirror::overlaps, oracle::overlaps, overlap_case)
            .edge("touched", |(a, b, c, corner)| mirror::overlaps(a, b, c, corner))
            .edge("not touched", |(a, b, c, corner)| !mirror::overlaps(a, b, c, corner))
            .edge("no area", |(a, b, c, _)| (b - a).cross(c - a) == Vec3::ZERO)
            .edge("a point", |(a, b, c, _)| a == b && b == c)
            .edge("touched, but not as f64 sees it without a margin", |(a, b, c, corner)| {
                let without = oracle::touches(exact_triangle((a, b, c)), corner.as_dvec3(), 0.0);
                mirror::overlaps(a, b, c, corner) && !without
            })
            .invariant("what is touched in exact arithmetic is never missed", |(a, b, c, corner), found: bool| {
                let touched = oracle::touches(exact_triangle((a, b, c)), corner.as_dvec3(), 0.0);
                if found || !touched { Ok(()) } else { Err("missed".to_owned()) }
            })
            .invariant("on a grid of steps all is exact", |(a, b, c, corner), found: bool| {
                let touched = oracle::touches(exact_triangle((a, b, c)), corner.as_dvec3(), 1e-4);
                if !all_steps(&[a, b, c, corner]) || found == touched { Ok(()) } else { Err(format!("{found}")) }
            })
            .pair(
                "the corners may be named in any order",
                |(a, b, c, corner)| (b, c, a, corner),
                |(a, b, c, corner), one: bool, other: bool| {
                    // Within the margin, rounding decides.
                    let wide = oracle::touches(exact_triangle((a, b, c)), corner.as_dvec3(), 0.01);
                    let narrow = oracle::touches(exact_triangle((a, b, c)), corner.as_dvec3(), 0.0);
                    if one == other || wide != narrow { Ok(()) } else { Err(format!("{one}, {other}")) }
                },
            )
            .build(),
    ]
}
