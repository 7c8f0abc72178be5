//! Test inputs, edges, invariants and hard cases of `wgsl/screen_trace.wgsl`.

use crate::{self as mirror, SCREEN_TRACE_FAR, oracle};
use glam::{Vec3, Vec4};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::outside::{Promise, finite, holds, that};

const M: &str = "screen_trace";

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), promises())
}

/// Draws a ray in clip coordinates that leaves the view at a clear angle, or never.
fn ray(draws: &mut Draws<'_>) -> (Vec4, Vec4) {
    let w = draws.magnitude(-10, 10);
    let inside = |draws: &mut Draws<'_>| match draws.below(8) {
        0 => 0.0,
        1 => draws.pick(&[-1.0, 1.0]),
        2 => draws.pick(&[-1.5, 1.5]),
        _ => draws.between(-0.99, 0.99),
    };
    let (x, y, z) = (inside(draws), inside(draws), inside(draws).abs());
    let start = w * Vec4::new(x, y, z, 1.0);
    let speed = draws.magnitude(-6, 6);
    // In multiples of 2^-6, whose sums and differences are exact: no rate is 0 but for a parallel ray.
    let part = |draws: &mut Draws<'_>| (draws.below(129) as f32 - 64.0) / 64.0;
    let along = Vec4::new(part(draws), part(draws), part(draws), part(draws));
    let along = match draws.below(6) {
        // Along the screen, and straight ahead.
        0 => Vec4::new(along.x, along.y, 0.0, 0.0),
        1 => Vec4::new(0.0, 0.0, along.w, along.w),
        _ => along,
    };
    (start, speed * along)
}

/// Draws the two ends of a way on the screen, its length and a fraction of it.
fn way(draws: &mut Draws<'_>) -> (f32, f32, f32, f32) {
    let start = draws.magnitude(-19, 18);
    let end = match draws.below(3) {
        0 => start,
        1 => start * draws.between(0.5, 2.0),
        _ => draws.magnitude(-19, 18),
    };
    let reach = if draws.below(8) == 0 { 0.0 } else { draws.magnitude(-19, 18) };
    let fraction = match draws.below(6) {
        0 => 0.0,
        1 => 1.0,
        2 => draws.below(33) as f32 / 32.0,
        _ => draws.unit() as f32,
    };
    (start, end.clamp(1e-6, 1e6), reach, if fraction < 1e-6 { 0.0 } else { fraction })
}

/// Draws a depth with the constants of a projection: usual, reversed, or with its far plane at
/// infinity.
fn depth(draws: &mut Draws<'_>) -> (f32, f32, f32) {
    let close = draws.magnitude(-10, 6);
    let far = close * draws.magnitude(1, 6);
    let reversed = draws.below(3) == 0;
    let infinite = draws.below(3) == 0;
    let (scale, offset) = match (reversed, infinite) {
        (false, false) => (far / (far - close), -far * close / (far - close)),
        (false, true) => (1.0, -close),
        (true, false) => (-close / (far - close), far * close / (far - close)),
        (true, true) => (0.0, close),
    };
    let value = match draws.below(6) {
        0 => 0.0,
        1 => 1.0,
        2 => 1.0 - draws.magnitude(-20, -4),
        _ => draws.between(1e-6, 1.0),
    };
    (value, scale, offset.clamp(-1e4, 1e4))
}

/// Draws 1 / w: of a body at infinity, or any.
fn inverse(draws: &mut Draws<'_>) -> f32 {
    if draws.below(8) == 0 { 0.0 } else { draws.magnitude(-19, 18) }
}

/// Draws a step of a ray, a surface and a thickness.
fn step(draws: &mut Draws<'_>) -> (f32, f32, f32, f32) {
    let surface = inverse(draws);
    let beside = |draws: &mut Draws<'_>| match draws.below(4) {
        0 => inverse(draws),
        1 => surface,
        _ => surface * draws.between(0.5, 2.0),
    };
    let (before, here) = (beside(draws), beside(draws));
    let thickness = match draws.below(4) {
        0 => 0.0,
        // About as thick as far.
        1 if surface > 0.0 => (draws.between(0.25, 4.0) / surface).min(1e6),
        _ => draws.magnitude(-19, 18),
    };
    let kept = |value: f32| if value < 1e-6 { 0.0 } else { value.min(1e6) };
    (kept(before), kept(here), surface, kept(thickness))
}

/// Draws a step of a ray and the surface at both of its ends.
fn crossed(draws: &mut Draws<'_>) -> (f32, f32, f32, f32) {
    let before = draws.magnitude(-18, 17);
    let difference = draws.magnitude(-10, 2);
    let surface_before = match draws.below(4) {
        0 => before * (1.0 + difference),
        1 => 0.0,
        _ => before / (1.0 + difference),
    };
    let here = before * draws.between(0.5, 2.0);
    let surface = match draws.below(4) {
        0 => here / draws.between(1.0, 2.0),
        1 => here,
        _ => here * draws.between(1.0, 2.0),
    };
    (
        before,
        if surface_before < 1e-6 { 0.0 } else { surface_before.min(1e6) },
        here.clamp(1e-6, 1e6),
        surface.clamp(1e-6, 1e6),
    )
}

