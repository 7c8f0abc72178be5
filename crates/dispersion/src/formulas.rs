//! Test inputs, edges, invariants and hard cases of `wgsl/dispersion.wgsl`.

mod outside;

use crate::{self as mirror, DispersionSellmeier, oracle};
use glam::{DVec3, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;
use lapidary_refraction::formulas::{cosine_near_critical, incidence, relative_index};

mirror_struct!(crate, DispersionSellmeier { constant, strengths, resonances });

const M: &str = "dispersion";

/// Error of a unit vector's length after three squares, two sums and the rounding of the inputs,
/// 2⁻²⁴ each, with room for the portable bounds.
const UNIT: f64 = 16.0 / (1 << 24) as f64;

/// Diamond's index at the d line.
const DIAMOND: f32 = 2.41749;

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    vec![
        sellmeier(),
        cauchy(),
        abbe(),
        abbe_number(),
        enter(),
        refract(),
        refract_naive(),
        reflect(),
        direction(),
        paper_enter(),
        paper_enter_naive(),
        paper_refract(),
        paper_refract_naive(),
        paper_reflect(),
        paper_direction(),
    ]
}

/// Draws a visible wavelength in nm.
fn wavelength(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => draws.pick(&[587.6, 380.0, 780.0, mirror::DISPERSION_RED, mirror::DISPERSION_BLUE]),
        _ => draws.between(380.0, 780.0),
    }
}

/// Draws a material of the module, or any with resonances on both sides of the visible range.
fn material(draws: &mut Draws<'_>) -> DispersionSellmeier {
    if draws.below(3) == 0 {
        return draws.pick(&[
            mirror::DISPERSION_DIAMOND,
            mirror::DISPERSION_CORUNDUM,
            mirror::DISPERSION_QUARTZ,
            mirror::DISPERSION_CROWN_GLASS,
            mirror::DISPERSION_CUBIC_ZIRCONIA,
            mirror::DISPERSION_RUTILE,
            mirror::DISPERSION_STRONTIUM_TITANATE,
        ]);
    }
    if draws.below(64) == 0 {
        // The greatest strengths at the resonances next to the visible range make the radicand
        // negative.
        return DispersionSellmeier { constant: 0.0, strengths: Vec3::splat(40.0), resonances: Vec3::splat(50.0) };
    }
    // Without ultraviolet resonances the formula falls below 1.
    let infrared = draws.below(4) == 0;
    let mut resonance = || -> (f32, f32) {
        let strongest = if draws.below(4) == 0 { 40.0 } else { 10.0 };
        let strength = draws.between(0.0, strongest);
        match draws.below(4) {
            _ if infrared => (strength, draws.between(50.0, 600.0)),
            0 => (strength, draws.between(50.0, 600.0)),
            1 => (strength, draws.between(0.0, 0.05)),
            _ => (strength, draws.between(0.05, 0.1)),
        }
    };
    let [first, second, third] = [resonance(), resonance(), resonance()];
    let constant = if infrared || draws.below(2) == 0 { 0.0 } else { draws.between(0.0, 2.0) };
    DispersionSellmeier {
        constant,
        strengths: Vec3::new(first.0, second.0, third.0),
        resonances: Vec3::new(first.1, second.1, third.1),
    }
}

fn sellmeier() -> Formula {
    formula(M, "dispersion_sellmeier", mirror::sellmeier, oracle::sellmeier, |draws| {
        (material(draws), wavelength(draws))
    })
    .edge("one of the materials", |(material, _)| material == mirror::DISPERSION_CUBIC_ZIRCONIA)
    .edge("rutile at its strongest", |(material, nanometres)| {
        material == mirror::DISPERSION_RUTILE && nanometres < 400.0
    })
    .edge("a resonance next to the visible", |(material, nanometres)| {
        material.resonances.to_array().iter().any(|resonance| (0.095..0.1).contains(resonance)) && nanometres < 390.0
    })
    .edge("a constant", |(material, _)| material.constant > 0.0)
    .edge("below 0 under the root", |(material, _)| material.strengths == Vec3::splat(40.0))
    .edge("held at 1", |(material, _)| material.constant == 0.0 && material.resonances.min_element() > 1.0)
    .edge("an end of the visible", |(_, wavelength)| wavelength == 380.0)
    .invariant("at least 1", |_, index: f32| near("lack", (1.0 - f64::from(index)).max(0.0), 0.0, 0.0))
    // Between resonances every term decreases with the wavelength: normal dispersion.
    .pair(
        "a shorter wavelength has a higher index",
        |(material, wavelength)| (material, 0.9 * wavelength),
        |_, index: f32, shorter: f32| near("fall", f64::from(index - shorter).max(0.0), 0.0, 1.5e-6 * f64::from(index)),
    )
    .build()
}

