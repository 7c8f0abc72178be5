//! Test inputs, edges, invariants and hard cases of `wgsl/cdrf.wgsl`.

mod outside;

use crate::{self as mirror, CdrfDrift, CdrfTexels, oracle};
use glam::{UVec2, Vec2, Vec3, Vec4};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;
use std::f64::consts::{FRAC_1_PI, PI};

mirror_struct!(crate, CdrfTexels { lower, upper, weight });
mirror_struct!(crate, CdrfDrift { sigma, shift, share });

const M: &str = "cdrf";

/// Smallest share of the largest sigma that a channel of a table may have, except 0.
const LEAST_TINT: f32 = 1e-20;

/// The smallest positive f32, a subnormal.
const SUBNORMAL: f32 = f32::from_bits(1);

/// Draws a cosine: the ends, around the terminator at every magnitude, anywhere, or out of range by
/// rounding.
fn cosine(draws: &mut Draws<'_>) -> f32 {
    match draws.below(8) {
        0 => draws.pick(&[0.0, 1.0, -1.0, SUBNORMAL, -SUBNORMAL, 1.0f32.next_up(), -1.5]),
        1 => draws.signed(-126, -1),
        2 => 1.0 - draws.magnitude(-24, -2),
        3 => draws.magnitude(-24, -2) - 1.0,
        4 => draws.nudged(0.5, 2),
        _ => draws.between(-1.0, 1.0),
    }
}

/// Draws a sigma: 0, every magnitude, around the switches of the forms, or in the range of use.
fn sigma(draws: &mut Draws<'_>) -> f32 {
    match draws.below(10) {
        0 => draws.pick(&[0.0, SUBNORMAL, 1e-6, 3.0, 8.0, 1e6, 1e19, f32::MAX, -1.0]),
        1 => draws.magnitude(-126, 0),
        2 => {
            let switch = draws.pick(&[mirror::CDRF_SWITCH, mirror::CDRF_CHEAP_SWITCH, mirror::CDRF_SPHERICAL_SWITCH]);
            draws.nudged(switch, 2)
        }
        3 | 4 => draws.between(0.0, 0.1),
        5 | 6 => draws.between(0.1, 0.4),
        7 => draws.magnitude(0, 4),
        _ => draws.between(0.0, 3.0),
    }
}

/// Draws both; in one case of four the cosine is a few sigmas from the terminator, where the blur
/// acts.
fn shading(draws: &mut Draws<'_>) -> (f32, f32) {
    let sigma = sigma(draws);
    let cosine = if draws.below(4) == 0 && sigma < 1.0 { sigma * draws.between(-6.0, 6.0) } else { cosine(draws) };
    (cosine, sigma)
}

fn narrow(draws: &mut Draws<'_>, widest: f32) -> (f32, f32) {
    let (cosine, sigma) = shading(draws);
    if sigma <= widest { (cosine, sigma) } else { (cosine, draws.between(0.0, widest)) }
}

/// Draws floats of every kind.
fn any(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => {
            let largest = f32::MAX;
            // The last two are NaNs with the smallest payload.
            draws.pick(&[
                0.0,
                -0.0,
                f32::NAN,
                -f32::NAN,
                f32::INFINITY,
                f32::NEG_INFINITY,
                largest,
                -largest,
                1e18,
                SUBNORMAL,
                f32::from_bits(0x7f80_0001),
                f32::from_bits(0xff80_0001),
            ])
        }
        1 => f32::from_bits(draws.bits()),
        2 => draws.signed(-10, 10),
        _ => draws.nudged(1e18, 3),
    }
}

fn coordinates(draws: &mut Draws<'_>) -> Vec2 {
    let one = |draws: &mut Draws<'_>| match draws.below(4) {
        0 => draws.pick(&[0.0, 1.0, 0.5, 1.0f32.next_down(), -0.25, 1.25]),
        1 => 1.0 - draws.magnitude(-24, -1),
        2 => draws.magnitude(-126, -1),
        _ => draws.between(0.0, 1.0),
    };
    Vec2::new(one(draws), one(draws))
}

