//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use crate::EnvironmentTexels;
use glam::{DVec3, UVec2, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{
    Promise, accurate, any_finite, close, finite, holds, like, nothing, of_length, small_size, that, vector_up_to,
};
use std::f64::consts::{PI, TAU};

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    [directions(), lights()].into_iter().flatten().collect()
}

/// Draws any number, including subnormal ones.
fn subnormal_or_any(draws: &mut Draws<'_>) -> f32 {
    if draws.below(3) == 0 { f32::from_bits(draws.below(0x80_0000)) } else { any_finite(draws) }
}

/// Draws such a number below 2^127.
fn subnormal_or_less(draws: &mut Draws<'_>) -> f32 {
    if draws.below(2) == 0 { subnormal_or_any(draws).clamp(-1.0, 1.0) } else { draws.signed(-126, 126) }
}

fn directions() -> Vec<Promise> {
    const UV: &str = "environment_uv_from_direction";
    const FROM_UV: &str = "environment_direction_from_uv";
    const TEXELS: &str = "environment_texels";
    let from_uv = |uv: Vec2| {
        let (polar, azimuth) = (PI * f64::from(uv.y), TAU * (f64::from(uv.x) - 0.5));
        DVec3::new(polar.sin() * azimuth.cos(), polar.cos(), polar.sin() * azimuth.sin())
    };
    // Six times the last place of the angle itself; sine and cosine add two.
    let off = |uv: Vec2| 1e-6 * (1.0 + f64::from(uv.abs().max_element()));
    let runs_on = move |(uv,): (Vec2,), direction: Vec3| close(&direction.to_array(), &from_uv(uv).to_array(), off(uv));
    vec![
        holds(
            "environment_turns",
            "finite; a subnormal may count as zero",
            |draws| (subnormal_or_any(draws), subnormal_or_any(draws)),
            |_: (f32, f32), turns: f32| that(turns.abs() <= 0.5, || format!("{turns} turns")),
        ),
        finite("environment_hypot", "finite below 2^127; a subnormal may count as zero", |draws| {
            (subnormal_or_less(draws), subnormal_or_less(draws))
        }),
        accurate("environment_sine", "nothing", |draws| (any_finite(draws),)),
        holds(
            UV,
            "(1/2, 0) for the zero vector",
            |_| (Vec3::ZERO,),
            |_: (Vec3,), uv: Vec2| that(uv == Vec2::new(0.5, 0.0), || format!("uv is {uv}")),
        ),
        holds(
            UV,
            "subnormal components may count as zero",
            |draws| (Vec3::new(subnormal_or_less(draws), subnormal_or_less(draws), subnormal_or_less(draws)),),
            |_: (Vec3,), uv: Vec2| {
                that(uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all(), || format!("uv is {uv}"))
            },
        ),
        holds(
            FROM_UV,
            "u repeats with period 1",
            |draws| (Vec2::new(draws.between(-64.0, 64.0), draws.between(0.0, 1.0)),),
            runs_on,
        ),
        holds(
            FROM_UV,
            "v runs on over the pole, down the other side",
            |draws| (Vec2::new(draws.between(0.0, 1.0), draws.between(-2.0, 3.0)),),
            runs_on,
        ),
        holds(
            TEXELS,
            "u of either sign repeats, less exactly below 0, as long as it is finite",
            |draws| (Vec2::new(any_finite(draws), draws.between(0.0, 1.0)), small_size(draws)),
            |(_, size): (Vec2, UVec2), texels: EnvironmentTexels| {
                let inside = texels.lower.cmplt(size).all() && texels.upper.cmplt(size).all();
                let weights = texels.weight.cmpge(Vec2::ZERO).all() && texels.weight.cmple(Vec2::ONE).all();
                that(inside && weights, || format!("{texels:?} of {size}"))
            },
        ),
        like(
            TEXELS,
            "v is clamped",
            |draws| (Vec2::new(draws.between(0.0, 1.0), any_finite(draws)), small_size(draws)),
            |(uv, size): (Vec2, UVec2)| (Vec2::new(uv.x, uv.y.clamp(0.0, 1.0)), size),
        ),
    ]
}

fn lights() -> Vec<Promise> {
    const SOFTBOX: &str = "environment_softbox";
    const STUDIO: &str = "environment_studio";
    vec![
        finite("environment_harmonics", "finite for components up to 1e9", |draws| (vector_up_to(draws, 29),)),
        like(
            SOFTBOX,
            "any length of direction gives the same, as long as products stay finite",
            |draws| {
                // A power of 2 scales all computed values exactly.
                let length = 2f32.powi(draws.below(81) as i32 - 40);
                let half_size = Vec2::new(draws.between(0.1, 1.0), draws.between(0.1, 1.0));
                (length * (Vec3::Z + 0.9 * draws.in_cube()), Vec3::Z, Vec3::Y, half_size, draws.between(0.01, 0.1))
            },
            |(direction, axis, up, half_size, softness): (Vec3, Vec3, Vec3, Vec2, f32)| {
                let exponent = direction.z.log2().floor() as i32;
                (direction * 2f32.powi(-exponent), axis, up, half_size, softness)
            },
        ),
        nothing(SOFTBOX, "softness 0 has no edge to divide by"),
        holds(
            "environment_dome",
            "y beyond +-1 extrapolates",
            |draws| (100.0 * draws.in_cube(), draws.in_cube().abs(), draws.in_cube().abs()),
            |(direction, ground, zenith): (Vec3, Vec3, Vec3), radiance: Vec3| {
                let weight = (0.5 + 0.5 * f64::from(direction.y)).powi(2);
                let wanted = ground.as_dvec3() * (1.0 - weight) + zenith.as_dvec3() * weight;
                close(&radiance.to_array(), &wanted.to_array(), 2e-6 * (1.0 + weight))
            },
        ),
        like(
            STUDIO,
            "lights do not depend on the length",
            |draws| {
                // Horizontal directions, for which the dome is the same at any length.
                let azimuth = draws.between(0.0, 6.3);
                let length = 2f32.powi(draws.below(41) as i32 - 20);
                (length * Vec3::new(azimuth.cos(), 0.0, azimuth.sin()),)
            },
            |(direction,): (Vec3,)| {
                let exponent = direction.abs().max_element().log2().floor() as i32;
                (direction * 2f32.powi(-exponent),)
            },
        ),
        finite(STUDIO, "the dome extrapolates", |draws| (of_length(draws, -30, 30),)),
    ]
}
