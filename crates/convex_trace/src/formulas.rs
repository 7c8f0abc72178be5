//! Test inputs, edges, invariants and hard cases of `wgsl/convex_trace.wgsl`.

mod outside;

use crate::{self as mirror, CONVEX_TRACE_FAR, CONVEX_TRACE_NONE, ConvexTraceHit, oracle};
use glam::{DVec3, Vec3, Vec4, Vec4Swizzles as _};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;

mirror_struct!(crate, ConvexTraceHit { distance, face });

const M: &str = "convex_trace";

/// The rounding unit of f32.
const ULP: f64 = 1.0 / (1 << 23) as f64;

/// Magnitude below which an implementation may flush to zero.
const FLUSHED: f64 = f32::MIN_POSITIVE as f64;

type Step = (ConvexTraceHit, Vec3, Vec3, Vec4, u32, u32);

/// Draws the size of a stone: 1 in half of the cases, otherwise from 1e-4 to 1e4.
fn size(draws: &mut Draws<'_>) -> f32 {
    if draws.below(2) == 0 { 1.0 } else { draws.magnitude(-13, 13) }
}

/// Draws a plane, a start on its inner side, on the plane or a few ulp outside, and a direction:
/// towards the plane, away from it, or parallel to the last ulp.
fn start_and_plane(draws: &mut Draws<'_>, size: f32) -> (Vec3, Vec3, Vec4) {
    let normal = draws.unit_vector();
    let axis = normal.as_dvec3().normalize();
    let tangent = draws.perpendicular(axis);
    let slope = match draws.below(6) {
        0 => f64::from(draws.magnitude(-30, -1)),
        1 => 0.0,
        2 => 1.0,
        _ => f64::from(draws.between(0.0, 1.0)),
    };
    let slope = if draws.below(4) == 0 { -slope } else { slope };
    let direction = (((1.0 - slope) * (1.0 + slope)).max(0.0).sqrt() * tangent + slope * axis).as_vec3();
    let position = if draws.below(4) == 0 { Vec3::ZERO } else { size * draws.in_cube() };
    let through = axis.dot(position.as_dvec3()) as f32;
    let offset = match draws.below(6) {
        0 => draws.nudged(through, 4),
        1 => through + size * draws.magnitude(-22, -1),
        _ => through + size * draws.between(0.0, 2.0),
    };
    (position, direction, normal.extend(offset))
}

/// Draws a step: no hit so far, a much nearer or farther one, one at nearly the same distance, or
/// one at exactly the same distance.
fn step(draws: &mut Draws<'_>) -> Step {
    let size = size(draws);
    let (position, direction, plane) = start_and_plane(draws, size);
    let face = draws.below(73);
    let left = if draws.below(4) == 0 { face } else { draws.pick(&[CONVEX_TRACE_NONE, 73, 74]) };
    let height = plane.w - plane.xyz().dot(position);
    let slope = plane.xyz().dot(direction);
    let before = 100 + draws.below(8);
    let distance = if slope > 1e-6 { height.max(0.0) / slope } else { size * draws.between(0.0, 2.0) };
    let hit = match draws.below(6) {
        0 => mirror::start(CONVEX_TRACE_FAR),
        1 => mirror::start(size * draws.magnitude(-2, 2)),
        2 => ConvexTraceHit { distance, face: before },
        3 => ConvexTraceHit { distance: draws.nudged(distance, 8).max(0.0), face: before },
        4 => ConvexTraceHit { distance: 0.0, face: before },
        _ => ConvexTraceHit { distance: size * draws.between(0.0, 2.0), face: before },
    };
    (hit, position, direction, plane, face, left)
}

/// Returns height and slope of the plane in f64, and whether f32 computes them without rounding in
/// any order of operations: only one component of the normal counts.
fn height_and_slope((_, position, direction, plane, ..): Step) -> (f64, f64, bool) {
    let (normal, position, direction) = (plane.xyz().as_dvec3(), position.as_dvec3(), direction.as_dvec3());
    let height = f64::from(plane.w) - normal.dot(position);
    let along_an_axis = plane.xyz().abs().max_element() == 1.0;
    (height, normal.dot(direction), along_an_axis && f64::from(height as f32) == height)
}

/// Checks which plane is met, if f32 computes the distance without rounding.
fn exact_choice(arguments: Step, result: ConvexTraceHit) -> Result<(), String> {
    let (hit, _, _, _, face, left) = arguments;
    let (height, slope, exact) = height_and_slope(arguments);
    let distance = height.max(0.0) / slope;
    if !exact || slope > 0.0 && f64::from(distance as f32) != distance {
        return Ok(());
    }
    let wanted = if slope > 0.0 && distance < f64::from(hit.distance) && face != left { face } else { hit.face };
    if result.face == wanted { Ok(()) } else { Err(format!("face {} is met, not {wanted}", result.face)) }
}

