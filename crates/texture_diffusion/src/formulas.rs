//! `wgsl/texture_diffusion.wgsl`.

mod outside;

use crate::{self as mirror, TEXTURE_DIFFUSION_REACH, TextureDiffusionTap, oracle};
use glam::{Vec2, Vec3, Vec4};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;

mirror_struct!(crate, TextureDiffusionTap { offset, weight });

const M: &str = "texture_diffusion";

/// Ratios at which a pair of taps is added.
const LADDER: [f32; 8] = [0.695, 0.345, 0.248, 0.198, 0.124, 0.104, 0.087, 0.073];

/// Draws bits of every kind.
fn any(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => draws.pick(&[
            0.0,
            -0.0,
            f32::NAN,
            -f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::MAX,
            f32::MIN,
            1e18,
            f32::from_bits(1),
            // NaNs with the least payload.
            f32::from_bits(0x7f80_0001),
            f32::from_bits(0xff80_0001),
        ]),
        1 => f32::from_bits(draws.bits()),
        2 => draws.signed(-10, 10),
        _ => draws.nudged(1e18, 3),
    }
}

/// Draws a length: of any valid magnitude, ordinary, 0 or invalid.
fn length(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[0.0, f32::NAN, -1.0, f32::INFINITY, f32::NAN]),
        1 => draws.magnitude(-59, 59),
        _ => draws.magnitude(-8, 2),
    }
}

/// Draws a material: equal channels, ratios near the steps of the ladder, any ratio, or independent
/// channels. Any channel may be the widest.
fn sigma0(draws: &mut Draws<'_>) -> Vec3 {
    if draws.below(4) == 0 {
        return Vec3::new(length(draws), length(draws), length(draws));
    }
    let widest = if draws.below(2) == 0 { 1.0 } else { draws.magnitude(-8, 8) };
    let ratio = match draws.below(5) {
        0 => draws.pick(&[1.0, 0.5, 0.25, 0.0625, 0.03125, 0.0]),
        1 | 2 => draws.pick(&LADDER) * draws.between(0.98, 1.02),
        3 => draws.magnitude(-14, -1),
        _ => draws.between(0.05, 1.0),
    };
    let between = draws.between(ratio, 1.0);
    let channels = widest * Vec3::new(1.0, between, ratio);
    match draws.below(3) {
        0 => channels,
        1 => Vec3::new(channels.z, channels.x, channels.y),
        _ => Vec3::new(channels.y, channels.z, channels.x),
    }
}

/// Draws a tap; in one case of two with the material's own number of pairs.
fn tap(draws: &mut Draws<'_>) -> (u32, u32, Vec3) {
    let sigma0 = sigma0(draws);
    let pairs = match draws.below(4) {
        0 => draws.pick(&[1, 0, 2, 1024]),
        1 => 1 + draws.below(64),
        _ => mirror::pairs(sigma0),
    };
    let index = match draws.below(6) {
        0 => draws.pick(&[0, pairs, pairs + 1]),
        _ => draws.below(pairs + 1),
    };
    (index, pairs, sigma0)
}

fn derivative(draws: &mut Draws<'_>) -> Vec3 {
    match draws.below(4) {
        0 => draws.pick(&[Vec3::ZERO, Vec3::X, Vec3::NEG_Y, Vec3::new(3.0, 0.0, 4.0)]),
        1 => draws.magnitude(-49, 49) * draws.unit_vector(),
        _ => draws.magnitude(-12, 2) * draws.in_cube(),
    }
}

/// Draws a sum of colours and its coverage.
fn sums(draws: &mut Draws<'_>) -> (Vec3, Vec3) {
    let coverage = |draws: &mut Draws<'_>| match draws.below(5) {
        0 => draws.pick(&[0.0, 1.0, 0.5, mirror::TEXTURE_DIFFUSION_SMALLEST]),
        1 => mirror::TEXTURE_DIFFUSION_SMALLEST * draws.between(0.9, 1.1),
        2 => draws.magnitude(-59, 19),
        _ => draws.between(0.0, 40.0),
    };
    let coverage = Vec3::new(coverage(draws), coverage(draws), coverage(draws));
    let irradiance = draws.magnitude(-10, 10) * (Vec3::ONE + draws.in_cube());
    (irradiance * coverage, coverage)
}

