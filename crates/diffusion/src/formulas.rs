//! Test inputs, edges, invariants and hard cases of `wgsl/diffusion.wgsl`.

mod outside;

use crate::{self as mirror, DIFFUSION_DEEPEST, DIFFUSION_FARTHEST, DIFFUSION_OPAQUE, oracle};
use glam::{Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};

const M: &str = "diffusion";

/// An extrapolation length near Milne's; the hard cases' limits are those of this one.
const MILNE: f32 = 0.7104;

/// Gamma at which kappa times a cosine of 1 is 1, to 5e-7.
const AT_POLE: f32 = 0.57735;

/// Relative error of two results that differ by rounding alone, on any device.
const ROUNDED: f64 = 6e-5;

/// What flushing may leave or take.
const FLUSHED: f64 = 1e-37;

/// Draws a cosine: every magnitude, the ends, around the limit, or out of range.
fn cosine(draws: &mut Draws<'_>) -> f32 {
    match draws.below(5) {
        0 => draws.pick(&[1.0, 0.0, -0.5, 1.5]),
        1 => draws.magnitude(-40, -1),
        2 => draws.nudged(mirror::DIFFUSION_GRAZING, 3),
        _ => draws.between(0.0, 1.0),
    }
}

/// Draws gamma: every magnitude of it and of its rest, the ends, about the pole, or out of range.
fn matter(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[0.0, 1.0, 0.5, -0.5, 1.5]),
        1 => draws.magnitude(-60, -1),
        2 => 1.0 - draws.magnitude(-24, -2),
        3 => draws.nudged(AT_POLE, 8),
        _ => draws.between(0.0, 1.0),
    }
}

/// Draws the optical depth of a node: 0, every magnitude, the limit, or out of range.
fn depth(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[0.0, 1.0, DIFFUSION_DEEPEST, -1.0, 1e7]),
        1 => draws.magnitude(-60, 19),
        2 => draws.nudged(DIFFUSION_DEEPEST, 3),
        _ => draws.between(0.0, 10.0),
    }
}

/// Draws an optical depth along a line: 0, every magnitude, about the branch at 1, or out of range.
fn thickness(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[0.0, 1.0, DIFFUSION_FARTHEST, -1.0, 1e16]),
        1 => draws.magnitude(-60, 49),
        2 => draws.nudged(1.0, 3),
        3 => draws.between(0.0, 3.0),
        _ => draws.between(0.0, 90.0),
    }
}

/// Draws an optical depth of which something is left.
fn clear(draws: &mut Draws<'_>) -> f32 {
    match draws.below(5) {
        0 => draws.pick(&[0.0, 1.0, DIFFUSION_OPAQUE, -1.0, 100.0]),
        1 => draws.magnitude(-60, 5),
        2 => draws.between(0.0, 1.0),
        _ => draws.between(0.0, 87.0),
    }
}

/// Draws a length, an area or a density that is not negative: 0, or every magnitude.
fn length(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => draws.pick(&[1.0, 0.0]),
        1 => draws.magnitude(-59, 58),
        _ => draws.between(0.0, 2.0),
    }
}

fn within(what: &str, value: f32, low: f64, high: f64) -> Result<(), String> {
    if (low..=high).contains(&f64::from(value)) { Ok(()) } else { Err(format!("{what} {value}")) }
}

/// Checks that two results are equal up to rounding.
fn alike<A>(_: A, one: f32, other: f32) -> Result<(), String> {
    near("difference", f64::from(one) - f64::from(other), 0.0, ROUNDED * f64::from(one).abs() + FLUSHED)
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [equation(), surface(), lines(), rays(), half_space(), nodes()].into_iter().flatten().collect()
}

