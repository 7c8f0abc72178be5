//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use crate::{DispersionSellmeier, oracle as dispersion};
use glam::Vec3;
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{Promise, close, finite, holds, nothing, of_length};
use lapidary_refraction::formulas::linear;

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    const SAME: &str = "the same formula, while the wavelength is in [1e-3, 1e9]";
    const ENTER: &str = "dispersion_enter";
    const REFRACT: &str = "dispersion_refract";
    const FACES_AWAY: &str = "A normal that faces away is taken to be at grazing incidence, as refraction.wgsl does";
    let away = |draws: &mut Draws<'_>| {
        let (direction, normal) = (draws.unit_vector(), draws.unit_vector());
        (direction, if normal.dot(direction) < 0.0 { -normal } else { normal })
    };
    let refracted = move |draws: &mut Draws<'_>| {
        let (direction, normal) = away(draws);
        let gradient = draws.magnitude(-40, 39) * draws.unit_vector();
        (direction, gradient, normal, draws.between(0.25, 4.0), draws.signed(-40, -1))
    };
    vec![
        holds(
            "dispersion_sellmeier",
            "the same formula while no resonance is met",
            |draws| {
                let resonances =
                    Vec3::new(draws.between(0.001, 0.02), draws.between(0.001, 0.02), draws.between(100.0, 200.0));
                let material = DispersionSellmeier {
                    constant: draws.between(0.0, 2.0),
                    strengths: draws.in_cube().abs(),
                    resonances,
                };
                (material, draws.between(200.0, 4000.0))
            },
            |(material, wavelength): (DispersionSellmeier, f32), index: f32| {
                let squared = (f64::from(wavelength) / 1000.0).powi(2);
                let term = |place: usize| {
                    f64::from(material.strengths[place]) * squared / (squared - f64::from(material.resonances[place]))
                };
                let wanted = 1.0 + f64::from(material.constant) + (0..3).map(term).sum::<f64>();
                let wanted = wanted.max(1.0).sqrt();
                close(&[index], &[wanted], 1e-5 * wanted)
            },
        ),
        nothing("dispersion_sellmeier", "infinite or not a number where wavelength^2 is a resonance"),
        holds(
            "dispersion_cauchy",
            SAME,
            |draws| {
                (
                    Vec3::new(draws.between(1.0, 4.0), draws.between(0.0, 0.1), draws.between(0.0, 0.01)),
                    draws.magnitude(-9, 29),
                )
            },
            |(coefficients, wavelength): (Vec3, f32), index: f32| {
                let [a, b, c] = coefficients.as_dvec3().to_array();
                let inverse = (f64::from(wavelength) / 1000.0).powi(-2);
                let wanted = a + inverse * (b + inverse * c);
                close(&[index], &[wanted], 1e-5 * wanted)
            },
        ),
        holds(
            "dispersion_abbe",
            SAME,
            |draws| (draws.between(1.0, 4.0), draws.between(0.0, 64.0), draws.magnitude(-9, 29)),
            |(index_d, strength, wavelength): (f32, f32, f32), index: f32| {
                let wanted = dispersion::abbe(index_d.into(), strength.into(), wavelength.into());
                let squared = (f64::from(wavelength) / 1000.0).powi(-2);
                close(&[index], &[wanted], 1e-5 * (wanted.abs() + f64::from(strength) * (1.0 + squared)))
            },
        ),
        holds(
            "dispersion_abbe_number",
            "the same quotient",
            |draws| {
                let middle = draws.signed(-6, 10);
                (middle, middle + draws.magnitude(0, 4), middle - draws.magnitude(0, 4))
            },
            |(d, f, c): (f32, f32, f32), number: f32| {
                let [d, f, c] = [d, f, c].map(f64::from);
                let wanted = (d - 1.0) / (f - c);
                close(&[number], &[wanted], 4e-6 * ((d.abs() + 1.0) / (f - c)).abs() + 1e-6 * wanted.abs())
            },
        ),
        finite(ENTER, "finite", |draws| (draws.unit_vector(), draws.unit_vector(), draws.between(0.25, 4.0))),
        finite(ENTER, FACES_AWAY, move |draws| {
            let (direction, normal) = away(draws);
            (direction, normal, draws.between(1.0, 4.0))
        }),
        nothing(ENTER, "A gem in a denser medium takes dispersion_refract, which knows total internal reflection"),
        finite(REFRACT, "finite", refracted),
        finite(REFRACT, FACES_AWAY, refracted),
        holds(
            "dispersion_reflect",
            "for other lengths of the normal the same linear map, which then is no reflection",
            |draws| (of_length(draws, -20, 20), of_length(draws, -20, 20)),
            |(gradient, normal): (Vec3, Vec3), reflected: Vec3| linear(gradient, normal, reflected),
        ),
        nothing(
            "dispersion_direction",
            "not a number where the sum is 0, which a perpendicular gradient cannot bring about",
        ),
        holds(
            "dispersion_paper_enter",
            "the same quotient",
            |draws| (of_length(draws, -3, 3), of_length(draws, -3, 3)),
            |(direction, refracted): (Vec3, Vec3), unit: Vec3| {
                let chord = refracted.as_dvec3() - direction.as_dvec3();
                let size = direction.length().max(refracted.length());
                if chord.length() < 1e-3 {
                    return Ok(());
                }
                close(&unit.to_array(), &chord.normalize().to_array(), 2e-6 * (1.0 + f64::from(size) / chord.length()))
            },
        ),
    ]
}
