//! Test inputs, edges, invariants and hard cases of `wgsl/bvh_trace.wgsl`.

mod outside;

use crate::{
    self as mirror, BVH_TRACE_NAIVE_EPSILON, BVH_TRACE_NONE, BvhTraceBox, BvhTraceExtent, BvhTraceHit, BvhTraceNode,
    BvhTraceObjectRay, BvhTraceRay, oracle,
};
use glam::{DVec3, UVec3, UVec4, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;

mirror_struct!(crate, BvhTraceRay { origin, direction, reciprocal, shear, axis, margin });
mirror_struct!(crate, BvhTraceObjectRay { origin, direction, stretch });
mirror_struct!(crate, BvhTraceNode { corner, steps, lower, upper, children });
mirror_struct!(crate, BvhTraceExtent { lower, upper });
mirror_struct!(crate, BvhTraceBox { entry, hit });
mirror_struct!(crate, BvhTraceHit { distance, barycentrics, triangle });

const M: &str = "bvh_trace";
/// Smaller components of the direction are replaced by this value, 2⁻²⁴.
const SMALLEST: f32 = 5.960_464_5e-8;
/// A distance farther than any hit.
const FAR: f32 = 1e37;

/// Arguments of a triangle test.
type Case = (BvhTraceHit, BvhTraceRay, Vec3, Vec3, Vec3, u32, u32);
/// Arguments of a box test.
type BoxCase = (BvhTraceRay, Vec3, Vec3, f32);

/// Draws a ray direction: anywhere, along an axis, close to one, or with two equal components.
fn direction(draws: &mut Draws<'_>) -> Vec3 {
    match draws.below(4) {
        0 => {
            let axis = draws.unit_vector();
            let aside = draws.direction() * f64::from(draws.magnitude(-30, -2));
            (axis.as_dvec3() + aside).normalize().as_vec3()
        }
        1 => {
            let along = draws.pick(&[Vec3::ONE, Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 1.0, 1.0)]);
            let sign = |draws: &mut Draws<'_>| if draws.below(2) == 0 { 1.0 } else { -1.0 };
            (along * Vec3::new(sign(draws), sign(draws), sign(draws))).normalize()
        }
        _ => draws.unit_vector(),
    }
}

/// Draws the size of a mesh: often 1, otherwise of any magnitude.
fn size(draws: &mut Draws<'_>) -> f64 {
    f64::from(if draws.below(2) == 0 { 1.0 } else { draws.magnitude(-30, 36) })
}

fn exact(ray: &BvhTraceRay) -> oracle::BvhTraceRay {
    oracle::BvhTraceRay {
        origin: ray.origin.as_dvec3(),
        direction: ray.direction.as_dvec3(),
        reciprocal: ray.reciprocal.as_dvec3(),
        shear: ray.shear.as_dvec3(),
        axis: ray.axis,
        margin: ray.margin.into(),
    }
}

fn exact_hit(hit: &BvhTraceHit) -> oracle::BvhTraceHit {
    oracle::BvhTraceHit {
        distance: hit.distance.into(),
        barycentrics: hit.barycentrics.as_dvec2(),
        triangle: hit.triangle,
    }
}

/// Draws a whole or half number from -3 to 3.
fn step(draws: &mut Draws<'_>) -> f32 {
    0.5 * (draws.below(13) as f32 - 6.0)
}

fn steps(draws: &mut Draws<'_>) -> Vec3 {
    Vec3::new(step(draws), step(draws), step(draws))
}

/// Returns whether all values are halves of small whole numbers and the ray runs along an axis, so
/// that f32 computes without any rounding.
fn on_grid(ray: &BvhTraceRay, points: &[Vec3]) -> bool {
    let whole = |value: f32| (2.0 * value).fract() == 0.0 && value.abs() <= 8.0;
    let reciprocal = |value: f32| [0.5, 1.0, 2.0, 1.0 / SMALLEST].contains(&value.abs());
    points.iter().chain([&ray.origin]).all(|point| point.to_array().into_iter().all(whole))
        && ray.shear.truncate() == Vec2::ZERO
        && ray.shear.z.abs() == 1.0
        && ray.reciprocal.to_array().into_iter().all(reciprocal)
        && whole(ray.margin)
}

/// Draws a ray along an axis from a grid point, with a margin on the grid or of 0.
fn grid_ray(draws: &mut Draws<'_>) -> BvhTraceRay {
    let origin = if draws.below(2) == 0 { Vec3::ZERO } else { steps(draws) };
    let along = draws.pick(&[Vec3::Z, Vec3::X, Vec3::Y, Vec3::NEG_Z, Vec3::NEG_X, Vec3::NEG_Y]);
    let margin = draws.pick(&[0.0, 0.5, 1.0]);
    BvhTraceRay { margin, ..mirror::ray(origin, along, origin, origin) }
}