fn size(draws: &mut Draws<'_>) -> UVec2 {
    let side = |draws: &mut Draws<'_>| match draws.below(3) {
        0 => draws.pick(&[1, 2, 3, 64, 65, 256, 257, 16384]),
        1 => 1 + draws.below(300),
        _ => 1 + draws.below(16384),
    };
    UVec2::new(side(draws), side(draws))
}

fn in_unit_range(reflectance: f32) -> Result<(), String> {
    if (0.0..=1.0).contains(&reflectance) { Ok(()) } else { Err(format!("reflectance {reflectance}")) }
}

/// Checks that the result without blur is exactly Lambert's law, except for values that may be
/// flushed.
fn lambert_at_zero((cosine, sigma): (f32, f32), reflectance: f32) -> Result<(), String> {
    if sigma > 0.0 {
        return Ok(());
    }
    near("reflectance", reflectance.into(), f64::from(cosine.clamp(0.0, 1.0)), f32::MIN_POSITIVE.into())
}

/// Returns the cosine of an angle that is `step` farther from the light.
fn turned(cosine: f32, step: f64) -> f32 {
    (f64::from(cosine.clamp(-1.0, 1.0)).acos() + step).min(PI).cos() as f32
}

/// Checks that the reflectance does not rise as the light sinks, except for rounding of at most
/// `bound` in each value.
fn darker(reflectance: f32, turned: f32, bound: f64) -> Result<(), String> {
    let rise = f64::from(turned) - f64::from(reflectance);
    if rise <= 2.0 * bound { Ok(()) } else { Err(format!("rises by {rise:e} to {turned}")) }
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [widths(), drifts(), helpers(), rungs(), accurate(), others(), tables()].into_iter().flatten().collect()
}

fn widths() -> Vec<Formula> {
    const NAIVE: &str = "cdrf_sigma_naive";
    vec![
        formula(M, "cdrf_finite", mirror::finite, oracle::finite, |draws| (any(draws),))
            .edge("a NaN", |(x,)| x.is_nan())
            .edge("infinite", |(x,)| x.is_infinite())
            .edge("too large", |(x,)| x.is_finite() && x.abs() > 1e18)
            .edge("just large enough", |(x,)| x == 1e18)
            .build(),
        formula(M, "cdrf_sigma", mirror::sigma, oracle::sigma, |draws| (any(draws), any(draws)))
            .edge("either a NaN", |(s, k)| s.is_nan() || k.is_nan())
            .edge("zero times infinity", |(s, k)| s == 0.0 && k.is_infinite())
            .edge("no curvature", |(s, k)| s > 0.0 && k == 0.0)
            .edge("negative curvature", |(s, k)| s > 0.0 && k < 0.0)
            .edge("negative sigma0", |(s, k)| s < 0.0 && k > 0.0)
            .invariant("finite and not negative", |_, sigma: f32| {
                if (0.0..=1.000_001e36).contains(&sigma) { Ok(()) } else { Err(format!("sigma {sigma}")) }
            })
            .pair(
                "a hollow as a ridge",
                |(s, k)| (s, -k),
                |_, sigma: f32, other: f32| near("difference", f64::from(sigma - other), 0.0, 0.0),
            )
            .hard_case("sigma0 a NaN", (f32::NAN, 1.0), (&[0.0], 0.0), (NAIVE, f64::INFINITY))
            .hard_case("curvature a NaN", (1.0, f32::NAN), (&[0.0], 0.0), (NAIVE, f64::INFINITY))
            .hard_case("no scattering on a needle", (0.0, f32::INFINITY), (&[0.0], 0.0), (NAIVE, f64::INFINITY))
            .hard_case("infinite curvature", (1.0, f32::INFINITY), (&[1e18], 1e11), (NAIVE, f64::INFINITY))
            .hard_case("huge curvature and sigma0", (1e30, 1e30), (&[1e36], 1e29), (NAIVE, f64::INFINITY))
            .hard_case("negative sigma0", (-0.25, 2.0), (&[0.0], 0.0), (NAIVE, 0.4))
            .hard_case("negative curvature", (0.25, -2.0), (&[0.5], 0.0), (NAIVE, 0.9))
            .build(),
        formula(M, "cdrf_sigma_naive", mirror::sigma_naive, oracle::sigma_naive, |draws| {
            (draws.magnitude(-20, 20), draws.magnitude(-20, 20))
        })
        .benign(1e-6)
        .build(),
    ]
}

