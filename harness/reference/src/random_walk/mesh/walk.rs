//! One walk through bodies of scattering matter: backwards from the eye, or from a light, as light goes. Matter does not know the difference, but for what
//! each scattering is connected with.

mod general;

use super::super::isotropic;
use super::Boundary;
use crate::spectral::geometry::{Bodies, Geometry, Hit, Place};
use general::Structure;
use glam::DVec3;
use lapidary_scene::light::Arrival;
use lapidary_scene::view::{Sight, View};
use lapidary_scene::{Environment, Light, Medium, Object, Scene};
use rand::RngExt as _;
use rand::rngs::Xoshiro256PlusPlus;
use std::f64::consts::PI;

/// A walk whose strongest channel has less left than this goes on with the probability that makes up for it. This and the next were
/// chosen for the least product of time and variance in a picture of a bunny of skin.
const WEAK: f64 = 0.5;
/// The optical depth, in the channel that has least, up to which the way out to a light is always looked for.
const SURE: f64 = 0.7;

/// Bodies of scattering matter, and the lights about them.
pub(super) struct Matter<'scene> {
    bodies: Bodies,
    /// Each body's.
    coefficients: Vec<Coefficients>,
    structures: Vec<Structure>,
    boundary: Boundary,
    lights: Vec<Light>,
    environment: Option<&'scene Environment>,
    /// About all bodies: a walk that is outside has slipped through a surface.
    least: DVec3,
    greatest: DVec3,
}

/// Per unit of length, for red, green and blue.
#[derive(Clone, Copy, Debug)]
struct Coefficients {
    scattering: DVec3,
    extinction: DVec3,
}

impl From<&Medium> for Coefficients {
    fn from(medium: &Medium) -> Self {
        let scattering = medium.scattering.as_dvec3();
        Self { scattering, extinction: scattering + medium.absorption.as_dvec3() }
    }
}

/// What each scattering is connected with.
#[derive(Clone, Copy)]
pub(super) enum Targets<'a> {
    /// The lights, by a walk from the eye.
    Lights(&'a [Light]),
    /// The eye, by a walk from a light.
    Eye(&'a View),
}

impl Targets<'_> {
    fn count(self) -> usize {
        match self {
            Self::Lights(lights) => lights.len(),
            Self::Eye(_) => 1,
        }
    }

    /// What a point receives from a light, or the radiance that the eye sees of a point that shines with intensity 1, and in which pixel.
    fn at(self, number: usize, position: DVec3) -> Option<(Arrival, [u32; 2])> {
        match self {
            // Outside of a spot's cone there is none.
            Self::Lights(lights) => Some((lights[number].arrival(position), [0; 2]))
                .filter(|(arrival, _)| arrival.irradiance != DVec3::ZERO),
            Self::Eye(view) => view.sight(position).map(|Sight { x, y, toward, distance, weight }| {
                let arrival = Arrival { direction: toward, distance, irradiance: DVec3::splat(weight) };
                (arrival, [x as u32, y as u32])
            }),
        }
    }
}

/// What a walk brought.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Outcome {
    /// Linear RGB, of light that was scattered at least once, by a walk from the eye.
    pub(super) radiance: DVec3,
    /// What is left of a walk that nothing scattered: the mean is the share of what lies behind that shows through.
    pub(super) straight: DVec3,
    pub(super) scatterings: u32,
    /// It slipped through a surface; what it had brought until then counts.
    pub(super) lost: bool,
}

impl<'scene> Matter<'scene> {
    /// Nothing where an object has no medium: that object's number.
    pub(super) fn new(
        scene: &Scene,
        boundary: Boundary,
        environment: Option<&'scene Environment>,
    ) -> Result<Self, usize> {
        let objects = || scene.objects.iter().enumerate();
        let medium =
            |(number, object): (usize, &Object)| object.material.medium.as_ref().map(Coefficients::from).ok_or(number);
        let coefficients = objects().map(medium).collect::<Result<_, _>>()?;
        let structure = |(number, object): (usize, &Object)| Structure::new(object, boundary).ok_or(number);
        let structures = objects().map(structure).collect::<Result<_, _>>()?;
        let bounds = scene.bounds();
        let margin = 1e-6 * f64::from(bounds.radius());
        Ok(Self {
            bodies: Bodies::new(&scene.objects, Geometry::Triangles),
            coefficients,
            structures,
            boundary,
            lights: scene.lights.clone(),
            environment,
            least: bounds.min.as_dvec3() - margin,
            greatest: bounds.max.as_dvec3() + margin,
        })
    }

