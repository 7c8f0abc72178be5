//! Test inputs, edges, invariants and hard cases of `wgsl/optical_path.wgsl`.

mod outside;

use crate::{self as mirror, OPTICAL_PATH_DARKEST, OPTICAL_PATH_DEEPEST, OPTICAL_PATH_UNREACHED, oracle};
use glam::{Vec3, Vec3Swizzles as _};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};

const M: &str = "optical_path";

/// A few units in the last place of f32.
const ROUNDING: f64 = 16.0 / (1 << 24) as f64;

/// Draws a cost: ordinary, 0, every magnitude, near unreached, unreached, and above it.
fn cost(draws: &mut Draws<'_>) -> f32 {
    match draws.below(8) {
        0 => draws.pick(&[0.0, OPTICAL_PATH_UNREACHED, 3e38, OPTICAL_PATH_UNREACHED.next_down()]),
        1 => OPTICAL_PATH_UNREACHED * draws.between(0.5, 4.0),
        2 => draws.magnitude(-126, 126),
        _ => draws.between(0.0, 20.0),
    }
}

/// Draws an extinction: ordinary, 0, every magnitude.
fn extinction(draws: &mut Draws<'_>) -> f32 {
    match draws.below(5) {
        0 => draws.pick(&[0.0, 1e-8, 1e8, 1e15]),
        1 => draws.magnitude(-60, 49),
        _ => draws.between(0.0, 10.0),
    }
}

/// Draws a length or an offset, including 0.
fn length(draws: &mut Draws<'_>) -> f32 {
    match draws.below(5) {
        0 => draws.pick(&[1.0, 0.0, 1e14]),
        1 => draws.magnitude(-60, 46),
        _ => draws.between(0.0, 3.0),
    }
}

/// Draws a share of irradiance: anywhere in [0, 1], next to 1, next to 0, and out of range.
fn share(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[1.0, 0.0, -1.0, 2.0, 1e-40, OPTICAL_PATH_DARKEST, 1.0f32.next_up(), 1.0f32.next_down()]),
        1 => 1.0 - draws.magnitude(-24, -2),
        2 => draws.magnitude(-126, -1),
        3 => OPTICAL_PATH_DARKEST * draws.between(1.0, 1.03),
        _ => draws.between(0.0, 1.0),
    }
}

/// Draws the least neighbours on three axes, and the slowness. The neighbours differ by about the
/// slowness, by every magnitude, or not at all, or are unreached, in every order. They are on top
/// of costs from 0 to values that swallow the slowness.
fn upwind(draws: &mut Draws<'_>) -> (Vec3, f32) {
    let slowness = match draws.below(6) {
        0 => draws.pick(&[1.0, 0.0, 1e-30, 1e15]),
        1 => draws.magnitude(-99, 49),
        _ => draws.between(0.01, 2.0),
    };
    let base = match draws.below(6) {
        0 => 0.0,
        1 => slowness * draws.magnitude(-4, 30),
        2 => draws.magnitude(-99, 99),
        // Sums of exact numbers.
        3 => slowness * draws.below(16) as f32,
        _ => draws.between(0.0, 20.0),
    };
    let mut rise = || match draws.below(8) {
        0 => 0.0,
        1 => OPTICAL_PATH_UNREACHED,
        2 => slowness * draws.magnitude(-20, 4),
        // Near the rise at which an axis begins to count.
        3 => slowness * draws.between(0.69, 0.72),
        4 => slowness * draws.between(0.98, 1.02),
        _ => slowness * draws.between(0.0, 1.2),
    };
    let rises = [0.0, rise(), rise()];
    let order = draws.pick(&[[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]]);
    let least = order.map(|place| (base + rises[place]).min(OPTICAL_PATH_UNREACHED));
    (if draws.below(16) == 0 { Vec3::splat(OPTICAL_PATH_UNREACHED) } else { Vec3::from(least) }, slowness)
}

/// Draws an input for which the quadratic formula is accurate.
fn benign_upwind(draws: &mut Draws<'_>) -> (Vec3, f32) {
    (2.0 * Vec3::new(draws.unit() as f32, draws.unit() as f32, draws.unit() as f32), draws.between(0.5, 2.0))
}