/// Draws a mean free path and a curvature: of every kind, or so that their product is in the range of
/// use, with either sign.
fn turn(draws: &mut Draws<'_>) -> (f32, f32) {
    if draws.below(3) == 0 {
        return (any(draws), any(draws));
    }
    let path = draws.magnitude(-12, 12);
    let turn = if draws.below(3) == 0 { draws.signed(-60, 2) } else { draws.between(-1.2, 1.2) };
    (path, turn / path)
}

/// Draws the root of 1 - albedo: the ends, beside them, and anywhere.
fn gamma(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => draws.pick(&[0.0, 1.0, -0.5, 1.5]),
        1 => draws.magnitude(-60, 0),
        _ => draws.between(0.0, 1.0),
    }
}

fn drifts() -> Vec<Formula> {
    const NAIVE: &str = "cdrf_sigma_power_naive";
    const LEAST: f64 = 1.5e-7;
    vec![
        formula(M, "cdrf_sigma_power", mirror::sigma_power, oracle::sigma_power, turn)
            .edge("either a NaN", |(l, k)| l.is_nan() || k.is_nan())
            .edge("no curvature", |(l, k)| l > 0.0 && k == 0.0)
            .edge("a hollow", |(l, k)| l > 0.0 && k < 0.0)
            .edge("infinite curvature", |(l, k)| l > 0.0 && k.is_infinite())
            .invariant("positive and finite", |_, sigma: f32| {
                if (1.4e-7..=3.3e21).contains(&sigma) { Ok(()) } else { Err(format!("sigma {sigma}")) }
            })
            .pair(
                "the exponent",
                |(l, k)| (l, 2.0 * k),
                |(l, k), one: f32, other: f32| {
                    let product = oracle::sigma(l.into(), k.into());
                    if (1e-11..1e12).contains(&product) && k.abs() < 1e17 && l < 1e17 {
                        near("quotient", f64::from(other / one), 2f64.powf(0.59), 1e-4)
                    } else {
                        Ok(())
                    }
                },
            )
            .hard_case("no curvature", (1.0, 0.0), (&[0.0], LEAST), (NAIVE, 0.0))
            // What the plain power makes of a NaN is each device's own.
            .hard_case("curvature a NaN", (1.0, f32::NAN), (&[0.0], LEAST), (NAIVE, 0.0))
            .hard_case("a hollow", (0.25, -2.0), (&[1.8 * 0.5f64.powf(0.59)], 6e-5), (NAIVE, f64::INFINITY))
            .hard_case("huge curvature", (1e30, 1e30), (&[1.8 * 1e36f64.powf(0.59)], 2e17), (NAIVE, f64::INFINITY))
            .build(),
        formula(M, "cdrf_sigma_power_naive", mirror::sigma_power_naive, oracle::sigma_power_naive, |draws| {
            (draws.magnitude(-10, 20), draws.magnitude(-10, 20))
        })
        .benign(4e-5)
        .build(),
        formula(M, "cdrf_drift", mirror::drift, oracle::drift, |draws| {
            let (path, curvature) = turn(draws);
            (path, curvature, gamma(draws))
        })
        .edge("either a NaN", |(l, k, _)| l.is_nan() || k.is_nan())
        .edge("no curvature", |(l, k, _)| l > 0.0 && k == 0.0)
        .edge("no curvature, nothing absorbed", |(l, k, g)| (l == 0.0 || k == 0.0) && g == 0.0)
        .edge("a hollow", |(l, k, _)| l > 0.0 && k < 0.0)
        .edge("infinite curvature", |(l, k, _)| l > 0.0 && k.is_infinite())
        .edge("nothing absorbed", |(l, k, g)| l * k.abs() > 0.01 && g == 0.0)
        .edge("nothing scattered", |(l, k, g)| l * k.abs() > 0.01 && g == 1.0)
        .invariant("in its ranges", |_, drift: CdrfDrift| {
            let CdrfDrift { sigma, shift, share } = drift;
            let sound = (0.0..=1.5).contains(&sigma) && shift.abs() < 0.886 && (0.239..=1.0).contains(&share);
            if sound { Ok(()) } else { Err(format!("{drift:?}")) }
        })
        .pair(
            "a hollow against a ridge",
            |(l, k, g)| (l, -k, g),
            |_, ridge: CdrfDrift, hollow: CdrfDrift| {
                near("sum of the shifts", f64::from(ridge.shift + hollow.shift), 0.0, 0.0)?;
                near("difference of the widths", f64::from(ridge.sigma - hollow.sigma), 0.0, 0.0)
            },
        )
        .build(),
        formula(M, "cdrf_shifted", mirror::shifted, oracle::shifted, |draws| {
            let shift = match draws.below(4) {
                0 => draws.pick(&[0.0, 0.9, -0.9, 1.5, -1.5]),
                1 => draws.signed(-60, 0),
                _ => draws.between(-0.9, 0.9),
            };
            let near_zero = draws.below(4) == 0;
            (if near_zero { -shift + draws.signed(-24, -4) } else { cosine(draws) }, shift)
        })
        .edge("no shift", |(_, b)| b == 0.0)
        .edge("facing the light", |(c, b)| c == 1.0 && b < -0.5)
        .edge("facing away", |(c, b)| c == -1.0 && b > 0.5)
        .edge("moved to the terminator", |(c, b)| b.abs() > 0.1 && (c + b).abs() < 1e-3)
        .edge("out of range", |(c, b)| c.abs() > 1.0 || b.abs() > 0.9)
        .invariant(
            "a cosine",
            |_, cosine: f32| {
                if (-1.0..=1.0).contains(&cosine) { Ok(()) } else { Err(format!("cosine {cosine}")) }
            },
        )
        .pair(
            "darker further from the light",
            |(c, b)| (turned(c, 0.01), b),
            |_, one: f32, other: f32| darker(one, other, 1.1e-6),
        )
        .build(),
    ]
}