fn cauchy() -> Formula {
    formula(M, "dispersion_cauchy", mirror::cauchy, oracle::cauchy, |draws| {
        let coefficients = Vec3::new(draws.between(1.0, 4.0), draws.between(0.0, 0.1), draws.pick(&[0.0, 0.005, 0.01]));
        (coefficients, wavelength(draws))
    })
    .edge("two terms", |(coefficients, _)| coefficients.z == 0.0)
    .edge("three terms", |(coefficients, _)| coefficients.z > 0.0)
    .pair(
        "a shorter wavelength has a higher index",
        |(coefficients, wavelength)| (coefficients, 0.9 * wavelength),
        |_, index: f32, shorter: f32| near("fall", f64::from(index - shorter).max(0.0), 0.0, 4e-6),
    )
    .build()
}

fn abbe() -> Formula {
    formula(M, "dispersion_abbe", mirror::abbe, oracle::abbe, |draws| {
        let index = draws.pick(&[1.5, 1.0, 2.41749, 4.0]);
        let index = if draws.below(2) == 0 { index } else { draws.between(1.0, 4.0) };
        let dispersion = match draws.below(4) {
            0 => draws.pick(&[0.0, 20.0 / 55.3, 1.0, 64.0]),
            1 => draws.between(0.0, 64.0),
            _ => draws.between(0.0, 2.0),
        };
        (index, dispersion, wavelength(draws))
    })
    .edge("no dispersion", |(_, dispersion, _)| dispersion == 0.0)
    .edge("nothing to disperse", |(index, dispersion, _)| index == 1.0 && dispersion > 0.0)
    .edge("held at 1", |(index, dispersion, wavelength)| index > 1.5 && dispersion > 40.0 && wavelength > 770.0)
    .invariant("at least 1, and the index itself without dispersion", |(index, dispersion, _), bent: f32| {
        let lack = if dispersion == 0.0 { f64::from(bent - index).abs() } else { (1.0 - f64::from(bent)).max(0.0) };
        near("lack", lack, 0.0, 0.0)
    })
    .build()
}

fn abbe_number() -> Formula {
    formula(M, "dispersion_abbe_number", mirror::abbe_number, oracle::abbe_number, |draws| {
        let index = draws.between(1.0, 3.9);
        let index_c = match draws.below(4) {
            0 => index,
            _ => index - (index - 1.0) * draws.between(0.0, 0.02),
        };
        let index_f = match draws.below(4) {
            0 => index_c,
            1 => draws.nudged(index_c, 3),
            _ => index + draws.between(0.0, 0.1),
        };
        (index, index_f, index_c)
    })
    .edge("no dispersion", |(_, index_f, index_c)| index_f == index_c)
    .edge("anomalous dispersion", |(_, index_f, index_c)| index_f < index_c)
    .edge("a glass", |(index, index_f, index_c)| (10.0..100.0).contains(&((index - 1.0) / (index_f - index_c))))
    .build()
}

fn incident(draws: &mut Draws<'_>) -> (Vec3, Vec3, f32) {
    let index = relative_index(draws);
    let cosine = cosine_near_critical(draws, index);
    let (direction, normal) = incidence(draws, cosine);
    (direction, normal, index)
}

/// Returns n² cos² θ_t, negative under total internal reflection.
fn radicand(direction: Vec3, normal: Vec3, index: f32) -> f64 {
    let cosine = (-direction.as_dvec3().dot(normal.as_dvec3())).max(0.0);
    (f64::from(index) - 1.0) * (f64::from(index) + 1.0) + cosine * cosine
}

/// Returns the refracted ray, or the reflected ray under total internal reflection.
fn onwards(direction: Vec3, normal: Vec3, index: f32) -> DVec3 {
    let squared = radicand(direction, normal, index);
    let [direction, normal] = [direction, normal].map(|v| v.as_dvec3());
    let cosine = -direction.dot(normal);
    if squared < 0.0 {
        direction + 2.0 * cosine * normal
    } else {
        (direction + (cosine - squared.sqrt()) * normal) / f64::from(index)
    }
}

