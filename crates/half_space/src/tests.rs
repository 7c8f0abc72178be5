//! Checks the oracle against the integral equation and Chandrasekhar's values, the energy of the law,
//! and the law behind a boundary against all reflections inside.

use super::*;
use lapidary_assay::extremum::larger;
use std::f64::consts::PI;

/// Nodes and weights of Gauss's rule on [low, high], mapped by the square of a variable, so that they lie
/// densely at `low`.
fn nodes(low: f64, high: f64, panels: u32) -> Vec<(f64, f64)> {
    let half = 0.5 / f64::from(panels);
    let panel = |index: u32| {
        oracle::GAUSS.map(|(node, weight)| {
            let u = half * (2.0 * f64::from(index) + 1.0 + node);
            (low + (high - low) * u * u, 2.0 * (high - low) * u * half * weight)
        })
    };
    (0..panels).flat_map(panel).collect()
}

#[test]
fn the_oracle_solves_the_integral_equation() {
    let grid = nodes(0.0, 1.0, 12);
    for gamma in [0.0, 0.01, 0.1, 0.3, 0.7, 0.9] {
        let albedo = (1.0 - gamma) * (1.0 + gamma);
        for cosine in [1e-3, 0.1, 0.5, 1.0] {
            let scattered: f64 =
                grid.iter().map(|(m, weight)| weight * m * oracle::h(*m, gamma) / (cosine + m)).sum::<f64>();
            let inverse = gamma + 0.5 * albedo * scattered;
            let error = oracle::h(cosine, gamma) * inverse - 1.0;
            assert!(error.abs() < 1e-6, "gamma {gamma}, cosine {cosine}: {error:e}");
        }
    }
}

#[test]
fn known_reflectances() {
    for (albedo, straight, diffuse) in
        [(0.5f32, 0.115_226, 0.146_544), (0.9, 0.414_947, 0.478_024), (0.99, 0.752_721, 0.794_564)]
    {
        let exact = (1.0 - f64::from(albedo)).sqrt();
        assert!((oracle::directional(1.0, exact) - straight).abs() < 1e-6, "{albedo}");
        assert!((oracle::reflectance(exact) - diffuse).abs() < 1e-6, "{albedo}");
        let gamma = gamma(albedo, 0.0);
        assert!((f64::from(directional(1.0, gamma)) / straight - 1.0).abs() < 2e-4, "{albedo}");
        assert!((f64::from(reflectance(gamma)) / diffuse - 1.0).abs() < 2e-5, "{albedo}");
    }
}

#[test]
fn h_is_as_accurate_as_documented() {
    let (mut ours, mut hapke): (f64, f64) = (0.0, 0.0);
    for i in 0..=100u8 {
        for j in 0..=100u8 {
            let (cosine, gamma) = (f32::from(i) / 100.0, (f32::from(j) / 100.0).powi(2));
            let exact = oracle::h(cosine.into(), gamma.into());
            ours = larger(ours, (f64::from(h(cosine, gamma)) / exact - 1.0).abs());
            hapke = larger(hapke, (f64::from(h_paper(cosine, gamma)) / exact - 1.0).abs());
        }
    }
    assert!((1e-5..1.2e-4).contains(&ours), "{ours:e}");
    assert!((0.035..0.042).contains(&hapke), "{hapke:e}");
}

#[test]
fn the_factor_conserves_energy() {
    let grid = nodes(0.0, 1.0, 12);
    for gamma in [0.0f32, 0.03, 0.1, 0.3, 0.7, 0.95, 1.0] {
        let mut total = 0.0;
        for (eye, eye_weight) in &grid {
            for (light, light_weight) in &grid {
                let weight = 4.0 * eye_weight * eye * light_weight * light;
                total += weight * f64::from(factor(*eye as f32, *light as f32, gamma));
            }
        }
        assert!((total - 1.0).abs() < 3e-4, "gamma {gamma}: {total}");
        let left: f64 = grid.iter().map(|(c, weight)| 2.0 * weight * c * f64::from(exit(*c as f32, gamma))).sum();
        assert!((left - 1.0).abs() < 3e-4, "gamma {gamma}: {left}");
    }
}

/// Fresnel's reflectance from inside, for a relative index n.
fn reflected(cosine: f64, n: f64) -> f64 {
    let radicand = 1.0 - n * n * (1.0 - cosine * cosine);
    if radicand <= 0.0 {
        return 1.0;
    }
    let outside = radicand.sqrt();
    let (s, p) = ((n * cosine - outside) / (n * cosine + outside), (cosine - n * outside) / (cosine + n * outside));
    0.5 * (s * s + p * p)
}