fn step_formula() -> Formula {
    let far = mirror::start(CONVEX_TRACE_FAR);
    let none = CONVEX_TRACE_NONE;
    // The facet on the right.
    let right = |offset: f32| Vec3::X.extend(offset);
    let (oblique, grazing) = (Vec3::new(0.6, 0.8, 0.0), Vec3::new(1e-6, 1.0, 0.0));
    let (beside, inside, outside) = (Vec3::X * (1.0 - 1e-5), Vec3::X * 1.0f32.next_down(), Vec3::X * 1.0f32.next_up());
    // A point under the plane x = 1 of a stone of size 1, in the stone's own coordinates and 1e4
    // units away.
    let (here, there) = (Vec3::new(0.7504, 0.1, -0.2), Vec3::splat(1e4));
    formula(M, "convex_trace_step", mirror::step, oracle::step, step)
        .edge("nothing hit so far", |(hit, ..)| hit.face == CONVEX_TRACE_NONE && hit.distance == CONVEX_TRACE_FAR)
        .edge("a limit", |(hit, ..)| hit.face == CONVEX_TRACE_NONE && hit.distance < 100.0)
        .edge("exactly parallel", |a: Step| height_and_slope(a).1 == 0.0 && a.0.face == CONVEX_TRACE_NONE)
        .edge("exactly parallel, outside by rounding", |a: Step| {
            let (height, slope, exact) = height_and_slope(a);
            exact && slope == 0.0 && height < 0.0
        })
        .edge("parallel to the last ulp", |a: Step| (1e-12..1e-7).contains(&height_and_slope(a).1))
        .edge("away from the plane", |a: Step| height_and_slope(a).1 < -0.1)
        .edge("outside by rounding, going out", |a: Step| {
            let (height, slope, _) = height_and_slope(a);
            height < 0.0 && slope > 0.1
        })
        .edge("on the plane, going out", |a: Step| {
            let (height, slope, exact) = height_and_slope(a);
            exact && height == 0.0 && slope > 0.1
        })
        .edge("the face that was left, at grazing incidence", |a: Step| {
            a.4 == a.5 && (1e-12..1e-7).contains(&height_and_slope(a).1)
        })
        .edge("a tie", |a: Step| {
            let (height, slope, exact) = height_and_slope(a);
            exact && height > 0.0 && slope > 0.0 && height / slope == f64::from(a.0.distance) && a.4 != a.5
        })
        .edge("a tie at distance 0", |a: Step| {
            let (height, slope, exact) = height_and_slope(a);
            exact && height <= 0.0 && slope > 0.1 && a.0.distance == 0.0 && a.4 != a.5
        })
        .edge("a stone of size 1e-4", |(_, position, ..)| (1e-5..2e-4).contains(&position.length()))
        .edge("a stone of size 1e4", |(_, position, ..)| (5e3..5e4).contains(&position.length()))
        .invariant("it is this plane's hit or the one so far", |arguments: Step, result: ConvexTraceHit| {
            let (hit, position, _, plane, face, left) = arguments;
            if result.face != face || face == left {
                return if result == hit { Ok(()) } else { Err(format!("it is {result:?}")) };
            }
            let (height, slope, _) = height_and_slope(arguments);
            // Height and slope are three products and at most three sums each, each off by up to a
            // whole last place.
            let magnitude = f64::from(plane.xyz().abs().dot(position.abs()) + plane.w.abs());
            let distance = f64::from(result.distance);
            let bound = 4.0 * ULP * (magnitude + distance) + FLUSHED;
            near("the height that it covers", distance * slope, height.max(0.0), bound)
        })
        .invariant_at_nearest("the nearer plane, at a tie the one so far, parallel planes never", exact_choice)
        .hard_case_with(
            "a stone of size 1e-4",
            (far, Vec3::ZERO, Vec3::X, right(5e-5), 7, none),
            (&[f64::from(5e-5f32), 7.0], 1e-11),
            ("convex_trace_step_naive", (far, Vec3::ZERO, Vec3::X, right(5e-5), 7), 1e30),
        )
        .hard_case_with(
            "a facet 1e-5 away, beside an edge",
            (far, beside, Vec3::X, right(1.0), 7, none),
            (&[1.0 - f64::from(beside.x), 7.0], 1e-12),
            ("convex_trace_step_naive", (far, beside, Vec3::X, right(1.0), 7), 1e30),
        )
        .hard_case_with(
            "one ulp outside of a facet, going out",
            (far, outside, oblique, right(1.0), 7, none),
            (&[0.0, 7.0], 0.0),
            ("convex_trace_step_naive", (far, outside, oblique, right(1.0), 7), 1e30),
        )
        .hard_case_with(
            "grazing incidence: one ulp inside of the face that was left, turned back to it by rounding",
            (far, inside, grazing, right(1.0), 7, 7),
            (&[f64::from(far.distance), f64::from(none)], 0.0),
            ("convex_trace_step_naive", (far, inside, grazing, right(1.0), 7), 1e9),
        )
        .hard_case_with(
            "1e4 units from the origin, where the stone's own coordinates keep their digits",
            (far, here, Vec3::X, right(1.0), 7, none),
            (&[1.0 - f64::from(here.x), 7.0], 1e-12),
            ("convex_trace_step_naive", (far, here + there, Vec3::X, right(10_001.0), 7), 3e-4),
        )
        .build()
}