fn equation() -> Vec<Formula> {
    vec![
        formula(M, "diffusion_milne", mirror::milne, oracle::milne, |draws| {
            (match draws.below(5) {
                0 => draws.pick(&[1.0, 1.4, 1.5, 2.5, 0.5, 3.0]),
                1 => 1.0 + draws.magnitude(-23, -2),
                2 => draws.nudged(1.0, 3),
                _ => draws.between(1.0, 2.5),
            },)
        })
        .edge("no boundary", |(index,)| index == 1.0)
        .edge("one ulp above", |(index,)| index == 1.0f32.next_up())
        .edge("glass", |(index,)| index == 1.5)
        .edge("out of range", |(index,)| index > 2.5)
        .invariant("at least that without a boundary", |_, length: f32| within("length", length, 0.7103, 10.4))
        .build(),
        formula(M, "diffusion_face", mirror::face, oracle::face, |draws| {
            let open = match draws.below(3) {
                0 => draws.pick(&[1.0, 0.0]),
                _ => draws.between(0.0, 1.0),
            };
            let distance = match draws.below(4) {
                0 => draws.nudged(mirror::DIFFUSION_LEAST_DISTANCE, 3),
                _ => length(draws),
            };
            let density = |draws: &mut Draws<'_>| match draws.below(4) {
                0 => draws.nudged(mirror::DIFFUSION_THINNEST, 3),
                _ => length(draws),
            };
            (open, distance, Vec2::new(density(draws), density(draws)))
        })
        .edge("shut", |(open, ..)| open == 0.0)
        .edge("nodes at one place", |(open, distance, _)| open > 0.0 && distance == 0.0)
        .edge("no density", |(open, _, densities)| open > 0.0 && densities == Vec2::ZERO)
        .edge("density on one side", |(open, _, densities)| {
            open > 0.0 && densities.min_element() == 0.0 && densities.max_element() > 0.1
        })
        .invariant("not negative", |_, conductance: f32| within("conductance", conductance, 0.0, 4001.0))
        .pair(
            "the same from both sides",
            |(open, distance, densities)| (open, distance, Vec2::new(densities.y, densities.x)),
            alike,
        )
        .hard_case("no density", (1.0, 1.0, Vec2::ZERO), (&[1000.0], 1e-3), ("diffusion_face_naive", f64::INFINITY))
        .build(),
        formula(M, "diffusion_face_naive", mirror::face_naive, oracle::face_naive, |draws| {
            let densities = Vec2::new(draws.between(0.01, 10.0), draws.between(0.01, 10.0));
            (draws.between(0.0, 1.0), draws.between(0.25, 2.0), densities)
        })
        .benign(3e-6)
        .build(),
    ]
}

fn surface() -> Vec<Formula> {
    vec![
        formula(M, "diffusion_surface", mirror::surface, oracle::surface, |draws| {
            let depth = match draws.below(4) {
                0 => draws.nudged(mirror::DIFFUSION_LEAST_DEPTH, 3),
                _ => length(draws),
            };
            let density = match draws.below(4) {
                0 => draws.nudged(mirror::DIFFUSION_THINNEST, 3),
                _ => length(draws),
            };
            (length(draws), depth, density, length(draws))
        })
        .edge("no surface", |(area, ..)| area == 0.0)
        .edge("a node at the surface", |(area, depth, ..)| area > 0.0 && depth == 0.0)
        .edge("no density", |(area, _, density, _)| area > 0.0 && density == 0.0)
        .edge("dense", |(area, .., milne)| area > 0.0 && milne == 0.0)
        .invariant("not negative", |(area, ..), conductance: f32| {
            within("conductance", conductance, 0.0, 20_001.0 * f64::from(area))
        })
        .hard_case(
            "no density",
            (1.0, 0.5, 0.0, 2.0),
            (&[1.0 / 2.0005], 1e-6),
            ("diffusion_surface_naive", f64::INFINITY),
        )
        .build(),
        formula(M, "diffusion_surface_naive", mirror::surface_naive, oracle::surface_naive, |draws| {
            (draws.between(0.0, 2.0), draws.between(0.05, 2.0), draws.between(0.01, 10.0), draws.between(0.1, 10.0))
        })
        .benign(3e-6)
        .build(),
        formula(M, "diffusion_profile", mirror::profile, oracle::profile, |draws| {
            let node_depth = length(draws);
            let depth = match draws.below(4) {
                0 => draws.nudged(node_depth, 3),
                1 => draws.pick(&[0.0, -1.0]),
                2 => node_depth * draws.between(0.0, 1.0),
                _ => length(draws),
            };
            (depth, node_depth, length(draws))
        })
        .edge("at the surface", |(depth, node_depth, milne)| depth == 0.0 && node_depth > 0.0 && milne > 0.0)
        .edge("at the node", |(depth, node_depth, _)| depth == node_depth && depth > 0.0)
        .edge("below it", |(depth, node_depth, _)| depth > node_depth && node_depth > 0.0)
        .edge("outside", |(depth, node_depth, _)| depth < 0.0 && node_depth > 0.0)
        .edge("nothing between", |(depth, node_depth, milne)| depth == 0.0 && node_depth == 0.0 && milne == 0.0)
        .edge("no extrapolation", |(depth, node_depth, milne)| depth < node_depth && depth > 0.0 && milne == 0.0)
        .invariant("a share", |_, share: f32| within("share", share, 0.0, 1.000_001))
        .hard_case(
            "a node at a surface without extrapolation",
            (0.0, 0.0, 0.0),
            (&[1.0], 0.0),
            ("diffusion_profile_naive", f64::INFINITY),
        )
        .build(),
        formula(M, "diffusion_profile_naive", mirror::profile_naive, oracle::profile_naive, |draws| {
            (draws.between(0.01, 10.0), draws.between(0.01, 10.0), draws.between(0.01, 10.0))
        })
        .benign(2e-6)
        .build(),
        formula(M, "diffusion_angle", mirror::angle, oracle::angle, |draws| {
            let cosine = match draws.below(4) {
                0 => draws.pick(&[1.0, 0.0, -0.5, 1.5]),
                1 => draws.magnitude(-60, -1),
                _ => draws.between(0.0, 1.0),
            };
            let milne = match draws.below(3) {
                0 => draws.pick(&[MILNE, 0.5, 20.0]),
                _ => draws.between(0.5, 20.0),
            };
            (cosine, draws.between(1.0, 3.0), draws.between(1.0, 3.0), matter(draws), milne)
        })
        .edge("grazing", |(cosine, ..)| cosine == 0.0)
        .edge("along the normal", |(cosine, ..)| cosine == 1.0)
        .edge("below the surface", |(cosine, ..)| cosine < 0.0)
        .edge("nothing absorbed", |(cosine, _, _, gamma, _)| cosine > 0.1 && gamma == 0.0)
        .edge("nothing scattered", |(cosine, _, _, gamma, _)| cosine > 0.1 && gamma == 1.0)
        .invariant("positive", |_, factor: f32| within("factor", factor, 0.12, 9.01))
        .build(),
    ]
}

