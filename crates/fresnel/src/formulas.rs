//! Test inputs, edges, invariants and hard cases of `wgsl/fresnel.wgsl`.

mod outside;

use crate::{self as mirror, oracle};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};

const M: &str = "fresnel";

/// Size of 16 ulp just below 1.
const AT_ONE: f64 = 16.0 / (1 << 24) as f64;

/// Draws a relative index in [1/4, 4]: anywhere, or 1 ± every magnitude down to the last place.
fn relative_index(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[1.0, 4.0, 0.25, 2.41749, 1.0 / 2.41749]),
        1 => draws.nudged(1.0, 20),
        2 => 1.0 + draws.magnitude(-23, -2),
        3 => 1.0 - draws.magnitude(-24, -2),
        4 => 1.0 / draws.between(1.0, 4.0),
        _ => draws.between(1.0, 4.0),
    }
}

/// Draws a cosine and an index: every magnitude of the cosine, its ends, out of range, and both
/// sides of the critical angle.
fn incidence(draws: &mut Draws<'_>) -> (f32, f32) {
    let index = relative_index(draws);
    let critical = if index < 1.0 {
        let index = f64::from(index);
        ((1.0 - index) * (1.0 + index)).sqrt() as f32
    } else {
        0.5
    };
    let cosine = match draws.below(8) {
        0 => draws.pick(&[1.0, 0.0, -0.25, 1.5, f32::MIN_POSITIVE, f32::from_bits(1)]),
        1 => draws.magnitude(-126, -1),
        2 => draws.nudged(critical, 20),
        3 => 1.0 - draws.magnitude(-24, -2),
        _ => draws.between(0.0, 1.0),
    };
    (cosine, index)
}

/// Returns whether the interface reflects all light.
fn total(cosine: f32, index: f32) -> bool {
    let (cosine, index) = (f64::from(cosine).clamp(0.0, 1.0), f64::from(index));
    (index - 1.0) * (index + 1.0) + cosine * cosine < 0.0
}

fn in_unit_range(reflectance: f32) -> Result<(), String> {
    if (0.0..=1.0).contains(&reflectance) { Ok(()) } else { Err(format!("reflectance {reflectance}")) }
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    vec![exact(), textbook(), normal_incidence(), schlick()]
}

fn exact() -> Formula {
    let below_one = 1.0f32.next_down();
    let above_one = 1.0f32.next_up();
    let grazing = f32::from_bits(0x38d1_b717);
    const NAIVE: &str = "fresnel_dielectric_textbook";
    formula(M, "fresnel_dielectric", mirror::dielectric, oracle::dielectric, incidence)
        .edge("total internal reflection", |(c, n)| total(c, n))
        .edge("just inside the critical angle", |(c, n)| n < 0.9 && total(c, n) && !total(c * 1.000_002, n))
        .edge("just outside it", |(c, n)| n < 0.9 && !total(c, n) && total(c * 0.999_998, n))
        .edge("equal indices", |(_, n)| n == 1.0)
        .edge("equal indices at exactly grazing incidence", |(c, n)| n == 1.0 && c == 0.0)
        .edge("one ulp from equal indices", |(_, n)| n == 1.0f32.next_up() || n == 1.0f32.next_down())
        .edge("normal incidence", |(c, _)| c == 1.0)
        .edge("grazing to the last ulp", |(c, n)| c > 0.0 && c < 1e-30 && n > 1.0)
        .edge("cosine out of range", |(c, _)| !(0.0..=1.0).contains(&c))
        .invariant("in [0, 1]", |_, reflectance: f32| in_unit_range(reflectance))
        .invariant_at_nearest("1 under total internal reflection, away from its edge", |(c, n), reflectance: f32| {
            let past = (f64::from(n) - 1.0) * (f64::from(n) + 1.0) + f64::from(c.clamp(0.0, 1.0)).powi(2);
            if past < -1e-5 { near("reflectance", reflectance.into(), 1.0, AT_ONE) } else { Ok(()) }
        })
        .invariant_at_nearest("1 at grazing incidence, 0 without an interface", |(c, n), reflectance: f32| {
            if n == 1.0 {
                near("reflectance", reflectance.into(), 0.0, 0.0)
            } else if c <= 0.0 {
                near("reflectance", reflectance.into(), 1.0, AT_ONE)
            } else {
                Ok(())
            }
        })
        // Helmholtz reciprocity: the reversed ray has the same reflectance.
        .pair("reciprocity", reversed, |(c, n), reflectance: f32, backwards: f32| {
            let well_conditioned = (n - 1.0).abs() > 0.05 && (0.05..=1.0).contains(&c) && !total(c * 0.95, n);
            // The reversed cosine is rounded, and near its critical angle the reflectance varies
            // with it as 1 / c².
            let slack = 2e-6 + 2e-7 / f64::from(c).powi(2);
            if well_conditioned { near("difference", f64::from(reflectance - backwards), 0.0, slack) } else { Ok(()) }
        })
        .hard_case(
            "index one step below 1, 60 degrees",
            (0.5, below_one),
            (&[8.881_788_533e-15], 4e-21),
            (NAIVE, 1e-14),
        )
        .hard_case(
            "index one step below 1, 45.6 degrees",
            (0.7, below_one),
            (&[1.850_341_349e-15], 1e-21),
            (NAIVE, 1e-15),
        )
        .hard_case(
            "index one step below 1, 89.4 degrees",
            (0.01, below_one),
            (&[8.890_606_191e-8], 5e-14),
            (NAIVE, 1e-7),
        )
        .hard_case(
            "index one step above 1, 45.6 degrees",
            (0.7, above_one),
            (&[7.401_361_289e-15], 2e-21),
            (NAIVE, 1e-15),
        )
        .hard_case(
            "index 1e-5 above 1, 89.4 degrees",
            (0.01, f32::from_bits(0x3f80_0054)),
            (&[2.079_407_866e-3], 1e-9),
            (NAIVE, 3e-6),
        )
        .hard_case(
            "index one step above 1, 1e-4 from grazing",
            (grazing, above_one),
            (&[0.443_268_811_5], 3e-7),
            (NAIVE, 5e-3),
        )
        .hard_case(
            "n * n - 1 instead of two factors: a nearly equal index at 51.5 degrees",
            (f32::from_bits(0x3f1f_56ec), f32::from_bits(0x3f80_07fb)),
            (&[5.184_650_042_522_7e-8], 5e-13),
            (NAIVE, 1e-11),
        )
        .hard_case(
            "c - g instead of m / (c + g): a nearly equal index at 42.1 degrees",
            (f32::from_bits(0x3f3e_0280), f32::from_bits(0x3f7f_f7d9)),
            (&[6.441_410_680_326_8e-9], 5e-14),
            (NAIVE, 4e-12),
        )
        .hard_case(
            "1 - c * c instead of two factors: just inside the critical angle of a thin medium",
            (f32::from_bits(0x3f75_df23), f32::from_bits(0x3e8e_9c39)),
            (&[0.885_257_645_391], 2e-5),
            (NAIVE, 7e-5),
        )
        .hard_case(
            "m + c * c, of which c * c is rounded near 1: just inside the critical angle of a thin medium",
            (f32::from_bits(0x3f74_0933), f32::from_bits(0x3e9a_b2a8)),
            (&[0.941_471_705_084_22], 2e-5),
            (NAIVE, 1e-4),
        )
        .hard_case("no interface, grazing", (grazing, 1.0), (&[0.0], 0.0), (NAIVE, 0.9))
        .hard_case("no interface, a subnormal cosine", (f32::from_bits(1), 1.0), (&[0.0], 0.0), (NAIVE, 0.9))
        .hard_case("no interface, exactly grazing", (0.0, 1.0), (&[0.0], 0.0), (NAIVE, f64::INFINITY))
        .hard_case(
            "100 ulp inside the critical angle of an index one step below 1",
            (f32::from_bits(0x39b5_0557), below_one),
            (&[0.983_712_507_8], 1e-4),
            (NAIVE, 0.01),
        )
        .build()
}