fn helpers() -> Vec<Formula> {
    vec![
        formula(M, "cdrf_arcsine", mirror::arcsine, oracle::arcsine, |draws| (cosine(draws),))
            .edge("both sides of the change of form", |(x,)| x == 0.5f32.next_up())
            .edge("the ends", |(x,)| x.abs() == 1.0)
            .edge("out of range", |(x,)| x.abs() > 1.0)
            .pair("odd", |(x,)| (-x,), |_, angle: f32, other: f32| near("sum", f64::from(angle + other), 0.0, 0.0))
            .build(),
        formula(M, "cdrf_deviations", mirror::deviations, oracle::deviations, |draws| {
            let x = 1.5 * cosine(draws).clamp(-1.0, 1.0);
            (x, if draws.below(2) == 0 { x.abs() / draws.between(0.5, 14.0) } else { sigma(draws) })
        })
        .edge("no blur", |(x, s)| s == 0.0 && x != 0.0)
        .edge("the terminator without blur", |(x, s)| s == 0.0 && x == 0.0)
        .edge("far out", |(x, s)| s > 0.0 && x.abs() > 12.0 * s)
        .build(),
        formula(M, "cdrf_normal_density", mirror::normal_density, oracle::normal_density, |draws| {
            (draws.between(-12.0, 12.0),)
        })
        .edge("far out", |(u,)| u > 11.0)
        .build(),
        formula(M, "cdrf_normal_share", mirror::normal_share, oracle::normal_share, |draws| {
            (match draws.below(4) {
                0 => draws.pick(&[0.0, 1e30, -1e30, 12.0, -12.0]),
                1 => draws.signed(-126, 126),
                _ => draws.between(-6.0, 6.0),
            },)
        })
        .edge("the middle", |(u,)| u == 0.0)
        .edge("far out", |(u,)| u.abs() > 12.0)
        .invariant("a share", |_, share: f32| in_unit_range(share))
        .build(),
        formula(M, "cdrf_sine", mirror::sine, oracle::sine, |draws| {
            (match draws.below(4) {
                0 => draws.nudged(0.25, 2) * draws.pick(&[0.0, 1.0, 2.0, 3.0, -1.0, -2.0]),
                1 => draws.signed(-40, -2),
                _ => draws.between(-9.0, 9.0),
            },)
        })
        .edge("quarter turns", |(t,)| t.abs() == 0.25)
        .edge("half turns", |(t,)| t == 0.5)
        .build(),
        formula(M, "cdrf_series", mirror::series, oracle::series, |draws| {
            let (cosine, sigma) = shading(draws);
            (cosine, sigma, draws.below(17))
        })
        .edge("no terms", |(.., terms)| terms == 0)
        .edge("sixteen terms without blur", |(_, sigma, terms)| terms == 16 && sigma == 0.0)
        .build(),
    ]
}