/// Draws a case on the grid, from a set of numbers so small that every tie occurs.
fn grid_case(draws: &mut Draws<'_>) -> Case {
    let ray = grid_ray(draws);
    // Two cyclic permutations are the inverse of one.
    let turn_back = |v: Vec3| mirror::turn(mirror::turn(v, ray.axis), ray.axis);
    // Corners in the ray's frame; in half of the cases the triangle is perpendicular to the ray.
    let level = step(draws);
    let flat = draws.below(2) == 0;
    let mut corner = || {
        let mut vertex = steps(draws);
        if flat {
            vertex.z = level;
        }
        ray.origin + turn_back(vertex)
    };
    let (a, b, c) = (corner(), corner(), corner());
    let distance = draws.pick(&[FAR, 0.0, 0.5, 1.0, 1.5, 2.0, 3.0]);
    let met = draws.pick(&[BVH_TRACE_NONE, 0, 1, 2, 3]);
    let hit = BvhTraceHit { distance, barycentrics: Vec2::new(0.25, 0.5), triangle: met };
    (hit, ray, a, b, c, draws.below(4), draws.pick(&[BVH_TRACE_NONE, 0, 1, 2, 3]))
}

/// Draws the weights of the second and third corner at the point at which the ray is aimed: inside,
/// on an edge, at a corner, just outside, or far away.
fn aim(draws: &mut Draws<'_>, aside: f64) -> (f64, f64) {
    let inside = |draws: &mut Draws<'_>| {
        let (v, w) = (draws.unit(), draws.unit());
        if v + w > 1.0 { (1.0 - v, 1.0 - w) } else { (v, w) }
    };
    let beside = 4.0 * aside * (2.0 * draws.unit() - 1.0);
    match draws.below(8) {
        0 => draws.pick(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5)]),
        1 => {
            let along = draws.unit();
            draws.pick(&[(along, 0.0), (0.0, along), (along, 1.0 - along)])
        }
        2 | 3 => {
            let along = draws.unit();
            draws.pick(&[(along, beside), (beside, along), (along, 1.0 - along + beside)])
        }
        4 => (4.0 * draws.unit() - 2.0, 4.0 * draws.unit() - 2.0),
        _ => inside(draws),
    }
}

/// Draws a ray and a triangle that it is aimed at: of every size, from fat triangles to needles,
/// from perpendicular to the ray to edge-on.
fn any_case(draws: &mut Draws<'_>) -> Case {
    let size = size(draws);
    let toward = direction(draws).as_dvec3();
    // Edge-on or a needle, but not both: in the ray's frame a triangle is at least 1/32 as thick as
    // it is long.
    let shape = draws.below(16);
    let cosine = match shape {
        0..=2 => f64::from(draws.between(1.0 / 16.0, 0.2)),
        3 => -draws.unit(),
        4 | 5 => 0.5 + 0.5 * draws.unit(),
        _ => 0.1 + 0.9 * draws.unit(),
    };
    let across = draws.perpendicular(toward.normalize());
    let normal = (cosine * toward + (1.0 - cosine * cosine).sqrt() * across).normalize();
    let first = draws.perpendicular(normal);
    let second = normal.cross(first);
    let extent = size * f64::from(draws.magnitude(-6, 0));
    let edge_b = extent * first;
    let edge_c = match shape {
        4 | 5 => extent * (draws.unit() * first + f64::from(draws.between(1.0 / 16.0, 0.2)) * second),
        _ => extent * ((2.0 * draws.unit() - 1.0) * first + (0.5 + draws.unit()) * second),
    };
    let distance = match draws.below(8) {
        0 => 0.0,
        1 => 2f64.powi(-16) * size * (2.0 * draws.unit() - 1.0),
        2 => -2.0 * size * draws.unit(),
        _ => 2.0 * size * draws.unit(),
    };
    // At an edge and at the start of the ray the result has a kink, so no input within a few last
    // places need have the rounded result. For a triangle perpendicular to the ray this is within
    // the bounds. It is not if a thin outline magnifies it, or if both kinks coincide.
    let close = distance.abs() < 0.01 * size;
    let (v, w) = if close || cosine.abs() < 0.5 || shape < 6 {
        let (v, w) = draws.pick(&[(0.3, 0.3), (0.1, 0.5), (0.6, 0.2), (0.2, 0.6), (1.5, -0.2), (-0.3, 0.6)]);
        (v + 0.1 * draws.unit(), w + 0.1 * draws.unit())
    } else {
        aim(draws, 2f64.powi(-18) * size / extent)
    };
    // Backward error is relative to the input: at distance 0 from an origin of exactly 0 there is
    // nothing for it to be relative to.
    let origin = match draws.below(3) {
        0 if !close => DVec3::ZERO,
        1 => 8.0 * size * draws.in_cube().as_dvec3(),
        _ => size * draws.in_cube().as_dvec3(),
    };
    let corner = origin + distance * toward - v * edge_b - w * edge_c;
    let [origin, a, b, c] = [origin, corner, corner + edge_b, corner + edge_c].map(|point| point.as_vec3());
    let more = (size * draws.unit()) as f32 * Vec3::ONE;
    let corners = [origin, a, b, c];
    let lower = corners.into_iter().reduce(Vec3::min).unwrap_or_default() - more;
    let upper = corners.into_iter().reduce(Vec3::max).unwrap_or_default() + more;
    let ray = mirror::ray(origin, toward.as_vec3(), lower, upper);
    let hit = if distance > 0.01 * size && draws.below(3) == 0 {
        BvhTraceHit {
            distance: (distance * (0.5 + draws.unit())) as f32,
            barycentrics: Vec2::new(0.25, 0.5),
            triangle: draws.below(100),
        }
    } else {
        mirror::start(FAR)
    };
    let number = draws.below(100);
    (hit, ray, a, b, c, number, if draws.below(16) == 0 { number } else { BVH_TRACE_NONE })
}