/// Returns the cosine and the index of the reversed refracted ray.
fn reversed((cosine, index): (f32, f32)) -> (f32, f32) {
    let (c, n) = (f64::from(cosine).clamp(0.0, 1.0), f64::from(index));
    let transmitted = ((n - 1.0) * (n + 1.0) + c * c).max(0.0).sqrt() / n;
    (transmitted as f32, (1.0 / n) as f32)
}

fn textbook() -> Formula {
    formula(M, "fresnel_dielectric_textbook", mirror::dielectric_textbook, oracle::dielectric_textbook, |draws| {
        if draws.below(4) == 0 {
            // Well inside total internal reflection.
            (draws.between(0.1, 0.5), draws.between(0.25, 0.6))
        } else {
            (draws.between(0.2, 1.0), draws.between(1.25, 4.0))
        }
    })
    .benign(5e-5)
    .build()
}

fn normal_incidence() -> Formula {
    formula(M, "fresnel_normal_incidence", mirror::normal_incidence, oracle::normal_incidence, |draws| {
        (relative_index(draws),)
    })
    .edge("equal indices", |(n,)| n == 1.0)
    .edge("into a thinner medium", |(n,)| n < 0.5)
    .pair(
        "the same from both sides",
        |(n,)| (1.0 / n,),
        |(n,), one: f32, other: f32| {
            // The difference n - 1 magnifies the rounding of 1 / n.
            let slack = 4.0 / (1 << 24) as f64 / (f64::from(n) - 1.0).abs().max(1e-7) + 1e-5;
            near("difference", f64::from(one - other), 0.0, f64::from(one) * slack + 1e-13)
        },
    )
    .build()
}

fn schlick() -> Formula {
    formula(M, "fresnel_schlick", mirror::schlick, oracle::schlick, incidence)
        .edge("total internal reflection", |(c, n)| total(c, n))
        .edge("normal incidence", |(c, _)| c == 1.0)
        .edge("exactly grazing", |(c, _)| c == 0.0)
        .edge("equal indices", |(_, n)| n == 1.0)
        .invariant("in [0, 1]", |_, reflectance: f32| in_unit_range(reflectance))
        .invariant_at_nearest("1 under total internal reflection, away from its edge", |(c, n), reflectance: f32| {
            let past = (f64::from(n) - 1.0) * (f64::from(n) + 1.0) + f64::from(c.clamp(0.0, 1.0)).powi(2);
            if past < -1e-5 { near("reflectance", reflectance.into(), 1.0, AT_ONE) } else { Ok(()) }
        })
        .build()
}
