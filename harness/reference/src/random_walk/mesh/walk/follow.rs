//! The walk itself, in media of any density and phase function, behind any boundary.
//!
//! Delta tracking keeps one walk for all three channels: tentative collisions are drawn with the
//! chosen channel's majorant. The channels share the density, and so the probability that a
//! collision is real. The balance heuristic weights each flight by what each channel would have
//! done, as in uniform media.
//!
//! At a dielectric boundary, refraction or reflection is chosen at random by the Fresnel
//! reflectance. A straight ray from a collision does not find a light behind such a boundary: the
//! paths with one refraction are computed instead. The environment is found by walks that leave.

use super::refracted::{Facing, Path};
use super::{Beginnings, Coefficients, Matter, Outcome, Ray, SURE, Standstill, Targets, WEAK, channel, weighted};
use crate::spectral::hit::{Hit, Place};
use glam::DVec3;
use lapidary_scene::Density;
use lapidary_scene::view::View;
use rand::RngExt as _;
use rand::rngs::Xoshiro256PlusPlus;

/// Largest number of surfaces met between two collisions; a walk that meets more is trapped.
const MOST_REFLECTIONS: u32 = 10_000;
/// A surface this much nearer than a crossing, as a share of its distance, is in the way.
const NEARER: f64 = 1e-9;
/// A transmittance below this continues with the probability [`GOES_ON`].
const FAINT: f64 = 0.02;
const GOES_ON: f64 = 0.25;

/// Where a ray outside all bodies arrives.
enum Arrival {
    /// Inside a body, at this place on its surface.
    Body(Place),
    Nowhere,
    /// Trapped between surfaces that keep reflecting it.
    Caught,
}

