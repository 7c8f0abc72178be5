//! The BRDF of single scattering, integrated over the facets by midpoints; no table is read.

use super::eye;
use glam::DVec3;
use std::f64::consts::PI;

/// Returns α² / (π (α² cos² + sin²)²) for a facet of this cosine (Walter et al., eq. 33).
fn distribution(cosine: f64, alpha: f64) -> f64 {
    let spread = (alpha * cosine).powi(2) + (1.0 - cosine) * (1.0 + cosine);
    (alpha / spread).powi(2) / PI
}

/// Returns Λ of Smith (Heitz 2014, eq. 72).
fn lambda(cosine: f64, alpha: f64) -> f64 {
    let tangent_squared = (1.0 - cosine) * (1.0 + cosine) / (cosine * cosine);
    0.5 * ((1.0 + alpha * alpha * tangent_squared).sqrt() - 1.0)
}

/// Integrates light over all directions, times cosine and BRDF without Fresnel's factor, for an eye of this cosine: the
/// integrand is asked for each direction and the cosine between it and its facet. Facets are taken at `count` azimuths
/// of a turn and as many angles; the share tan² / (α² + tan²) of facets below an angle is w² (3 - 2 w), w uniform.
pub(super) fn over_light(cosine: f64, alpha: f64, count: u32, integrand: impl Fn(DVec3, f64) -> f64) -> f64 {
    let eye = eye(cosine);
    let step = 1.0 / f64::from(count);
    let midpoints = || (0..count).map(|index| (f64::from(index) + 0.5) * step);
    let ring = |w: f64| {
        let (below, above) = (w * w * (3.0 - 2.0 * w), (1.0 - w) * (1.0 - w) * (1.0 + 2.0 * w));
        let tangent = alpha * (below / above).sqrt();
        let angle = tangent.atan();
        // d(angle) / du, then du / dw.
        let stretch = (alpha * angle.cos() / above).powi(2) / (2.0 * tangent) * 6.0 * w * (1.0 - w);
        let at = |turn: f64| {
            let azimuth = 2.0 * PI * turn;
            let facet = DVec3::new(angle.sin() * azimuth.cos(), angle.sin() * azimuth.sin(), angle.cos());
            let facing = eye.dot(facet);
            let light = 2.0 * facing * facet - eye;
            if facing <= 0.0 || light.z <= 0.0 {
                return 0.0;
            }
            // D G2 / (4 l v) · l dω, with dω = 4 (v · h) dω(facet).
            let seen = 1.0 / (1.0 + lambda(light.z, alpha) + lambda(cosine, alpha));
            distribution(facet.z, alpha) * seen * facing / cosine * integrand(light, facing)
        };
        stretch * angle.sin() * midpoints().map(at).sum::<f64>()
    };
    2.0 * PI * step * step * midpoints().map(ring).sum::<f64>()
}

/// Returns both parts of the reflectance under Schlick's approximation: the factor of f0, and the rest.
pub(super) fn parts(cosine: f64, alpha: f64) -> [f64; 2] {
    let once = over_light(cosine, alpha, 400, |_, _| 1.0);
    let grazing = over_light(cosine, alpha, 400, |_, facing| (1.0 - facing).powi(5));
    [once - grazing, grazing]
}

/// Checks the quadrature itself by a quarter of its step: it is off by less than a fifth of what the tests allow.
#[test]
fn quadrature_has_converged() {
    for alpha in [0.001, 0.01, 0.1, 0.5, 1.0] {
        for cosine in [1.0, 0.5, 0.1, 0.03] {
            let [coarse, fine] = [400, 1600].map(|count| over_light(cosine, alpha, count, |_, _| 1.0));
            assert!((coarse - fine).abs() < 1e-3 * fine, "alpha {alpha}, cosine {cosine}: {coarse} {fine}");
        }
    }
}
