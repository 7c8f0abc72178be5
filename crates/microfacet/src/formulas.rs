//! Test inputs, edges, invariants and hard cases of `wgsl/microfacet.wgsl`.

mod outside;

use crate::{self as mirror, oracle};
use glam::{DVec3, Vec2, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use std::f64::consts::PI;

const M: &str = "microfacet";

/// Error of a unit vector's length after three squares, two sums and the rounding of the inputs,
/// with room for the portable bounds.
const UNIT: f64 = 16.0 / (1 << 24) as f64;

/// Factor on the bound of a product for the rounding of each of its parts, with room for the
/// portable bounds.
const ROUNDED: f64 = 1.0 + 2e-5;

/// Draws an alpha: every magnitude down to the clamp and below it, the ends, and beyond.
fn alpha(draws: &mut Draws<'_>) -> f32 {
    match draws.below(6) {
        0 => draws.pick(&[1.0, 0.001, 0.0, -0.5, 2.0, 1.0f32.next_down()]),
        1..=3 => draws.magnitude(-12, -1),
        _ => draws.between(0.001, 1.0),
    }
}

/// Returns the clamped alpha.
fn width(alpha: f32) -> f64 {
    f64::from(alpha.clamp(0.001, 1.0))
}

/// Draws an angle between the normals of a facet and the surface: multiples of alpha, every
/// magnitude, and any angle.
fn tilt(draws: &mut Draws<'_>, alpha: f32) -> f64 {
    match draws.below(4) {
        0 => f64::from(draws.magnitude(-30, 0)),
        1 | 2 => width(alpha) * f64::from(draws.magnitude(-3, 3)),
        _ => PI * draws.unit(),
    }
}

/// Draws a cosine: every magnitude, the ends, and out of range.
fn cosine(draws: &mut Draws<'_>) -> f32 {
    match draws.below(4) {
        0 => draws.pick(&[1.0, 0.0, -0.5, 1.5, f32::MIN_POSITIVE]),
        1 => draws.magnitude(-126, -1),
        2 => draws.magnitude(-24, -1),
        _ => draws.between(0.0, 1.0),
    }
}

/// Draws the normals of the surface and of a facet, and alpha. In one case of eight, the lengths
/// are not 1.
fn facet(draws: &mut Draws<'_>) -> (Vec3, Vec3, f32) {
    let normal = draws.unit_vector();
    let alpha = alpha(draws);
    let axis = normal.as_dvec3().normalize();
    let tangent = draws.perpendicular(axis);
    let tilt = tilt(draws, alpha);
    let half = match draws.below(16) {
        1 => normal,
        2 => tangent.as_vec3(),
        3 => Vec3::ZERO,
        _ => (tilt.cos() * axis + tilt.sin() * tangent).as_vec3(),
    };
    match draws.below(16) {
        1 => (Vec3::ZERO, half, alpha),
        2 | 3 => (draws.magnitude(-13, 12) * normal, draws.magnitude(-13, 12) * half, alpha),
        _ => (normal, half, alpha),
    }
}

/// Draws directions towards light and eye: any, equal, opposite, and opposite up to a deviation of
/// every magnitude.
fn directions(draws: &mut Draws<'_>) -> (Vec3, Vec3) {
    let light = draws.unit_vector();
    let axis = light.as_dvec3().normalize();
    let eye = match draws.below(6) {
        0 => light,
        1 => -light,
        2 => (f64::from(draws.magnitude(-80, -1)) * draws.perpendicular(axis) - axis).normalize().as_vec3(),
        _ => draws.unit_vector(),
    };
    (light, eye)
}

/// Draws normal, light, eye, alpha and Fresnel reflectance, mostly with a facet near the normal
/// that reflects the light into the eye.
fn lit(draws: &mut Draws<'_>) -> (Vec3, Vec3, Vec3, f32, f32) {
    let normal = draws.unit_vector();
    let alpha = alpha(draws);
    let axis = normal.as_dvec3().normalize();
    let fresnel = if draws.below(4) == 0 { draws.pick(&[1.0, 0.0]) } else { draws.between(0.0, 1.0) };
    let elevation = match draws.below(4) {
        0 => draws.magnitude(-24, -1),
        _ => draws.between(0.0, 1.0),
    };
    let tangent = draws.perpendicular(axis);
    let up = f64::from(elevation);
    let eye = up * axis + ((1.0 - up) * (1.0 + up)).sqrt() * tangent;
    let (light, eye) = match draws.below(8) {
        0 => return (normal, eye.as_vec3(), -eye.as_vec3(), alpha, fresnel),
        1 => return (Vec3::ZERO, eye.as_vec3(), draws.unit_vector(), alpha, fresnel),
        2 => (draws.direction(), draws.direction()),
        3 => (draws.direction(), eye),
        _ => {
            let tilt = tilt(draws, alpha);
            let facet = tilt.cos() * axis + tilt.sin() * draws.perpendicular(axis);
            (2.0 * eye.dot(facet) * facet - eye, eye)
        }
    };
    (normal, light.normalize().as_vec3(), eye.as_vec3(), alpha, fresnel)
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a.as_dvec3().dot(b.as_dvec3())
}

fn within(what: &str, value: f32, most: f64) -> Result<(), String> {
    if (0.0..=most * ROUNDED).contains(&f64::from(value)) { Ok(()) } else { Err(format!("{what} {value} of {most}")) }
}

/// Returns every function of the module with its mirror, its oracle and its promises outside its
/// domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    let all =
        [vec![distribution(), distribution_naive(), visibility(), visibility_naive(), half(), half_naive()], facets()];
    all.into_iter().flatten().chain([reflectance()]).collect()
}