fn lines() -> Vec<Formula> {
    let thin = 2f32.powi(-20);
    vec![
        formula(M, "diffusion_ramps", mirror::ramps, oracle::ramps, |draws| (thickness(draws),))
            .edge("no matter", |(x,)| x == 0.0)
            .edge("below the branch", |(x,)| x == 1.0f32.next_down())
            .edge("at the branch", |(x,)| x == 1.0)
            .edge("opaque", |(x,)| x > 1e6)
            .edge("out of range", |(x,)| x < 0.0)
            .invariant("more at the start", |_, means: Vec2| {
                if means.y >= 0.0 && f64::from(means.x) >= f64::from(means.y) * (1.0 - ROUNDED) && means.x <= 0.500_01 {
                    Ok(())
                } else {
                    Err(format!("means {means}"))
                }
            })
            .build(),
        formula(M, "diffusion_mean", mirror::mean, oracle::mean, |draws| {
            let near = if draws.below(3) == 0 { thickness(draws) } else { clear(draws) };
            let far = match draws.below(4) {
                0 => near,
                1 => draws.nudged(near, 3),
                2 => near + draws.magnitude(-23, 0),
                _ => thickness(draws),
            };
            (near, far)
        })
        .edge("equal", |(near, far)| near == far && near > 0.1 && near < 80.0)
        .edge("nearly equal", |(near, far)| near != far && near > 0.1 && (near - far).abs() < 1e-6 * near)
        .edge("falling", |(near, far)| near > far && far > 0.0 && near < 80.0)
        .edge("to the end", |(near, far)| near < 1.0 && far > 1e6)
        .edge("opaque", |(near, far)| near > DIFFUSION_OPAQUE && far > DIFFUSION_OPAQUE)
        .invariant("a share", |_, share: f32| within("share", share, 0.0, 1.000_01))
        .pair("either way", |(near, far)| (far, near), alike)
        .hard_case(
            "nearly equal depths",
            (1.0, 1.0 + thin),
            (&[0.367_879_265_753], 2e-7),
            ("diffusion_mean_naive", 3e-3),
        )
        .hard_case("equal depths", (1.0, 1.0), (&[0.367_879_441_171], 2e-7), ("diffusion_mean_naive", f64::INFINITY))
        .build(),
        formula(M, "diffusion_mean_naive", mirror::mean_naive, oracle::mean_naive, |draws| {
            (draws.between(0.0, 1.0), draws.between(2.0, 4.0))
        })
        .benign(5e-6)
        .build(),
        formula(M, "diffusion_scattered", mirror::scattered, oracle::scattered, |draws| {
            (clear(draws), thickness(draws))
        })
        .edge("no layer", |(_, x)| x == 0.0)
        .edge("2^-60", |(depth, x)| depth < 1.0 && x > 0.0 && x < 2f32.powi(-58))
        .edge("all of it", |(depth, x)| depth == 0.0 && x > 1e6)
        .edge("opaque", |(depth, x)| depth > DIFFUSION_OPAQUE && x > 1.0)
        .invariant("a share", |_, share: f32| within("share", share, 0.0, 1.000_01))
        .hard_case(
            "a thin layer",
            (1.0, 2f32.powi(-40)),
            (&[3.345_844_026_36e-13], 3e-19),
            ("diffusion_scattered_naive", 3e-13),
        )
        .build(),
        formula(M, "diffusion_scattered_naive", mirror::scattered_naive, oracle::scattered_naive, |draws| {
            (draws.between(0.0, 4.0), draws.between(1.0, 4.0))
        })
        .benign(6e-6)
        .build(),
    ]
}