/// Draws a needle that a ray along an axis meets at its blunt end. Positions in the frame are exact
/// there, and the weights are as exact as two of the corners are near.
fn straight_case(draws: &mut Draws<'_>) -> Case {
    let along = draws.pick(&[Vec3::Z, Vec3::X, Vec3::Y, Vec3::NEG_Z, Vec3::NEG_X, Vec3::NEG_Y]);
    let (side, up) = (Vec3::new(along.z, along.x, along.y), Vec3::new(along.y, along.z, along.x));
    let azimuth = std::f64::consts::TAU * draws.unit();
    let (sine, cosine) = azimuth.sin_cos();
    let mut corner = |along_needle: f64, across: f64| {
        let (x, y) = (along_needle * cosine - across * sine, along_needle * sine + across * cosine);
        x as f32 * side + y as f32 * up + draws.between(1.0, 2.0) * along
    };
    let near = 2f64.powi(-10);
    let mut corners = [corner(0.3 * near, 0.9 * near), corner(-0.8, 0.1 * near), corner(0.2 * near, -0.9 * near)];
    let first = draws.below(3) as usize;
    corners.rotate_left(first);
    if draws.below(2) == 0 {
        corners.swap(0, 1);
    }
    let [a, b, c] = corners;
    let number = draws.below(100);
    let ray = mirror::ray(Vec3::ZERO, along, a.min(b).min(c).min(Vec3::ZERO), a.max(b).max(c).max(Vec3::ZERO));
    (mirror::start(FAR), ray, a, b, c, number, BVH_TRACE_NONE)
}

fn triangle_case(draws: &mut Draws<'_>) -> Case {
    match draws.below(12) {
        0..=3 => grid_case(draws),
        4 => straight_case(draws),
        _ => any_case(draws),
    }
}

/// Returns the crossing of a case in f64, without any margin.
fn crossing(case: &Case) -> Option<oracle::Crossing> {
    let (_, ray, a, b, c, triangle, _) = *case;
    oracle::crossing([a, b, c].map(|p| p.as_dvec3()), triangle, ray.origin.as_dvec3(), ray.direction.as_dvec3())
}

/// Draws cases in which Möller and Trumbore's test does well: away from edges and from edge-on, or
/// small whole numbers around the epsilon.
fn benign_case(draws: &mut Draws<'_>) -> Case {
    let number = draws.below(4);
    let left = draws.pick(&[BVH_TRACE_NONE, BVH_TRACE_NONE, BVH_TRACE_NONE, 0]);
    if draws.below(2) == 0 {
        let epsilon = BVH_TRACE_NAIVE_EPSILON;
        let near_epsilon = draws.pick(&[1.0, 0.992, 1.008, 0.5, 2.0]) * epsilon;
        let (distance, area) = if draws.below(2) == 0 { (near_epsilon, 1.0) } else { (1.0, near_epsilon) };
        let distance = if draws.below(8) == 0 { -0.5 } else { distance };
        // The ray passes inside, outside, at edges and at corners of a triangle that f32 represents
        // exactly.
        let (v, w) = (0.25 * (draws.below(7) as f32 - 1.0), 0.25 * (draws.below(7) as f32 - 1.0));
        // Outside by less than 1/64.
        let (v, w) = if draws.below(4) == 0 { (0.507_812_5, 0.5) } else { (v, w) };
        let v = if area == 1.0 { v } else { draws.pick(&[0.3, 0.6, 1.3, -0.3]) };
        let a = Vec3::new(-v * area, -w, distance);
        let (b, c) = (a + Vec3::X * area, a + Vec3::Y);
        // Also seen from the other side.
        let (b, c) = if draws.below(8) == 0 { (c, b) } else { (b, c) };
        let before = draws.pick(&[FAR, 1.0, 0.25, epsilon]);
        let hit = BvhTraceHit { distance: before, barycentrics: Vec2::new(0.25, 0.5), triangle: draws.below(4) };
        return (hit, mirror::ray(Vec3::ZERO, Vec3::Z, a, b.max(c)), a, b, c, number, left);
    }
    let toward = draws.direction();
    let origin = draws.in_cube().as_dvec3();
    let cosine = 0.2 + 0.8 * draws.unit();
    let across = draws.perpendicular(toward);
    let normal = cosine * toward + (1.0 - cosine * cosine).sqrt() * across;
    let first = draws.perpendicular(normal.normalize());
    let second = normal.normalize().cross(first);
    let edge_b = (0.5 + draws.unit()) * first;
    let edge_c = (draws.unit() - 0.5) * first + (0.5 + draws.unit()) * second;
    let (v, w) = draws.pick(&[(0.3, 0.3), (0.1, 0.5), (0.6, 0.2), (0.2, 0.7), (0.7, 0.7), (-0.2, 0.5), (0.5, -0.2)]);
    let distance = draws.pick(&[1.0, 0.5, 2.0, -1.0]) * (0.9 + 0.2 * draws.unit());
    let corner = origin + distance * toward - v * edge_b - w * edge_c;
    let [a, b, c] = [corner, corner + edge_b, corner + edge_c].map(|point| point.as_vec3());
    let ray = mirror::ray(origin.as_vec3(), toward.as_vec3(), a.min(b).min(c), a.max(b).max(c));
    let hit = BvhTraceHit { distance: draws.pick(&[FAR, 1.5, 0.7]), barycentrics: Vec2::new(0.25, 0.5), triangle: 7 };
    (hit, ray, a, b, c, number, left)
}

