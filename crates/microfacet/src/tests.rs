//! Joint properties of the distribution and the masking: areas, energy, reciprocity; and the tables
//! of docs/microfacet.md.

use super::*;
use glam::DVec3;
use lapidary_assay::extremum::larger;
use std::f64::consts::{FRAC_PI_2, PI};

const ALPHAS: [f64; 6] = [0.001, 0.01, 0.1, 0.25, 0.5, 1.0];

/// A distribution as a function of normal, half vector and alpha.
type Distribution = fn(DVec3, DVec3, f64) -> f64;
/// A visibility as a function of both cosines and alpha.
type Visibility = fn(f64, f64, f64) -> f64;

const ORACLE: (Distribution, Visibility) = (oracle::distribution, oracle::visibility);
const MIRROR: (Distribution, Visibility) = (
    |normal, half, alpha| distribution(normal.as_vec3(), half.as_vec3(), alpha as f32).into(),
    |light, eye, alpha| visibility(light as f32, eye as f32, alpha as f32).into(),
);

/// Returns a direction towards an eye at this cosine to +z.
fn eye(cosine: f64) -> DVec3 {
    DVec3::new(((1.0 - cosine) * (1.0 + cosine)).sqrt(), 0.0, cosine)
}

/// Integrates over all facet normals above the surface by midpoints: `count` azimuths of half a
/// turn, for functions even in y, and as many angles to the normal. The share u = tan² /
/// (α² + tan²) of facets below an angle is taken as w² (3 - 2 w), with w uniform in [0, 1], so that
/// the angles lie close together near `alpha`, and ever closer towards either end. The midpoints of
/// du / dw itself are off by step² / 2.
fn over_facets(alpha: f64, count: u32, integrand: impl Fn(DVec3) -> f64) -> f64 {
    let step = 1.0 / f64::from(count);
    let midpoints = || (0..count).map(|index| (f64::from(index) + 0.5) * step);
    let ring = |w: f64| {
        let (below, above) = (w * w * (3.0 - 2.0 * w), (1.0 - w) * (1.0 - w) * (1.0 + 2.0 * w));
        let tangent = alpha * (below / above).sqrt();
        let angle = tangent.atan();
        // d(angle) / du, then du / dw.
        let stretch = (alpha * angle.cos() / above).powi(2) / (2.0 * tangent) * 6.0 * w * (1.0 - w);
        let toward = |azimuth: f64| DVec3::new(angle.sin() * azimuth.cos(), angle.sin() * azimuth.sin(), angle.cos());
        stretch * angle.sin() * midpoints().map(|turn| integrand(toward(PI * turn))).sum::<f64>()
    };
    2.0 * PI * step * step * midpoints().map(ring).sum::<f64>()
}

/// Returns the share of light from the eye's direction that perfectly reflecting facets send
/// anywhere above the surface: the integral of D V n.l over directions of light. Each direction is
/// reflected by its facet and has the solid angle 4 (v . h) times the facet's.
fn albedo((distribution, visibility): (Distribution, Visibility), cosine: f64, alpha: f64, count: u32) -> f64 {
    let eye = eye(cosine);
    over_facets(alpha, count, |facet| {
        let facing = eye.dot(facet);
        let light = 2.0 * facing * facet.z - eye.z;
        if facing <= 0.0 || light <= 0.0 {
            return 0.0;
        }
        4.0 * facing * distribution(DVec3::Z, facet, alpha) * visibility(light, eye.z, alpha) * light
    })
}

#[test]
fn facets_cover_the_surface_that_they_are_on() {
    for alpha in ALPHAS {
        for (distribution, _) in [ORACLE, MIRROR] {
            let covered = over_facets(alpha, 400, |facet| distribution(DVec3::Z, facet, alpha) * facet.z);
            assert!((covered - 1.0).abs() < 1e-5, "alpha {alpha}: {covered}");
        }
    }
}

/// Checks the weak white furnace (Heitz 2014, section 5.2): from any direction, the visible facets
/// cover the same area as the surface. It ties the masking to the distribution: no other masking of
/// this kind passes. Nothing hides a light along the normal, so its visibility is the masking of
/// the eye alone, over 4 n . v.
#[test]
fn masking_leaves_the_facets_that_are_seen() {
    for alpha in ALPHAS {
        for cosine in [1.0, 0.7, 0.3, 0.1] {
            for (distribution, visibility) in [ORACLE, MIRROR] {
                let masking = 4.0 * cosine * visibility(1.0, cosine, alpha);
                let seen = over_facets(alpha, 600, |facet| {
                    masking * eye(cosine).dot(facet).max(0.0) * distribution(DVec3::Z, facet, alpha) / cosine
                });
                assert!((seen - 1.0).abs() < 1e-4, "alpha {alpha}, cosine {cosine}: {seen}");
            }
        }
    }
}