fn distribution() -> Formula {
    const NAIVE: &str = "microfacet_distribution_naive";
    // A facet whose normal has the x component `sine`, on a surface with normal +z, and its exact
    // distribution.
    let tilted = |sine: f32| Vec3::new(sine, 0.0, (1.0 - f64::from(sine).powi(2)).sqrt() as f32);
    let exact = |facet: Vec3, alpha: f64| {
        let tangent = f64::from(facet.x) / f64::from(facet.z);
        (alpha * (1.0 + tangent * tangent) / (alpha * alpha + tangent * tangent)).powi(2) / PI
    };
    let case = |sine: f32, alpha: f32| {
        let facet = tilted(sine);
        ((Vec3::Z, facet, alpha), [exact(facet, width(alpha))], (facet.z, alpha))
    };
    let (mirror_like, mirror_limit, mirror_naive) = case(0.0, 0.0);
    let (unseen, unseen_limit, unseen_naive) = case(2e-4, 0.001);
    let (flank, flank_limit, flank_naive) = case(1e-3, 0.001);
    let (wider, wider_limit, wider_naive) = case(5e-3, 0.01);
    formula(M, "microfacet_distribution", mirror::distribution, oracle::distribution, facet)
        .edge("at the peak", |(normal, half, _)| normal == half && normal != Vec3::ZERO)
        .edge("a cosine of 1 beside the peak", |(normal, half, _)| normal.dot(half) == 1.0 && normal != half)
        .edge("one alpha from the peak, alpha below 0.01", |(normal, half, alpha)| {
            let tangent = normal.as_dvec3().cross(half.as_dvec3()).length() / dot(normal, half);
            alpha < 0.01 && (0.5..2.0).contains(&(tangent / width(alpha)))
        })
        .edge("at right angles", |(normal, half, _)| normal.dot(half) == 0.0 && normal.cross(half) != Vec3::ZERO)
        .edge("far side", |(normal, half, _)| normal.dot(half) < -0.5)
        .edge("no normal", |(normal, ..)| normal == Vec3::ZERO)
        .edge("no half", |(_, half, _)| half == Vec3::ZERO)
        .edge("long and short vectors", |(normal, half, _)| normal.length() > 1e3 && half.length() < 1e-2)
        .edge("alpha below its least", |(.., alpha)| alpha < 0.001)
        .edge("alpha above its greatest", |(.., alpha)| alpha > 1.0)
        .invariant("in [0, 1 / (pi alpha^2)]", |(.., alpha), density: f32| {
            within("density", density, 1.0 / (PI * width(alpha).powi(2)))
        })
        .invariant("0 without a direction, else above 0", |(normal, half, _), density: f32| {
            let none = normal == Vec3::ZERO || half == Vec3::ZERO;
            if none == (density == 0.0) { Ok(()) } else { Err(format!("density {density}")) }
        })
        .pair(
            "even in half",
            |(normal, half, alpha)| (normal, -half, alpha),
            |_, density: f32, other: f32| near("difference", f64::from(density) - f64::from(other), 0.0, 0.0),
        )
        .hard_case_with("at the peak, alpha 0", mirror_like, (&mirror_limit, 1.0), (NAIVE, mirror_naive, f64::INFINITY))
        .hard_case_with("2e-4 beside the peak, alpha 0.001", unseen, (&unseen_limit, 1.0), (NAIVE, unseen_naive, 1e4))
        .hard_case_with("one alpha from the peak, alpha 0.001", flank, (&flank_limit, 0.3), (NAIVE, flank_naive, 1e3))
        .hard_case_with(
            "half an alpha from the peak, alpha 0.01",
            wider,
            (&wider_limit, 0.01),
            (NAIVE, wider_naive, 0.5),
        )
        .build()
}

