//! Tracing of rays of one wavelength, split at every surface that they meet.

use super::geometry::Bodies;
use super::hit::{Hit, Place};
use glam::DVec3;
use lapidary_fresnel::oracle as fresnel;
use lapidary_refraction::oracle as refraction;
use lapidary_scene::Environment;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Largest number of surface hits for one sample and wavelength, over all its rays. Total
/// reflection takes no energy, so a ray may be trapped for a long time; its energy then counts as
/// lost.
const MOST_HITS: u32 = 20_000;

/// Optical properties of a body at one wavelength.
#[derive(Clone, Copy, Debug)]
pub(super) struct Optics {
    /// Refractive index relative to the air outside.
    pub(super) index: f64,
    /// Absorption coefficient of the Beer-Lambert law per unit of distance, for each channel of
    /// linear RGB.
    pub(super) absorption: DVec3,
    /// Factor applied to light on entry, linear RGB.
    pub(super) base_color: DVec3,
}

/// The surroundings of a ray, whatever its wavelength.
pub(super) struct Surroundings<'scene> {
    pub(super) bodies: Bodies,
    pub(super) environment: &'scene Environment,
    /// Share of a camera ray's energy that may be dropped.
    pub(super) energy_bound: f64,
}

/// Result of a camera ray at one wavelength.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Outcome {
    /// Linear RGB radiance; each channel is computed as if all its light were of this wavelength.
    pub(super) radiance: DVec3,
    /// Share of the ray's energy that was not followed to its end.
    pub(super) lost: f64,
}

/// A camera ray up to its first surface, which does not depend on the wavelength.
pub(super) enum Primary {
    /// The ray meets a clear body.
    Clear(Entry),
    /// The ray meets a matte body, which sends this radiance.
    Matte(DVec3),
}

/// A camera ray at the surface of a clear body.
pub(super) struct Entry {
    arrival: Arrival,
    /// Direction of the reflection at the surface.
    reflected: DVec3,
    /// Radiance of the matte body or of the environment that the reflection meets; `None` if it
    /// meets a clear body.
    reflected_radiance: Option<DVec3>,
}

/// What a ray outside meets first.
enum Ahead {
    /// A clear body.
    Clear(Hit),
    /// A matte body or the environment, which sends this radiance.
    Light(DVec3),
}

/// A ray that arrives at a surface.
#[derive(Clone, Copy)]
struct Arrival {
    point: DVec3,
    direction: DVec3,
    /// Unit normal, facing the ray.
    normal: DVec3,
    place: Place,
    inside: bool,
    throughput: DVec3,
}

/// A ray that leaves a surface.
struct Ray {
    origin: DVec3,
    direction: DVec3,
    left: Place,
    inside: bool,
    /// Factor from the ray's radiance to its contribution to the camera ray.
    throughput: DVec3,
}

impl Ray {
    fn energy(&self) -> f64 {
        self.throughput.max_element()
    }
}

// Ordered by energy, so that the heap yields the strongest ray first.
impl Ord for Ray {
    fn cmp(&self, other: &Self) -> Ordering {
        self.energy().total_cmp(&other.energy())
    }
}

impl PartialOrd for Ray {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Ray {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Ray {}

impl Surroundings<'_> {
    /// Finds the first surface that a camera ray meets, of whatever body; `None` if it meets none.
    pub(super) fn primary(&self, eye: DVec3, direction: DVec3) -> Option<Primary> {
        let hit = self.bodies.enter(eye, direction, None)?;
        let arrival = Arrival::new(eye, direction, hit, false, DVec3::ONE);
        if let Some(radiance) = self.bodies.sent(&hit, arrival.point) {
            return Some(Primary::Matte(radiance));
        }
        let reflected = reflect(direction, arrival.normal);
        let reflected_radiance = match self.ahead(arrival.point, reflected, hit.place) {
            Ahead::Clear(_) => None,
            Ahead::Light(radiance) => Some(radiance),
        };
        Some(Primary::Clear(Entry { arrival, reflected, reflected_radiance }))
    }

    /// Finds what a ray outside meets that starts from `left`.
    fn ahead(&self, origin: DVec3, direction: DVec3, left: Place) -> Ahead {
        let Some(hit) = self.bodies.enter(origin, direction, Some(left)) else {
            return Ahead::Light(self.environment.radiance(direction));
        };
        self.bodies.sent(&hit, origin + hit.distance * direction).map_or(Ahead::Clear(hit), Ahead::Light)
    }

