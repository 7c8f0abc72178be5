//! The prefiltered environment: the average over the lobe, and what the split of the sum errs.

use super::{eye, on_page, quadrature};
use crate::{lobe, point};
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

/// Returns the texel of a prefiltered environment in a direction, as a shader computes it.
fn texel(axis: DVec3, alpha: f64, count: u32, radiance: impl Fn(DVec3) -> f64) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for index in 0..count {
        let at = point(index, count);
        let azimuth = Vec2::from_angle((TAU * f64::from(at.y)) as f32);
        let lobe = lobe(axis.as_vec3(), alpha as f32, at.x, azimuth);
        sum += f64::from(lobe.weight) * radiance(lobe.toward.as_dvec3());
        weights += f64::from(lobe.weight);
    }
    sum / weights
}

#[test]
fn even_light_stays_even() {
    for alpha in [0.001, 0.1, 1.0] {
        let value = texel(DVec3::new(0.48, -0.64, 0.6), alpha, 256, |_| 3.0);
        assert!((value - 3.0).abs() < 1e-6, "{alpha}: {value}");
    }
}

/// Checks directions and weights against the integral of D (n . l) over the light's directions for an eye along the normal,
/// which shadowing does not enter: dω is 4 times the cosine of the facet times the facets' own.
#[test]
fn texel_is_the_integral_of_the_lobe() {
    let radiances: [fn(DVec3) -> f64; 3] = [|l| l.z, |l| l.z * l.z, |l| (1.0 + 0.5 * l.x).powi(3)];
    for alpha in [0.01, 0.1, 0.25, 0.5, 1.0f64] {
        for radiance in radiances {
            // D dω = D 4 cos dω(facet); D cos dω(facet) is even in the share of slopes u and in the azimuth.
            let side = 400;
            let (mut sum, mut weights) = (0.0, 0.0);
            for place in 0..side * side {
                let [u, turns] = [place % side, place / side].map(|at| (f64::from(at) + 0.5) / f64::from(side));
                let tilt = 2.0 * (alpha * (u / (1.0 - u)).sqrt()).atan();
                let toward = DVec3::new(tilt.sin() * (TAU * turns).cos(), tilt.sin() * (TAU * turns).sin(), tilt.cos());
                sum += toward.z.max(0.0) * radiance(toward);
                weights += toward.z.max(0.0);
            }
            let found = texel(DVec3::Z, alpha, 4096, radiance);
            assert!((found - sum / weights).abs() < 2e-3, "alpha {alpha}: {found} {}", sum / weights);
        }
    }
}

/// Checks that the solid angles of the directions around any one are those of the sphere: their sum over a cap is its area.
#[test]
fn solid_angles_add_up_to_the_cap() {
    let count = 65_536;
    for alpha in [0.05, 0.3, 1.0f32] {
        for cosine in [0.9, 0.5, 0.0] {
            let within = (0..count).map(|index| point(index, count)).filter_map(|at| {
                let lobe = lobe(Vec3::Z, alpha, at.x, Vec2::from_angle(std::f32::consts::TAU * at.y));
                (lobe.toward.z > cosine).then(|| f64::from(lobe.solid_angle) / f64::from(count))
            });
            let (sum, area) = (within.sum::<f64>(), TAU * (1.0 - f64::from(cosine)));
            // A point more or less at the edge of the cap, where the solid angle is greatest.
            let edge =
                2.0 * f64::from(lobe(Vec3::Z, alpha, share(alpha, cosine), Vec2::X).solid_angle) / f64::from(count);
            assert!((sum - area).abs() < edge + 1e-3 * area, "alpha {alpha}, cosine {cosine}: {sum} {area}");
        }
    }
}

/// Returns the share u of directions that are nearer to the axis than this cosine.
fn share(alpha: f32, cosine: f32) -> f32 {
    let tangent_squared = (1.0 - cosine) / (1.0 + cosine);
    tangent_squared / (alpha * alpha + tangent_squared)
}

/// Checks the page's table: reflected radiance of a white metal, split over exact in percent, with a lamp of 10 degrees in
/// the mirror direction over a dim dome; both furnaces are 1, so that what differs is the shape of the lobe.
#[test]
fn table_of_the_split_is_current() {
    let mut table = String::new();
    for roughness in [0.1, 0.3, 0.5, 0.7, 1.0f64] {
        table += &format!("| {roughness} |");
        for cosine in [1.0, 0.7, 0.4, 0.2] {
            let alpha = roughness * roughness;
            let mirrored = eye(cosine) * DVec3::new(-1.0, 1.0, 1.0);
            let sharpness = 2.0 / (10.0 * PI / 180.0f64).powi(2);
            let radiance = |toward: DVec3| 0.1 + 10.0 * (sharpness * (mirrored.dot(toward) - 1.0)).exp();
            let once = quadrature::over_light(cosine, alpha, 600, |_, _| 1.0);
            let exact = quadrature::over_light(cosine, alpha, 600, |toward, _| radiance(toward)) / once;
            let split = texel(mirrored, alpha, 16_384, radiance);
            table += &format!(" {:+.0} |", 100.0 * (split / exact - 1.0));
        }
        table += "\n";
    }
    on_page(&table);
}
