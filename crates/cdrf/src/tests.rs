//! Tests of the oracle against other formulas, and of the claims of docs/cdrf.md.

use super::*;
use lapidary_assay::extremum::larger;
use std::f64::consts::{FRAC_1_PI, PI};

/// Returns the cosines of `count` + 1 angles from 0 to 180°.
fn cosines(count: u32) -> impl Iterator<Item = f64> {
    (0..=count).map(move |index| (PI * f64::from(index) / f64::from(count)).cos())
}

/// Returns the largest value of `f` over the angles.
fn most(f: impl Fn(f64) -> f64) -> f64 {
    cosines(500).map(f).fold(0.0, larger)
}

const SIGMAS: [f64; 12] = [0.03, 0.1, 0.2, 0.25, 0.3, 0.35, 0.5, 0.999, 1.0, 1.5, 2.0, 3.0];

#[test]
fn oracle_is_the_fourier_series() {
    for sigma in SIGMAS {
        let terms = (5.0 / sigma).ceil() as u32;
        let error = most(|c| (oracle::accurate(c, sigma) - oracle::series(c, sigma, terms)).abs());
        assert!(error < 2e-10, "sigma {sigma}: {error:e}");
    }
}

#[test]
fn oracle_for_the_smallest_sigmas_scales() {
    // Next to the terminator sigma is the only length: W(u sigma) / sigma tends to φ(u) + u Φ(u).
    for u in [-3.0f64, -1.0, 0.0, 0.5, 2.0] {
        let limit = (-0.5 * u * u).exp() / (2.0 * PI).sqrt() + u * oracle::normal_share(u);
        for sigma in [1e-4, 1e-6, 1e-12, 1e-30] {
            let scaled = oracle::accurate(u * sigma, sigma) / sigma;
            assert!((scaled - limit).abs() < 1e-9 + sigma * sigma, "{u} {sigma}: {scaled} {limit}");
        }
    }
    assert_eq!(oracle::accurate(0.7, 0.0), 0.7);
    assert!((oracle::accurate(0.7, 1e-20) - 0.7).abs() < 1e-10);
    assert!((oracle::accurate(0.7, 1e6) - FRAC_1_PI).abs() < 1e-10);
}

#[test]
fn oracle_of_the_normal_distribution() {
    for index in -80..=80 {
        let u = 0.1 * f64::from(index);
        let error = (oracle::normal_share(u) - oracle::normal_share_by_quadrature(u)).abs();
        assert!(error < 1e-13, "{u}: {error:e}");
    }
}

#[test]
fn forms_wrapped_and_single_lobed_agree_where_they_should() {
    let differ = |sigma: f64| most(|c| (oracle::accurate(c, sigma) - oracle::single_lobe(c, sigma)).abs());
    assert!(differ(0.3) < 1e-8, "{:e}", differ(0.3));
    assert!((5e-5..2e-4).contains(&differ(0.5)), "{:e}", differ(0.5));
    assert!((0.02..0.025).contains(&differ(1.0)), "{:e}", differ(1.0));
    // Facing the light, no light comes around.
    assert!((oracle::accurate(1.0, 0.5) - oracle::single_lobe(1.0, 0.5)).abs() < 1e-10);
}

/// Returns the closed form at one edge in f64, with 1 to 3 corrections and the angle off by `slip`.
fn edge_in_f64(c: f64, sigma: f64, corrections: u32, slip: f64) -> f64 {
    let (x, v) = (c.asin() + slip, sigma * sigma);
    let (u, q) = (x / sigma, x * x);
    let second = (q + 2.0 * v) / 6.0;
    let fourth = (q * q + 9.0 * q * v + 8.0 * v * v) / 120.0;
    let sixth = (q * q * q + 20.0 * q * q * v + 87.0 * q * v * v + 48.0 * v * v * v) / 5040.0;
    let carried = match corrections {
        1 => 1.0 - second,
        2 => 1.0 - second + fourth,
        _ => 1.0 - second + fourth - sixth,
    };
    let density = (-0.5 * u * u).exp() / (2.0 * PI).sqrt();
    (-0.5 * v).exp() * c * oracle::normal_share(u) + sigma * density * carried
}

#[test]
fn corrections_are_as_good_as_the_page_says() {
    let error =
        |sigma, corrections| most(|c| (edge_in_f64(c, sigma, corrections, 0.0) - oracle::accurate(c, sigma)).abs());
    for (sigma, corrections, stated) in
        [(0.2, 2, 1.2e-7), (0.25, 2, 5.6e-7), (0.3, 2, 2.0e-6), (0.3, 3, 3.6e-8), (0.35, 1, 1.9e-4), (0.35, 3, 2.6e-7)]
    {
        let found = error(sigma, corrections);
        assert!((found - stated).abs() < 0.05 * stated, "{sigma} with {corrections}: {found:e}");
    }
}