/// Draws a ray whose reciprocals are powers of two, and a box, both on the grid.
fn grid_box(draws: &mut Draws<'_>, least: f32) -> BoxCase {
    let ray = grid_ray(draws);
    let mut component = || {
        let size = draws.pick(&[1.0, 2.0, 0.5, 1.0 / least]);
        if draws.below(2) == 0 { size } else { -size }
    };
    let reciprocal = Vec3::new(component(), component(), component());
    let (one, other) = (steps(draws), steps(draws));
    let nearest = draws.pick(&[FAR, 0.0, 0.5, 1.0, 2.0, 4.0]);
    (BvhTraceRay { reciprocal, direction: 1.0 / reciprocal, ..ray }, one.min(other), one.max(other), nearest)
}

/// Draws a ray aimed at a box: at its middle, its edges, its corners, or just outside; boxes are
/// flat or thick.
fn any_box(draws: &mut Draws<'_>) -> BoxCase {
    let size = size(draws);
    let toward = direction(draws);
    let (one, other) = (size * draws.in_cube().as_dvec3(), size * draws.in_cube().as_dvec3());
    let (mut lower, mut upper) = (one.min(other), one.max(other));
    match draws.below(4) {
        0 => upper.z = lower.z,
        1 => lower.x = upper.x,
        _ => {}
    }
    let mut share = || draws.pick(&[0.5, 0.0, 1.0, 0.25, 1.25, 1.0 + 2f64.powi(-19)]);
    let share = DVec3::new(share(), share(), share());
    let target = lower + share * (upper - lower);
    let distance = draws.pick(&[1.0, 0.0, 3.0, -1.0]) * size;
    let origin = (target - distance * toward.as_dvec3()).as_vec3();
    let (lower, upper) = (lower.as_vec3(), upper.as_vec3());
    let nearest = match draws.below(4) {
        0 => (distance.abs() * (0.5 + draws.unit())) as f32,
        1 => distance.abs() as f32,
        _ => FAR,
    };
    (mirror::ray(origin, toward, lower.min(origin), upper.max(origin)), lower, upper, nearest)
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    let all = [vec![to_object_formula()], ray_formulas(), node_formulas(), box_formulas(), triangle_formulas()];
    all.into_iter().flatten().collect()
}

/// Draws the rows of a matrix that rotates, and scales each axis of the body separately.
fn rows(draws: &mut Draws<'_>) -> [Vec3; 3] {
    let first = draws.unit_vector().as_dvec3().normalize();
    let second = draws.perpendicular(first);
    let size = if draws.below(2) == 0 { 1.0 } else { f64::from(draws.magnitude(-12, 12)) };
    [first, second, first.cross(second)].map(|row| {
        let of_axis = if draws.below(3) == 0 { f64::from(draws.magnitude(-3, 3)) } else { 1.0 };
        (size * of_axis * row).as_vec3()
    })
}

fn to_object_formula() -> Formula {
    formula(M, "bvh_trace_to_object", mirror::to_object, oracle::to_object, |draws| {
        let [row_x, row_y, row_z] = rows(draws);
        let far = if draws.below(2) == 0 { 1.0 } else { draws.magnitude(-10, 30) };
        let place = if draws.below(4) == 0 { Vec3::ZERO } else { far * draws.in_cube() };
        let from_place = draws.pick(&[1.0, 1e-3, 1e3]) * draws.in_cube();
        (place + from_place, direction(draws), place, row_x, row_y, row_z)
    })
    .edge("a body far away", |(origin, _, place, ..)| place.length() > 1e4 * origin.distance(place) && origin != place)
    .edge("a body at the origin", |(_, _, place, ..)| place == Vec3::ZERO)
    .edge("stretched along one axis", |(_, _, _, x, y, _)| x.length() > 2.0 * y.length())
    .edge("of another size", |(_, _, _, x, y, z)| x.length().max(y.length()).max(z.length()) < 0.01)
    .invariant("a unit direction", |_, ray: BvhTraceObjectRay| {
        // Half of a square's and two sums' last places, 4.5 of the root and 2.5 of the quotient, of
        // up to 2^-23 each, and what they are of one another. Two quotients in a row may be taken as
        // one by a product, 1, and then the 2.5 of the first are left in the length alone.
        near("length", ray.direction.as_dvec3().length(), 1.0, 12.25 / f64::from(1 << 23))
    })
    .build()
}

