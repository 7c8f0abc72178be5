//! The table as a shader bakes and reads it, against quadrature of the BRDF.

use super::walk::facet;
use super::{eye, on_page, quadrature};
use crate::{albedo, place, point, reflectance, texel};
use glam::{UVec2, Vec2, Vec3};

const SIZE: u32 = 64;
const SAMPLES: u32 = 1024;

/// Bakes the table, row by row.
pub(super) fn baked() -> Vec<Vec2> {
    let size = UVec2::splat(SIZE);
    let places = (0..SIZE * SIZE).map(|index| UVec2::new(index % SIZE, index / SIZE));
    places
        .map(|place| {
            let [cosine, alpha] = texel(place, size).to_array().map(f64::from);
            let alpha = alpha.max(1e-3);
            let toward = eye(cosine);
            let sum: Vec2 = (0..SAMPLES)
                .map(|index| {
                    let [u, turns] = point(index, SAMPLES).to_array().map(f64::from);
                    let met = facet(toward, alpha, u, turns);
                    let facing = toward.dot(met);
                    let light = 2.0 * facing * met.z - toward.z;
                    albedo(facing as f32, light as f32, cosine as f32, alpha as f32)
                })
                .sum();
            sum / SAMPLES as f32
        })
        .collect()
}

/// Reads the table as a sampler does that blends and clamps.
pub(super) fn read(table: &[Vec2], cosine: f64, alpha: f64) -> Vec2 {
    let at = place(cosine as f32, alpha as f32, UVec2::splat(SIZE)) * SIZE as f32 - 0.5;
    let lower = at.floor().clamp(Vec2::ZERO, Vec2::splat(SIZE as f32 - 1.0));
    let weight = at - lower;
    let upper = (lower + 1.0).min(Vec2::splat(SIZE as f32 - 1.0));
    let of = |column: f32, row: f32| table[(row as u32 * SIZE + column as u32) as usize];
    of(lower.x, lower.y)
        .lerp(of(upper.x, lower.y), weight.x)
        .lerp(of(lower.x, upper.y).lerp(of(upper.x, upper.y), weight.x), weight.y)
}

/// Roughnesses and cosines beside the texels and on them.
fn grid() -> impl Iterator<Item = (f64, f64)> {
    let roughnesses = [0.0317, 0.05, 0.1, 0.17, 0.25, 0.33, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
    let cosines = [1.0, 0.9, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05, 0.02];
    roughnesses.into_iter().flat_map(move |roughness| cosines.map(|cosine| (roughness * roughness, cosine)))
}

/// The furnace of the BRDF with the compensation that the table gives: the integral of single scattering by quadrature,
/// times the factor. At f0 = 1 it is 1 only if the table's albedo is right; at f0 = 1/2 it is that of the albedo by quadrature.
#[test]
fn furnace_by_quadrature() {
    let table = baked();
    for (alpha, cosine) in grid() {
        let [factor, rest] = quadrature::parts(cosine, alpha);
        let value = read(&table, cosine, alpha);
        for f0 in [0.04, 0.5, 1.0] {
            let once = f0 * factor + rest;
            let by_table = once * f64::from(crate::compensation(Vec3::splat(f0 as f32), value.x + value.y).x);
            let exact = once * crate::oracle::compensation(glam::DVec3::splat(f0), factor + rest).x;
            assert!(
                (by_table / exact - 1.0).abs() < 5e-3,
                "alpha {alpha}, cosine {cosine}, f0 {f0}: {by_table} {exact}"
            );
            // And what a shader takes for it, both of whose factors come from the table.
            let drawn = f64::from(reflectance(Vec3::splat(f0 as f32), value).x);
            let bound = if f0 < 0.1 { 2e-3 } else { 5e-3 * exact };
            assert!((drawn - exact).abs() < bound, "alpha {alpha}, cosine {cosine}, f0 {f0}: {drawn} {exact}");
        }
        let white = f64::from(reflectance(Vec3::ONE, value).x);
        // The albedo may exceed 1 by the rounding of the sum of its samples.
        assert!(
            (white - 1.0).abs() < f64::from(SAMPLES) * f64::from(f32::EPSILON),
            "alpha {alpha}, cosine {cosine}: {white}"
        );
    }
}

/// Checks the first table of the page: what single scattering loses at f0 = 1, and what reciprocity lacks: the ratio of the
/// compensations for eyes along the normal and at a cosine of 0.1, which change places with the light.
#[test]
fn table_of_losses_is_current() {
    let mut table = String::new();
    for roughness in [0.1, 0.3, 0.5, 0.7, 0.85, 1.0f64] {
        let alpha = roughness * roughness;
        let once = [1.0, 0.5, 0.1].map(|cosine| quadrature::over_light(cosine, alpha, 400, |_, _| 1.0));
        let lost = once.map(|once| 1.0 - once);
        let factor = |f0: f64, once: f64| crate::oracle::compensation(glam::DVec3::splat(f0), once).x;
        let defect = [0.5, 1.0].map(|f0| (factor(f0, once[0]) / factor(f0, once[2])).ln().abs().exp());
        table += &format!(
            "| {roughness} | {:.3} | {:.3} | {:.3} | {:.2} | {:.2} |\n",
            lost[0], lost[1], lost[2], defect[0], defect[1]
        );
    }
    on_page(&table);
}
