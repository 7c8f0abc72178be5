//! Test inputs, edges, invariants and hard cases of `wgsl/half_space.wgsl`.

mod outside;

use crate::{self as mirror, HALF_SPACE_GRAZING, HALF_SPACE_LAST_EDGE, oracle};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};

const M: &str = "half_space";

/// Relative error of two values of H and a reflectance, with room for the portable bounds.
const FITTED: f64 = 6e-4;

/// Draws a cosine: every magnitude, the ends, around the limit, or out of range.
fn cosine(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[1.0, 0.0, -0.5, 1.5, f32::MIN_POSITIVE]),
        1 => draws.magnitude(-126, -1),
        2 => HALF_SPACE_GRAZING * draws.between(0.1, 3.0),
        3 => draws.magnitude(-24, -1),
        _ => draws.between(0.0, 1.0),
    }
}

/// Draws a share, such as gamma, an albedo or a reflectance: every magnitude of it and of its rest, the
/// ends, or out of range.
fn share(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[0.0, 1.0, 0.5, -0.5, 1.5, 1.0f32.next_down(), 1.0f32.next_up()]),
        1 => draws.magnitude(-126, -1),
        2 => 1.0 - draws.magnitude(-24, -2),
        3 => draws.magnitude(-16, -1),
        _ => draws.between(0.0, 1.0),
    }
}

/// Draws a relative index: 1 and just above it, common ones, or out of range.
fn index(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[1.0, 1.4, 1.33, 4.0, 0.5, 5.0]),
        1 => 1.0 + draws.magnitude(-23, -2),
        2 => draws.nudged(1.0, 3),
        _ => draws.between(1.0, 4.0),
    }
}

/// Draws an edge: that of an index, the ends, or any.
fn edge_of(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => draws.pick(&[0.0, HALF_SPACE_LAST_EDGE, -0.5, 1.5]),
        1 => draws.magnitude(-126, -1),
        2 => draws.nudged(HALF_SPACE_LAST_EDGE, 3),
        _ => draws.between(0.0, 0.98),
    }
}

/// Draws a gain: that of some matter, the ends, or out of range.
fn strength(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => draws.pick(&[0.0, 100.0, -1.0, 200.0]),
        _ => draws.between(0.07, 12.0),
    }
}

fn within(what: &str, value: f32, low: f64, high: f64) -> Result<(), String> {
    if (low..=high).contains(&f64::from(value)) { Ok(()) } else { Err(format!("{what} {value}")) }
}

fn in_unit_range(share: f32) -> Result<(), String> {
    within("share", share, 0.0, 1.0)
}

/// Relative error of two results that differ by rounding alone, on any device.
const ROUNDED: f64 = 3e-5;

/// Checks that two results are equal up to rounding.
fn alike<A>(_: A, one: f32, other: f32) -> Result<(), String> {
    near("difference", f64::from(one) - f64::from(other), 0.0, ROUNDED * f64::from(one))
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [matter(), angles(), laws(), boundary(), behind()].into_iter().flatten().collect()
}