fn step(draws: &mut Draws<'_>) -> Vec2 {
    if draws.below(4) == 0 {
        return draws.pick(&[Vec2::X, Vec2::NEG_Y, Vec2::ONE, Vec2::ZERO, Vec2::splat(0.25)]);
    }
    Vec2::new(draws.below(5) as f32 - 2.0, draws.below(5) as f32 - 2.0)
}

/// Returns every function of the module, bound to its mirror and its oracle, with its promises
/// outside its domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [places(), widths(), taps(), means()].into_iter().flatten().collect()
}

fn places() -> Vec<Formula> {
    const NAIVE: &str = "texture_diffusion_clip_naive";
    let uv = |draws: &mut Draws<'_>| match draws.below(4) {
        0 => draws.pick(&[Vec2::ZERO, Vec2::ONE, Vec2::splat(0.5), Vec2::X]),
        1 => Vec2::new(draws.between(-4.0, 4.0), draws.between(-4.0, 4.0)),
        _ => draws.in_square(),
    };
    vec![
        formula(M, "texture_diffusion_clip", mirror::clip, oracle::clip, move |draws| (uv(draws),))
            .edge("the upper left corner", |(uv,)| uv == Vec2::ZERO)
            .edge("the lower right corner", |(uv,)| uv == Vec2::ONE)
            .edge("beyond a seam", |(uv,)| uv.x > 1.0 && uv.y > 0.0 && uv.y < 1.0)
            .invariant("the texture is the clip volume", |(uv,), place: Vec4| {
                let inside = uv.clamp(Vec2::ZERO, Vec2::ONE) == uv;
                let drawn = place.x.abs() <= 1.0 && place.y.abs() <= 1.0 && place.z == 0.0 && place.w == 1.0;
                if inside && !drawn { Err(format!("{place}")) } else { Ok(()) }
            })
            .hard_case("high up in the texture", (Vec2::new(0.5, 0.125),), (&[0.0, 0.75, 0.0, 1.0], 0.0), (NAIVE, 1.0))
            .build(),
        formula(M, NAIVE, mirror::clip_naive, oracle::clip_naive, |draws| (draws.in_square(),)).benign(1e-6).build(),
        formula(M, "texture_diffusion_stretch", mirror::stretch, oracle::stretch, |draws| {
            (derivative(draws), derivative(draws))
        })
        .edge("a texel without extent", |(x, y)| x == Vec3::ZERO && y != Vec3::ZERO)
        .edge("huge", |(x, _)| x.length() > 1e13)
        .edge("tiny", |(x, _)| x != Vec3::ZERO && x.length() < 1e-13)
        .build(),
    ]
}