/// Checks that a gradient is perpendicular to its ray. The ray's own angle of refraction is known
/// to about an ulp of its squared cosine, which `scale` and the root convert to an angle.
fn perpendicular(gradient: Vec3, ray: (Vec3, Vec3, f32), scale: f64) -> Result<(), String> {
    let squared = radicand(ray.0, ray.1, ray.2);
    // Here either branch may be right, or the root is clamped.
    if squared.abs() < 1e-5 || (0.0..0.004).contains(&squared) {
        return Ok(());
    }
    let along = gradient.as_dvec3().dot(onwards(ray.0, ray.1, ray.2));
    near("part along the ray", along, 0.0, 2e-6 * scale / squared.abs().sqrt())
}

/// Returns the ray at `cosine` in the plane of incidence, with the normal along +z, and its
/// derivative with respect to its angle.
fn in_plane(cosine: f64) -> [DVec3; 2] {
    let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    [DVec3::new(sine, 0.0, -cosine), DVec3::new(cosine, 0.0, sine)]
}

fn flat(v: DVec3) -> [f64; 3] {
    v.to_array()
}

fn enter() -> Formula {
    formula(M, "dispersion_enter", mirror::enter, oracle::enter, |draws| {
        let index = relative_index(draws);
        let index = if index < 1.0 { 1.0 / index } else { index };
        let cosine = cosine_near_critical(draws, index);
        let (direction, normal) = incidence(draws, cosine);
        (direction, normal, index)
    })
    .edge("held near the critical angle", |(r, n, index)| (1e-5..3e-3).contains(&radicand(r, n, index)))
    .edge("equal indices", |(_, _, index)| index == 1.0)
    .edge("equal indices at exactly grazing incidence", |(r, n, index)| index == 1.0 && r.dot(n) == 0.0)
    .edge("normal incidence", |(r, n, _)| r == -n)
    .edge("grazing to the last ulp", |(r, n, _)| r.dot(n) != 0.0 && r.dot(n).abs() < 1e-30)
    .edge("into a denser medium", |(_, _, index)| index > 1.5)
    .invariant("perpendicular to the ray", |(r, n, index), gradient: Vec3| {
        perpendicular(gradient, (r, n, index), 17.0 / f64::from(index).powi(2))
    })
    .invariant("tan θ_t / n long, away from the critical angle", |(r, n, index), gradient: Vec3| {
        let squared = radicand(r, n, index);
        if squared < 0.004 {
            return Ok(());
        }
        let sine = r.as_dvec3().cross(n.as_dvec3()).length();
        let length = sine / squared.sqrt() / f64::from(index);
        near("length", gradient.as_dvec3().length(), length, 64.0 * UNIT * (1.0 + length / squared))
    })
    .hard_case_with(
        "normal incidence: eq. (10) is 0 / 0",
        (Vec3::NEG_Z, Vec3::Z, DIAMOND),
        (&[0.0; 3], 0.0),
        ("dispersion_paper_enter_naive", (Vec3::NEG_Z, Vec3::NEG_Z), f64::INFINITY),
    )
    .hard_case_with(
        "normal incidence, refracted an ulp short: eq. (10) is noise of unit length",
        (Vec3::NEG_Z, Vec3::Z, DIAMOND),
        (&[0.0; 3], 0.0),
        ("dispersion_paper_enter_naive", (Vec3::NEG_Z, Vec3::new(0.0, 0.0, -1.0f32.next_down())), 0.9),
    )
    .build()
}

type Refraction = (Vec3, Vec3, Vec3, f32, f32);

/// Draws a ray with any gradient, on the way in, on the way out, or with any slope. Some rays leave
/// a parallel slab.
fn refraction(draws: &mut Draws<'_>) -> Refraction {
    if draws.below(8) == 0 {
        let index = draws.between(1.05, 4.0);
        let cosine = draws.between(0.05, 0.99);
        let (direction, normal) = incidence(draws, cosine);
        let inside = onwards(direction, normal, index);
        let gradient = oracle::enter(direction.into(), normal.into(), index.into());
        return (inside.as_vec3(), gradient.as_vec3(), normal, 1.0 / index, -1.0 / (index * index));
    }
    let (direction, normal, index) = incident(draws);
    let length = match draws.below(4) {
        0 => 0.0,
        1 => draws.magnitude(-40, 39),
        _ => draws.between(0.0, 1.0),
    };
    let across = draws.perpendicular(direction.as_dvec3().normalize());
    let slope = match draws.below(4) {
        0 => 1.0,
        1 | 2 => -index.min(1.0) * index.min(1.0),
        _ => draws.pick(&[1.0, -1.0]) * draws.pick(&[0.0, 1e-12, 1e-3, 0.5]),
    };
    (direction, (f64::from(length) * across).as_vec3(), normal, index, slope)
}

