//! Promises of the functions outside their domains, one for each clause of their `Outside:` lines.

use crate::oracle as cdrf;
use glam::{UVec2, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::outside::{Promise, accurate, any_bits, any_finite, close, finite, holds, like, nothing, that};

/// Returns all promises of the module.
pub(super) fn promises() -> Vec<Promise> {
    [reflectances(), tables()].into_iter().flatten().collect()
}

fn two(draws: &mut Draws<'_>) -> (f32, f32) {
    (any_finite(draws), any_finite(draws))
}

fn not_negative(value: f32) -> Result<(), String> {
    that(value >= 0.0 && value.is_finite(), || format!("the result is {value}"))
}

/// Returns a draw of a cosine with a fixed blur.
fn blurred(sigma: f32) -> impl Fn(&mut Draws<'_>) -> (f32, f32) {
    move |draws| (draws.between(-1.0, 1.0), sigma)
}

/// Passes if the reflectance is as close to the true one as the line says, except for rounding.
fn off_by(most: f64) -> impl Fn((f32, f32), f32) -> Result<(), String> {
    move |(cosine, sigma), reflectance| {
        // The figure in the line has two digits; the bound of the accuracy line is the rounding
        // error.
        let bound = 1.05 * most + 1.2e-6;
        close(&[reflectance], &[cdrf::accurate(cosine.into(), sigma.into())], bound)
    }
}

fn reflectances() -> Vec<Promise> {
    const EDGE: &str = "cdrf_edge";
    const FADES: &str = "not negative and finite, ever less accurate";
    const CHEAP: &str = "cdrf_cheap";
    let wide = |least: f32| {
        move |draws: &mut Draws<'_>| {
            (any_finite(draws), if draws.below(2) == 0 { draws.between(least, 4.0) } else { draws.magnitude(-1, 127) })
        }
    };
    let one_bits = |draws: &mut Draws<'_>| (any_bits(draws),);
    let one = |draws: &mut Draws<'_>| (any_finite(draws),);
    vec![
        accurate("cdrf_finite", "nothing; a subnormal may count as zero", one_bits),
        accurate("cdrf_sigma", "nothing", |draws| (any_bits(draws), any_bits(draws))),
        accurate("cdrf_sigma_power", "nothing", |draws| (any_bits(draws), any_bits(draws))),
        accurate("cdrf_drift", "nothing", |draws| (any_bits(draws), any_bits(draws), any_finite(draws))),
        accurate("cdrf_shifted", "nothing", two),
        accurate("cdrf_arcsine", "nothing", one),
        holds(
            "cdrf_deviations",
            "finite while the quotient is",
            |draws| (draws.signed(-126, 20), draws.magnitude(-60, 127).max(2f32.powi(-60))),
            |_: (f32, f32), deviations: f32| that(deviations.abs() <= 12.0, || format!("{deviations} deviations")),
        ),
        like(
            "cdrf_deviations",
            "a negative sigma counts as 0",
            |draws| (draws.between(-1.5, 1.5), -draws.magnitude(-126, 127)),
            |(x, _): (f32, f32)| (x, 0.0),
        ),
        accurate("cdrf_normal_density", "as long as u^2 is finite", |draws| (draws.signed(-126, 62),)),
        accurate("cdrf_normal_share", "nothing", one),
        accurate("cdrf_lambert", "nothing", one),
        accurate("cdrf_wrap", "nothing", two),
        accurate("cdrf_series", "nothing", |draws| (any_finite(draws), any_finite(draws), draws.below(17))),
        finite("cdrf_series", "but the time that more terms take", |draws| {
            (draws.between(-1.0, 1.0), 0.3, draws.below(300))
        }),
        holds(EDGE, FADES, wide(0.3), |_: (f32, f32), value: f32| not_negative(value)),
        holds(EDGE, "off by 4.8e-7 at 0.35", blurred(0.35), off_by(4.8e-7)),
        holds(EDGE, "1.2e-4 at 0.5", blurred(0.5), off_by(1.2e-4)),
        accurate("cdrf_accurate", "nothing", two),
        finite(CHEAP, "the formula goes on, up to 1: off by rounding where the cosine is", |draws| {
            let end = draws.pick(&[1.0, -1.0]);
            (draws.nudged(end, 64), any_finite(draws))
        }),
        finite(CHEAP, "finite up to 10", |draws| (draws.signed(0, 3), any_finite(draws))),
        accurate("cdrf_rgb", "nothing", |draws| {
            let sigma = Vec3::new(any_bits(draws), any_bits(draws), any_bits(draws));
            (any_finite(draws), sigma, any_bits(draws))
        }),
        accurate("cdrf_sine", "nothing", one),
        accurate("cdrf_quadrature", "nothing", two),
        holds("cdrf_spherical_edge", FADES, wide(0.1), |_: (f32, f32), value: f32| not_negative(value)),
        accurate("cdrf_spherical", "nothing", two),
        accurate("cdrf_harmonic_weights", "nothing", one),
    ]
}

