//! Test inputs, edges, invariants and hard cases of `wgsl/ray_footprint.wgsl`.

use crate::{self as mirror, oracle};
use glam::{Vec3, Vec4, vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::outside::{Promise, finite, holds, like, that, vector_up_to};

const M: &str = "ray_footprint";

/// Arguments of an edge.
type Case = (Vec3, Vec3, Vec3, Vec3, Vec3, f32);

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), promises())
}

/// Draws the normal of a plane that a ray meets at a slope: any, small, 0 or 1.
fn normal(draws: &mut Draws<'_>, direction: Vec3, least: f32) -> Vec3 {
    let along = direction.as_dvec3().normalize();
    let slope = match draws.below(8) {
        0 => f64::from(least),
        1 => f64::from(draws.magnitude(-20, -4).max(least)),
        2 => 1.0,
        _ => f64::from(draws.between(least, 1.0)),
    };
    let across = draws.perpendicular(along);
    let normal = (slope * along + (1.0 - slope * slope).max(0.0).sqrt() * across).as_vec3();
    // The rounded normal may point away from the ray, which the domain excludes.
    if normal.dot(direction) < 0.0 { direction } else { normal }
}

/// Draws a ray, two offsets about as long as a pixel is wide, and the planes of two facets.
fn case(draws: &mut Draws<'_>, least: f32) -> Case {
    let direction = draws.unit_vector();
    let nearest = normal(draws, direction, least);
    // Nearly the same plane, the same one, or any.
    let runner_up = match draws.below(6) {
        0 => nearest,
        1 => (nearest + 1e-3 * draws.in_cube()).normalize(),
        _ => normal(draws, direction, least),
    };
    let runner_up = if runner_up.dot(direction) < least { nearest } else { runner_up };
    // One of the planes is not edge-on.
    let edge_on = nearest.dot(direction).max(runner_up.dot(direction)) < 1e-3;
    let runner_up = if edge_on { normal(draws, direction, 1e-2) } else { runner_up };
    let size = draws.magnitude(-20, 12);
    let (right, down) = (size * draws.in_cube(), size * draws.in_cube());
    let gap = if draws.below(8) == 0 { 0.0 } else { draws.magnitude(-20, 12) };
    (direction, right, down, nearest, runner_up, gap)
}

/// Draws a line in a pixel: any, through the middle, through a corner, beyond it, along an axis.
fn line(draws: &mut Draws<'_>) -> Vec3 {
    let size = draws.magnitude(-20, 20);
    let signed = |draws: &mut Draws<'_>| (2.0 * draws.unit() - 1.0) as f32;
    let (x, y) = match draws.below(7) {
        6 => (0.0, 0.0),
        0 => (signed(draws), 0.0),
        1 => (0.0, signed(draws)),
        2 => {
            let x = signed(draws);
            (x, if draws.below(2) == 0 { x } else { -x })
        }
        3 => (signed(draws), draws.signed(-20, 0)),
        _ => (signed(draws), signed(draws)),
    };
    let clear = |value: f32| if value.abs() < 1e-7 { 0.0 } else { value };
    let (x, y) = (clear(x), clear(y));
    let f = match draws.below(6) {
        0 => 0.0,
        1 => 0.5 * (x.abs() - y.abs()).abs(),
        2 => 2.0 * draws.unit() as f32,
        _ => draws.unit() as f32 * 0.5 * (x.abs() + y.abs()),
    };
    size * vec3(f, x, y)
}

/// Returns half the sum of the gradient's magnitudes: the f at which a line leaves the pixel.
fn reach(edge: Vec3) -> f32 {
    0.5 * (edge.y.abs() + edge.z.abs())
}

fn functions() -> Vec<Formula> {
    let all = [vec![growth_formula()], edge_formulas(), vec![share_formula(), neighbours_formula(), mix_formula()]];
    all.into_iter().flatten().collect()
}