fn widths() -> Vec<Formula> {
    const NAIVE: &str = "texture_diffusion_width_naive";
    vec![
        formula(M, "texture_diffusion_finite", mirror::finite, oracle::finite, |draws| (any(draws),))
            .edge("a NaN", |(x,)| x.is_nan())
            .edge("infinite", |(x,)| x.is_infinite())
            .edge("too large", |(x,)| x.is_finite() && x.abs() > 1e18)
            .edge("just large enough", |(x,)| x == 1e18)
            .build(),
        formula(M, "texture_diffusion_width", mirror::width, oracle::width, |draws| {
            let widest = draws.pick(&[512.0, 0.0, 1e6, -1.0, 512.0]);
            match draws.below(3) {
                0 => (any(draws), any(draws), widest),
                1 => (length(draws), mirror::TEXTURE_DIFFUSION_SMALLEST * draws.between(0.9, 1.1), 1e6),
                _ => (draws.magnitude(-8, 2), draws.magnitude(-12, 0), widest),
            }
        })
        .edge("a pole", |(s, k, w)| s > 0.0 && k == 0.0 && w > 0.0)
        .edge("no scattering off the charts", |(s, k, w)| s == 0.0 && k == 0.0 && w > 0.0)
        .edge("negative sigma0", |(s, k, w)| s < 0.0 && k > 0.0 && w > 0.0)
        .edge("sigma0 a NaN", |(s, _, w)| s.is_nan() && w > 0.0)
        .edge("stretch a NaN", |(s, k, w)| s > 0.0 && k.is_nan() && w > 0.0)
        .edge("stretch infinite", |(s, k, w)| s > 0.0 && k.is_infinite() && w > 0.0)
        .edge("wider than the widest", |(s, k, w)| k > 0.0 && w > 0.0 && s / k > w)
        .invariant("from 0 to the widest", |(.., widest), width: f32| {
            if (0.0..=widest.max(0.0)).contains(&width) { Ok(()) } else { Err(format!("width {width}")) }
        })
        .hard_case_with("a pole", (0.25, 0.0, 512.0), (&[512.0], 0.0), (NAIVE, (0.25, 0.0), f64::INFINITY))
        .hard_case_with("off the charts", (0.0, 0.0, 512.0), (&[0.0], 0.0), (NAIVE, (0.0, 0.0), f64::INFINITY))
        .hard_case_with("negative sigma0", (-1.0, 0.5, 512.0), (&[0.0], 0.0), (NAIVE, (-1.0, 0.5), 1.9))
        .hard_case_with("sigma0 a NaN", (f32::NAN, 0.5, 512.0), (&[0.0], 0.0), (NAIVE, (f32::NAN, 0.5), f64::INFINITY))
        .hard_case_with("near a pole", (0.25, 1e-6, 512.0), (&[512.0], 0.0), (NAIVE, (0.25, 1e-6), 2e5))
        .build(),
        formula(M, NAIVE, mirror::width_naive, oracle::width_naive, |draws| {
            (draws.magnitude(-19, 19), draws.magnitude(-19, 19))
        })
        .benign(1e-6)
        .build(),
        formula(M, "texture_diffusion_sigma", mirror::sigma, oracle::sigma, |draws| {
            (Vec3::new(any(draws), any(draws), any(draws)),)
        })
        .edge("a NaN among others", |(s,)| s.x.is_nan() && s.y > 0.0)
        .edge("a negative one among others", |(s,)| s.z < 0.0 && s.y > 0.0)
        .build(),
        formula(M, "texture_diffusion_ratio", mirror::ratio, oracle::ratio, |draws| (sigma0(draws),))
            .edge("equal channels", |(s,)| s.x == s.y && s.y == s.z && s.x > 0.0)
            .edge("a channel that does not scatter", |(s,)| s.min_element() == 0.0 && s.max_element() > 0.0)
            .edge("red the widest", |(s,)| s.x > s.y && s.x > s.z)
            .edge("green the widest", |(s,)| s.y > s.x && s.y > s.z)
            .edge("blue the widest", |(s,)| s.z > s.y && s.z > s.x)
            .invariant("in [1/16, 1]", |_, ratio: f32| {
                if (0.0625..=1.0).contains(&ratio) { Ok(()) } else { Err(format!("ratio {ratio}")) }
            })
            .build(),
    ]
}

fn taps() -> Vec<Formula> {
    const NAIVE: &str = "texture_diffusion_tap_naive";
    vec![
        formula(M, "texture_diffusion_pairs", mirror::pairs, oracle::pairs, |draws| (sigma0(draws),))
            .edge("fewest", |(s,)| mirror::ratio(s) >= LADDER[0])
            .edge("most", |(s,)| mirror::ratio(s) < LADDER[7])
            .edge("between", |(s,)| (LADDER[4]..LADDER[3]).contains(&mirror::ratio(s)))
            .invariant(
                "from 15 to 23",
                |_, pairs: u32| {
                    if (15..=23).contains(&pairs) { Ok(()) } else { Err(format!("{pairs} pairs")) }
                },
            )
            .build(),
        formula(M, "texture_diffusion_tap", mirror::tap, oracle::tap, tap)
            .edge("the middle", |(index, ..)| index == 0)
            .edge("the last", |(index, pairs, _)| index == pairs && pairs > 1)
            .edge("beyond the last", |(index, pairs, _)| index > pairs && pairs > 1)
            .edge("no pairs", |(_, pairs, _)| pairs == 0)
            .edge("one channel does not scatter", |(index, _, s)| index > 0 && s.z == 0.0 && s.x > 0.0)
            .edge("nothing scatters", |(index, _, s)| index > 0 && s.max_element() <= 0.0)
            .invariant("within reach, weights not negative", |_, tap: TextureDiffusionTap| {
                let reach = (0.0..=TEXTURE_DIFFUSION_REACH * (1.0 + 1e-6)).contains(&tap.offset);
                // Far out, tiny values of the exponential may or may not be flushed to 0.
                if reach && tap.weight.min_element() >= 0.0 { Ok(()) } else { Err(format!("{tap:?}")) }
            })
            .pair("farther from tap to tap", |(index, pairs, s)| (index + 1, pairs, s), {
                |(index, pairs, _), one: TextureDiffusionTap, next: TextureDiffusionTap| {
                    let farther = next.offset > one.offset;
                    if farther == (index < pairs.max(1)) { Ok(()) } else { Err(format!("{one:?} {next:?}")) }
                }
            })
            .pair("a material's scale does not matter", |(index, pairs, s)| (index, pairs, 4.0 * s), {
                |(_, _, s), one: TextureDiffusionTap, other: TextureDiffusionTap| {
                    // Numbers count as at most 1e18, and divisors as at least 2^-60.
                    if s.is_nan() || s.max_element() > 1e17 || (s.max_element() > 0.0 && s.max_element() < 1e-17) {
                        return Ok(());
                    }
                    near("offset", f64::from(one.offset), f64::from(other.offset), 0.0)
                }
            })
            .hard_case(
                "nothing scatters",
                (1, 17, Vec3::ZERO),
                (&[0.064_150_943, 0.0, 0.0, 0.0], 1e-6),
                (NAIVE, f64::INFINITY),
            )
            .hard_case(
                "blue does not scatter: it keeps to the middle",
                (0, 23, Vec3::new(1.0, 0.5, 0.0)),
                (&[0.0, 1.0, 1.0, 1.0], 0.0),
                (NAIVE, f64::INFINITY),
            )
            .hard_case(
                "sigma0 a NaN",
                (0, 23, Vec3::new(1.0, f32::NAN, 0.5)),
                (&[0.0, 1.0, 1.0, 1.0], 0.0),
                (NAIVE, f64::INFINITY),
            )
            .build(),
        formula(M, NAIVE, mirror::tap_naive, oracle::tap_naive, |draws| {
            let pairs = 1 + draws.below(32);
            let share = |draws: &mut Draws<'_>| draws.between(0.25, 1.0);
            (draws.below(pairs / 2 + 1), pairs, Vec3::new(share(draws), share(draws), share(draws)))
        })
        .benign(2e-5)
        .build(),
    ]
}