/// Returns the module's bound on the length of the gradient.
fn most(gradient: Vec3, index: f32, slope: f32) -> f64 {
    let index = f64::from(index);
    17.0 / index * (gradient.as_dvec3().length() + f64::from(slope).abs() / index)
}

/// Returns the f32 arguments for a ray at `cosine` to +z that turns at `rate`, and the exact
/// gradient.
fn refraction_case(cosine: f32, rate: f64, index: f32, slope: f32) -> (Refraction, [f64; 3]) {
    let [ray, turning] = in_plane(cosine.into());
    let arguments = (ray.as_vec3(), (rate * turning).as_vec3(), Vec3::Z, index, slope);
    let root = radicand(ray.as_vec3(), Vec3::Z, index).sqrt();
    let index = f64::from(index);
    let sine = ray.x / index;
    let moved = f64::from(cosine) * rate - f64::from(slope) * sine;
    (arguments, flat(moved * DVec3::new(1.0 / index, 0.0, sine / root.max(0.0625))))
}

fn refract() -> Formula {
    const NAIVE: &str = "dispersion_refract_naive";
    let out = 1.0 / DIAMOND;
    let out_slope = -out * out;
    let [ray, turning] = in_plane(0.5);
    // 60 degrees inside: all light is reflected, and the reflected ray turns the other way.
    let total: Refraction = (ray.as_vec3(), (0.2 * turning).as_vec3(), Vec3::Z, out, out_slope);
    let reflected = 0.2 * DVec3::new(turning.x, 0.0, -turning.z);
    let critical = (1.0 - f64::from(out) * f64::from(out)).sqrt() as f32;
    let (past, past_limit) = refraction_case(critical + 1e-6, 0.2, out, out_slope);
    let (close, close_limit) = refraction_case(critical + 1e-3, 0.2, out, out_slope);
    let (grazing, grazing_limit) = refraction_case(0.0, 0.0, 1.0, 1.0);
    let (squared, squared_limit) = refraction_case(f32::from_bits(0x3d72_1b3b), 0.0, f32::from_bits(0x3f80_07fb), 1.0);
    let (denser, denser_limit) = refraction_case(1e-4, 0.0, 1.0f32.next_up(), 1.0);
    // Diamond between parallel faces, entered at 0.6 rad.
    let [ray, _] = in_plane(0.6f64.cos());
    let entered = onwards(ray.as_vec3(), Vec3::Z, DIAMOND);
    let gradient = oracle::enter(ray, DVec3::Z, DIAMOND.into());
    let slab = (entered.as_vec3(), gradient.as_vec3(), Vec3::Z, out, out_slope);
    let paper = (slab.0, gradient.normalize().as_vec3(), Vec3::Z, out, mirror::DISPERSION_PAPER_EPSILON);
    // The part of the gradient along the surface is a thousandth of it: 0.55 n_x n_z along z, and
    // -0.55 n_z^2 along x.
    let tilted = DVec3::new((1.0 - 2f64.powi(-20)).sqrt(), 0.0, 2f64.powi(-10)).as_vec3();
    let upright = (Vec3::NEG_Y, Vec3::new(-0.55, 0.0, 0.0), tilted, 1.0625, 0.0);
    let upright_limit = {
        let (gradient, normal) = (upright.1.as_dvec3(), tilted.as_dvec3().normalize());
        ((gradient - gradient.dot(normal) * normal) / 1.0625).to_array()
    };
    formula(M, "dispersion_refract", mirror::refract, oracle::refract, refraction)
        .edge("total internal reflection", |(r, _, n, index, _)| radicand(r, n, index) < 0.0)
        .edge("just above the critical angle", |(r, _, n, index, _)| {
            index < 0.9 && (0.0..1e-6).contains(&radicand(r, n, index))
        })
        .edge("just below it", |(r, _, n, index, _)| index < 0.9 && (-1e-6..0.0).contains(&radicand(r, n, index)))
        .edge("held near it", |(r, _, n, index, _)| (1e-5..3e-3).contains(&radicand(r, n, index)))
        .edge("equal indices", |(_, _, _, index, _)| index == 1.0)
        .edge("equal indices at exactly grazing incidence", |(r, _, n, index, _)| index == 1.0 && r.dot(n) == 0.0)
        .edge("normal incidence", |(r, _, n, _, _)| r == -n)
        .edge("no gradient", |(_, gradient, ..)| gradient == Vec3::ZERO)
        .edge("no slope", |(.., slope)| slope == 0.0)
        .edge("a parallel slab", |(r, gradient, n, index, slope)| {
            let after = oracle::refract(r.into(), gradient.into(), n.into(), index.into(), slope.into());
            gradient.length() > 0.05 && after.length() < 1e-5
        })
        .invariant("perpendicular to the ray", |(r, gradient, n, index, slope), after: Vec3| {
            perpendicular(after, (r, n, index), most(gradient, index, slope))
        })
        .invariant("as short as stated", |(_, gradient, _, index, slope), after: Vec3| {
            let excess = after.as_dvec3().length() - (1.0 + UNIT) * most(gradient, index, slope);
            near("excess", excess.max(0.0), 0.0, 0.0)
        })
        .pair(
            "linear: twice the gradient and twice the slope give twice the result",
            |(r, gradient, n, index, slope)| (r, 2.0 * gradient, n, index, 2.0 * slope),
            |(_, gradient, _, index, slope), after: Vec3, twice: Vec3| {
                let scale = most(gradient, index, slope);
                near("difference", (twice - 2.0 * after).as_dvec3().length(), 0.0, 1e-6 * scale + 1e-36)
            },
        )
        .hard_case("total internal reflection", total, (&flat(reflected), 1e-7), (NAIVE, f64::INFINITY))
        .hard_case("1e-6 inside the critical angle", past, (&past_limit, 1e-5), (NAIVE, 10.0))
        .hard_case("1e-3 inside the critical angle", close, (&close_limit, 1e-5), (NAIVE, 1.0))
        .hard_case("equal indices, exactly grazing", grazing, (&grazing_limit, 0.0), (NAIVE, f64::INFINITY))
        .hard_case(
            "n * n - 1 instead of two factors: a nearly equal index",
            squared,
            (&squared_limit, 1e-5),
            (NAIVE, 1e-4),
        )
        .hard_case("an index one ulp above 1, grazing", denser, (&denser_limit, 1e-5), (NAIVE, 100.0))
        .hard_case("a gradient nearly along the normal, grazing", upright, (&upright_limit, 5e-10), (NAIVE, 1.5e-8))
        .hard_case_with(
            "a parallel slab: eq. (11) leaves a spread of unit length",
            slab,
            (&[0.0; 3], 5e-7),
            ("dispersion_paper_refract", paper, 0.8),
        )
        .build()
}