#[test]
fn series_needs_the_terms_that_the_page_says() {
    for (sigma, terms) in [(0.1, 18), (0.2, 9), (0.3, 6), (0.5, 4), (1.0, 2), (2.0, 1)] {
        let error = |terms| most(|c| (oracle::series(c, sigma, terms) - oracle::accurate(c, sigma)).abs());
        println!("{sigma} {terms}: {:e}, with one fewer {:e}", error(terms), error(terms - 1));
        assert!(error(terms) < 1e-6);
    }
    let error = |sigma, terms| most(|c| (oracle::series(c, sigma, terms) - oracle::accurate(c, sigma)).abs());
    assert!(error(0.3, 7) < 2.6e-8 && error(0.35, 4) < 1.5e-5);
    assert!((0.034..0.036).contains(&error(1e-3, 4)));
}

/// WGSL's asin is off by 6.8e-5, or by 4096 ulp of an arctangent, which is 4.9e-4.
#[test]
fn an_error_of_the_angle_enters_by_an_eighth_of_the_variance() {
    let moved =
        |sigma: f64, slip: f64| most(|c| (edge_in_f64(c, sigma, 3, slip) - edge_in_f64(c, sigma, 3, 0.0)).abs());
    assert!((6e-7..8e-7).contains(&moved(0.3, 6.8e-5)), "{:e}", moved(0.3, 6.8e-5));
    assert!((4e-6..6e-6).contains(&moved(0.3, 4.9e-4)), "{:e}", moved(0.3, 4.9e-4));
    // If sigma is smaller than the slip, a lit point counts as dark, and the slip enters in full.
    // At a sharp terminator the error that WGSL allows is the absolute one.
    let sharp = |c: f64| edge_in_f64(c, 1e-6, 3, -6.8e-5) - edge_in_f64(c, 1e-6, 3, 0.0);
    assert!((-6.8e-5..-6.0e-5).contains(&sharp(6.4e-5)), "{:e}", sharp(6.4e-5));
    // If the cosine, too, is taken from the angle, the error enters with the full slope of the
    // function.
    let turned = |c: f64| {
        let slipped = (c.asin() + 6.8e-5).sin();
        (oracle::accurate(slipped, 0.1) - oracle::accurate(c, 0.1)).abs()
    };
    assert!((6e-5..6.8e-5).contains(&most(turned)), "{:e}", most(turned));
}

/// Compares both forms in f64: the effect of the switch itself on value and slope, without
/// rounding.
#[test]
fn forms_meet_without_a_seam() {
    let switch = f64::from(CDRF_SWITCH);
    let step = 1e-4;
    let difference = |c: f64, sigma: f64| {
        let v = sigma * sigma;
        // The shader's polynomial for e^(-v/2).
        let slip = 1.0 - v * (0.5 - v * (0.125 - v * 0.02064)) - (-0.5 * v).exp();
        let edge = edge_in_f64(c, sigma, 3, 0.0) + slip * c * oracle::normal_share(c.asin() / sigma);
        edge - oracle::series(c, sigma, 7)
    };
    assert!(most(|c| difference(c, switch).abs()) < 7.1e-8, "{:e}", most(|c| difference(c, switch).abs()));
    let in_sigma = most(|c| ((difference(c, switch + step) - difference(c, switch - step)) / (2.0 * step)).abs());
    assert!(in_sigma < 4e-6, "{in_sigma:e}");
    let in_angle = most(|c| {
        let turned = |by: f64| difference((c.acos() + by).clamp(0.0, PI).cos(), switch);
        ((turned(step) - turned(-step)) / (2.0 * step)).abs()
    });
    assert!(in_angle < 1e-6, "{in_angle:e}");
}

/// Returns the light received by a sphere that is evenly covered with normals, as a share of the
/// light by Lambert's law.
fn energy(reflectance: impl Fn(f64) -> f64) -> f64 {
    let count = 20_000;
    let step = PI / f64::from(count);
    2.0 * (0..count)
        .map(|index| {
            let angle = (f64::from(index) + 0.5) * step;
            reflectance(angle.cos()) * angle.sin() * step
        })
        .sum::<f64>()
}

