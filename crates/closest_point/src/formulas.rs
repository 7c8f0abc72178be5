//! Test inputs, edges, invariants and hard cases of `wgsl/closest_point.wgsl`.

mod outside;

use crate::{self as mirror, CLOSEST_POINT_REGULARISATION, oracle};
use glam::{DVec3, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};

const M: &str = "closest_point";

/// A triangle with a normal at each vertex, in the argument order of the module's functions.
type Corners = (Vec3, Vec3, Vec3, Vec3, Vec3, Vec3);

/// Returns a unit normal at `angle` radians from `axis`, at any azimuth.
fn tilted(draws: &mut Draws<'_>, axis: DVec3, angle: f64) -> DVec3 {
    let across = draws.perpendicular(axis);
    (angle.cos() * axis + angle.sin() * across).normalize()
}

/// Draws two lines: at every angle down to equal normals, at every distance, sometimes meeting.
fn two_lines(draws: &mut Draws<'_>) -> (Vec3, Vec3, Vec3, Vec3) {
    let normal_i = draws.unit_vector();
    let axis = normal_i.as_dvec3().normalize();
    let angle = match draws.below(8) {
        0 => 0.0,
        1..=3 => f64::from(draws.magnitude(-24, 0)),
        _ => f64::from(draws.between(0.1, 3.1)),
    };
    let normal_j = if angle == 0.0 { normal_i } else { tilted(draws, axis, angle).as_vec3() };
    let size = f64::from(if draws.below(2) == 0 { 1.0 } else { draws.magnitude(-49, 49) });
    let origin_i = match draws.below(3) {
        0 => DVec3::ZERO,
        1 => size * draws.in_cube().as_dvec3(),
        _ => 100.0 * size * draws.in_cube().as_dvec3(),
    };
    let offset = match draws.below(8) {
        0 => DVec3::ZERO,
        1 => axis,
        2 => axis.cross(normal_j.as_dvec3()).normalize_or(DVec3::X),
        _ => draws.in_cube().as_dvec3(),
    };
    (origin_i.as_vec3(), normal_i, (origin_i + size * offset).as_vec3(), normal_j)
}

/// Draws a triangle of any size: fat, thin around the limit of a sliver, a needle at the origin, or
/// degenerate in every way.
fn triangle(draws: &mut Draws<'_>) -> [Vec3; 3] {
    let size = f64::from(if draws.below(2) == 0 { 1.0 } else { draws.magnitude(-64, 61) });
    let first = draws.unit_vector().as_dvec3().normalize();
    let across = draws.perpendicular(first);
    let (b, c) = match draws.below(16) {
        0 => (DVec3::ZERO, first),
        1 => (first, DVec3::ZERO),
        2 => (first, first),
        3 => (DVec3::ZERO, DVec3::ZERO),
        4 => (first, 3.0 * first),
        5 | 6 => {
            (first, f64::from(draws.between(0.0, 1.0)) * first + 0.003 * f64::from(draws.between(0.1, 2.0)) * across)
        }
        7 => (first, first + 1e-3 * f64::from(draws.between(0.1, 2.0)) * draws.direction()),
        _ => (first, f64::from(draws.between(-1.0, 1.5)) * first + f64::from(draws.between(0.2, 1.5)) * across),
    };
    let corner = match draws.below(4) {
        0 => DVec3::ZERO,
        1 => -b,
        2 => draws.in_cube().as_dvec3(),
        _ => 10.0 * draws.in_cube().as_dvec3(),
    };
    [corner, corner + b, corner + c].map(|vertex| (size * vertex).as_vec3())
}

/// Draws three normals at most 120 degrees apart: parallel, nearly parallel, around the angle at
/// which the regularisation takes over, or wide.
fn normals(draws: &mut Draws<'_>) -> [Vec3; 3] {
    let axis = draws.unit_vector();
    let middle = axis.as_dvec3().normalize();
    let most = match draws.below(8) {
        0 => return [axis; 3],
        1..=3 => f64::from(draws.magnitude(-26, -1)),
        4 => 0.016,
        _ => 1.04,
    };
    std::array::from_fn(|_| {
        let share = draws.unit();
        let normal = tilted(draws, middle, most * share).as_vec3();
        if draws.below(8) == 0 { axis } else { normal }
    })
}

