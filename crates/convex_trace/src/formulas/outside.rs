//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use crate::{self as convex, CONVEX_TRACE_FAR, CONVEX_TRACE_NONE, ConvexTraceHit};
use glam::{Vec3, Vec4};
use lapidary_assay::outside::{Promise, close, finite, holds, that, vector_up_to};

/// Returns all promises of the module.
pub(super) fn promises() -> Vec<Promise> {
    const STEP: &str = "convex_trace_step";
    vec![
        holds(
            "convex_trace_start",
            "from a negative limit on nothing is hit",
            |draws| (-draws.magnitude(-126, 127),),
            |(limit,): (f32,), hit: ConvexTraceHit| {
                that(hit.distance == limit && hit.face == CONVEX_TRACE_NONE, || format!("{hit:?}"))
            },
        ),
        finite(STEP, "finite for sizes up to 1e18", |draws| {
            let plane = draws.unit_vector().extend(draws.signed(-126, 58));
            let hit = convex::start(CONVEX_TRACE_FAR);
            (hit, vector_up_to(draws, 58), draws.unit_vector(), plane, draws.below(9), CONVEX_TRACE_NONE)
        }),
        holds(
            STEP,
            "for other directions distances in units of their length",
            |draws| {
                let length = 2f32.powi(draws.below(21) as i32 - 10);
                let plane = draws.unit_vector().extend(draws.between(1.0, 3.0));
                (
                    convex::start(CONVEX_TRACE_FAR),
                    Vec3::ZERO,
                    length * draws.unit_vector(),
                    plane,
                    3u32,
                    CONVEX_TRACE_NONE,
                )
            },
            |(hit, position, direction, plane, face, left): (ConvexTraceHit, Vec3, Vec3, Vec4, u32, u32),
             met: ConvexTraceHit| {
                let length = direction.length().log2().round().exp2();
                let unit = convex::step(hit, position, direction / length, plane, face, left);
                let right = unit.face == met.face
                    && (met.face == CONVEX_TRACE_NONE
                        || close(
                            &[met.distance * length],
                            &[f64::from(unit.distance)],
                            1e-6 * f64::from(unit.distance),
                        )
                        .is_ok());
                that(right, || format!("{met:?}, in units of a length of {length}: {unit:?}"))
            },
        )
        .at_nearest(),
        holds(
            "convex_trace_runner_up",
            "a runner-up nearer than the nearest stays unless the nearest is overtaken",
            |draws| {
                let nearest = ConvexTraceHit { distance: draws.between(1.0, 2.0), face: 1 };
                let runner_up = ConvexTraceHit { distance: draws.between(0.1, 0.9), face: 2 };
                (nearest, runner_up, ConvexTraceHit { distance: draws.between(0.1, 3.0), face: 3 })
            },
            |(nearest, runner_up, hit): (ConvexTraceHit, ConvexTraceHit, ConvexTraceHit), met: ConvexTraceHit| {
                let nearer = if hit.distance < runner_up.distance { hit } else { runner_up };
                let wanted = if hit.distance < nearest.distance { nearest } else { nearer };
                that(met == wanted, || format!("{met:?}"))
            },
        ),
        finite("convex_trace_point", "finite up to 1e18", |draws| {
            let plane = draws.unit_vector().extend(draws.signed(-126, 58));
            (vector_up_to(draws, 58), draws.unit_vector(), draws.magnitude(-126, 58), plane)
        }),
    ]
}
