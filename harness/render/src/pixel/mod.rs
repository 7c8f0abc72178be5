//! The gem recipes' whole computation of one pixel in Rust, from the mirrors:
//! `wgsl/recipes/parts/gem_shading.wgsl` line by line.
//!
//! A GPU picture is compared with it pixel by pixel (`harness/cook/tests/suite/parity`). The facets
//! that each ray met are also returned, because a difference is allowed only where rays part at a
//! facet's edge.

pub mod display;
mod geometry;
mod surface;

pub use geometry::Stone;
pub use surface::{SurfacePoint, Viewer};

use crate as render;
use crate::bodies::{self, Body};
use crate::lighting::around;
use crate::{GemMaterial, GemWavelength, Settings};
use geometry::{Entry, Hit};
use glam::{Mat3, UVec2, Vec3, Vec4Swizzles as _};
use lapidary_absorption as absorption;
use lapidary_dispersion as dispersion;
use lapidary_environment as environment;
use lapidary_fresnel as fresnel;
use lapidary_plan::{Decisions, Effect, Rung, Spectrum};
use lapidary_refraction as refraction;
use lapidary_scene::{Environment, Material, Object, Scene};

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

/// A pixel's radiance and the events of its rays, wavelength by wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixel {
    /// Linear radiance.
    pub radiance: Vec3,
    /// One list per ray: one ray, or one for each separate wavelength.
    pub rays: Vec<Vec<Event>>,
}

/// `GemCopy` of the recipe.
struct GemCopy {
    /// Columns that are the rows of its rotation from the stone's space to world space.
    rotation: Mat3,
    scale: f32,
    translation: Vec3,
    base_color: Vec3,
    absorption: Vec3,
}

impl GemCopy {
    /// Returns the copy at `place`, of its own material.
    fn of(place: &lapidary_scene::Place, material: &GemMaterial) -> Self {
        let rows = place.rows();
        let scale = rows[0].xyz().length();
        let rotation = Mat3::from_cols(rows[0].xyz() / scale, rows[1].xyz() / scale, rows[2].xyz() / scale);
        let translation = Vec3::new(rows[0].w, rows[1].w, rows[2].w);
        let GemMaterial { base_color, absorption, .. } = *material;
        Self { rotation, scale, translation, base_color, absorption: scale * absorption }
    }
}

/// The recipe's uniforms and overrides.
pub struct Shading<'a> {
    material: GemMaterial,
    copy: Option<GemCopy>,
    /// Bodies that light meets outside; none if the effect is off.
    bodies: Vec<Body>,
    wavelengths: Vec<GemWavelength>,
    settings: &'a Settings,
    absorbs: bool,
    limits_throughput: bool,
}

/// `GemRay` of the recipe, and the events that the ray met.
struct Ray {
    position: Vec3,
    direction: Vec3,
    travelled: f32,
    throughput: Vec3,
    radiance: Vec3,
    followed: bool,
    events: Vec<Event>,
}

impl Ray {
    fn new(position: Vec3, direction: Vec3) -> Self {
        let (throughput, radiance) = (Vec3::ONE, Vec3::ZERO);
        Self { position, direction, travelled: 0.0, throughput, radiance, followed: true, events: Vec::new() }
    }

    fn end(&mut self, outside: Vec3, met: Option<usize>) {
        self.radiance += self.throughput * outside;
        if met.is_some() {
            self.events.push(Event { facet: None, total: 0, met });
        }
    }
}

/// Direction of a ray that leaves through a facet, and the share of light that does.
struct Exit {
    direction: Vec3,
    share: f32,
}

fn exit(inside: Vec3, normal: Vec3, index: f32) -> Exit {
    let leaving = refraction::refract(inside, normal, 1.0 / index);
    if leaving.total {
        return Exit { direction: inside, share: 0.0 };
    }
    Exit { direction: leaving.direction, share: 1.0 - fresnel::dielectric(-normal.dot(inside), 1.0 / index) }
}

/// `GemMeeting` of the recipe, of bounds.
#[derive(Clone, Copy)]
struct Meeting {
    /// Number of the body.
    body: usize,
    /// Radiance that it sends.
    radiance: Vec3,
}

/// `gem_lead` of the recipe.
fn lead(red: &Exit, green: &Exit, blue: &Exit) -> Vec3 {
    let other = if red.share > 0.0 { red.direction } else { blue.direction };
    if green.share > 0.0 { green.direction } else { other }
}