fn ray_formulas() -> Vec<Formula> {
    vec![
        formula(M, "bvh_trace_turn", mirror::turn, oracle::turn, |draws| (draws.in_cube(), draws.below(3)))
            .edge("x", |(_, axis)| axis == 0)
            .edge("y", |(_, axis)| axis == 1)
            .edge("z", |(_, axis)| axis == 2)
            .build(),
        formula(M, "bvh_trace_ray", mirror::ray, oracle::ray, |draws| {
            let size = size(draws) as f32;
            let toward = direction(draws);
            let place = draws.pick(&[1.0, 0.01, 30.0]);
            let (one, other) = (size * draws.in_cube(), size * draws.in_cube());
            (place * size * draws.in_cube(), toward, one.min(other), one.max(other))
        })
        .edge("along x", |(_, r, ..)| r.x.abs() > 0.9)
        .edge("against y", |(_, r, ..)| r.y < -0.9)
        .edge("along z", |(_, r, ..)| r.z.abs() > 0.9)
        .edge("two components alike", |(_, r, ..)| r.x.abs() == r.y.abs() && r.x != 0.0)
        .edge("a component 0", |(_, r, ..)| r.min_element() == 0.0)
        .edge("a component just above the smallest", |(_, r, ..)| {
            r.to_array().iter().any(|x| (1.0..2.0).contains(&(x.abs() / SMALLEST)))
        })
        .edge("a component just below the smallest", |(_, r, ..)| {
            r.to_array().iter().any(|x| (0.5..1.0).contains(&(x.abs() / SMALLEST)))
        })
        .edge("far from the box", |(o, _, lower, upper)| {
            o.distance(0.5 * (lower + upper)) > 10.0 * lower.distance(upper)
        })
        .invariant("all is finite", |_, ray: BvhTraceRay| {
            let finite = ray.reciprocal.is_finite() && ray.shear.is_finite() && ray.margin.is_finite();
            if finite { Ok(()) } else { Err(format!("{ray:?}")) }
        })
        .build(),
        formula(M, "bvh_trace_start", mirror::start, oracle::start, |draws| (draws.magnitude(-20, 122),))
            .edge("a short one", |(limit,)| limit < 1.0)
            .edge("a long one", |(limit,)| limit > 1e30)
            .build(),
        formula(M, "bvh_trace_shear", mirror::shear, oracle::shear, |draws| {
            let (_, ray, a, ..) = any_case(draws);
            (ray, a)
        })
        .edge("along x", |(ray, _)| ray.axis == 0)
        .edge("along y", |(ray, _)| ray.axis == 1)
        .edge("along z", |(ray, _)| ray.axis == 2)
        .edge("against the axis", |(ray, _)| ray.shear.z < 0.0)
        .invariant("the frame gives the position back", |(ray, position), sheared: Vec3| {
            let ray = exact(&ray);
            let axis = ray.axis as usize;
            let mut back = f64::from(sheared.z) * (ray.direction / ray.direction[axis] / ray.shear.z);
            back[(axis + 1) % 3] += f64::from(sheared.x);
            back[(axis + 2) % 3] += f64::from(sheared.y);
            let offset = position.as_dvec3() - ray.origin;
            // The rounding of the shear and of three operations, relative to the offset.
            near("distance", (back - offset).length(), 0.0, 8.0 * 2f64.powi(-23) * offset.length())
        })
        .build(),
    ]
}

/// Draws a node: of any bytes, or of the boxes of a hierarchy's node, with 1 to 4 children.
fn node(draws: &mut Draws<'_>) -> BvhTraceNode {
    let exponent = 87 + draws.below(81);
    // An axis along which the node is flat has the smallest step.
    let near = |draws: &mut Draws<'_>| if draws.below(4) == 0 { 1 } else { (exponent + draws.below(3)).min(167) };
    let steps = near(draws) | near(draws) << 8 | near(draws) << 16;
    let step = 2f64.powi(exponent as i32 - 127);
    // Corners where the sum rounds, and where it cancels.
    let corner = match draws.below(4) {
        0 => Vec3::ZERO,
        1 => -(step * f64::from(draws.below(256))) as f32 * Vec3::ONE,
        _ => (step * f64::from(draws.magnitude(0, 20))) as f32 * draws.in_cube(),
    };
    let corner = corner.clamp(Vec3::splat(-1e12), Vec3::splat(1e12));
    let mut bytes = || UVec3::new(draws.below(u32::MAX), draws.below(u32::MAX), draws.below(u32::MAX));
    let (one, other) = (bytes(), bytes());
    let count = 1 + draws.below(4);
    let (mut lower, mut upper) = (UVec3::ZERO, UVec3::ZERO);
    for axis in 0..3 {
        for child in 0..count {
            let [one, other] = [one, other].map(|words| words[axis] >> (8 * child) & 255);
            lower[axis] |= one.min(other) << (8 * child);
            upper[axis] |= one.max(other) << (8 * child);
        }
    }
    let child = |place: u32| if place < count { place + 1 } else { BVH_TRACE_NONE };
    BvhTraceNode { corner, steps, lower, upper, children: UVec4::new(child(0), child(1), child(2), child(3)) }
}

