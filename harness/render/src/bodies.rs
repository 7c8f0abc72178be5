//! The bodies of a scene by their bounds and by what they send, as the part `bodies` reads them.

use crate::record::Record;
use glam::{DVec3, Vec3, Vec4};
use lapidary_scene::{Bounds, Environment, Object, Scene, harmonics};
use std::f64::consts::PI;

/// Largest number of bodies: each ray that leaves a stone is tested against all.
pub const MOST_BODIES: usize = 16;

/// Number of harmonics of degrees 0 to 2.
const HARMONICS: usize = 9;

/// Share of its box that a body must fill to count as a box: between an ellipsoid's, π/6, and 1.
const BOX: f64 = 0.5 * (1.0 + PI / 6.0);

/// Returns the structs `Body` of the recipes: of all bodies but clear stones, or of the largest.
///
/// Of a stone, bounds and a mean colour say too little: with them, rays that meet another stone come out
/// worse than with the environment behind it (docs/gem.md).
pub(super) fn records(scene: &Scene, environment: &Environment) -> Vec<Record> {
    let around = harmonics::project(environment);
    let bounds = |object: &Object| Bounds::of(object.mesh.positions.iter().copied());
    let is_met = |object: &&Object| !object.material.is_clear() && !object.mesh.indices.is_empty();
    let shown = scene.objects.iter().filter(is_met);
    let mut bodies: Vec<(&Object, Bounds)> = shown.map(|object| (object, bounds(object))).collect();
    let size = |bounds: &Bounds| (bounds.max - bounds.min).length_squared();
    bodies.sort_by(|(_, one), (_, other)| size(other).total_cmp(&size(one)));
    bodies.truncate(MOST_BODIES);
    bodies.into_iter().map(|(object, bounds)| record(object, bounds, scene, &around)).collect()
}

fn record(object: &Object, bounds: Bounds, scene: &Scene, around: &[DVec3; harmonics::COUNT]) -> Record {
    let (centre, half) = (bounds.centre(), 0.5 * (bounds.max - bounds.min));
    // Bounds without thickness still face somewhere.
    let half = half.max(Vec3::splat(1e-4 * half.max_element().max(f32::MIN_POSITIVE)));
    let scale = half.recip();
    let rows: [Vec4; 3] = std::array::from_fn(|axis| {
        let mut row = Vec4::ZERO;
        row[axis] = scale[axis];
        row.w = -centre[axis] * scale[axis];
        row
    });
    let volume = 8.0 * half.as_dvec3().element_product();
    let is_ball = object.mesh.volume_and_area().0 < BOX * volume;
    let radiance = matte(object, centre.as_dvec3(), scene, around);
    let radiance: Vec<Vec4> = radiance.iter().map(|coefficient| coefficient.as_vec3().extend(0.0)).collect();
    let record = Record::new("Body").with("bounds_from_world", rows).with("radiance", &radiance[..]);
    record.with("shape", u32::from(is_ball))
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
