//! `wgsl/veins.wgsl`.

mod outside;

use crate::{self as mirror, VeinsCell, VeinsPattern, oracle};
use glam::{IVec3, UVec3, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;

mirror_struct!(crate, VeinsCell { corner, offset });
mirror_struct!(crate, VeinsPattern { frequency, width, least, greatest, octaves, seed });

const M: &str = "veins";

/// Draws a coordinate: on a border or next to it, of any magnitude and either sign, or anywhere
/// near the origin.
fn coordinate(draws: &mut Draws<'_>, largest: i32) -> f32 {
    match draws.below(5) {
        0 => draws.pick(&[0.0, 1.0, -1.0, -0.25, 0.5]),
        1 => draws.nudged(1.0, 2) * draws.pick(&[1.0, -1.0, 2.0]),
        2 => draws.signed(-20, largest),
        _ => draws.between(-8.0, 8.0),
    }
}

fn position(draws: &mut Draws<'_>, largest: i32) -> Vec3 {
    Vec3::new(coordinate(draws, largest), coordinate(draws, largest), coordinate(draws, largest))
}

fn integer(draws: &mut Draws<'_>) -> i32 {
    match draws.below(3) {
        0 => draws.pick(&[0, 1, -1, 4_194_304, -4_194_304]),
        _ => draws.bits().cast_signed() >> 9,
    }
}

fn corner(draws: &mut Draws<'_>) -> IVec3 {
    IVec3::new(integer(draws), integer(draws), integer(draws))
}

fn seed(draws: &mut Draws<'_>) -> u32 {
    if draws.below(4) == 0 { draws.pick(&[0, 1, u32::MAX]) } else { draws.bits() }
}

/// Draws a width: in the useful range, of any magnitude, or one that is clamped.
fn width(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => draws.pick(&[1.0, mirror::VEINS_NARROWEST, 0.0, -1.0, 1e-5, mirror::VEINS_WIDEST, 1e30]),
        1 => draws.magnitude(-12, 4),
        _ => draws.between(0.0625, 1.0),
    }
}

fn pattern(draws: &mut Draws<'_>) -> VeinsPattern {
    VeinsPattern {
        frequency: draws.magnitude(-6, 4),
        width: draws.between(0.0625, 4.0),
        least: draws.between(0.0, 4.0),
        greatest: draws.between(0.0, 4.0),
        octaves: draws.below(9),
        seed: seed(draws),
    }
}

/// Returns whether a coordinate is a whole number.
fn whole(x: f32) -> bool {
    x.fract() == 0.0
}

/// Returns every function of the module, bound to its mirror and its oracle, with its promises
/// outside its domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [cells(), noises(), folds()].into_iter().flatten().collect()
}

fn cells() -> Vec<Formula> {
    const NAIVE: &str = "veins_cell_naive";
    vec![
        formula(M, "veins_cell", mirror::cell, oracle::cell, |draws| (position(draws, 30),))
            .edge("a corner", |(p,)| p.to_array().iter().all(|x| whole(*x)))
            .edge("just below a border", |(p,)| p.x == 1.0f32.next_down())
            .edge("negative", |(p,)| p.max_element() < 0.0)
            .edge("too far", |(p,)| p.x > mirror::VEINS_FARTHEST)
            .edge("too far on the other side", |(p,)| p.y < -mirror::VEINS_FARTHEST)
            .invariant("offset in [0, 1]", |_, cell: VeinsCell| {
                let inside = cell.offset.cmpge(Vec3::ZERO).all() && cell.offset.cmple(Vec3::ONE).all();
                if inside { Ok(()) } else { Err(format!("{}", cell.offset)) }
            })
            .hard_case(
                "a negative coordinate",
                (Vec3::new(-0.25, 0.25, 0.5),),
                (&[-1.0, 0.0, 0.0, 0.75, 0.25, 0.5], 0.0),
                (NAIVE, 0.9),
            )
            .build(),
        formula(M, "veins_cell_naive", mirror::cell_naive, oracle::cell_naive, |draws| {
            (Vec3::new(draws.magnitude(-4, 18), draws.magnitude(-4, 18), draws.magnitude(-4, 18)),)
        })
        .benign(1e-6)
        .build(),
        formula(M, "veins_hash", mirror::hash, oracle::hash, |draws| (corner(draws), seed(draws)))
            .edge("the origin", |(c, _)| c == IVec3::ZERO)
            .edge("negative", |(c, _)| c.max_element() < 0)
            .build(),
        formula(M, "veins_gradient", mirror::gradient, oracle::gradient, |draws| (draws.bits(),))
            .edge("each axis", |(bits,)| bits % 3 == 2)
            .invariant("along an edge's middle", |_, gradient: Vec3| {
                near("squared length", gradient.length_squared().into(), 2.0, 0.0)
            })
            .build(),
        formula(M, "veins_corner", mirror::corner, oracle::corner, |draws| {
            let offset = Vec3::new(draws.between(0.0, 1.0), draws.between(0.0, 1.0), draws.between(0.0, 1.0));
            let number = draws.below(8);
            let vertex = UVec3::new(number & 1, number >> 1 & 1, number >> 2).as_ivec3();
            (VeinsCell { corner: corner(draws), offset }, vertex, seed(draws))
        })
        .invariant("within [-2, 2]", |_, value: f32| near("value", value.into(), 0.0, 2.0))
        .build(),
    ]
}

