//! Checks the closed form of the fluence against Green's function, the local part against a grid that
//! shows the rest, and the extrapolation length against known values.

use super::*;
use lapidary_assay::extremum::larger;
use std::f64::consts::PI;

const GAMMAS: [f64; 7] = [0.0, 0.01, 0.1, 0.3, 0.577_350_269, 0.7, 0.95];

#[test]
fn the_closed_form_of_the_fluence_is_green_s_function() {
    for gamma in GAMMAS {
        for cosine in [1e-3, 0.2, 0.6, 1.0] {
            for depth in [0.0, 1e-3, 0.3, 2.0, 20.0] {
                for milne in [0.5, 0.7104, 2.6, 20.0] {
                    let green = oracle::fluence(depth, cosine, gamma, milne);
                    let closed = oracle::emission(depth, cosine, gamma, milne);
                    assert!((green - closed).abs() < 1e-8 * closed, "{depth} {cosine} {gamma}: {green} {closed}");
                }
            }
        }
    }
}

#[test]
fn the_fluence_solves_its_equation() {
    let step = 1e-3;
    for gamma in GAMMAS {
        for cosine in [0.2, 0.6, 1.0] {
            let milne = 1.7;
            let f = |depth: f64| oracle::emission(depth, cosine, gamma, milne);
            let slope = (4.0 * f(step) - 3.0 * f(0.0) - f(2.0 * step)) / (2.0 * step);
            assert!((f(0.0) - milne * slope).abs() < 1e-3, "Robin's condition: {gamma} {cosine}");
            let depth: f64 = 0.8;
            let bend = (f(depth + step) + f(depth - step) - 2.0 * f(depth)) / (step * step);
            let source = 3.0 * (1.0 - gamma * gamma) * (-depth / cosine).exp();
            assert!((bend - 3.0 * gamma * gamma * f(depth) + source).abs() < 1e-4, "{gamma} {cosine}");
        }
    }
}

/// What the eye sees of a fluence on a grid: straight lines from `surface` to a node and to the next, and
/// fine segments of the fluence from there on.
fn shown(eye: f32, (depth, gap): (f32, f32), surface: f32, fluence_at: impl Fn(f32) -> f32) -> f64 {
    let (first, second) = (fluence_at(depth), fluence_at(depth + gap));
    let mut shown = f64::from(segment(surface, first, depth / eye));
    shown += f64::from((-depth / eye).exp() * segment(first, second, gap / eye));
    let step = 0.01 * eye;
    for index in 0..2000u16 {
        let start = depth + gap + step * f32::from(index);
        shown += f64::from((-start / eye).exp() * segment(fluence_at(start), fluence_at(start + step), step / eye));
    }
    shown
}

#[test]
fn grid_and_local_part_make_the_exact_law() {
    // Any values will do for the law and the angles' factor.
    let (law, angle) = (0.3f32, 0.9);
    for gamma in [0.0f32, 0.1, 0.577_35, 0.9] {
        for (eye, light) in [(0.2f32, 1.0f32), (1.0, 0.2), (0.7, 0.6)] {
            for (depth, gap) in [(0.1f32, 0.5f32), (0.5, 1.0), (2.0, 0.25), (4.0, 8.0)] {
                for milne in [DIFFUSION_MILNE, 2.6] {
                    let fluence_at = |depth: f32| fluence(depth, light, gamma, milne);
                    // Robin's profile, by its definition at the surface.
                    let surface = fluence_at(depth) * profile(0.0, depth, milne);
                    let shown = f64::from(angle) * shown(eye, (depth, gap), surface, fluence_at);
                    let single = f64::from(light / (eye + light));
                    let part = local(eye, light, law, gamma, milne, depth, gap, angle);
                    let albedo = f64::from(1.0 - gamma * gamma);
                    let whole = f64::from(part) + albedo / (4.0 * PI) * (single + shown);
                    assert!((whole - f64::from(law)).abs() < 1e-5, "{gamma} {eye} {light} {depth} {gap}: {whole}");
                }
            }
        }
    }
}

#[test]
fn grid_and_local_part_make_the_exact_law_under_light_from_all_around() {
    let (law, angle) = (0.6f32, 0.9);
    for gamma in [0.0f32, 0.1, 0.5, 0.9] {
        for eye in [0.2f32, 0.7, 1.0] {
            for (depth, gap) in [(0.1f32, 0.5f32), (0.5, 1.0), (2.0, 0.25), (4.0, 8.0)] {
                for milne in [DIFFUSION_MILNE, 2.6] {
                    let kappa = 3f32.sqrt() * gamma;
                    let fluence_at = |depth: f32| (-kappa * depth).exp() / (1.0 + kappa * milne);
                    let share = profile(0.0, depth, milne);
                    let surface = share * fluence_at(depth) + 1.0 - share;
                    let shown = f64::from(angle) * shown(eye, (depth, gap), surface, fluence_at);
                    let part = local_around(eye, law, gamma, milne, depth, gap, angle);
                    let whole = f64::from(part) + f64::from(1.0 - gamma * gamma) * shown;
                    assert!((whole - f64::from(law)).abs() < 1e-5, "{gamma} {eye} {depth} {gap}: {whole}");
                }
            }
        }
    }
}

#[test]
fn known_extrapolation_lengths() {
    // By the integral equation of the fluence, and by the H function.
    for (index, length) in [(1.0, 0.7104), (1.3, 1.4746), (1.5, 2.2971), (2.0, 5.2524)] {
        let exact = oracle::milne(index);
        assert!((exact - length).abs() < 6e-5, "{index}: {exact}");
    }
    let mut worst: f64 = 0.0;
    for step in 0..=1500u16 {
        let index = 1.0 + f32::from(step) / 1000.0;
        worst = larger(worst, (f64::from(milne(index)) / oracle::milne(index.into()) - 1.0).abs());
    }
    assert!((5e-6..1.45e-5).contains(&worst), "{worst:e}");
}

#[test]
fn weights_of_corners_add_up() {
    for fraction in [Vec3::ZERO, Vec3::ONE, Vec3::new(0.25, 0.5, 0.875)] {
        let sum: f32 = (0..8).map(|corner| weight(fraction, corner, 1.0)).sum();
        assert!((sum - 1.0 - 8.0 * DIFFUSION_LEAST_WEIGHT).abs() < 1e-6, "{fraction}: {sum}");
    }
}
