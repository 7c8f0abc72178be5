//! Test inputs, edges, invariants and hard cases of `wgsl/split_sum.wgsl`.

mod draw;
mod outside;
mod shared;
mod table;

use shared::{M, ROUNDED};

use crate::{self as mirror, SplitSumLobe, oracle};
use draw::{alpha, axis, azimuth, colour, cosine, random};
use glam::{Vec2, Vec3};
use lapidary_assay::formula::{Formula, formula, near, with_promises};
use lapidary_assay::mirror_struct;
use std::f64::consts::PI;

mirror_struct!(crate, SplitSumLobe { toward, weight, solid_angle });

/// Error of a unit vector's length: the half turn, two products and a sum, with room for the portable bounds.
const UNIT: f64 = 64.0 / (1 << 24) as f64;

/// Returns every function of the module with its mirror, its oracle and its promises outside its domain.
#[must_use]
pub fn formulas() -> Vec<Formula> {
    with_promises(functions(), outside::promises())
}

fn functions() -> Vec<Formula> {
    [table::formulas(), shadowing(), lobe(), reflectance()].into_iter().flatten().collect()
}

/// Checks that shares of light are between 0 and 1.
fn shares(values: &[f32]) -> Result<(), String> {
    for value in values {
        near("share", f64::from(*value) - 0.5, 0.0, 0.5 + ROUNDED)?;
    }
    Ok(())
}

fn shadowing() -> Vec<Formula> {
    const NAIVE: &str = "split_sum_shadowing_naive";
    vec![
        formula(M, "split_sum_fresnel", mirror::fresnel, oracle::fresnel, |draws| (colour(draws), cosine(draws)))
            .edge("grazing", |(f0, cosine)| cosine == 0.0 && f0.x < 0.5)
            .edge("head on", |(f0, cosine)| cosine == 1.0 && f0.x < 0.5)
            .edge("a cosine above 1", |(_, cosine)| cosine > 1.0)
            .edge("a cosine below 0", |(_, cosine)| cosine < 0.0)
            .edge("a perfect mirror", |(f0, _)| f0 == Vec3::ONE)
            .invariant("between f0 and 1", |(f0, _), share: Vec3| {
                let least = (share - f0).min_element();
                shares(&share.to_array())?;
                if f64::from(least) >= -ROUNDED { Ok(()) } else { Err(format!("below f0 by {least}")) }
            })
            .build(),
        formula(M, "split_sum_shadowing", mirror::shadowing, oracle::shadowing, |draws| {
            (cosine(draws), cosine(draws), alpha(draws))
        })
        .edge("light exactly grazing", |(light, eye, _)| light == 0.0 && eye > 0.01)
        .edge("eye exactly grazing", |(light, eye, _)| eye == 0.0 && light > 0.01)
        .edge("both exactly grazing", |(light, eye, _)| light == 0.0 && eye == 0.0)
        .edge("the eye nearer to grazing than counts", |(light, eye, _)| light > 0.1 && (1e-30..1e-15).contains(&eye))
        .edge("the light much nearer", |(light, eye, _)| (1e-37..1e-30).contains(&light) && eye < 1e-15)
        .edge("light below the surface", |(light, ..)| light < 0.0)
        .edge("eye below the surface", |(_, eye, _)| eye < 0.0)
        .edge("a cosine above 1", |(light, eye, _)| light > 1.0 && eye > 1.0)
        .edge("alpha below its least", |(.., alpha)| alpha < 0.001)
        .edge("alpha above its greatest", |(.., alpha)| alpha > 1.0)
        .invariant("in [0, 1]", |_, share: f32| shares(&[share]))
        .invariant("G1 of the light where the eye is along the normal", |(light, eye, alpha), share: f32| {
            if eye < 1.0 {
                return Ok(());
            }
            let [light, alpha] = [light.clamp(0.0, 1.0), alpha.clamp(0.001, 1.0)].map(f64::from);
            let wanted = 2.0 * light / (light + (alpha * alpha + (1.0 - alpha * alpha) * light * light).sqrt());
            near("share", share.into(), wanted, ROUNDED)
        })
        .hard_case("eye exactly grazing", (0.5, 0.0, 0.25), (&[1.0], 1e-6), (NAIVE, f64::INFINITY))
        .build(),
        formula(M, NAIVE, mirror::shadowing_naive, oracle::shadowing_naive, |draws| {
            (draws.between(0.1, 1.0), draws.between(0.1, 1.0), draws.between(0.1, 1.0))
        })
        .benign(1e-5)
        .build(),
        formula(M, "split_sum_albedo", mirror::albedo, oracle::albedo, |draws| {
            (cosine(draws), cosine(draws), cosine(draws), alpha(draws))
        })
        .edge("a facet seen edge on", |(facing, light, eye, _)| facing == 0.0 && light > 0.1 && eye > 0.1)
        .edge("a facet seen head on", |(facing, light, eye, _)| facing == 1.0 && light > 0.1 && eye > 0.1)
        .edge("light below the surface", |(_, light, ..)| light < 0.0)
        .edge("alpha below its least", |(.., alpha)| alpha < 0.001)
        .invariant("both parts are shares of light", |_, parts: Vec2| shares(&[parts.x, parts.y, parts.x + parts.y]))
        .build(),
    ]
}

