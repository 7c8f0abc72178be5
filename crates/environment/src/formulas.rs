//! Test inputs, edges, invariants and hard cases of `wgsl/environment.wgsl`.

mod outside;

use crate::{self as mirror, EnvironmentHarmonics, EnvironmentTexels, oracle};
use glam::{DVec2, UVec2, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;
use std::f64::consts::PI;

mirror_struct!(crate, EnvironmentTexels { lower, upper, weight });
mirror_struct!(crate, EnvironmentHarmonics { zeroth, first, second, fourth });

const M: &str = "environment";

/// Error of the length of a direction computed from sines and cosines that are each 5 ulp off.
const UNIT: f64 = 32.0 / (1 << 24) as f64;

/// Draws a coordinate of any normal magnitude, or zero.
fn coordinate(draws: &mut Draws<'_>) -> f32 {
    match draws.below(8) {
        0 => 0.0,
        1..=3 => draws.signed(-126, 125),
        _ => draws.between(-1.0, 1.0),
    }
}

/// Draws any direction: all over the sphere, near the poles, near the seam, along the axes, of
/// every length.
fn direction(draws: &mut Draws<'_>) -> Vec3 {
    let near_axis = |draws: &mut Draws<'_>| draws.signed(-30, -1);
    match draws.below(8) {
        0 => Vec3::new(near_axis(draws), draws.pick(&[1.0, -1.0]), near_axis(draws)),
        1 => Vec3::new(-1.0, draws.between(-1.0, 1.0), draws.signed(-40, -10)),
        2 => Vec3::new(coordinate(draws), draws.signed(-126, 125), coordinate(draws)),
        // A component may have become subnormal.
        3 => (draws.unit_vector() * draws.magnitude(-120, 120)).map(|x| if x.is_subnormal() { 0.0 } else { x }),
        _ => draws.unit_vector(),
    }
}

/// Draws a light, with its axis and up vector, and a direction aimed at its edges or anywhere.
fn softbox_inputs(draws: &mut Draws<'_>) -> (Vec3, Vec3, Vec3, Vec2, f32) {
    let axis = draws.unit_vector().as_dvec3().normalize();
    let up = draws.perpendicular(axis);
    // Orthogonalized twice, because one short cross product leaves them an ulp or more from
    // perpendicular.
    let up = (up - up.dot(axis) * axis).normalize();
    let softness = match draws.below(4) {
        0 => draws.pick(&[1.0, 1.0 / 256.0]),
        _ => draws.between(1.0 / 256.0, 1.0),
    };
    let half_size = Vec2::new(draws.between(softness, 8.0), draws.between(softness, 2.0));
    let direction = match draws.below(8) {
        0 => axis,
        1 => up,
        2 => -axis,
        3 | 4 => draws.direction(),
        _ => aimed(draws, axis.as_vec3(), up.as_vec3(), half_size, softness).as_dvec3(),
    };
    (direction.as_vec3(), axis.as_vec3(), up.as_vec3(), half_size, softness)
}

/// Draws a unit direction into the rectangle of a light, or up to a fifth beyond its edges.
fn aimed(draws: &mut Draws<'_>, axis: Vec3, up: Vec3, half_size: Vec2, softness: f32) -> Vec3 {
    let (axis, up) = (axis.as_dvec3(), up.as_dvec3());
    let reach = 1.2 * (half_size.as_dvec2() + f64::from(softness));
    let offset = DVec2::new(2.0 * draws.unit() - 1.0, 2.0 * draws.unit() - 1.0) * reach;
    (axis + offset.x * up.cross(axis) + offset.y * up).normalize().as_vec3()
}

/// A light's axis, up vector, half size and softness.
type Light = ([f32; 3], [f32; 3], [f32; 2], f32);

/// Lights of the studio, as in the WGSL, at which directions are aimed.
const LIGHTS: [Light; 9] = [
    ([-2.0, 6.0, 3.0], [6.0, 3.0, -2.0], [0.28, 0.28], 0.05),
    ([0.0, 24.0, -7.0], [0.0, 7.0, 24.0], [0.70, 0.06], 0.03),
    ([6.0, 3.0, 2.0], [-2.0, 6.0, -3.0], [0.08, 0.45], 0.04),
    ([-2.0, 1.0, -2.0], [2.0, 2.0, -1.0], [0.09, 0.40], 0.04),
    ([4.0, 7.0, -4.0], [1.0, 4.0, 8.0], [0.08, 0.08], 0.03),
    ([1.0, 2.0, 2.0], [-2.0, 2.0, -1.0], [0.07, 0.07], 0.03),
    ([2.0, 3.0, -6.0], [6.0, 2.0, 3.0], [0.06, 0.06], 0.03),
    ([0.0, -3.0, -4.0], [0.0, 4.0, -3.0], [0.60, 0.20], 0.10),
    ([0.0, -5.0, 12.0], [0.0, 12.0, 5.0], [0.50, 0.14], 0.10),
];

fn studio_direction(draws: &mut Draws<'_>) -> (Vec3,) {
    let direction = match draws.below(4) {
        0 => draws.unit_vector(),
        _ => {
            let (axis, up, half_size, softness) = draws.pick(&LIGHTS);
            let (axis, up) = (Vec3::from(axis).normalize(), Vec3::from(up).normalize());
            aimed(draws, axis, up, Vec2::from(half_size), softness)
        }
    };
    (direction,)
}

/// Draws a point of a map and the map's size: on texel edges, at the borders, anywhere.
fn texel_inputs(draws: &mut Draws<'_>) -> (Vec2, UVec2) {
    let side = |draws: &mut Draws<'_>| match draws.below(3) {
        0 => 1 + draws.below(8),
        1 => draws.pick(&[2048, 1024, 16_384]),
        _ => 1 + draws.below(16_384),
    };
    let size = UVec2::new(side(draws), side(draws));
    let u = match draws.below(4) {
        0 => draws.pick(&[0.0, 1.0, 0.5, 2.0]),
        1 => draws.below(4 * size.x) as f32 / size.x as f32,
        2 => draws.magnitude(-30, 1),
        _ => draws.between(0.0, 4.0),
    };
    let v = match draws.below(4) {
        0 => draws.pick(&[0.0, 1.0]),
        1 => draws.below(size.y + 1) as f32 / size.y as f32,
        2 => draws.magnitude(-30, -1),
        _ => draws.between(0.0, 1.0),
    };
    (Vec2::new(u, v), size)
}