fn rays() -> Vec<Formula> {
    const NAIVE: &str = "diffusion_segment_naive";
    let radiance = |draws: &mut Draws<'_>| match draws.below(4) {
        0 => draws.pick(&[1.0, 0.0]),
        1 => draws.magnitude(-20, 19),
        _ => draws.between(0.001, 1.0),
    };
    vec![
        formula(M, "diffusion_segment", mirror::segment, oracle::segment, move |draws| {
            (radiance(draws), radiance(draws), thickness(draws))
        })
        .edge("no matter", |(start, _, x)| start > 0.0 && x == 0.0)
        .edge("thin", |(start, end, x)| start > 0.0 && end > 0.0 && x > 0.0 && x < 1e-9)
        .edge("opaque", |(start, end, x)| start > 0.0 && end > 0.0 && x > 1e6)
        .edge("dark at the start", |(start, end, x)| start == 0.0 && end > 0.0 && x > 0.0)
        .edge("dark at the end", |(start, end, x)| start > 0.0 && end == 0.0 && x > 0.0)
        .invariant("between the ends", |(start, end, x), sent: f32| {
            let share = -(-f64::from(x.max(0.0))).exp_m1();
            let (low, high) = (f64::from(start.min(end)) * share, f64::from(start.max(end)) * share);
            within("sent", sent, low * (1.0 - ROUNDED) - FLUSHED, high * (1.0 + ROUNDED) + FLUSHED)
        })
        .hard_case("a thin segment", (0.0, 1.0, 2f32.powi(-10)), (&[4.879_634_749_46e-4], 1e-9), (NAIVE, 2e-5))
        .hard_case("no matter", (1.0, 2.0, 0.0), (&[0.0], 0.0), (NAIVE, f64::INFINITY))
        .build(),
        formula(M, NAIVE, mirror::segment_naive, oracle::segment_naive, |draws| {
            (draws.between(0.5, 1.0), draws.between(0.5, 1.0), draws.between(1.0, 4.0))
        })
        .benign(6e-6)
        .build(),
        formula(M, "diffusion_unscattered", mirror::unscattered, oracle::unscattered, |draws| {
            let (x, near) = (depth(draws), clear(draws));
            let far = match draws.below(4) {
                0 => near,
                1 => near - x,
                2 => draws.nudged(near - x, 3),
                _ => clear(draws),
            };
            (x, near, far)
        })
        .edge("no matter", |(x, ..)| x == 0.0)
        .edge("thin", |(x, near, _)| x > 0.0 && x < 1e-9 && near < 10.0)
        .edge("neither more nor less", |(x, near, far)| x > 0.1 && far > 0.1 && near < 80.0 && x + far == near)
        .edge("less and less", |(x, near, far)| x > 0.1 && far > 0.1 && near < 80.0 && x + far < near - 1.0)
        .edge("deep", |(x, near, _)| x > 1e5 && near < 10.0)
        .edge("deep, hardly lit", |(x, near, far)| x > 1e5 && near == DIFFUSION_OPAQUE && far < 80.0)
        .invariant("at most all", |(x, ..), sent: f32| {
            within("sent", sent, 0.0, (1.0 + ROUNDED) * f64::from(x.max(0.0)) + FLUSHED)
        })
        .hard_case(
            "the light comes nearer as the eye's way grows",
            (1.0, 3.0, 2.0),
            (&[0.049_787_068_367_9], 1e-7),
            ("diffusion_unscattered_naive", f64::INFINITY),
        )
        .build(),
        formula(M, "diffusion_unscattered_naive", mirror::unscattered_naive, oracle::unscattered_naive, |draws| {
            (draws.between(1.0, 4.0), draws.between(0.0, 1.0), draws.between(1.0, 4.0))
        })
        .benign(6e-6)
        .build(),
    ]
}