fn matter() -> Vec<Formula> {
    const NAIVE: &str = "half_space_gamma_naive";
    let nearly_white = 1.0f32.next_down();
    let odds = |albedo: f32, anisotropy: f32| {
        let (albedo, anisotropy) = (f64::from(albedo), f64::from(anisotropy));
        [(1.0 + albedo / (1.0 - albedo) * (1.0 - anisotropy)).sqrt().recip()]
    };
    vec![
        formula(M, "half_space_gamma", mirror::gamma, oracle::gamma, |draws| {
            let anisotropy = match draws.below(4) {
                0 => draws.pick(&[0.0, 0.9, -1.0, 0.999, 1.0, -2.0, 2.0]),
                1 => draws.signed(-126, -1),
                2 => draws.nudged(0.999, 3),
                _ => draws.between(-1.0, 0.999),
            };
            (share(draws), anisotropy)
        })
        .edge("nothing is absorbed", |(albedo, _)| albedo == 1.0)
        .edge("nothing is absorbed, nothing is turned", |(albedo, g)| albedo >= 1.0 && g >= 1.0)
        .edge("nothing is scattered", |(albedo, _)| albedo == 0.0)
        .edge("one ulp from white", |(albedo, _)| albedo == 1.0f32.next_down())
        .edge("isotropic", |(albedo, g)| g == 0.0 && albedo > 0.0 && albedo < 1.0)
        .edge("backwards", |(albedo, g)| g < 0.0 && albedo > 0.5)
        .invariant("in [0, 1]", |_, gamma: f32| in_unit_range(gamma))
        .invariant("0 if nothing is absorbed", |(albedo, _), gamma: f32| {
            if albedo >= 1.0 { near("gamma", gamma.into(), 0.0, 0.0) } else { Ok(()) }
        })
        .hard_case(
            "one ulp from white, scattering forwards",
            (nearly_white, 0.9),
            (&odds(nearly_white, 0.9), 1e-8),
            (NAIVE, 1e-5),
        )
        .hard_case("white, scattering straight on", (1.0, 1.0), (&[0.0], 0.0), (NAIVE, f64::INFINITY))
        .build(),
        formula(M, "half_space_gamma_naive", mirror::gamma_naive, oracle::gamma_naive, |draws| {
            (draws.between(0.01, 0.9), draws.between(-0.9, 0.9))
        })
        .benign(3e-5)
        .build(),
        formula(
            M,
            "half_space_gamma_of_reflectance",
            mirror::gamma_of_reflectance,
            oracle::gamma_of_reflectance,
            |draws| (share(draws),),
        )
        .edge("all is reflected", |(reflectance,)| reflectance == 1.0)
        .edge("nothing is reflected", |(reflectance,)| reflectance == 0.0)
        .edge("one ulp from white", |(reflectance,)| reflectance == 1.0f32.next_down())
        .edge("above 1", |(reflectance,)| reflectance > 1.0)
        .invariant("in [0, 1]", |_, gamma: f32| in_unit_range(gamma))
        .invariant("half_space_reflectance takes it back", |(reflectance,), gamma: f32| {
            near("reflectance", mirror::reflectance(gamma).into(), f64::from(reflectance.clamp(0.0, 1.0)), 3e-6)
        })
        .build(),
        formula(M, "half_space_gamma_of_shares", mirror::gamma_of_shares, oracle::gamma_of_shares, |draws| {
            let part = |draws: &mut Draws<'_>| match draws.below(4) {
                0 => draws.pick(&[1.0, 1.5, 100.0]),
                1 => draws.magnitude(-60, -1),
                _ => draws.between(0.0, 1.0).max(2f32.powi(-60)),
            };
            match draws.below(8) {
                0 => (0.0, part(draws)),
                1 => (part(draws), 0.0),
                _ => (part(draws), part(draws)),
            }
        })
        .edge("nothing is reflected", |(reflected, _)| reflected == 0.0)
        .edge("nothing is absorbed", |(_, absorbed)| absorbed == 0.0)
        .edge("both are small", |(reflected, absorbed)| reflected < 1e-9 && absorbed < 1e-9)
        .invariant("in [0, 1]", |_, gamma: f32| in_unit_range(gamma))
        .edge("above 1", |(reflected, absorbed)| reflected > 1.0 && absorbed > 0.0 && absorbed < 1.0)
        .pair("of any whole", |(reflected, absorbed)| (0.5 * reflected.min(1.0), 0.5 * absorbed.min(1.0)), alike)
        .build(),
        formula(M, "half_space_darkening", mirror::darkening, oracle::darkening, |draws| (share(draws),))
            .edge("nothing is absorbed", |(gamma,)| gamma == 0.0)
            .edge("nothing is scattered", |(gamma,)| gamma == 1.0)
            .invariant("in [1, 2.4442]", |_, quotient: f32| within("quotient", quotient, 0.999_999, 2.4443))
            .build(),
        formula(M, "half_space_reflectance", mirror::reflectance, oracle::reflectance, |draws| (share(draws),))
            .edge("nothing is absorbed", |(gamma,)| gamma == 0.0)
            .edge("nothing is scattered", |(gamma,)| gamma == 1.0)
            .edge("out of range", |(gamma,)| gamma > 1.0)
            .invariant("in [0, 1]", |_, reflectance: f32| in_unit_range(reflectance))
            .build(),
    ]
}

