//! Test inputs, edges, invariants and hard cases of `wgsl/curvature.wgsl`.

mod outside;

use crate::{self as mirror, CURVATURE_EDGE_ON, CURVATURE_SMALLEST, CurvatureFrame, CurvaturePixel, oracle};
use glam::{DVec3, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Builder, Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;
use lapidary_assay::value::Value;

mirror_struct!(crate, CurvaturePixel { p_x, p_y, n_x, n_y });
mirror_struct!(crate, CurvatureFrame { first, second, normal, width, lean, rise, bounded });

const M: &str = "curvature";

/// Derivatives of position and normal along both screen axes.
type Derivatives = (Vec3, Vec3, Vec3, Vec3);
/// Derivatives with a light.
type Lit = (Vec3, Vec3, Vec3, Vec3, Vec3);

/// A surface at a pixel: unit normal, principal directions, principal curvatures.
struct Surface {
    normal: DVec3,
    first: DVec3,
    second: DVec3,
    principal: [f64; 2],
}

impl Surface {
    /// Draws a sphere, a cylinder, a saddle, a plane or a general surface, with `size` as the
    /// larger curvature.
    fn draw(draws: &mut Draws<'_>, size: f64) -> Surface {
        let normal = draws.unit_vector().as_dvec3().normalize();
        let first = draws.perpendicular(normal);
        let principal = match draws.below(8) {
            0 => [1.0, 1.0],
            1 => [1.0, 0.0],
            2 => [0.0, -1.0],
            3 => [1.0, -1.0],
            4 => [0.0, 0.0],
            _ => [1.0, f64::from(draws.between(-1.0, 1.0))],
        };
        let sign = if draws.below(2) == 0 { size } else { -size };
        Surface { normal, first, second: normal.cross(first), principal: principal.map(|k| sign * k) }
    }

    /// Returns the derivative of the normal along a tangent.
    fn bend(&self, tangent: DVec3) -> DVec3 {
        let [one, two] = self.principal;
        one * tangent.dot(self.first) * self.first + two * tangent.dot(self.second) * self.second
    }
}

/// Draws the sine of the angle between the position derivatives: wide, at every magnitude, around
/// the limit of edge-on, or parallel.
fn sine(draws: &mut Draws<'_>) -> f64 {
    match draws.below(8) {
        0 | 1 => f64::from(draws.magnitude(-26, -1)),
        2 => f64::from(draws.between(0.5, 2.0)) / 1024.0,
        3 if draws.below(4) == 0 => 0.0,
        _ => f64::from(draws.between(0.1, 1.0)),
    }
}

/// Draws derivatives on a surface, of all sizes and angles: regular, degenerate, or with the
/// asymmetry and the component along the normal that interpolation leaves.
fn derivatives(draws: &mut Draws<'_>) -> (Derivatives, Surface) {
    let width = f64::from(if draws.below(2) == 0 { 1.0 } else { draws.magnitude(-70, 70) });
    let height = width * f64::from(draws.magnitude(-8, 8));
    // The normal turns by at most 1 between two pixels.
    let turn = if draws.below(2) == 0 { 1.0 } else { f64::from(draws.magnitude(-30, 0)) };
    let surface = Surface::draw(draws, turn / width.max(height));
    let right = if draws.below(2) == 0 { surface.first } else { draws.perpendicular(surface.normal) };
    let up = surface.normal.cross(right);
    let sine = sine(draws);
    let cosine = ((1.0 - sine) * (1.0 + sine)).max(0.0).sqrt() * if draws.below(2) == 0 { 1.0 } else { -1.0 };
    let mut p_x = width * right;
    let mut p_y = height * (cosine * right + sine * up);
    match draws.below(24) {
        0 => p_x = DVec3::ZERO,
        1 => p_y = DVec3::ZERO,
        2 => (p_x, p_y) = (DVec3::ZERO, DVec3::ZERO),
        3 => p_y = -2.0 * p_x,
        // Around the smallest size and below it, where the result fades: seen at a wide angle.
        4 => p_x = f64::from(CURVATURE_SMALLEST * draws.magnitude(-20, 2)) * right,
        5 => p_y = f64::from(CURVATURE_SMALLEST * draws.magnitude(-20, 2)) * up,
        _ => {}
    }
    let (mut n_x, mut n_y) = (surface.bend(p_x), surface.bend(p_y));
    if draws.below(4) == 0 {
        // Up to a quarter of the derivatives' length along each axis.
        n_x += 0.25 * n_x.length() * draws.in_cube().as_dvec3();
        n_y += 0.25 * n_y.length() * draws.in_cube().as_dvec3();
    }
    ((p_x.as_vec3(), p_y.as_vec3(), n_x.as_vec3(), n_y.as_vec3()), surface)
}

/// Draws derivatives with a light anywhere, along the surface, or near the zenith at every angle.
fn lit(draws: &mut Draws<'_>) -> Lit {
    let ((p_x, p_y, n_x, n_y), surface) = derivatives(draws);
    let across = draws.perpendicular(surface.normal);
    let light = match draws.below(8) {
        0 => surface.normal,
        1..=3 => {
            let angle = f64::from(draws.magnitude(-24, -1));
            angle.cos() * surface.normal + angle.sin() * across
        }
        4 => across,
        5 => surface.first,
        _ => draws.direction(),
    };
    (p_x, p_y, n_x, n_y, light.as_vec3())
}

/// Draws a case in which the textbook form does well: a surface whose curvatures have the same
/// sign, seen not too obliquely, with a size of about 1.
fn benign(draws: &mut Draws<'_>) -> Lit {
    let normal = draws.direction();
    let first = draws.perpendicular(normal);
    let surface = Surface {
        normal,
        first,
        second: normal.cross(first),
        principal: [f64::from(draws.between(0.5, 1.0)), f64::from(draws.between(0.1, 0.4))],
    };
    let right = draws.perpendicular(normal);
    let up = normal.cross(right);
    let sine = f64::from(draws.between(0.5, 1.0));
    let cosine = (1.0 - sine * sine).sqrt() * if draws.below(2) == 0 { 1.0 } else { -1.0 };
    let p_x = f64::from(draws.between(0.5, 2.0)) * right;
    let p_y = f64::from(draws.between(0.5, 2.0)) * (cosine * right + sine * up);
    let azimuth = std::f64::consts::TAU * draws.unit();
    let elevation = f64::from(draws.between(0.0, 1.2));
    let light = elevation.sin() * normal + elevation.cos() * (azimuth.cos() * right + azimuth.sin() * up);
    let bent = [p_x, p_y].map(|tangent| surface.bend(tangent).as_vec3());
    (p_x.as_vec3(), p_y.as_vec3(), bent[0], bent[1], light.as_vec3())
}

fn benign_derivatives(draws: &mut Draws<'_>) -> Derivatives {
    let (p_x, p_y, n_x, n_y, _) = benign(draws);
    (p_x, p_y, n_x, n_y)
}

/// Returns the sine of the angle between two derivatives; 0 if one is 0.
fn sine_between(p_x: Vec3, p_y: Vec3) -> f64 {
    let (p_x, p_y) = (p_x.as_dvec3(), p_y.as_dvec3());
    let lengths = p_x.length() * p_y.length();
    if lengths == 0.0 { 0.0 } else { p_x.cross(p_y).length() / lengths }
}

/// Returns a bound on the curvatures from these derivatives: |n_x| / |p_x| + |n_y| / |p_y|, with
/// denominators of at least CURVATURE_SMALLEST.
fn steepest((p_x, p_y, n_x, n_y): Derivatives) -> f64 {
    let one = |p: Vec3, n: Vec3| n.as_dvec3().length() / p.as_dvec3().length().max(f64::from(CURVATURE_SMALLEST));
    one(p_x, n_x) + one(p_y, n_y)
}

/// Returns the rounding error of a curvature bounded by `steepest`, divided by the sine.
fn rounding(inputs: Derivatives) -> f64 {
    let least = f64::from(CURVATURE_EDGE_ON).sqrt();
    // Derivatives below the smallest size count with that sine, because the result fades there as
    // it does edge-on.
    let tiny = inputs.0.length().min(inputs.1.length()) < CURVATURE_SMALLEST;
    let sine = if tiny { least } else { sine_between(inputs.0, inputs.1).max(least) };
    64.0 * 2f64.powi(-24) * steepest(inputs) / sine + 1e-30
}

/// Returns a surface with these curvatures along p_x and across it, seen at a sine of 1.04e-3: just
/// not edge-on.
fn aslant(principal: [f32; 2]) -> Derivatives {
    let p_x = Vec3::new(0.6, 0.3, 0.7);
    let p_y = p_x + 1.5e-3 * ACROSS;
    // The difference is exact; the product was not.
    (p_x, p_y, principal[0] * p_x, principal[0] * p_x + principal[1] * (p_y - p_x))
}

/// Vector perpendicular to p_x of [`aslant`].
const ACROSS: Vec3 = Vec3::new(0.3, -0.6, 0.0);

/// Returns a surface with principal curvatures along x and y, seen from straight above.
fn square(principal: [f32; 2]) -> Derivatives {
    (Vec3::X, Vec3::Y, principal[0] * Vec3::X, principal[1] * Vec3::Y)
}

/// Returns a sphere of this radius, with pixels of this size.
fn ball(pixel: f32, radius: f32) -> Derivatives {
    (pixel * Vec3::X, pixel * Vec3::Y, pixel / radius * Vec3::X, pixel / radius * Vec3::Y)
}

fn lit_by((p_x, p_y, n_x, n_y): Derivatives, light: Vec3) -> Lit {
    (p_x, p_y, n_x, n_y, light)
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [input_formulas(), mean_formulas(), gaussian_formulas(), towards_formulas()].into_iter().flatten().collect()
}

fn input_formulas() -> Vec<Formula> {
    const NAIVE: &str = "curvature_normal_derivative_naive";
    let normal_and_derivative = |draws: &mut Draws<'_>| {
        let direction = draws.unit_vector().as_dvec3().normalize();
        let length = f64::from(if draws.below(2) == 0 { 1.0 } else { draws.magnitude(-49, 49) });
        let share = f64::from(draws.magnitude(-40, 20));
        let derivative = match draws.below(8) {
            0 => DVec3::ZERO,
            1 => direction,
            2 => draws.perpendicular(direction),
            _ => draws.direction(),
        };
        let normal = match draws.below(16) {
            0 => 0.0,
            1 => f64::from(CURVATURE_SMALLEST * draws.magnitude(-20, 2)),
            _ => length,
        };
        ((normal * direction).as_vec3(), (share * normal * derivative).as_vec3())
    };
    vec![
        formula(M, "curvature_scale", mirror::scale, oracle::scale, |draws| {
            let component = |draws: &mut Draws<'_>| match draws.below(6) {
                0 => 0.0,
                1 => draws.signed(-1, 1),
                2 => draws.pick(&[1.0, 2.0, 1.0f32.next_down(), -2.0f32.next_down(), CURVATURE_SMALLEST]),
                3 => draws.signed(-60, -45),
                _ => draws.signed(-126, 126),
            };
            (Vec3::new(component(draws), component(draws), component(draws)),)
        })
        .edge("zero", |(v,)| v == Vec3::ZERO)
        .edge("below the least", |(v,)| v != Vec3::ZERO && v.abs().max_element() < CURVATURE_SMALLEST)
        .edge("the least", |(v,)| v.abs().max_element() == CURVATURE_SMALLEST)
        .edge("just below a power of two", |(v,)| v.abs().max_element() == 2.0f32.next_down())
        .edge("x leads", |(v,)| v.abs().max_element() == v.x.abs())
        .edge("y leads", |(v,)| v.abs().max_element() == v.y.abs())
        .edge("z leads", |(v,)| v.abs().max_element() == v.z.abs())
        .build(),
        on_pixels(formula(M, "curvature_pixel", mirror::pixel, oracle::pixel, |draws| derivatives(draws).0))
            .invariant("positions about 1 long, or degenerate", |(x, y, ..), pixel: CurvaturePixel| {
                let sizes = [(x, pixel.p_x), (y, pixel.p_y)].map(|(from, to)| {
                    let [from, size] = [from, to].map(|vector| vector.abs().max_element());
                    from < CURVATURE_SMALLEST && size < 1.0 || (1.0..2.0).contains(&size)
                });
                if sizes == [true; 2] { Ok(()) } else { Err(format!("{pixel:?}")) }
            })
            .build(),
        formula(M, "curvature_frame", mirror::frame, oracle::frame, |draws| {
            let (x, y, n, m) = derivatives(draws).0;
            let pixel = mirror::pixel(x, y, n, m);
            (pixel.p_x, pixel.p_y)
        })
        .edge("edge-on", |(x, y)| (1e-9..9e-4).contains(&sine_between(x, y)))
        .edge("parallel", |(x, y)| x != Vec3::ZERO && y != Vec3::ZERO && x.cross(y) == Vec3::ZERO)
        .edge("no width", |(x, _)| x == Vec3::ZERO)
        .edge("no height", |(_, y)| y == Vec3::ZERO)
        .edge("degenerate", |(x, _)| x != Vec3::ZERO && x.length() < 0.5)
        .invariant_at_nearest("an orthonormal frame, or none", |_, frame: CurvatureFrame| {
            let [first, second] = [frame.first, frame.second].map(|vector| vector.as_dvec3());
            // The rounding of the lengths, 4 ulp of each component.
            let bound = 16.0 * 2f64.powi(-24);
            let whole = [(first, frame.width > 0.0), (second, frame.rise >= CURVATURE_SMALLEST)];
            for (vector, _) in whole.into_iter().filter(|(_, is_whole)| *is_whole) {
                near("length", vector.length(), 1.0, bound)?;
            }
            near("cosine between them", first.dot(second), 0.0, bound)
        })
        .pair("a swapped sign of y turns the second round", |(x, y)| (x, -y), {
            |_, frame: CurvatureFrame, turned: CurvatureFrame| {
                let same = frame.second == -turned.second && frame.lean == -turned.lean && frame.rise == turned.rise;
                if same { Ok(()) } else { Err(format!("{turned:?}")) }
            }
        })
        .build(),
        formula(
            M,
            "curvature_normal_derivative",
            mirror::normal_derivative,
            oracle::normal_derivative,
            normal_and_derivative,
        )
        .edge("no normal", |(normal, _)| normal == Vec3::ZERO)
        .edge("a fading normal", |(normal, _)| (1e-20..5e-16).contains(&normal.length()))
        .edge("no change", |(normal, derivative)| normal != Vec3::ZERO && derivative == Vec3::ZERO)
        .edge("a change of length alone", |(normal, derivative)| {
            derivative != Vec3::ZERO && normal.normalize_or_zero().cross(derivative.normalize_or_zero()).length() < 1e-6
        })
        .invariant("perpendicular to the normal", |(normal, derivative), turned: Vec3| {
            let along = normal.as_dvec3().normalize_or_zero().dot(turned.as_dvec3());
            // With e = 2^-23: the quotient is off by 2.5 e of the result, and a cross product by
            // 2.4 e of its factors' lengths. The error of the outer product is relative to the
            // result, and to the rounding that remains of the inner product if the derivative runs
            // along the normal.
            let e = 2f64.powi(-23);
            let left = 2.4 * e * derivative.as_dvec3().length() / normal.as_dvec3().length().max(1e-20);
            near("part along the normal", along, 0.0, e * (8.0 * turned.as_dvec3().length() + 2.4 * left) + 1e-37)
        })
        .pair("the length of the normal does not matter", |(normal, derivative)| (2.0 * normal, 2.0 * derivative), {
            |(normal, _), turned: Vec3, doubled: Vec3| {
                if normal.length() < 1e-15 {
                    return Ok(());
                }
                near("difference", turned.as_dvec3().distance(doubled.as_dvec3()), 0.0, 1e-37)
            }
        })
        .hard_case(
            "neighbours 1e-6 apart",
            (Vec3::new(0.7, 0.1, 0.5), Vec3::new(0.1e-6, -0.7e-6, 0.0)),
            // The normal's length is the root of 3/4.
            (&[0.1e-6 / 0.75f64.sqrt(), -0.7e-6 / 0.75f64.sqrt(), 0.0], 2e-13),
            (NAIVE, 4e-8),
        )
        .hard_case(
            "neighbours 1e-8 apart",
            (Vec3::new(0.36, 0.48, 0.8), Vec3::new(0.8e-8, -0.6e-8, 0.0)),
            (&[0.8e-8, -0.6e-8, 0.0], 2e-14),
            (NAIVE, 5e-9),
        )
        .hard_case(
            "a normal that vanishes",
            (Vec3::ZERO, Vec3::new(0.0, 1.0, 0.0)),
            (&[0.0, 0.0, 0.0], 0.0),
            (NAIVE, f64::INFINITY),
        )
        .build(),
        formula(M, NAIVE, mirror::normal_derivative_naive, oracle::normal_derivative_naive, |draws| {
            let direction = draws.direction();
            let across = draws.perpendicular(direction);
            let length = f64::from(draws.magnitude(-9, 9));
            let (share, lean) = (f64::from(draws.between(0.2, 2.0)), f64::from(draws.between(-0.2, 0.2)));
            ((length * direction).as_vec3(), (length * share * (across + lean * direction)).as_vec3())
        })
        .benign(2e-5)
        .build(),
    ]
}