/// Draws three hits: the nearest, a farther one, and another before, between or behind them, beside
/// one of them, or one of them again; not every one has a face.
fn three_hits(draws: &mut Draws<'_>) -> (ConvexTraceHit, ConvexTraceHit, ConvexTraceHit) {
    let size = size(draws);
    let nearest = match draws.below(8) {
        0 => mirror::start(size),
        1 => ConvexTraceHit { distance: 0.0, face: 1 },
        _ => ConvexTraceHit { distance: size * draws.between(0.1, 1.0), face: 1 },
    };
    let runner_up = match draws.below(6) {
        0 => mirror::start(CONVEX_TRACE_FAR),
        1 => ConvexTraceHit { face: 2, ..nearest },
        _ => ConvexTraceHit { distance: nearest.distance + size * draws.between(0.01, 1.0), face: 2 },
    };
    let hit = match draws.below(10) {
        0 if nearest.face != CONVEX_TRACE_NONE => nearest,
        1 if runner_up.face != CONVEX_TRACE_NONE => runner_up,
        2 => mirror::start(CONVEX_TRACE_FAR),
        3 => ConvexTraceHit { face: 3, ..nearest },
        4 => ConvexTraceHit { face: 3, ..runner_up },
        5 => ConvexTraceHit { distance: draws.nudged(nearest.distance, 4).max(0.0), face: 3 },
        6 => ConvexTraceHit { distance: draws.nudged(runner_up.distance, 4).max(0.0), face: 3 },
        7 => ConvexTraceHit { distance: 0.0, face: 3 },
        _ => ConvexTraceHit { distance: size * draws.between(0.0, 2.0), face: 3 },
    };
    (nearest, runner_up, hit)
}

fn runner_up_formula() -> Formula {
    type Three = (ConvexTraceHit, ConvexTraceHit, ConvexTraceHit);
    formula(M, "convex_trace_runner_up", mirror::runner_up, oracle::runner_up, three_hits)
        .edge("nothing hit so far", |(nearest, ..): Three| nearest.face == CONVEX_TRACE_NONE)
        .edge("the first plane within the limit", |(nearest, runner_up, hit): Three| {
            let limit = nearest.face == CONVEX_TRACE_NONE && hit.distance < nearest.distance;
            limit && runner_up.face != CONVEX_TRACE_NONE
        })
        .edge("no runner-up so far", |(_, runner_up, _): Three| runner_up.face == CONVEX_TRACE_NONE)
        .edge("nothing is hit", |(.., hit): Three| hit.face == CONVEX_TRACE_NONE)
        .edge("the nearest again", |(nearest, _, hit): Three| hit == nearest)
        .edge("the runner-up again", |(_, runner_up, hit): Three| hit == runner_up)
        .edge("a tie with the nearest", |(nearest, _, hit): Three| {
            hit.distance == nearest.distance && hit.face != nearest.face
        })
        .edge("a tie with the runner-up", |(_, runner_up, hit): Three| {
            hit.distance == runner_up.distance && hit.face != runner_up.face
        })
        .edge("the nearest is overtaken", |(nearest, _, hit): Three| hit.distance < nearest.distance)
        .edge("between the two", |(nearest, runner_up, hit): Three| {
            nearest.distance < hit.distance && hit.distance < runner_up.distance
        })
        .invariant("it is one of the three, no nearer than the nearest left", |(nearest, runner_up, hit): Three, it| {
            let given: ConvexTraceHit = it;
            let least = nearest.distance.min(hit.distance);
            let known = [nearest, runner_up, hit].contains(&given) && given.distance >= least;
            if known { Ok(()) } else { Err(format!("{given:?}")) }
        })
        .build()
}

