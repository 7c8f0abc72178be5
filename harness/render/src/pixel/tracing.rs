//! Rays followed through a stone, for each way in which light of several colours is carried.

use super::geometry::Entry;
use super::ray::{Event, Ray, exit, lead};
use super::shading::Shading;
use glam::Vec3;
use lapidary_dispersion as dispersion;
use lapidary_refraction as refraction;

impl Shading<'_> {
    pub(super) fn trace(&self, entry: &Entry<'_>, direction: Vec3, index: f32) -> Ray {
        let mut place = entry.enter();
        let mut ray = Ray::new(entry.position, refraction::refract(direction, entry.face_normal, index).direction);
        for _ in 0..self.settings.rung.hits() {
            if !ray.followed {
                break;
            }
            let hit = place.hit(ray.position, ray.direction);
            if !self.arrive(&mut ray, &hit) {
                break;
            }
            let exit = exit(ray.direction, hit.normal, index);
            let met = self.met(hit.point, exit.direction);
            ray.events.push(Event { facet: hit.facet, total: u8::from(exit.share == 0.0), met });
            if exit.share > 0.0 {
                self.leave(&mut ray, Vec3::splat(exit.share), self.surroundings(hit.point, exit.direction));
            }
            self.reflect(&mut ray, &hit);
        }
        if self.settings.gem.rest_from_environment {
            let met = self.met(ray.position, ray.direction);
            ray.end(self.surroundings(ray.position, ray.direction), met);
        }
        ray
    }

    fn surroundings_channels(&self, position: Vec3, lead: Vec3, [red, green, blue]: [Vec3; 3]) -> Vec3 {
        let meeting = self.meeting(position, lead);
        let [red, green, blue] = [red, green, blue].map(|direction| self.arriving(meeting, direction));
        Vec3::new(red.x, green.y, blue.z)
    }

    pub(super) fn trace_tracked(&self, entry: &Entry<'_>, direction: Vec3) -> Ray {
        let indices = self.material.channel_indices;
        let offsets = indices - self.material.index;
        let mut place = entry.enter();
        let inside = refraction::refract(direction, entry.face_normal, self.material.index).direction;
        let mut ray = Ray::new(entry.position, inside);
        let mut gradient = dispersion::enter(direction, entry.face_normal, self.material.index);
        for _ in 0..self.settings.rung.hits() {
            if !ray.followed {
                break;
            }
            let hit = place.hit(ray.position, ray.direction);
            if !self.arrive(&mut ray, &hit) {
                break;
            }
            let red = exit(dispersion::direction(ray.direction, gradient, offsets.x), hit.normal, indices.x);
            let green = exit(dispersion::direction(ray.direction, gradient, offsets.y), hit.normal, indices.y);
            let blue = exit(dispersion::direction(ray.direction, gradient, offsets.z), hit.normal, indices.z);
            let share = Vec3::new(red.share, green.share, blue.share);
            let lead = lead(&red, &green, &blue);
            let met = self.met(hit.point, lead);
            ray.events.push(Event { facet: hit.facet, total: share.cmpeq(Vec3::ZERO).bitmask() as u8, met });
            if share.cmpgt(Vec3::ZERO).any() {
                let directions = [red.direction, green.direction, blue.direction];
                let outside = self.surroundings_channels(hit.point, lead, directions);
                self.leave(&mut ray, share, outside);
            }
            self.reflect(&mut ray, &hit);
            gradient = dispersion::reflect(gradient, hit.normal);
        }
        if self.settings.gem.rest_from_environment {
            let [red, green, blue] =
                offsets.to_array().map(|offset| dispersion::direction(ray.direction, gradient, offset));
            let met = self.met(ray.position, ray.direction);
            ray.end(self.surroundings_channels(ray.position, ray.direction, [red, green, blue]), met);
        }
        ray
    }

    fn surroundings_red_green(&self, position: Vec3, lead: Vec3, [red, green]: [Vec3; 2]) -> Vec3 {
        let meeting = self.meeting(position, lead);
        Vec3::new(self.arriving(meeting, red).x, self.arriving(meeting, green).y, 0.0)
    }

    fn surroundings_blue(&self, position: Vec3, blue: Vec3) -> Vec3 {
        Vec3::new(0.0, 0.0, self.surroundings(position, blue).z)
    }

    /// Returns green's ray, which carries red as well, and blue's.
    pub(super) fn trace_split(&self, entry: &Entry<'_>, direction: Vec3) -> [Ray; 2] {
        let indices = self.material.channel_indices;
        let offset = indices.x - indices.y;
        let [mut place, mut place_blue] = [entry.enter(), entry.enter()];
        let inside = |index: f32| refraction::refract(direction, entry.face_normal, index).direction;
        let mut ray = Ray::new(entry.position, inside(indices.y));
        let mut blue = Ray::new(entry.position, inside(indices.z));
        ray.throughput = Vec3::new(1.0, 1.0, 0.0);
        blue.throughput = Vec3::Z;
        let mut gradient = dispersion::enter(direction, entry.face_normal, indices.y);
        for _ in 0..self.settings.rung.hits() {
            if !ray.followed && !blue.followed {
                break;
            }
            let [hit, hit_blue] =
                place.hit_both((ray.position, ray.direction), &mut place_blue, (blue.position, blue.direction));
            if self.arrive(&mut ray, &hit) {
                let red = exit(dispersion::direction(ray.direction, gradient, offset), hit.normal, indices.x);
                let green = exit(ray.direction, hit.normal, indices.y);
                let total = u8::from(red.share == 0.0) | u8::from(green.share == 0.0) << 1;
                let lead = lead(&red, &green, &green);
                ray.events.push(Event { facet: hit.facet, total, met: self.met(hit.point, lead) });
                if red.share > 0.0 || green.share > 0.0 {
                    let outside = self.surroundings_red_green(hit.point, lead, [red.direction, green.direction]);
                    self.leave(&mut ray, Vec3::new(red.share, green.share, 0.0), outside);
                }
                self.reflect(&mut ray, &hit);
                gradient = dispersion::reflect(gradient, hit.normal);
            }
            if self.arrive(&mut blue, &hit_blue) {
                let exit = exit(blue.direction, hit_blue.normal, indices.z);
                let met = self.met(hit_blue.point, exit.direction);
                blue.events.push(Event { facet: hit_blue.facet, total: u8::from(exit.share == 0.0), met });
                if exit.share > 0.0 {
                    let outside = self.surroundings_blue(hit_blue.point, exit.direction);
                    self.leave(&mut blue, Vec3::new(0.0, 0.0, exit.share), outside);
                }
                self.reflect(&mut blue, &hit_blue);
            }
        }
        if self.settings.gem.rest_from_environment {
            let red = dispersion::direction(ray.direction, gradient, offset);
            let met = [&ray, &blue].map(|ray| self.met(ray.position, ray.direction));
            ray.end(self.surroundings_red_green(ray.position, ray.direction, [red, ray.direction]), met[0]);
            blue.end(self.surroundings_blue(blue.position, blue.direction), met[1]);
        }
        [ray, blue]
    }

    fn surroundings_paper(&self, position: Vec3, red: Vec3, spread: Vec3, travelled_inside: f32) -> Vec3 {
        let travelled = self.world_length(travelled_inside);
        let strength = self.material.dispersion_strength;
        self.surroundings_channels(
            position,
            red,
            [
                red,
                dispersion::paper_direction(red, spread, travelled, dispersion::DISPERSION_PAPER_GREEN, strength),
                dispersion::paper_direction(red, spread, travelled, dispersion::DISPERSION_PAPER_BLUE, strength),
            ],
        )
    }

    pub(super) fn trace_paper(&self, entry: &Entry<'_>, direction: Vec3) -> Ray {
        let index = self.material.channel_indices.x;
        let epsilon = dispersion::DISPERSION_PAPER_EPSILON;
        let mut place = entry.enter();
        let mut ray = Ray::new(entry.position, refraction::refract(direction, entry.face_normal, index).direction);
        let mut spread = dispersion::paper_enter(direction, ray.direction);
        for _ in 0..self.settings.rung.hits() {
            if !ray.followed {
                break;
            }
            let hit = place.hit(ray.position, ray.direction);
            if !self.arrive(&mut ray, &hit) {
                break;
            }
            let exit = exit(ray.direction, hit.normal, index);
            let met = self.met(hit.point, exit.direction);
            ray.events.push(Event { facet: hit.facet, total: u8::from(exit.share == 0.0), met });
            if exit.share > 0.0 {
                let leaving = dispersion::paper_refract(ray.direction, spread, hit.normal, 1.0 / index, epsilon);
                let outside = self.surroundings_paper(hit.point, exit.direction, leaving, ray.travelled);
                self.leave(&mut ray, Vec3::splat(exit.share), outside);
            }
            spread = dispersion::paper_reflect(ray.direction, spread, hit.normal, epsilon);
            self.reflect(&mut ray, &hit);
        }
        if self.settings.gem.rest_from_environment {
            let met = self.met(ray.position, ray.direction);
            ray.end(self.surroundings_paper(ray.position, ray.direction, spread, ray.travelled), met);
        }
        ray
    }
}