/// Adds the edges of pixels, degenerate or not.
fn on_pixels<R: Value + 'static>(builder: Builder<Derivatives, R>) -> Builder<Derivatives, R> {
    builder
        .edge("edge-on", |(x, y, ..)| (1e-9..9e-4).contains(&sine_between(x, y)))
        .edge("about where edge-on begins", |(x, y, ..)| (9e-4..1.1e-3).contains(&sine_between(x, y)))
        .edge("parallel", |(x, y, ..)| x != Vec3::ZERO && y != Vec3::ZERO && x.cross(y) == Vec3::ZERO)
        .edge("no width", |(x, ..)| x == Vec3::ZERO)
        .edge("no height", |(_, y, ..)| y == Vec3::ZERO)
        .edge("a facet", |(x, y, n, m)| sine_between(x, y) > 0.1 && n == Vec3::ZERO && m == Vec3::ZERO)
        .edge("tiny", |(x, ..)| (1e-25..1e-15).contains(&x.length()))
        .edge("huge", |(x, ..)| x.length() > 1e15)
}

fn mean_formulas() -> Vec<Formula> {
    let along = Vec3::new(1.0, 0.5, 0.0);
    let nan = f64::INFINITY;
    const TEXTBOOK: &str = "curvature_mean_textbook";
    const NAIVE: &str = "curvature_naive";
    vec![
        on_pixels(formula(M, "curvature_mean", mirror::mean, oracle::mean, |draws| derivatives(draws).0))
            .invariant("bounded", |(x, y, n, m), mean: f32| {
                let most = 0.5 * steepest((x, y, n, m)) / f64::from(CURVATURE_EDGE_ON).sqrt();
                near("excess", (f64::from(mean).abs() - most * 1.001).max(0.0), 0.0, 1e-30)
            })
            .pair("a normal turned over changes the sign", |(x, y, n, m)| (x, y, -n, -m), {
                |_, mean: f32, turned: f32| near("sum", f64::from(mean) + f64::from(turned), 0.0, 0.0)
            })
            .pair("the screen's axes may be swapped", |(x, y, n, m)| (y, x, m, n), {
                |inputs, mean: f32, swapped: f32| {
                    near("difference", f64::from(mean) - f64::from(swapped), 0.0, rounding(inputs))
                }
            })
            .pair("the screen may be sheared", |(x, y, n, m)| (x, 0.5 * x + y, n, 0.5 * n + m), {
                |(x, y, n, m), mean: f32, sheared: f32| {
                    // A sheared pixel is edge-on or tiny for other inputs.
                    let tiny = x.length().min(y.length()) < 4.0 * CURVATURE_SMALLEST;
                    if tiny || sine_between(x, y) < 4e-3 || sine_between(x, 0.5 * x + y) < 4e-3 {
                        return Ok(());
                    }
                    // Once for the result, once for the sums.
                    let bound = rounding((x, y, n, m)) + rounding((x, 0.5 * x + y, n, 0.5 * n + m));
                    near("difference", f64::from(mean) - f64::from(sheared), 0.0, 2.0 * bound)
                }
            })
            .hard_case("a cylinder nearly edge-on", aslant([0.0, 1.0]), (&[0.5], 2e-4), (TEXTBOOK, 0.05))
            .hard_case(
                "a triangle seen along its plane",
                (along, 2.0 * along, along, along),
                (&[0.0], 0.0),
                (TEXTBOOK, nan),
            )
            .hard_case(
                "a triangle without height",
                (along, Vec3::ZERO, along, Vec3::ZERO),
                (&[0.0], 0.0),
                (TEXTBOOK, nan),
            )
            .hard_case("no triangle", (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO, Vec3::ZERO), (&[0.0], 0.0), (TEXTBOOK, nan))
            .hard_case("a ball of 1e-10", ball(1e-12, 1e-10), (&[1e10], 1e4), (TEXTBOOK, nan))
            .hard_case("a ball of 1e14", ball(1e12, 1e14), (&[1e-14], 1e-20), (TEXTBOOK, 0.9e-14))
            .hard_case("a cylinder seen squarely", square([1.0, 0.0]), (&[0.5], 1e-7), (NAIVE, 0.2))
            .hard_case("a saddle", square([1.0, -1.0]), (&[0.0], 1e-7), (NAIVE, 0.99))
            .hard_case("a hollow", square([-1.0, -1.0]), (&[-1.0], 1e-7), (NAIVE, 1.99))
            .hard_case(
                "no triangle, the usual form",
                (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO, Vec3::ZERO),
                (&[0.0], 0.0),
                (NAIVE, nan),
            )
            .build(),
        formula(M, TEXTBOOK, mirror::mean_textbook, oracle::mean_textbook, benign_derivatives).benign(5e-5).build(),
        formula(M, NAIVE, mirror::naive, oracle::naive, benign_derivatives).benign(2e-6).build(),
    ]
}