/// Checks 1 / G2 = 1 / G1(l) + 1 / G1(v) - 1, which distinguishes height-correlated masking from
/// the product G1(l) G1(v).
#[test]
fn masking_and_shadowing_are_correlated_by_height() {
    let inverse = |light: f64, eye: f64, alpha| 1.0 / (4.0 * light * eye * oracle::visibility(light, eye, alpha));
    for alpha in ALPHAS {
        for (light, eye) in [(0.9, 0.8), (0.5, 0.1), (0.01, 0.02), (1.0, 0.3)] {
            let expected = inverse(1.0, eye, alpha) + inverse(light, 1.0, alpha) - 1.0;
            let found = inverse(light, eye, alpha);
            assert!((found - expected).abs() < 1e-12 * found, "{light} {eye} {alpha}: {found} {expected}");
        }
    }
}

#[test]
fn no_more_light_leaves_than_came() {
    for alpha in ALPHAS {
        for cosine in [1.0, 0.7, 0.3, 0.1, 0.03] {
            for parts in [ORACLE, MIRROR] {
                let found = albedo(parts, cosine, alpha, 300);
                assert!((0.3..1.0 + 1e-4).contains(&found), "alpha {alpha}, cosine {cosine}: {found}");
            }
        }
    }
    // Single scattering misses the light that a second facet reflects, and misses less on smoother
    // surfaces.
    for cosine in [1.0, 0.7, 0.3] {
        let missing: Vec<f64> =
            [0.25, 0.1, 0.01, 0.001].iter().map(|alpha| 1.0 - albedo(ORACLE, cosine, *alpha, 600)).collect();
        assert!(missing.is_sorted_by(|rougher, smoother| rougher > smoother), "cosine {cosine}: {missing:?}");
        assert!(missing[3] < 2e-4, "cosine {cosine}: {missing:?}");
    }
}

#[test]
fn light_and_eye_may_change_places() {
    let mut count = 0;
    for index in 0..20_000u32 {
        // Two directions and a width from Roberts' sequence in five dimensions, which generalizes
        // the golden ratio.
        let coordinate = |power: i32| (f64::from(index) * 1.167_304_f64.powi(-power)).fract();
        let toward = |turn: f64, cosine: f64| {
            let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
            DVec3::new(sine * (2.0 * PI * turn).cos(), sine * (2.0 * PI * turn).sin(), cosine).as_vec3()
        };
        let [light, eye] = [toward(coordinate(1), coordinate(2)), toward(coordinate(3), coordinate(4))];
        let alpha = coordinate(5) as f32;
        let there = reflectance(Vec3::Z, light, eye, alpha, 0.04) * eye.z;
        let back = reflectance(Vec3::Z, eye, light, alpha, 0.04) * light.z;
        assert!((there - back).abs() <= 1e-6 * there, "{light} {eye} {alpha}: {there} {back}");
        count += u32::from(there > 0.0);
    }
    assert!(count > 15_000, "{count}");
}

/// Checks that a smooth surface reflects a point light from one place only: all light of the
/// highlight is within a few alpha of it.
#[test]
fn highlight_narrows_with_alpha() {
    let within = |alpha: f64, angle: f64| -> f64 {
        over_facets(alpha, 400, |facet| {
            let inside = facet.z.acos() < angle;
            if inside { oracle::distribution(DVec3::Z, facet, alpha) * facet.z } else { 0.0 }
        })
    };
    for alpha in [0.001, 0.01, 0.1] {
        // The share of slopes below t is t² / (α² + t²).
        for widths in [1.0f64, 3.0] {
            let angle = (widths * alpha).atan();
            let share = widths * widths / (1.0 + widths * widths);
            assert!((within(alpha, angle) - share).abs() < 3e-3, "{alpha} {widths}: {}", within(alpha, angle));
        }
        assert!((within(alpha, FRAC_PI_2) - 1.0).abs() < 1e-5);
    }
}