fn distribution_naive() -> Formula {
    formula(M, "microfacet_distribution_naive", mirror::distribution_naive, oracle::distribution_naive, |draws| {
        (draws.between(0.0, 1.0), draws.between(0.2, 1.0))
    })
    .benign(3e-5)
    .build()
}

fn visibility() -> Formula {
    const NAIVE: &str = "microfacet_visibility_naive";
    formula(M, "microfacet_visibility", mirror::visibility, oracle::visibility, |draws| {
        (cosine(draws), cosine(draws), alpha(draws))
    })
    .edge("light exactly grazing", |(light, eye, _)| light == 0.0 && eye > 0.01)
    .edge("eye exactly grazing", |(light, eye, _)| eye == 0.0 && light > 0.01)
    .edge("both exactly grazing", |(light, eye, _)| light == 0.0 && eye == 0.0)
    .edge("the least divisor", |(light, eye, _)| light > 0.0 && eye > 0.0 && light.max(eye) < 1e-24)
    .edge("just above it", |(light, eye, _)| light.min(eye) > 0.0 && (1e-21..1e-15).contains(&light.max(eye)))
    .edge("both along the normal", |(light, eye, _)| light == 1.0 && eye == 1.0)
    .edge("light below the surface", |(light, ..)| light < 0.0)
    .edge("eye below the surface", |(_, eye, _)| eye < 0.0)
    .edge("a cosine above 1", |(light, eye, _)| light > 1.0 && eye > 1.0)
    .edge("alpha below its least", |(.., alpha)| alpha < 0.001)
    .edge("alpha above its greatest", |(.., alpha)| alpha > 1.0)
    .invariant(
        "masked light is less than 1 / (4 n.l n.v), and seen light not none",
        |(light, eye, _), visibility: f32| {
            let [light, eye] = [light, eye].map(|cosine| f64::from(cosine.clamp(0.0, 1.0)));
            let value = f64::from(visibility);
            if value * 4.0 * light * eye <= ROUNDED && value * ROUNDED >= 0.25 {
                Ok(())
            } else {
                Err(format!("visibility {visibility}"))
            }
        },
    )
    .pair(
        "light and eye may change places",
        |(light, eye, alpha)| (eye, light, alpha),
        |_, one: f32, other: f32| {
            near("difference", f64::from(one) - f64::from(other), 0.0, f64::from(one) * (ROUNDED - 1.0))
        },
    )
    .hard_case("light exactly grazing", (0.0, 0.5, 0.25), (&[4.0], 1e-5), (NAIVE, f64::INFINITY))
    .hard_case("both at a cosine of 1e-20", (1e-20, 1e-20, 0.5), (&[5e19], 5e13), (NAIVE, 4e19))
    .hard_case("both exactly grazing", (0.0, 0.0, 0.5), (&[5e23], 5e17), (NAIVE, f64::INFINITY))
    .build()
}

fn visibility_naive() -> Formula {
    formula(M, "microfacet_visibility_naive", mirror::visibility_naive, oracle::visibility_naive, |draws| {
        (draws.between(0.1, 1.0), draws.between(0.1, 1.0), draws.between(0.1, 1.0))
    })
    .benign(1e-5)
    .build()
}