/// Draws a plane well ahead or behind, or around the epsilon from the origin, where its distance is
/// exact to a thousandth, and a hit so far that is nearer, farther, or at the same distance.
fn benign_step(draws: &mut Draws<'_>) -> (ConvexTraceHit, Vec3, Vec3, Vec4, u32) {
    let face = draws.below(73);
    if draws.below(4) == 0 {
        // Along the normal, which is an axis: no rounding.
        let distance = draws.pick(&[1e-4, 0.99e-4, 0.995e-4, 1.005e-4, 1.01e-4, 0.5]);
        let hit = ConvexTraceHit { distance: distance * draws.pick(&[1.0, 0.5, 2.0]), face: 100 };
        return (hit, Vec3::ZERO, Vec3::Z, Vec3::Z.extend(distance), face);
    }
    let (normal, position) = (draws.unit_vector(), 0.5 * draws.in_cube());
    let axis = normal.as_dvec3().normalize();
    let slope = f64::from(draws.between(0.1, 1.0)) * if draws.below(4) == 0 { -1.0 } else { 1.0 };
    let direction = ((1.0 - slope * slope).sqrt() * draws.perpendicular(axis) + slope * axis).as_vec3();
    let distance = draws.between(0.02, 2.0);
    let through: DVec3 = position.as_dvec3() + f64::from(distance) * direction.as_dvec3();
    let plane = normal.extend(axis.dot(through) as f32);
    let hit = match draws.below(4) {
        0 => mirror::start(CONVEX_TRACE_FAR),
        _ => ConvexTraceHit { distance: distance * draws.pick(&[0.5, 0.99, 1.01, 2.0]), face: 100 },
    };
    (hit, position, direction, plane, face)
}

/// Draws a ray to a plane and the distance there, for every slope from 1e-6 on; or a start on a
/// plane as interpolation leaves it, with a distance of 0.
fn way_to_plane(draws: &mut Draws<'_>) -> (Vec3, Vec3, f32, Vec4) {
    let size = size(draws);
    let (position, direction, plane) = start_and_plane(draws, size);
    let (height, slope) = (plane.w - plane.xyz().dot(position), plane.xyz().dot(direction));
    let reached = slope > 1e-6 && height / slope < 4.0 * size;
    let distance = if reached { (height / slope).max(0.0) } else { 0.0 };
    (position, direction, distance, plane)
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    // From the far side, at 30 degrees to the plane's normal.
    let (across, direction, way) = (Vec3::Z * -1e4, Vec3::new(0.5, 0.0, 0.866_025_4), 11_547.813f32);
    vec![
        formula(M, "convex_trace_start", mirror::start, oracle::start, |draws| {
            (match draws.below(4) {
                0 => draws.pick(&[CONVEX_TRACE_FAR, 0.0, CONVEX_TRACE_FAR.next_up(), 3e38]),
                1 => CONVEX_TRACE_FAR * draws.between(0.9, 1.1),
                _ => draws.magnitude(-40, 40),
            },)
        })
        .edge("no limit", |(limit,)| limit == CONVEX_TRACE_FAR)
        .edge("beyond the farthest", |(limit,)| limit > CONVEX_TRACE_FAR)
        .edge("no way to go", |(limit,)| limit == 0.0)
        .build(),
        step_formula(),
        runner_up_formula(),
        formula(M, "convex_trace_step_naive", mirror::step_naive, oracle::step_naive, benign_step).benign(1e-3).build(),
        formula(M, "convex_trace_point", mirror::point, oracle::point, way_to_plane)
            .edge("no way to go", |(_, _, distance, _)| distance == 0.0)
            .edge("nearly parallel", |(_, direction, distance, plane)| {
                distance > 0.0 && plane.xyz().dot(direction) < 1e-4
            })
            .edge("a stone of size 1e-4", |(position, ..)| (1e-5..2e-4).contains(&position.length()))
            .edge("a stone of size 1e4", |(position, ..)| (5e3..5e4).contains(&position.length()))
            .invariant("it lies on the plane", |(position, direction, distance, plane), point: Vec3| {
                let height = plane.xyz().as_dvec3().dot(point.as_dvec3()) - f64::from(plane.w);
                // The rounding of the height along the ray and, over a long distance, of the
                // normal's length.
                let far = position.abs() + distance * direction.abs();
                let magnitude = f64::from(plane.xyz().abs().dot(far) + plane.w.abs());
                near("height", height, 0.0, 4.0 * ULP * magnitude + FLUSHED)
            })
            .hard_case_with(
                "through a stone of size 1e4 to a plane near its centre",
                (across, direction, way, Vec3::Z.extend(0.7)),
                (&[0.5 * f64::from(way), 0.0, f64::from(0.7f32)], 1e-9),
                ("convex_trace_point_naive", (across, direction, way), 5e-4),
            )
            .build(),
        formula(M, "convex_trace_point_naive", mirror::point_naive, oracle::point_naive, |draws| {
            // Outwards, because on the way back to small components the digits of a position
            // cancel.
            let (position, direction) = (draws.in_cube(), draws.unit_vector());
            let outwards = if position.dot(direction) < 0.0 { -direction } else { direction };
            (position, outwards, draws.between(0.5, 2.0))
        })
        .benign(1e-6)
        .build(),
    ]
}