fn rungs() -> Vec<Formula> {
    vec![
        formula(M, "cdrf_lambert", mirror::lambert, oracle::lambert, |draws| (cosine(draws),))
            .edge("facing away", |(c,)| c < 0.0)
            .edge("above 1 by rounding", |(c,)| c > 1.0)
            .build(),
        formula(M, "cdrf_wrap", mirror::wrap, oracle::wrap, shading)
            .edge("no blur", |(c, s)| s == 0.0 && c > 0.0)
            .edge("wrapped round", |(c, s)| s > 2.0 && c < -0.9)
            .invariant("in [0, 1]", |_, reflectance: f32| in_unit_range(reflectance))
            .invariant_at_nearest("Lambert's law without blur", lambert_at_zero)
            .build(),
        formula(M, "cdrf_cheap", mirror::cheap, oracle::cheap, |draws| {
            let (cosine, sigma) = shading(draws);
            (cosine.clamp(-1.0, 1.0), sigma)
        })
        .edge("no blur", |(_, s)| s == 0.0)
        .edge("just below the switch", |(_, s)| s == mirror::CDRF_CHEAP_SWITCH.next_down())
        .edge("at the switch", |(_, s)| s == mirror::CDRF_CHEAP_SWITCH)
        .invariant("in [0, 1]", |_, reflectance: f32| in_unit_range(reflectance))
        .invariant_at_nearest("Lambert's law without blur", lambert_at_zero)
        .build(),
        formula(M, "cdrf_quadrature", mirror::quadrature, oracle::quadrature, |draws| {
            let (cosine, sigma) = shading(draws);
            // The wider the Gaussian, the more there is to sum.
            (cosine, if sigma > 3.0 && draws.below(8) > 0 { draws.between(0.0, 3.0) } else { sigma })
        })
        .edge("no blur", |(_, s)| s == 0.0)
        .edge("wider than a turn", |(_, s)| s > 6.3 && s < 8.0)
        .build(),
    ]
}

