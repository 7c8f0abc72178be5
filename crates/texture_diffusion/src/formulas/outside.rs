//! Promises of the functions outside their domains, for each clause of their `Outside:` lines.

use crate::TextureDiffusionTap;
use glam::{Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::near;
use lapidary_assay::outside::{
    Promise, accurate, any_bits, any_number, close, finite, holds, like, nothing, of_length, that,
};

fn bits_vector(draws: &mut Draws<'_>) -> Vec3 {
    Vec3::new(any_bits(draws), any_bits(draws), any_bits(draws))
}

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    const TAP: &str = "texture_diffusion_tap";
    let uv = |draws: &mut Draws<'_>| (Vec2::new(draws.signed(0, 30), draws.signed(0, 30)),);
    let width = |draws: &mut Draws<'_>| (any_bits(draws), any_bits(draws), -draws.magnitude(-60, 100));
    let scattering = |draws: &mut Draws<'_>| draws.in_cube().abs() + 0.1;
    vec![
        accurate("texture_diffusion_finite", "nothing; a subnormal may count as zero", |draws| (any_bits(draws),)),
        holds("texture_diffusion_clip", "the same, less accurate", uv, |(uv,): (Vec2,), clip: glam::Vec4| {
            let uv = uv.as_dvec2();
            let bound = 1e-6 * (1.0 + uv.abs().max_element());
            close(&clip.to_array(), &[2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.0, 1.0], bound)
        }),
        holds(
            "texture_diffusion_stretch",
            "0 for shorter ones",
            |draws| (of_length(draws, -126, -64), of_length(draws, -126, -64)),
            |(x, y): (Vec3, Vec3), stretch: Vec2| {
                // Subnormal squares have few digits, and the smallest is 2^-149.
                let longest = 1.5 * x.as_dvec3().length().max(y.as_dvec3().length()) + 1e-22;
                let right = stretch.min_element() >= 0.0 && f64::from(stretch.max_element()) <= longest;
                that(right, || format!("the stretch is {stretch}"))
            },
        ),
        // Width is tested for every stretch.
        nothing("texture_diffusion_stretch", "infinite for longer ones; texture_diffusion_width takes both"),
        finite("texture_diffusion_width", "a negative widest counts as 0", width),
        holds("texture_diffusion_width", "a negative widest counts as 0", width, |_: (f32, f32, f32), width: f32| {
            that(width == 0.0, || format!("the width is {width}"))
        }),
        accurate("texture_diffusion_sigma", "nothing; a subnormal may count as zero", |draws| (bits_vector(draws),)),
        holds(
            "texture_diffusion_ratio",
            "less than the ratio for a widest below 2^-60",
            |draws| {
                let scale = draws.magnitude(-100, -62);
                (scale * (draws.in_cube().abs() + 0.01),)
            },
            |(sigma,): (Vec3,), ratio: f32| {
                let of_channels = sigma.as_dvec3().min_element() / sigma.as_dvec3().max_element();
                let most = of_channels.clamp(0.0625, 1.0) * 1.000_001;
                that((0.0625..=1.0).contains(&ratio) && f64::from(ratio) <= most, || format!("the ratio is {ratio}"))
            },
        ),
        holds(
            "texture_diffusion_pairs",
            "the same",
            |draws| (bits_vector(draws),),
            |_: (Vec3,), pairs: u32| that((15..=23).contains(&pairs), || format!("{pairs} pairs")),
        ),
        like(
            TAP,
            "an index beyond the last counts as the last",
            move |draws| {
                let pairs = 1 + draws.below(1024);
                (pairs.saturating_add(any_number(draws)), pairs, scattering(draws))
            },
            |(_, pairs, sigma): (u32, u32, Vec3)| (pairs, pairs, sigma),
        ),
        like(
            TAP,
            "0 pairs as 1",
            move |draws| (draws.below(3), 0, scattering(draws)),
            |(index, _, sigma): (u32, u32, Vec3)| (index, 1, sigma),
        ),
        holds(
            TAP,
            "0 pairs as 1",
            |draws| (any_number(draws), any_number(draws), bits_vector(draws)),
            |_: (u32, u32, Vec3), tap: TextureDiffusionTap| {
                let right = (0.0..=3.401).contains(&tap.offset) && tap.weight.min_element() >= 0.0;
                that(right && tap.weight.is_finite(), || format!("the tap is {tap:?}"))
            },
        ),
        holds(
            "texture_diffusion_normalize",
            "fades to 0 for smaller coverages",
            |draws| {
                let coverage = draws.magnitude(-126, -61);
                (coverage * draws.in_cube().abs(), Vec3::splat(coverage))
            },
            |(sum, coverage): (Vec3, Vec3), mean: Vec3| {
                let most = 1.000_001 * sum.as_dvec3() / coverage.as_dvec3();
                let right = mean.min_element() >= 0.0 && mean.as_dvec3().cmple(most + 1e-30).all();
                that(right, || format!("the mean is {mean}, at most {most}"))
            },
        ),
        holds(
            "texture_diffusion_half",
            "smaller values keep 11 bits too, which half floats do not have there",
            |draws| (Vec3::new(draws.signed(-120, -15), draws.signed(-120, -15), draws.signed(-120, -15)),),
            |(value,): (Vec3,), half: Vec3| {
                let off = (half - value).as_dvec3().abs();
                let bits = half.to_array().into_iter().all(|half| half.to_bits().trailing_zeros() >= 13);
                let right = off.cmple(value.as_dvec3().abs() * 2f64.powi(-11)).all() && bits;
                that(right, || format!("rounded to {half}"))
            },
        ),
        holds(
            "texture_diffusion_half",
            "the target rounds them, by less than 2^-24",
            |draws| (Vec3::splat(draws.signed(-120, -15)),),
            |(value,): (Vec3,), half: Vec3| {
                // A half float's subnormals are the multiples of 2^-24.
                let stored = (half.x * 2f32.powi(24)).round() * 2f32.powi(-24);
                near("what is stored", stored.into(), value.x.into(), 2f64.powi(-24))
            },
        ),
        holds(
            "texture_diffusion_nearness",
            "|step| below 1 counts as 1",
            |draws| (0.999 * draws.between(0.0, 1.0) * Vec2::from_angle(draws.between(0.0, 6.3)),),
            |_: (Vec2,), nearness: f32| that((nearness - 1.0).abs() < 1.6e-6, || format!("the nearness is {nearness}")),
        ),
    ]
}