fn refract_naive() -> Formula {
    formula(M, "dispersion_refract_naive", mirror::refract_naive, oracle::refract, |draws| {
        let index = if draws.below(2) == 0 { draws.between(1.25, 4.0) } else { draws.between(0.4, 0.8) };
        // n cos θ_t at least 0.3.
        let least = (0.09 - (index - 1.0) * (index + 1.0)).max(0.04).sqrt();
        let cosine = draws.between(least, 1.0);
        let (direction, normal) = incidence(draws, cosine);
        // Perpendicular to the ray, and at most half a right angle from the normal of the plane of
        // incidence: the part in the plane may cancel against the slope of the index, the part
        // across it cannot.
        let ray = direction.as_dvec3().normalize();
        let out = ray.cross(normal.as_dvec3()).try_normalize().unwrap_or_else(|| draws.perpendicular(ray));
        let turn = std::f64::consts::FRAC_PI_4 * (2.0 * draws.unit() - 1.0);
        let across = (turn.cos() * out + turn.sin() * ray.cross(out)).as_vec3();
        let slope = draws.pick(&[1.0, -1.0]) * draws.between(0.5, 1.0);
        (direction, draws.between(6.0, 9.0) * across, normal, index, slope)
    })
    // With e = 2^-24, g the gradient's length and eta / g at most 0.42: the largest component of
    // the result is at least 0.41 eta g, cos 45 degrees over the root of 3, across the plane. The
    // radicand is at least 0.09 eta^2 and off by (8 eta^2 + 5) e, so its root is off by 62 e of
    // itself. The slope of the root is at most 1.18 eta g + 3.3 eta^2, which adds 390 e of the
    // result. The numerator of the slope adds 20 eta g e and 17 eta^2 e, which is 66 e; the first
    // two terms add 9 e, the cosine's slope 8 e, product and sums 19 e. The sum is 492 e.
    .benign(3e-5)
    .build()
}