fn gaussian_formulas() -> Vec<Formula> {
    let along = Vec3::new(1.0, 0.5, 0.0);
    let nan = f64::INFINITY;
    const TEXTBOOK: &str = "curvature_gaussian_textbook";
    vec![
        on_pixels(formula(M, "curvature_gaussian", mirror::gaussian, oracle::gaussian, |draws| derivatives(draws).0))
            .pair("a normal turned over changes nothing", |(x, y, n, m)| (x, y, -n, -m), {
                |_, gaussian: f32, turned: f32| near("difference", f64::from(gaussian) - f64::from(turned), 0.0, 0.0)
            })
            .invariant("at most the square of the mean", |(x, y, n, m), gaussian: f32| {
                let mean = oracle::mean(x.as_dvec3(), y.as_dvec3(), n.as_dvec3(), m.as_dvec3());
                // If both principal curvatures are equal, K is H², and rounding may lift it above;
                // it enters twice, each time multiplied by a curvature.
                let bound = 2.0 * rounding((x, y, n, m)) * (rounding((x, y, n, m)) * 2f64.powi(20)) + 1e-30;
                near("excess", (f64::from(gaussian) - mean * mean).max(0.0), 0.0, bound)
            })
            .hard_case("a saddle nearly edge-on", aslant([1.0, -1.0]), (&[-1.0], 5e-4), (TEXTBOOK, 0.2))
            .hard_case(
                "a triangle seen along its plane",
                (along, 2.0 * along, along, along),
                (&[0.0], 0.0),
                (TEXTBOOK, nan),
            )
            .hard_case(
                "a triangle without height",
                (along, Vec3::ZERO, along, Vec3::ZERO),
                (&[0.0], 0.0),
                (TEXTBOOK, nan),
            )
            .hard_case("a ball of 1e-10", ball(1e-12, 1e-10), (&[1e20], 1e14), (TEXTBOOK, nan))
            .hard_case("a ball of 1e14", ball(1e12, 1e14), (&[1e-28], 1e-31), (TEXTBOOK, 0.9e-28))
            .build(),
        formula(M, TEXTBOOK, mirror::gaussian_textbook, oracle::gaussian_textbook, benign_derivatives)
            .benign(1e-4)
            .build(),
    ]
}

