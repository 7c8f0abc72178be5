//! Test inputs, edges, invariants and hard cases of `wgsl/random_walk.wgsl`.

mod outside;

use crate::{self as mirror, RandomWalkBasis, RandomWalkCrossing, oracle};
use glam::{DVec3, UVec4, Vec2, Vec3, Vec4};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;
use std::f64::consts::{FRAC_1_PI, TAU};

mirror_struct!(crate, RandomWalkBasis { tangent, bitangent });
mirror_struct!(crate, RandomWalkCrossing { direction, crosses });

const M: &str = "random_walk";

/// Error of a unit vector's length after three squares, two sums and the rounding of the inputs.
const UNIT: f64 = 24.0 / (1 << 24) as f64;

/// Draws a random number as the module makes it: the ends, near either end, anywhere.
fn uniform(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[0.0, 1.0 - f32::EPSILON / 2.0, 0.5, f32::EPSILON / 2.0]),
        1 => draws.magnitude(-24, -1),
        2 => 1.0 - draws.magnitude(-24, -1),
        _ => (draws.bits() >> 8) as f32 * (f32::EPSILON / 2.0),
    }
}

/// Draws the same, or a number out of range.
fn clamped(draws: &mut Draws<'_>) -> f32 {
    if draws.below(8) == 0 { draws.pick(&[1.0, -0.25, 1.25]) } else { uniform(draws) }
}

/// Draws an anisotropy: every magnitude, the ends, near them, out of range.
fn anisotropy(draws: &mut Draws<'_>) -> f32 {
    let limit = mirror::RANDOM_WALK_STRAIGHTEST;
    match draws.below(6) {
        0 => draws.pick(&[0.0, 1.0, -1.0, 1.5, -1.5, limit, -limit]),
        1 => draws.signed(-40, -2),
        2 => (1.0 - draws.magnitude(-24, -2)) * draws.pick(&[1.0, -1.0]),
        _ => draws.between(-1.0, 1.0),
    }
}

fn cosine(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[1.0, -1.0, 0.0, 1.0f32.next_up(), -1.5]),
        1 => 1.0 - draws.magnitude(-24, -2),
        2 => draws.magnitude(-24, -2) - 1.0,
        _ => draws.between(-1.0, 1.0),
    }
}

fn majorant(draws: &mut Draws<'_>) -> f32 {
    if draws.below(8) == 0 { draws.pick(&[0.0, -1.0, 1e-30, 1e-33]) } else { draws.magnitude(-40, 40) }
}

fn turns(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => draws.nudged(0.25, 2) * draws.pick(&[0.0, 1.0, 2.0, 3.0, -1.0, -2.0]),
        1 => draws.signed(-40, -2),
        _ => draws.between(-3.0, 3.0),
    }
}

/// Draws a unit vector, sometimes near the poles or near the equator, where the basis changes its
/// side.
fn normal(draws: &mut Draws<'_>) -> Vec3 {
    let tilt = f64::from(draws.signed(-40, -3));
    match draws.below(4) {
        0 => DVec3::new(tilt, f64::from(draws.signed(-40, -3)), draws.pick(&[1.0, -1.0])).normalize().as_vec3(),
        1 => {
            let (sine, cosine) = (TAU * draws.unit()).sin_cos();
            DVec3::new(cosine, sine, tilt).normalize().as_vec3()
        }
        _ => draws.unit_vector(),
    }
}

/// Draws the cosine and sine of any angle.
fn unit_pair(draws: &mut Draws<'_>) -> Vec2 {
    let angle = if draws.below(3) == 0 { f64::from(draws.signed(-30, 0)) } else { TAU * draws.unit() };
    Vec2::new(angle.cos() as f32, angle.sin() as f32)
}

