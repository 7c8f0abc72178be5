//! Promises of the functions outside their domains, for each clause of their `Outside:` lines.

use glam::{DVec3, Vec3};
use lapidary_assay::outside::{Promise, accurate, any_finite, any_vector, close, holds, nothing};

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    const NOTHING: &str = "nothing";
    vec![
        accurate("srgb_encode", NOTHING, |draws| (any_finite(draws),)),
        accurate("srgb_encode_gamma", NOTHING, |draws| (any_finite(draws),)),
        accurate("srgb_decode", NOTHING, |draws| (any_finite(draws),)),
        accurate("srgb_encode_color", NOTHING, |draws| (any_vector(draws),)),
        accurate("srgb_decode_color", NOTHING, |draws| (any_vector(draws),)),
        holds(
            "srgb_luminance",
            "the same weighted sum, in which channels of opposite sign cancel",
            |draws| (Vec3::new(draws.signed(-40, 100), draws.signed(-40, 100), draws.signed(-40, 100)),),
            |(color,): (Vec3,), luminance: f32| {
                let weights = DVec3::new(0.2126, 0.7152, 0.0722);
                let sum = weights.dot(color.as_dvec3());
                close(&[luminance], &[sum], 1e-6 * weights.dot(color.as_dvec3().abs()))
            },
        ),
        nothing("srgb_tone_curve", "products may overflow"),
    ]
}