fn growth_formula() -> Formula {
    formula(M, "ray_footprint_growth", mirror::growth, oracle::growth, |draws| {
        let travelled = if draws.below(8) == 0 { 0.0 } else { draws.magnitude(-20, 29) };
        (draws.magnitude(-13, 29), travelled, draws.between(1.0, 4.0))
    })
    .edge("on the facet", |(_, travelled, _)| travelled == 0.0)
    .edge("an eye that touches the stone", |(distance, ..)| distance < 1e-3)
    .edge("a far eye", |(distance, travelled, _)| travelled > 0.0 && distance > 1e4 * travelled)
    .invariant("at least 1", |_, growth: f32| if growth >= 1.0 { Ok(()) } else { Err(format!("{growth}")) })
    .build()
}

fn edge_formulas() -> Vec<Formula> {
    // A facet that the ray passes edge-on: the runner-up's plane is met at once.
    let (direction, right, down) = (Vec3::Z, vec3(0.01, 0.0, 0.003), vec3(0.0, 0.01, -0.002));
    let edge_on: Case = (direction, right, down, Vec3::X, vec3(0.6, 0.0, 0.8), 0.5);
    // Offsets nearly along the ray, which meets the nearest plane head-on.
    let toward = vec3(-0.559_120_06, -0.777_824_04, -0.287_009_66);
    let aslant = vec3(-0.559_285_1, -0.777_569_5, -0.287_377_5);
    let offsets = (vec3(-0.883_789_06, -1.0, -0.439_453_13), vec3(-0.804_687_5, -1.0, -0.517_089_84));
    let one_plane: Case = (toward, offsets.0, offsets.1, toward, aslant, 0.0);
    let of_one_plane = [0.0, 5.316_353_312_41e-5, 6.866_346_284_80e-5];
    vec![
        formula(M, "ray_footprint_edge", mirror::edge, oracle::edge, |draws| case(draws, 0.0))
            .edge("seen edge-on", |(direction, .., nearest, _, _): Case| nearest.dot(direction) < 1e-6)
            .edge("one plane twice", |(.., nearest, runner_up, _): Case| nearest == runner_up)
            .edge("nearly one plane", |(.., nearest, runner_up, _): Case| {
                nearest != runner_up && nearest.distance(runner_up) < 0.01
            })
            .edge("no gap", |case: Case| case.5 == 0.0)
            .invariant("offsets along the ray move no edge", |case: Case, edge: Vec3| {
                let (direction, right, down, nearest, runner_up, gap) = case;
                let along = right.length() * direction;
                let moved = mirror::edge(direction, right + along, down + along, nearest, runner_up, gap);
                let give = f64::from((right.length() + down.length()) * 32.0 * f32::EPSILON);
                near("gx", moved.y.into(), edge.y.into(), give)?;
                near("gy", moved.z.into(), edge.z.into(), give)
            })
            .invariant("f is not below 0, but for the rounding of a slope", |case: Case, edge: Vec3| {
                if edge.x >= -4.0 * f32::EPSILON * case.5 { Ok(()) } else { Err(format!("{edge}")) }
            })
            .hard_case("a facet seen edge-on", edge_on, (&[0.0, -0.008, 0.0], 1e-6), ("ray_footprint_edge_naive", 1e9))
            .hard_case("nearly one plane", one_plane, (&of_one_plane, 5e-10), ("ray_footprint_edge_naive", 1e-7))
            .build(),
        formula(M, "ray_footprint_edge_naive", mirror::edge_naive, oracle::edge, |draws| {
            // Offsets along the gradient, and aside by less: no component cancels.
            let direction = draws.unit_vector();
            let along = direction.as_dvec3();
            let across = draws.perpendicular(along);
            let slope = |draws: &mut Draws<'_>| f64::from(draws.between(0.3, 0.9));
            let (one, other) = (slope(draws), slope(draws));
            let nearest = (one * along + (1.0 - one * one).sqrt() * across).as_vec3();
            let runner_up = (other * along - (1.0 - other * other).sqrt() * across).as_vec3();
            let size = draws.magnitude(-20, 12);
            let aside = 0.5 * draws.in_cube().as_dvec3();
            let (right, down) = ((across + 0.5 * aside).as_vec3(), (0.5 * aside - across).as_vec3());
            (direction, size * right, size * down, nearest, runner_up, draws.magnitude(-20, 12))
        })
        .benign(1e-4)
        .build(),
    ]
}