impl<'a> Shading<'a> {
    /// Prepares the shading of `material` under `settings`.
    pub fn new(material: &Material, settings: &'a Settings) -> Self {
        Self {
            material: GemMaterial::of(material, settings.rung, settings),
            copy: None,
            bodies: Vec::new(),
            wavelengths: render::wavelengths(material, settings.rung.spectrum()),
            settings,
            absorbs: !settings.without.has(Effect::Absorption) && material.absorbs(),
            limits_throughput: render::restraint::limits_throughput(settings.rung, settings),
        }
    }

    /// Prepares the shading of a copy of `material` at `place`.
    pub fn of_copy(material: &Material, place: &lapidary_scene::Place, settings: &'a Settings) -> Self {
        let shading = Self::new(&place.material(material), settings);
        Self { copy: Some(GemCopy::of(place, &shading.material)), ..shading }
    }

    /// Returns the shading of `object`, whose light meets the bounds of the other bodies of `scene` if the
    /// settings have it so.
    #[must_use]
    pub fn among(self, object: &Object, scene: &Scene) -> Self {
        let meets = Decisions::of(object, scene, &self.settings.request()).has(Effect::BoundsTrace);
        let bodies = if meets { bodies::all(scene, &around(self.settings)) } else { Vec::new() };
        Self { bodies, ..self }
    }

    fn world_position(&self, position: Vec3) -> Vec3 {
        let of = |copy: &GemCopy| copy.scale * (copy.rotation.transpose() * position) + copy.translation;
        self.copy.as_ref().map_or(position, of)
    }

    fn world_direction(&self, direction: Vec3) -> Vec3 {
        self.copy.as_ref().map_or(direction, |copy| copy.rotation.transpose() * direction)
    }

    fn world_length(&self, length_inside: f32) -> f32 {
        self.copy.as_ref().map_or(length_inside, |copy| copy.scale * length_inside)
    }

    fn base_color(&self) -> Vec3 {
        self.copy.as_ref().map_or(self.material.base_color, |copy| copy.base_color)
    }

    /// Returns the radiance that arrives from a direction in the stone's space.
    pub fn environment(&self, direction: Vec3) -> Vec3 {
        let direction = self.world_direction(direction);
        let Environment::Map(map) = &self.settings.environment else {
            return environment::studio(direction);
        };
        let texels = environment::texels(environment::uv_from_direction(direction), UVec2::new(map.width, map.height));
        let load = |x: u32, y: u32| {
            let [r, g, b, _] = map.pixels[(y * map.width + x) as usize];
            Vec3::new(r, g, b)
        };
        let mix = |a: Vec3, b: Vec3, t: f32| a * (1.0 - t) + b * t;
        let lower = mix(load(texels.lower.x, texels.lower.y), load(texels.upper.x, texels.lower.y), texels.weight.x);
        let upper = mix(load(texels.lower.x, texels.upper.y), load(texels.upper.x, texels.upper.y), texels.weight.x);
        mix(lower, upper, texels.weight.y)
    }

    /// `gem_meeting` of the recipe, for bounds: the body that a ray meets first; `None` if it meets none.
    fn meeting(&self, position: Vec3, direction: Vec3) -> Option<Meeting> {
        let (position, direction) = (self.world_position(position), self.world_direction(direction));
        let (body, distance) = bodies::hit(&self.bodies, position, direction)?;
        Some(Meeting { body, radiance: self.bodies[body].sends(position + distance * direction) })
    }

    fn met(&self, position: Vec3, direction: Vec3) -> Option<usize> {
        self.meeting(position, direction).map(|meeting| meeting.body)
    }

    fn arriving(&self, meeting: Option<Meeting>, direction: Vec3) -> Vec3 {
        meeting.map_or_else(|| self.environment(direction), |meeting| meeting.radiance)
    }

    fn surroundings(&self, position: Vec3, direction: Vec3) -> Vec3 {
        self.arriving(self.meeting(position, direction), direction)
    }

    fn transmittance(&self, distance: f32) -> Vec3 {
        if !self.absorbs {
            return Vec3::ONE;
        }
        let coefficient = self.copy.as_ref().map_or(self.material.absorption, |copy| copy.absorption);
        absorption::transmittance(coefficient, distance)
    }

    fn ends(&self, travelled: f32) -> bool {
        self.settings.gem.distance_limit.is_some() && self.world_length(travelled) > self.material.distance_limit
    }

