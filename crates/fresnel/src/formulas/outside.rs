//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{Promise, any_finite, holds, that};

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    const WIDE: &str = "finite and in [0, 1] for relative_index in [2^-30, 2^30]";
    let share = |value: f32| that((0.0..=1.0).contains(&value), || format!("the reflectance is {value}"));
    let wide = |draws: &mut Draws<'_>| (any_finite(draws), draws.magnitude(-30, 29));
    vec![
        holds("fresnel_dielectric", WIDE, wide, move |_: (f32, f32), value: f32| share(value)),
        holds("fresnel_schlick", WIDE, wide, move |_: (f32, f32), value: f32| share(value)),
        holds(
            "fresnel_normal_incidence",
            "as the formula gives, in [0, 1] for every positive relative_index up to 2^120",
            |draws| (draws.magnitude(-126, 119),),
            move |_: (f32,), value: f32| share(value),
        ),
    ]
}
