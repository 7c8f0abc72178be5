//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use glam::{DVec3, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{Promise, accurate, any_finite, close, finite, holds, of_length, that};

fn not_negative(value: f32) -> Result<(), String> {
    that(value >= 0.0 && value.is_finite(), || format!("the result is {value}"))
}

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    const DISTRIBUTION: &str = "microfacet_distribution";
    const REFLECTANCE: &str = "microfacet_reflectance";
    let facing = |draws: &mut Draws<'_>| {
        let lift = |direction: DVec3| (direction + 1.5 * DVec3::Z).normalize().as_vec3();
        (lift(draws.direction()), lift(draws.direction()))
    };
    vec![
        holds(
            DISTRIBUTION,
            "finite and not negative as long as the fourth power of the product of the lengths is finite",
            |draws| (of_length(draws, -60, 15), of_length(draws, -60, 15), any_finite(draws)),
            |_: (Vec3, Vec3, f32), density: f32| not_negative(density),
        ),
        holds(
            DISTRIBUTION,
            "0 where its square underflows",
            |draws| (of_length(draws, -60, -42), of_length(draws, -60, -42), any_finite(draws)),
            |_: (Vec3, Vec3, f32), density: f32| that(density == 0.0, || format!("the density is {density}")),
        ),
        accurate("microfacet_visibility", "nothing", |draws| (any_finite(draws), any_finite(draws), any_finite(draws))),
        holds(
            "microfacet_half",
            "the direction of the sum, for lengths up to 1e18",
            |draws| {
                let length = draws.magnitude(-10, 59);
                let first = draws.unit_vector();
                // Not nearly opposite, because the sum would be rounding error.
                let second = (first.as_dvec3() + 0.9 * draws.direction()).as_vec3();
                (length * first, length * draws.between(0.1, 2.0) * second)
            },
            |(light, eye): (Vec3, Vec3), half: Vec3| {
                close(&half.to_array(), &(light.as_dvec3() + eye.as_dvec3()).normalize().to_array(), 4e-6)
            },
        ),
        finite("microfacet_facet", "finite", |draws| {
            let turns = draws.unit() * std::f64::consts::TAU;
            let azimuth = glam::Vec2::new(turns.cos() as f32, turns.sin() as f32);
            let (normal, eye) = (draws.unit_vector(), draws.unit_vector());
            (normal, eye, draws.between(0.001, 1.0), draws.between(0.0, 0.999), azimuth)
        }),
        holds(
            "microfacet_facet",
            "an eye below the surface sees the facets that turn towards it",
            |draws| {
                let azimuth = glam::Vec2::from_angle(draws.between(0.0, 6.0));
                let eye = (draws.direction() - 1.5 * DVec3::Z).normalize().as_vec3();
                (Vec3::Z, eye, draws.between(0.1, 1.0), draws.between(0.0, 0.999), azimuth)
            },
            |(_, eye, ..): (Vec3, Vec3, f32, f32, glam::Vec2), facet: Vec3| {
                that(facet.z >= 0.0 && facet.dot(eye) >= -1e-5, || format!("{facet}"))
            },
        ),
        finite(REFLECTANCE, "for vectors of other lengths finite, but no reflectance", |draws| {
            (of_length(draws, -10, 10), of_length(draws, -10, 10), of_length(draws, -10, 10), any_finite(draws), 1.0f32)
        }),
        holds(
            REFLECTANCE,
            "proportional to fresnel",
            move |draws| {
                let (light, eye) = facing(draws);
                (Vec3::Z, light, eye, draws.between(0.1, 1.0), draws.signed(-10, 20))
            },
            |(normal, light, eye, alpha, fresnel): (Vec3, Vec3, Vec3, f32, f32), value: f32| {
                let of_one = f64::from(crate::reflectance(normal, light, eye, alpha, 1.0));
                let wanted = f64::from(fresnel) * of_one;
                close(&[value], &[wanted], 1e-4 * wanted.abs())
            },
        ),
    ]
}