fn corners(draws: &mut Draws<'_>) -> Corners {
    let [a, b, c] = triangle(draws);
    let [n_a, n_b, n_c] = normals(draws);
    (a, n_a, b, n_b, c, n_c)
}

/// Draws corners whose normals are 0.3 to 2.8 radians apart, away from the origin so that no
/// component of the result is near 0.
fn benign_corners(draws: &mut Draws<'_>) -> Corners {
    let place = |draws: &mut Draws<'_>| Vec3::splat(3.0) + draws.in_cube();
    let axis = draws.direction();
    let first = draws.perpendicular(axis);
    let second = axis.cross(first);
    // A third of a turn apart around the axis, at 35 to 70 degrees from it.
    let normal = |draws: &mut Draws<'_>, third: f64| {
        let (polar, azimuth) = (0.6 + 0.6 * draws.unit(), std::f64::consts::TAU * (third + 0.1 * draws.unit()) / 3.0);
        (polar.cos() * axis + polar.sin() * (azimuth.cos() * first + azimuth.sin() * second)).as_vec3()
    };
    (place(draws), normal(draws, 0.0), place(draws), normal(draws, 1.0), place(draws), normal(draws, 2.0))
}

/// Draws two lines at an angle of 0.5 to 2.6 radians, at most 1 apart, whose closest points lie 0.5
/// to 2 from the origins: parameters much smaller than the separation of the origins would be
/// mostly rounding. With e = 2^-24: the separation is at most 5, so numerators of products of dot
/// products are off by 75 e, and the determinant, at least 0.23, by 15 e. As one of the parameters
/// is 0.5 or more, this makes 720 e, 4.3e-5. Cross products take fewer steps.
fn benign_lines(draws: &mut Draws<'_>) -> (Vec3, Vec3, Vec3, Vec3) {
    let normal_i = draws.direction();
    let angle = 0.5 + 2.1 * draws.unit();
    let normal_j = tilted(draws, normal_i, angle);
    let [t_i, t_j] = [(); 2].map(|()| draws.pick(&[1.0, -1.0]) * (0.5 + 1.5 * draws.unit()));
    let offset = draws.unit() * normal_i.cross(normal_j).normalize();
    let origin_i = draws.in_cube();
    let origin_j = origin_i.as_dvec3() + t_i * normal_i + offset - t_j * normal_j;
    (origin_i, normal_i.as_vec3(), origin_j.as_vec3(), normal_j.as_vec3())
}

fn angle_between(a: Vec3, b: Vec3) -> f64 {
    let (a, b) = (a.as_dvec3(), b.as_dvec3());
    a.cross(b).length().atan2(a.dot(b))
}

fn extent(vertices: [Vec3; 3]) -> f64 {
    let [a, b, c] = vertices.map(Vec3::as_dvec3);
    (b - a).length().max((c - a).length()).max((c - b).length())
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [vector_formulas(), line_formulas(), fallback_formulas(), centre_formulas(), paper_formulas()]
        .into_iter()
        .flatten()
        .collect()
}