/// Draws light, normal, relative index and random number at a boundary.
fn crossing(draws: &mut Draws<'_>) -> (Vec3, Vec3, f32, f32) {
    let normal = draws.unit_vector();
    let axis = normal.as_dvec3().normalize();
    let index = match draws.below(5) {
        0 => draws.pick(&[1.0, 1.5, 1.0 / 1.5, 4.0, 0.25]),
        1 => 1.0 + draws.signed(-23, -3),
        2 => draws.between(0.25, 1.0),
        _ => draws.between(1.0, 4.0),
    };
    let up = match draws.below(5) {
        0 => f64::from(draws.pick(&[0.0f32, 1.0])),
        1 => f64::from(draws.magnitude(-24, -1)),
        // Near the critical angle.
        2 if index < 1.0 => (1.0 - f64::from(index).powi(2)).sqrt() * (1.0 + f64::from(draws.signed(-20, -3))),
        _ => draws.unit(),
    };
    let up = up.clamp(0.0, 1.0);
    let incident = ((1.0 - up) * (1.0 + up)).sqrt() * draws.perpendicular(axis) - up * axis;
    (incident.normalize().as_vec3(), normal, index, uniform(draws))
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a.as_dvec3().dot(b.as_dvec3())
}

fn unit(vector: Vec3) -> Result<(), String> {
    near("length", vector.as_dvec3().length(), 1.0, UNIT)
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [numbers(), paths(), scattering(), directions(), surfaces()].into_iter().flatten().collect()
}

fn numbers() -> Vec<Formula> {
    let counter = |draws: &mut Draws<'_>| match draws.below(3) {
        0 => UVec4::new(draws.below(4), draws.below(4), draws.below(4), draws.below(4)),
        1 => UVec4::MAX - UVec4::new(draws.below(4), draws.below(4), 0, 0),
        _ => UVec4::new(draws.bits(), draws.bits(), draws.bits(), draws.bits()),
    };
    vec![
        formula(M, "random_walk_bits", mirror::bits, oracle::bits, move |draws| (counter(draws),))
            .edge("the first counter", |(counter,)| counter == UVec4::ZERO)
            .edge("the last counter", |(counter,)| counter == UVec4::MAX)
            .pair(
                "neighbours have other bits",
                |(counter,)| (counter ^ UVec4::X,),
                |_, one: UVec4, other: UVec4| if one == other { Err(format!("{one} twice")) } else { Ok(()) },
            )
            .build(),
        formula(M, "random_walk_random", mirror::random, oracle::random, move |draws| (counter(draws),))
            .invariant("in [0, 1), on multiples of 2^-24", |_, numbers: Vec4| {
                let whole = (numbers.as_dvec4() * f64::from(1 << 24)).fract() == glam::DVec4::ZERO;
                let inside = numbers.cmpge(Vec4::ZERO).all() && numbers.cmplt(Vec4::ONE).all();
                if whole && inside { Ok(()) } else { Err(format!("{numbers}")) }
            })
            .build(),
    ]
}