/// Draws a vector of any length and direction.
fn vector(draws: &mut Draws<'_>) -> Vec3 {
    let length = match draws.below(8) {
        0 => draws.pick(&[0.0, 1e37]),
        1 | 2 => draws.magnitude(-60, 120),
        _ => draws.between(0.0, 1.0),
    };
    length * draws.unit_vector()
}

fn reflect() -> Formula {
    let [ray, turning] = in_plane(0.37);
    let [ray, turning] = [ray, turning].map(|v| v.as_vec3());
    let normal = Vec3::new(0.48, 0.6, 0.64);
    let reflected = {
        let [turning, normal] = [turning, normal].map(|v| v.as_dvec3());
        turning - 2.0 * normal.dot(turning) / normal.length_squared() * normal
    };
    formula(M, "dispersion_reflect", mirror::reflect, oracle::reflect, |draws| (vector(draws), draws.unit_vector()))
        .edge("no gradient", |(gradient, _)| gradient == Vec3::ZERO)
        .edge("a large gradient", |(gradient, _)| gradient.length() > 1e30)
        .edge("along the normal", |(gradient, normal)| {
            gradient.length() > 0.1 && gradient.length() < 1.0 && gradient.normalize() == normal
        })
        .invariant("as long as before", |(gradient, _), reflected: Vec3| {
            let [before, after] = [gradient, reflected].map(|v| v.as_dvec3().length());
            near("length", after, before, UNIT * before + 1e-36)
        })
        .pair(
            "linear: the reversed gradient is reflected to the reverse",
            |(gradient, normal)| (-gradient, normal),
            |_, reflected: Vec3, reversed: Vec3| near("sum", (reflected + reversed).as_dvec3().length(), 0.0, 0.0),
        )
        .hard_case_with(
            "reflection is linear: eq. (11) adds the noise of a finite difference",
            (turning, normal),
            (&flat(reflected), 3e-7),
            ("dispersion_paper_reflect", (ray, turning, normal, mirror::DISPERSION_PAPER_EPSILON), 1e-5),
        )
        .build()
}

fn direction() -> Formula {
    const NAIVE: &str = "dispersion_paper_direction";
    let [ray, turning] = in_plane(0.8);
    let (ray, gradient) = (ray.as_vec3(), (0.2 * turning).as_vec3());
    let limit = (ray.as_dvec3() + f64::from(0.03f32) * gradient.as_dvec3()).normalize();
    let paper = |size: f32| (ray, turning.as_vec3(), 1.5 * size, mirror::DISPERSION_PAPER_BLUE, 1.0f32);
    formula(M, "dispersion_direction", mirror::direction, oracle::direction, |draws| {
        let direction = draws.unit_vector();
        let length = if draws.below(4) == 0 { draws.magnitude(-40, 39) } else { draws.between(0.0, 8.0) };
        let across = draws.perpendicular(direction.as_dvec3().normalize());
        let offset = match draws.below(4) {
            0 => draws.pick(&[0.0, 0.03, -0.03]),
            1 => draws.signed(-30, 19),
            _ => draws.between(-0.2, 0.2),
        };
        (direction, (f64::from(length) * across).as_vec3(), offset)
    })
    .edge("the reference itself", |(.., offset)| offset == 0.0)
    .edge("a longer wavelength", |(.., offset)| offset < -0.01)
    .edge("a spread beyond all measure", |(_, gradient, offset)| gradient.length() * offset > 1e12)
    .invariant("unit length", |_, found: Vec3| near("length", found.as_dvec3().length(), 1.0, UNIT))
    .pair(
        "as far to one side as to the other",
        |(direction, gradient, offset)| (direction, gradient, -offset),
        |(direction, ..), one: Vec3, other: Vec3| {
            let difference = direction.as_dvec3().dot(one.as_dvec3() - other.as_dvec3());
            near("difference of cosines", difference, 0.0, UNIT)
        },
    )
    .hard_case_with("a stone 1e4 units large", (ray, gradient, 0.03), (&flat(limit), 2e-7), (NAIVE, paper(1e4), 0.5))
    .hard_case_with("a stone 1e-4 units large", (ray, gradient, 0.03), (&flat(limit), 2e-7), (NAIVE, paper(1e-4), 4e-3))
    .build()
}

