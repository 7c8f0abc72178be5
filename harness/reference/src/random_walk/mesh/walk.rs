//! One walk through scattering bodies: backwards from the eye, or forwards from a light.
//!
//! The two differ only in the targets with which each scattering is connected.

mod follow;
mod refracted;
mod structure;

use super::boundary::Boundary;
use crate::spectral::geometry::{Bodies, Geometry};
use crate::spectral::hit::{Hit, Place};
use glam::DVec3;
use lapidary_scene::light::Arrival;
use lapidary_scene::view::{Sight, View};
use lapidary_scene::{Environment, Light, Medium, Object, Scene};
use refracted::{Facing, Source};
use structure::Structure;

/// A walk whose strongest channel has less left than this continues with the probability that
/// compensates for its gain. This constant and the next were chosen for the least product of time
/// and variance in an image of a skin bunny.
const WEAK: f64 = 0.5;
/// Optical depth, in the channel with the least, up to which the way out to a light is always
/// searched.
const SURE: f64 = 0.7;

/// Scattering bodies and the lights around them.
pub(super) struct Matter<'scene> {
    bodies: Bodies,
    /// Coefficients of each body.
    coefficients: Vec<Coefficients>,
    structures: Vec<Structure>,
    boundary: Boundary,
    lights: Vec<Light>,
    /// For each light, the surface of each body that faces it; empty if boundaries are matched.
    facing_lights: Vec<Vec<Facing>>,
    /// The same for the eye.
    facing_eye: Vec<Facing>,
    environment: Option<&'scene Environment>,
    /// Bounds of all bodies: a walk outside them has slipped through a surface.
    least: DVec3,
    greatest: DVec3,
}

/// Coefficients per unit of length, for red, green and blue.
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

/// Targets with which each scattering is connected.
#[derive(Clone, Copy)]
pub(super) enum Targets<'a> {
    /// The lights, for a walk from the eye.
    Lights(&'a [Light]),
    /// The eye, for a walk from a light.
    Eye(&'a View),
}

impl Targets<'_> {
    fn count(self) -> usize {
        match self {
            Self::Lights(lights) => lights.len(),
            Self::Eye(_) => 1,
        }
    }

    /// Returns the light that a point receives from a light, or the radiance and pixel in which the
    /// eye sees a point of intensity 1. `None` outside a spot's cone or the eye's view.
    fn at(self, number: usize, position: DVec3) -> Option<(Arrival, [u32; 2])> {
        match self {
            // There is no light outside a spot's cone.
            Self::Lights(lights) => Some((lights[number].arrival(position), [0; 2]))
                .filter(|(arrival, _)| arrival.irradiance != DVec3::ZERO),
            Self::Eye(view) => view.sight(position).map(|Sight { x, y, toward, distance, weight }| {
                let arrival = Arrival { direction: toward, distance, irradiance: DVec3::splat(weight) };
                (arrival, [x as u32, y as u32])
            }),
        }
    }
}

/// Which walks count, by the surfaces that they meet before they are scattered for the first time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Beginnings {
    /// All walks.
    All,
    /// Only walks that meet more than one surface: those that a connection with the place where
    /// they start would miss.
    Indirect,
}

/// Result of a walk.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Outcome {
    /// Linear RGB radiance, for a walk from the eye: of lights that was scattered at least once, and of the environment.
    pub(super) radiance: DVec3,
    /// Throughput of a walk that was never scattered; its mean is the share of what is behind that
    /// shows through.
    pub(super) straight: DVec3,
    pub(super) scatterings: u32,
    /// Whether the walk slipped through a surface; its contributions until then count.
    pub(super) lost: bool,
}

