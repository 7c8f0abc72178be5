//! `wgsl/refraction.wgsl`.

mod outside;

pub use outside::linear;

use crate::{self as mirror, RefractionHit, oracle};
use glam::{DVec3, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;

mirror_struct!(crate, RefractionHit { direction, total });

/// Error of a length from three squares, two sums and the rounding of the inputs: 2⁻²⁴ each, with
/// room for the portable bounds.
const UNIT: f64 = 16.0 / (1 << 24) as f64;

/// Draws a cosine of incidence in [0, 1]: of any magnitude down to the smallest normal number, or
/// an end.
fn cosine(draws: &mut Draws<'_>) -> f32 {
    match draws.below(8) {
        0 => draws.pick(&[1.0, 1.0f32.next_down(), 0.0, f32::MIN_POSITIVE, 1e-40]),
        1..=3 => draws.magnitude(-126, -1),
        _ => draws.between(0.0, 1.0),
    }
}

/// Draws a relative index in [1/4, 4]: anywhere, or 1 ± any magnitude down to the last place.
pub fn relative_index(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[1.0, 4.0, 0.25, 1.0f32.next_up(), 1.0f32.next_down(), 2.41749, 1.0 / 2.41749]),
        1 | 2 => {
            let offset = draws.magnitude(-24, -2);
            if draws.below(2) == 0 { 1.0 + offset } else { 1.0 - offset }
        }
        3 => 1.0 / draws.between(1.0, 4.0),
        _ => draws.between(1.0, 4.0),
    }
}

/// Draws a cosine: for `index` < 1 within a few ulp of the critical angle, on either side; any
/// cosine for other indices.
pub fn cosine_near_critical(draws: &mut Draws<'_>, index: f32) -> f32 {
    if index < 1.0 && draws.below(3) == 0 {
        let index = f64::from(index);
        let critical = ((1.0 - index) * (1.0 + index)).sqrt() as f32;
        draws.nudged(critical, 8)
    } else {
        cosine(draws)
    }
}

/// Draws an incident direction and a normal at the angle of incidence of `cosine`; exact if the
/// normal lies along an axis.
pub fn incidence(draws: &mut Draws<'_>, cosine: f32) -> (Vec3, Vec3) {
    let normal = draws.unit_vector();
    let axis = normal.as_dvec3().normalize();
    let tangent = draws.perpendicular(axis);
    let cosine = f64::from(cosine);
    let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
    let incident = (sine * tangent - cosine * axis).as_vec3();
    // Rounding can turn a grazing ray to the far side.
    if normal.as_dvec3().dot(incident.as_dvec3()) > 0.0 { (incident, -normal) } else { (incident, normal) }
}

fn refraction_inputs(draws: &mut Draws<'_>) -> (Vec3, Vec3, f32) {
    let index = relative_index(draws);
    let cosine = cosine_near_critical(draws, index);
    let (incident, normal) = incidence(draws, cosine);
    (incident, normal, index)
}

/// Draws inputs away from grazing incidence and total internal reflection, for which the usual
/// forms are accurate.
fn benign_refraction_inputs(draws: &mut Draws<'_>) -> (Vec3, Vec3, f32) {
    let index = draws.between(1.25, 4.0);
    let cosine = draws.between(0.1, 1.0);
    let (incident, normal) = incidence(draws, cosine);
    (incident, normal, index)
}

/// Returns the squared sine of the angle of incidence divided by n², in f64; above 1, reflection is
/// total.
fn squared_sine_transmitted(incident: Vec3, normal: Vec3, index: f32) -> f64 {
    let cosine = -incident.as_dvec3().dot(normal.as_dvec3());
    (1.0 - cosine * cosine) / f64::from(index).powi(2)
}