/// Draws an extrapolation length: a boundary's, the ends, or out of range.
fn extrapolation(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => draws.pick(&[MILNE, 0.5, 20.0, 0.0, 30.0]),
        _ => draws.between(0.5, 20.0),
    }
}

/// Draws a number from 0 to a limit, its ends, or out of range.
fn up_to(draws: &mut Draws<'_>, limit: f32) -> f32 {
    match draws.below(4) {
        0 => draws.pick(&[0.0, limit, -0.5, 2.0 * limit]),
        _ => draws.between(0.0, limit),
    }
}

fn half_space() -> Vec<Formula> {
    [of_light(), of_parts(), of_surroundings()].into_iter().flatten().collect()
}

fn of_light() -> Vec<Formula> {
    const NAIVE: &str = "diffusion_fluence_naive";
    vec![
        formula(M, "diffusion_fluence", mirror::fluence, oracle::fluence, |draws| {
            (depth(draws), cosine(draws), matter(draws), extrapolation(draws))
        })
        .edge("at the surface", |(depth, cosine, gamma, _)| depth == 0.0 && cosine > 0.1 && gamma < 0.9)
        .edge("grazing", |(_, cosine, gamma, _)| cosine == 0.0 && gamma < 0.9)
        .edge("at the pole", |(depth, cosine, gamma, _)| {
            depth > 0.1 && depth < 10.0 && cosine == 1.0 && (gamma - AT_POLE).abs() < 1e-6
        })
        .edge("deep, nothing absorbed", |(depth, cosine, gamma, _)| depth > 1e5 && cosine > 0.1 && gamma == 0.0)
        .edge("nothing scattered", |(_, cosine, gamma, _)| cosine > 0.1 && gamma == 1.0)
        .edge("a boundary that reflects much", |(_, cosine, gamma, milne)| cosine > 0.1 && gamma < 0.9 && milne > 20.0)
        .invariant("in [0, 63]", |_, fluence: f32| within("fluence", fluence, 0.0, 63.01))
        .hard_case(
            "diffusion decays as fast as the light",
            (1.0, 1.0, AT_POLE, MILNE),
            (&[0.520_675_525_373], 1e-6),
            (NAIVE, 1e-3),
        )
        .hard_case("exactly grazing", (0.0, 0.0, 0.0, MILNE), (&[2.131_199_955_94e-9], 1e-14), (NAIVE, f64::INFINITY))
        .build(),
        formula(M, NAIVE, mirror::fluence_naive, oracle::fluence_naive, |draws| {
            (draws.between(0.0, 3.0), draws.between(0.2, 1.0), draws.between(0.0, 0.4), draws.between(0.7, 4.0))
        })
        .benign(2e-5)
        .build(),
        formula(M, "diffusion_slab", mirror::slab, oracle::slab, |draws| {
            (depth(draws), matter(draws), extrapolation(draws))
        })
        .edge("no slab", |(x, gamma, _)| x == 0.0 && gamma < 0.9)
        .edge("thin", |(x, gamma, _)| x > 0.0 && x < 1e-9 && gamma < 0.9)
        .edge("thick, nothing absorbed", |(x, gamma, _)| x > 1e5 && gamma == 0.0)
        .edge("thick, hardly anything absorbed", |(x, gamma, _)| x > 1e4 && gamma > 1e-6 && gamma < 1e-4)
        .edge("nothing comes through", |(x, gamma, _)| x > 1e3 && gamma > 0.5 && gamma < 0.9)
        .edge("nothing scattered", |(x, gamma, _)| x > 0.1 && gamma == 1.0)
        .edge("a boundary that reflects much", |(x, gamma, milne)| x > 0.1 && gamma < 0.9 && milne > 20.0)
        .invariant("a share", |_, share: f32| within("share", share, 0.0, 0.52))
        .hard_case(
            "a thin slab that absorbs nothing",
            (2f32.powi(-30), 0.0, MILNE),
            (&[4.656_612_873_1e-10], 1e-15),
            ("diffusion_slab_naive", f64::INFINITY),
        )
        .build(),
        formula(M, "diffusion_slab_naive", mirror::slab_naive, oracle::slab_naive, |draws| {
            (draws.between(0.5, 8.0), draws.between(0.1, 0.5), draws.between(0.7, 4.0))
        })
        .benign(2e-5)
        .build(),
        formula(M, "diffusion_tail", mirror::tail, oracle::tail, |draws| {
            (depth(draws), cosine(draws), cosine(draws), matter(draws), extrapolation(draws))
        })
        .edge("from the surface", |(depth, eye, light, gamma, _)| {
            depth == 0.0 && eye > 0.1 && light > 0.1 && gamma < 0.9
        })
        .edge("both grazing", |(_, eye, light, gamma, _)| eye == 0.0 && light == 0.0 && gamma < 0.9)
        .edge("the eye grazing at the surface", |(depth, eye, light, gamma, _)| {
            depth == 0.0 && eye == 0.0 && light > 0.1 && gamma < 0.9
        })
        .edge("at the pole", |(depth, _, light, gamma, _)| {
            depth > 0.1 && light == 1.0 && (gamma - AT_POLE).abs() < 1e-6
        })
        .edge("nothing scattered", |(.., gamma, _)| gamma == 1.0)
        .invariant("in [0, 61.5]", |_, seen: f32| within("seen", seen, 0.0, 61.51))
        .build(),
    ]
}