#[test]
fn energy_is_kept_on_the_circle_or_on_the_sphere() {
    for (sigma, ratio) in [(0.3, 1.042), (1.0, 1.235)] {
        let found = energy(|c| oracle::accurate(c, sigma));
        assert!((found - ratio).abs() < 0.0005, "sigma {sigma}: {found}");
        // Half the circle by the trapezoidal rule.
        let ends = 0.5 * (oracle::accurate(1.0, sigma) + oracle::accurate(-1.0, sigma));
        let mean = (cosines(3600).map(|c| oracle::accurate(c, sigma)).sum::<f64>() - ends) / 3600.0;
        assert!((mean - FRAC_1_PI).abs() < 1e-6, "sigma {sigma}: mean over the circle {mean}");
    }
    for sigma in [0.01, 0.05, 0.1, 0.3, 1.0, 3.0] {
        let found = energy(|c| oracle::spherical(c, sigma));
        assert!((found - 1.0).abs() < 1e-6, "sigma {sigma}: {found}");
        let found = energy(|c| f64::from(spherical(c as f32, sigma as f32)));
        assert!((found - 1.0).abs() < 2e-6, "sigma {sigma}: the mirror keeps {found}");
        let found = energy(|c| f64::from(wrap(c as f32, sigma as f32)));
        assert!((found - 1.0).abs() < 1e-5, "sigma {sigma}: wrap keeps {found}");
    }
}

#[test]
fn oracle_of_the_sphere_is_one_function() {
    // The sigmas at which its methods of calculation meet.
    for (sigma, bound) in [(0.1, 1e-9), (1e-3, 2e-9)] {
        let below = sigma * (1.0 - 1e-12);
        let difference = most(|c| (oracle::spherical(c, sigma) - oracle::spherical(c, below)).abs());
        assert!(difference < bound, "{sigma}: {difference:e}");
    }
    // The first coefficients, known in closed form.
    let wide = 0.9f64;
    let legendre = |c: f64| {
        let c2 = c * c;
        [
            1.0,
            c,
            1.5 * c2 - 0.5,
            0.0,
            (35.0 * c2 * c2 - 30.0 * c2 + 3.0) / 8.0,
            0.0,
            (231.0 * c2 * c2 * c2 - 315.0 * c2 * c2 + 105.0 * c2 - 5.0) / 16.0,
        ]
    };
    let a = [0.25, 0.5, 5.0 / 16.0, 0.0, -3.0 / 32.0, 0.0, 13.0 / 256.0];
    let difference = most(|c| {
        let p = legendre(c);
        let sum: f64 = (0..7).map(|l| a[l] * (-0.5 * wide * wide * (l * (l + 1)) as f64).exp() * p[l]).sum();
        (sum - oracle::spherical(c, wide)).abs()
    });
    assert!(difference < 1e-9, "{difference:e}");
    // The limit is the mean.
    assert!((oracle::spherical(0.3, 20.0) - 0.25).abs() < 1e-12);
}

#[test]
fn no_bad_number_comes_out() {
    for sigma0 in [f32::NAN, -1.0, 0.0, 1.0, f32::INFINITY, f32::NEG_INFINITY] {
        for curvature in [f32::NAN, -3.0, 0.0, 2.0, f32::INFINITY, f32::NEG_INFINITY, 1e30] {
            for cosine in [-1.0, 0.0, 0.5, 1.0] {
                let value = rgb(cosine, Vec3::splat(sigma0), curvature);
                assert!((0.0..=1.0).contains(&value.x), "{cosine} {sigma0} {curvature}: {value}");
            }
        }
    }
}

#[test]
fn pieces_of_the_spherical_form_are_as_good_as_the_page_says() {
    let sigma = f64::from(CDRF_SPHERICAL_SWITCH);
    let local = |c: f64| {
        let (x, v) = (c.asin(), sigma * sigma);
        let u = x / sigma;
        let carried = 1.0 - x * x / 6.0 - 7.0 * v / 12.0;
        (-v).exp() * c * oracle::normal_share(u) + sigma * (-0.5 * u * u).exp() / (2.0 * PI).sqrt() * carried
    };
    let error = most(|c| (local(c) - oracle::spherical(c, sigma)).abs());
    assert!((1.1e-6..1.2e-6).contains(&error), "{error:e}");
    // The truncation error is the next even degree, whose coefficient falls as l^(-3/2).
    let left_out = |degree: u32| most(|c| (truncated(c, sigma, degree) - oracle::spherical(c, sigma)).abs());
    assert!((1.3e-6..1.5e-6).contains(&left_out(36)), "{:e}", left_out(36));
    assert!(left_out(44) < 4e-8, "{:e}", left_out(44));
}

/// Returns the series up to degree `last`, by Bonnet's recurrence in f64.
fn truncated(c: f64, sigma: f64, last: u32) -> f64 {
    let damped = |l: u32| (-0.5 * f64::from(l * (l + 1)) * sigma * sigma).exp();
    let (mut previous, mut current, mut moment) = (1.0, c, 0.125);
    let mut sum = 0.25 + 0.5 * damped(1) * c;
    for l in 2..=last {
        let degree = f64::from(l);
        (previous, current) = (current, ((2.0 * degree - 1.0) * c * current - (degree - 1.0) * previous) / degree);
        if l % 2 == 0 {
            sum += (degree + 0.5) * moment * damped(l) * current;
            moment *= (1.0 - degree) / (degree + 4.0);
        }
    }
    sum
}