fn functions() -> Vec<Formula> {
    [
        vec![reach_formula(), sides_formula()],
        distance_formulas(),
        vec![inverse_formula(), meets_formula(), crossing_formula()],
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Whether a place is in view.
fn in_view(place: Vec4) -> bool {
    place.x.abs() <= place.w && place.y.abs() <= place.w && (0.0..=place.w).contains(&place.z)
}

fn reach_formula() -> Formula {
    formula(M, "screen_trace_reach", mirror::reach, oracle::reach, ray)
        .edge("from beyond the view", |(start, _)| !in_view(start))
        .edge("at the edge of the view", |(start, _): (Vec4, Vec4)| start.x.abs() == start.w)
        .edge("past the eye", |(start, step): (Vec4, Vec4)| in_view(start) && step.w < 0.0)
        .edge("along the screen", |(_, step): (Vec4, Vec4)| step.z == 0.0 && step.w == 0.0)
        .edge("it stays in view", |(start, step)| mirror::reach(start, step) == SCREEN_TRACE_FAR)
        .invariant("half the way is in view", |(start, step): (Vec4, Vec4), reach: f32| {
            if reach == 0.0 {
                return Ok(());
            }
            let part = 0.5 * f64::from(reach).min(1e6);
            let place = start.as_dvec4() + part * step.as_dvec4();
            let give = 1e-6 * (start.abs().max_element() + reach.min(1e6) * step.abs().max_element());
            that(place.truncate().truncate().abs().max_element() <= place.w + f64::from(give), || format!("{place}"))
        })
        .pair(
            "mirrored at the middle of the screen",
            |(start, step): (Vec4, Vec4)| {
                let turn = Vec4::new(-1.0, -1.0, 1.0, 1.0);
                (start * turn, step * turn)
            },
            |_, one: f32, other: f32| near("reach", one.into(), other.into(), 0.0),
        )
        .build()
}

fn sides_formula() -> Formula {
    formula(M, "screen_trace_sides", mirror::sides, oracle::sides, |draws| {
        let height = |draws: &mut Draws<'_>| if draws.below(8) == 0 { 0.0 } else { draws.magnitude(-19, 12) };
        let rate = |draws: &mut Draws<'_>| if draws.below(8) == 0 { 0.0 } else { draws.signed(-19, 12) };
        let heights = Vec3::new(height(draws), height(draws), height(draws));
        (heights, Vec3::new(rate(draws), rate(draws), rate(draws)))
    })
    .edge("on a side", |(height, _): (Vec3, Vec3)| height.min_element() == 0.0)
    .edge("parallel to a side", |(_, rate): (Vec3, Vec3)| rate.cmpeq(Vec3::ZERO).any())
    .edge("away from all", |(_, rate): (Vec3, Vec3)| rate.max_element() < 0.0)
    .build()
}

fn distance_formulas() -> Vec<Formula> {
    vec![
        formula(M, "screen_trace_distance", mirror::distance, oracle::distance, way)
            .edge("at the start", |(.., fraction)| fraction == 0.0)
            .edge("at the end", |(.., fraction)| fraction == 1.0)
            .edge("across the view", |(start, end, ..)| start == end)
            .edge("towards the eye", |(start, end, ..): (f32, f32, f32, f32)| end < 1e-3 * start)
            .edge("away from it", |(start, end, ..): (f32, f32, f32, f32)| end > 1e3 * start)
            .invariant("between the start and the end, but for rounding", |(.., reach, _), distance: f32| {
                that((0.0..=reach * (1.0 + 8.0 * f32::EPSILON)).contains(&distance), || format!("{distance}"))
            })
            .hard_case(
                "from a hundred times as deep, halfway on the screen",
                (100.0, 1.0, 99.0, 0.5),
                (&[98.019_801_980_198_02], 1e-5),
                ("screen_trace_distance_naive", 0.49),
            )
            .build(),
        formula(M, "screen_trace_distance_naive", mirror::distance_naive, oracle::distance, |draws| {
            let w = draws.between(1.0, 1000.0);
            (w, w, draws.between(1.0, 1000.0), draws.unit() as f32)
        })
        .benign(1e-5)
        .build(),
    ]
}

fn inverse_formula() -> Formula {
    formula(M, "screen_trace_inverse_w", mirror::inverse_w, oracle::inverse_w, depth)
        .edge("on the near plane", |(depth, scale, _)| depth == 0.0 && scale > 0.5)
        .edge("at infinity", |(depth, scale, _)| depth == scale)
        .edge("reversed", |(_, _, offset)| offset > 0.0)
        .build()
}

fn meets_formula() -> Formula {
    type Case = (f32, f32, f32, f32);
    formula(M, "screen_trace_meets", mirror::meets, oracle::meets, step)
        .edge("it goes through", |(before, here, surface, _): Case| before > surface && surface > here)
        .edge("in front", |(before, here, surface, _): Case| before.min(here) > surface)
        .edge("from behind to the front", |(before, here, surface, _): Case| before < surface && surface < here)
        .edge("behind the body", |case: Case| {
            let (before, here, surface, thickness) = case;
            before.max(here) < surface && !mirror::meets(before, here, surface, thickness)
        })
        .edge("inside the body", |case: Case| {
            let (before, here, surface, thickness) = case;
            before.max(here) < surface && mirror::meets(before, here, surface, thickness)
        })
        .edge("towards the eye", |(before, here, ..): Case| here > before)
        .edge("a surface at infinity", |(_, _, surface, _): Case| surface == 0.0)
        .edge("a ray to infinity", |(before, here, ..): Case| before.min(here) == 0.0)
        .invariant("in front at the end, it has met nothing", |(_, here, surface, _): Case, meets: bool| {
            that(!meets || here <= surface, || "it meets".to_owned())
        })
        .build()
}

fn crossing_formula() -> Formula {
    type Case = (f32, f32, f32, f32);
    formula(M, "screen_trace_crossing", mirror::crossing, oracle::crossing, crossed)
        .edge("from behind", |(before, surface_before, ..): Case| before < surface_before)
        .edge("in front at the end", |(_, _, here, surface): Case| here > surface)
        .edge("at the end", |(_, _, here, surface): Case| here == surface)
        .edge("a surface from infinity", |(_, surface_before, ..): Case| surface_before == 0.0)
        .invariant("a fraction", |_, fraction: f32| that((0.0..=1.0).contains(&fraction), || format!("{fraction}")))
        .build()
}

/// Returns the promises of the `Outside:` lines.
fn promises() -> Vec<Promise> {
    vec![
        finite("screen_trace_reach", "finite for coordinates up to 1e18", |draws| {
            let coordinates = |draws: &mut Draws<'_>| {
                let vector: Vec3 = lapidary_assay::outside::vector_up_to(draws, 59);
                vector.extend(draws.signed(-126, 58))
            };
            (coordinates(draws), coordinates(draws))
        }),
        holds(
            "screen_trace_reach",
            "a start at the edge is in view",
            |draws| {
                let w = draws.magnitude(-4, 4);
                let edge = draws.pick(&[Vec3::new(1.0, 0.0, 0.5), Vec3::new(0.0, -1.0, 0.5), Vec3::ZERO, Vec3::Z]);
                (w * edge.extend(1.0), w * (Vec3::new(0.0, 0.0, 0.5) - edge).extend(0.0))
            },
            |_: (Vec4, Vec4), reach: f32| that(reach > 0.5, || format!("{reach}")),
        ),
        finite("screen_trace_sides", "finite for heights up to 1e18", |draws| {
            let vector = |draws: &mut Draws<'_>| lapidary_assay::outside::vector_up_to(draws, 59);
            (vector(draws), vector(draws))
        }),
        finite(
            "screen_trace_distance",
            "finite for w from 1e-18 up to 1e18, reach up to 1e18 and fractions in [0, 1]",
            |draws| {
                let mut size = || draws.magnitude(-59, 58);
                let (start, end, reach) = (size(), size(), size());
                (start, end, reach, draws.unit() as f32)
            },
        ),
        finite(
            "screen_trace_inverse_w",
            "finite for a depth and a scale up to 1e6 and an offset from 1e-9 on",
            |draws| (draws.signed(-20, 18), draws.signed(-20, 18), draws.signed(-29, 18)),
        ),
        holds(
            "screen_trace_meets",
            "with a thickness below 0, a body thinner than its own front, which a ray may miss",
            |draws| {
                let surface = draws.between(0.5, 2.0);
                (1.01 * surface, 0.99 * surface, surface, -0.1 / surface)
            },
            |_: (f32, f32, f32, f32), meets: bool| that(!meets, || "it meets".to_owned()),
        ),
        holds(
            "screen_trace_crossing",
            "a ray that begins on the surface counts as behind it",
            |draws| {
                let before = draws.between(0.5, 2.0);
                (before, before, draws.between(0.1, 0.4), draws.between(0.5, 2.0))
            },
            |_: (f32, f32, f32, f32), fraction: f32| that(fraction == 1.0, || format!("{fraction}")),
        ),
        finite("screen_trace_crossing", "finite for inverses in [0, 1e18]", |draws| {
            let mut any = || if draws.below(6) == 0 { 0.0 } else { draws.magnitude(-126, 58) };
            (any(), any(), any(), any())
        }),
    ]
}