fn lobe() -> Vec<Formula> {
    const NAIVE: &str = "split_sum_lobe_naive";
    // Of a facet of slope 2e-6, on a surface along z.
    let narrow = (Vec3::Z, 0.001, 2f32.powi(-18), Vec2::X);
    let exact = oracle::lobe(glam::DVec3::Z, 0.001f32.into(), 2f64.powi(-18), glam::DVec2::X);
    let limit = [exact.toward.x, 0.0, exact.toward.z, exact.weight, exact.solid_angle];
    let down = (Vec3::NEG_Z, 0.5, 0.0, Vec2::X);
    let below = [0.0, 0.0, -1.0, 1.0, PI];
    vec![
        formula(M, "split_sum_lobe", mirror::lobe, oracle::lobe, |draws| {
            (axis(draws), alpha(draws), random(draws), azimuth(draws))
        })
        .edge("along the axis", |(_, _, u, _)| u == 0.0)
        .edge("the least light", |(_, _, u, _)| u == 1.0f32.next_down())
        .edge("a smooth metal", |(_, alpha, u, _)| alpha < 0.002 && u > 0.1)
        .edge("below the horizon", |(_, alpha, u, _)| alpha > 0.5 && u > 0.9)
        .edge("an axis in the plane z = 0", |(axis, ..)| axis.z == 0.0)
        .edge("an axis along -z", |(axis, ..)| axis == Vec3::NEG_Z)
        .edge("alpha below its least", |(_, alpha, ..)| alpha < 0.001)
        .edge("alpha above its greatest", |(_, alpha, ..)| alpha > 1.0)
        .invariant("unit length", |_, lobe: SplitSumLobe| near("length", lobe.toward.as_dvec3().length(), 1.0, UNIT))
        .invariant("the weight is the cosine to the axis", |(axis, ..), lobe: SplitSumLobe| {
            near("weight", lobe.weight.into(), axis.as_dvec3().dot(lobe.toward.as_dvec3()).max(0.0), UNIT)
        })
        .invariant("a solid angle of 4 pi alpha^2 to 4 pi / alpha^2", |(_, alpha, ..), lobe: SplitSumLobe| {
            let width = f64::from(alpha.clamp(0.001, 1.0)).powi(2);
            let share = f64::from(lobe.solid_angle) / (4.0 * PI);
            if share >= width * (1.0 - ROUNDED) && share * width <= 1.0 + ROUNDED {
                Ok(())
            } else {
                Err(format!("{share}"))
            }
        })
        .hard_case("a narrow lobe", narrow, (&limit, 1e-6), (NAIVE, 3e-6))
        .hard_case("an axis along -z", down, (&below, 1e-6), (NAIVE, f64::INFINITY))
        .build(),
        formula(M, NAIVE, mirror::lobe_naive, oracle::lobe_naive, |draws| {
            let axis = (draws.direction() + 1.5 * glam::DVec3::Z).normalize().as_vec3();
            (axis, draws.between(0.3, 0.6), draws.between(0.2, 0.5), azimuth(draws))
        })
        .benign(2e-5)
        .build(),
    ]
}

