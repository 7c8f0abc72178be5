//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use glam::{Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{Promise, accurate, any_finite, any_number, finite, holds, that};

/// Draws a number of a magnitude up to 1e18: 0, or either sign.
fn large(draws: &mut Draws<'_>) -> f32 {
    if draws.below(6) == 0 { 0.0 } else { draws.signed(-126, 58) }
}

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    const NOTHING: &str = "nothing";
    let mut promises = vec![
        finite("diffusion_face", "finite for magnitudes up to 1e18", |draws| {
            (large(draws), large(draws), Vec2::new(large(draws), large(draws)))
        }),
        finite("diffusion_surface", "finite for magnitudes up to 1e18, if milne is not negative", |draws| {
            (large(draws), large(draws), large(draws), large(draws).abs())
        }),
        holds(
            "diffusion_profile",
            "in [0, 1.000001] for node_depth and milne in [0, 1e18]",
            |draws| (any_finite(draws), large(draws).abs(), large(draws).abs()),
            |_, share: f32| that((0.0..=1.000_001).contains(&share), || format!("share {share}")),
        ),
        finite(
            "diffusion_angle",
            "finite for magnitudes up to 1e9, if h_normal is at least 1 and milne at least 0.01",
            |draws| {
                let (cosine, h, h_normal) = (draws.signed(-126, 28), draws.signed(-126, 28), draws.magnitude(0, 28));
                (cosine, h, h_normal, any_finite(draws), draws.between(0.01, 1e9))
            },
        ),
        finite("diffusion_segment", "finite for start and end up to 1e18", |draws| {
            (large(draws), large(draws), any_finite(draws))
        }),
        accurate("diffusion_unscattered", NOTHING, |draws| (any_finite(draws), any_finite(draws), any_finite(draws))),
        accurate("diffusion_fluence", NOTHING, |draws| {
            (any_finite(draws), any_finite(draws), any_finite(draws), any_finite(draws))
        }),
        accurate("diffusion_slab", NOTHING, |draws| (any_finite(draws), any_finite(draws), any_finite(draws))),
        accurate("diffusion_tail", NOTHING, |draws| {
            (any_finite(draws), any_finite(draws), any_finite(draws), any_finite(draws), any_finite(draws))
        }),
        accurate("diffusion_local", NOTHING, |draws| {
            let [eye, light, law, gamma, milne, depth, gap, angle] = [(); 8].map(|()| any_finite(draws));
            (eye, light, law, gamma, milne, depth, gap, angle)
        }),
        accurate("diffusion_local_around", NOTHING, |draws| {
            let [eye, law, gamma, milne, depth, gap, angle] = [(); 7].map(|()| any_finite(draws));
            (eye, law, gamma, milne, depth, gap, angle)
        }),
        finite("diffusion_weight", "finite for volumes of magnitudes up to 1e18", |draws| {
            (Vec3::new(any_finite(draws), any_finite(draws), any_finite(draws)), any_number(draws), large(draws))
        }),
        holds(
            "diffusion_slope",
            "in [-100.01, 100.01] for magnitudes up to 1e18",
            |draws| (large(draws), large(draws), large(draws), large(draws)),
            |_, slope: f32| that(slope.abs() <= 100.01, || format!("slope {slope}")),
        ),
        holds(
            "diffusion_limit",
            "in [0, 1] for fluences of magnitudes up to 1e18",
            |draws| (large(draws), large(draws), any_finite(draws)),
            |_, factor: f32| that((0.0..=1.000_01).contains(&factor), || format!("factor {factor}")),
        ),
        holds(
            "diffusion_relax",
            "0 if conductances and reaction are not positive",
            |draws| (large(draws), large(draws), -large(draws).abs(), -large(draws).abs()),
            |_, value: f32| that(value == 0.0, || format!("value {value}")),
        ),
    ];
    let single = ["diffusion_milne", "diffusion_ramps"];
    promises.extend(single.map(|function| accurate(function, NOTHING, |draws| (any_finite(draws),))));
    let pairs = ["diffusion_mean", "diffusion_scattered"];
    promises.extend(pairs.map(|function| accurate(function, NOTHING, |draws| (any_finite(draws), any_finite(draws)))));
    promises
}