    /// Follows `primary` at one wavelength with the bodies' `optics` at that wavelength. The
    /// strongest ray comes first, until all remaining rays together have less energy than the
    /// bound.
    pub(super) fn follow(&self, primary: &Primary, optics: &[Optics]) -> Outcome {
        let Entry { arrival, reflected, reflected_radiance } = match primary {
            Primary::Clear(entry) => entry,
            Primary::Matte(radiance) => return Outcome { radiance: *radiance, lost: 0.0 },
        };
        let mut outcome = Outcome::default();
        let mut waiting = BinaryHeap::with_capacity(16);
        let (reflectance, transmitted) = arrival.split(optics);
        match reflected_radiance {
            Some(radiance) => outcome.radiance += reflectance * *radiance,
            None => waiting.push(arrival.leave(*reflected, false, DVec3::splat(reflectance))),
        }
        waiting.extend(transmitted);
        let mut pending: f64 = waiting.iter().map(Ray::energy).sum();
        // The strongest ray, if known without asking the heap: usually one under total reflection.
        let mut strongest: Option<Ray> = None;
        let mut hits = 1;
        while pending >= self.energy_bound
            && hits < MOST_HITS
            && let Some(ray) = strongest.take().or_else(|| waiting.pop())
        {
            pending -= ray.energy();
            let Some(arrival) = self.travel(&ray, optics, &mut outcome) else { continue };
            hits += 1;
            let (reflectance, transmitted) = arrival.split(optics);
            if let Some(ray) = transmitted {
                pending += ray.energy();
                waiting.push(ray);
            }
            if reflectance > 0.0 {
                let direction = reflect(arrival.direction, arrival.normal);
                let ray = arrival.leave(direction, arrival.inside, arrival.throughput * reflectance);
                pending += ray.energy();
                match waiting.peek() {
                    Some(other) if *other > ray => waiting.push(ray),
                    _ => strongest = Some(ray),
                }
            }
        }
        outcome.lost += waiting.iter().chain(&strongest).map(Ray::energy).sum::<f64>();
        outcome
    }

    /// Finds the next surface of a clear body along the ray. If there is none outside, the light of
    /// the matte body or of the environment ahead is added to `outcome`; if there is none inside,
    /// the surface has a gap and the ray is lost.
    fn travel(&self, ray: &Ray, optics: &[Optics], outcome: &mut Outcome) -> Option<Arrival> {
        if ray.inside {
            let Some(hit) = self.bodies.leave(ray.origin, ray.direction, ray.left) else {
                outcome.lost += ray.energy();
                return None;
            };
            let transmittance = (-hit.distance * optics[ray.left.body].absorption).exp();
            return Some(Arrival::new(ray.origin, ray.direction, hit, true, ray.throughput * transmittance));
        }
        match self.ahead(ray.origin, ray.direction, ray.left) {
            Ahead::Clear(hit) => Some(Arrival::new(ray.origin, ray.direction, hit, false, ray.throughput)),
            Ahead::Light(radiance) => {
                outcome.radiance += ray.throughput * radiance;
                None
            }
        }
    }
}

impl Arrival {
    fn new(origin: DVec3, direction: DVec3, hit: Hit, inside: bool, throughput: DVec3) -> Self {
        let normal = if inside { -hit.normal } else { hit.normal };
        Self { point: origin + hit.distance * direction, direction, normal, place: hit.place, inside, throughput }
    }

    fn leave(&self, direction: DVec3, inside: bool, throughput: DVec3) -> Ray {
        Ray { origin: self.point, direction, left: self.place, inside, throughput }
    }

    /// Returns the surface's reflectance and the transmitted ray; `None` under total reflection.
    fn split(&self, optics: &[Optics]) -> (f64, Option<Ray>) {
        let Optics { index, base_color, .. } = optics[self.place.body];
        let (relative_index, color) = if self.inside { (1.0 / index, DVec3::ONE) } else { (index, base_color) };
        let cosine = -self.normal.dot(self.direction);
        // Skips the oracle well beyond the critical angle; near it, the oracle decides.
        let squared_sine = (1.0 - cosine) * (1.0 + cosine);
        if squared_sine > 1.000_001 * relative_index * relative_index {
            return (1.0, None);
        }
        let refracted = refraction::refract(self.direction, self.normal, relative_index);
        if refracted.total {
            return (1.0, None);
        }
        let reflectance = fresnel::dielectric(cosine, relative_index);
        let throughput = self.throughput * color * (1.0 - reflectance);
        (reflectance, Some(self.leave(refracted.direction, !self.inside, throughput)))
    }
}

/// Reflects by the vector form of the law of reflection. The oracle's angle form gives the same
/// result to the last digits, but would take a quarter of an image's render time: most hits are
/// reflections.
fn reflect(incident: DVec3, normal: DVec3) -> DVec3 {
    incident - 2.0 * normal.dot(incident) * normal
}

#[cfg(test)]
mod tests;