fn of_parts() -> Vec<Formula> {
    const NAIVE: &str = "diffusion_local_naive";
    vec![
        formula(M, "diffusion_local", mirror::local, oracle::local, |draws| {
            let law = up_to(draws, 4.0);
            let angle = up_to(draws, 1.25);
            let of_matter = (matter(draws), extrapolation(draws));
            (cosine(draws), cosine(draws), law, of_matter.0, of_matter.1, depth(draws), depth(draws), angle)
        })
        .edge("both grazing", |(eye, light, _, gamma, ..)| eye == 0.0 && light == 0.0 && gamma < 0.9)
        .edge("a node at the surface", |(_, _, _, gamma, _, depth, _, _)| gamma < 0.9 && depth == 0.0)
        .edge("no second node", |(_, _, _, gamma, _, _, gap, _)| gamma < 0.9 && gap == 0.0)
        .edge("deep nodes", |(_, _, _, gamma, _, depth, gap, _)| gamma < 0.9 && depth > 1e5 && gap > 1e5)
        .edge("nothing absorbed", |(eye, light, _, gamma, ..)| eye > 0.1 && light > 0.1 && gamma == 0.0)
        .edge("at the pole", |(_, light, _, gamma, ..)| light == 1.0 && (gamma - AT_POLE).abs() < 1e-6)
        .edge("nothing scattered", |(_, _, _, gamma, ..)| gamma == 1.0)
        .edge("a grid that is not shown", |(_, _, _, gamma, .., angle)| gamma < 0.9 && angle == 0.0)
        .invariant("in [-7, 4]", |_, part: f32| within("part", part, -7.0, 4.0))
        .invariant("the law if nothing is scattered", |(_, _, law, gamma, ..), part: f32| {
            if gamma >= 1.0 { near("part", part.into(), law.clamp(0.0, 4.0).into(), 0.0) } else { Ok(()) }
        })
        .hard_case(
            "diffusion decays as fast as the light",
            (0.5, 1.0, 0.092_842_1, AT_POLE, MILNE, 1.0, 1.0, 1.0),
            (&[0.039_697_560_779], 5e-7),
            (NAIVE, 1e-4),
        )
        .hard_case(
            "no second node",
            (0.5, 1.0, 0.265_258_24, 0.0, MILNE, 0.5, 0.0, 1.0),
            (&[-0.029_031_394_742_8], 5e-7),
            (NAIVE, f64::INFINITY),
        )
        .hard_case(
            "light exactly grazing",
            (0.5, 0.0, 3e-10, 0.0, MILNE, 0.5, 0.5, 1.0),
            (&[-2.977_680_147_5e-12], 1e-13),
            (NAIVE, f64::INFINITY),
        )
        .build(),
        formula(M, NAIVE, mirror::local_naive, oracle::local_naive, |draws| {
            let (eye, light) = (draws.between(0.2, 1.0), draws.between(0.2, 1.0));
            // What is taken off the law is at most 1, by rounding of at most 2e-6 where the nodes are at
            // least 0.3 apart: from 2 on the difference keeps it.
            let (law, gamma) = (draws.between(2.0, 4.0), draws.between(0.1, 0.4));
            let (milne, angle) = (draws.between(0.7, 4.0), draws.between(0.8, 1.1));
            (eye, light, law, gamma, milne, draws.between(0.5, 4.0), draws.between(0.3, 2.0), angle)
        })
        .benign(2e-5)
        .build(),
    ]
}