/// Draws a value of the table: any of its domain, and those at the ends of the albedo.
fn reflected(draws: &mut lapidary_assay::draws::Draws<'_>) -> Vec2 {
    let albedo = match draws.below(4) {
        0 => draws.pick(&[1.0, 0.25, 0.5]),
        1 => 1.0 - draws.magnitude(-24, -2),
        _ => draws.between(0.25, 1.0),
    };
    let rest = albedo * if draws.below(4) == 0 { draws.pick(&[0.0, 1.0]) } else { draws.between(0.0, 1.0) };
    Vec2::new(albedo - rest, rest)
}

fn reflectance() -> Vec<Formula> {
    const SINGLE: &str = "split_sum_reflectance_naive";
    const TURQUIN: &str = "split_sum_compensation_turquin";
    // Half of what comes is reflected at each facet, as rough and head on as in the first row of the walks' table.
    let (half, rough) = (Vec3::splat(0.5), 0.307);
    let left = oracle::compensation(half.as_dvec3(), f64::from(rough)).to_array();
    vec![
        formula(M, "split_sum_compensation", mirror::compensation, oracle::compensation, |draws| {
            let albedo = match draws.below(5) {
                0 => draws.pick(&[0.0, 0.25, 1.0, 1.5]),
                1 => 1.0 - draws.magnitude(-24, -2),
                _ => draws.between(0.2, 1.1),
            };
            (colour(draws), albedo)
        })
        .edge("nothing lost", |(f0, albedo)| albedo == 1.0 && f0.x > 0.1)
        .edge("hardly anything lost", |(_, albedo)| (1e-6..1e-4).contains(&(1.0 - albedo)))
        .edge("the most that is lost", |(_, albedo)| albedo == 0.25)
        .edge("an albedo below its least", |(_, albedo)| albedo < 0.25)
        .edge("an albedo above its greatest", |(_, albedo)| albedo > 1.0)
        .edge("a perfect mirror", |(f0, albedo)| f0 == Vec3::ONE && albedo < 0.9)
        .edge("black", |(f0, albedo)| f0 == Vec3::ZERO && albedo < 0.9)
        .invariant("1 / E at f0 = 1, and between 1 and 1 / E", |(f0, albedo), factor: Vec3| {
            let most = 1.0 / f64::from(albedo.clamp(0.25, 1.0));
            for (f0, factor) in f0.to_array().into_iter().zip(factor.to_array()) {
                let factor = f64::from(factor);
                if f0 == 1.0 {
                    near("factor", factor, most, ROUNDED * most)?;
                }
                near("factor", factor, 0.5 * (1.0 + most), 0.5 * (most - 1.0) + ROUNDED * most)?;
            }
            Ok(())
        })
        .hard_case("a third of the light, halved at each facet", (half, rough), (&left, 1e-5), (TURQUIN, 0.3))
        .build(),
        formula(M, TURQUIN, mirror::compensation_turquin, oracle::compensation_turquin, |draws| {
            (colour(draws), draws.between(0.25, 1.0))
        })
        .benign(1e-5)
        .build(),
        formula(M, "split_sum_reflectance", mirror::reflectance, oracle::reflectance, |draws| {
            (colour(draws), reflected(draws))
        })
        .edge("all light reflected once", |(_, table)| table.x + table.y == 1.0)
        .edge("the least light", |(_, table)| table.x + table.y == 0.25)
        .edge("all of it grazing", |(_, table)| table.x == 0.0 && table.y > 0.3)
        .edge("a perfect mirror", |(f0, table)| f0 == Vec3::ONE && table.x + table.y < 0.9)
        .invariant("a share of light, and all of it at f0 = 1", |(f0, _), share: Vec3| {
            shares(&share.to_array())?;
            if f0 == Vec3::ONE { near("share", share.x.into(), 1.0, ROUNDED) } else { Ok(()) }
        })
        .hard_case(
            "white and rough: single scattering loses two thirds",
            (Vec3::ONE, Vec2::new(0.303, 0.004)),
            (&[1.0; 3], 1e-5),
            (SINGLE, 0.69),
        )
        .build(),
        formula(M, SINGLE, mirror::reflectance_naive, oracle::reflectance_naive, |draws| {
            (colour(draws), reflected(draws))
        })
        .benign(1e-5)
        .build(),
    ]
}