fn accurate() -> Vec<Formula> {
    const SERIES: &str = "cdrf_series_naive";
    const UNWRAPPED: &str = "cdrf_accurate_naive";
    const FIRST_ORDER: &str = "cdrf_edge_naive";
    const ANGLE: &str = "cdrf_angle_naive";
    /// Bound of the accuracy line on lavapipe.
    const BOUND: f64 = 5e-7;
    // σ φ(0) (1 - σ²/3 + …) at the terminator.
    let terminator = |sigma: f64| oracle::accurate(0.0, sigma);
    vec![
        formula(M, "cdrf_edge", mirror::edge, oracle::edge, |draws| narrow(draws, mirror::CDRF_SWITCH))
            .edge("no blur", |(_, s)| s == 0.0)
            .edge("the terminator", |(c, s)| c == 0.0 && s > 0.0)
            .edge("a standard deviation into the dark", |(c, s)| s > 1e-20 && c < -0.9 * s && c > -1.1 * s)
            .invariant("in [0, 1]", |_, reflectance: f32| in_unit_range(reflectance))
            .invariant_at_nearest("Lambert's law without blur", lambert_at_zero)
            .hard_case("no blur at the terminator", (0.0, 0.0), (&[0.0], 0.0), (FIRST_ORDER, f64::INFINITY))
            .hard_case(
                "a sigma of 0.05 facing the light",
                (0.8, 0.05),
                (&[oracle::accurate(f64::from(0.8f32), f64::from(0.05f32))], BOUND),
                (FIRST_ORDER, 9e-4),
            )
            .build(),
        formula(M, "cdrf_edge_naive", mirror::edge_naive, oracle::edge_naive, |draws| {
            let sigma = draws.between(0.05, 0.25);
            (sigma * draws.between(-0.5, 4.0), sigma)
        })
        .benign(2e-5)
        .build(),
        formula(M, "cdrf_accurate", mirror::accurate, oracle::accurate, shading)
            .edge("no blur", |(_, s)| s == 0.0)
            .edge("a subnormal sigma", |(_, s)| s == SUBNORMAL)
            .edge("a negative sigma", |(_, s)| s < 0.0)
            .edge("huge", |(_, s)| s > 1e18)
            .edge("just below the switch", |(_, s)| s == mirror::CDRF_SWITCH.next_down())
            .edge("at the switch", |(_, s)| s == mirror::CDRF_SWITCH)
            .edge("facing the light", |(c, _)| c == 1.0)
            .edge("facing away", |(c, _)| c == -1.0)
            .edge("beside the terminator", |(c, s)| c.abs() < 1e-30 && c != 0.0 && s > 0.0)
            .invariant("in [0, 1]", |_, reflectance: f32| in_unit_range(reflectance))
            .invariant_at_nearest("Lambert's law without blur", lambert_at_zero)
            .invariant_at_nearest("the mean, 1/pi, at last", |(_, s), reflectance: f32| {
                if s >= 8.0 { near("reflectance", reflectance.into(), FRAC_1_PI, 1e-7) } else { Ok(()) }
            })
            .pair(
                "darker further from the light",
                |(c, s)| (turned(c, 0.01), s),
                |_, one: f32, other: f32| darker(one, other, BOUND),
            )
            // The forms meet at the switch. The slope in sigma is the function's own, at most 0.4
            // there.
            .pair(
                "no seam",
                |(c, _)| (c, mirror::CDRF_SWITCH),
                |(_, s), one: f32, other: f32| {
                    let step = f64::from(s) - f64::from(mirror::CDRF_SWITCH);
                    if step.abs() < 1e-6 {
                        near("difference", f64::from(one) - f64::from(other), 0.0, 2.0 * BOUND + 0.4 * step.abs())
                    } else {
                        Ok(())
                    }
                },
            )
            .hard_case("no blur at the terminator", (0.0, 0.0), (&[0.0], 0.0), (SERIES, 0.03))
            .hard_case("no blur, facing away", (-1.0, 0.0), (&[0.0], 0.0), (SERIES, 3e-3))
            .hard_case("no blur, facing the light", (1.0, 0.0), (&[1.0], 0.0), (SERIES, 3e-3))
            .hard_case("a subnormal sigma", (0.0, SUBNORMAL), (&[0.0], 1e-38), (SERIES, 0.03))
            .hard_case("sigma 1e-6 at the terminator", (0.0, 1e-6), (&[terminator(1e-6)], 1e-12), (SERIES, 0.03))
            // No f32 is exactly 90 degrees in radians: the cosine of the nearest one, and of one
            // step less.
            .hard_case("the f32 nearest to 90 degrees", (-4.371_139e-8, 1e-6), (&[3.774_677e-7], 1e-12), (SERIES, 0.03))
            .hard_case("one step less than 90 degrees", (7.549_790e-8, 1e-6), (&[4.378_277e-7], 1e-12), (SERIES, 0.03))
            .hard_case(
                "sigma 1e-6, one step past the terminator",
                (0.0f32.next_down(), 1e-6),
                (&[terminator(1e-6)], 1e-12),
                (SERIES, 0.03),
            )
            .hard_case(
                "sigma 0.1 at the terminator",
                (0.0, 0.1),
                (&[terminator(f64::from(0.1f32))], BOUND),
                (SERIES, 5e-3),
            )
            .hard_case(
                "light from behind at sigma 1",
                (-1.0, 1.0),
                (&[oracle::accurate(-1.0, 1.0)], BOUND),
                (UNWRAPPED, 0.02),
            )
            .hard_case("sigma 3", (0.0, 3.0), (&[terminator(3.0)], BOUND), (UNWRAPPED, 0.1))
            .hard_case(
                "an angle of 37 degrees at sigma 0.05",
                (0.8, 0.05),
                (&[oracle::accurate(f64::from(0.8f32), f64::from(0.05f32))], BOUND),
                (ANGLE, 3e-5),
            )
            .hard_case("sigma 1e6 facing the light", (1.0, 1e6), (&[FRAC_1_PI], BOUND), (UNWRAPPED, 0.1))
            .hard_case("sigma 1e6 facing away", (-1.0, 1e6), (&[FRAC_1_PI], BOUND), (UNWRAPPED, 0.1))
            .build(),
        formula(M, "cdrf_series_naive", mirror::series_naive, oracle::series_naive, |draws| {
            (draws.between(0.0, 1.0), draws.between(0.2, 3.0))
        })
        .benign(5e-6)
        .build(),
        formula(M, "cdrf_accurate_naive", mirror::accurate_naive, oracle::accurate_naive, |draws| {
            (draws.between(0.0, 1.0), draws.between(0.05, 0.3))
        })
        .benign(1e-4)
        .build(),
        formula(M, "cdrf_angle_naive", mirror::angle_naive, oracle::angle_naive, |draws| {
            (draws.between(0.0, 1.0), draws.between(0.3, 3.0))
        })
        .benign(1e-3)
        .build(),
        formula(M, "cdrf_rgb", mirror::rgb, oracle::rgb, |draws| {
            let sigma0 = |draws: &mut Draws<'_>| if draws.below(4) == 0 { any(draws) } else { sigma(draws) };
            let sigma0 = Vec3::new(sigma0(draws), sigma0(draws), sigma0(draws));
            let curvature = if draws.below(4) == 0 { any(draws) } else { draws.signed(-3, 3) };
            (cosine(draws), sigma0, curvature)
        })
        .edge("a channel that is a NaN", |(_, s, _)| s.is_nan())
        .edge("a curvature that is a NaN", |(.., k)| k.is_nan())
        .edge("channels on both sides of the switch", |(_, s, k)| {
            let s = s * k.abs();
            s.min_element() > 0.05 && s.min_element() < mirror::CDRF_SWITCH && s.max_element() < 3.0
        })
        .invariant("in [0, 1]", |_, reflectance: Vec3| {
            in_unit_range(reflectance.x).and(in_unit_range(reflectance.y)).and(in_unit_range(reflectance.z))
        })
        .build(),
    ]
}