    /// Takes a ray as far as its next facet. Returns whether it is followed there. The callers stop
    /// where it ends; the recipe's loops continue, but no longer change such a ray.
    fn arrive(&self, ray: &mut Ray, hit: &Hit) -> bool {
        if !ray.followed {
            return false;
        }
        ray.travelled += hit.distance;
        ray.followed = hit.facet.is_some() && !self.ends(ray.travelled);
        if ray.followed {
            ray.throughput *= self.transmittance(hit.distance);
        } else {
            ray.events.push(Event { facet: None, total: 0, met: None });
        }
        ray.followed
    }

    fn leave(&self, ray: &mut Ray, share: Vec3, outside: Vec3) {
        let left = if self.settings.gem.end_at_first_exit { share.ceil() } else { share };
        ray.radiance += left * ray.throughput * outside;
        ray.throughput *= 1.0 - left;
    }

    fn reflect(&self, ray: &mut Ray, hit: &Hit) {
        ray.position = hit.point;
        ray.direction = refraction::reflect(ray.direction, hit.normal);
        if self.settings.gem.end_at_first_exit {
            ray.followed = ray.throughput.cmpgt(Vec3::ZERO).any();
        }
        if self.limits_throughput {
            ray.followed = ray.throughput.max_element() >= self.material.throughput_limit;
        }
    }

    fn trace(&self, entry: &Entry<'_>, direction: Vec3, index: f32) -> Ray {
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

    fn trace_tracked(&self, entry: &Entry<'_>, direction: Vec3) -> Ray {
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
    fn trace_split(&self, entry: &Entry<'_>, direction: Vec3) -> [Ray; 2] {
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

    fn trace_paper(&self, entry: &Entry<'_>, direction: Vec3) -> Ray {
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

    fn reflectance_channels(&self, cosine: f32) -> Vec3 {
        Vec3::from_array(self.material.channel_indices.to_array().map(|index| fresnel::dielectric(cosine, index)))
    }

    /// Returns the radiance of a pixel whose centre shows `point` of `stone` to an eye at `eye`, in
    /// world space; the point is in the stone's space.
    pub fn pixel(&self, stone: &Stone<'_>, point: SurfacePoint, eye: Vec3) -> Pixel {
        let entry = stone.entry(point);
        let eye = self.copy.as_ref().map_or(eye, |copy| copy.rotation * (eye - copy.translation) / copy.scale);
        let transmits = self.settings.rung != Rung::Surface;
        let direction = (entry.position - eye).normalize();
        let cosine = (-entry.face_normal.dot(direction)).clamp(0.0, 1.0);
        let reflected = self.surroundings(entry.position, refraction::reflect(direction, entry.face_normal));
        let mut rays = Vec::new();
        let met = self.met(entry.position, refraction::reflect(direction, entry.face_normal));
        rays.extend(met.map(|_| vec![Event { facet: None, total: 0, met }]));
        if let Spectrum::Separate(_) = self.settings.rung.spectrum() {
            let (mut surface, mut inside) = (Vec3::ZERO, Vec3::ZERO);
            for &GemWavelength { weights, index } in &self.wavelengths {
                let reflectance = fresnel::dielectric(cosine, index);
                surface += weights * (reflectance * reflected);
                if transmits {
                    let ray = self.trace(&entry, direction, index);
                    inside += weights * ((1.0 - reflectance) * ray.radiance);
                    rays.push(ray.events);
                }
            }
            return Pixel { radiance: surface + inside * self.base_color(), rays };
        }
        let mut reflectance = Vec3::splat(fresnel::dielectric(cosine, self.material.index));
        if matches!(self.settings.rung.spectrum(), Spectrum::Tracker | Spectrum::Split) {
            reflectance = self.reflectance_channels(cosine);
        }
        let traced = match self.settings.rung.spectrum() {
            _ if !transmits => Vec::new(),
            Spectrum::Paper => vec![self.trace_paper(&entry, direction)],
            Spectrum::Tracker => vec![self.trace_tracked(&entry, direction)],
            Spectrum::Split => self.trace_split(&entry, direction).into(),
            Spectrum::One | Spectrum::Separate(_) => vec![self.trace(&entry, direction, self.material.index)],
        };
        let inside: Vec3 = traced.iter().map(|ray| ray.radiance).sum();
        rays.extend(traced.into_iter().map(|ray| ray.events));
        let radiance = reflectance * reflected + (1.0 - reflectance) * self.base_color() * inside;
        Pixel { radiance, rays }
    }
}