fn vector_formulas() -> Vec<Formula> {
    const NAIVE: &str = "closest_point_direction_naive";
    let vector = |draws: &mut Draws<'_>| match draws.below(8) {
        0 => (Vec3::ZERO,),
        1 => (Vec3::new(draws.signed(-99, 120), 0.0, 0.0),),
        2 => (Vec3::new(0.0, draws.signed(-99, 120), draws.signed(-99, 120)),),
        3 => (Vec3::new(draws.signed(-99, 120), draws.signed(-99, 120), draws.signed(-99, 120)),),
        _ => (draws.magnitude(-99, 120) * draws.unit_vector(),),
    };
    vec![
        formula(M, "closest_point_largest_component", mirror::largest_component, oracle::largest_component, vector)
            .edge("zero", |(v,)| v == Vec3::ZERO)
            .edge("largest in x", |(v,)| v.x.abs() > v.y.abs().max(v.z.abs()))
            .edge("largest in y", |(v,)| v.y.abs() > v.x.abs().max(v.z.abs()))
            .edge("largest in z", |(v,)| v.z.abs() > v.x.abs().max(v.y.abs()))
            .edge("negative", |(v,)| v.max_element() <= 0.0 && v != Vec3::ZERO)
            .build(),
        formula(M, "closest_point_direction", mirror::direction, oracle::direction, vector)
            .edge("zero", |(v,)| v == Vec3::ZERO)
            .edge("length below 1e-20", |(v,)| v.abs().max_element() < 1e-20 && v != Vec3::ZERO)
            .edge("length above 1e19", |(v,)| v.abs().max_element() > 1e19)
            .invariant("unit length, or zero", |(v,), direction: Vec3| {
                let wanted = if v == Vec3::ZERO { 0.0 } else { 1.0 };
                near("length", direction.as_dvec3().length(), wanted, 1e-6)
            })
            .hard_case(
                "length 5e-24",
                (Vec3::new(3e-24, 0.0, 4e-24),),
                (&[0.6, 0.0, 0.8], 1e-6),
                (NAIVE, f64::INFINITY),
            )
            .hard_case("length 5e19", (Vec3::new(3e19, 0.0, 4e19),), (&[0.6, 0.0, 0.8], 1e-6), (NAIVE, 0.5))
            .hard_case("the zero vector", (Vec3::ZERO,), (&[0.0; 3], 0.0), (NAIVE, f64::INFINITY))
            .build(),
        formula(M, NAIVE, mirror::direction_naive, oracle::direction, |draws| {
            (draws.magnitude(-49, 49) * draws.unit_vector(),)
        })
        .benign(1e-6)
        .build(),
    ]
}

fn line_formulas() -> Vec<Formula> {
    const NAIVE: &str = "closest_point_parameters_dot";
    // Lines at a small angle `s`: n_i = (.6, 0, .8), n_j = normalize(.6, s, .8), from 0 and
    // (.3, 1, -.2).
    let at_angle = |n_j: [f32; 3]| (Vec3::ZERO, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.3, 1.0, -0.2), Vec3::from(n_j));
    vec![
        formula(M, "closest_point_parameters", mirror::parameters, oracle::parameters, two_lines)
            .edge("equal normals", |(_, n_i, _, n_j)| n_i == n_j)
            .edge("an angle below 1e-5", |(_, n_i, _, n_j)| n_i != n_j && angle_between(n_i, n_j) < 1e-5)
            .edge("nearly opposite", |(_, n_i, _, n_j)| angle_between(n_i, n_j) > 3.0)
            .edge("the same origin", |(x_i, _, x_j, _)| x_i == x_j)
            .edge("tiny", |(x_i, _, x_j, _)| x_i != x_j && x_i.distance(x_j) < 1e-10)
            .edge("huge", |(x_i, _, x_j, _)| x_i.distance(x_j) > 1e10)
            .pair("the lines exchanged exchange the parameters", |(x_i, n_i, x_j, n_j)| (x_j, n_j, x_i, n_i), {
                |_, t: Vec2, other: Vec2| {
                    let scale = f64::from(t.abs().max_element());
                    near(
                        "difference",
                        (t.as_dvec2() - glam::DVec2::new(other.y.into(), other.x.into())).length(),
                        0.0,
                        1e-5 * scale,
                    )
                }
            })
            .hard_case(
                "an angle of 1e-2",
                at_angle([0.599_970_04, 0.009_999_501, 0.799_960_1]),
                (&[-99.979_914_605_189_62, -100.004_908_535_909_37], 6e-5),
                (NAIVE, 0.05),
            )
            .hard_case(
                "an angle of 1e-3",
                at_angle([0.599_999_7, 0.000_999_999_6, 0.799_999_65]),
                (&[-999.971_369_6, -999.991_834_5], 5e-4),
                (NAIVE, 40.0),
            )
            .hard_case(
                "an angle of 1e-4",
                at_angle([0.6, 1e-4, 0.8]),
                (&[-9_999.980_252_612_671, -10_000.000_252_621_254], 8e-3),
                (NAIVE, f64::INFINITY),
            )
            .hard_case(
                "an angle of 1e-7",
                at_angle([0.6, 1e-7, 0.8]),
                (&[-9_999_999.863_139_018, -9_999_999.883_139_025], 8.0),
                (NAIVE, f64::INFINITY),
            )
            .hard_case(
                "a plain cross product of two normals 5e-5 apart",
                (
                    Vec3::ZERO,
                    Vec3::new(0.839_001_95, 0.538_878_56, -0.075_402_99),
                    Vec3::new(0.3, 1.0, -0.2),
                    Vec3::new(0.839_005_05, 0.538_867_6, -0.075_446_75),
                ),
                (&[625.768_916_925_23, 624.963_263_509_1], 0.02),
                (NAIVE, 100.0),
            )
            .hard_case("parallel normals", at_angle([0.6, 0.0, 0.8]), (&[0.0, 0.0], 0.0), (NAIVE, f64::INFINITY))
            .hard_case(
                "two axes, where a sphere cannot tell t_i from t_j",
                (Vec3::ZERO, Vec3::X, Vec3::new(2.0, 3.0, 0.0), Vec3::Y),
                (&[2.0, -3.0], 0.0),
                ("closest_point_parameters_literal", 5.0),
            )
            .build(),
        formula(M, "closest_point_parameters_dot", mirror::parameters_dot, oracle::parameters_dot, benign_lines)
            .benign(4.5e-5)
            .build(),
        formula(
            M,
            "closest_point_parameters_literal",
            mirror::parameters_literal,
            oracle::parameters_literal,
            benign_lines,
        )
        .benign(4.5e-5)
        .build(),
    ]
}