fn paths() -> Vec<Formula> {
    const NAIVE: &str = "random_walk_free_path_naive";
    const RATIO_NAIVE: &str = "random_walk_ratio_naive";
    let tiny = 2f32.powi(-30);
    vec![
        formula(M, "random_walk_free_path", mirror::free_path, oracle::free_path, |draws| {
            let u = match draws.below(8) {
                0 => draws.magnitude(-100, -20),
                1 => draws.nudged(1.0 - std::f32::consts::FRAC_1_SQRT_2, 2),
                _ => clamped(draws),
            };
            (u, majorant(draws))
        })
        .edge("no path", |(u, _)| u == 0.0)
        .edge("the longest", |(u, m)| u == 1.0 - f32::EPSILON / 2.0 && m > 1.0)
        .edge("a number far below f32's steps at 1", |(u, _)| u > 0.0 && u < 1e-10)
        .edge("no matter", |(u, m)| m == 0.0 && u > 0.0)
        .edge("a number of 1", |(u, _)| u >= 1.0)
        .invariant("not negative", |_, path: f32| if path >= 0.0 { Ok(()) } else { Err(format!("{path}")) })
        .pair(
            "longer for a greater number",
            |(u, m)| (u.clamp(0.0, 1.0) * 0.5 + 0.5, m),
            |_, path: f32, other: f32| if other >= path * (1.0 - 1e-6) { Ok(()) } else { Err(format!("{other}")) },
        )
        .hard_case("a number of 2^-30", (tiny, 1.0), (&[f64::from(tiny)], 1e-15), (NAIVE, 9e-10))
        .hard_case("no matter", (0.5, 0.0), (&[0.5f64.ln().abs() * 1e30], 1e24), (NAIVE, f64::INFINITY))
        .hard_case("a number of 1", (1.0, 1.0), (&[24.0 * 2f64.ln()], 1e-5), (NAIVE, f64::INFINITY))
        .build(),
        formula(M, "random_walk_free_path_naive", mirror::free_path_naive, oracle::free_path_naive, |draws| {
            (draws.between(0.1, 0.9), draws.magnitude(-9, 9))
        })
        .benign(1e-5)
        .build(),
        formula(M, "random_walk_collision", mirror::collision, oracle::collision, |draws| {
            let majorant = if draws.below(32) == 0 { 0.0 } else { draws.magnitude(-40, 40) };
            let u = uniform(draws);
            let share = if draws.below(4) == 0 { draws.pick(&[0.0, 1.0]) } else { draws.between(0.0, 1.0) };
            let scattered = if draws.below(4) == 0 { draws.pick(&[0.0, 1.0]) } else { draws.between(0.0, 1.0) };
            let scattering = scattered * share * majorant;
            (u, scattering, (share * majorant - scattering).max(0.0), majorant)
        })
        .edge("no matter", |(_, s, a, _)| s == 0.0 && a == 0.0)
        .edge("no number and no scattering", |(u, s, a, _)| u == 0.0 && s == 0.0 && a > 0.0)
        .edge("no number and nothing", |(u, s, a, _)| u == 0.0 && s == 0.0 && a == 0.0)
        .edge("nothing anywhere", |(_, _, _, m)| m == 0.0)
        .edge("as dense as the majorant", |(_, s, a, m)| s == m && a == 0.0 && m > 0.0)
        .invariant("only what is there happens", |(u, s, a, m), event: u32| {
            let possible = match event {
                mirror::RANDOM_WALK_SCATTERED => s > 0.0,
                mirror::RANDOM_WALK_ABSORBED => a > 0.0,
                _ => s < m || u >= 1.0 || m == 0.0,
            };
            if possible { Ok(()) } else { Err(format!("event {event}")) }
        })
        .build(),
        formula(M, "random_walk_ratio", mirror::ratio, oracle::ratio, |draws| {
            let majorant = draws.magnitude(-20, 20);
            let density = match draws.below(4) {
                0 => draws.pick(&[0.0, 1.0, 1.5]) * majorant,
                1 => draws.nudged(majorant, 3),
                _ => draws.between(0.0, 1.0) * majorant,
            };
            (draws.between(0.0, 1.0), density, if draws.below(16) == 0 { 0.0 } else { majorant })
        })
        .edge("no matter", |(_, d, m)| d == 0.0 && m > 0.0)
        .edge("as dense as the majorant", |(_, d, m)| d == m)
        .edge("denser", |(_, d, m)| d > 1.2 * m)
        .edge("a step less dense", |(_, d, m)| d == m.next_down())
        .edge("no majorant", |(t, _, m)| m == 0.0 && t > 0.0)
        .hard_case(
            "a step below the majorant",
            (1.0, 3.0f32.next_down(), 3.0),
            (&[2f64.powi(-22) / 3.0], 1e-13),
            (RATIO_NAIVE, 1e-8),
        )
        .hard_case("neither density nor majorant", (1.0, 0.0, 0.0), (&[1.0], 0.0), (RATIO_NAIVE, f64::INFINITY))
        .build(),
        formula(M, "random_walk_ratio_naive", mirror::ratio_naive, oracle::ratio_naive, |draws| {
            let majorant = draws.magnitude(-9, 9);
            (draws.between(0.1, 1.0), draws.between(0.0, 0.5) * majorant, majorant)
        })
        .benign(1e-6)
        .build(),
    ]
}

