//! Promises of the functions outside their domains, for each clause of their `Outside:` lines.

use crate::{self as veins, VeinsCell, VeinsPattern};
use glam::{IVec3, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{
    Promise, accurate, any_number, any_numbers, any_vector, close, holds, like, nothing, that,
};

/// Returns every promise of the module.
pub(super) fn promises() -> Vec<Promise> {
    let pattern = |draws: &mut Draws<'_>, least_width: i32| VeinsPattern {
        frequency: draws.magnitude(-40, 40),
        width: if draws.below(4) == 0 { -1.0 } else { draws.magnitude(least_width, 2) },
        least: draws.between(0.0, 4.0),
        greatest: draws.between(0.0, 4.0),
        octaves: any_number(draws),
        seed: draws.bits(),
    };
    let between = |(_, pattern): (Vec3, VeinsPattern), density: f32| {
        let (low, high) = (pattern.least.min(pattern.greatest), pattern.least.max(pattern.greatest));
        that((low - 1e-5..=high + 1e-5).contains(&density), || format!("the density is {density}"))
    };
    vec![
        accurate("veins_cell", "nothing", |draws| (any_vector(draws),)),
        accurate("veins_hash", "nothing", |draws| {
            let corner = any_numbers(draws).to_array().map(u32::cast_signed);
            (IVec3::from_array(corner), any_number(draws))
        }),
        accurate("veins_gradient", "nothing", |draws| (any_number(draws),)),
        holds(
            "veins_corner",
            "the plane goes on",
            |draws| {
                let cell = VeinsCell { corner: IVec3::new(1, -2, 3), offset: 16.0 * draws.in_cube() };
                let corner = IVec3::new(draws.below(8) as i32, draws.below(8) as i32, draws.below(8) as i32);
                (cell, corner, draws.bits())
            },
            |(cell, corner, seed): (VeinsCell, IVec3, u32), value: f32| {
                let gradient = veins::gradient(veins::hash(cell.corner + corner, seed)).as_dvec3();
                close(&[value], &[gradient.dot(cell.offset.as_dvec3() - corner.as_dvec3())], 1e-5)
            },
        ),
        accurate("veins_noise", "nothing", |draws| (any_vector(draws), any_number(draws))),
        holds(
            "veins_fractal",
            "positions up to 2^120 are clamped for each octave",
            |draws| (any_vector(draws) / 256.0, draws.below(9), draws.bits()),
            |_: (Vec3, u32, u32), sum: f32| that(sum.abs() <= 2.2, || format!("the sum is {sum}")),
        ),
        like(
            "veins_fractal",
            "more octaves count as 8",
            |draws| (100.0 * draws.in_cube(), 8u32.saturating_add(any_number(draws)), draws.bits()),
            |(position, _, seed): (Vec3, u32, u32)| (position, 8, seed),
        ),
        nothing("veins_fold", "anything where the value's square overflows"),
        holds(
            "veins_density",
            "as veins_fractal and veins_fold",
            // The pattern scales the positions, which could then overflow; hence the factor.
            move |draws| (1e-20 * any_vector(draws), pattern(draws, -4)),
            between,
        ),
        holds(
            "veins_density",
            "a smaller width is as accurate as the noise, whose error it magnifies by its inverse",
            move |draws| (100.0 * draws.in_cube(), pattern(draws, -40)),
            between,
        ),
    ]
}
