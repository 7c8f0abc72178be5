//! A ray of one wavelength, split at every surface that it meets.

use super::geometry::{Bodies, Hit, Place};
use glam::DVec3;
use lapidary_fresnel::oracle as fresnel;
use lapidary_refraction::oracle as refraction;
use lapidary_scene::Environment;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Surfaces that the rays of one sample and wavelength meet at most, all together. Total reflection takes no energy, so
/// a ray may be caught for long; what is caught for longer counts as lost.
const MOST_HITS: u32 = 20_000;

/// A body at one wavelength.
#[derive(Clone, Copy, Debug)]
pub(super) struct Optics {
    /// Refractive index relative to the air outside.
    pub(super) index: f64,
    /// The coefficient of Beer and Lambert's law, per unit of distance, for each channel of linear RGB.
    pub(super) absorption: DVec3,
    /// What light is multiplied by where it enters, linear RGB.
    pub(super) base_color: DVec3,
}

/// What light meets, whatever its wavelength.
pub(super) struct Surroundings<'scene> {
    pub(super) bodies: Bodies,
    pub(super) environment: &'scene Environment,
    /// What may be left unfollowed of the energy of a ray from the camera.
    pub(super) energy_bound: f64,
}

/// What a ray from the camera brings at one wavelength.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Outcome {
    /// Linear RGB: each channel as if its light alone were of this wavelength.
    pub(super) radiance: DVec3,
    /// The share of the ray's energy that was not followed to its end.
    pub(super) lost: f64,
}

/// A ray from the camera up to its first surface: what does not depend on the wavelength.
pub(super) struct Primary {
    arrival: Arrival,
    /// The surface's reflection.
    reflected: DVec3,
    /// What it shows where it meets nothing.
    reflected_radiance: Option<DVec3>,
}

/// A ray at a surface.
#[derive(Clone, Copy)]
struct Arrival {
    point: DVec3,
    direction: DVec3,
    /// Unit normal that faces the ray.
    normal: DVec3,
    place: Place,
    inside: bool,
    throughput: DVec3,
}

/// A ray that sets out from a surface.
struct Ray {
    origin: DVec3,
    direction: DVec3,
    left: Place,
    inside: bool,
    /// What its radiance is multiplied by to be the camera's.
    throughput: DVec3,
}

impl Ray {
    fn energy(&self) -> f64 {
        self.throughput.max_element()
    }
}

// By energy: the heap gives the strongest ray first.
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
    /// The first surface that a ray from the camera meets.
    pub(super) fn primary(&self, eye: DVec3, direction: DVec3) -> Option<Primary> {
        let hit = self.bodies.enter(eye, direction, None)?;
        let arrival = Arrival::new(eye, direction, hit, false, DVec3::ONE);
        let reflected = reflect(direction, arrival.normal);
        let free = self.bodies.enter(arrival.point, reflected, Some(hit.place)).is_none();
        let reflected_radiance = free.then(|| self.environment.radiance(reflected));
        Some(Primary { arrival, reflected, reflected_radiance })
    }

    /// Follows `primary` at one wavelength, at which the bodies have these `optics`: the strongest ray first, until all
    /// that are left have less energy together than the bound.
    pub(super) fn follow(&self, primary: &Primary, optics: &[Optics]) -> Outcome {
        let mut outcome = Outcome::default();
        let mut waiting = BinaryHeap::with_capacity(16);
        let (reflectance, transmitted) = primary.arrival.split(optics);
        match primary.reflected_radiance {
            Some(radiance) => outcome.radiance += reflectance * radiance,
            None => waiting.push(primary.arrival.leave(primary.reflected, false, DVec3::splat(reflectance))),
        }
        waiting.extend(transmitted);
        let mut pending: f64 = waiting.iter().map(Ray::energy).sum();
        // The strongest, where it is known without asking the heap: most often a ray under total reflection.
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

    /// The next surface on the ray's way. Without one, outside, the environment is added to `outcome`; inside, the
    /// surface has a gap, and the ray is lost.
    fn travel(&self, ray: &Ray, optics: &[Optics], outcome: &mut Outcome) -> Option<Arrival> {
        if ray.inside {
            let Some(hit) = self.bodies.leave(ray.origin, ray.direction, ray.left) else {
                outcome.lost += ray.energy();
                return None;
            };
            let transmittance = (-hit.distance * optics[ray.left.body].absorption).exp();
            return Some(Arrival::new(ray.origin, ray.direction, hit, true, ray.throughput * transmittance));
        }
        let hit = self.bodies.enter(ray.origin, ray.direction, Some(ray.left));
        if hit.is_none() {
            outcome.radiance += ray.throughput * self.environment.radiance(ray.direction);
        }
        hit.map(|hit| Arrival::new(ray.origin, ray.direction, hit, false, ray.throughput))
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

    /// The surface's reflectance, and the ray that it lets through, if any.
    fn split(&self, optics: &[Optics]) -> (f64, Option<Ray>) {
        let Optics { index, base_color, .. } = optics[self.place.body];
        let (relative_index, color) = if self.inside { (1.0 / index, DVec3::ONE) } else { (index, base_color) };
        let cosine = -self.normal.dot(self.direction);
        // Spares the oracle what is far beyond the critical angle; it decides near it.
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

/// The law of reflection by vectors. The oracle's form by angles gives the same to the last digits, and would take a
/// quarter of the time that a picture takes: most hits are reflections.
fn reflect(incident: DVec3, normal: DVec3) -> DVec3 {
    incident - 2.0 * normal.dot(incident) * normal
}

#[cfg(test)]
mod tests;