/// Checks the law inside a boundary against the series of all reflections, with the boundary's
/// reflectance at each angle; and the flux that leaves. Returns the largest relative error of both.
fn errors_behind(n: f32, gamma: f32) -> (f64, f64) {
    let index = f64::from(n);
    let critical = (1.0 - 1.0 / (index * index)).sqrt();
    let below = nodes(0.0, critical, 6);
    let grid: Vec<(f64, f64)> = below.iter().copied().chain(nodes(critical, 1.0, 6)).collect();
    let h: Vec<f64> = grid.iter().map(|(c, _)| oracle::h(*c, gamma.into())).collect();
    let albedo = (1.0 - f64::from(gamma)) * (1.0 + f64::from(gamma));
    let law = |i: usize, j: usize| albedo * h[i] * h[j] / (4.0 * PI * (grid[i].0 + grid[j].0));
    let inner: Vec<f64> = grid.iter().map(|(c, _)| reflected(*c, index)).collect();
    let (edge, mut worst, mut lost) = (edge(n), 0.0, 0.0);
    let gain = gain(gamma, edge);
    for light in (below.len()..grid.len()).step_by(4) {
        let mut step: Vec<f64> = (0..grid.len()).map(|i| law(i, light)).collect();
        let mut sum = step.clone();
        for _ in 0..400 {
            let back: Vec<f64> = grid
                .iter()
                .zip(&inner)
                .zip(&step)
                .map(|(((c, weight), r), radiance)| 2.0 * PI * weight * c * r * radiance)
                .collect();
            step = (0..grid.len()).map(|i| back.iter().enumerate().map(|(j, flux)| law(i, j) * flux).sum()).collect();
            sum.iter_mut().zip(&step).for_each(|(sum, step)| *sum += step);
        }
        let (mut truth, mut approximation) = (0.0, 0.0);
        for eye in below.len()..grid.len() {
            let value = f64::from(inside(grid[eye].0 as f32, grid[light].0 as f32, gamma, edge, gain));
            worst = larger(worst, (value / sum[eye] - 1.0).abs());
            let passed = 2.0 * PI * grid[eye].1 * grid[eye].0 * (1.0 - inner[eye]);
            truth += passed * sum[eye];
            approximation += passed * value;
        }
        lost = larger(lost, (approximation / truth - 1.0).abs());
    }
    (worst, lost)
}

#[test]
fn behind_a_boundary_the_law_is_that_of_all_reflections() {
    for n in [1.02, 1.1, 1.33, 1.4, 1.5, 1.8] {
        for gamma in [0.0, 0.03, 0.1, 0.3, 0.7] {
            let (worst, lost) = errors_behind(n, gamma);
            assert!(worst < 5e-3, "index {n}, gamma {gamma}: BRDF off by {worst:e}");
            assert!(lost < 3e-3, "index {n}, gamma {gamma}: flux off by {lost:e}");
        }
    }
}

#[test]
fn a_furnace_loses_nothing() {
    // Uniform light outside: what enters matter that absorbs nothing leaves it again.
    for n in [1.0f32, 1.1, 1.4, 1.8] {
        let (edge, index) = (edge(n), f64::from(n));
        let gain = gain(0.0, edge);
        let grid = nodes(0.0, 1.0, 12);
        let passes = |outside: f64| 1.0 - if n > 1.0 { reflected(oracle::refract(outside, index), index) } else { 0.0 };
        let (mut entering, mut leaving) = (0.0, 0.0);
        for (light, light_weight) in &grid {
            let flux = 2.0 * light_weight * light * passes(*light);
            entering += flux;
            for (eye, eye_weight) in &grid {
                let value = dielectric(*eye as f32, *light as f32, 0.0, n, edge, gain);
                leaving += flux * 2.0 * PI * eye_weight * eye * passes(*eye) * f64::from(value);
            }
        }
        assert!((leaving / entering - 1.0).abs() < 3e-3, "index {n}: {leaving} of {entering}");
        let share = 1.0 - f64::from(edge).powi(2);
        assert!((entering / (index * index * share) - 1.0).abs() < 2e-3, "index {n}: {entering}");
    }
}

#[test]
fn base_colours_come_back() {
    for n in [1.0, 1.33, 1.4, 2.4] {
        let edge = edge(n);
        for step in 0..=20u8 {
            let share = f32::from(step) / 20.0;
            let back = entered(gamma_of_entered(share, edge), edge);
            assert!((back - share).abs() < 1e-5, "index {n}: {share} becomes {back}");
        }
    }
}