fn of_surroundings() -> Vec<Formula> {
    vec![
        formula(M, "diffusion_local_around", mirror::local_around, oracle::local_around, |draws| {
            let (law, angle) = (up_to(draws, 1.0), up_to(draws, 1.25));
            let of_matter = (matter(draws), extrapolation(draws));
            (cosine(draws), law, of_matter.0, of_matter.1, depth(draws), depth(draws), angle)
        })
        .edge("grazing", |(eye, _, gamma, ..)| eye == 0.0 && gamma < 0.9)
        .edge("a node at the surface", |(_, _, gamma, _, depth, ..)| gamma < 0.9 && depth == 0.0)
        .edge("no second node", |(_, _, gamma, _, _, gap, _)| gamma < 0.9 && gap == 0.0)
        .edge("deep nodes", |(_, _, gamma, _, depth, gap, _)| gamma < 0.9 && depth > 1e5 && gap > 1e5)
        .edge("nothing absorbed", |(eye, _, gamma, .., angle)| eye > 0.1 && gamma == 0.0 && angle == 1.25)
        .edge("nothing scattered", |(_, _, gamma, ..)| gamma == 1.0)
        .invariant("in [-1.25, 1]", |_, part: f32| within("part", part, -1.250_01, 1.0))
        .invariant("a white furnace", |(_, law, gamma, .., angle), part: f32| {
            let left = f64::from(law.clamp(0.0, 1.0)) - f64::from(angle.clamp(0.0, 1.25));
            if gamma <= 0.0 { near("part", part.into(), left, 1e-5) } else { Ok(()) }
        })
        .build(),
    ]
}