fn others() -> Vec<Formula> {
    /// Bound of the accuracy line on lavapipe.
    const BOUND: f64 = 1.8e-6;
    vec![
        formula(M, "cdrf_spherical_edge", mirror::spherical_edge, oracle::spherical_edge, |draws| {
            narrow(draws, mirror::CDRF_SPHERICAL_SWITCH)
        })
        .edge("no blur", |(_, s)| s == 0.0)
        .edge("the terminator", |(c, s)| c == 0.0 && s > 0.0)
        .invariant_at_nearest("Lambert's law without blur", lambert_at_zero)
        .build(),
        formula(M, "cdrf_harmonic_weights", mirror::harmonic_weights, oracle::harmonic_weights, |draws| {
            (shading(draws).1,)
        })
        .edge("no blur", |(s,)| s == 0.0)
        .edge("huge", |(s,)| s > 1e18)
        .invariant_at_nearest("more blur of higher degrees", |_, weights: Vec4| {
            let all = [PI, PI / 1.5, PI / 4.0, PI / 24.0].map(|weight| weight as f32);
            let shares = weights.abs() / Vec4::from_array(all);
            let falling = shares.to_array().windows(2).all(|pair| f64::from(pair[1]) <= f64::from(pair[0]) + 1e-6);
            if falling { Ok(()) } else { Err(format!("{shares}")) }
        })
        .build(),
        formula(M, "cdrf_spherical", mirror::spherical, oracle::spherical, shading)
            .edge("no blur", |(_, s)| s == 0.0)
            .edge("just below the switch", |(_, s)| s == mirror::CDRF_SPHERICAL_SWITCH.next_down())
            .edge("at the switch", |(_, s)| s == mirror::CDRF_SPHERICAL_SWITCH)
            .edge("huge", |(_, s)| s > 1e18)
            .invariant("in [0, 1]", |_, reflectance: f32| in_unit_range(reflectance))
            .invariant_at_nearest("Lambert's law without blur", lambert_at_zero)
            .invariant_at_nearest("the sphere's mean, 1/4, at last", |(_, s), reflectance: f32| {
                if s >= 8.0 { near("reflectance", reflectance.into(), 0.25, 1e-7) } else { Ok(()) }
            })
            .pair(
                "darker further from the light",
                |(c, s)| (turned(c, 0.01), s),
                |_, one: f32, other: f32| darker(one, other, BOUND),
            )
            .build(),
    ]
}