fn angles() -> Vec<Formula> {
    let nearly_black = 1.0f32.next_down();
    vec![
        formula(M, "half_space_escape", mirror::escape, oracle::escape, |draws| (cosine(draws), share(draws)))
            .edge("grazing", |(c, _)| c == 0.0)
            .edge("just above the limit", |(c, _)| (HALF_SPACE_GRAZING..2.0 * HALF_SPACE_GRAZING).contains(&c))
            .edge("along the normal, nothing absorbed", |(c, gamma)| c == 1.0 && gamma == 0.0)
            .edge("nothing scattered", |(c, gamma)| gamma == 1.0 && c > 0.1)
            .invariant("in [0.3, 1.001]", |_, part: f32| within("part", part, 0.3, 1.001))
            .build(),
        formula(M, "half_space_h", mirror::h, oracle::h, |draws| (cosine(draws), share(draws)))
            .edge("grazing", |(c, gamma)| c == 0.0 && gamma < 0.5)
            .edge("along the normal, nothing absorbed", |(c, gamma)| c == 1.0 && gamma == 0.0)
            .edge("nothing scattered", |(c, gamma)| gamma == 1.0 && c > 0.1)
            .invariant("in [1, 2.909]", |_, h: f32| within("H", h, 0.9998, 2.909))
            .pair(
                "rises with the cosine",
                |(c, gamma)| (c + 0.25 * (1.0 - c.clamp(0.0, 1.0)), gamma),
                |_, h: f32, nearer: f32| {
                    if f64::from(nearer) >= f64::from(h) * (1.0 - FITTED) {
                        Ok(())
                    } else {
                        Err(format!("falls from {h} to {nearer}"))
                    }
                },
            )
            .hard_case(
                "along the normal of matter that absorbs nothing",
                (1.0, 0.0),
                (&[2.907_810_529], 4e-4),
                ("half_space_h_paper", 0.09),
            )
            .build(),
        formula(M, "half_space_h_paper", mirror::h_paper, oracle::h_paper, |draws| {
            (draws.between(0.0, 1.0), draws.between(0.0, 1.0))
        })
        .benign(1e-6)
        .build(),
        formula(M, "half_space_directional", mirror::directional, oracle::directional, |draws| {
            (cosine(draws), share(draws))
        })
        .edge("grazing", |(c, gamma)| c == 0.0 && gamma > 0.0 && gamma < 1.0)
        .edge("nothing absorbed", |(c, gamma)| c > 0.1 && gamma == 0.0)
        .edge("nothing scattered", |(c, gamma)| c > 0.1 && gamma == 1.0)
        .edge("all but nothing scattered", |(c, gamma)| c > 0.1 && gamma == 1.0f32.next_down())
        .invariant("in [0, 1]", |_, reflectance: f32| in_unit_range(reflectance))
        .invariant("all, if nothing is absorbed", |(_, gamma), reflectance: f32| {
            if gamma <= 0.0 { near("reflectance", reflectance.into(), 1.0, 1e-6) } else { Ok(()) }
        })
        .hard_case(
            "one ulp from matter that scatters nothing",
            (1.0, nearly_black),
            // 2^-24 (1 - ln 2).
            (&[1.828_99e-8], 1e-11),
            ("half_space_directional_naive", 1e-8),
        )
        .build(),
        formula(M, "half_space_directional_naive", mirror::directional_naive, oracle::directional_naive, |draws| {
            (draws.between(0.01, 1.0), draws.between(0.0, 0.9))
        })
        .benign(2e-3)
        .build(),
        formula(M, "half_space_exit", mirror::exit, oracle::exit, |draws| (cosine(draws), share(draws)))
            .edge("grazing", |(c, _)| c == 0.0)
            .edge("nothing absorbed", |(c, gamma)| c > 0.1 && gamma == 0.0)
            .edge("nothing scattered", |(c, gamma)| c > 0.1 && gamma == 1.0)
            .invariant("in [0.43, 1.27]", |_, factor: f32| within("factor", factor, 0.43, 1.27))
            .build(),
    ]
}