fn nodes() -> Vec<Formula> {
    vec![
        formula(M, "diffusion_weight", mirror::weight, oracle::weight, |draws| {
            let place = |draws: &mut Draws<'_>| match draws.below(4) {
                0 => draws.pick(&[0.0, 1.0, 0.5, -0.5, 1.5]),
                1 => draws.magnitude(-30, -1),
                _ => draws.between(0.0, 1.0),
            };
            let corner = if draws.below(8) == 0 { draws.bits() } else { draws.below(8) };
            let fraction = match draws.below(6) {
                0 => draws.pick(&[Vec3::ZERO, Vec3::ONE]),
                _ => Vec3::new(place(draws), place(draws), place(draws)),
            };
            (fraction, corner, length(draws))
        })
        .edge("at the corner", |(fraction, corner, volume)| fraction == Vec3::ZERO && corner == 0 && volume > 0.0)
        .edge("at the opposite one", |(fraction, corner, volume)| fraction == Vec3::ONE && corner == 0 && volume > 0.0)
        .edge("the last corner", |(fraction, corner, volume)| {
            fraction.min_element() > 0.0 && corner == 7 && volume > 0.0
        })
        .edge("no matter", |(.., volume)| volume == 0.0)
        .edge("more than three bits", |(_, corner, _)| corner > 7)
        .invariant("at most the volume", |(.., volume), weight: f32| {
            within("weight", weight, 0.0, 1.000_102 * f64::from(volume) + FLUSHED)
        })
        .build(),
        formula(M, "diffusion_slope", mirror::slope, oracle::slope, |draws| {
            let missing = match draws.below(3) {
                0 => draws.signed(-59, 58),
                _ => draws.between(-2.0, 2.0),
            };
            let variance = match draws.below(3) {
                0 => draws.nudged(mirror::DIFFUSION_LEAST_VARIANCE, 3),
                _ => length(draws),
            };
            let distance = |draws: &mut Draws<'_>| match draws.below(3) {
                0 => draws.nudged(mirror::DIFFUSION_LEAST_STEP, 3),
                _ => length(draws),
            };
            (missing, variance, distance(draws), distance(draws))
        })
        .edge("nodes of one depth", |(missing, variance, ..)| missing != 0.0 && variance == 0.0)
        .edge("between the nodes", |(missing, variance, above, below)| {
            variance > 0.01 && missing * above < variance && -missing * below < variance && missing != 0.0
        })
        .edge("above all nodes", |(missing, variance, _, below)| below > 0.1 && -missing * below > 2.0 * variance)
        .edge("below all nodes", |(missing, variance, above, _)| above > 0.1 && missing * above > 2.0 * variance)
        .invariant("no weight is negative", |(_, _, above, below), slope: f32| {
            let [above, below] = [above, below].map(|distance| f64::from(distance.max(mirror::DIFFUSION_LEAST_STEP)));
            let least = (1.0 - f64::from(slope) * above).min(1.0 + f64::from(slope) * below);
            if least >= -1e-6 { Ok(()) } else { Err(format!("a weight of {least}")) }
        })
        .build(),
        formula(M, "diffusion_limit", mirror::limit, oracle::limit, |draws| {
            let fluence = |draws: &mut Draws<'_>| match draws.below(6) {
                0 => draws.pick(&[0.0, 1e-18]),
                1 => draws.magnitude(-59, 58),
                2 => -draws.between(0.0, 1.0),
                _ => draws.between(0.01, 1.0),
            };
            let one = fluence(draws);
            let other = if draws.below(4) == 0 { draws.nudged(one, 3) } else { fluence(draws) };
            let thickness = match draws.below(4) {
                0 => draws.magnitude(-40, 58),
                1 => draws.nudged(mirror::DIFFUSION_THINNEST_FACE, 3),
                _ => draws.between(0.05, 4.0),
            };
            (one, if other.is_subnormal() { 0.0 } else { other }, thickness)
        })
        .edge("equal fluences", |(one, other, _)| one == other && one > 0.0)
        .edge("no light", |(one, other, _)| one <= 0.0 && other <= 0.0)
        .edge("light on one side alone", |(one, other, _)| one > 0.0 && other <= 0.0)
        .edge("thin matter", |(one, other, thickness)| thickness < 1e-6 && one > 2.0 * other && other > 0.0)
        .edge("thick matter", |(one, other, thickness)| thickness > 1e3 && one != other)
        .invariant("in [0, 1] to rounding", |_, factor: f32| within("factor", factor, 0.0, 1.0 + 2e-6))
        .pair(
            "symmetric",
            |(one, other, thickness)| (other, one, thickness),
            |_, factor: f32, other: f32| near("factor", factor.into(), other.into(), 0.0),
        )
        .hard_case("equal fluences", (1.0, 1.0, 1.0), (&[1.0], 0.0), ("diffusion_limit_naive", f64::INFINITY))
        .hard_case(
            "a gentle slope",
            (1.0, 1.0 + 2f32.powi(-10), 1.0),
            (&[0.999_999_936_5], 2e-7),
            ("diffusion_limit_naive", 1e-2),
        )
        .hard_case("no light", (0.0, 0.0, 1.0), (&[1.0], 0.0), ("diffusion_limit_naive", f64::INFINITY))
        .build(),
        formula(M, "diffusion_limit_naive", mirror::limit_naive, oracle::limit_naive, |draws| {
            (draws.between(0.1, 0.4), draws.between(0.5, 1.0), draws.between(0.5, 2.0))
        })
        .benign(2e-4)
        .build(),
        formula(M, "diffusion_relax", mirror::relax, oracle::relax, |draws| {
            let amount = |draws: &mut Draws<'_>| match draws.below(4) {
                0 => 0.0,
                1 => draws.signed(-59, 58),
                _ => draws.between(-1.0, 1.0),
            };
            (amount(draws), amount(draws), length(draws), length(draws))
        })
        .edge("an isolated node", |(load, _, conductances, reaction)| {
            load != 0.0 && conductances == 0.0 && reaction == 0.0
        })
        .edge("nothing absorbed", |(.., conductances, reaction)| conductances > 0.0 && reaction == 0.0)
        .edge("nothing exchanged", |(.., conductances, reaction)| conductances == 0.0 && reaction > 0.0)
        .invariant("0 for an isolated node", |(.., conductances, reaction), value: f32| {
            if conductances + reaction > 0.0 { Ok(()) } else { near("value", value.into(), 0.0, 0.0) }
        })
        .hard_case("an isolated node", (0.0, 0.0, 0.0, 0.0), (&[0.0], 0.0), ("diffusion_relax_naive", f64::INFINITY))
        .build(),
        formula(M, "diffusion_relax_naive", mirror::relax_naive, oracle::relax_naive, |draws| {
            (draws.between(0.1, 1.0), draws.between(0.1, 1.0), draws.between(0.1, 6.0), draws.between(0.0, 1.0))
        })
        .benign(2e-6)
        .build(),
    ]
}