fn half() -> Formula {
    formula(M, "microfacet_half", mirror::half, oracle::half, directions)
        .edge("opposite", |(light, eye)| light == -eye)
        .edge("opposite to 1e-15", |(light, eye)| (1e-24..1e-15).contains(&(light + eye).length()))
        .edge("opposite to 1e-3", |(light, eye)| (1e-12..1e-3).contains(&(light + eye).length()))
        .edge("equal", |(light, eye)| light == eye)
        .invariant("unit length, or less for opposite directions", |(light, eye), half: Vec3| {
            let length = half.as_dvec3().length();
            let sum = (light.as_dvec3() + eye.as_dvec3()).length();
            near("length", length, (sum * 1e15).min(1.0), UNIT)
        })
        .invariant("equal angles to light and eye", |(light, eye), half: Vec3| {
            let sum = (light.as_dvec3() + eye.as_dvec3()).length();
            near("difference of cosines", sum.min(1.0) * (dot(half, light) - dot(half, eye)), 0.0, UNIT)
        })
        .pair(
            "light and eye may change places",
            |(light, eye)| (eye, light),
            |_, half: Vec3, other: Vec3| near("difference", half.distance(other).into(), 0.0, 0.0),
        )
        .hard_case(
            "opposite directions",
            (Vec3::X, Vec3::NEG_X),
            (&[0.0; 3], 0.0),
            ("microfacet_half_naive", f64::INFINITY),
        )
        .build()
}

fn half_naive() -> Formula {
    formula(M, "microfacet_half_naive", mirror::half_naive, oracle::half_naive, |draws| {
        let light = draws.unit_vector();
        let axis = light.as_dvec3().normalize();
        let angle = 3.0 * draws.unit();
        let eye: DVec3 = angle.cos() * axis + angle.sin() * draws.perpendicular(axis);
        (light, eye.as_vec3())
    })
    .benign(1e-5)
    .build()
}

/// Normal, direction towards the eye, alpha, u and azimuth.
type Seen = (Vec3, Vec3, f32, f32, Vec2);

/// Draws an eye above a surface, alpha and the place of a facet among those that it sees.
fn seen(draws: &mut Draws<'_>) -> Seen {
    let normal = match draws.below(8) {
        0 => draws.pick(&[Vec3::Z, Vec3::NEG_Z, Vec3::X]),
        1 => draws.unit_vector().with_z(0.0).normalize_or(Vec3::Y),
        _ => draws.unit_vector(),
    };
    let axis = normal.as_dvec3().normalize();
    let up = match draws.below(6) {
        0 => draws.pick(&[0.0, 1.0]),
        1 => draws.magnitude(-24, -1),
        2 => 1.0 - draws.magnitude(-24, -1),
        _ => draws.between(0.0, 1.0),
    };
    let up = f64::from(up);
    let eye = (up * axis + ((1.0 - up) * (1.0 + up)).sqrt() * draws.perpendicular(axis)).as_vec3();
    // Rounding may put an eye at the surface below it.
    let eye = if normal.dot(eye) < 0.0 { eye - 2.0 * normal.dot(eye) * normal } else { eye };
    // Multiples of 2^-24.
    let u = match draws.below(6) {
        0 => draws.pick(&[0.0, 1.0f32.next_down(), 0.5]),
        1 => draws.magnitude(-23, -1),
        2 => 1.0 - draws.magnitude(-23, -1),
        _ => draws.between(0.0, 1.0),
    };
    let u = (u * 16_777_216.0).floor().min(16_777_215.0) / 16_777_216.0;
    let turns = std::f64::consts::TAU * draws.unit();
    (normal, eye, alpha(draws), u, Vec2::new(turns.cos() as f32, turns.sin() as f32))
}