fn share_formula() -> Formula {
    formula(M, "ray_footprint_share", mirror::share, oracle::share, |draws| (line(draws),))
        .edge("through the middle", |(edge,)| edge.x == 0.0 && edge != Vec3::ZERO)
        .edge("a triangle", |(edge,)| mirror::share(edge) > 0.0 && edge.x > 0.5 * (edge.y.abs() - edge.z.abs()).abs())
        .edge("a trapezoid", |(edge,)| edge.x > 0.0 && edge.x < 0.5 * (edge.y.abs() - edge.z.abs()).abs())
        .edge("along an axis", |(edge,)| edge.z == 0.0 && edge.y != 0.0)
        .edge("along a diagonal", |(edge,)| edge.y.abs() == edge.z.abs() && edge.y != 0.0)
        .edge("beyond the pixel", |(edge,)| edge.x > reach(edge))
        .edge("no gradient", |(edge,)| edge.y == 0.0 && edge.z == 0.0)
        .invariant("at most a half, but for rounding", |_, share: f32| {
            // A triangle's two heights are rounded twice each, two quotients and a product once:
            // in WGSL 4 + 5 + 1 ulp.
            if (0.0..=0.5 * (1.0 + 10.0 * f32::EPSILON)).contains(&share) { Ok(()) } else { Err(format!("{share}")) }
        })
        .pair(
            "axes exchanged",
            |(edge,)| (vec3(edge.x, edge.z, edge.y),),
            |_, one: f32, other: f32| near("share", one.into(), other.into(), 1e-5),
        )
        .build()
}

fn neighbours_formula() -> Formula {
    formula(M, "ray_footprint_neighbours", mirror::neighbours, oracle::neighbours, |draws| {
        let share = if draws.below(8) == 0 { 0.0 } else { draws.unit() as f32 };
        (line(draws), share)
    })
    .edge("one neighbour", |(edge, share): (Vec3, f32)| share > 0.0 && edge.y.abs() > edge.x && edge.z.abs() <= edge.x)
    .edge("two neighbours", |(edge, share): (Vec3, f32)| share > 0.0 && edge.y.abs() > edge.x && edge.z.abs() > edge.x)
    .edge("none", |(edge, _): (Vec3, f32)| edge.y.abs().max(edge.z.abs()) <= edge.x)
    .edge("nothing to share", |(_, share): (Vec3, f32)| share == 0.0)
    .invariant("they add up to the share, or to nothing", |(edge, share): (Vec3, f32), shares: Vec4| {
        let sum = shares.as_dvec4().element_sum();
        if edge.y.abs().max(edge.z.abs()) <= edge.x.max(0.0) {
            near("sum", sum, 0.0, 0.0)
        } else {
            near("sum", sum, share.into(), 8.0 * f64::from(f32::EPSILON))
        }
    })
    .invariant(
        "none is below 0",
        |_, shares: Vec4| {
            if shares.min_element() >= 0.0 { Ok(()) } else { Err(format!("{shares}")) }
        },
    )
    .build()
}

/// A pixel, its four neighbours, and their shares.
type Mixed = (Vec4, Vec4, Vec4, Vec4, Vec4, Vec4);

/// Draws five pixels, dark or bright or alike, and shares of which some are 0.
fn mixed(draws: &mut Draws<'_>) -> Mixed {
    let size = draws.magnitude(-20, 20);
    let pixel = |draws: &mut Draws<'_>| match draws.below(6) {
        0 => Vec4::ZERO,
        1 => Vec4::splat(size),
        _ => size * Vec4::from_array([0, 1, 2, 3].map(|_| draws.between(0.001, 1.0))),
    };
    let [centre, right, left, below, above] = [0, 1, 2, 3, 4].map(|_| pixel(draws));
    let whole = if draws.below(6) == 0 { 1.0 } else { draws.between(0.01, 1.0) };
    // One neighbour, two, or all.
    let parts = match draws.below(4) {
        0 => [1.0, 0.0, 0.0, 0.0],
        1 => [0.0, 0.75, 0.25, 0.0],
        2 => [0.0; 4],
        _ => [0.25, 0.25, 0.125, 0.375],
    };
    (centre, right, left, below, above, whole * Vec4::from_array(parts))
}

