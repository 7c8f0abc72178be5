//! Promises of the functions outside their domains, for each clause of their `Outside:` lines.

use crate::RefractionHit;
use glam::Vec3;
use lapidary_assay::outside::{Promise, close, finite, finite_values, holds, of_length};

/// Checks a reflection against its linear map, r - 2 (n . r) n in f64, for vectors of any length.
pub fn linear(vector: Vec3, normal: Vec3, reflected: Vec3) -> Result<(), String> {
    let (r, n) = (vector.as_dvec3(), normal.as_dvec3());
    let wanted = r - 2.0 * n.dot(r) * n;
    close(&reflected.to_array(), &wanted.to_array(), 2e-6 * r.length() * (1.0 + 2.0 * n.length_squared()))
}

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    const RADICAND: &str = "refraction_radicand";
    vec![
        holds(
            "refraction_relative_index",
            "the quotient, while index_incident is not 0",
            |draws| (draws.signed(-60, 60), draws.signed(-60, 60)),
            |(incident, transmitted): (f32, f32), index: f32| {
                let wanted = f64::from(transmitted) / f64::from(incident);
                close(&[index], &[wanted], 4e-7 * wanted.abs())
            },
        ),
        holds(
            "refraction_reflect",
            "for other lengths the linear map r - 2 (n . r) n, which then is no reflection",
            |draws| (of_length(draws, -20, 20), of_length(draws, -20, 20)),
            |(incident, normal): (Vec3, Vec3), reflected: Vec3| linear(incident, normal, reflected),
        ),
        holds(
            RADICAND,
            "the same quotient",
            |draws| (draws.signed(-10, 10), draws.magnitude(-10, 10)),
            |(cosine, index): (f32, f32), radicand: f32| {
                let (cosine, index) = (f64::from(cosine), f64::from(index));
                let wanted = ((index - 1.0) * (index + 1.0) + cosine * cosine) / (index * index);
                let terms = (cosine * cosine + index * index + 1.0) / (index * index);
                close(&[radicand], &[wanted], 2e-6 * terms)
            },
        ),
        finite(RADICAND, "finite for |cosine| < 1e9 and relative_index in [1e-9, 1e18]", |draws| {
            (draws.signed(-126, 28), draws.magnitude(-29, 58))
        }),
        holds(
            "refraction_refract",
            "a normal that faces away from the ray is taken to be at grazing incidence (c = 0): finite, but not unit",
            |draws| {
                let (incident, normal) = (draws.unit_vector(), draws.unit_vector());
                (incident, if normal.dot(incident) < 0.0 { -normal } else { normal }, draws.between(0.25, 4.0))
            },
            |_: (Vec3, Vec3, f32), hit: RefractionHit| finite_values(&hit.direction.to_array()),
        ),
    ]
}