/// Checks the share of the slowness that the update adds to the least neighbour: 1, 1/√2 and 1/√3
/// for one, two and three equal neighbours.
fn rise_within_bounds((least, slowness): (Vec3, f32), cost: f32) -> Result<(), String> {
    let first = f64::from(least.min_element());
    let (slowness, cost) = (f64::from(slowness), f64::from(cost));
    let unreached = f64::from(OPTICAL_PATH_UNREACHED);
    let margin = ROUNDING * cost + f64::from(f32::MIN_POSITIVE);
    let low = (first + slowness / 3f64.sqrt()).min(unreached) - margin;
    let high = (first + slowness).min(unreached) + margin;
    if (low..=high).contains(&cost) {
        Ok(())
    } else {
        Err(format!("the cost {cost:e} lies outside [{low:e}, {high:e}]"))
    }
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [on_graphs(), on_grids(), of_light()].into_iter().flatten().collect()
}

/// Returns the formulas for edges, relaxation and encoding.
fn on_graphs() -> Vec<Formula> {
    vec![
        formula(M, "optical_path_edge", mirror::edge, oracle::edge, |draws| {
            (extinction(draws), extinction(draws), length(draws))
        })
        .edge("no extinction", |(a, b, _)| a == 0.0 && b == 0.0)
        .edge("much beside little", |(a, b, _)| a > 1e6 && b < 1e-6)
        .edge("the largest", |(a, _, length)| a == 1e15 && length == 1e14)
        .pair(
            "symmetric to the bit",
            |(a, b, length)| (b, a, length),
            |_, there: f32, back: f32| {
                if there.to_bits() == back.to_bits() { Ok(()) } else { Err(format!("{there:e} there, {back:e} back")) }
            },
        )
        .hard_case_with(
            "a grid twice as fine",
            (1.0, 1.0, 0.5),
            (&[0.5], 0.0),
            ("optical_path_edge_paper", (1.0f32, 1.0f32), 0.5),
        )
        .hard_case_with(
            "a neighbour across a corner",
            (1.0, 1.0, 1.7320508),
            (&[3f64.sqrt()], 1e-7),
            ("optical_path_edge_paper", (1.0f32, 1.0f32), 0.7),
        )
        .build(),
        formula(M, "optical_path_edge_paper", mirror::edge_paper, oracle::edge_paper, |draws| {
            (extinction(draws), extinction(draws))
        })
        .benign(1e-6)
        .build(),
        formula(M, "optical_path_relax", mirror::relax, oracle::relax, |draws| {
            let edge = match draws.below(4) {
                0 => draws.pick(&[0.0, 1e30]),
                1 => draws.magnitude(-100, 99),
                _ => draws.between(0.0, 5.0),
            };
            (cost(draws), cost(draws), edge)
        })
        .edge("an unreached neighbour", |(_, neighbour, _)| neighbour == OPTICAL_PATH_UNREACHED)
        .edge("next to unreached", |(_, neighbour, _)| neighbour == OPTICAL_PATH_UNREACHED.next_down())
        .edge("an unreached node", |(cost, neighbour, _)| cost == OPTICAL_PATH_UNREACHED && neighbour < 1e3)
        .edge("both beyond", |(cost, neighbour, _)| cost > neighbour && neighbour > OPTICAL_PATH_UNREACHED)
        .invariant("never more than it was", |(cost, _, _), relaxed: f32| {
            if relaxed <= cost { Ok(()) } else { Err(format!("{relaxed:e} from {cost:e}")) }
        })
        .build(),
        formula(M, "optical_path_encode", mirror::encode, oracle::encode, |draws| {
            let any = match draws.below(4) {
                0 => draws.pick(&[
                    0.0,
                    -0.0,
                    f32::INFINITY,
                    f32::NEG_INFINITY,
                    f32::NAN,
                    -f32::NAN,
                    -1.0,
                    f32::MIN,
                    // The last NaN without a sign bit, and the first with one.
                    f32::from_bits(0x7fff_ffff),
                    f32::from_bits(0xff80_0001),
                ]),
                1 => f32::from_bits(draws.bits()),
                _ => cost(draws),
            };
            (draws.nudged(any, 1),)
        })
        .edge("minus zero", |(cost,)| cost.to_bits() == 1 << 31)
        .edge("negative", |(cost,)| cost < 0.0)
        .edge("infinite", |(cost,)| cost == f32::INFINITY)
        .edge("infinite and negative", |(cost,)| cost == f32::NEG_INFINITY)
        .edge("no number", |(cost,)| cost.is_nan() && cost.is_sign_positive())
        .edge("no number, and negative", |(cost,)| cost.is_nan() && cost.is_sign_negative())
        .edge("unreached", |(cost,)| cost == OPTICAL_PATH_UNREACHED)
        .edge("subnormal", |(cost,)| cost > 0.0 && cost < f32::MIN_POSITIVE)
        .pair(
            "ordered as costs are",
            |(cost,)| (0.75 * cost,),
            |(cost,), bits: u32, less: u32| {
                let right = if cost.is_nan() { less == bits } else { less <= bits };
                if right { Ok(()) } else { Err(format!("{bits:#x}, and {less:#x} for three quarters")) }
            },
        )
        .build(),
        formula(M, "optical_path_decode", mirror::decode, oracle::decode, |draws| {
            (match draws.below(3) {
                0 => draws.bits(),
                1 => OPTICAL_PATH_UNREACHED.to_bits() - 4 + draws.below(8),
                _ => cost(draws).to_bits(),
            },)
        })
        .edge("no cost", |(bits,)| bits > f32::INFINITY.to_bits())
        .invariant("a cost", |_, cost: f32| {
            if (0.0..=OPTICAL_PATH_UNREACHED).contains(&cost) { Ok(()) } else { Err(format!("{cost:e}")) }
        })
        .build(),
    ]
}

