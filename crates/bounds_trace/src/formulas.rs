//! Test inputs, edges, invariants and hard cases of `wgsl/bounds_trace.wgsl`.

use crate::{self as mirror, BOUNDS_TRACE_NONE, BOUNDS_TRACE_PARALLEL, oracle};
use glam::{DVec3, Vec3, vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::outside::{Promise, any_vector, finite, holds, like, of_length, that, vector_up_to};

const M: &str = "bounds_trace";

/// Part of the distance by which a line passes a silhouette and a start lies off a surface: 2⁻¹⁰.
const CLEAR: f64 = 1.0 / 1024.0;
/// Further part for each unit of the start's distance: 2⁻¹⁸.
const CLEAR_FAR: f64 = 1.0 / 262_144.0;

/// Position and direction of a ray.
type Ray = (Vec3, Vec3);

/// The bounds that a ray is drawn for.
#[derive(Clone, Copy)]
enum Bounds {
    Cuboid,
    Ball,
}

impl Bounds {
    /// Draws a point of the surface.
    fn point(self, draws: &mut Draws<'_>) -> Vec3 {
        match self {
            Self::Cuboid => {
                let (mut point, axis) = (draws.in_cube(), draws.below(3) as usize);
                point[axis] = draws.pick(&[1.0, -1.0]);
                point
            }
            Self::Ball => draws.unit_vector(),
        }
    }

    /// Returns how many times as large the bounds around a point are.
    fn size(self, point: DVec3) -> f64 {
        match self {
            Self::Cuboid => point.abs().max_element(),
            Self::Ball => point.length(),
        }
    }

    /// Returns how many times as large the bounds are that a line touches.
    fn touched(self, (position, direction): (DVec3, DVec3)) -> f64 {
        match self {
            Self::Cuboid => oracle::nearest(position, direction).1,
            Self::Ball => position.cross(direction).length() / direction.length(),
        }
    }

    /// Replaces a start that is too near to the surface, or passes the silhouette too near, by one from
    /// which the direction leads through the middle.
    fn clear(self, (position, direction): Ray) -> Ray {
        let exact = (position.as_dvec3(), direction.as_dvec3());
        let size = self.size(exact.0);
        let is_beside = (size - 1.0).abs() < CLEAR;
        if is_beside || (self.touched(exact) - 1.0).abs() < CLEAR + CLEAR_FAR * size {
            return (-position.length().max(4.0) * direction.normalize(), direction);
        }
        (position, direction)
    }

    /// Draws a ray: towards the bounds, past them, away from them, or from inside.
    fn ray(self, draws: &mut Draws<'_>) -> Ray {
        let direction = heading(draws);
        let passed = match draws.below(5) {
            0 => Vec3::ZERO,
            1 => (1.0 + draws.magnitude(-9, 0)) * self.point(draws),
            2 => self.point(draws),
            3 => 2.0 * draws.in_cube(),
            _ => draws.in_cube(),
        };
        let way = match draws.below(8) {
            0 => 0.0,
            1 => draws.magnitude(-9, 0),
            2 => -draws.magnitude(-1, 6),
            3 => draws.magnitude(4, 12),
            4 => 9_990.0,
            _ => draws.between(1.5, 8.0),
        };
        let length = match draws.below(4) {
            0 => draws.pick(&[0.001_01, 990.0]),
            1 => draws.magnitude(-9, 8),
            _ => 1.0,
        };
        self.clear((passed - way * direction.normalize(), length * direction))
    }
}

/// Draws a unit vector: anywhere, along an axis or a diagonal, parallel to a side of
/// the box, or nearly.
fn heading(draws: &mut Draws<'_>) -> Vec3 {
    let tilted = |draws: &mut Draws<'_>, part: f32| {
        let (mut direction, axis) = (draws.direction().as_vec3(), draws.below(3) as usize);
        direction[axis] = part;
        // Without that part little may be left.
        if direction.length() < 0.1 { Vec3::ONE.normalize() } else { direction.normalize() }
    };
    match draws.below(8) {
        0 => draws.unit_vector(),
        1 => {
            let sign = |draws: &mut Draws<'_>| draws.pick(&[0.577_350_3, -0.577_350_3]);
            vec3(sign(draws), sign(draws), sign(draws))
        }
        2 => {
            let part = draws.signed(-80, -56);
            tilted(draws, part)
        }
        3 => tilted(draws, 0.0),
        _ => draws.direction().as_vec3(),
    }
}

/// Returns whether a ray from outside runs towards the middle but misses.
fn passes_ahead((position, direction): Ray, distance: f64) -> bool {
    distance < 0.0 && position.abs().max_element() > 1.5 && position.dot(direction) < 0.0
}