impl Matter<'_> {
    /// Follows a ray from the eye that meets a body at `hit`.
    pub(in crate::random_walk::mesh) fn walk(
        &self,
        ray: Ray,
        hit: Hit,
        beginnings: Beginnings,
        random: &mut Xoshiro256PlusPlus,
    ) -> Outcome {
        let mut radiance = DVec3::ZERO;
        let targets = Targets::Lights(&self.lights);
        let outcome = self.follow(targets, ray, hit, beginnings, random, &mut |_, value| radiance += value);
        Outcome { radiance: radiance + outcome.radiance, ..outcome }
    }

    /// Follows light along a ray that meets a body at `hit`; `deposit` receives a pixel and the
    /// light that the eye sees there.
    pub(in crate::random_walk::mesh) fn walk_of_light(
        &self,
        eye: &View,
        ray: Ray,
        hit: Hit,
        beginnings: Beginnings,
        random: &mut Xoshiro256PlusPlus,
        mut deposit: impl FnMut([u32; 2], DVec3),
    ) -> Outcome {
        self.follow(Targets::Eye(eye), ray, hit, beginnings, random, &mut deposit)
    }

    /// Follows a ray that meets a body at `hit`, and connects each scattering with the targets. A
    /// walk that does not count, by its beginning, ends before its first scattering.
    ///
    /// One walk serves all three channels. At each flight, one channel is chosen in proportion to
    /// its throughput, and its extinction gives the length. Each channel is then weighted by its
    /// own density over the mean density of the choice (the balance heuristic: Chiang, Kutz and
    /// Burley, 2016, "Practical and Controllable Subsurface Scattering for Production Path
    /// Tracing"). So no channel ever has more than the three had together at the start.
    fn follow(
        &self,
        targets: Targets<'_>,
        mut ray: Ray,
        hit: Hit,
        beginnings: Beginnings,
        random: &mut Xoshiro256PlusPlus,
        deposit: &mut impl FnMut([u32; 2], DVec3),
    ) -> Outcome {
        let mut outcome = Outcome::default();
        let mut throughput = DVec3::ONE;
        let mut surfaces = 0;
        let mut arrival = self.arrive(&mut ray, Some(hit), &mut surfaces, random);
        let mut standstill = Standstill::new();
        'bodies: loop {
            let Place { body, face } = match arrival {
                Arrival::Body(place) => place,
                Arrival::Nowhere => {
                    self.leave(ray.direction, throughput, &mut outcome);
                    return outcome;
                }
                Arrival::Caught => break,
            };
            let (mut left, mut reflections) = (Some(face), 0);
            let structure = &self.structures[body];
            let Coefficients { scattering, extinction } = self.coefficients[body];
            let majorant = structure.most * extinction;
            loop {
                let depth = -(1.0 - random.random::<f64>()).ln();
                let chosen = channel(throughput, random.random());
                let free = if majorant[chosen] > 0.0 { depth / majorant[chosen] } else { f64::INFINITY };
                if let Some(out) = self.bodies.leave_body(ray.position, ray.direction, body, left, free) {
                    let transmittance = (-out.distance * majorant).exp();
                    throughput = weighted(throughput, transmittance, transmittance);
                    ray.position += out.distance * ray.direction;
                    surfaces += 1;
                    if standstill.holds(ray.position) {
                        break 'bodies;
                    }
                    if structure.crosses(&mut ray.direction, -out.normal, structure.index().recip(), random) {
                        let next = self.bodies.enter(ray.position, ray.direction, Some(out.place));
                        arrival = self.arrive(&mut ray, next, &mut surfaces, random);
                        continue 'bodies;
                    }
                    left = Some(out.place.face);
                    reflections += 1;
                    if reflections > MOST_REFLECTIONS {
                        break 'bodies;
                    }
                    continue;
                }
                ray.position += free * ray.direction;
                if !self.holds(ray.position) {
                    break 'bodies;
                }
                left = None;
                let transmittance = (-free * majorant).exp();
                // The same for all channels, so that it cancels out of the weights of a real
                // collision.
                let share = structure.share(ray.position);
                if share < 1.0 && random.random::<f64>() >= share {
                    throughput = weighted(throughput, majorant * transmittance, majorant * transmittance);
                    continue;
                }
                if outcome.scatterings == 0 && surfaces == 1 && beginnings == Beginnings::Indirect {
                    return outcome;
                }
                throughput = weighted(throughput, scattering * transmittance, extinction * transmittance);
                let mut connected = |place, value: DVec3| deposit(place, throughput * value);
                if self.connect(targets, ray, body, random, &mut connected).is_none() {
                    break 'bodies;
                }
                outcome.scatterings += 1;
                reflections = 0;
                let strongest = throughput.max_element();
                if strongest < WEAK {
                    if random.random::<f64>() * WEAK >= strongest {
                        return outcome;
                    }
                    throughput *= WEAK / strongest;
                }
                ray.direction = structure.scattered(ray.direction, random);
            }
        }
        outcome.lost = true;
        outcome
    }

    /// Takes a ray outside to the body that it enters, reflected by those that it does not; `next`
    /// is its first hit. Adds to the number of `surfaces` that it meets.
    fn arrive(
        &self,
        ray: &mut Ray,
        mut next: Option<Hit>,
        surfaces: &mut u32,
        random: &mut Xoshiro256PlusPlus,
    ) -> Arrival {
        for _ in 0..MOST_REFLECTIONS {
            let Some(hit) = next else { return Arrival::Nowhere };
            *surfaces += 1;
            ray.position += hit.distance * ray.direction;
            let structure = &self.structures[hit.place.body];
            if structure.crosses(&mut ray.direction, hit.normal, structure.index(), random) {
                return Arrival::Body(hit.place);
            }
            next = self.bodies.enter(ray.position, ray.direction, Some(hit.place));
        }
        Arrival::Caught
    }

    /// Adds the light that arrives along a walk's last direction.
    fn leave(&self, direction: DVec3, throughput: DVec3, outcome: &mut Outcome) {
        if outcome.scatterings == 0 {
            outcome.straight = throughput;
        }
        if let Some(environment) = self.environment {
            outcome.radiance += throughput * environment.radiance(direction);
        }
    }

    /// Deposits the light that the targets send to a point in `body`, or see of it, times the phase
    /// function. Returns `None` if a surface has a gap.
    pub(super) fn connect(
        &self,
        targets: Targets<'_>,
        ray: Ray,
        body: usize,
        random: &mut Xoshiro256PlusPlus,
        deposit: &mut impl FnMut([u32; 2], DVec3),
    ) -> Option<()> {
        if self.refracts() {
            self.connect_refracted(targets, ray, body, random, deposit);
            return Some(());
        }
        let structure = &self.structures[body];
        let least = self.least_extinction(body);
        for target in 0..targets.count() {
            let limit = (SURE - (1.0 - random.random::<f64>()).ln()) / least;
            let Some((found, place)) = targets.at(target, ray.position) else { continue };
            let (direction, distance, irradiance) = (found.direction, found.distance, found.irradiance);
            let out = self.bodies.leave_body(ray.position, direction, body, None, limit.min(distance));
            let way = match out {
                Some(out) => out.distance,
                None if distance < limit => distance,
                None => continue,
            };
            let mut transmittance = self.transmittance(body, Ray { direction, ..ray }, way, random);
            if let Some(out) = out {
                let position = ray.position + way * direction;
                self.beyond(position, direction, out, distance - way, |body, position, length| {
                    transmittance *= self.transmittance(body, Ray { position, direction }, length, random);
                })?;
            }
            let gain = (least * way - SURE).max(0.0).exp();
            deposit(place, irradiance * gain * transmittance * structure.phase(ray.direction.dot(direction)));
        }
        Some(())
    }

    /// The least extinction of a channel anywhere in a body: the rate at which paths to the targets
    /// end at random. Any rate gives the right mean; at this one, no gain outgrows the attenuation on
    /// the way.
    fn least_extinction(&self, body: usize) -> f64 {
        self.coefficients[body].extinction.min_element() * self.structures[body].least
    }

    /// The same as [`connect`](Self::connect) behind a dielectric boundary: by all paths that are
    /// refracted once, at the surface of `body`, and meet no other surface.
    fn connect_refracted(
        &self,
        targets: Targets<'_>,
        ray: Ray,
        body: usize,
        random: &mut Xoshiro256PlusPlus,
        deposit: &mut impl FnMut([u32; 2], DVec3),
    ) {
        let structure = &self.structures[body];
        let least = self.least_extinction(body);
        for target in 0..targets.count() {
            let limit = (SURE - (1.0 - random.random::<f64>()).ln()) / least;
            self.facing(targets, target, body).visit(ray.position, limit, |path| {
                let Path { distance, direction, crossing, face, gain } = path;
                let Some((found, place)) = targets.at(target, crossing) else { return };
                let end = distance * (1.0 + NEARER);
                let before = self.bodies.leave_body(ray.position, direction, body, None, end);
                if before.is_some_and(|hit| hit.place.face != face && hit.distance < distance * (1.0 - NEARER)) {
                    return;
                }
                let outside = self.bodies.enter(crossing, found.direction, Some(Place { body, face }));
                if outside.is_some_and(|hit| hit.distance < found.distance) {
                    return;
                }
                let transmittance = self.transmittance(body, Ray { direction, ..ray }, distance, random);
                let gain = gain * (least * distance - SURE).max(0.0).exp();
                deposit(place, found.irradiance * gain * transmittance * structure.phase(ray.direction.dot(direction)));
            });
        }
    }

    /// The surface of a body that faces a target.
    fn facing(&self, targets: Targets<'_>, target: usize, body: usize) -> &Facing {
        match targets {
            Targets::Lights(_) => &self.facing_lights[target][body],
            Targets::Eye(_) => &self.facing_eye[body],
        }
    }

    /// Estimates the share of light left after a path inside a body, by ratio tracking; exact in
    /// uniform media.
    fn transmittance(&self, body: usize, ray: Ray, length: f64, random: &mut Xoshiro256PlusPlus) -> DVec3 {
        let structure = &self.structures[body];
        let majorant = structure.most * self.coefficients[body].extinction;
        if structure.density == Density::Uniform {
            return (-length * majorant).exp();
        }
        let rate = majorant.max_element();
        if rate == 0.0 {
            return DVec3::ONE;
        }
        let mut transmittance = DVec3::ONE;
        let mut gone = 0.0;
        loop {
            gone -= (1.0 - random.random::<f64>()).ln() / rate;
            if gone >= length {
                return transmittance;
            }
            transmittance *= 1.0 - majorant * (structure.share(ray.position + gone * ray.direction) / rate);
            if transmittance.max_element() < FAINT {
                if random.random::<f64>() >= GOES_ON {
                    return DVec3::ZERO;
                }
                transmittance /= GOES_ON;
            }
        }
    }
}

#[cfg(test)]
mod tests;
