//! Rough surfaces: light goes from facet to facet until it leaves them on either side, so that none is lost.
//!
//! Heitz, Hanika, d'Eon and Dachsbacher, "Multiple-Scattering Microfacet BSDFs with the Smith Model", ACM Transactions on
//! Graphics 35(4), 2016. The facets are Trowbridge and Reitz's (GGX).

use glam::{DVec2, DVec3};
use lapidary_fresnel::oracle as fresnel;
use lapidary_microfacet::oracle as microfacet;
use lapidary_refraction::oracle as refraction;
use rand::RngExt as _;
use rand::rngs::Xoshiro256PlusPlus;
use std::f64::consts::TAU;

/// Largest number of facets that light meets; one path in millions meets more, and leaves as it goes then.
const MOST_FACETS: u32 = 1000;

/// Returns where light goes from a rough surface, and whether it goes through. `normal` faces the light; `alpha` is the width
/// of the facets' slopes.
pub(super) fn scatter(
    random: &mut Xoshiro256PlusPlus,
    direction: DVec3,
    normal: DVec3,
    alpha: f64,
    relative_index: f64,
) -> (DVec3, bool) {
    let mut direction = direction;
    // The side of the facets that light is on, 1 before the surface and -1 behind it, and the share of the surface that lies
    // farther from that side's outside, which is 1 far out.
    let (mut side, mut below) = (1.0, 1.0);
    for _ in 0..MOST_FACETS {
        let up = side * normal;
        let Some(next) = step(random.random(), below, masking(up.dot(direction), alpha)) else { break };
        below = next;
        let facet = facet(random, direction, up, alpha);
        let index = if side > 0.0 { relative_index } else { relative_index.recip() };
        let reflectance = fresnel::dielectric(-facet.dot(direction), index);
        let refracted = refraction::refract(direction, facet, index);
        if refracted.total || random.random::<f64>() < reflectance {
            direction -= 2.0 * facet.dot(direction) * facet;
        } else {
            direction = refracted.direction;
            side = -side;
            below = 1.0 - below;
        }
        direction = direction.normalize();
    }
    (direction, side < 0.0)
}

/// Returns where light goes from a rough metal, and what is left of it; `f0` is the share that a facet reflects head on.
/// `met` hears of each facet: from where light comes to it, the share of the surface below it, and what is left of the light.
pub(super) fn reflect(
    random: &mut Xoshiro256PlusPlus,
    direction: DVec3,
    (normal, alpha, f0): (DVec3, f64, DVec3),
    mut met: impl FnMut(DVec3, f64, DVec3),
) -> (DVec3, DVec3) {
    let (mut direction, mut below, mut left) = (direction, 1.0, DVec3::ONE);
    for _ in 0..MOST_FACETS {
        let Some(next) = step(random.random(), below, masking(normal.dot(direction), alpha)) else { break };
        below = next;
        met(direction, below, left);
        let facet = facet(random, direction, normal, alpha);
        let facing = -facet.dot(direction);
        left *= schlick(f0, facing);
        direction = (direction + 2.0 * facing * facet).normalize();
    }
    (direction, left)
}

/// Returns what a facet of a rough metal at random, which `direction` comes to above a share `below` of the surface, sends
/// out towards a light, per steradian.
pub(super) fn toward(light: DVec3, direction: DVec3, (normal, alpha, f0): (DVec3, f64, DVec3), below: f64) -> DVec3 {
    let (cosine_light, cosine) = (normal.dot(light), -normal.dot(direction));
    let half = (light - direction).normalize_or_zero();
    if cosine_light <= 0.0 || normal.dot(half) <= 0.0 {
        return DVec3::ZERO;
    }
    // The area of all facets, as seen along the direction.
    let area = 0.5 * (cosine + (alpha * alpha * (1.0 - cosine * cosine) + cosine * cosine).sqrt());
    let density = microfacet::distribution(normal, half, alpha);
    let leaves = below.powf(masking(cosine_light, alpha));
    schlick(f0, -half.dot(direction)) * density / (4.0 * area) * leaves
}

/// Returns Schlick's share of light that a metal reflects.
pub(super) fn schlick(f0: DVec3, cosine: f64) -> DVec3 {
    f0 + (DVec3::ONE - f0) * (1.0 - cosine.clamp(0.0, 1.0)).powi(5)
}

/// Returns the normal of a facet that light meets, at random by how much of it light sees.
pub(super) fn facet(random: &mut Xoshiro256PlusPlus, direction: DVec3, normal: DVec3, alpha: f64) -> DVec3 {
    let azimuth = DVec2::from_angle(TAU * random.random::<f64>());
    microfacet::facet(normal, -direction, alpha, random.random(), azimuth)
}

/// Smith's Λ of light on its way out, the mean number of facets that it meets from the lowest point on; of light on its way
/// in, -1 - Λ of the opposite way.
fn masking(cosine: f64, alpha: f64) -> f64 {
    let squared_sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0);
    let stretched = (alpha * alpha * squared_sine + cosine * cosine).sqrt();
    0.5 * (stretched / cosine.abs().max(1e-300) * cosine.signum() - 1.0)
}

/// Returns the share of the surface below the next facet; `None` if light leaves without meeting one.
fn step(random: f64, below: f64, masking: f64) -> Option<f64> {
    let left = 1.0 - random;
    let next = below * left.powf(-masking.recip());
    if masking >= 0.0 && next >= 1.0 { None } else { Some(next.clamp(0.0, 1.0)) }
}

#[cfg(test)]
mod tests;