impl<'scene> Matter<'scene> {
    /// Returns the number of the first object without a medium as the error.
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
        let structures = objects().map(structure).collect::<Result<Vec<_>, _>>()?;
        // Bodies with the index of their surroundings have no boundary, whatever was asked for.
        let boundary = if structures.iter().all(Structure::is_matched) { Boundary::Matched } else { boundary };
        let bounds = scene.bounds();
        let margin = 1e-6 * f64::from(bounds.radius());
        let bodies = Bodies::new(&scene.objects, Geometry::Triangles);
        let (mut facing_lights, mut facing_eye) = (Vec::new(), Vec::new());
        if boundary == Boundary::Dielectric {
            let facing = |source: Source| {
                let body =
                    |(body, structure): (usize, &Structure)| Facing::new(&bodies, body, source, structure.index());
                structures.iter().enumerate().map(body).collect()
            };
            let source = |light: &Light| match light {
                Light::Directional { toward, .. } => Source::Far(toward.as_dvec3().normalize()),
                Light::Point { position, .. } | Light::Spot { position, .. } => Source::At(position.as_dvec3()),
            };
            facing_lights = scene.lights.iter().map(|light| facing(source(light))).collect();
            facing_eye = facing(Source::At(scene.camera.eye.as_dvec3()));
        }
        Ok(Self {
            bodies,
            coefficients,
            structures,
            boundary,
            lights: scene.lights.clone(),
            facing_lights,
            facing_eye,
            environment,
            least: bounds.min.as_dvec3() - margin,
            greatest: bounds.max.as_dvec3() + margin,
        })
    }

    /// Finds where a ray from outside first enters a body.
    pub(super) fn enter(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        self.bodies.enter(origin, direction, None)
    }

    /// Whether light is refracted at a surface.
    pub(super) fn refracts(&self) -> bool {
        self.boundary == Boundary::Dielectric
    }

    /// Whether a point lies inside a body.
    pub(super) fn contains(&self, point: DVec3) -> bool {
        let front = self.bodies.enter(point, DVec3::Z, None).map_or(f64::INFINITY, |hit| hit.distance);
        let leaves = |body: usize| self.bodies.leave_body(point, DVec3::Z, body, None, f64::INFINITY);
        // Bodies do not overlap: a ray from inside leaves before it enters.
        (0..self.coefficients.len()).any(|body| leaves(body).is_some_and(|hit| hit.distance < front))
    }

    /// Whether a point lies within the bounds of all bodies. Written so that it is false for NaN
    /// and infinity.
    fn holds(&self, position: DVec3) -> bool {
        position.cmpge(self.least).all() && position.cmple(self.greatest).all()
    }

    /// Calls `pass` for each body along a ray that leaves one at `out`, as far as `distance`, with
    /// the position where the ray enters the body and the path length inside. Returns `None` if a
    /// surface has a gap or crosses itself.
    fn beyond(
        &self,
        mut position: DVec3,
        direction: DVec3,
        mut out: Hit,
        mut distance: f64,
        mut pass: impl FnMut(usize, DVec3, f64),
    ) -> Option<()> {
        let mut standstill = Standstill::new();
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
            if standstill.holds(position) {
                return None;
            }
        }
        Some(())
    }
}

/// Surfaces that a ray may meet at one place. Where a scan folds there are a few; more are two faces that cross, of which
/// each leads to the other for ever.
const MOST_AT_ONE_PLACE: u32 = 16;

/// Where a ray met surfaces last, and how many there.
#[derive(Debug)]
struct Standstill {
    position: DVec3,
    met: u32,
}

impl Standstill {
    fn new() -> Self {
        Self { position: DVec3::NAN, met: 0 }
    }

    /// Notes that the ray meets a surface. Returns whether it has not come off this place for too long.
    fn holds(&mut self, position: DVec3) -> bool {
        self.met = if position == self.position { self.met + 1 } else { 0 };
        self.position = position;
        self.met > MOST_AT_ONE_PLACE
    }
}

/// A ray: a position and a unit direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub(super) position: DVec3,
    pub(super) direction: DVec3,
}

/// Picks a channel with its share of the throughput as the probability, from a `number` in [0, 1).
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

/// Returns the throughput after a step with these `values` and probability `densities` in each
/// channel. The step was drawn from the mean of the densities, weighted by throughput.
fn weighted(throughput: DVec3, values: DVec3, densities: DVec3) -> DVec3 {
    throughput * values * (throughput.element_sum() / throughput.dot(densities))
}

#[cfg(test)]
mod tests;
