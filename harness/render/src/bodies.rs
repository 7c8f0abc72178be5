//! The bodies of a scene by their bounds and by what they send, as the part `bodies` reads them.

use crate::record::Record;
use glam::{DVec3, Vec3, Vec4};
use lapidary_bounds_trace::{self as bounds_trace, BOUNDS_TRACE_NONE};
use lapidary_environment as environment;
use lapidary_scene::{Bounds, Environment, Object, Scene, harmonics};
use std::f64::consts::PI;

/// Largest number of bodies: each ray that leaves a stone is tested against all.
pub const MOST_BODIES: usize = 16;

/// Binding of the part `bodies` in group 0.
pub(super) const BINDING: u32 = 9;

/// Number of harmonics of degrees 0 to 2.
const HARMONICS: usize = 9;

/// Share of its box that a body must fill to count as a box: between an ellipsoid's, π/6, and 1.
const BOX: f64 = 0.5 * (1.0 + PI / 6.0);

/// `Body` of the recipes.
pub(crate) struct Body {
    /// Rows of the matrix from world space to the space of the bounds.
    pub(crate) bounds_from_world: [Vec4; 3],
    /// Harmonics of what the body sends, by the normal of its surface.
    pub(crate) radiance: [Vec3; HARMONICS],
    pub(crate) is_ball: bool,
}

/// Returns all bodies but clear stones, or the largest of them.
///
/// Of a stone, bounds and a mean colour say too little: with them, rays that meet another stone come out
/// worse than with the environment behind it (docs/gem.md).
pub(crate) fn all(scene: &Scene, surroundings: &Environment) -> Vec<Body> {
    let around = harmonics::project(surroundings);
    let bounds = |object: &Object| Bounds::of(object.mesh.positions.iter().copied());
    let is_met = |object: &&Object| !object.material.is_clear() && !object.mesh.indices.is_empty();
    let shown = scene.objects.iter().filter(is_met);
    let mut bodies: Vec<(&Object, Bounds)> = shown.map(|object| (object, bounds(object))).collect();
    let size = |bounds: &Bounds| (bounds.max - bounds.min).length_squared();
    bodies.sort_by(|(_, one), (_, other)| size(other).total_cmp(&size(one)));
    bodies.truncate(MOST_BODIES);
    bodies.into_iter().map(|(object, bounds)| Body::of(object, bounds, scene, &around)).collect()
}

impl Body {
    fn of(object: &Object, bounds: Bounds, scene: &Scene, around: &[DVec3; harmonics::COUNT]) -> Self {
        let (centre, half) = (bounds.centre(), 0.5 * (bounds.max - bounds.min));
        // Bounds without thickness still face somewhere.
        let half = half.max(Vec3::splat(1e-4 * half.max_element().max(f32::MIN_POSITIVE)));
        let scale = half.recip();
        let bounds_from_world = std::array::from_fn(|axis| {
            let mut row = Vec4::ZERO;
            row[axis] = scale[axis];
            row.w = -centre[axis] * scale[axis];
            row
        });
        let volume = 8.0 * half.as_dvec3().element_product();
        let is_ball = object.mesh.volume_and_area().0 < BOX * volume;
        let radiance = matte(object, centre.as_dvec3(), scene, around).map(|coefficient| coefficient.as_vec3());
        Self { bounds_from_world, radiance, is_ball }
    }

    /// Returns the struct as the recipes read it.
    pub(crate) fn record(&self) -> Record {
        let radiance = self.radiance.map(|coefficient| coefficient.extend(0.0));
        let record = Record::new("Body").with("bounds_from_world", self.bounds_from_world);
        record.with("radiance", &radiance[..]).with("shape", u32::from(self.is_ball))
    }
}

/// Returns the harmonics of what a matte body sends, by its normal: the environment and the lights,
/// without shadows, by Lambert's law.
fn matte(object: &Object, centre: DVec3, scene: &Scene, around: &[DVec3; harmonics::COUNT]) -> [DVec3; HARMONICS] {
    let mut arriving = *around;
    for light in &scene.lights {
        let arrival = light.arrival(centre);
        for (sum, value) in arriving.iter_mut().zip(harmonics::basis(arrival.direction)) {
            *sum += value * arrival.irradiance;
        }
    }
    let albedo = object.material.base_color.as_dvec3() / PI;
    let weights: Vec<f64> = harmonics::weights().collect();
    std::array::from_fn(|place| weights[place] * albedo * arriving[place])
}

/// `bodies_hit` of the part `bodies`: the number of the body that a ray meets first, and the distance.
pub(crate) fn hit(bodies: &[Body], position: Vec3, direction: Vec3) -> Option<(usize, f32)> {
    let mut nearest: Option<(usize, f32)> = None;
    for (number, body) in bodies.iter().enumerate() {
        let [start, along] = [body.point(position), body.direction(direction)];
        let distance = if body.is_ball { bounds_trace::ball(start, along) } else { bounds_trace::cuboid(start, along) };
        if distance != BOUNDS_TRACE_NONE && nearest.is_none_or(|(_, least)| distance < least) {
            nearest = Some((number, distance));
        }
    }
    nearest
}

impl Body {
    fn point(&self, position: Vec3) -> Vec3 {
        Vec3::from_array(self.bounds_from_world.map(|row| row.dot(position.extend(1.0))))
    }

    fn direction(&self, direction: Vec3) -> Vec3 {
        Vec3::from_array(self.bounds_from_world.map(|row| row.dot(direction.extend(0.0))))
    }

    /// `bodies_radiance`: the radiance that it sends from a world position on its bounds.
    pub(crate) fn sends(&self, position: Vec3) -> Vec3 {
        let point = self.point(position);
        let normal = if self.is_ball { point } else { bounds_trace::cuboid_normal(point) };
        let [first, second, third] = self.bounds_from_world.map(|row| row.truncate());
        let about = (first * normal.x + second * normal.y + third * normal.z).normalize();
        let basis = environment::harmonics(about);
        let basis = [basis.zeroth].into_iter().chain(basis.first.to_array()).chain(basis.second);
        let radiance: Vec3 = self.radiance.iter().zip(basis).map(|(coefficient, value)| value * *coefficient).sum();
        radiance.max(Vec3::ZERO)
    }
}