fn within(what: &str, value: f64, low: f64, high: f64) -> Result<(), String> {
    if (low..=high).contains(&value) { Ok(()) } else { Err(format!("{what} is {value}, outside [{low}, {high}]")) }
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [angle_formulas(), coordinate_formulas(), texel_formulas(), light_formulas()].into_iter().flatten().collect()
}

fn angle_formulas() -> Vec<Formula> {
    vec![
        formula(M, "environment_turns", mirror::turns, oracle::turns, |draws| match draws.below(64) {
            0 => (f32::MIN_POSITIVE, f32::MIN_POSITIVE),
            _ => (coordinate(draws), coordinate(draws)),
        })
        .edge("the shortest that counts", |(y, x)| y == f32::MIN_POSITIVE && x == f32::MIN_POSITIVE)
        .edge("origin", |(y, x)| y == 0.0 && x == 0.0)
        .edge("behind, above the seam", |(y, x)| x < 0.0 && y > 0.0)
        .edge("behind, below the seam", |(y, x)| x < 0.0 && y < 0.0)
        .edge("on the seam", |(y, x)| x < 0.0 && y == 0.0)
        .edge("steep", |(y, x)| x != 0.0 && y.abs() > 1e30 * x.abs())
        .pair(
            "mirroring y turns the other way",
            |(y, x)| (-y, x),
            |(y, x), turns: f32, other: f32| {
                if y == 0.0 && x < 0.0 {
                    near("seam", other.into(), turns.into(), 0.0)
                } else {
                    near("sum", f64::from(turns) + f64::from(other), 0.0, 0.0)
                }
            },
        )
        .build(),
        formula(M, "environment_hypot", mirror::hypot, oracle::hypot, |draws| (coordinate(draws), coordinate(draws)))
            .edge("origin", |(a, b)| a == 0.0 && b == 0.0)
            .edge("squares that underflow", |(a, b)| a != 0.0 && a.abs().max(b.abs()) < 1e-25)
            .edge("squares that overflow", |(a, b)| a.abs().min(b.abs()) > 1e20)
            .build(),
        formula(M, "environment_sine", mirror::sine, oracle::sine, |draws| {
            (match draws.below(4) {
                0 => (draws.below(65) as f32 - 32.0) / 4.0,
                1 => draws.signed(-126, 126),
                _ => draws.between(-8.0, 8.0),
            },)
        })
        .edge("quarter turns", |(turns,)| turns.abs().fract() == 0.25)
        .edge("angles beyond the last fraction", |(turns,)| turns.abs() > 1e8)
        .invariant("in [-1, 1] to rounding", |_, sine: f32| near("size", f64::from(sine).abs().max(1.0), 1.0, UNIT))
        .pair("odd", |(turns,)| (-turns,), |_, sine: f32, other: f32| near("sum", f64::from(sine + other), 0.0, 0.0))
        .build(),
    ]
}

