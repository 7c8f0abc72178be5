//! Tests of the mirror against the oracle at all magnitudes, of the facts behind the paper's
//! erratum, and of the failures of the naive forms.

use super::*;
use glam::{DVec2, DVec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::extremum::larger;
use lapidary_assay::tolerance::ulp_of;

fn largest(vector: DVec3) -> f64 {
    oracle::largest_component(vector)
}

/// Returns the error in ulp of `value`, less the first-order change of the truth for an input error
/// of `backward` ulp.
fn excess<const N: usize>(value: DVec3, truth: impl Fn([DVec3; N]) -> DVec3, inputs: [DVec3; N], backward: f64) -> f64 {
    assert!(value.is_finite(), "{value} for {inputs:?}");
    let exact = truth(inputs);
    let mut allowed = DVec3::ZERO;
    if backward > 0.0 {
        for i in 0..N {
            for axis in DVec3::AXES {
                let mut reach = DVec3::ZERO;
                for sign in [-1.0, 1.0] {
                    let mut near = inputs;
                    near[i] += axis * sign * backward * ulp_of(largest(inputs[i]));
                    reach = reach.max((truth(near) - exact).abs());
                }
                allowed += reach;
            }
        }
    }
    let error = ((value - exact).abs() - allowed).max(DVec3::ZERO);
    largest(error) / ulp_of(largest(exact))
}

fn extend(vector: DVec2) -> DVec3 {
    vector.extend(0.0)
}

fn parameters_truth(v: [DVec3; 4]) -> DVec3 {
    extend(oracle::parameters(v[0], v[1], v[2], v[3]))
}

fn centre_truth(v: [DVec3; 6]) -> DVec3 {
    oracle::centre(v[0], v[1], v[2], v[3], v[4], v[5])
}

fn single<const N: usize>(inputs: [DVec3; N]) -> [Vec3; N] {
    inputs.map(|v| v.as_vec3())
}

fn double<const N: usize>(inputs: [Vec3; N]) -> [DVec3; N] {
    inputs.map(|v| v.as_dvec3())
}

fn pair(random: &mut Draws<'_>, angle: f64) -> [Vec3; 4] {
    let n = random.direction();
    let side = random.direction().reject_from(n).normalize();
    let size = 10f64.powf(30.0 * random.unit() - 15.0);
    let shift = random.in_cube().as_dvec3() * size * [0.0, 1.0, 100.0][random.below(3) as usize];
    let x = match random.below(4) {
        0 => n * (random.unit() - 0.5),
        1 => n.cross(side),
        _ => random.in_cube().as_dvec3(),
    } * size;
    single([shift, n, shift + x, (n * angle.cos() + side * angle.sin()).normalize()])
}

/// Draws a triangle of any shape, sometimes degenerate, with normals at an angle around one axis,
/// at most 120° apart.
fn triangle(random: &mut Draws<'_>, angle: f64) -> [Vec3; 6] {
    let size = 10f64.powf(39.0 * random.unit() - 20.0);
    let shift = random.in_cube().as_dvec3() * [0.0, 1.0, 10.0, 0.1][random.below(4) as usize];
    let mut corners =
        [random.in_cube().as_dvec3() + shift, random.in_cube().as_dvec3() + shift, random.in_cube().as_dvec3() + shift];
    match random.below(14) {
        0 => corners[1] = corners[0],
        1 => corners[2] = corners[1],
        2 => corners[2] = corners[0],
        3 => corners = [corners[0]; 3],
        4 => corners[2] = corners[0] + (corners[1] - corners[0]) * random.unit(),
        12 => corners[2] = corners[0].lerp(corners[1], random.unit()) + random.in_cube().as_dvec3() * 3e-3,
        13 => {
            corners[1] = random.in_cube().as_dvec3() * 10f64.powf(-8.0 * random.unit());
            corners[2] = random.in_cube().as_dvec3() * 10f64.powf(-8.0 * random.unit());
        }
        5 => corners[2] = corners[1] + random.in_cube().as_dvec3() * 10f64.powf(-8.0 * random.unit()),
        _ => {}
    }
    let axis = random.direction();
    let mut inputs = [DVec3::ZERO; 6];
    for i in 0..3 {
        inputs[2 * i] = corners[i] * size;
        inputs[2 * i + 1] = (axis + random.in_cube().as_dvec3() * angle.tan()).normalize();
    }
    if inputs[1].dot(inputs[3]).min(inputs[3].dot(inputs[5])).min(inputs[5].dot(inputs[1])) < -0.5 {
        return triangle(random, angle);
    }
    single(inputs)
}

/// Runs `trial` many times and returns the worst error in ulp beyond the `backward` term of the
/// accuracy.
fn worst(seed: u64, trials: usize, mut trial: impl FnMut(&mut Draws<'_>) -> f64) -> f64 {
    let mut random = Draws::of_row(seed, 0);
    let worst = (0..trials).map(|_| trial(&mut random)).fold(0.0, larger);
    println!("{worst:.2} ulp");
    worst
}

#[test]
fn parameters_are_accurate() {
    for angle in [3.1, 3.0, 2.0, 1.5, 0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 0.0] {
        let error = worst(2, 40_000, |random| {
            let v = pair(random, angle);
            excess(extend(parameters(v[0], v[1], v[2], v[3]).as_dvec2()), parameters_truth, double(v), 1.5)
        });
        assert!(error <= 4.0, "{error} at {angle}");
    }
}

#[test]
fn parameters_keep_their_digits_at_every_angle() {
    // The separation has no component along the normals here, so only the cross product can lose
    // digits.
    for exponent in 1..30 {
        let angle = 10f32.powf(-0.25 * exponent as f32);
        let v = [Vec3::ZERO, Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.8, 1.0, 0.6), Vec3::new(0.6, angle, 0.8)];
        let stable = extend(parameters(v[0], v[1], v[2], v[3]).as_dvec2());
        assert!(excess(stable, parameters_truth, double(v), 0.0) <= 8.0, "{angle}");
        let naive = extend(parameters_dot(v[0], v[1], v[2], v[3]).as_dvec2());
        let exact = parameters_truth(double(v));
        if angle < 1e-3 {
            assert!(!naive.is_finite() || largest(naive - exact) > 1e-2 * largest(exact), "{angle} {naive} {exact}");
        }
    }
}

#[test]
fn printed_equation_swaps_the_parameters() {
    let (x_i, n_i, x_j, n_j) = (Vec3::ZERO, Vec3::X, Vec3::new(2.0, 3.0, 0.0), Vec3::Y);
    assert_eq!(parameters(x_i, n_i, x_j, n_j), Vec2::new(2.0, -3.0));
    assert_eq!(parameters_dot(x_i, n_i, x_j, n_j), Vec2::new(2.0, -3.0));
    assert_eq!(parameters_literal(x_i, n_i, x_j, n_j), Vec2::new(-3.0, 2.0));
}

#[test]
fn fallback_is_accurate() {
    let error = worst(3, 400_000, |random| {
        let v = triangle(random, 0.0);
        let p = fallback(v[0], v[2], v[4]).as_dvec3();
        excess(p, |v| oracle::fallback(v[0], v[1], v[2]), double([v[0], v[2], v[4]]), 2.0)
    });
    assert!(error <= 4.0);
}

#[test]
fn largest_component_is_exact() {
    for vector in [Vec3::new(-3.0, 1.0, 2.0), Vec3::new(1.0, -3.0, 2.0), Vec3::new(2.0, 1.0, -3.0)] {
        assert_eq!(largest_component(vector), 3.0);
    }
}

#[test]
fn direction_is_accurate() {
    let error = worst(4, 400_000, |random| {
        let v = (random.in_cube().as_dvec3() * 10f64.powf(60.0 * random.unit() - 28.0)).as_vec3();
        excess(direction(v).as_dvec3(), |v| oracle::direction(v[0]), double([v]), 0.0)
    });
    assert!(error <= 4.0);
}

#[test]
fn centre_is_accurate() {
    for angle in [1.55, 1.5, 1.0, 0.5, 0.1, 0.03, 1e-2, 1e-3, 1e-4, 1e-6, 0.0] {
        let error = worst(5, 20_000, |random| {
            let v = triangle(random, angle);
            let o = centre(v[0], v[1], v[2], v[3], v[4], v[5]).as_dvec3();
            excess(o, centre_truth, double(v), 3.0)
        });
        assert!(error <= 64.0, "{error} at {angle}");
    }
}

#[test]
fn centre_is_bounded_and_does_not_depend_on_the_first_vertex() {
    let mut random = Draws::of_row(6, 0);
    for _ in 0..100_000 {
        let angle = 10f64.powf(-8.0 * random.unit());
        let v = triangle(&mut random, angle);
        let o = centre(v[0], v[1], v[2], v[3], v[4], v[5]);
        let p = fallback(v[0], v[2], v[4]);
        let squared: f64 =
            (0..3).map(|i| (p - v[2 * i]).as_dvec3().reject_from(v[2 * i + 1].as_dvec3()).length_squared()).sum();
        let slack = 1e-5 * f64::from(largest_component(p).max(largest_component(o)).max(largest_component(v[0])));
        assert!((o - p).as_dvec3().length() <= 32.0 * squared.sqrt() * (1.0 + 1e-5) + slack, "{v:?}");
        let turned = centre(v[2], v[3], v[4], v[5], v[0], v[1]).as_dvec3();
        assert!(excess(turned, centre_truth, double(v), 3.0) <= 64.0, "{v:?}");
    }
}

#[test]
fn naive_forms_are_those_formulas() {
    let corners = [Vec3::new(0.5, 0.0, 0.1), Vec3::new(-0.25, 0.4375, 0.0), Vec3::new(-0.2, -0.4375, 0.0)];
    let normals = [Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.36, 0.48, 0.8), Vec3::new(0.0, -0.28, 0.96)];
    let [a, b, c] = corners.map(|v| v.as_dvec3());
    let [l, m, n] = normals.map(|v| v.as_dvec3());
    let paper = centre_paper(corners[0], normals[0], corners[1], normals[1], corners[2], normals[2]).as_dvec3();
    assert!(largest(paper - oracle::centre_paper(a, l, b, m, c, n)) < 1e-6);
    let literal = centre_literal(corners[0], normals[0], corners[1], normals[1], corners[2], normals[2]).as_dvec3();
    assert!(largest(literal - oracle::centre_literal(a, l, b, m, c, n)) < 1e-6);
    assert!(largest(literal - paper) > 1e-3);
    let naive = fallback_naive(corners[0], corners[1], corners[2]).as_dvec3();
    assert!(largest(naive - oracle::fallback_naive(a, b, c)) < 1e-6);
}