fn scattering() -> Vec<Formula> {
    const PHASE: &str = "random_walk_phase_naive";
    const NAIVE: &str = "random_walk_deflection_naive";
    let limit = f64::from(mirror::RANDOM_WALK_STRAIGHTEST);
    let peak = 0.25 * FRAC_1_PI * (1.0 + limit) / (1.0 - limit).powi(2);
    vec![
        formula(M, "random_walk_phase", mirror::phase, oracle::phase, |draws| (cosine(draws), anisotropy(draws)))
            .edge("isotropic", |(_, g)| g == 0.0)
            .edge("straight on, g 1", |(c, g)| c == 1.0 && g == 1.0)
            .edge("straight back, g -1", |(c, g)| c == -1.0 && g == -1.0)
            .edge("a cosine out of range", |(c, _)| c.abs() > 1.0)
            .edge("a g out of range", |(_, g)| g.abs() > 1.0)
            .invariant_at_nearest("isotropic for g = 0", |(_, g), value: f32| {
                if g == 0.0 { near("phase", value.into(), 0.25 * FRAC_1_PI, 2e-8) } else { Ok(()) }
            })
            .pair(
                "forwards as backwards",
                |(c, g)| (-c, -g),
                |_, one: f32, other: f32| near("difference", f64::from(one) - f64::from(other), 0.0, 0.0),
            )
            .hard_case(
                "1 - g * g instead of two factors: backwards, nearly always straight on",
                (-f32::from_bits(0x3f4d_c5fc), f32::from_bits(0x3f7f_f4b1)),
                (&[4.008_624_400_82e-6], 1e-11),
                (PHASE, 3e-10),
            )
            .hard_case("straight on, g 1", (1.0, 1.0), (&[peak], 1e-5 * peak), (PHASE, f64::INFINITY))
            .build(),
        formula(M, "random_walk_phase_naive", mirror::phase_naive, oracle::phase_naive, |draws| {
            (draws.between(-1.0, 1.0), draws.between(-0.8, 0.8))
        })
        .benign(1e-4)
        .build(),
        formula(M, "random_walk_deflection", mirror::deflection, oracle::deflection, |draws| {
            (clamped(draws), anisotropy(draws))
        })
        .edge("isotropic", |(_, g)| g == 0.0)
        .edge("nearly isotropic", |(_, g)| g != 0.0 && g.abs() < 1e-6)
        .edge("g above 1", |(_, g)| g > 1.0)
        .edge("straight back", |(u, _)| u == 0.0)
        .edge("straight on", |(u, _)| u == 1.0)
        .invariant("cosine and sine", |_, deflection: Vec2| {
            near("length", deflection.as_dvec2().length(), 1.0, UNIT)?;
            if deflection.y >= 0.0 { Ok(()) } else { Err(format!("sine {}", deflection.y)) }
        })
        .hard_case("isotropic", (0.75, 0.0), (&[0.5, 0.75f64.sqrt()], 1e-6), (NAIVE, f64::INFINITY))
        .hard_case("g 1e-5", (0.75, 1e-5), (&[0.500_011_25, 0.866_018_91], 1e-6), (NAIVE, 1e-4))
        .hard_case(
            "1 - g * g instead of two factors: nearly straight on, sent back",
            (f32::from_bits(0x35a3_ac14), f32::from_bits(0x3f7f_f4c3)),
            (&[-0.944_310_531_09, 0.329_055_650_115], 2e-6),
            (NAIVE, 5e-4),
        )
        .hard_case("a sine of 3e-4", (0.3, 0.9999), (&[0.999_999_949_436, 3.180_076e-4], 1e-7), (NAIVE, 1e-5))
        .build(),
        formula(M, "random_walk_deflection_naive", mirror::deflection_naive, oracle::deflection_naive, |draws| {
            (draws.between(0.05, 0.95), draws.between(0.3, 0.8) * draws.pick(&[1.0, -1.0]))
        })
        .benign(1e-4)
        .build(),
    ]
}

