//! Light on a microsurface of Smith's kind, facet by facet (Heitz, Hanika, d'Eon and Dachsbacher, "Multiple-Scattering
//! Microfacet BSDFs with the Smith Model", 2016): the exact multiple scattering that compensation stands for.

use super::eye;
use glam::DVec3;
use std::f64::consts::TAU;

/// Numbers in [0, 1), by SplitMix64.
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Returns Λ of a direction to either side; below the surface it is -1 - Λ of the opposite one.
fn lambda(cosine: f64, alpha: f64) -> f64 {
    let root = (1.0 + alpha * alpha * (1.0 - cosine) * (1.0 + cosine) / (cosine * cosine)).sqrt();
    if cosine > 0.0 { 0.5 * (root - 1.0) } else { -0.5 * (root + 1.0) }
}

/// Returns a facet at random by how much of it is seen from `toward`, which may be below the surface: a cap of the
/// hemisphere that stretching makes of the facets (Dupuy and Benyoub 2023).
pub(super) fn facet(toward: DVec3, alpha: f64, u: f64, turns: f64) -> DVec3 {
    let stretched = DVec3::new(alpha * toward.x, alpha * toward.y, toward.z).normalize();
    let z = (1.0 - u) * (1.0 + stretched.z) - stretched.z;
    let level = (1.0 - z * z).max(0.0).sqrt();
    let (sine, cosine) = (TAU * turns).sin_cos();
    let half = stretched + DVec3::new(level * cosine, level * sine, z);
    DVec3::new(alpha * half.x, alpha * half.y, half.z.max(1e-12)).normalize()
}

/// Where the light went: for each f0 the share that leaves, and the share that leaves the first facet at f0 = 1.
pub(super) struct Walked<const N: usize> {
    pub(super) left: [f64; N],
    pub(super) once: f64,
}

/// Walks `count` times from an eye at this cosine. `reflected` is the share of light that a facet reflects, by f0 and the
/// cosine of incidence. The state is the share of the surface below the light's height, which by itself holds all of it.
pub(super) fn walk<const N: usize>(
    cosine: f64,
    alpha: f64,
    f0: [f64; N],
    reflected: impl Fn(f64, f64) -> f64,
    count: u32,
) -> Walked<N> {
    let mut random = Random(u64::from(count) ^ cosine.to_bits() ^ alpha.to_bits().rotate_left(17));
    let mut walked = Walked { left: [0.0; N], once: 0.0 };
    for _ in 0..count {
        let (mut toward, mut below, mut weight) = (-eye(cosine), 1.0f64, [1.0; N]);
        for bounce in 0..1000 {
            let slope = lambda(toward.z, alpha);
            let u = random.next();
            if toward.z > 0.0 && u > 1.0 - below.powf(slope) {
                for (left, weight) in walked.left.iter_mut().zip(weight) {
                    *left += weight;
                }
                walked.once += f64::from(bounce == 1);
                break;
            }
            below = (below / (1.0 - u).powf(slope.recip())).min(1.0);
            let met = facet(-toward, alpha, random.next(), random.next());
            let facing = -toward.dot(met);
            for (weight, f0) in weight.iter_mut().zip(f0) {
                *weight *= reflected(f0, facing);
            }
            toward += 2.0 * facing * met;
        }
    }
    let all = f64::from(count);
    walked.once /= all;
    walked.left = walked.left.map(|left| left / all);
    walked
}

/// Returns Schlick's reflectance.
pub(super) fn schlick(f0: f64, facing: f64) -> f64 {
    f0 + (1.0 - f0) * (1.0 - facing.clamp(0.0, 1.0)).powi(5)
}

/// Checks that the walk's single scattering is that of the BRDF, and that no light stays between white facets.
#[test]
fn walks_scatter_once_as_the_brdf_does() {
    for alpha in [0.1, 0.5, 1.0] {
        for cosine in [1.0, 0.5, 0.1] {
            let walked = walk(cosine, alpha, [1.0], schlick, 200_000);
            let once = super::quadrature::over_light(cosine, alpha, 400, |_, _| 1.0);
            // Four standard deviations of a share.
            let bound = 4.0 * (once * (1.0 - once) / 200_000.0).sqrt() + 1e-4;
            assert!((walked.once - once).abs() < bound, "alpha {alpha}, cosine {cosine}: {} {once}", walked.once);
            assert!((walked.left[0] - 1.0).abs() < 1e-4, "alpha {alpha}, cosine {cosine}: {}", walked.left[0]);
        }
    }
}