/// Checks the table of docs/closest_point.md: three normals tilted from the z axis, only one or all
/// of them away from the middle.
#[test]
fn table_is_current() {
    let corners = [Vec3::new(0.5, 0.0, 0.0), Vec3::new(-0.25, 0.4375, 0.0), Vec3::new(-0.25, -0.4375, 0.0)];
    let mut table = String::new();
    for tilt in [0.25, 1e-1, 1e-2, 1e-3, 1e-5, 1e-7, 0.0] {
        let lean = |x: f32, y: f32| Vec3::new(tilt * x, tilt * y, 1.0).normalize();
        let all = [lean(1.0, 0.0), lean(-0.5, 0.875), lean(-0.5, -0.875)];
        let one = [lean(1.0, 0.0), Vec3::Z, Vec3::Z];
        table += &format!("| {tilt} |");
        for [l, m, n] in [all, one] {
            let stable = centre(corners[0], l, corners[1], m, corners[2], n).z;
            let paper = centre_paper(corners[0], l, corners[1], m, corners[2], n).z;
            table += &format!(
                " {stable:.2} | {} |",
                if paper.abs() < 1e3 { format!("{paper:.2}") } else { format!("{paper:.0e}") }
            );
        }
        table += "\n";
    }
    let page = include_str!("../../../docs/closest_point.md");
    assert!(page.contains(&table), "docs/closest_point.md should hold:\n{table}");
}