/// Returns the formulas for Godunov's update.
fn on_grids() -> Vec<Formula> {
    let f = 0.01f32;
    let alike = |cost: f32, count: f64| [f64::from(cost) + f64::from(f) / count.sqrt()];
    vec![
        formula(M, "optical_path_godunov", mirror::godunov, oracle::godunov, upwind)
            .edge("one axis", |(least, slowness)| {
                let mut sorted = least.to_array();
                sorted.sort_by(f32::total_cmp);
                sorted[1] - sorted[0] > slowness && slowness > 0.0
            })
            .edge("two axes", |(least, slowness)| {
                let mut sorted = least.to_array();
                sorted.sort_by(f32::total_cmp);
                sorted[1] - sorted[0] < 0.9 * slowness && sorted[2] - sorted[0] > slowness
            })
            .edge("three alike", |(least, slowness)| least == Vec3::splat(least.x) && least.x > 1.0 && slowness > 0.0)
            .edge("no slowness", |(_, slowness)| slowness == 0.0)
            .edge("all unreached", |(least, _)| least == Vec3::splat(OPTICAL_PATH_UNREACHED))
            .edge("swallowed", |(least, slowness)| {
                slowness > 0.0 && least.min_element() > 1e9 * slowness && least.max_element() < 1e29
            })
            .invariant("between the third part and the whole of a step", rise_within_bounds)
            .pair(
                "the axes do not matter",
                |(least, slowness)| (least.yzx(), slowness),
                |_, one: f32, other: f32| {
                    if one.to_bits() == other.to_bits() { Ok(()) } else { Err(format!("{one:e} and {other:e}")) }
                },
            )
            .pair(
                "four times as far at four times the cost",
                |(least, slowness)| (4.0 * least, 4.0 * slowness),
                |(least, slowness), once: f32, four: f32| {
                    // Unreached does not scale, and a slowness this small rounds differently.
                    if least.max_element() > 1e29 || slowness < 1e-35 {
                        return Ok(());
                    }
                    near("the cost", f64::from(four), 4.0 * f64::from(once), 0.0)
                },
            )
            .hard_case(
                "three neighbours alike, large beside the slowness",
                (Vec3::splat(100.0), f),
                (&alike(100.0, 3.0), 8e-6),
                ("optical_path_godunov_naive", 5e-3),
            )
            .hard_case(
                "two neighbours alike, large beside the slowness",
                (Vec3::new(300.0, 900.0, 300.0), f),
                (&alike(300.0, 2.0), 4e-5),
                ("optical_path_godunov_naive", 5e-3),
            )
            .hard_case(
                "a radicand that rounding makes negative",
                (Vec3::new(1000.1, 1000.1625, OPTICAL_PATH_UNREACHED), 0.125),
                // With d = 1/16 between the two, the cost is half of d + √(2 slowness² - d²) above
                // the lesser.
                (&[f64::from(1000.1f32) + 0.5 * (0.0625 + (2.0 * 0.125f64.powi(2) - 0.0625f64.powi(2)).sqrt())], 7e-5),
                ("optical_path_godunov_naive", f64::INFINITY),
            )
            .hard_case(
                "costs whose squares overflow",
                (Vec3::splat(1e20), 1e18),
                (&[f64::from(1e20f32) + f64::from(1e18f32) / 3f64.sqrt()], 1e13),
                ("optical_path_godunov_naive", f64::INFINITY),
            )
            .build(),
        formula(M, "optical_path_godunov_naive", mirror::godunov_naive, oracle::godunov, benign_upwind)
            .benign(4e-6)
            .build(),
    ]
}