/// Returns every function of the module, bound to its mirror and its oracle, with its promises
/// outside its domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    const M: &str = "refraction";
    let grazing = |cosine: f32| {
        let cosine = f64::from(cosine);
        Vec3::new((1.0 - cosine * cosine).sqrt() as f32, 0.0, -cosine as f32)
    };
    // A ray at `cosine` to +z refracted with index n: (sin θ_i / n, 0, -cos θ_t), in f64.
    let refracted = |cosine: f32, index: f32| -> [f64; 4] {
        let (cosine, index) = (f64::from(cosine), f64::from(index));
        let squared = (index - 1.0) * (index + 1.0) + cosine * cosine;
        [((1.0 - cosine) * (1.0 + cosine)).sqrt() / index, 0.0, -squared.sqrt() / index, 0.0]
    };
    let barely_denser = 1.0f32.next_up();
    let barely_thinner = 1.0f32.next_down();
    vec![
        formula(M, "refraction_relative_index", mirror::relative_index, oracle::relative_index, |draws| {
            (draws.between(1.0, 4.0), draws.between(1.0, 4.0))
        })
        .edge("into a denser medium", |(incident, transmitted)| transmitted > incident)
        .edge("into a thinner medium", |(incident, transmitted)| transmitted < incident)
        .build(),
        formula(M, "refraction_reflect", mirror::reflect, oracle::reflect, |draws| {
            let cosine = cosine(draws);
            let (incident, normal) = incidence(draws, cosine);
            if draws.below(2) == 0 { (incident, normal) } else { (incident, -normal) }
        })
        .edge("normal incidence", |(incident, normal)| incident == -normal)
        .edge("grazing incidence", |(incident, normal)| normal.dot(incident).abs() < 1e-20)
        .edge("normal on the far side", |(incident, normal)| normal.dot(incident) > 0.1)
        .invariant("unit length", |_, reflected: Vec3| near("length", reflected.as_dvec3().length(), 1.0, UNIT))
        .invariant("equal angles", |(incident, normal), reflected: Vec3| {
            let [before, after] = [incident, reflected].map(|v| v.as_dvec3().dot(normal.as_dvec3()));
            near("cosine", after, -before, UNIT)
        })
        .pair("reflecting a reversed ray reverses the reflection", |(incident, normal)| (-incident, normal), {
            |_, reflected: Vec3, reversed: Vec3| near("sum", (reflected + reversed).as_dvec3().length(), 0.0, 0.0)
        })
        .build(),
        formula(M, "refraction_radicand", mirror::radicand, oracle::radicand, |draws| {
            let index = relative_index(draws);
            (cosine_near_critical(draws, index), index)
        })
        .edge("total internal reflection", |(cosine, index)| oracle::radicand(cosine.into(), index.into()) < 0.0)
        .edge("a few ulp above the critical angle", |(cosine, index)| {
            (0.0..1e-6).contains(&oracle::radicand(cosine.into(), index.into())) && index < 0.9
        })
        .edge("a few ulp below it", |(cosine, index)| {
            (-1e-6..0.0).contains(&oracle::radicand(cosine.into(), index.into())) && index < 0.9
        })
        .edge("equal indices", |(_, index)| index == 1.0)
        .edge("normal incidence", |(cosine, _)| cosine == 1.0)
        .edge("grazing incidence", |(cosine, _)| cosine < 1e-30)
        .hard_case(
            "equal indices at a grazing cosine of 1e-4",
            (1e-4, 1.0),
            (&[f64::from(1e-4f32).powi(2)], 1e-15),
            ("refraction_radicand_naive", 9e-9),
        )
        .hard_case(
            "equal indices at a grazing cosine of 1e-15",
            (1e-15, 1.0),
            (&[f64::from(1e-15f32).powi(2)], 1e-37),
            ("refraction_radicand_naive", 9e-31),
        )
        .hard_case(
            "an index one ulp above 1",
            (1e-4, barely_denser),
            (&[refracted(1e-4, barely_denser)[2].powi(2)], 1e-13),
            ("refraction_radicand_naive", 1e-9),
        )
        .hard_case(
            "n * n - 1 instead of two factors: an index of 1.0002277 close to grazing",
            (f32::from_bits(0x399b_7e0a), f32::from_bits(0x3f80_0776)),
            (&[4.553_119_239_593_2e-4], 5e-10),
            ("refraction_radicand_naive", 5e-8),
        )
        .build(),
        formula(M, "refraction_radicand_naive", mirror::radicand_naive, oracle::radicand, |draws| {
            (draws.between(0.3, 1.0), draws.between(1.25, 4.0))
        })
        .benign(1e-5)
        .build(),
        formula(M, "refraction_refract", mirror::refract, oracle::refract, refraction_inputs)
            .edge("total internal reflection", |(r, n, index)| squared_sine_transmitted(r, n, index) > 1.0)
            .edge("just above the critical angle", |(r, n, index)| {
                index < 0.9 && (1.0..1.000_001).contains(&squared_sine_transmitted(r, n, index))
            })
            .edge("just below it", |(r, n, index)| {
                index < 0.9 && (0.999_999..1.0).contains(&squared_sine_transmitted(r, n, index))
            })
            .edge("equal indices", |(_, _, index)| index == 1.0)
            .edge("equal indices at exactly grazing incidence", |(r, n, index)| index == 1.0 && r.dot(n) == 0.0)
            .edge("normal incidence", |(r, n, _)| r == -n)
            .edge("grazing to the last ulp", |(r, n, _)| r.dot(n) != 0.0 && r.dot(n).abs() < 1e-30)
            .edge("into a denser medium", |(_, _, index)| index > 1.0)
            .invariant("unit length", |_, hit: RefractionHit| {
                // docs/refraction.md: 88 and 148 units of 2⁻²⁴ at the smallest index, 1/4.
                near("length", hit.direction.as_dvec3().length(), 1.0, 148.0 / (1 << 24) as f64)
            })
            .invariant("Snell: n × r = n_relative n × r'", |(incident, normal, index), hit: RefractionHit| {
                let across = |v: Vec3| normal.as_dvec3().cross(v.as_dvec3());
                let ratio = if hit.total { 1.0 } else { f64::from(index) };
                let off: DVec3 = across(incident) - ratio * across(hit.direction);
                near("difference", off.length(), 0.0, 4.0 * UNIT)
            })
            .invariant_at_nearest(
                "refracted rays cross the plane, reflected ones do not",
                |(_, normal, _), hit: RefractionHit| {
                    let height = normal.as_dvec3().dot(hit.direction.as_dvec3());
                    let wrong_side = if hit.total { -height } else { height };
                    near("height", wrong_side.max(0.0), 0.0, UNIT)
                },
            )
            .hard_case(
                "equal indices at a grazing cosine of 1e-4",
                (grazing(1e-4), Vec3::Z, 1.0),
                (&refracted(1e-4, 1.0), 1e-7),
                ("refraction_refract_naive", 9e-5),
            )
            .hard_case(
                "an index one ulp above 1, at a grazing cosine of 1e-4",
                (grazing(1e-4), Vec3::Z, barely_denser),
                (&refracted(1e-4, barely_denser), 1e-7),
                ("refraction_refract_naive", 5e-6),
            )
            .hard_case(
                "n * n - 1 instead of two factors: an index of 1.0002266 close to grazing",
                (grazing(f32::from_bits(0x392c_3424)), Vec3::Z, f32::from_bits(0x3f80_076d)),
                (&refracted(f32::from_bits(0x392c_3424), f32::from_bits(0x3f80_076d)), 2e-7),
                ("refraction_refract_naive", 1e-6),
            )
            .hard_case(
                "an index one ulp below 1, one part in 400 inside the critical angle",
                (grazing(3.46e-4), Vec3::Z, barely_thinner),
                (&refracted(3.46e-4, barely_thinner), 2e-6),
                ("refraction_refract_naive", 1e-5),
            )
            .hard_case(
                "1 ulp inside the critical angle of an index one ulp below 1",
                (grazing(3.452_670_1e-4), Vec3::Z, barely_thinner),
                (&refracted(3.452_670_1e-4, barely_thinner), 1e-5),
                ("refraction_refract_naive", 0.9),
            )
            .hard_case(
                "2 ulp outside the critical angle of an index two ulp below 1",
                (grazing(4.882_811_6e-4), Vec3::Z, barely_thinner.next_down()),
                (&[f64::from(grazing(4.882_811_6e-4).x), 0.0, f64::from(4.882_811_6e-4f32), 1.0], 1e-7),
                ("refraction_refract_naive", 0.9),
            )
            .hard_case(
                "total internal reflection at 60 degrees out of diamond",
                (grazing(0.5), Vec3::Z, 1.0 / 2.41749),
                (&[f64::from(grazing(0.5).x), 0.0, 0.5, 1.0], 1e-7),
                ("refraction_refract_builtin", f64::INFINITY),
            )
            .build(),
        formula(M, "refraction_refract_naive", mirror::refract_naive, oracle::refract, |draws| {
            // On either side of the critical angle at a distance from it, and just inside it.
            match draws.below(4) {
                0 => {
                    let cosine = draws.between(0.2, 0.6);
                    let (incident, normal) = incidence(draws, cosine);
                    (incident, normal, draws.between(0.25, 0.5))
                }
                1 => {
                    let index = draws.between(0.5, 0.8);
                    let squared_cosine_transmitted = draws.between(0.004, 0.015);
                    let cosine = (1.0 - index * index * (1.0 - squared_cosine_transmitted)).sqrt();
                    let (incident, normal) = incidence(draws, cosine);
                    (incident, normal, index)
                }
                _ => benign_refraction_inputs(draws),
            }
        })
        .benign(2e-5)
        .build(),
        formula(M, "refraction_refract_builtin", mirror::refract_builtin, oracle::refract, benign_refraction_inputs)
            .benign(1e-5)
            .build(),
    ]
}
