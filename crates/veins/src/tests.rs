//! Tests of the claims of the documentation page: no step in value, slope or curvature at the
//! border of a cell, no preferred gradient, bounds that hold.

use super::*;
use glam::DVec3;
use lapidary_assay::extremum::larger;

#[test]
fn value_slope_and_curvature_go_on_across_borders() {
    for k in 0..200u32 {
        let along = f64::from(k) * 0.137;
        let value = |x: f64| oracle::noise(DVec3::new(x, 0.3 + along, 7.7 - along), 5);
        let step = 1e-4;
        // One-sided differences of second order, on either side of x = 3.
        let slope = |side: f64| {
            (-3.0 * value(3.0 + side * 1e-12) + 4.0 * value(3.0 + side * step) - value(3.0 + 2.0 * side * step))
                / (2.0 * side * step)
        };
        let bend = |side: f64| {
            (value(3.0 + side * 1e-12) - 2.0 * value(3.0 + side * step) + value(3.0 + 2.0 * side * step))
                / (step * step)
        };
        assert!((value(3.0 - 1e-12) - value(3.0 + 1e-12)).abs() < 1e-10);
        assert!((slope(1.0) - slope(-1.0)).abs() < 1e-5, "{along}: {} {}", slope(1.0), slope(-1.0));
        assert!((bend(1.0) - bend(-1.0)).abs() < 0.05, "{along}: {} {}", bend(1.0), bend(-1.0));
    }
}

/// Checks that the twelve gradients are equally likely, also in pairs of neighbours.
#[test]
fn gradients_are_evenly_spread() {
    let mut counts = std::collections::HashMap::new();
    let side = 24;
    for k in 0..side * side * side {
        let corner = IVec3::new(k % side, k / side % side, k / side / side) - side / 2;
        let [here, beside] = [corner, corner + IVec3::X].map(|corner| gradient(hash(corner, 3)).as_ivec3());
        *counts.entry((here, beside)).or_insert(0) += 1;
    }
    assert_eq!(counts.len(), 144);
    let expected = f64::from(side.pow(3)) / 144.0;
    let chi_squared: f64 = counts.values().map(|count| (f64::from(*count) - expected).powi(2) / expected).sum();
    // 143 ± sqrt(286).
    assert!((chi_squared - 143.0).abs() < 4.0 * 286f64.sqrt(), "{chi_squared}");
}

#[test]
fn noise_keeps_its_bounds_and_has_no_mean() {
    let (mut sum, mut largest) = (0.0, 0.0f64);
    let count = 200_000;
    for k in 0..count {
        let place = Vec3::new(0.377 * k as f32, 0.211 * (k % 977) as f32, 0.193 * (k % 131) as f32);
        let value = f64::from(noise(place, 1));
        sum += value;
        largest = larger(largest, value.abs());
    }
    assert!(largest < 1.1 && largest > 0.8, "{largest}");
    assert!((sum / f64::from(count)).abs() < 0.01, "{}", sum / f64::from(count));
}

#[test]
fn density_keeps_its_bounds_and_reaches_them() {
    let pattern = VeinsPattern { frequency: 0.3, width: 0.1, least: 0.25, greatest: 2.0, octaves: 4, seed: 9 };
    let densities = (0..20_000).map(|k| density(Vec3::new(0.37 * k as f32, 0.21 * (k % 97) as f32, 1.5), pattern));
    let (least, greatest) =
        densities.fold((f32::MAX, 0.0f32), |(least, greatest), value| (least.min(value), greatest.max(value)));
    assert!((0.25..0.35).contains(&least) && (1.99..=2.0).contains(&greatest), "{least} {greatest}");
}