fn noises() -> Vec<Formula> {
    vec![
        formula(M, "veins_noise", mirror::noise, oracle::noise, |draws| (position(draws, 24), seed(draws)))
            .edge("a corner", |(p, _)| p.to_array().iter().all(|x| whole(*x)))
            .edge("just below a border", |(p, _)| p.x == 1.0f32.next_down() && !whole(p.y))
            .edge("far out", |(p, _)| p.abs().max_element() > 1e6)
            .edge("negative", |(p, _)| p.max_element() < 0.0)
            .invariant("bounded, and 0 at corners", |(p, _), value: f32| {
                let corner = p.to_array().iter().all(|x| whole(*x));
                near("noise", value.into(), 0.0, if corner { 0.0 } else { 1.1 })
            })
            .pair(
                "no step across a border",
                |(p, seed)| (p.with_x(p.x.round().next_down()), seed),
                |(p, _), one: f32, other: f32| {
                    let step = f64::from(p.x - p.x.round().next_down()).abs();
                    // The slope is at most about 4.
                    if step < 1e-3 { near("step", f64::from(one - other), 0.0, 4.0 * step + 1e-5) } else { Ok(()) }
                },
            )
            .build(),
        formula(M, "veins_fractal", mirror::fractal, oracle::fractal, |draws| {
            (position(draws, 15), draws.below(12), seed(draws))
        })
        .edge("no octave", |(_, octaves, _)| octaves == 0)
        .edge("more octaves than there are", |(_, octaves, _)| octaves > 8)
        .edge("a seed that wraps", |(_, octaves, seed)| seed == u32::MAX && octaves > 1)
        .invariant("bounded", |_, value: f32| near("sum", value.into(), 0.0, 2.2))
        .build(),
    ]
}

fn folds() -> Vec<Formula> {
    const NAIVE: &str = "veins_fold_naive";
    vec![
        formula(M, "veins_fold", mirror::fold, oracle::fold, |draws| {
            let value = if draws.below(3) == 0 { draws.signed(-30, 1) } else { draws.between(-4.0, 4.0) };
            (value, width(draws))
        })
        .edge("no width", |(value, width)| width == 0.0 && value != 0.0)
        .edge("the narrowest", |(_, width)| width == mirror::VEINS_NARROWEST)
        .edge("a negative width", |(_, width)| width < 0.0)
        .edge("a width whose square overflows", |(value, width)| width == 1e30 && value != 0.0)
        .invariant("in [0, 1]", |_, share: f32| near("share", share.into(), 0.5, 0.5))
        .hard_case("four widths away", (1.0, 0.25), (&[1.0 / 17.0], 1e-7), (NAIVE, 1.0))
        .hard_case("no width in the middle", (0.0, 0.0), (&[1.0], 0.0), (NAIVE, f64::INFINITY))
        .build(),
        formula(M, "veins_fold_naive", mirror::fold_naive, oracle::fold_naive, |draws| {
            let width = draws.between(0.1, 1.0);
            (draws.between(-0.5, 0.5) * width, width)
        })
        .benign(1e-6)
        .build(),
        formula(M, "veins_density", mirror::density, oracle::density, |draws| {
            let pattern = pattern(draws);
            (position(draws, 8), pattern)
        })
        .edge("uniform", |(_, pattern)| pattern.octaves == 0)
        .edge("thinner in the veins", |(_, pattern)| pattern.octaves > 0 && pattern.greatest < pattern.least)
        .edge("far out", |(p, pattern)| p.abs().max_element() * pattern.frequency > 1e3)
        .invariant("within its bounds", |(_, pattern), density: f32| {
            let (least, greatest) = (pattern.least.min(pattern.greatest), pattern.least.max(pattern.greatest));
            let slack = 1e-6 * greatest;
            let inside = (least - slack..=greatest + slack).contains(&density);
            if inside { Ok(()) } else { Err(format!("{density} of {least} to {greatest}")) }
        })
        .build(),
    ]
}