#[test]
fn naive_forms_are_those_formulas() {
    for i in 0..50 {
        for j in 0..50 {
            let (cosine, alpha) = (0.05 + 0.019 * f64::from(i), 0.3 + 0.014 * f64::from(j));
            let exact = oracle::distribution_naive(cosine, alpha);
            let found = f64::from(distribution_naive(cosine as f32, alpha as f32));
            assert!((found - exact).abs() < 3e-5 * exact, "{cosine} {alpha}: {found} {exact}");
            assert!((exact - oracle::distribution(DVec3::Z, eye(cosine), alpha)).abs() < 1e-12 * exact);
            let exact = oracle::visibility_naive(cosine, alpha, alpha);
            let found = f64::from(visibility_naive(cosine as f32, alpha as f32, alpha as f32));
            assert!((found - exact).abs() < 3e-6 * exact, "{cosine} {alpha}: {found} {exact}");
        }
    }
}

/// Checks the first table of docs/microfacet.md: the light that facets of reflectance 1 give back,
/// and so the loss of single scattering.
#[test]
fn table_of_albedos_is_current() {
    let mut table = String::new();
    for alpha in [0.01, 0.1, 0.25, 0.5, 1.0] {
        table += &format!("| {alpha} |");
        for cosine in [1.0, 0.7, 0.3, 0.1] {
            table += &format!(" {:.3} |", albedo(ORACLE, cosine, alpha, 600));
        }
        table += "\n";
    }
    let page = include_str!("../../../docs/microfacet.md");
    assert!(page.contains(&table), "docs/microfacet.md should hold:\n{table}");
}

/// Checks the second table: the largest relative error of each form in f32 within five alpha of a
/// normal along z.
#[test]
fn table_of_errors_is_current() {
    let mut table = String::new();
    for alpha in [0.1f32, 0.03, 0.01, 0.003, 0.001] {
        let (mut stable, mut naive) = (0.0f64, 0.0f64);
        for index in 0..2000 {
            let angle = 5.0 * f64::from(alpha) * f64::from(index) / 2000.0;
            let facet = DVec3::new(0.6 * angle.sin(), 0.8 * angle.sin(), angle.cos()).as_vec3();
            let exact = oracle::distribution(DVec3::Z, facet.as_dvec3(), alpha.into());
            let error = |found: f32| (f64::from(found) - exact).abs() / exact;
            stable = larger(stable, error(distribution(Vec3::Z, facet, alpha)));
            naive = naive.max(error(distribution_naive(facet.z, alpha)));
        }
        table += &format!("| {alpha} | {naive:.1e} | {stable:.1e} |\n");
    }
    let page = include_str!("../../../docs/microfacet.md");
    assert!(page.contains(&table), "docs/microfacet.md should hold:\n{table}");
}

/// What an eye at a cosine sees of all facets: masked and foreshortened, so that its integral is 1.
fn visible(eye: DVec3, facet: DVec3, alpha: f64) -> f64 {
    let tangent = (1.0 - eye.z * eye.z).sqrt() / eye.z;
    let unmasked = 2.0 / (1.0 + (1.0 + (alpha * tangent).powi(2)).sqrt());
    oracle::distribution(DVec3::Z, facet, alpha) * unmasked * eye.dot(facet).max(0.0) / eye.z
}

#[test]
fn facets_are_drawn_as_the_eye_sees_them() {
    for alpha in [0.1, 0.25, 0.5, 1.0] {
        for cosine in [1.0, 0.7, 0.3, 0.1] {
            let eye = eye(cosine);
            let side = 400;
            let places = (0..side * side).map(|place| (place % side, place / side));
            let drawn = |of: fn(DVec3) -> f64| {
                let each = places.clone().map(|(column, row)| {
                    let [u, turns] = [column, row].map(|place| (f64::from(place) + 0.5) / f64::from(side));
                    let azimuth = Vec2::from_angle((2.0 * PI * turns) as f32);
                    of(facet(Vec3::Z, eye.as_vec3(), alpha as f32, u as f32, azimuth).as_dvec3())
                });
                each.sum::<f64>() / f64::from(side * side)
            };
            let by_area = |of: fn(DVec3) -> f64| over_facets(alpha, 400, |m| visible(eye, m, alpha) * of(m));
            let moments: [fn(DVec3) -> f64; 4] = [|_| 1.0, |m| m.z, |m| m.x, |m| m.z * m.z];
            for (number, of) in moments.into_iter().enumerate() {
                let (drawn, by_area) = (drawn(of), by_area(of));
                assert!((drawn - by_area).abs() < 2e-3, "{alpha} {cosine} {number}: {drawn} {by_area}");
            }
        }
    }
}