/// Draws the cosines of eye and light: in one case of eight both grazing, in another below the limit.
fn cosines(draws: &mut Draws<'_>) -> (f32, f32) {
    match draws.below(8) {
        0 => (0.0, 0.0),
        1 => (draws.magnitude(-126, -61), draws.magnitude(-126, -61)),
        _ => (cosine(draws), cosine(draws)),
    }
}

/// Draws the cosines of eye and light, and gamma.
fn shading(draws: &mut Draws<'_>) -> (f32, f32, f32) {
    let (eye, light) = cosines(draws);
    (eye, light, share(draws))
}

fn benign(draws: &mut Draws<'_>) -> (f32, f32, f32) {
    (draws.between(0.01, 1.0), draws.between(0.01, 1.0), draws.between(0.0, 0.9))
}

fn laws() -> Vec<Formula> {
    let grazing = f64::from(HALF_SPACE_GRAZING);
    vec![
        formula(M, "half_space_brdf", mirror::brdf, oracle::brdf, shading)
            .edge("both exactly grazing", |(eye, light, gamma)| eye == 0.0 && light == 0.0 && gamma < 1.0)
            .edge("light exactly grazing", |(eye, light, _)| eye > 0.1 && light == 0.0)
            .edge("below the limit", |(eye, light, _)| eye > 0.0 && light > 0.0 && eye + light < HALF_SPACE_GRAZING)
            .edge("light below the surface", |(_, light, _)| light < 0.0)
            .edge("nothing absorbed", |(eye, light, gamma)| eye > 0.1 && light > 0.1 && gamma == 0.0)
            .edge("nothing scattered", |(.., gamma)| gamma == 1.0)
            .invariant("not negative, 0 only if nothing is scattered", |(.., gamma), brdf: f32| {
                if (brdf > 0.0) == (gamma < 1.0) && brdf >= 0.0 { Ok(()) } else { Err(format!("BRDF {brdf}")) }
            })
            .pair("light and eye may change places", |(eye, light, gamma)| (light, eye, gamma), alike)
            .hard_case(
                "both exactly grazing, nothing absorbed",
                (0.0, 0.0, 0.0),
                (&[0.5 * 0.079_577_471_5 / grazing], 1e-4 / grazing),
                ("half_space_brdf_naive", f64::INFINITY),
            )
            .build(),
        formula(M, "half_space_brdf_naive", mirror::brdf_naive, oracle::brdf_naive, benign).benign(5e-4).build(),
        formula(M, "half_space_factor", mirror::factor, oracle::factor, shading)
            .edge("both exactly grazing", |(eye, light, _)| eye == 0.0 && light == 0.0)
            .edge("light exactly grazing", |(eye, light, _)| eye > 0.1 && light == 0.0)
            .edge("below the limit", |(eye, light, _)| eye > 0.0 && light > 0.0 && eye + light < HALF_SPACE_GRAZING)
            .edge("nothing absorbed", |(eye, light, gamma)| eye > 0.1 && light > 0.1 && gamma == 0.0)
            .edge("nothing scattered", |(eye, light, gamma)| eye > 0.1 && light > 0.1 && gamma == 1.0)
            .invariant("at least 0.6", |_, factor: f32| within("factor", factor, 0.6, 7e17))
            .pair("light and eye may change places", |(eye, light, gamma)| (light, eye, gamma), alike)
            .hard_case(
                "both exactly grazing",
                (0.0, 0.0, 0.0),
                (&[0.125 / grazing], 1e-4 / grazing),
                ("half_space_factor_naive", f64::INFINITY),
            )
            .hard_case(
                "nothing scattered",
                (0.5, 0.5, 1.0),
                (&[1.222_084_257], 1e-4),
                ("half_space_factor_naive", f64::INFINITY),
            )
            .build(),
        formula(M, "half_space_factor_naive", mirror::factor_naive, oracle::factor_naive, benign).benign(5e-4).build(),
    ]
}