fn directions() -> Vec<Formula> {
    const NAIVE: &str = "random_walk_basis_naive";
    let orthonormal = |normal: Vec3, basis: RandomWalkBasis| {
        unit(basis.tangent)?;
        unit(basis.bitangent)?;
        near("normal . tangent", dot(normal, basis.tangent), 0.0, UNIT)?;
        near("tangent . bitangent", dot(basis.tangent, basis.bitangent), 0.0, UNIT)?;
        near("handedness", dot(basis.tangent.cross(basis.bitangent), normal), 1.0, UNIT)
    };
    let down = Vec3::NEG_Z;
    vec![
        formula(M, "random_walk_azimuth", mirror::azimuth, oracle::azimuth, |draws| (turns(draws),))
            .edge("quarter turns", |(t,)| t.abs() == 0.25)
            .edge("half turns", |(t,)| t == 0.5)
            .build(),
        formula(M, "random_walk_basis", mirror::basis, oracle::basis, |draws| (normal(draws),))
            .edge("down", |(n,)| n == Vec3::NEG_Z)
            .edge("nearly down", |(n,)| n.z < 0.0 && n.truncate().length() < 1e-6)
            .edge("level", |(n,)| n.z == 0.0)
            .edge("just below level", |(n,)| n.z < 0.0 && n.z > -1e-6)
            .invariant("a right-handed basis", move |(n,), basis| orthonormal(n, basis))
            .hard_case("down", (down,), (&[-1.0, 0.0, 0.0, 0.0, -1.0, 0.0], 3.0), (NAIVE, f64::INFINITY))
            .build(),
        formula(M, "random_walk_basis_naive", mirror::basis_naive, oracle::basis_naive, |draws| {
            let normal = draws.unit_vector();
            (normal.with_z(normal.z.abs()),)
        })
        .benign(1e-5)
        .build(),
        formula(M, "random_walk_turn", mirror::turn, oracle::turn, |draws| {
            (normal(draws), unit_pair(draws), unit_pair(draws))
        })
        .edge("straight on", |(_, deflection, _)| deflection.x == 1.0)
        .edge("down", |(n, ..)| n == Vec3::NEG_Z)
        .invariant("unit length", |_, turned: Vec3| unit(turned))
        .invariant("the angle is the deflection", |(n, deflection, _), turned: Vec3| {
            near("cosine", dot(n, turned), deflection.x.into(), UNIT)
        })
        .build(),
        formula(M, "random_walk_isotropic", mirror::isotropic, oracle::isotropic, |draws| {
            (Vec2::new(clamped(draws), uniform(draws)),)
        })
        .edge("up", |(u,)| u.x == 0.0)
        .edge("down", |(u,)| u.x == 1.0)
        .invariant("unit length", |_, direction: Vec3| unit(direction))
        .build(),
    ]
}

fn surfaces() -> Vec<Formula> {
    vec![
        formula(M, "random_walk_boundary", mirror::boundary, oracle::boundary, crossing)
            .edge("equal indices", |(_, _, n, _)| n == 1.0)
            .edge("equal indices, grazing", |(i, normal, n, _)| n == 1.0 && dot(i, normal) == 0.0)
            .edge("square on", |(i, normal, n, _)| n != 1.0 && i == -normal)
            .edge("grazing", |(i, normal, n, _)| n > 1.0 && dot(i, normal).abs() < 1e-6)
            .edge("total reflection, the greatest number", |(i, normal, n, u)| {
                u == 1.0 - f32::EPSILON / 2.0 && n < 1.0 && dot(i, normal).powi(2) < 0.9 * (1.0 - f64::from(n * n))
            })
            .edge("the least number", |(_, _, n, u)| u == 0.0 && n != 1.0)
            // Refraction into a thinner medium stretches the part along the surface, and its
            // rounding.
            .invariant("unit length", |(.., n, _), crossing: RandomWalkCrossing| {
                let stretch = f64::from(n).min(1.0).powi(-2);
                near("length", crossing.direction.as_dvec3().length(), 1.0, UNIT * stretch)
            })
            .invariant("on the side that it says", |(_, normal, ..), crossing: RandomWalkCrossing| {
                let up = dot(normal, crossing.direction);
                let right = if crossing.crosses { up <= 1e-6 } else { up >= -1e-6 };
                if right { Ok(()) } else { Err(format!("normal . direction is {up}")) }
            })
            .invariant("total reflection beyond the critical angle", |(i, normal, n, _), crossing| {
                let sine = i.as_dvec3().cross(normal.as_dvec3()).length();
                if sine > f64::from(n) * 1.00001 && crossing.crosses { Err("crosses".to_owned()) } else { Ok(()) }
            })
            .build(),
    ]
}
