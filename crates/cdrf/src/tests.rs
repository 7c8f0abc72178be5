//! The oracle against other formulas, the claims of docs/cdrf.md, and its table of rungs.

use super::*;
use std::f64::consts::{FRAC_1_PI, PI};

/// Cosines of `count` + 1 angles from 0 to 180°.
fn cosines(count: u32) -> impl Iterator<Item = f64> {
    (0..=count).map(move |index| (PI * f64::from(index) / f64::from(count)).cos())
}

/// Largest of `f` over angles.
fn most(f: impl Fn(f64) -> f64) -> f64 {
    cosines(500).map(f).fold(0.0, f64::max)
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
    // Where the light is: nothing comes round.
    assert!((oracle::accurate(1.0, 0.5) - oracle::single_lobe(1.0, 0.5)).abs() < 1e-10);
}