fn mix_formula() -> Formula {
    formula(M, "ray_footprint_mix", mirror::mix, oracle::mix, mixed)
        .edge("no shares", |(.., shares): Mixed| shares == Vec4::ZERO)
        .edge("nothing of its own", |(.., shares): Mixed| shares.element_sum() == 1.0)
        .edge("one neighbour", |(.., shares): Mixed| shares.x > 0.0 && shares.x == shares.element_sum())
        .edge("a black pixel", |(centre, .., shares): Mixed| centre == Vec4::ZERO && shares != Vec4::ZERO)
        .invariant(
            "it lies between the five, but for rounding",
            |(centre, right, left, below, above, _), pixel: Vec4| {
                let others = [right, left, below, above];
                let least = others.into_iter().fold(centre, Vec4::min);
                let most = others.into_iter().fold(centre, Vec4::max);
                let give = 8.0 * f32::EPSILON * most;
                let within = pixel.cmpge(least - give).all() && pixel.cmple(most + give).all();
                if within { Ok(()) } else { Err(format!("{pixel} of {least} to {most}")) }
            },
        )
        .build()
}

/// Returns the promises of the `Outside:` lines.
fn promises() -> Vec<Promise> {
    vec![
        finite(
            "ray_footprint_growth",
            "finite for distances from 2^-40 on, ways up to 2^60 and an index from 2^-20 on",
            |draws| (draws.magnitude(-40, 60), draws.magnitude(-40, 60), draws.magnitude(-20, 20)),
        ),
        finite("ray_footprint_edge", "finite for offsets and a gap up to 2^30 and other vectors up to 2^10", |draws| {
            let far = |draws: &mut Draws<'_>| vector_up_to(draws, 29);
            let vector = |draws: &mut Draws<'_>| vector_up_to(draws, 9);
            let gap = draws.signed(-20, 29);
            (vector(draws), far(draws), far(draws), vector(draws), vector(draws), gap)
        }),
        holds(
            "ray_footprint_edge",
            "where one slope is below 0, so is f",
            |draws| {
                let direction = draws.unit_vector();
                let (nearest, runner_up) = (normal(draws, direction, 0.01), -normal(draws, direction, 0.01));
                (direction, draws.in_cube(), draws.in_cube(), nearest, runner_up, draws.between(0.1, 1.0))
            },
            |_: Case, edge: Vec3| that(edge.x < 0.0, || format!("{edge}")),
        ),
        like(
            "ray_footprint_share",
            "for f below 0, the area of -f",
            |draws| (line(draws) * vec3(-1.0, 1.0, 1.0),),
            |(edge,): (Vec3,)| (edge * vec3(-1.0, 1.0, 1.0),),
        ),
        like(
            "ray_footprint_neighbours",
            "an f below 0 counts as 0",
            |draws| (line(draws) * vec3(-1.0, 1.0, 1.0), draws.unit() as f32),
            |(edge, share): (Vec3, f32)| (vec3(0.0, edge.y, edge.z), share),
        ),
        finite("ray_footprint_mix", "finite for pixels up to 1e30 and shares up to 1e6", |draws| {
            let pixel = |draws: &mut Draws<'_>| Vec4::from_array([0, 1, 2, 3].map(|_| draws.magnitude(-99, 99)));
            let pixels = [0, 1, 2, 3, 4].map(|_| pixel(draws));
            let shares = Vec4::from_array([0, 1, 2, 3].map(|_| draws.magnitude(-19, 19)));
            (pixels[0], pixels[1], pixels[2], pixels[3], pixels[4], shares)
        }),
        holds(
            "ray_footprint_mix",
            "where shares add up to more than 1, the pixel itself counts below 0",
            |draws| {
                let centre = Vec4::splat(draws.between(0.5, 1.0));
                (centre, Vec4::ZERO, Vec4::ZERO, Vec4::ZERO, Vec4::ZERO, Vec4::splat(draws.between(0.3, 1.0)))
            },
            |_: Mixed, pixel: Vec4| that(pixel.max_element() < 0.0, || format!("{pixel}")),
        ),
    ]
}
