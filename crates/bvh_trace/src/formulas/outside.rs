//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use crate::{self as bvh, BVH_TRACE_NONE, BvhTraceBox, BvhTraceHit, BvhTraceNode, BvhTraceRay};
use glam::{DVec3, Mat3, Quat, UVec4, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{
    Promise, any_numbers, any_vector, finite, holds, like, nothing, of_length, that, vector_up_to,
};

/// Draws a ray and the box that it is made for, with coordinates up to 2^`high`.
fn ray(draws: &mut Draws<'_>, high: i32) -> (BvhTraceRay, Vec3, Vec3) {
    let (one, other) = (vector_up_to(draws, high), vector_up_to(draws, high));
    let (lower, upper) = (one.min(other), one.max(other));
    let direction = draws.unit_vector();
    (bvh::ray(vector_up_to(draws, high), direction, lower, upper), lower, upper)
}

/// Draws a node of any bytes, with exponents from `low` to `high`.
fn node(draws: &mut Draws<'_>, low: u32, high: u32) -> BvhTraceNode {
    let mut exponent = || low + draws.below(high + 1 - low);
    let steps = exponent() | exponent() << 8 | exponent() << 16;
    let corner = vector_up_to(draws, 99);
    BvhTraceNode { corner, steps, lower: any_numbers(draws), upper: any_numbers(draws), children: UVec4::ZERO }
}

/// Returns all promises of the module.
pub(super) fn promises() -> Vec<Promise> {
    const TRIANGLE: &str = "bvh_trace_triangle";
    const FAR_STEPS: &str = "finite for exponents up to 240 and coordinates up to 1e30";
    const HUGE: &str = "finite for coordinates up to 1e30";
    // 2^99 is below 1e30.
    let huge = 99;
    vec![
        like(
            "bvh_trace_turn",
            "3 and more count as 2",
            |draws| (any_vector(draws), 3 + draws.below(u32::MAX - 3)),
            |(vector, _): (Vec3, u32)| (vector, 2),
        ),
        finite("bvh_trace_ray", "finite for |direction| in [1e-6, 1e6] and coordinates up to 1e30", move |draws| {
            let (one, other) = (vector_up_to(draws, huge), vector_up_to(draws, huge));
            (vector_up_to(draws, huge), of_length(draws, -19, 19), one.min(other), one.max(other))
        }),
        nothing("bvh_trace_ray", "a zero direction divides by 0"),
        // Perpendicular rows at least 1e-3 long turn no direction into 0.
        finite("bvh_trace_to_object", "finite while the direction is not turned into 0", move |draws| {
            let turn = Mat3::from_quat(Quat::from_rotation_arc(Vec3::Z, draws.unit_vector()));
            let rows = turn.transpose() * Mat3::from_diagonal(Vec3::splat(draws.magnitude(-9, 40)));
            let place = vector_up_to(draws, 50);
            (vector_up_to(draws, 50), of_length(draws, -10, 30), place, rows.x_axis, rows.y_axis, rows.z_axis)
        }),
        like(
            "bvh_trace_child_box",
            "a child of 4 and more counts as its remainder by 4",
            |draws| (node(draws, 1, 167), 4 + draws.below(u32::MAX - 4)),
            |(node, child): (BvhTraceNode, u32)| (node, child % 4),
        ),
        finite("bvh_trace_child_box", FAR_STEPS, |draws| (node(draws, 0, 240), draws.below(4))),
        finite("bvh_trace_bounds", FAR_STEPS, |draws| (node(draws, 0, 240),)),
        finite("bvh_trace_box", HUGE, move |draws| {
            let (ray, lower, upper) = ray(draws, huge);
            (ray, lower, upper, draws.magnitude(-20, 120))
        }),
        holds(
            "bvh_trace_box",
            "where lower > upper, the box between them less the margin",
            |draws| {
                let upper = draws.in_cube();
                let lower = upper + draws.between(0.1, 2.0);
                // Aimed at the middle of the box from outside.
                let middle = 0.5 * (lower + upper);
                let direction = draws.unit_vector();
                let ray = bvh::ray(middle - 8.0 * direction, direction, -4.0 * Vec3::ONE, 4.0 * Vec3::ONE);
                (ray, lower, upper, 1e37f32)
            },
            |(_, lower, upper, _): (BvhTraceRay, Vec3, Vec3, f32), found: BvhTraceBox| {
                // The ray reaches the middle of the box after 8; the faces are at most half a
                // diagonal before that.
                let nearest = 8.0 - 0.51 * (lower - upper).length();
                that(found.hit && found.entry > nearest && found.entry < 8.0, || format!("{found:?}"))
            },
        ),
        holds(
            "bvh_trace_start",
            "negative: nothing will be met",
            |draws| (-draws.magnitude(-126, 120),),
            |(limit,): (f32,), hit: BvhTraceHit| {
                that(hit.distance == limit && hit.triangle == BVH_TRACE_NONE, || format!("{hit:?}"))
            },
        ),
        finite("bvh_trace_shear", HUGE, move |draws| {
            let (ray, ..) = ray(draws, huge);
            (ray, vector_up_to(draws, huge))
        }),
        holds(
            TRIANGLE,
            "`triangle` equal to `left`, the one just left, never counts",
            |draws| {
                let triangle = draws.below(100);
                let (ray, ..) = ray(draws, 2);
                let hit = BvhTraceHit { distance: draws.magnitude(-2, 100), ..bvh::start(1e37) };
                (hit, ray, draws.in_cube(), draws.in_cube(), draws.in_cube(), triangle, triangle)
            },
            |(before, ..): (BvhTraceHit, BvhTraceRay, Vec3, Vec3, Vec3, u32, u32), hit: BvhTraceHit| {
                that(hit == before, || format!("{hit:?}"))
            },
        ),
        nothing(TRIANGLE, "A triangle without area in the ray's frame need not: its neighbours at that edge do"),
        holds(
            TRIANGLE,
            "Of thin ones none that the ray meets is refused, but its point is less sure",
            |draws| {
                // A thin triangle, met in the middle by a ray from in front of it.
                let (along, across) = (Vec3::X, draws.magnitude(-14, -5) * Vec3::Y);
                let [a, b, c] = [-along - across, along - across, 0.2 * along + across];
                let middle = (a + b + c) / 3.0;
                let direction = (draws.direction() + 1.2 * DVec3::Z).normalize().as_vec3();
                let ray = bvh::ray(middle - direction, direction, -2.0 * Vec3::ONE, 2.0 * Vec3::ONE);
                (bvh::start(1e37), ray, a, b, c, 7u32, BVH_TRACE_NONE)
            },
            |_: (BvhTraceHit, BvhTraceRay, Vec3, Vec3, Vec3, u32, u32), hit: BvhTraceHit| {
                that(hit.triangle == 7 && (hit.distance - 1.0).abs() < 0.01, || format!("{hit:?}"))
            },
        ),
    ]
}