fn tables() -> Vec<Formula> {
    vec![
        formula(M, "cdrf_table_coordinates", mirror::table_coordinates, oracle::table_coordinates, |draws| {
            let (cosine, sigma) = shading(draws);
            (cosine, sigma.min(1e36))
        })
        .edge("the terminator", |(c, _)| c == 0.0)
        .edge("no blur", |(_, s)| s == 0.0)
        .edge("huge", |(_, s)| s > 1e18)
        .invariant("fractions", |_, place: Vec2| in_unit_range(place.x).and(in_unit_range(place.y)))
        .invariant_at_nearest("the terminator in the middle", |(c, _), place: Vec2| {
            if c == 0.0 { near("column", place.x.into(), 0.5, 0.0) } else { Ok(()) }
        })
        .build(),
        formula(M, "cdrf_table_texel", mirror::table_texel, oracle::table_texel, |draws| {
            let size = size(draws);
            let pick = |draws: &mut Draws<'_>, side: u32| match draws.below(4) {
                0 => draws.pick(&[0, side - 1, side / 2]),
                _ => draws.below(side),
            };
            let texel = UVec2::new(pick(draws, size.x), pick(draws, size.y));
            let tint = Vec3::new(1.0, draws.between(0.0, 1.0), draws.pick(&[0.0, 0.25, 1.0, LEAST_TINT]));
            (texel, size, tint)
        })
        .edge("the first row", |(texel, ..)| texel.y == 0)
        .edge("the last row", |(texel, size, _)| texel.y == size.y - 1)
        .edge("the last row of the faintest channel", |(texel, size, tint)| {
            texel.y == size.y - 1 && tint.z == LEAST_TINT
        })
        .edge("the terminator of an odd width", |(texel, size, _)| size.x % 2 == 1 && texel.x == size.x / 2)
        .build(),
        formula(M, "cdrf_texture_coordinates", mirror::texture_coordinates, oracle::texture_coordinates, |draws| {
            (coordinates(draws).clamp(Vec2::ZERO, Vec2::ONE), size(draws))
        })
        .edge("one texel", |(_, size)| size == UVec2::ONE)
        .hard_case_with(
            "no blur, facing away: the first texel's middle",
            (Vec2::ZERO, UVec2::new(257, 257)),
            (&[0.5 / 257.0; 2], 1e-9),
            ("cdrf_texture_coordinates_naive", (Vec2::ZERO,), 1.9e-3),
        )
        .build(),
        formula(
            M,
            "cdrf_texture_coordinates_naive",
            mirror::texture_coordinates_naive,
            oracle::texture_coordinates_naive,
            |draws| (coordinates(draws),),
        )
        .benign(1e-7)
        .build(),
        formula(M, "cdrf_texels", mirror::texels, oracle::texels, |draws| (coordinates(draws), size(draws)))
            .edge("one texel", |(_, size)| size == UVec2::ONE)
            .edge("the last texel", |(place, _)| place.x == 1.0)
            .edge("out of range", |(place, _)| place.y > 1.0)
            .invariant("inside the table, neighbours", |(_, size), texels: CdrfTexels| {
                let CdrfTexels { lower, upper, weight } = texels;
                let inside = lower.cmplt(size).all() && upper == (lower + 1).min(size - 1);
                let weights = weight.cmpge(Vec2::ZERO).all() && weight.cmple(Vec2::ONE).all();
                if inside && weights { Ok(()) } else { Err(format!("{texels:?} of {size}")) }
            })
            .build(),
        formula(M, "cdrf_blend", mirror::blend, oracle::blend, |draws| {
            let texel = |draws: &mut Draws<'_>| draws.magnitude(-10, 10) * (Vec3::ONE + 0.9 * draws.in_cube());
            (draws.in_square(), texel(draws), texel(draws), texel(draws), texel(draws))
        })
        .build(),
    ]
}
