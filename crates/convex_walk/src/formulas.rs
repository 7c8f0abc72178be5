//! Test inputs, edges, invariants and hard cases of `wgsl/convex_walk.wgsl`.

use crate::{self as mirror, oracle};
use glam::{DVec2, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::outside::{Promise, finite, holds, that};

const M: &str = "convex_walk";

/// Draws a direction: anywhere, along an axis, or in a coordinate plane.
fn direction(draws: &mut Draws<'_>) -> Vec3 {
    match draws.below(4) {
        0 => draws.pick(&[Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z]),
        1 => {
            let plane = draws.pick(&[Vec3::new(0.0, 1.0, 1.0), Vec3::new(1.0, 0.0, 1.0), Vec3::new(1.0, 1.0, 0.0)]);
            (draws.unit_vector() * plane).try_normalize().unwrap_or(Vec3::X)
        }
        _ => draws.unit_vector(),
    }
}

/// Draws a box, and a ray from inside it or from its surface.
fn ray_in_box(draws: &mut Draws<'_>) -> (Vec3, Vec3, Vec3, Vec3) {
    let size = if draws.below(2) == 0 { 1.0 } else { draws.magnitude(-10, 12) };
    let corner = |draws: &mut Draws<'_>| {
        size * Vec3::new(draws.between(0.25, 1.0), draws.between(0.25, 1.0), draws.between(0.25, 1.0))
    };
    let (lower, upper) = (-corner(draws), corner(draws));
    let share = 0.5 * (draws.in_cube() + 1.0);
    let share = match draws.below(4) {
        0 => share.round(),
        1 => Vec3::new(share.x.round(), share.y, share.z),
        _ => share,
    };
    let position = Vec3::select(share.cmpeq(Vec3::ONE), upper, lower + share * (upper - lower));
    // No component so small that a device may take it for 0.
    let kept = |value: f32| if value.abs() < 1e-3 * size { 0.0 } else { value };
    let position = Vec3::new(kept(position.x), kept(position.y), kept(position.z));
    (position.clamp(lower, upper), direction(draws), lower, upper)
}

/// Draws a point of any length in a direction.
fn point(draws: &mut Draws<'_>) -> (Vec3,) {
    (draws.magnitude(-40, 40) * direction(draws),)
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), promises())
}