fn tables() -> Vec<Promise> {
    const TEXEL: &str = "cdrf_table_texel";
    const TEXTURE: &str = "cdrf_texture_coordinates";
    let size = |draws: &mut Draws<'_>| UVec2::new(2 + draws.below(60), 2 + draws.below(60));
    vec![
        accurate("cdrf_table_coordinates", "nothing", |draws| (any_finite(draws), any_finite(draws))),
        like(
            TEXEL,
            "a texel beyond the last counts as the last",
            move |draws| {
                let size = size(draws);
                (size + UVec2::new(draws.below(9), draws.below(1 << 20)), size, draws.in_cube().abs())
            },
            |(_, size, tint): (UVec2, UVec2, Vec3)| (size - 1, size, tint),
        ),
        like(
            TEXEL,
            "A size below 2 counts as 2",
            |draws| {
                (
                    UVec2::new(draws.below(2), draws.below(2)),
                    UVec2::new(draws.below(3), draws.below(2)),
                    draws.in_cube().abs(),
                )
            },
            |(texel, size, tint): (UVec2, UVec2, Vec3)| (texel, size.max(UVec2::splat(2)), tint),
        ),
        holds(
            TEXTURE,
            "extrapolates",
            move |draws| (Vec2::new(draws.signed(0, 20), draws.signed(0, 20)), size(draws)),
            |(coordinates, size): (Vec2, UVec2), place: Vec2| {
                let (position, size) = (coordinates.as_dvec2(), size.as_dvec2());
                let wanted = (position * (size - 1.0) + 0.5) / size;
                close(&place.to_array(), &wanted.to_array(), 1e-6 * (1.0 + position.abs().max_element()))
            },
        ),
        nothing(TEXTURE, "size 0 has no texel"),
        like(
            "cdrf_texels",
            "coordinates are clamped to [0, 1]",
            move |draws| (Vec2::new(any_finite(draws), any_finite(draws)), size(draws)),
            |(coordinates, size): (Vec2, UVec2)| (coordinates.clamp(Vec2::ZERO, Vec2::ONE), size),
        ),
        holds(
            "cdrf_blend",
            "extrapolates",
            |draws| {
                let weight = Vec2::new(draws.between(-8.0, 8.0), draws.between(-8.0, 8.0));
                (weight, draws.in_cube(), draws.in_cube(), draws.in_cube(), draws.in_cube())
            },
            |(weight, lower_left, lower_right, upper_left, upper_right): (Vec2, Vec3, Vec3, Vec3, Vec3),
             blend: Vec3| {
                let (x, y) = (f64::from(weight.x), f64::from(weight.y));
                let mix = |left: Vec3, right: Vec3| left.as_dvec3() * (1.0 - x) + right.as_dvec3() * x;
                let wanted = mix(lower_left, lower_right) * (1.0 - y) + mix(upper_left, upper_right) * y;
                let sum = (1.0 + 2.0 * x.abs()) * (1.0 + 2.0 * y.abs());
                close(&blend.to_array(), &wanted.to_array(), 1e-6 * sum)
            },
        ),
    ]
}