fn coordinate_formulas() -> Vec<Formula> {
    vec![
        formula(M, "environment_uv_from_direction", mirror::uv_from_direction, oracle::uv_from_direction, |draws| {
            (direction(draws),)
        })
        .edge("at a pole", |(d,)| d.x == 0.0 && d.z == 0.0)
        .edge("near a pole", |(d,)| d.x.abs().max(d.z.abs()) < 1e-5 * d.y.abs() && d.x != 0.0)
        .edge("about the seam", |(d,)| d.x < 0.0 && d.z.abs() < 1e-6 * d.x.abs())
        .edge("length below 1e-20", |(d,)| d.abs().max_element() < 1e-20)
        .edge("length above 1e19", |(d,)| d.abs().max_element() > 1e19)
        .invariant("in the map", |_, uv: Vec2| {
            within("u", uv.x.into(), 0.0, 1.0)?;
            within("v", uv.y.into(), 0.0, 1.0)
        })
        .invariant_at_nearest("the direction comes back", |(d,), uv: Vec2| {
            let back = oracle::direction_from_uv(uv.as_dvec2());
            near("distance", back.distance(d.as_dvec3().normalize()), 0.0, 8e-6)
        })
        .pair(
            "upside down is 1 - v",
            |(d,)| (Vec3::new(d.x, -d.y, d.z),),
            |_, uv: Vec2, other: Vec2| near("sum of v", f64::from(uv.y) + f64::from(other.y), 1.0, 3e-7),
        )
        .hard_case(
            "near the zenith",
            (Vec3::new(1e-4, 1.0, 2e-4),),
            (&[0.676_208, 7.117_63e-5], 1e-6),
            ("environment_uv_from_direction_naive", 5e-5),
        )
        .hard_case(
            "near the nadir",
            (Vec3::new(3e-4, -1.0, 1e-4),),
            (&[0.551_208, 0.999_899_34], 1e-6),
            ("environment_uv_from_direction_naive", 5e-5),
        )
        .hard_case(
            "length 5e-24",
            (Vec3::new(3e-24, 4e-24, 0.0),),
            (&[0.5, 0.204_832_76], 1e-6),
            ("environment_uv_from_direction_naive", f64::INFINITY),
        )
        .hard_case(
            "length 5e19",
            (Vec3::new(3e19, 4e19, 0.0),),
            (&[0.5, 0.204_832_76], 1e-6),
            ("environment_uv_from_direction_naive", 0.1),
        )
        .build(),
        formula(
            M,
            "environment_uv_from_direction_naive",
            mirror::uv_from_direction_naive,
            oracle::uv_from_direction,
            // WGSL allows acos an error of 6.8e-5, and atan2 on lavapipe is a polynomial of similar
            // accuracy.
            |draws| {
                let d = draws.direction();
                let d = if d.y.abs() > 0.99 || (d.x < 0.0 && d.z.abs() < 1e-3) {
                    glam::DVec3::new(0.6, 0.0, 0.8)
                } else {
                    d
                };
                (d.as_vec3(),)
            },
        )
        .benign(4e-4)
        .build(),
        formula(M, "environment_direction_from_uv", mirror::direction_from_uv, oracle::direction_from_uv, |draws| {
            let v = if draws.below(3) == 0 { draws.magnitude(-30, -1) } else { draws.between(0.0, 1.0) };
            let v = if draws.below(16) == 0 { draws.pick(&[0.0, 0.5, 1.0]) } else { v };
            (Vec2::new(draws.between(0.0, 1.0), v),)
        })
        .edge("zenith", |(uv,)| uv.y == 0.0)
        .edge("nadir", |(uv,)| uv.y == 1.0)
        .edge("near the zenith", |(uv,)| uv.y > 0.0 && uv.y < 1e-6)
        .invariant("unit length", |_, d: Vec3| near("length", d.as_dvec3().length(), 1.0, UNIT))
        .build(),
    ]
}

