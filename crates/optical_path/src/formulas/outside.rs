//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use crate::OPTICAL_PATH_UNREACHED;
use glam::Vec3;
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::near;
use lapidary_assay::outside::{Promise, accurate, any_bits, any_number, finite, holds, that};

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    vec![
        finite("optical_path_edge", "finite while products stay below 3e38", |draws| {
            (draws.magnitude(-126, 60), draws.magnitude(-126, 60), draws.magnitude(-126, 64))
        }),
        finite("optical_path_relax", "finite while the sum is", |draws| {
            (draws.magnitude(-126, 126), draws.magnitude(-126, 126), draws.magnitude(-126, 126))
        }),
        holds(
            "optical_path_godunov",
            "a slowness below 2^-126 counts as 0 or as itself",
            |draws| {
                let unreached =
                    |draws: &mut Draws<'_>| if draws.below(3) == 0 { 1e30 } else { draws.between(0.0, 4.0) };
                let least = Vec3::new(unreached(draws), unreached(draws), unreached(draws));
                (least, f32::from_bits(1 + draws.below(0x7f_ffff)))
            },
            |(least, _): (Vec3, f32), cost: f32| {
                let wanted = f64::from(least.min_element());
                near("the cost", cost.into(), wanted, 1e-6 * wanted + 2f64.powi(-125))
            },
        ),
        accurate("optical_path_encode", "nothing", |draws| (any_bits(draws),)),
        accurate("optical_path_decode", "nothing", |draws| (any_number(draws),)),
        holds(
            "optical_path_seed",
            "a negative share is no light",
            |draws| (-draws.magnitude(-120, 100), draws.magnitude(-20, 49), draws.magnitude(-20, 46)),
            |_: (f32, f32, f32), cost: f32| that(cost == OPTICAL_PATH_UNREACHED, || format!("the cost is {cost}")),
        ),
        finite("optical_path_through", "finite while the product is", |draws| {
            (draws.magnitude(-126, 125), draws.magnitude(-126, 62), draws.magnitude(-126, 62))
        }),
        holds("optical_path_luminance", "1 for a negative cost", |draws| (-draws.magnitude(-126, 127),), {
            |_: (f32,), luminance: f32| that(luminance == 1.0, || format!("the luminance is {luminance}"))
        }),
    ]
}