fn node_formulas() -> Vec<Formula> {
    // The sides of a flat box are equal sums, each rounded on its own: up or down, as WGSL has it.
    let ordered = |extent: BvhTraceExtent| {
        let give = f32::EPSILON * extent.upper.abs();
        if extent.lower.cmple(extent.upper + give).all() { Ok(()) } else { Err(format!("{extent:?}")) }
    };
    vec![
        formula(M, "bvh_trace_child_box", mirror::child_box, oracle::child_box, |draws| (node(draws), draws.below(4)))
            .edge("the first child", |(_, child)| child == 0)
            .edge("the last child", |(_, child)| child == 3)
            .edge("no child", |(node, child)| node.children[child as usize] == BVH_TRACE_NONE)
            .edge("a corner at the origin", |(node, _)| node.corner == Vec3::ZERO)
            .edge("a flat axis", |(node, _)| node.steps & 255 == 1)
            .edge("steps that differ", |(node, _)| node.steps & 255 != node.steps >> 8 & 255)
            .edge("a sum that cancels", |(node, child)| {
                let BvhTraceExtent { lower, .. } = mirror::child_box(node, child);
                lower.x == 0.0 && node.corner.x != 0.0
            })
            .invariant("lower is not above upper, but for rounding", move |_, extent: BvhTraceExtent| ordered(extent))
            .build(),
        formula(M, "bvh_trace_bounds", mirror::bounds, oracle::bounds, |draws| (node(draws),))
            .edge("one child", |(node,)| node.children.y == BVH_TRACE_NONE)
            .edge("four children", |(node,)| node.children.w != BVH_TRACE_NONE)
            .edge("a corner at the origin", |(node,)| node.corner == Vec3::ZERO)
            .invariant("every child's box lies within", |(node,), whole: BvhTraceExtent| {
                let outside = (0..4).map(|child| mirror::child_box(node, child)).find(|child| {
                    let give = 2f32.powi(-22) * (child.lower.abs().max(child.upper.abs()) + node.corner.abs());
                    !(child.lower + give).cmpge(whole.lower).all() || !(child.upper - give).cmple(whole.upper).all()
                });
                outside.map_or(Ok(()), |child| Err(format!("{child:?} in {whole:?}")))
            })
            .build(),
    ]
}

fn box_formulas() -> Vec<Formula> {
    // Through the corner of the flat box, exactly so in f64.
    let toward = Vec3::new(0.895_533_44, -0.199_007_45, 0.398_014_9);
    let (lower, upper) = (Vec3::new(-0.7, -0.2, 0.4), Vec3::new(0.9, 0.7, 0.4));
    let flat = (mirror::ray(Vec3::ZERO, toward, Vec3::new(-0.7, -0.2, 0.0), upper), lower, upper, FAR);
    let toward = Vec3::new(-0.441_128_8, -0.735_214_6, 0.514_650_2);
    let (lower, upper) = (Vec3::new(-0.7, -1.0, 0.1), Vec3::new(-0.6, -0.6, 0.7));
    let thick = (mirror::ray(Vec3::ZERO, toward, Vec3::new(-0.7, -1.0, 0.0), Vec3::Z * 0.7), lower, upper, FAR);
    vec![
        formula(M, "bvh_trace_box", mirror::r#box, oracle::r#box, |draws| {
            if draws.below(3) == 0 { grid_box(draws, SMALLEST) } else { any_box(draws) }
        })
        .edge("hit", |case| mirror::r#box(case.0, case.1, case.2, case.3).hit)
        .edge("missed", |case| !mirror::r#box(case.0, case.1, case.2, case.3).hit)
        .edge("from inside", |(ray, lower, upper, _)| ray.origin.cmpgt(lower).all() && ray.origin.cmplt(upper).all())
        .edge("flat", |(_, lower, upper, _)| lower.z == upper.z)
        .edge("in the plane of a flat box", |(ray, lower, upper, _)| {
            lower.z == upper.z && ray.origin.z == lower.z && ray.direction.z == 0.0
        })
        .edge("behind", |(ray, lower, upper, _)| {
            (0.5 * (lower + upper) - ray.origin).dot(ray.direction) < 0.0 && ray.origin.cmplt(lower).any()
        })
        .edge("farther than the nearest hit", |case| {
            !mirror::r#box(case.0, case.1, case.2, case.3).hit && mirror::r#box(case.0, case.1, case.2, FAR).hit
        })
        .edge("as far as the nearest hit", |case| {
            case.3 > 0.0 && mirror::r#box(case.0, case.1, case.2, case.3).entry == case.3
        })
        .invariant_at_nearest("on a grid all is exact", |(ray, lower, upper, nearest), found: BvhTraceBox| {
            if !on_grid(&ray, &[lower, upper]) {
                return Ok(());
            }
            let wanted = oracle::r#box(exact(&ray), lower.as_dvec3(), upper.as_dvec3(), nearest.into());
            if found.hit == wanted.hit && f64::from(found.entry) == wanted.entry {
                Ok(())
            } else {
                Err(format!("{found:?}, not {wanted:?}"))
            }
        })
        .invariant(
            "a box that the ray itself meets is never missed",
            |(ray, lower, upper, nearest), found: BvhTraceBox| {
                let ray =
                    oracle::BvhTraceRay { margin: 0.0, reciprocal: 1.0 / ray.direction.as_dvec3(), ..exact(&ray) };
                let slanted = ray.direction.abs().min_element() > 1e-12;
                let meets = slanted && oracle::r#box(ray, lower.as_dvec3(), upper.as_dvec3(), nearest.into()).hit;
                if found.hit || !meets { Ok(()) } else { Err("missed".to_owned()) }
            },
        )
        .hard_case("a flat box, hit at its corner", flat, (&[1.004_987_5, 1.0], 1e-5), ("bvh_trace_box_naive", 1.0))
        .hard_case("a box, hit at its edge", thick, (&[1.360_147, 1.0], 1e-5), ("bvh_trace_box_naive", 1.0))
        .build(),
        formula(M, "bvh_trace_box_naive", mirror::box_naive, oracle::r#box, |draws| {
            let (ray, lower, upper, nearest) = grid_box(draws, 0.25);
            (BvhTraceRay { margin: 0.0, ..ray }, lower, upper, nearest)
        })
        .benign(0.0)
        .build(),
    ]
}

