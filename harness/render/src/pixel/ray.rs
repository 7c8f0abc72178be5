//! A ray inside a stone, how it leaves, and what happened to it.

use glam::Vec3;
use lapidary_fresnel as fresnel;
use lapidary_refraction as refraction;

/// The discrete part of what happened to a ray at one facet: which facet, and which channels left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Event {
    /// Number that identifies the facet; `None` if the ray met none.
    pub facet: Option<u64>,
    /// One bit per channel, set if it is totally reflected.
    pub total: u8,
    /// Body whose bounds are met by what leaves; `None` if it meets none.
    pub met: Option<usize>,
}

/// `GemRay` of the recipe, and the events that the ray met.
pub(super) struct Ray {
    pub(super) position: Vec3,
    pub(super) direction: Vec3,
    pub(super) travelled: f32,
    pub(super) throughput: Vec3,
    pub(super) radiance: Vec3,
    pub(super) followed: bool,
    pub(super) events: Vec<Event>,
}

impl Ray {
    pub(super) fn new(position: Vec3, direction: Vec3) -> Self {
        let (throughput, radiance) = (Vec3::ONE, Vec3::ZERO);
        Self { position, direction, travelled: 0.0, throughput, radiance, followed: true, events: Vec::new() }
    }

    pub(super) fn end(&mut self, outside: Vec3, met: Option<usize>) {
        self.radiance += self.throughput * outside;
        if met.is_some() {
            self.events.push(Event { facet: None, total: 0, met });
        }
    }
}

/// Direction of a ray that leaves through a facet, and the share of light that does.
pub(super) struct Exit {
    pub(super) direction: Vec3,
    pub(super) share: f32,
}

/// Returns how a ray leaves through a facet.
pub(super) fn exit(inside: Vec3, normal: Vec3, index: f32) -> Exit {
    let leaving = refraction::refract(inside, normal, 1.0 / index);
    if leaving.total {
        return Exit { direction: inside, share: 0.0 };
    }
    Exit { direction: leaving.direction, share: 1.0 - fresnel::dielectric(-normal.dot(inside), 1.0 / index) }
}

/// `gem_lead` of the recipe.
pub(super) fn lead(red: &Exit, green: &Exit, blue: &Exit) -> Vec3 {
    let other = if red.share > 0.0 { red.direction } else { blue.direction };
    if green.share > 0.0 { green.direction } else { other }
}