/// Returns whether a ray, turned around, meets what it misses.
fn is_behind((position, direction): Ray, trace: fn(DVec3, DVec3) -> f64) -> bool {
    trace(position.as_dvec3(), -direction.as_dvec3()) > 0.0
}

/// Checks that a direction twice as long halves the distance.
fn halved(_: Ray, distance: f32, other: f32) -> Result<(), String> {
    let wanted = if distance == BOUNDS_TRACE_NONE { distance } else { 0.5 * distance };
    near("distance", other.into(), wanted.into(), 0.0)
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), promises())
}

fn functions() -> Vec<Formula> {
    let all = [cuboid_formulas(), vec![normal_formula()], ball_formulas()];
    all.into_iter().flatten().collect()
}

fn cuboid_formulas() -> Vec<Formula> {
    let exact = |(position, direction): Ray| oracle::cuboid(position.as_dvec3(), direction.as_dvec3());
    let zeros = |direction: Vec3| direction.to_array().iter().filter(|part| **part == 0.0).count();
    let in_a_side = (vec3(-1.0, 0.25, -3.0), Vec3::Z);
    vec![
        formula(M, "bounds_trace_cuboid", mirror::cuboid, oracle::cuboid, |draws| Bounds::Cuboid.ray(draws))
            .edge("parallel to a pair of sides, met", move |ray: Ray| zeros(ray.1) == 1 && exact(ray) > 0.0)
            .edge("along an axis, met", move |ray: Ray| zeros(ray.1) == 2 && exact(ray) > 0.0)
            .edge("all but parallel to a side", |(_, direction): Ray| {
                let least = direction.abs().min_element();
                least > 0.5 * BOUNDS_TRACE_PARALLEL && least < 2.0 * BOUNDS_TRACE_PARALLEL
            })
            .edge("along a diagonal, through two corners", move |ray: Ray| {
                let (place, toward) = (ray.0.abs(), ray.1.abs());
                place == Vec3::splat(place.x) && toward == Vec3::splat(toward.x) && exact(ray) > 0.0
            })
            .edge("through the middle", move |ray: Ray| ray.0.normalize().dot(ray.1.normalize()) < -0.999_999)
            .edge("a miss, the box ahead", move |ray: Ray| passes_ahead(ray, exact(ray)))
            .edge("from inside", |(position, _): Ray| position.abs().max_element() < 1.0)
            .edge("the box behind", |ray: Ray| is_behind(ray, oracle::cuboid))
            .edge("beside the box, met", move |ray: Ray| ray.0.abs().max_element() < 1.01 && exact(ray) > 0.0)
            .edge("from afar, met", move |ray: Ray| ray.0.abs().max_element() > 5e3 && exact(ray) > 0.0)
            .edge("a short direction, met", move |ray: Ray| ray.1.length() < 0.01 && exact(ray) > 0.0)
            .edge("a long direction, met", move |ray: Ray| ray.1.length() > 100.0 && exact(ray) > 0.0)
            .invariant("the ray enters on the box's surface", |(position, direction): Ray, distance: f32| {
                if distance == BOUNDS_TRACE_NONE {
                    return Ok(());
                }
                let point = position.as_dvec3() + f64::from(distance) * direction.as_dvec3();
                // A quotient is off by 2.5 ulp of the way, which is no longer than the start is far.
                let give = 4.0 * f64::from(f32::EPSILON) * (1.0 + Bounds::Cuboid.size(position.as_dvec3()));
                near("largest coordinate", Bounds::Cuboid.size(point), 1.0, give)
            })
            .pair("a direction twice as long", |(position, direction)| (position, 2.0 * direction), halved)
            .pair(
                "seen from the opposite side",
                |(position, direction)| (-position, -direction),
                |_, one: f32, other: f32| near("distance", other.into(), one.into(), 0.0),
            )
            .hard_case("in the plane of a side", in_a_side, (&[2.0], 1e-6), ("bounds_trace_cuboid_naive", 2.0))
            .build(),
        formula(M, "bounds_trace_cuboid_naive", mirror::cuboid_naive, oracle::cuboid, |draws| {
            let part = |draws: &mut Draws<'_>| draws.between(0.1, 1.0) * draws.pick(&[1.0, -1.0]);
            let direction = draws.magnitude(-6, 8) * vec3(part(draws), part(draws), part(draws));
            let way = draws.between(-8.0, 8.0);
            Bounds::Cuboid.clear((1.5 * draws.in_cube() - way * direction.normalize(), direction))
        })
        .benign(1e-6)
        .build(),
    ]
}