fn boundary() -> Vec<Formula> {
    const NAIVE: &str = "half_space_edge_naive";
    vec![
        formula(M, "half_space_refract", mirror::refract, oracle::refract, |draws| (cosine(draws), index(draws)))
            .edge("no boundary", |(c, n)| n == 1.0 && c > 0.0 && c < 1.0)
            .edge("no boundary, all but grazing", |(c, n)| n == 1.0 && c > 0.0 && c < 1e-20)
            .edge("grazing", |(c, n)| c == 0.0 && n > 1.1)
            .edge("one ulp from none, grazing", |(c, n)| c == 0.0 && n == 1.0f32.next_up())
            .edge("into a thinner medium", |(_, n)| n < 1.0)
            .invariant("in [0, 1]", |_, cosine: f32| in_unit_range(cosine))
            .invariant("not farther from the normal", |(c, _), refracted: f32| {
                if refracted >= c.clamp(0.0, 1.0) || c < 2.0 * f32::MIN_POSITIVE {
                    Ok(())
                } else {
                    Err(format!("cosine {refracted}"))
                }
            })
            .build(),
        formula(M, "half_space_edge", mirror::edge, oracle::edge, |draws| (index(draws),))
            .edge("no boundary", |(n,)| n == 1.0)
            .edge("one ulp from none", |(n,)| n == 1.0f32.next_up())
            .edge("into a thinner medium", |(n,)| n < 1.0)
            .edge("the densest", |(n,)| n >= 4.0)
            .invariant("in [0, 0.981]", |_, edge: f32| within("edge", edge, 0.0, HALF_SPACE_LAST_EDGE.into()))
            .invariant(
                "0 without a boundary",
                |(n,), edge: f32| {
                    if n <= 1.0 { near("edge", edge.into(), 0.0, 0.0) } else { Ok(()) }
                },
            )
            .hard_case("no boundary", (1.0,), (&[0.0], 0.0), (NAIVE, f64::INFINITY))
            .hard_case("an index of 1.001", (1.001,), (&[0.048_236_667], 3e-6), (NAIVE, 1e-3))
            .build(),
        formula(M, "half_space_edge_naive", mirror::edge_naive, oracle::edge_naive, |draws| (draws.between(1.3, 3.0),))
            .benign(3e-5)
            .build(),
        formula(M, "half_space_gain", mirror::gain, oracle::gain, |draws| (share(draws), edge_of(draws)))
            .edge("no boundary", |(_, edge)| edge == 0.0)
            .edge("the densest, nothing absorbed", |(gamma, edge)| gamma == 0.0 && edge >= HALF_SPACE_LAST_EDGE)
            .edge("nothing scattered", |(gamma, _)| gamma == 1.0)
            .invariant("in [0.07, 12]", |_, gain: f32| within("gain", gain, 0.07, 12.0))
            .build(),
    ]
}