fn functions() -> Vec<Formula> {
    let on_edge = |x: f32| x.abs() == 1.0;
    vec![
        formula(M, "convex_walk_exit", mirror::exit, oracle::exit, ray_in_box)
            .edge("from a side of the box", |(position, _, lower, upper)| {
                position.cmpeq(lower).any() || position.cmpeq(upper).any()
            })
            .edge("along an axis", |(_, direction, ..)| direction.abs().max_element() == 1.0)
            .edge("parallel to one side", |(_, direction, ..)| {
                direction.to_array().iter().filter(|part| **part == 0.0).count() == 1
            })
            .invariant("the end lies on a side of the box, and beyond none", |ray, distance: f32| {
                let (position, direction, lower, upper) = ray;
                let end = position.as_dvec3() + f64::from(distance) * direction.as_dvec3();
                let beyond = (end - upper.as_dvec3()).max(lower.as_dvec3() - end).max_element();
                let size = f64::from((upper - lower).max_element());
                near("height over the box", beyond, 0.0, 4e-6 * size)
            })
            .build(),
        formula(M, "convex_walk_square", mirror::square, oracle::square, point)
            .edge("straight up", |(point,)| point.x == 0.0 && point.y == 0.0 && point.z > 0.0)
            .edge("straight down", |(point,)| point.x == 0.0 && point.y == 0.0 && point.z < 0.0)
            .edge("on the octahedron's edge", |(point,)| point.z == 0.0)
            .edge("below, between two corners", |(point,)| (point.x == 0.0) != (point.y == 0.0) && point.z < 0.0)
            .edge("below", |(point,)| point.x != 0.0 && point.y != 0.0 && point.z < 0.0)
            .invariant("it lies on the square, upper directions in its inner half", |(point,), square: Vec2| {
                let sum = square.as_dvec2().abs().element_sum();
                let inner = if point.z >= 0.0 { sum <= 1.0 + 1e-6 } else { sum >= 1.0 - 1e-6 };
                let right = inner && square.abs().max_element() <= 1.0 + 1e-6;
                if right { Ok(()) } else { Err(format!("{square} of {point}")) }
            })
            .hard_case_with(
                "a culet, straight below the origin",
                (Vec3::new(0.0, 0.0, -0.86),),
                (&[1.0, 1.0], 1e-12),
                ("convex_walk_square_naive", (Vec3::new(0.0, 0.0, -0.86),), 1.0),
            )
            .hard_case_with(
                "the middle of a main facet, straight below an axis",
                (Vec3::new(0.5, 0.0, -0.5),),
                (&[1.0, 0.5], 1e-12),
                ("convex_walk_square_naive", (Vec3::new(0.5, 0.0, -0.5),), 0.4),
            )
            .build(),
        formula(M, "convex_walk_square_naive", mirror::square_naive, oracle::square, |draws| {
            let mut part = || draws.between(0.0625, 1.0) * if draws.below(2) == 0 { -1.0 } else { 1.0 };
            let (x, y, side) = (part(), part(), part());
            (Vec3::new(x, y, draws.magnitude(-10, 0).copysign(side)),)
        })
        .benign(1e-6)
        .build(),
        formula(M, "convex_walk_cell", mirror::cell, oracle::cell, |draws| {
            let most = draws.pick(&[64, 2048]);
            let side = 2 * (1 + draws.below(most));
            let square = draws.in_cube().truncate();
            let square = match draws.below(4) {
                // On a boundary between cells, or a few ulp beside it.
                0 => (0.5 * side as f32 * square).round() / (0.5 * side as f32),
                1 => square * draws.magnitude(-30, -1),
                2 => Vec2::new(square.x.signum(), square.y),
                _ => square,
            };
            (square, side)
        })
        .edge("on a boundary", |(square, side): (Vec2, u32)| {
            let place = DVec2::new(square.x.into(), square.y.into()) * (0.5 * f64::from(side));
            place.x.fract() == 0.0 || place.y.fract() == 0.0
        })
        .edge("just below the middle", |(square, _)| square.x < 0.0 && square.x > -1e-6)
        .edge("on the square's edge", move |(square, _)| on_edge(square.x) || on_edge(square.y))
        .edge("the smallest map", |(_, side)| side == 2)
        .invariant("it is a cell of the map", |(_, side), cell: u32| {
            if cell < side * side { Ok(()) } else { Err(format!("cell {cell} of {}", side * side)) }
        })
        .build(),
    ]
}

/// One promise for each clause of the `Outside:` lines.
fn promises() -> Vec<Promise> {
    vec![
        finite("convex_walk_exit", "finite for positions and corners up to 1e18", |draws| {
            let mut point = || Vec3::new(draws.signed(-126, 59), draws.signed(-126, 59), draws.signed(-126, 59));
            let (position, lower, upper) = (point(), point(), point());
            (position, draws.unit_vector(), lower, upper)
        }),
        holds(
            "convex_walk_exit",
            "from a start beyond the side, 0",
            |draws| {
                let direction = draws.unit_vector();
                (2.0 * direction.signum(), direction, Vec3::NEG_ONE, Vec3::ONE)
            },
            |_: (Vec3, Vec3, Vec3, Vec3), distance: f32| that(distance == 0.0, || format!("{distance}")),
        ),
        finite("convex_walk_square", "finite up to 1e37, also at the origin", |draws| {
            let part = |draws: &mut Draws<'_>| if draws.below(4) == 0 { 0.0 } else { draws.signed(-126, 122) };
            (Vec3::new(part(draws), part(draws), part(draws)),)
        }),
        holds(
            "convex_walk_cell",
            "coordinates beyond the square count as on its edge",
            |draws| {
                let part = |draws: &mut Draws<'_>| draws.signed(1, 100);
                (Vec2::new(part(draws), part(draws)), 64u32)
            },
            |(square, side): (Vec2, u32), cell: u32| {
                let edge = mirror::cell(square.clamp(Vec2::NEG_ONE, Vec2::ONE), side);
                that(cell == edge, || format!("{cell}, not {edge}"))
            },
        ),
    ]
}
