//! The gem recipes' uniforms and overrides, and what light does to a ray under them.

use super::geometry::Hit;
use super::ray::{Event, Ray};
use crate::light::environment::around;
use crate::light::from_bodies::{self, Body};
use crate::settings::Settings;
use crate::stone::material::GemMaterial;
use crate::stone::restraint;
use crate::stone::wavelengths::{GemWavelength, wavelengths};
use glam::{Mat3, UVec2, Vec3, Vec4Swizzles as _};
use lapidary_absorption as absorption;
use lapidary_environment as environment;
use lapidary_plan::{Decisions, Effect};
use lapidary_refraction as refraction;
use lapidary_scene::{Environment, Material, Object, Scene};

/// `GemCopy` of the recipe.
pub(super) struct GemCopy {
    /// Columns that are the rows of its rotation from the stone's space to world space.
    pub(super) rotation: Mat3,
    pub(super) scale: f32,
    pub(super) translation: Vec3,
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
    pub(super) material: GemMaterial,
    pub(super) copy: Option<GemCopy>,
    /// Bodies that light meets outside; none if the effect is off.
    bodies: Vec<Body>,
    pub(super) wavelengths: Vec<GemWavelength>,
    pub(super) settings: &'a Settings,
    absorbs: bool,
    limits_throughput: bool,
}

/// `GemMeeting` of the recipe, of bounds.
#[derive(Clone, Copy)]
pub(super) struct Meeting {
    /// Number of the body.
    body: usize,
    /// Radiance that it sends.
    radiance: Vec3,
}

impl<'a> Shading<'a> {
    /// Prepares the shading of `material` under `settings`.
    pub fn new(material: &Material, settings: &'a Settings) -> Self {
        Self {
            material: GemMaterial::of(material, settings.rung, settings),
            copy: None,
            bodies: Vec::new(),
            wavelengths: wavelengths(material, settings.rung.spectrum()),
            settings,
            absorbs: !settings.without.has(Effect::Absorption) && material.absorbs(),
            limits_throughput: restraint::limits_throughput(settings.rung, settings),
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
        let bodies = if meets { from_bodies::all(scene, &around(self.settings)) } else { Vec::new() };
        Self { bodies, ..self }
    }

    fn world_position(&self, position: Vec3) -> Vec3 {
        let in_world = |copy: &GemCopy| copy.scale * (copy.rotation.transpose() * position) + copy.translation;
        self.copy.as_ref().map_or(position, in_world)
    }

    fn world_direction(&self, direction: Vec3) -> Vec3 {
        self.copy.as_ref().map_or(direction, |copy| copy.rotation.transpose() * direction)
    }

    pub(super) fn world_length(&self, length_inside: f32) -> f32 {
        self.copy.as_ref().map_or(length_inside, |copy| copy.scale * length_inside)
    }

    pub(super) fn base_color(&self) -> Vec3 {
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
    pub(super) fn meeting(&self, position: Vec3, direction: Vec3) -> Option<Meeting> {
        let (position, direction) = (self.world_position(position), self.world_direction(direction));
        let (body, distance) = from_bodies::hit(&self.bodies, position, direction)?;
        Some(Meeting { body, radiance: self.bodies[body].sends(position + distance * direction) })
    }

    pub(super) fn met(&self, position: Vec3, direction: Vec3) -> Option<usize> {
        self.meeting(position, direction).map(|meeting| meeting.body)
    }

    pub(super) fn arriving(&self, meeting: Option<Meeting>, direction: Vec3) -> Vec3 {
        meeting.map_or_else(|| self.environment(direction), |meeting| meeting.radiance)
    }

    pub(super) fn surroundings(&self, position: Vec3, direction: Vec3) -> Vec3 {
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
    pub(super) fn arrive(&self, ray: &mut Ray, hit: &Hit) -> bool {
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

    pub(super) fn leave(&self, ray: &mut Ray, share: Vec3, outside: Vec3) {
        let left = if self.settings.gem.end_at_first_exit { share.ceil() } else { share };
        ray.radiance += left * ray.throughput * outside;
        ray.throughput *= 1.0 - left;
    }

    pub(super) fn reflect(&self, ray: &mut Ray, hit: &Hit) {
        ray.position = hit.point;
        ray.direction = refraction::reflect(ray.direction, hit.normal);
        if self.settings.gem.end_at_first_exit {
            ray.followed = ray.throughput.cmpgt(Vec3::ZERO).any();
        }
        if self.limits_throughput {
            ray.followed = ray.throughput.max_element() >= self.material.throughput_limit;
        }
    }
}