fn paper_enter() -> Formula {
    const NAIVE: &str = "dispersion_paper_enter_naive";
    let [ray, _] = in_plane(0.6);
    let ray = ray.as_vec3();
    formula(M, "dispersion_paper_enter", mirror::paper_enter, oracle::paper_enter, |draws| {
        let index = relative_index(draws);
        let cosine = cosine_near_critical(draws, index);
        let (direction, normal) = incidence(draws, cosine);
        let refracted = match draws.below(4) {
            0 => {
                let offset = f64::from(draws.magnitude(-25, -10));
                let across = draws.perpendicular(direction.as_dvec3().normalize());
                (direction.as_dvec3() + offset * across).as_vec3()
            }
            _ => onwards(direction, normal, index).as_vec3(),
        };
        (direction, refracted)
    })
    .edge("not bent at all", |(direction, refracted)| direction == refracted)
    .edge("bent by an ulp", |(direction, refracted)| (1e-9..2e-7).contains(&direction.distance(refracted)))
    .edge("bent by little more than noise", |(direction, refracted)| {
        (9.6e-7..2e-6).contains(&direction.distance(refracted))
    })
    .edge("bent far", |(direction, refracted)| direction.distance(refracted) > 0.5)
    .invariant("unit or zero", |_, spread: Vec3| {
        let length = spread.as_dvec3().length();
        if length == 0.0 { Ok(()) } else { near("length", length, 1.0, UNIT) }
    })
    .pair(
        "backwards it is the opposite",
        |(direction, refracted)| (refracted, direction),
        |_, spread: Vec3, backwards: Vec3| near("sum", (spread + backwards).as_dvec3().length(), 0.0, 0.0),
    )
    .hard_case("equal indices", (ray, ray), (&[0.0; 3], 0.0), (NAIVE, f64::INFINITY))
    .hard_case(
        "normal incidence, refracted an ulp short",
        (Vec3::NEG_Z, Vec3::new(0.0, 0.0, -1.0f32.next_down())),
        (&[0.0; 3], 0.0),
        (NAIVE, 0.9),
    )
    .build()
}

fn paper_enter_naive() -> Formula {
    formula(M, "dispersion_paper_enter_naive", mirror::paper_enter_naive, oracle::paper_enter, |draws| {
        let cosine = draws.between(0.1, 0.95);
        let (direction, normal) = incidence(draws, cosine);
        (direction, onwards(direction, normal, draws.between(1.2, 4.0)).as_vec3())
    })
    .benign(1e-6)
    .build()
}

/// Draws a unit spread, perpendicular to the ray or, with `leaning`, as far from perpendicular as a
/// chord may be.
fn spread(draws: &mut Draws<'_>, direction: Vec3, leaning: bool) -> Vec3 {
    let direction = direction.as_dvec3().normalize();
    let across = draws.perpendicular(direction);
    let lean = if leaning { f64::from(draws.between(0.0, 0.7)) } else { 0.0 };
    (lean.cos() * across + lean.sin() * direction).as_vec3()
}

type Shifted = (Vec3, Vec3, Vec3, f32, f32);

/// Draws a refraction for which a finite difference in f32 is accurate: n cos θ_t and
/// c / (n cos θ_t) are not small.
fn benign_shifted(draws: &mut Draws<'_>, leaning: bool) -> Shifted {
    let (index, cosine) = if draws.below(2) == 0 {
        (draws.between(1.2, 2.5), draws.between(0.5, 1.0))
    } else {
        let index = draws.between(0.5, 0.8);
        (index, draws.between((1.09 - index * index).sqrt(), 1.0))
    };
    let (direction, normal) = incidence(draws, cosine);
    (direction, spread(draws, direction, leaning), normal, index, draws.between(2e-4, 1e-3))
}