fn texel_formulas() -> Vec<Formula> {
    vec![
        formula(M, "environment_texels", mirror::texels, oracle::texels, texel_inputs)
            .edge("a map of one texel", |(_, size)| size == UVec2::ONE)
            .edge("across the seam", |(uv, size)| uv.x.fract() * (size.x as f32) < 0.4)
            .edge("at the top", |(uv, _)| uv.y == 0.0)
            .edge("at the bottom", |(uv, _)| uv.y == 1.0)
            .edge("on a texel's edge", |(uv, size)| uv.x > 1.0 && (uv.x * size.x as f32).fract() == 0.0)
            .invariant("inside the map, neighbours", |(_, size), texels: EnvironmentTexels| {
                let EnvironmentTexels { lower, upper, weight } = texels;
                let inside = lower.cmplt(size).all() && upper.cmplt(size).all();
                let neighbours = upper.x == (lower.x + 1) % size.x && upper.y == (lower.y + 1).min(size.y - 1);
                let weights = weight.cmpge(Vec2::ZERO).all() && weight.cmple(Vec2::ONE).all();
                if inside && neighbours && weights { Ok(()) } else { Err(format!("{texels:?} of {size}")) }
            })
            .hard_case(
                "on the seam",
                (Vec2::new(0.0, 0.5), UVec2::new(8, 4)),
                (&[7.0, 1.0, 0.0, 2.0, 0.5, 0.5], 1e-6),
                ("environment_texels_naive", 1.0),
            )
            .hard_case(
                "just before the seam",
                (Vec2::new(0.999, 0.5), UVec2::new(8, 4)),
                (&[7.0, 1.0, 0.0, 2.0, 0.492, 0.5], 1e-5),
                ("environment_texels_naive", 1.0),
            )
            .build(),
        formula(M, "environment_texels_naive", mirror::texels_naive, oracle::texels, |draws| {
            let size = UVec2::new(4 + draws.below(60), 4 + draws.below(60));
            // Well inside a cell between texel centres, so that rounding does not decide the
            // column.
            let share = |draws: &mut Draws<'_>, side: u32| {
                (0.6 + draws.below(side - 1) as f32 + draws.between(0.0, 0.8)) / side as f32
            };
            let u = share(draws, size.x);
            (Vec2::new(u, share(draws, size.y)), size)
        })
        .benign(1e-4)
        .build(),
    ]
}