fn behind() -> Vec<Formula> {
    vec![
        formula(M, "half_space_inside", mirror::inside, oracle::inside, |draws| {
            let (eye, light) = cosines(draws);
            (eye, light, share(draws), edge_of(draws), strength(draws))
        })
        .edge("no boundary", |(.., edge, _)| edge == 0.0)
        .edge("no boundary, both grazing", |(eye, light, _, edge, _)| eye == 0.0 && light == 0.0 && edge == 0.0)
        .edge("both grazing", |(eye, light, _, edge, _)| eye == 0.0 && light == 0.0 && edge > 0.1)
        .edge("nothing absorbed", |(eye, light, gamma, edge, _)| eye > 0.1 && light > 0.1 && gamma == 0.0 && edge > 0.1)
        .edge("nothing thrown back", |(.., edge, gain)| edge > 0.1 && gain == 0.0)
        .invariant("half_space_brdf without a boundary", |(eye, light, gamma, edge, _), brdf: f32| {
            if edge > 0.0 {
                return Ok(());
            }
            let without = f64::from(mirror::brdf(eye, light, gamma));
            near("BRDF", brdf.into(), without, ROUNDED * without)
        })
        .pair(
            "light and eye may change places",
            |(eye, light, gamma, edge, gain)| (light, eye, gamma, edge, gain),
            alike,
        )
        .build(),
        formula(M, "half_space_dielectric", mirror::dielectric, oracle::dielectric, |draws| {
            let index = index(draws);
            let gamma = share(draws);
            let edge = mirror::edge(index);
            let (eye, light) = cosines(draws);
            (eye, light, gamma, index, edge, mirror::gain(gamma, edge))
        })
        .edge("no boundary", |(eye, light, _, index, ..)| index == 1.0 && eye > 0.1 && light > 0.1)
        .edge("no boundary, both grazing", |(eye, light, _, index, ..)| index == 1.0 && eye == 0.0 && light == 0.0)
        .edge("skin", |(.., index, _, _)| index == 1.4)
        .edge("both grazing", |(eye, light, _, index, ..)| eye == 0.0 && light == 0.0 && index > 1.1)
        .invariant("half_space_brdf without a boundary", |(eye, light, gamma, index, ..), brdf: f32| {
            if index > 1.0 {
                return Ok(());
            }
            let without = f64::from(mirror::brdf(eye, light, gamma));
            near("BRDF", brdf.into(), without, ROUNDED * without)
        })
        .pair(
            "light and eye may change places",
            |(eye, light, gamma, index, edge, gain)| (light, eye, gamma, index, edge, gain),
            alike,
        )
        .build(),
        formula(M, "half_space_slant", mirror::slant, oracle::slant, |draws| (share(draws), edge_of(draws)))
            .edge("no boundary", |(gamma, edge)| edge == 0.0 && gamma > 0.0)
            .edge("nothing scattered behind the densest", |(gamma, edge)| gamma == 1.0 && edge >= HALF_SPACE_LAST_EDGE)
            .invariant("in [1, 1.62]", |_, factor: f32| within("factor", factor, 0.999_999, 1.62))
            .build(),
        formula(M, "half_space_entered", mirror::entered, oracle::entered, |draws| (share(draws), edge_of(draws)))
            .edge("no boundary", |(gamma, edge)| edge == 0.0 && gamma > 0.0 && gamma < 1.0)
            .edge("nothing absorbed", |(gamma, edge)| gamma == 0.0 && edge > 0.1)
            .edge("nothing scattered", |(gamma, edge)| gamma == 1.0 && edge > 0.1)
            .invariant("in [0, 1]", |_, share: f32| in_unit_range(share))
            .invariant("half_space_reflectance without a boundary", |(gamma, edge), share: f32| {
                if edge > 0.0 {
                    return Ok(());
                }
                let without = f64::from(mirror::reflectance(gamma));
                near("share", share.into(), without, ROUNDED * without)
            })
            .build(),
        formula(M, "half_space_gamma_of_entered", mirror::gamma_of_entered, oracle::gamma_of_entered, |draws| {
            (share(draws), edge_of(draws))
        })
        .edge("no boundary", |(share, edge)| edge == 0.0 && share > 0.0 && share < 1.0)
        .edge("all leaves", |(share, edge)| share == 1.0 && edge > 0.1)
        .edge("nothing leaves", |(share, edge)| share == 0.0 && edge > 0.1)
        .edge("one ulp from white", |(share, edge)| share == 1.0f32.next_down() && edge > 0.1)
        .invariant("in [0, 1]", |_, gamma: f32| in_unit_range(gamma))
        .invariant("half_space_entered takes it back", |(share, edge), gamma: f32| {
            near("share", mirror::entered(gamma, edge).into(), f64::from(share.clamp(0.0, 1.0)), 1e-4)
        })
        .build(),
    ]
}