fn triangle_formulas() -> Vec<Formula> {
    let whole = |origin: Vec3, toward: Vec3, [a, b, c]: [Vec3; 3]| -> Case {
        let (lower, upper) = (a.min(b).min(c).min(origin), a.max(b).max(c).max(origin));
        (mirror::start(FAR), mirror::ray(origin, toward, lower, upper), a, b, c, 0, BVH_TRACE_NONE)
    };
    let vertex = whole(
        Vec3::ZERO,
        Vec3::new(0.577_350_26, 0.577_350_26, 0.577_350_26),
        [Vec3::new(0.5, -0.8, 0.1), Vec3::splat(0.2), Vec3::new(-0.6, 0.9, 1.0)],
    );
    // The middle of the edge between b and c. The ray meets it from both sides of the edge; Möller
    // and Trumbore's test finds a hit from neither.
    let toward = Vec3::new(0.531_890_63, -0.576_214_85, 0.620_539_07);
    let (b, c) = (Vec3::new(0.3, -0.9, 0.7), Vec3::new(0.9, -0.4, 0.7));
    let one = Vec3::new(0.7, -0.1, 0.8);
    let other = one - 2.0 * (one - 0.5 * (b + c));
    let edge = whole(Vec3::ZERO, toward, [one, b, c]);
    let across = whole(Vec3::ZERO, toward, [other, c, b]);
    let tiny = 1e-4f32;
    let small = whole(
        Vec3::ZERO,
        Vec3::Z,
        [Vec3::new(-tiny, -tiny, tiny), Vec3::new(3.0 * tiny, -tiny, tiny), Vec3::new(-tiny, 3.0 * tiny, tiny)],
    );
    let close = whole(
        Vec3::new(0.0, 0.0, 1.0 - 2f32.powi(-21)),
        Vec3::Z,
        [Vec3::new(-1.0, -1.0, 1.0), Vec3::new(3.0, -1.0, 1.0), Vec3::new(-1.0, 3.0, 1.0)],
    );
    let beyond = whole(
        Vec3::new(0.0, 0.0, 1.0 + 2f32.powi(-20)),
        Vec3::Z,
        [Vec3::new(-1.0, -1.0, 1.0), Vec3::new(3.0, -1.0, 1.0), Vec3::new(-1.0, 3.0, 1.0)],
    );
    vec![
        formula(M, "bvh_trace_triangle", mirror::triangle, oracle::triangle, triangle_case)
            .edge("hit", |case| mirror_of(&case).triangle == case.5 && case.0.triangle != case.5)
            .edge("missed", |case| mirror_of(&case).triangle == BVH_TRACE_NONE)
            .edge("the one before is nearer", |case| {
                let alone = mirror_of(&(mirror::start(FAR), case.1, case.2, case.3, case.4, case.5, case.6));
                alone.triangle == case.5 && mirror_of(&case) == case.0 && case.0.distance < alone.distance
            })
            .edge("as far as the one before", |case| {
                let alone = mirror_of(&(mirror::start(FAR), case.1, case.2, case.3, case.4, case.5, case.6));
                alone.triangle == case.5 && alone.distance == case.0.distance && case.0.triangle != case.5
            })
            .edge("just left", |case| case.5 == case.6)
            .edge("entered instead of left", |case| {
                (case.3 - case.2).cross(case.4 - case.2).dot(case.1.direction) < 0.0
            })
            .edge("edge-on, almost", |case| (0.06..0.2).contains(&cosine(&case)))
            .edge("no area", |case| case.3 == case.4 || case.2 == case.4)
            .edge("beside, within the margin", |case| {
                crossing(&case).is_some_and(|crossing| crossing.clearance < 0.0) && mirror_of(&case).triangle == case.5
            })
            .edge("behind, within the margin", |case| {
                crossing(&case).is_some_and(|crossing| crossing.distance < 0.0) && mirror_of(&case).triangle == case.5
            })
            .edge("beside, past the margin", |case| {
                let margin = f64::from(case.1.margin);
                crossing(&case).is_some_and(|crossing| (-8.0 * margin..-2.0 * margin).contains(&crossing.clearance))
            })
            .edge("along x", |case| case.1.axis == 0)
            .edge("along y", |case| case.1.axis == 1)
            .edge("along z", |case| case.1.axis == 2)
            .edge("against the axis", |case| case.1.shear.z < 0.0)
            .invariant_at_nearest("on a grid all is exact", |case, found: BvhTraceHit| {
                let (hit, ray, a, b, c, triangle, left) = case;
                if !on_grid(&ray, &[a, b, c]) {
                    return Ok(());
                }
                let [a, b, c] = [a, b, c].map(|p| p.as_dvec3());
                let wanted = oracle::triangle(exact_hit(&hit), exact(&ray), a, b, c, triangle, left);
                if found.triangle == wanted.triangle { Ok(()) } else { Err(format!("{found:?}, not {wanted:?}")) }
            })
            .invariant("what the ray meets in exact arithmetic is never refused", |case, found: BvhTraceHit| {
                let (hit, _, _, _, _, triangle, left) = case;
                let clear = crossing(&case).is_some_and(|crossing| {
                    crossing.clearance >= 0.0
                        && crossing.distance >= 0.0
                        && crossing.distance < 0.99 * f64::from(hit.distance)
                        && triangle != left
                        && cosine(&case) > 1e-3
                });
                if !clear || found.triangle == triangle { Ok(()) } else { Err(format!("{found:?}")) }
            })
            .invariant("the weights are as exact as the corners are near", |case, found: BvhTraceHit| {
                let (hit, ray, a, b, c, ..) = case;
                if ray.origin != Vec3::ZERO || ray.shear.truncate() != Vec2::ZERO || found == hit {
                    return Ok(());
                }
                // Positions in the frame are exact here.
                let [p, q, r] = [a, b, c].map(|corner| mirror::shear(ray, corner).truncate().as_dvec2());
                let side = f64::from(ray.shear.z);
                let edges = [(q, r), (r, p), (p, q)];
                let weights = edges.map(|(from, to)| (side * from.perp_dot(to)).max(0.0));
                let total: f64 = weights.iter().sum();
                // Two products and a difference, with an edge that is itself a difference.
                let near = edges.map(|(from, to)| from.length().min(to.length()) * (to - from).length());
                let bound = 2f64.powi(-21) * (near.iter().sum::<f64>() / total + 1.0);
                near_weight(found.barycentrics.x, weights[1] / total, bound)?;
                near_weight(found.barycentrics.y, weights[2] / total, bound)
            })
            .invariant("a hit is ahead, in the triangle", |_, hit: BvhTraceHit| {
                let [v, w] = hit.barycentrics.to_array();
                // The sum of the weights is rounded.
                let inside = v >= 0.0 && w >= 0.0 && v + w <= 1.0 + 4.0 * f32::EPSILON;
                if hit.distance >= 0.0 && inside { Ok(()) } else { Err(format!("{hit:?}")) }
            })
            .pair(
                "the corners may be named from any one on",
                |(hit, ray, a, b, c, triangle, left)| (hit, ray, b, c, a, triangle, left),
                |(hit, ray, a, b, c, ..), one: BvhTraceHit, other: BvhTraceHit| {
                    let slope = (b - a).cross(c - a).dot(ray.direction);
                    let extent = (b - a).length() * (c - a).length();
                    // At the margin, at the distance of the previous hit and edge-on, rounding
                    // decides.
                    if slope < 1e-2 * extent || hit.triangle != BVH_TRACE_NONE || one.triangle != other.triangle {
                        return Ok(());
                    }
                    let offset = (a - ray.origin).length() + (b - ray.origin).length() + (c - ray.origin).length();
                    let offset = f64::from(offset + ray.origin.length());
                    near("distance", one.distance.into(), other.distance.into(), 1e-4 * offset)
                },
            )
            .hard_case(
                "aimed at a vertex",
                vertex,
                (&[0.346_410_16, 1.0, 0.0, 0.0], 1e-6),
                ("bvh_trace_triangle_naive", 1e9),
            )
            .hard_case(
                "aimed at an edge",
                edge,
                (&[1.128_051_4, 0.5, 0.5, 0.0], 1e-6),
                ("bvh_trace_triangle_naive", 1e9),
            )
            .hard_case(
                "aimed at that edge, from its other side",
                across,
                (&[1.128_051_4, 0.5, 0.5, 0.0], 1e-6),
                ("bvh_trace_triangle_naive", 1e9),
            )
            .hard_case(
                "a stone of size 1e-4",
                small,
                (&[f64::from(tiny), 0.25, 0.25, 0.0], 1e-6),
                ("bvh_trace_triangle_naive", 1e9),
            )
            .hard_case(
                "starting 5e-7 before the triangle",
                close,
                (&[2f64.powi(-21), 0.25, 0.25, 0.0], 1e-9),
                ("bvh_trace_triangle_naive", 1e9),
            )
            .hard_case(
                "starting 1e-6 behind the triangle, by rounding",
                beyond,
                (&[0.0, 0.25, 0.25, 0.0], 1e-9),
                ("bvh_trace_triangle_naive", 1e9),
            )
            .build(),
        formula(M, "bvh_trace_triangle_naive", mirror::triangle_naive, oracle::triangle_naive, benign_case)
            .benign(1e-4)
            .build(),
    ]
}

fn near_weight(found: f32, wanted: f64, bound: f64) -> Result<(), String> {
    near("weight", found.into(), wanted, bound)
}

fn mirror_of(case: &Case) -> BvhTraceHit {
    let (hit, ray, a, b, c, triangle, left) = *case;
    mirror::triangle(hit, ray, a, b, c, triangle, left)
}

/// Returns the cosine of the angle between the normal and the ray.
fn cosine(case: &Case) -> f64 {
    let (_, ray, a, b, c, ..) = *case;
    let [a, b, c] = [a, b, c].map(|p| p.as_dvec3());
    (b - a).cross(c - a).normalize_or_zero().dot(ray.direction.as_dvec3())
}
