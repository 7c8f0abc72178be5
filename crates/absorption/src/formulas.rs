//! Test inputs, edges, invariants and hard cases of `wgsl/absorption.wgsl`.

mod outside;

use crate::{self as mirror, ABSORPTION_DARKEST, ABSORPTION_FARTHEST, ABSORPTION_NEAREST, oracle};
use glam::Vec3;
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};

const M: &str = "absorption";

/// A few units in the last place of f32.
const ROUNDING: f64 = 16.0 / (1 << 24) as f64;

/// Draws a colour component or a transmittance: anywhere in [0, 1], close to 1 at every magnitude,
/// at every magnitude down to the darkest, or out of range.
fn share(draws: &mut Draws<'_>) -> f32 {
    match draws.below(8) {
        0 => draws.pick(&[1.0, 0.0, 1.0f32.next_up(), 1.0f32.next_down(), 2.0, -1.0, ABSORPTION_DARKEST, 1e-40]),
        1 | 2 => 1.0 - draws.magnitude(-24, -2),
        3 => draws.magnitude(-126, -1),
        // Around the points at which the reduction of the logarithm switches: the square root of
        // 1/2, its double and its half.
        4 => draws.between(0.7, 0.715) * draws.pick(&[1.0, 0.5, 2.0]),
        _ => draws.between(0.0, 1.0),
    }
}

fn color(draws: &mut Draws<'_>) -> Vec3 {
    let first = share(draws);
    if draws.below(2) == 0 { Vec3::splat(first) } else { Vec3::new(first, share(draws), share(draws)) }
}

/// Draws an attenuation distance: ordinary, of every magnitude, around the limits, or one at which
/// nothing is absorbed.
fn attenuation_distance(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[1.0, 0.0, -1.0, -1e-3, ABSORPTION_FARTHEST, 1e38, 1e-37]),
        1 => ABSORPTION_FARTHEST * draws.between(0.98, 1.02),
        2 => ABSORPTION_NEAREST * draws.between(0.96, 1.04),
        3 => draws.magnitude(-125, 120),
        _ => draws.magnitude(-10, 10),
    }
}

/// Draws a coefficient and a distance, for optical depths of every magnitude, around the underflow
/// of f32, and 0.
fn path(draws: &mut Draws<'_>) -> (Vec3, f32) {
    let distance = match draws.below(8) {
        0 => draws.pick(&[1.0, 0.0, -1.0, -1e-3, -1e6]),
        1 | 2 => draws.magnitude(-30, 19),
        _ => draws.magnitude(-4, 4),
    };
    let mut depth = || match draws.below(7) {
        0 => 0.0,
        // Without rounding if the distance is 1.
        6 => 0.5f32.powi(draws.below(12) as i32),
        1 => draws.magnitude(-40, 7),
        2 => draws.between(80.0, 95.0),
        _ => draws.between(0.0, 8.0),
    };
    let depths = Vec3::new(depth(), depth(), depth());
    let depths = if draws.below(2) == 0 { Vec3::splat(depths.x) } else { depths };
    // A path of length 0 may cross any medium.
    (if distance > 0.0 { depths / distance } else { depths }, distance)
}