fn fallback_formulas() -> Vec<Formula> {
    const NAIVE: &str = "closest_point_fallback_naive";
    let right_angled = |size: f32| (Vec3::ZERO, Vec3::X * size, Vec3::Y * size);
    let below = |size: f64| {
        let third = size / 3.0;
        // The longest edge, √2 times the size, less the fade.
        let depth =
            std::f64::consts::SQRT_2 * size / (1.0 + (2.0 * f64::from(crate::CLOSEST_POINT_SLIVER)).powi(2)).sqrt();
        [third, third, -depth]
    };
    let corner = Vec3::new(1.0, 2.0, 3.0);
    vec![
        formula(M, "closest_point_fallback", mirror::fallback, oracle::fallback, |draws| {
            let [a, b, c] = triangle(draws);
            (a, b, c)
        })
        .edge("two equal corners", |(a, b, c)| a == b && b != c)
        .edge("three equal corners", |(a, b, c)| a == b && b == c)
        .edge("collinear", |(a, b, c)| {
            a != b && a != c && (b - a).normalize_or_zero().cross((c - a).normalize_or_zero()) == Vec3::ZERO
        })
        .edge("size below 1e-18", |(a, b, c)| a != b && extent([a, b, c]) < 1e-18)
        .edge("size above 1e18", |(a, b, c)| extent([a, b, c]) > 1e18)
        .invariant("no farther than the longest edge from the centroid", |(a, b, c), p: Vec3| {
            let centroid = (a.as_dvec3() + b.as_dvec3() + c.as_dvec3()) / 3.0;
            let scale = extent([a, b, c]) + f64::from(a.abs().max_element());
            near("excess", (p.as_dvec3().distance(centroid) - extent([a, b, c])).max(0.0), 0.0, 1e-5 * scale)
        })
        .pair(
            "twice the size, twice as far",
            |(a, b, c)| (2.0 * a, 2.0 * b, 2.0 * c),
            |_, p: Vec3, doubled: Vec3| {
                near("difference", (2.0 * p - doubled).as_dvec3().length(), 0.0, 1e-6 * p.as_dvec3().length())
            },
        )
        .hard_case(
            "a cross product of the two long edges of a needle",
            (
                Vec3::ZERO,
                Vec3::new(-0.842_004_954_814_910_9, 0.048_710_234_463_214_874, 0.537_266_254_425_048_8),
                Vec3::new(-0.838_605_642_318_725_6, 0.048_597_883_433_103_56, 0.535_161_018_371_582),
            ),
            (&[-0.517_225_082_239, -0.022_292_148_624_3, 0.429_793_515_345], 4e-6),
            (NAIVE, 1e-3),
        )
        .hard_case("edges of 1e-20", right_angled(1e-20), (&below(f64::from(1e-20f32)), 1e-26), (NAIVE, f64::INFINITY))
        .hard_case("edges of 1e19", right_angled(1e19), (&below(1e19), 1e13), (NAIVE, 1e18))
        .hard_case(
            "two equal corners",
            (corner, corner, corner + Vec3::X),
            (&[4.0 / 3.0, 2.0, 3.0], 1e-6),
            (NAIVE, f64::INFINITY),
        )
        .hard_case("three equal corners", (corner, corner, corner), (&[1.0, 2.0, 3.0], 0.0), (NAIVE, f64::INFINITY))
        .hard_case(
            "collinear corners",
            (Vec3::ZERO, Vec3::X, 3.0 * Vec3::X),
            (&[4.0 / 3.0, 0.0, 0.0], 1e-6),
            (NAIVE, f64::INFINITY),
        )
        .build(),
        formula(M, "closest_point_fallback_naive", mirror::fallback_naive, oracle::fallback_naive, |draws| {
            let place = Vec3::splat(3.0) + draws.in_cube();
            let first = draws.direction();
            let across = draws.perpendicular(first);
            let second = f64::from(draws.between(-0.5, 1.0)) * first + f64::from(draws.between(0.4, 1.0)) * across;
            (place, place + first.as_vec3(), place + second.as_vec3())
        })
        .benign(1e-4)
        .build(),
    ]
}

