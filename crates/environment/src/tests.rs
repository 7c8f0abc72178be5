//! Compares the mirror with the oracle: the errors of f32, and the failures of the naive forms.

use super::*;
use glam::{DVec2, DVec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::extremum::larger;
use lapidary_assay::extremum::largest;
use lapidary_assay::tolerance::ulp_of;

fn report(what: &str, worst: f64, bound: f64) {
    println!("{what}: {worst:.3e} of {bound:.3e}");
    assert!(worst <= bound, "{what}: {worst:e} > {bound:e}");
}

/// Returns the change of `f` when each component of `input` changes by `ulps` of the largest one:
/// the allowance for `ulps` of backward error.
fn backward(ulps: f64, input: Vec3, f: impl Fn(DVec3) -> DVec3) -> f64 {
    let (exact, step) = (f(input.as_dvec3()), ulps * ulp_of(f64::from(input.abs().max_element())));
    DVec3::AXES
        .iter()
        .map(|&axis| {
            let moved = |sign: f64| largest((f(input.as_dvec3() + sign * step * axis) - exact).abs().to_array());
            moved(1.0).max(moved(-1.0))
        })
        .sum()
}

#[test]
fn angles_match_the_oracle() {
    let mut rng = Draws::of_row(1, 0);
    let mut worst = [0.0f64; 3];
    for i in 0..1_000_000 {
        let (x, y) = match i % 4 {
            0 => (rng.between(-1.0, 1.0), rng.between(-1.0, 1.0)),
            1 => (rng.signed(-126, 126), rng.signed(-126, 126)),
            2 => (rng.signed(-1, 1), if i % 8 == 2 { 0.0 } else { rng.signed(-30, 1) }),
            _ => (if i % 8 == 3 { 0.0 } else { rng.signed(-30, 1) }, rng.signed(-1, 1)),
        };
        let (wide_x, wide_y) = (f64::from(x), f64::from(y));
        let exact = oracle::turns(wide_y, wide_x);
        assert!(turns(y, x).abs() <= 0.5);
        worst[0] = larger(worst[0], (f64::from(turns(y, x)) - exact).abs() / ulp_of(exact));
        let exact = oracle::hypot(wide_x, wide_y);
        worst[1] = larger(worst[1], (f64::from(hypot(x, y)) - exact).abs() / ulp_of(exact));
        let angle = if i % 2 == 0 { x } else { 8.0 * rng.between(-1.0, 1.0) };
        let exact = oracle::sine(f64::from(angle));
        worst[2] = larger(worst[2], (f64::from(sine(angle)) - exact).abs() / ulp_of(exact));
    }
    report("turns ulp", worst[0], 6.0);
    report("hypot ulp", worst[1], 3.0);
    report("sine ulp", worst[2], 5.0);
    for quarter in -8..=8 {
        let exact = [0.0, 1.0, 0.0, -1.0][(quarter & 3) as usize];
        assert!((sine(0.25 * quarter as f32) - exact).abs() <= 6e-8);
    }
}

#[test]
fn map_coordinates_match_the_oracle() {
    let mut rng = Draws::of_row(2, 0);
    let mut worst = [0.0f64; 5];
    for i in 0..1_000_000 {
        let direction = match i % 4 {
            0 => rng.direction().as_vec3(),
            1 => Vec3::new(rng.signed(-126, 126), rng.signed(-126, 126), rng.signed(-126, 126)),
            2 => Vec3::new(rng.signed(-30, 0), rng.signed(0, 0), rng.signed(-30, 0)),
            _ => Vec3::new(-1.0, rng.between(-1.0, 1.0), rng.signed(-40, -10)),
        };
        let uv = uv_from_direction(direction);
        assert!(uv.min_element() >= 0.0 && uv.max_element() <= 1.0, "{direction} {uv}");
        let exact = oracle::uv_from_direction(direction.as_dvec3());
        worst[0] = larger(worst[0], largest((uv.as_dvec2() - exact).abs().to_array()));
        let unit = direction.as_dvec3().normalize();
        worst[1] = larger(worst[1], largest((direction_from_uv(uv).as_dvec3() - unit).abs().to_array()));

        let uv = if i % 4 == 0 {
            Vec2::new(rng.unit() as f32, rng.signed(-30, 0).abs())
        } else {
            Vec2::new(rng.unit() as f32, rng.unit() as f32)
        };
        let exact = oracle::direction_from_uv(uv.as_dvec2());
        let got = direction_from_uv(uv);
        worst[2] =
            larger(worst[2], largest((got.as_dvec3() - exact).abs().to_array()) / ulp_of(exact.abs().max_element()));
        worst[3] = larger(worst[3], (got.as_dvec3().length() - 1.0).abs());
        if unit.y.abs() < 0.9 && i % 4 == 0 {
            let naive = uv_from_direction_naive(direction);
            worst[4] =
                worst[4].max((naive.as_dvec2() - oracle::uv_from_direction(direction.as_dvec3())).abs().max_element());
        }
    }
    report("uv_from_direction abs", worst[0], 1.5e-7);
    report("round trip abs", worst[1], 1e-6);
    report("direction_from_uv ulp", worst[2], 8.0);
    report("|direction_from_uv| - 1", worst[3], 4e-7);
    report("naive uv on benign input abs", worst[4], 3e-7);
}

#[test]
fn poles_and_seam() {
    for (direction, uv) in [
        (Vec3::Y, Vec2::new(0.5, 0.0)),
        (Vec3::NEG_Y, Vec2::new(0.5, 1.0)),
        (Vec3::X, Vec2::new(0.5, 0.5)),
        (Vec3::Z, Vec2::new(0.75, 0.5)),
        (Vec3::NEG_Z, Vec2::new(0.25, 0.5)),
        (Vec3::NEG_X, Vec2::new(1.0, 0.5)),
        (Vec3::new(-1.0, 0.0, -0.0), Vec2::new(1.0, 0.5)),
        (Vec3::new(-1.0, 0.0, -1e-30), Vec2::new(0.0, 0.5)),
        (Vec3::new(-0.0, 1.0, 0.0), Vec2::new(0.5, 0.0)),
        (Vec3::ZERO, Vec2::new(0.5, 0.0)),
    ] {
        assert_eq!(uv_from_direction(direction), uv, "{direction}");
    }
}

#[test]
fn naive_coordinates_fail_where_the_docs_say_so() {
    for direction in [
        Vec3::new(1e-4, 1.0, 2e-4),
        Vec3::new(3e-4, -1.0, 1e-4),
        Vec3::new(-0.0, 1.0, 0.0),
        Vec3::new(3e-24, 4e-24, 0.0),
        Vec3::new(3e19, 4e19, 0.0),
    ] {
        let exact = oracle::uv_from_direction(direction.as_dvec3());
        let (stable, naive) = (uv_from_direction(direction), uv_from_direction_naive(direction));
        println!(
            "{direction}: exact {exact}, stable off {:e}, naive {naive} off {:e}",
            largest((stable.as_dvec2() - exact).abs().to_array()),
            (naive.as_dvec2() - exact).abs().max_element()
        );
        assert!(largest((stable.as_dvec2() - exact).abs().to_array()) <= 1.5e-7);
        let naive_error = (naive.as_dvec2() - exact).abs();
        assert!(naive.is_nan() || naive_error.max_element() > 5e-5);
    }
}

#[test]
fn texels_match_the_oracle() {
    let mut rng = Draws::of_row(3, 0);
    let (mut worst, mut backward, mut disagreements) = (0.0f64, 0.0f64, 0);
    for i in 0..1_000_000 {
        let size = match i % 3 {
            0 => UVec2::new(1 + (8.0 * (rng.unit() as f32)) as u32, 1 + (8.0 * (rng.unit() as f32)) as u32),
            1 => UVec2::new(2048, 1024),
            _ => UVec2::new(1 + (16383.0 * (rng.unit() as f32)) as u32, 1 + (16383.0 * (rng.unit() as f32)) as u32),
        };
        let uv = match i % 5 {
            0 => Vec2::new(4.0 * (rng.unit() as f32), rng.unit() as f32),
            1 => Vec2::new(
                ((rng.unit() as f32) * size.x as f32).floor() / size.x as f32,
                ((rng.unit() as f32) * size.y as f32).floor() / size.y as f32,
            ),
            2 => Vec2::new([0.0, 1.0, 0.5, 2.0][i % 4], [0.0, 1.0, 0.5, 1.0][i % 4]),
            3 => Vec2::new(rng.signed(-40, 0).abs(), rng.signed(-40, 0).abs()),
            _ => Vec2::new(rng.unit() as f32, rng.unit() as f32),
        };
        let got = texels(uv, size);
        assert!(got.lower.cmplt(size).all() && got.upper.cmplt(size).all());
        assert!(got.weight.min_element() >= 0.0 && got.weight.max_element() <= 1.0);
        let exact = oracle::texels(uv.as_dvec2(), size);
        if (got.lower, got.upper) != (exact.lower, exact.upper) {
            // The result must be right for an input that is two ulp off.
            let step = 2.0 * ulp_of(f64::from(uv.max_element()));
            let near = [-1.0, 0.0, 1.0].iter().any(|x| {
                [-1.0, 0.0, 1.0].iter().any(|y| {
                    let moved = oracle::texels(uv.as_dvec2() + step * DVec2::new(*x, *y), size);
                    (got.lower, got.upper) == (moved.lower, moved.upper)
                })
            });
            assert!(near, "{uv} {size} {got:?} {exact:?}");
            disagreements += 1;
            continue;
        }
        let unit = ulp_of(f64::from(uv.max_element())) * size.as_dvec2();
        let error = (got.weight.as_dvec2() - exact.weight).abs();
        worst = (error - 2.0 * unit).to_array().into_iter().fold(worst, larger);
        backward = ((error - 1e-7) / unit).to_array().into_iter().fold(backward, larger);
    }
    println!(
        "texels: {disagreements} discrete disagreements; weight beyond 2 backward {worst:e} abs, beyond 1e-7 {backward} backward"
    );
    assert!(worst <= 1e-7);
    // The hard case: on the seam both neighbours count.
    let size = UVec2::new(8, 4);
    for u in [0.0, 1.0, 0.999] {
        println!("u {u}: {:?}\n  naive {:?}", texels(Vec2::new(u, 0.5), size), texels_naive(Vec2::new(u, 0.5), size));
    }
    for _ in 0..100_000 {
        let uv = Vec2::new(0.125 + 0.75 * (rng.unit() as f32), 0.25 + 0.5 * (rng.unit() as f32));
        assert_eq!(texels(uv, size), texels_naive(uv, size));
    }
}

#[test]
fn softbox_matches_the_oracle() {
    let mut rng = Draws::of_row(4, 0);
    let (mut worst, mut naive_differs, mut lit) = (0.0f64, 0.0f32, 0);
    for i in 0..1_000_000 {
        let axis = rng.direction().as_vec3();
        // Twice, because a short cross product is not orthogonal to its last digits.
        let sideways = axis.cross(rng.direction().as_vec3()).normalize();
        let up = axis.cross(sideways).normalize();
        let half_size = Vec2::new(0.02 + 2.0 * (rng.unit() as f32), 0.02 + 2.0 * (rng.unit() as f32));
        let softness = (0.004 + (rng.unit() as f32) * 0.5).min(half_size.min_element());
        // Directions around the edges, where the coverage varies.
        let reach = (half_size + softness) * 1.2;
        let mut direction =
            (axis + reach.x * rng.between(-1.0, 1.0) * up.cross(axis) + reach.y * rng.between(-1.0, 1.0) * up)
                .normalize();
        if i % 4 == 0 {
            direction = rng.direction().as_vec3();
        }
        let got = softbox(direction, axis, up, half_size, softness);
        assert!((0.0..=1.0).contains(&got));
        let f = |d: DVec3, a: DVec3, u: DVec3| {
            DVec3::X * oracle::softbox(d, a, u, half_size.as_dvec2(), f64::from(softness))
        };
        let (d, a, u) = (direction.as_dvec3(), axis.as_dvec3(), up.as_dvec3());
        let exact = f(d, a, u).x;
        let allowed = backward(3.0, direction, |d| f(d, a, u))
            + backward(3.0, axis, |a| f(d, a, u))
            + backward(3.0, up, |u| f(d, a, u));
        let error = (f64::from(got) - exact).abs() - 6.0 * ulp_of(exact);
        if error > 0.0 {
            worst = larger(worst, error / allowed);
        }
        lit += usize::from(exact > 0.0);
        if direction.dot(axis) > 0.0 {
            naive_differs = naive_differs.max((softbox_naive(direction, axis, up, half_size, softness) - got).abs());
        }
    }
    println!("lit {lit}");
    report("softbox beyond 6 ulp, of 3 backward", worst, 1.0);
    assert_eq!(naive_differs, 0.0);
    let naive = softbox_naive(Vec3::NEG_Z, Vec3::Z, Vec3::Y, Vec2::ONE, 0.5);
    assert_eq!((softbox(Vec3::NEG_Z, Vec3::Z, Vec3::Y, Vec2::ONE, 0.5), naive), (0.0, 1.0));
}

#[test]
fn dome_and_studio_match_the_oracle() {
    let mut rng = Draws::of_row(5, 0);
    let (mut dome_worst, mut studio_worst) = (0.0f64, 0.0f64);
    let (mut low, mut high, mut mean, mut lit, mut upper) = (Vec3::MAX, Vec3::ZERO, DVec3::ZERO, 0, 0);
    let count = 2_000_000;
    for i in 0..count {
        let direction = rng.direction().as_vec3();
        let got = studio(direction);
        (low, high) = (low.min(got), high.max(got));
        mean += got.as_dvec3() / f64::from(count);
        lit += usize::from(got.max_element() > 0.5 && direction.y > 0.0);
        upper += usize::from(direction.y > 0.0);
        if i % 4 != 0 {
            continue;
        }
        let exact = oracle::studio(direction.as_dvec3());
        let error = largest((got.as_dvec3() - exact).abs().to_array()) - 8.0 * ulp_of(exact.max_element());
        if error > 0.0 {
            studio_worst = larger(studio_worst, error / backward(3.0, direction, oracle::studio));
        }
        let (ground, zenith) = (
            Vec3::new(rng.unit() as f32, rng.unit() as f32, rng.unit() as f32),
            Vec3::new(rng.unit() as f32, rng.unit() as f32, rng.unit() as f32),
        );
        let truth = |d: DVec3| oracle::dome(d, ground.as_dvec3(), zenith.as_dvec3());
        let exact = truth(direction.as_dvec3());
        let error = largest((dome(direction, ground, zenith).as_dvec3() - exact).abs().to_array())
            - backward(1.0, direction, truth);
        dome_worst = larger(dome_worst, error / ulp_of(exact.max_element()));
    }
    report("dome ulp beyond 1 backward", dome_worst, 4.0);
    report("studio beyond 8 ulp, of 3 backward", studio_worst, 1.0);
    println!("studio from {low} to {high}, mean {mean}, upper hemisphere lit {:.3}", lit as f64 / upper as f64);
    assert!(low.min_element() >= 0.0239 && high.max_element() <= 20.4);
}