fn towards_formulas() -> Vec<Formula> {
    let along = Vec3::new(1.0, 0.5, 0.0);
    let nan = f64::INFINITY;
    const TEXTBOOK: &str = "curvature_towards_textbook";
    vec![
        formula(M, "curvature_towards", mirror::towards, oracle::towards, lit)
            .edge("edge-on", |(x, y, ..)| (1e-9..9e-4).contains(&sine_between(x, y)))
            .edge("parallel", |(x, y, ..)| x != Vec3::ZERO && y != Vec3::ZERO && x.cross(y) == Vec3::ZERO)
            .edge("no width", |(x, ..)| x == Vec3::ZERO)
            .edge("no height", |(_, y, ..)| y == Vec3::ZERO)
            .edge("a facet", |(x, y, n, m, _)| sine_between(x, y) > 0.1 && n == Vec3::ZERO && m == Vec3::ZERO)
            .edge("the light at the zenith", |(x, y, _, _, light)| {
                sine_between(x, y) > 0.1 && x.cross(y).normalize_or_zero().cross(light).length() < 1e-6
            })
            .edge("the light along the surface", |(x, y, _, _, light)| {
                sine_between(x, y) > 0.1 && x.cross(y).normalize_or_zero().dot(light).abs() < 1e-6
            })
            .pair("the light's side does not matter", |(x, y, n, m, light)| (x, y, n, m, -light), {
                |_, normal: f32, opposite: f32| near("difference", f64::from(normal) - f64::from(opposite), 0.0, 0.0)
            })
            .invariant("between the principal curvatures", |(x, y, n, m, _), towards: f32| {
                if sine_between(x, y) < 4e-3 || x.length().min(y.length()) < CURVATURE_SMALLEST {
                    // A faded result has the rounding of the result before the fade.
                    return Ok(());
                }
                let [x, y, n, m] = [x, y, n, m].map(|v| v.as_dvec3());
                let (mean, gaussian) = (oracle::mean(x, y, n, m), oracle::gaussian(x, y, n, m));
                let reach = (mean * mean - gaussian).max(0.0).sqrt();
                // Values that may be flushed, as derived in the module.
                let bound = rounding((x.as_vec3(), y.as_vec3(), n.as_vec3(), m.as_vec3())) + 2e-28;
                near("excess", ((f64::from(towards) - mean).abs() - reach).max(0.0), 0.0, bound)
            })
            .hard_case("the light at the zenith", lit_by(square([1.0, 0.0]), Vec3::Z), (&[0.5], 1e-7), (TEXTBOOK, nan))
            .hard_case(
                "a cylinder nearly edge-on",
                lit_by(aslant([0.0, 1.0]), ACROSS.normalize()),
                (&[1.0], 5e-4),
                (TEXTBOOK, 0.1),
            )
            .hard_case(
                "a triangle seen along its plane",
                lit_by((along, 2.0 * along, along, along), Vec3::Z),
                (&[0.0], 0.0),
                (TEXTBOOK, nan),
            )
            .hard_case(
                "a triangle without height",
                lit_by((along, Vec3::ZERO, along, Vec3::ZERO), Vec3::X),
                (&[0.0], 0.0),
                (TEXTBOOK, nan),
            )
            .hard_case("a ball of 1e-10", lit_by(ball(1e-12, 1e-10), Vec3::X), (&[1e10], 1e4), (TEXTBOOK, nan))
            .hard_case("a ball of 1e14", lit_by(ball(1e12, 1e14), Vec3::X), (&[1e-14], 1e-20), (TEXTBOOK, 0.9e-14))
            .build(),
        formula(M, TEXTBOOK, mirror::towards_textbook, oracle::towards_textbook, benign).benign(2e-4).build(),
    ]
}