fn facets() -> Vec<Formula> {
    const NAIVE: &str = "microfacet_facet_naive";
    // Beside the middle of the cap, along y.
    let beside: Seen = (Vec3::Z, Vec3::new(0.6, 0.0, 0.8), 1.0, 2f32.powi(-24), Vec2::Y);
    let beside_limit = {
        let risen = f64::from(beside.3) * 1.8;
        let half = DVec3::new(0.6, -(risen * (2.0 - risen)).sqrt(), 1.8 - risen);
        half.normalize().to_array()
    };
    let down: Seen = (Vec3::NEG_Z, Vec3::NEG_Z, 0.5, 0.0, Vec2::X);
    vec![
        formula(M, "microfacet_facet", mirror::facet, oracle::facet, seen)
            .edge("the eye exactly grazing", |(normal, eye, ..)| normal.dot(eye) == 0.0)
            .edge("the eye along the normal", |(normal, eye, ..)| normal == eye)
            .edge("the middle of the cap", |(.., u, _)| u == 0.0)
            .edge("the cap's edge", |(.., u, _)| u == 1.0f32.next_down())
            .edge("a normal in the plane z = 0", |(normal, _, alpha, ..)| normal.z == 0.0 && alpha > 0.1)
            .edge("a normal along -z", |(normal, ..)| normal == Vec3::NEG_Z)
            .edge("alpha below its least", |(_, _, alpha, ..)| alpha < 0.001)
            .edge("alpha above its greatest", |(_, _, alpha, ..)| alpha > 1.0)
            .invariant("unit length", |_, facet: Vec3| near("length", facet.as_dvec3().length(), 1.0, UNIT))
            .invariant("on the surface's side and the eye's", |(normal, eye, _, u, _), facet: Vec3| {
                let least = dot(normal, facet).min(dot(eye, facet));
                // The sum of the two directions is no shorter than 1 - u, and rounded by as much as they are.
                if least >= -UNIT / f64::from((1.0 - u).max(f32::EPSILON / 2.0)) {
                    Ok(())
                } else {
                    Err(format!("a cosine of {least}"))
                }
            })
            .hard_case("beside the middle of the cap", beside, (&beside_limit, 1e-6), (NAIVE, 5e-5))
            .hard_case("a normal along -z", down, (&[0.0, 0.0, -1.0], 1e-6), (NAIVE, f64::INFINITY))
            .build(),
        formula(M, NAIVE, mirror::facet_naive, oracle::facet_naive, |draws| {
            let eye = (draws.direction() + 1.5 * DVec3::Z).normalize().as_vec3();
            let turns = std::f64::consts::TAU * draws.unit();
            let azimuth = Vec2::new(turns.cos() as f32, turns.sin() as f32);
            (Vec3::Z, eye, draws.between(0.2, 1.0), draws.between(0.1, 0.8), azimuth)
        })
        .benign(2e-5)
        .build(),
    ]
}

fn reflectance() -> Formula {
    formula(M, "microfacet_reflectance", mirror::reflectance, oracle::reflectance, lit)
        .edge("at the peak of a smooth surface", |(normal, light, eye, alpha, fresnel)| {
            let peak = 1.0 / (PI * width(alpha).powi(2));
            let half = oracle::half(light.as_dvec3(), eye.as_dvec3());
            alpha < 0.01 && fresnel > 0.0 && oracle::distribution(normal.as_dvec3(), half, alpha.into()) > 0.5 * peak
        })
        .edge("light below the surface", |(normal, light, ..)| dot(normal, light) < -0.01)
        .edge("eye below the surface, light above", |(normal, light, eye, ..)| {
            dot(normal, eye) < -0.01 && dot(normal, light) > 0.01 && (light + eye).length() > 0.01
        })
        .edge("light opposite to the eye", |(_, light, eye, ..)| light == -eye)
        .edge("light and eye grazing", |(normal, light, eye, ..)| {
            let range = 1e-7..1e-3;
            range.contains(&dot(normal, light)) && range.contains(&dot(normal, eye))
        })
        .edge("no normal", |(normal, ..)| normal == Vec3::ZERO)
        .edge("no reflection", |(.., fresnel)| fresnel == 0.0)
        .invariant("in [0, fresnel / (2 pi alpha^3)]", |(.., alpha, fresnel), reflectance: f32| {
            within("reflectance", reflectance, f64::from(fresnel) / (2.0 * PI * width(alpha).powi(3)))
        })
        .invariant(
            "0 where the light is below the surface, or no surface is there",
            |(normal, light, ..), value: f32| {
                let dark = normal == Vec3::ZERO || dot(normal, light) < -1e-6;
                if dark { near("reflectance", value.into(), 0.0, 0.0) } else { Ok(()) }
            },
        )
        // Helmholtz reciprocity of the BRDF, without the cosine of the light.
        .pair(
            "light and eye may change places",
            |(normal, light, eye, alpha, fresnel)| (normal, eye, light, alpha, fresnel),
            |(normal, light, eye, ..), there: f32, back: f32| {
                let [light, eye] = [light, eye].map(|toward| dot(normal, toward));
                if light.min(eye) < 0.01 {
                    return Ok(());
                }
                let (there, back) = (f64::from(there) * eye, f64::from(back) * light);
                // Each cosine is at least 0.01 and off by at most 2e-7.
                near("difference", there - back, 0.0, 1e-4 * there)
            },
        )
        .build()
}
