//! What the functions promise outside of their domain, one for each clause of their `Outside:` lines.

use glam::{UVec2, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{Promise, accurate, any_finite, any_number, close, finite, holds, vector_up_to};

/// A size of 0 or 1 in at least one direction.
fn thin(draws: &mut Draws<'_>) -> UVec2 {
    let other = draws.below(65);
    let one = draws.below(2);
    if draws.below(2) == 0 { UVec2::new(one, other) } else { UVec2::new(other, one) }
}

fn beyond(draws: &mut Draws<'_>) -> Vec3 {
    Vec3::from_array([(); 3].map(|()| draws.between(-1.0, 1.5)))
}

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    let cosine = |draws: &mut Draws<'_>| any_finite(draws);
    vec![
        finite("split_sum_fresnel", "finite for f0 up to 1e30 in magnitude", |draws| {
            (vector_up_to(draws, 99), any_finite(draws))
        }),
        holds(
            "split_sum_point",
            "y is the float before 1",
            |draws| {
                let count = any_number(draws).max(1);
                (count.saturating_add(draws.below(1 << 20)), count)
            },
            |_: (u32, u32), point: Vec2| close(&[point.y], &[1.0 - 0.5f64.powi(24)], 2e-7),
        ),
        holds(
            "split_sum_point",
            "a count of 0 counts as 1",
            |draws| (draws.below(2), 0),
            |(index, _): (u32, u32), point: Vec2| close(&[point.y], &[index.into()], 4e-7),
        ),
        finite("split_sum_texel", "finite", |draws| {
            (UVec2::new(any_number(draws), any_number(draws)), UVec2::new(any_number(draws), any_number(draws)))
        }),
        holds(
            "split_sum_texel",
            "a size below 2 counts as 2",
            |draws| (UVec2::new(draws.below(2), draws.below(2)), UVec2::new(draws.below(2), draws.below(2))),
            |(texel, _): (UVec2, UVec2), value: Vec2| close(&value.to_array(), &texel.as_dvec2().to_array(), 1e-6),
        ),
        accurate("split_sum_place", "a size below 2 counts as 2", move |draws| {
            (cosine(draws), cosine(draws), thin(draws))
        }),
        accurate("split_sum_shadowing", "nothing", move |draws| (cosine(draws), cosine(draws), cosine(draws))),
        accurate("split_sum_albedo", "nothing", move |draws| {
            (cosine(draws), cosine(draws), cosine(draws), cosine(draws))
        }),
        finite("split_sum_lobe", "finite for u up to 1 and vectors up to 1e9", |draws| {
            let azimuth = vector_up_to(draws, 29).truncate();
            (vector_up_to(draws, 29), any_finite(draws), draws.between(-2.0, 1.0), azimuth)
        }),
        finite("split_sum_compensation", "finite for f0 in [-1, 1.5]", |draws| (beyond(draws), any_finite(draws))),
        finite("split_sum_reflectance", "finite for f0 in [-1, 1.5] and a table up to 1e30 in magnitude", |draws| {
            (beyond(draws), vector_up_to(draws, 99).truncate())
        }),
    ]
}