/// Draws a point: on the box, with equal coordinates or nearly, or anywhere.
fn point(draws: &mut Draws<'_>) -> (Vec3,) {
    let point = match draws.below(4) {
        0 => Bounds::Cuboid.point(draws),
        1 => {
            let (first, second) = (draws.nudged(1.0, 2), draws.nudged(1.0, 2));
            let (x, y) = (draws.pick(&[1.0, -1.0]), first * draws.pick(&[1.0, -1.0]));
            let z = second * draws.between(-1.0, 1.0);
            draws.pick(&[vec3(x, y, z), vec3(z, x, y), vec3(y, z, x), vec3(x, y, second), vec3(x, y, 0.0)])
        }
        2 => draws.unit_vector(),
        _ => draws.in_cube(),
    };
    let point = draws.pick(&[1.0, 1.0, 8.0, 0.125]) * point;
    // The middle is on no side.
    (if point.abs().max_element() < 1e-9 { Vec3::X } else { point },)
}

/// Returns the largest coordinate of a point.
fn largest(point: Vec3) -> f32 {
    point.abs().max_element()
}

fn normal_formula() -> Formula {
    formula(M, "bounds_trace_cuboid_normal", mirror::cuboid_normal, oracle::cuboid_normal, point)
        .edge("an edge of x and y", |(point,): (Vec3,)| {
            point.x.abs() == point.y.abs() && point.x.abs() == largest(point) && point.z.abs() < largest(point)
        })
        .edge("an edge of y and z", |(point,): (Vec3,)| {
            point.y.abs() == point.z.abs() && point.y.abs() == largest(point) && point.x.abs() < largest(point)
        })
        .edge("an edge of z and x", |(point,): (Vec3,)| {
            point.z.abs() == point.x.abs() && point.z.abs() == largest(point) && point.y.abs() < largest(point)
        })
        .edge("a corner", |(point,): (Vec3,)| point.abs() == Vec3::splat(point.x.abs()))
        .edge("the middle of a side", |(point,): (Vec3,)| point.abs().element_sum() == largest(point))
        .invariant("it is the axis of the largest coordinate", |(point,), normal: Vec3| {
            let right = normal.dot(point) == largest(point) && normal.abs().element_sum() == 1.0;
            if right { Ok(()) } else { Err(format!("{normal} at {point}")) }
        })
        .build()
}

fn ball_formulas() -> Vec<Formula> {
    let exact = |(position, direction): Ray| oracle::ball(position.as_dvec3(), direction.as_dvec3());
    let from_afar = (vec3(-6_000.0, 0.5, -8_000.0), vec3(0.6, 0.0, 0.8));
    let past_it = (vec3(-6_000.0, 1.5, -8_000.0), vec3(0.6, 0.0, 0.8));
    vec![
        formula(M, "bounds_trace_ball", mirror::ball, oracle::ball, |draws| Bounds::Ball.ray(draws))
            .edge("through the middle", |(position, direction): Ray| {
                position.normalize().dot(direction.normalize()) < -0.999_999
            })
            .edge("far from the middle, met", move |ray: Ray| {
                Bounds::Ball.touched((ray.0.as_dvec3(), ray.1.as_dvec3())) > 0.95 && exact(ray) > 0.0
            })
            .edge("a miss, the ball ahead", move |ray: Ray| passes_ahead(ray, exact(ray)))
            .edge("from inside", |(position, _): Ray| position.length() < 1.0)
            .edge("the ball behind", |ray: Ray| is_behind(ray, oracle::ball))
            .edge("beside the ball, met", move |ray: Ray| ray.0.length() < 1.01 && exact(ray) > 0.0)
            .edge("from afar, met", move |ray: Ray| ray.0.length() > 5e3 && exact(ray) > 0.0)
            .edge("a short direction, met", move |ray: Ray| ray.1.length() < 0.01 && exact(ray) > 0.0)
            .edge("a long direction, met", move |ray: Ray| ray.1.length() > 100.0 && exact(ray) > 0.0)
            .invariant("the ray enters on the ball's surface", |(position, direction): Ray, distance: f32| {
                if distance == BOUNDS_TRACE_NONE {
                    return Ok(());
                }
                let point = position.as_dvec3() + f64::from(distance) * direction.as_dvec3();
                // On the way, 14 ulp; of the start and of the way, 4 ulp of each component.
                let give = 40.0 * f64::from(f32::EPSILON) * (1.0 + position.as_dvec3().length());
                near("distance from the middle", point.length(), 1.0, give)
            })
            .pair("a direction twice as long", |(position, direction)| (position, 2.0 * direction), halved)
            .pair(
                "seen from the opposite side",
                |(position, direction)| (-position, -direction),
                |_, one: f32, other: f32| near("distance", other.into(), one.into(), 0.0),
            )
            .hard_case(
                "from 10,000 radii, half a radius beside the middle",
                from_afar,
                (&[9_999.133_736_206_493], 2e-3),
                ("bounds_trace_ball_naive", 0.8),
            )
            .hard_case(
                "from 10,000 radii, half a radius beside the ball",
                past_it,
                (&[-1.0], 0.0),
                ("bounds_trace_ball_naive", 9_000.0),
            )
            .build(),
        formula(M, "bounds_trace_ball_naive", mirror::ball_naive, oracle::ball, |draws| {
            let toward = draws.direction();
            let across = draws.perpendicular(toward);
            let (aside, way) = match draws.below(6) {
                0 => (0.4 * draws.unit(), 0.3 * draws.unit()),
                1 => (1.1 + 0.9 * draws.unit(), 1.5 + 1.9 * draws.unit()),
                2 => (0.9 * draws.unit(), -1.5 - 1.9 * draws.unit()),
                _ => (0.9 * draws.unit(), 1.5 + 1.9 * draws.unit()),
            };
            let length = f64::from(draws.magnitude(-2, 1));
            ((aside * across - way * toward).as_vec3(), (length * toward).as_vec3())
        })
        .benign(1e-5)
        .build(),
    ]
}