fn benign_color(draws: &mut Draws<'_>) -> Vec3 {
    Vec3::new(draws.between(0.01, 0.9), draws.between(0.01, 0.9), draws.between(0.01, 0.9))
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    let nearly_clear = 1.0f32.next_down();
    // -ln(1 - h) with h = 2^-24.
    let clear_depth = 2f64.powi(-24) + 2f64.powi(-49);
    let splat = |value: f64| [value; 3];
    vec![
        formula(M, "absorption_optical_depth", mirror::optical_depth, oracle::optical_depth, |draws| (share(draws),))
            .edge("clear", |(transmittance,)| transmittance == 1.0)
            .edge("one ulp from clear", |(transmittance,)| transmittance == 1.0f32.next_down())
            .edge("above 1", |(transmittance,)| transmittance > 1.0)
            .edge("black", |(transmittance,)| transmittance == 0.0)
            .edge("darker than any color that counts", |(transmittance,)| {
                (f32::MIN_POSITIVE / 2.0..f32::MIN_POSITIVE).contains(&transmittance) || transmittance == 1e-40
            })
            .invariant("not negative, 0 exactly where all passes", |(transmittance,), depth: f32| {
                let right = if transmittance >= 1.0 { depth == 0.0 } else { depth > 0.0 };
                if right { Ok(()) } else { Err(format!("the depth is {depth:e}")) }
            })
            .build(),
        formula(M, "absorption_coefficient", mirror::coefficient, oracle::coefficient, |draws| {
            (color(draws), attenuation_distance(draws))
        })
        .edge("the farthest that absorbs", |(_, distance)| {
            (0.999 * ABSORPTION_FARTHEST..ABSORPTION_FARTHEST).contains(&distance)
        })
        .edge("the nearest that does not", |(_, distance)| distance == ABSORPTION_FARTHEST)
        .edge("shorter than the shortest that counts", |(_, distance)| distance > 0.0 && distance < ABSORPTION_NEAREST)
        .edge("no distance", |(_, distance)| distance == 0.0)
        .edge("a negative distance", |(_, distance)| distance < 0.0)
        .edge("colorless", |(color, _)| color == Vec3::ONE)
        .edge("black", |(color, _)| color == Vec3::ZERO)
        .invariant("a clear channel absorbs nothing", |(color, _), coefficient: Vec3| {
            let clear = color.cmpge(Vec3::ONE);
            let wrong = (0..3).any(|channel| clear.test(channel) && coefficient[channel] != 0.0);
            if wrong { Err(format!("the coefficient is {coefficient}")) } else { Ok(()) }
        })
        .invariant("the color is what is left at its distance", |(color, distance), coefficient: Vec3| {
            if !(ABSORPTION_NEAREST..ABSORPTION_FARTHEST).contains(&distance) {
                return Ok(());
            }
            (0..3).try_for_each(|channel| {
                let wanted = f64::from(color[channel].clamp(ABSORPTION_DARKEST, 1.0));
                let depth = f64::from(coefficient[channel]) * f64::from(distance);
                // The bound covers the last places of a depth of up to 88.
                near("color", (-depth).exp(), wanted, (1.0 + depth) * ROUNDING * wanted + f64::from(f32::MIN_POSITIVE))
            })
        })
        .hard_case(
            "one ulp from colorless",
            (Vec3::splat(nearly_clear), 1.0),
            (&splat(clear_depth), 1e-14),
            ("absorption_coefficient_naive", 1e-9),
        )
        .hard_case(
            "a color of 0.999",
            (Vec3::splat(0.999), 1.0),
            (&splat(-f64::from(0.999f32).ln()), 2e-10),
            ("absorption_coefficient_naive", 5e-9),
        )
        .hard_case(
            "black",
            (Vec3::ZERO, 1.0),
            (&splat(126.0 * std::f64::consts::LN_2), 2e-5),
            ("absorption_coefficient_naive", f64::INFINITY),
        )
        .hard_case(
            "no distance",
            (Vec3::splat(0.5), 0.0),
            (&splat(0.0), 0.0),
            ("absorption_coefficient_naive", f64::INFINITY),
        )
        .hard_case(
            "a negative distance",
            (Vec3::splat(0.5), -1.0),
            (&splat(0.0), 0.0),
            ("absorption_coefficient_naive", 0.5),
        )
        .build(),
        formula(M, "absorption_coefficient_naive", mirror::coefficient_naive, oracle::coefficient, |draws| {
            (benign_color(draws), draws.magnitude(-9, 9))
        })
        .benign(1e-5)
        .build(),
        formula(M, "absorption_transmittance", mirror::transmittance, oracle::transmittance, path)
            .edge("no absorption", |(coefficient, _)| coefficient == Vec3::ZERO)
            .edge("no distance", |(coefficient, distance)| distance == 0.0 && coefficient.x > 0.0)
            .edge("a negative distance", |(coefficient, distance)| distance < 0.0 && coefficient.x > 0.0)
            .edge("an optical depth below 1e-8", |(coefficient, distance)| {
                (1e-20..1e-8).contains(&(coefficient.x * distance))
            })
            .edge("underflow", |(coefficient, distance)| coefficient.x * distance > 89.0)
            .invariant("a share", |_, left: Vec3| {
                if left.cmpge(Vec3::ZERO).all() && left.cmple(Vec3::ONE).all() {
                    Ok(())
                } else {
                    Err(format!("the transmittance is {left}"))
                }
            })
            .invariant("nothing is lost without a medium or a way", |(coefficient, distance), left: Vec3| {
                let clear = (0..3).filter(|channel| coefficient[*channel] == 0.0 || distance <= 0.0);
                let lost = clear.into_iter().find(|channel| left[*channel] != 1.0);
                lost.map_or(Ok(()), |channel| Err(format!("channel {channel} is {:e}", left[channel])))
            })
            .pair("two paths multiply", |(coefficient, distance)| (coefficient, 2.0 * distance), {
                |(coefficient, distance), once: Vec3, twice: Vec3| {
                    (0..3).try_for_each(|channel| {
                        let depth = f64::from(coefficient[channel]) * f64::from(distance.max(0.0));
                        let square = f64::from(once[channel]).powi(2);
                        // At larger depths the factors themselves may be flushed to 0.
                        if depth > 80.0 {
                            return Ok(());
                        }
                        let bound = (1.0 + 2.0 * depth) * ROUNDING * square + f64::from(f32::MIN_POSITIVE);
                        near("the double path", f64::from(twice[channel]), square, bound)
                    })
                }
            })
            .hard_case_with(
                "an attenuation distance of 0, and no way to go",
                (mirror::coefficient(Vec3::splat(0.5), 0.0), 0.0),
                (&splat(1.0), 0.0),
                ("absorption_transmittance_naive", (Vec3::splat(0.5), 0.0, 0.0), f64::INFINITY),
            )
            .hard_case_with(
                "an attenuation distance of 0 means no absorption",
                (mirror::coefficient(Vec3::splat(0.5), 0.0), 2.0),
                (&splat(1.0), 0.0),
                ("absorption_transmittance_naive", (Vec3::splat(0.5), 0.0, 2.0), 0.9),
            )
            .hard_case_with(
                "a nearly colorless medium, ten million attenuation distances long",
                (mirror::coefficient(Vec3::splat(nearly_clear), 1.0), 1e7),
                (&splat((-clear_depth * 1e7).exp()), 1e-7),
                ("absorption_transmittance_naive", (Vec3::splat(nearly_clear), 1.0, 1e7), 0.01),
            )
            .build(),
        formula(
            M,
            "absorption_transmittance_naive",
            mirror::transmittance_naive,
            |color, attenuation_distance, distance| {
                oracle::transmittance(oracle::coefficient(color, attenuation_distance), distance)
            },
            |draws| {
                let attenuation_distance = draws.magnitude(-9, 9);
                (benign_color(draws), attenuation_distance, attenuation_distance * draws.between(0.0, 4.0))
            },
        )
        .benign(4e-5)
        .build(),
    ]
}