/// Returns the formulas for light that enters, for the lookup and for luminance.
fn of_light() -> Vec<Formula> {
    vec![
        formula(M, "optical_path_seed", mirror::seed, oracle::seed, |draws| {
            (share(draws), extinction(draws), length(draws))
        })
        .edge("all there is", |(share, _, _)| share == 1.0)
        .edge("more than that", |(share, _, _)| share > 1.0)
        .edge("nothing", |(share, _, _)| share == 0.0)
        .edge("less than nothing", |(share, _, _)| share < 0.0)
        .edge("the least that counts", |(share, _, _)| share == OPTICAL_PATH_DARKEST)
        .edge("less than that", |(share, _, _)| share == 1e-40)
        .invariant("not negative", |_, cost: f32| if cost >= 0.0 { Ok(()) } else { Err(format!("{cost:e}")) })
        .hard_case("no light", (0.0, 1.0, 1.0), (&[1e30], 1e23), ("optical_path_seed_naive", f64::INFINITY))
        .hard_case("light from behind", (-0.5, 1.0, 1.0), (&[1e30], 1e23), ("optical_path_seed_naive", f64::INFINITY))
        .hard_case("more than the largest share", (4.0, 1.0, 0.0), (&[0.0], 0.0), ("optical_path_seed_naive", 1.3))
        .build(),
        formula(M, "optical_path_seed_naive", mirror::seed_naive, oracle::seed, |draws| {
            (draws.between(0.01, 0.9), draws.between(0.0, 10.0), draws.between(0.0, 10.0))
        })
        .benign(4e-6)
        .build(),
        formula(M, "optical_path_through", mirror::through, oracle::through, |draws| {
            (cost(draws), extinction(draws), length(draws))
        })
        .edge("an unreached node", |(cost, _, _)| cost == OPTICAL_PATH_UNREACHED)
        .edge("next to unreached", |(cost, extinction, offset)| {
            cost < OPTICAL_PATH_UNREACHED && cost > 1e29 && extinction * offset > 0.0
        })
        .edge("no way", |(cost, extinction, offset)| cost < 1e3 && extinction * offset == 0.0)
        .invariant("no less than the node", |(cost, _, _), through: f32| {
            let least = cost.min(OPTICAL_PATH_UNREACHED);
            if (least..=OPTICAL_PATH_UNREACHED).contains(&through) { Ok(()) } else { Err(format!("{through:e}")) }
        })
        .build(),
        formula(M, "optical_path_luminance", mirror::luminance, oracle::luminance, |draws| {
            (match draws.below(4) {
                0 => {
                    draws.nudged(OPTICAL_PATH_DEEPEST, 2)
                        * if draws.below(2) == 0 { 1.0 } else { draws.between(0.99, 1.01) }
                }
                1 => draws.magnitude(-40, 6),
                2 => cost(draws),
                _ => draws.between(0.0, 20.0),
            },)
        })
        .edge("lit in full", |(cost,)| cost == 0.0)
        .edge("just above the deepest", |(cost,)| cost > 0.9995 * OPTICAL_PATH_DEEPEST && cost < OPTICAL_PATH_DEEPEST)
        .edge("just below it", |(cost,)| (OPTICAL_PATH_DEEPEST..1.0005 * OPTICAL_PATH_DEEPEST).contains(&cost))
        .edge("unreached", |(cost,)| cost == OPTICAL_PATH_UNREACHED)
        .invariant("a share, dark where no light reaches", |(cost,), luminance: f32| {
            let right = if cost >= OPTICAL_PATH_DEEPEST { luminance == 0.0 } else { (0.0..=1.0).contains(&luminance) };
            if right { Ok(()) } else { Err(format!("the luminance is {luminance:e}")) }
        })
        .build(),
    ]
}