/// Returns the promises of the `Outside:` lines.
fn promises() -> Vec<Promise> {
    const CUBOID: &str = "bounds_trace_cuboid";
    const NORMAL: &str = "bounds_trace_cuboid_normal";
    const BALL: &str = "bounds_trace_ball";
    let within = |draws: &mut Draws<'_>| draws.between(-0.9, 0.9);
    let met = |_: Ray, distance: f32| that(distance > 0.0, || format!("{distance}"));
    let not_met = |_: Ray, distance: f32| that(distance == BOUNDS_TRACE_NONE, || format!("{distance}"));
    vec![
        finite(CUBOID, "finite for positions and directions up to 1e17", |draws| {
            (vector_up_to(draws, 56), vector_up_to(draws, 56))
        }),
        holds(
            CUBOID,
            "a ray in the plane of a side meets the box",
            move |draws| {
                let side = draws.pick(&[1.0, -1.0]);
                let position = vec3(side, within(draws), -draws.between(2.0, 8.0));
                (position, draws.pick(&[1.0, 0.125, 8.0]) * Vec3::Z)
            },
            met,
        ),
        holds(
            CUBOID,
            "a ray that touches an edge meets it",
            move |draws| (vec3(-2.0, within(draws), 0.0), draws.pick(&[1.0, 0.125, 8.0]) * vec3(1.0, 0.0, 1.0)),
            met,
        )
        .at_nearest(),
        holds(
            CUBOID,
            "from a start on a side, BOUNDS_TRACE_NONE",
            move |draws| {
                let side = draws.pick(&[1.0, -1.0]);
                let position = vec3(side, within(draws), within(draws));
                (position, vec3(-side * draws.between(0.1, 1.0), within(draws), within(draws)))
            },
            not_met,
        ),
        holds(
            NORMAL,
            "for any finite point a unit vector along an axis",
            |draws| (any_vector(draws),),
            |_: (Vec3,), normal: Vec3| {
                let axis = normal.abs().max_element() == 1.0 && normal.abs().element_sum() == 1.0;
                that(axis, || format!("{normal}"))
            },
        ),
        like(NORMAL, "at the origin, that of x", |_| (Vec3::ZERO,), |_: (Vec3,)| (Vec3::X,)),
        finite(BALL, "finite for positions up to 1e9 and directions in [1e-9, 1e9]", |draws| {
            (vector_up_to(draws, 29), of_length(draws, -29, 29))
        }),
        holds(
            BALL,
            "a ray that touches the ball meets it",
            |draws| (vec3(-draws.between(1.5, 8.0), 1.0, 0.0), draws.pick(&[1.0, 0.125, 8.0]) * Vec3::X),
            met,
        )
        .at_nearest(),
        holds(
            BALL,
            "from a start on it, BOUNDS_TRACE_NONE",
            |draws| {
                let axis = draws.pick(&[Vec3::Z, Vec3::X, Vec3::Y, Vec3::NEG_Z, Vec3::NEG_X, Vec3::NEG_Y]);
                (axis, draws.direction().as_vec3())
            },
            not_met,
        ),
        holds(
            BALL,
            "with a direction of 0, BOUNDS_TRACE_NONE",
            |draws| (draws.magnitude(1, 10) * draws.unit_vector(), Vec3::ZERO),
            not_met,
        ),
    ]
}