fn centre_formulas() -> Vec<Formula> {
    const PAPER: &str = "closest_point_centre_paper";
    let (a, b, c) = (Vec3::new(0.5, 0.0, 0.0), Vec3::new(-0.25, 0.4375, 0.0), Vec3::new(-0.25, -0.4375, 0.0));
    let with = |n_a: Vec3, n_b: Vec3, n_c: Vec3| (a, n_a, b, n_b, c, n_c);
    let up = Vec3::Z;
    // Three normals 2 radians apart about the vertical, and `angle` radians off it.
    let inwards = |angle: f32| {
        let lean = |turn: f32| Vec3::new(angle * turn.cos(), angle * turn.sin(), 1.0).normalize();
        with(lean(0.0), lean(2.0), lean(4.0))
    };
    let truth = |(a, n_a, b, n_b, c, n_c): Corners| {
        let [a, n_a, b, n_b, c, n_c] = [a, n_a, b, n_b, c, n_c].map(Vec3::as_dvec3);
        oracle::centre(a, n_a, b, n_b, c, n_c).to_array()
    };
    let leaning = Vec3::new(0.36, 0.48, 0.8);
    vec![
        formula(M, "closest_point_centre", mirror::centre, oracle::centre, corners)
            .edge("three equal normals", |(_, n_a, _, n_b, _, n_c)| n_a == n_b && n_b == n_c)
            .edge("two equal normals", |(_, n_a, _, n_b, _, n_c)| n_a == n_b && n_b != n_c)
            .edge("normals within 1e-6 of each other", |(_, n_a, _, n_b, _, n_c)| {
                n_a != n_b && angle_between(n_a, n_b).max(angle_between(n_a, n_c)) < 1e-6
            })
            .edge("normals about the regularisation's angle", |(_, n_a, _, n_b, _, n_c)| {
                (0.01..0.04).contains(&angle_between(n_a, n_b).max(angle_between(n_a, n_c)))
            })
            .edge("normals a radian apart", |(_, n_a, _, n_b, ..)| angle_between(n_a, n_b) > 1.0)
            .edge("two equal corners", |(a, _, b, _, c, _)| a == b && b != c)
            .edge("three equal corners", |(a, _, b, _, c, _)| a == b && b == c)
            .edge("the centre outside, before the face", |(a, n_a, b, n_b, c, n_c)| {
                let face = (b - a).cross(c - a).normalize_or_zero();
                (mirror::centre(a, n_a, b, n_b, c, n_c) - a).dot(face) > 0.0
            })
            .invariant(
                "no farther from the fallback than the regularisation allows",
                |(a, n_a, b, n_b, c, n_c), o: Vec3| {
                    let p = oracle::fallback(a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
                    let residual: f64 = [(a, n_a), (b, n_b), (c, n_c)]
                        .iter()
                        .map(|(x, n)| (x.as_dvec3() - p).cross(n.as_dvec3()).length_squared())
                        .sum();
                    let most = residual.sqrt() / (2.0 * f64::from(CLOSEST_POINT_REGULARISATION).sqrt());
                    let distance = o.as_dvec3().distance(p);
                    near("excess", (distance - most).max(0.0), 0.0, 1e-4 * (most + p.length()))
                },
            )
            .pair("the order of the corners does not matter", |(a, n_a, b, n_b, c, n_c)| (b, n_b, c, n_c, a, n_a), {
                |(a, n_a, b, n_b, c, n_c), o: Vec3, other: Vec3| {
                    // Conditioning of the sum: the inverse of the angle, or of the regularisation.
                    let angle = angle_between(n_a, n_b).max(angle_between(n_a, n_c));
                    let scale = extent([a, b, c]) + a.as_dvec3().length();
                    let amplified = 1.0 / angle.clamp(0.016, 1.0);
                    near("difference", (o - other).as_dvec3().length(), 0.0, 2e-5 * scale * amplified * 64.0)
                }
            })
            .pair(
                "continuous: a normal moved by an ulp moves the centre by no more than the regularisation lets it",
                |(a, n_a, b, n_b, c, n_c)| (a, Vec3::new(n_a.x.next_up(), n_a.y, n_a.z), b, n_b, c, n_c),
                |(a, _, b, _, c, _), o: Vec3, moved: Vec3| {
                    // The inverse of the matrix is at most 1 / regularisation. Matrix and
                    // right-hand side move by two ulp, and the centre lies within 32 extents.
                    let ulps = 4.0 * f64::from(f32::EPSILON) / f64::from(CLOSEST_POINT_REGULARISATION);
                    let most = ulps * 33.0 * extent([a, b, c]);
                    near("distance", o.as_dvec3().distance(moved.as_dvec3()), 0.0, most + 1e-5 * a.as_dvec3().length())
                },
            )
            .hard_case("normals 1e-3 apart", inwards(1e-3), (&truth(inwards(1e-3)), 3e-6), (PAPER, 0.1))
            .hard_case("normals 1e-5 apart", inwards(1e-5), (&truth(inwards(1e-5)), 3e-6), (PAPER, 100.0))
            .hard_case(
                "three nearly equal normals",
                with(Vec3::new(1e-7, 0.0, 1.0), Vec3::new(-5e-8, 8.66e-8, 1.0), Vec3::new(-5e-8, -8.66e-8, 1.0)),
                (&[0.0, 0.0, -0.875_617_006_4], 3e-7),
                (PAPER, 1e6),
            )
            .hard_case(
                "one normal tilted by 1e-7 inwards",
                with(Vec3::new(1e-7, 0.0, 1.0), up, up),
                (&[0.0, 0.0, -0.875_204_232_1], 3e-7),
                (PAPER, 1e6),
            )
            .hard_case(
                "one normal tilted by 1e-7 outwards",
                with(Vec3::new(-1e-7, 0.0, 1.0), up, up),
                (&[0.0, 0.0, -0.874_794_632_1], 3e-7),
                (PAPER, 1e6),
            )
            .hard_case(
                "normals an ulp apart",
                with(
                    leaning,
                    Vec3::new(leaning.x.next_up(), leaning.y, leaning.z),
                    Vec3::new(leaning.x, leaning.y.next_up(), leaning.z),
                ),
                (&[-0.251_953_560_86, -0.335_938_053_40, -0.559_967_971_75], 5e-7),
                (PAPER, 1e6),
            )
            .hard_case(
                "three equal normals",
                with(up, up, up),
                (&[0.0, 0.0, -0.874_999_432_1], 3e-7),
                ("closest_point_centre_literal", f64::INFINITY),
            )
            .build(),
    ]
}

fn paper_formulas() -> Vec<Formula> {
    vec![
        formula(M, "closest_point_centre_paper", mirror::centre_paper, oracle::centre_paper, |draws| {
            if draws.below(16) == 0 {
                // All normals parallel: the sum of the weights is 0, and the fallback is used.
                let (a, n, b, _, c, _) = benign_corners(draws);
                (a, Vec3::Z * n.z.signum(), b, Vec3::Z * n.z.signum(), c, Vec3::Z * n.z.signum())
            } else {
                benign_corners(draws)
            }
        })
        .benign(1e-3)
        .build(),
        formula(M, "closest_point_centre_literal", mirror::centre_literal, oracle::centre_literal, benign_corners)
            .benign(1e-3)
            .build(),
    ]
}