fn paper_refract() -> Formula {
    const NAIVE: &str = "dispersion_paper_refract_naive";
    let epsilon = mirror::DISPERSION_PAPER_EPSILON;
    let out = 1.0 / DIAMOND;
    let [oblique, _] = in_plane(0.6);
    // At n cos θ_t = 0.01, a ray turned by epsilon is past the critical angle.
    let cosine = (1.0 - f64::from(out).powi(2) + 1e-4).sqrt();
    let [ray, turning] = in_plane(cosine);
    let shifted = (ray + f64::from(epsilon) * turning).normalize();
    let along_surface = DVec3::new(shifted.x - ray.x, 0.0, 0.01).normalize();
    let [total, total_turning] = in_plane(0.5);
    let reflected = DVec3::new(total_turning.x, 0.0, -total_turning.z);
    let case = |ray: DVec3, spread: DVec3, index: f32| (ray.as_vec3(), spread.as_vec3(), Vec3::Z, index, epsilon);
    formula(M, "dispersion_paper_refract", mirror::paper_refract, oracle::paper_refract, |draws| {
        match draws.below(8) {
            0 => {
                let (direction, _, normal, index, epsilon) = benign_shifted(draws, true);
                (direction, Vec3::ZERO, normal, index, epsilon)
            }
            1 => {
                // Both rays are totally reflected.
                let index = draws.between(0.3, 0.6);
                let cosine = draws.between(0.2, 0.7);
                let (direction, normal) = incidence(draws, cosine);
                (direction, spread(draws, direction, true), normal, index, draws.between(2e-4, 1e-3))
            }
            2 => {
                // Only the second ray is totally reflected, because the spread turns it towards the
                // surface.
                let index = draws.between(0.4, 0.6);
                let root = draws.between(0.005, 0.015);
                let (direction, normal) = incidence(draws, (1.0 - index * index + root * root).sqrt());
                let [r, n] = [direction, normal].map(|v| v.as_dvec3().normalize());
                let turning = (n - n.dot(r) * r).normalize().as_vec3();
                (direction, turning, normal, index, draws.between(5e-4, 1e-3))
            }
            _ => benign_shifted(draws, true),
        }
    })
    .edge("no spread", |(_, spread, ..)| spread == Vec3::ZERO)
    .edge("total internal reflection", |(r, _, n, index, _)| radicand(r, n, index) < 0.0)
    .edge("total internal reflection of the second alone", |(r, spread, n, index, epsilon)| {
        let shifted = (r.as_dvec3() + f64::from(epsilon) * spread.as_dvec3()).normalize().as_vec3();
        radicand(r, n, index) > 0.0 && radicand(shifted, n, index) < 0.0
    })
    // Each ray is off by about four roundings, 2e-7; the smallest difference is 2e-4 · 0.7 · 0.2.
    .benign(2e-2)
    .hard_case(
        "no spread, as after normal incidence",
        case(oblique, DVec3::ZERO, DIAMOND),
        (&[0.0; 3], 0.0),
        (NAIVE, f64::INFINITY),
    )
    .hard_case(
        "equal indices without a spread",
        case(oblique, DVec3::ZERO, 1.0),
        (&[0.0; 3], 0.0),
        (NAIVE, f64::INFINITY),
    )
    .hard_case(
        "total internal reflection of the second ray alone",
        case(ray, turning, out),
        (&flat(along_surface), 1e-3),
        (NAIVE, 0.9),
    )
    .hard_case(
        "total internal reflection of both",
        case(total, total_turning, out),
        (&flat(reflected), 3e-3),
        (NAIVE, f64::INFINITY),
    )
    .build()
}

fn paper_refract_naive() -> Formula {
    formula(M, "dispersion_paper_refract_naive", mirror::paper_refract_naive, oracle::paper_refract, |draws| {
        benign_shifted(draws, false)
    })
    .benign(2e-2)
    .build()
}

fn paper_reflect() -> Formula {
    formula(M, "dispersion_paper_reflect", mirror::paper_reflect, oracle::paper_reflect, |draws| {
        let cosine = draws.between(0.0, 1.0);
        let (direction, normal) = incidence(draws, cosine);
        let spread = if draws.below(8) == 0 { Vec3::ZERO } else { spread(draws, direction, true) };
        (direction, spread, normal, draws.between(2e-4, 1e-3))
    })
    // Each ray is off by about three roundings, 1.8e-7; the smallest difference is 2e-4 · 0.7.
    .benign(5e-3)
    .build()
}

fn paper_direction() -> Formula {
    formula(M, "dispersion_paper_direction", mirror::paper_direction, oracle::paper_direction, |draws| {
        let direction = draws.unit_vector();
        let spread = if draws.below(8) == 0 { Vec3::ZERO } else { spread(draws, direction, true) };
        let distance = if draws.below(2) == 0 { draws.between(0.1, 4.0) } else { draws.magnitude(-14, 14) };
        (direction, spread, distance, draws.between(1.0, 1.7), draws.pick(&[1.0, 0.02, 0.5]))
    })
    .edge("no spread", |(_, spread, ..)| spread == Vec3::ZERO)
    .edge("a large stone", |(_, _, distance, ..)| distance > 1e3)
    .edge("a small one", |(_, _, distance, ..)| distance < 1e-3)
    .benign(2e-6)
    .build()
}
