//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use crate::{RANDOM_WALK_PASSED, RANDOM_WALK_THINNEST, RandomWalkCrossing};
use glam::{UVec4, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{
    Promise, accurate, any_finite, any_number, finite, finite_values, holds, like, of_length, that, vector_up_to,
};

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    let counter = |draws: &mut Draws<'_>| (UVec4::from_array(std::array::from_fn(|_| any_number(draws))),);
    let below_one = |draws: &mut Draws<'_>| draws.between(0.0, 1.0).min(1.0f32.next_down());
    vec![
        accurate("random_walk_bits", "nothing", counter),
        accurate("random_walk_random", "nothing", counter),
        accurate("random_walk_free_path", "nothing", |draws| {
            let u = any_finite(draws);
            (if u.abs() < 2f32.powi(-120) { 0.0 } else { u }, any_finite(draws))
        }),
        finite("random_walk_free_path", "u below 2^-120 may count as 0", |draws| {
            (draws.magnitude(-126, -120), any_finite(draws))
        }),
        holds(
            "random_walk_collision",
            "light never passes where the sum exceeds the majorant: the walk is biased",
            move |draws| {
                let majorant = draws.magnitude(-20, 20);
                let scattering = majorant * draws.between(0.6, 4.0);
                (below_one(draws), scattering, majorant * draws.between(0.6, 4.0), majorant)
            },
            |_: (f32, f32, f32, f32), outcome: u32| that(outcome != RANDOM_WALK_PASSED, || "it passes".to_owned()),
        ),
        like(
            "random_walk_ratio",
            "a smaller majorant counts as 1e-30",
            |draws| {
                let smaller = if draws.below(2) == 0 { draws.magnitude(-126, -101) } else { -draws.magnitude(-99, 99) };
                (draws.between(0.0, 1.0), draws.magnitude(-126, -90), smaller)
            },
            |(transmittance, density, _): (f32, f32, f32)| (transmittance, density, RANDOM_WALK_THINNEST),
        ),
        accurate("random_walk_phase", "nothing", |draws| (any_finite(draws), any_finite(draws))),
        accurate("random_walk_deflection", "nothing", |draws| (any_finite(draws), any_finite(draws))),
        accurate("random_walk_azimuth", "nothing", |draws| (any_finite(draws),)),
        finite("random_walk_basis", "finite, but no unit vectors", |draws| (vector_up_to(draws, 60),)),
        finite("random_walk_turn", "finite, but no unit vector", |draws| {
            (of_length(draws, -10, 10), draws.in_square(), draws.in_square())
        }),
        accurate("random_walk_isotropic", "nothing", |draws| (Vec2::new(any_finite(draws), any_finite(draws)),)),
        holds(
            "random_walk_boundary",
            "a normal that faces away from the light counts as grazing: finite, but no unit vector",
            move |draws| {
                let incident = draws.unit_vector();
                let normal = draws.unit_vector();
                let away = if normal.dot(incident) < 0.0 { -normal } else { normal };
                (incident, away, draws.between(0.25, 4.0), below_one(draws))
            },
            |_: (Vec3, Vec3, f32, f32), crossing: RandomWalkCrossing| finite_values(&crossing.direction.to_array()),
        ),
    ]
}