fn means() -> Vec<Formula> {
    const NAIVE: &str = "texture_diffusion_normalize_naive";
    vec![
        formula(M, "texture_diffusion_normalize", mirror::normalize, oracle::normalize, sums)
            .edge("nothing covered", |(_, coverage)| coverage == Vec3::ZERO)
            .edge("one channel's taps find nothing", |(_, coverage)| coverage.z == 0.0 && coverage.x > 0.0)
            .edge("hardly anything covered", |(_, coverage)| coverage.y > 0.0 && coverage.y < 1e-17)
            .hard_case_with(
                "constant light at a chart's edge, half of the taps outside",
                (Vec3::splat(0.375), Vec3::splat(0.5)),
                (&[0.75; 3], 0.0),
                (NAIVE, (Vec3::splat(0.375), Vec3::ONE), 0.37),
            )
            .hard_case("no chart in reach", (Vec3::ZERO, Vec3::ZERO), (&[0.0; 3], 0.0), (NAIVE, f64::INFINITY))
            .build(),
        formula(M, NAIVE, mirror::normalize_naive, oracle::normalize_naive, |draws| {
            (draws.magnitude(-10, 10) * draws.in_cube(), Vec3::splat(draws.magnitude(-19, 19)))
        })
        .benign(1e-6)
        .build(),
        formula(M, "texture_diffusion_half", mirror::half, oracle::half, |draws| {
            let value = |draws: &mut Draws<'_>| match draws.below(6) {
                0 => draws.pick(&[0.0, 1.0, 65504.0, 65519.0, 1e18, -65520.0, 6.103_515_6e-5]),
                // Halfway between two half floats, of either parity, or 1 ulp from it.
                1 | 2 => {
                    let tie = 2048.0 + draws.below(2048) as f32 + 0.5;
                    draws.nudged(tie, 1)
                }
                3 => draws.signed(-14, 20),
                _ => draws.between(0.0, 1.0).max(6.103_515_6e-5),
            };
            (Vec3::new(value(draws), value(draws), value(draws)),)
        })
        .edge("a tie between", |(v,)| v.x > 2048.0 && v.x < 4096.0 && v.x.fract() == 0.5)
        .edge("the largest and beyond", |(v,)| v.y > 65504.0)
        .edge("negative", |(v,)| v.z < 0.0)
        .build(),
        formula(M, "texture_diffusion_nearness", mirror::nearness, oracle::nearness, |draws| (step(draws),))
            .edge("a neighbour", |(step,)| step.length() == 1.0)
            .edge("the corner", |(step,)| step.abs() == Vec2::splat(2.0))
            .edge("closer than a texel", |(step,)| step.length() < 1.0)
            .build(),
    ]
}