    /// Where a ray from outside enters a body first.
    pub(super) fn enter(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        self.bodies.enter(origin, direction, None)
    }

    /// Follows a ray from the eye that meets a body at `hit`.
    pub(super) fn walk(&self, ray: Ray, hit: Hit, random: &mut Xoshiro256PlusPlus) -> Outcome {
        let mut radiance = DVec3::ZERO;
        let outcome = self.follow(Targets::Lights(&self.lights), ray, hit, random, &mut |_, value| radiance += value);
        Outcome { radiance: radiance + outcome.radiance, ..outcome }
    }

    /// Follows light along a ray that meets a body at `hit`; `deposit` gets what the eye sees of it and in which pixel.
    pub(super) fn walk_of_light(
        &self,
        eye: &View,
        ray: Ray,
        hit: Hit,
        random: &mut Xoshiro256PlusPlus,
        mut deposit: impl FnMut([u32; 2], DVec3),
    ) -> Outcome {
        self.follow(Targets::Eye(eye), ray, hit, random, &mut deposit)
    }

    fn follow(
        &self,
        targets: Targets<'_>,
        ray: Ray,
        hit: Hit,
        random: &mut Xoshiro256PlusPlus,
        deposit: &mut impl FnMut([u32; 2], DVec3),
    ) -> Outcome {
        if self.structures.iter().all(Structure::is_plain) {
            self.follow_plain(targets, ray, hit, random, deposit)
        } else {
            self.follow_general(targets, ray, hit, random, deposit)
        }
    }

    /// Whether a point lies within the bounds of all bodies. Written so that NaN and infinity do not.
    fn holds(&self, position: DVec3) -> bool {
        position.cmpge(self.least).all() && position.cmple(self.greatest).all()
    }

    /// The walk in matter of one density that scatters to all sides alike, whose surface lets all light pass.
    ///
    /// One walk serves all three channels. At each flight one of them is chosen by what is left of it and its extinction gives the
    /// length; each is then weighted by what it would have done over what the choice does in the mean (the balance heuristic, as
    /// Chiang, Kutz and Burley, "Practical and Controllable Subsurface Scattering for Production Path Tracing", 2016, have it). So no channel
    /// ever has more than the three began with together.
    fn follow_plain(
        &self,
        targets: Targets<'_>,
        ray: Ray,
        hit: Hit,
        random: &mut Xoshiro256PlusPlus,
        deposit: &mut impl FnMut([u32; 2], DVec3),
    ) -> Outcome {
        let mut outcome = Outcome::default();
        let mut throughput = DVec3::ONE;
        let Ray { mut position, mut direction } = ray;
        position += hit.distance * direction;
        let (mut body, mut left) = (hit.place.body, Some(hit.place.face));
        loop {
            let Coefficients { scattering, extinction } = self.coefficients[body];
            // 1 - [0, 1) is never 0; where nothing is extinguished, the way is without end.
            let depth = -(1.0 - random.random::<f64>()).ln();
            let chosen = channel(throughput, random.random());
            let free = if extinction[chosen] > 0.0 { depth / extinction[chosen] } else { f64::INFINITY };
            if let Some(out) = self.bodies.leave_body(position, direction, body, left, free) {
                let transmittance = (-out.distance * extinction).exp();
                throughput = weighted(throughput, transmittance, transmittance);
                position += out.distance * direction;
                if let Some(next) = self.bodies.enter(position, direction, Some(out.place)) {
                    position += next.distance * direction;
                    (body, left) = (next.place.body, Some(next.place.face));
                    continue;
                }
                match self.environment {
                    _ if outcome.scatterings == 0 => outcome.straight = throughput,
                    Some(environment) => {
                        outcome.radiance += throughput * environment.radiance(direction);
                    }
                    None => {}
                }
                return outcome;
            }
            position += free * direction;
            let transmittance = (-free * extinction).exp();
            throughput = weighted(throughput, scattering * transmittance, extinction * transmittance);
            let mut connected = |place, value: DVec3| deposit(place, throughput * value);
            if !self.holds(position) || self.connect(targets, position, body, random, &mut connected).is_none() {
                outcome.lost = true;
                return outcome;
            }
            outcome.scatterings += 1;
            let strongest = throughput.max_element();
            if strongest < WEAK {
                if random.random::<f64>() * WEAK >= strongest {
                    return outcome;
                }
                throughput *= WEAK / strongest;
            }
            direction = isotropic(random);
            left = None;
        }
    }