fn light_formulas() -> Vec<Formula> {
    vec![
        formula(M, "environment_softbox", mirror::softbox, oracle::softbox, softbox_inputs)
            .edge("behind", |(d, axis, ..)| d.dot(axis) < 0.0)
            .edge("exactly beside", |(d, axis, ..)| d.dot(axis) == 0.0)
            .edge("in the middle", |(d, axis, ..)| d == axis)
            .edge("in the soft edge", |(d, axis, up, half_size, softness)| {
                let coverage = mirror::softbox(d, axis, up, half_size, softness);
                coverage > 0.01 && coverage < 0.99
            })
            .invariant("in [0, 1]", |_, coverage: f32| within("coverage", coverage.into(), 0.0, 1.0 + UNIT))
            .pair(
                "as much to the left as to the right",
                |(d, axis, up, half_size, softness)| (mirrored(d, up.cross(axis)), axis, up, half_size, softness),
                |(.., softness), coverage: f32, other: f32| {
                    // The slope of the smoothstep is 3/4 over the softness; the direction moves by
                    // an ulp or two, at a tangent of 8.
                    near("difference", f64::from(coverage - other), 0.0, 64.0 * UNIT / f64::from(softness))
                },
            )
            .hard_case(
                "a light behind",
                (Vec3::NEG_Z, Vec3::Z, Vec3::Y, Vec2::ONE, 0.5),
                (&[0.0], 0.0),
                ("environment_softbox_naive", 1.0),
            )
            .build(),
        formula(M, "environment_softbox_naive", mirror::softbox_naive, oracle::softbox, |draws| {
            let axis = draws.direction();
            let up = draws.perpendicular(axis);
            let softness = draws.between(0.25, 1.0);
            let half_size = Vec2::splat(softness) + Vec2::new(draws.between(0.0, 1.0), draws.between(0.0, 1.0));
            // In the middle, in the inner half of the soft edge, which keeps the value away from 0,
            // or well beyond the edge.
            let reach = if draws.below(8) == 0 {
                2.0 * half_size.as_dvec2() + DVec2::ONE
            } else {
                half_size.as_dvec2() * (2.0 * DVec2::new(draws.unit(), draws.unit()) - 1.0)
            };
            let d = (axis + reach.x * up.cross(axis) + reach.y * up).normalize();
            (d.as_vec3(), axis.as_vec3(), up.as_vec3(), half_size, softness)
        })
        .benign(1e-5)
        .build(),
        formula(M, "environment_harmonics", mirror::harmonics, oracle::harmonics, |draws| (draws.unit_vector(),))
            .edge("along an axis", |(d,)| d.abs().max_element() == 1.0)
            .edge("near the orders' axis", |(d,)| d.z.abs() > 0.999 && d.z.abs() < 1.0)
            .invariant("squares add up by degree", |_, found: EnvironmentHarmonics| {
                let squares = |values: &[f32]| values.iter().map(|value| f64::from(*value).powi(2)).sum::<f64>();
                let all = [&[found.zeroth][..], &found.first.to_array(), &found.second, &found.fourth];
                for (degree, values) in [0.0, 1.0, 2.0, 4.0].into_iter().zip(all) {
                    near("sum", squares(values), (2.0 * degree + 1.0) / (4.0 * PI), 1e-5)?;
                }
                Ok(())
            })
            .build(),
        formula(M, "environment_dome", mirror::dome, oracle::dome, |draws| {
            let light = |draws: &mut Draws<'_>| draws.magnitude(-10, 10) * (Vec3::ONE + 0.9 * draws.in_cube());
            (draws.unit_vector(), light(draws), light(draws))
        })
        .edge("zenith", |(d, ..)| d == Vec3::Y)
        .edge("nadir", |(d, ..)| d == Vec3::NEG_Y)
        .build(),
        formula(M, "environment_studio", mirror::studio, oracle::studio, studio_direction)
            .edge("in a light", |(d,)| mirror::studio(d).max_element() > 5.0)
            .edge("in the dark", |(d,)| mirror::studio(d).max_element() < 0.06)
            .edge("zenith", |(d,)| d == Vec3::Y)
            .edge("nadir", |(d,)| d == Vec3::NEG_Y)
            .invariant("within its stated range", |_, radiance: Vec3| {
                within("least", radiance.min_element().into(), 0.0239, 20.4)?;
                within("greatest", radiance.max_element().into(), 0.0239, 20.4)
            })
            .build(),
    ]
}

/// Reflects `d` in the plane through the origin with the unit normal `normal`.
fn mirrored(d: Vec3, normal: Vec3) -> Vec3 {
    let (d, normal) = (d.as_dvec3(), normal.as_dvec3().normalize());
    (d - 2.0 * d.dot(normal) * normal).as_vec3()
}