    /// What the targets send to a point in `body`, or see of it, times the phase function; nothing where a surface has a gap.
    fn connect(
        &self,
        targets: Targets<'_>,
        position: DVec3,
        body: usize,
        random: &mut Xoshiro256PlusPlus,
        deposit: &mut impl FnMut([u32; 2], DVec3),
    ) -> Option<()> {
        let extinction = self.coefficients[body].extinction;
        let least = extinction.min_element();
        for target in 0..targets.count() {
            // A longer way is looked for with the probability that makes up for its gain below: most of a search's time goes
            // into ways that bring next to nothing.
            let limit = (SURE - (1.0 - random.random::<f64>()).ln()) / least;
            let Some((Arrival { direction, distance, irradiance }, place)) = targets.at(target, position) else {
                continue;
            };
            let out = self.bodies.leave_body(position, direction, body, None, limit.min(distance));
            let (way, beyond) = match out {
                Some(out) => {
                    let beyond =
                        self.depth(position + out.distance * direction, direction, out, distance - out.distance)?;
                    (out.distance, beyond)
                }
                // A light inside the body.
                None if distance < limit => (distance, DVec3::ZERO),
                None => continue,
            };
            let gain = (least * way - SURE).max(0.0).exp();
            deposit(place, irradiance * (gain / (4.0 * PI)) * (-way * extinction - beyond).exp());
        }
        Some(())
    }

    /// The optical depth of all matter on the way of a ray that leaves a body at `out`, as far as `distance`; nothing where a surface
    /// has a gap.
    fn depth(&self, position: DVec3, direction: DVec3, out: Hit, distance: f64) -> Option<DVec3> {
        let mut depth = DVec3::ZERO;
        self.beyond(position, direction, out, distance, |body, _, length| {
            depth += length * self.coefficients[body].extinction;
        })?;
        Some(depth)
    }

    /// Names each body on the way of a ray that leaves one at `out`, as far as `distance`, with the place where the ray enters it and the length of
    /// its way inside; nothing where a surface has a gap.
    fn beyond(
        &self,
        mut position: DVec3,
        direction: DVec3,
        mut out: Hit,
        mut distance: f64,
        mut pass: impl FnMut(usize, DVec3, f64),
    ) -> Option<()> {
        while let Some(next) =
            self.bodies.enter(position, direction, Some(out.place)).filter(|next| next.distance < distance)
        {
            position += next.distance * direction;
            distance -= next.distance;
            let Place { body, face } = next.place;
            out = self.bodies.leave_body(position, direction, body, Some(face), f64::INFINITY)?;
            pass(body, position, out.distance.min(distance));
            position += out.distance * direction;
            distance -= out.distance;
        }
        Some(())
    }
}

/// A ray: a place and a unit direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub(super) position: DVec3,
    pub(super) direction: DVec3,
}

/// A channel, each as likely as its share, from a number in [0, 1).
fn channel(throughput: DVec3, number: f64) -> usize {
    let place = number * throughput.element_sum();
    if place < throughput.x {
        0
    } else if place < throughput.x + throughput.y {
        1
    } else {
        2
    }
}

/// What is left after a step that has these `values` in each channel, and these densities where the channel alone is followed: the step
/// was drawn with their mean, weighted by throughput.
fn weighted(throughput: DVec3, values: DVec3, densities: DVec3) -> DVec3 {
    throughput * values * (throughput.element_sum() / throughput.dot(densities))
}

#[cfg(test)]
mod tests;
