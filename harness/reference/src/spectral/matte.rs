//! Matte bodies: opaque, and of the same radiance seen from all sides. A partly clear body's surface is so for a share of the
//! light, and so is a body that covers a share of what is behind it. Of a metal in part the rest is matte.

use super::face::{Face, faces};
use super::hit::{Hit, Place};
use super::paint::{Paint, Painted, is_partly_clear};
use glam::DVec3;
use lapidary_scene::harmonics::{self, COUNT};
use lapidary_scene::{Environment, Light, Object, Scene, light};
use std::f64::consts::PI;

/// The matte bodies of a scene and the light on them. The default has none.
///
/// Nothing casts a shadow. The environment counts by its harmonics, as in the recipe
/// `cdrf_shading`, which follow a small bright light only roughly.
#[derive(Default)]
pub(super) struct Mattes {
    /// One entry for each body of the scene, `None` for one that is wholly clear; empty if all are.
    bodies: Vec<Option<Matte>>,
    /// Coefficients of the environment's harmonics; 0 if it does not count.
    around: [DVec3; COUNT],
    lights: Vec<Light>,
}

struct Matte {
    /// Whether no light enters or passes, and nothing is a metal, anywhere.
    is_whole: bool,
    is_opaque: bool,
    /// Factor from irradiance to radiance: the base colour / π; of a partly clear body, whose light has taken its colour as it
    /// came in, 1 / π.
    reflectance: DVec3,
    /// Numbered like the body's triangles.
    faces: Vec<Face>,
}

impl Mattes {
    /// Takes the opaque and partly clear bodies of `scene` as matte, lit by its lights and `environment`.
    pub(super) fn new(scene: &Scene, environment: Option<&Environment>) -> Self {
        if !scene.objects.iter().any(is_matte) {
            return Self::default();
        }
        Self {
            bodies: scene.objects.iter().map(|object| is_matte(object).then(|| Matte::new(object))).collect(),
            around: environment.map(harmonics::project).unwrap_or_default(),
            lights: scene.lights.clone(),
        }
    }

    /// Whether the triangles of this body are needed, as it is matte.
    pub(super) fn has(&self, body: usize) -> bool {
        matches!(self.bodies.get(body), Some(Some(matte)) if matte.is_whole || !matte.faces.is_empty())
    }

    /// Returns the radiance that a matte body sends from `hit`, which lies at `point`; `None` if
    /// the body is clear.
    pub(super) fn sent(&self, hit: &Hit, point: DVec3, paint: Option<&Paint>) -> Option<DVec3> {
        let matte = self.bodies.get(hit.place.body)?.as_ref().filter(|matte| matte.is_whole)?;
        let color = paint.map_or(DVec3::ONE, |paint| paint.at(hit.place, point).color);
        Some(color * self.sent_by(matte, hit.place, hit.normal, point, paint))
    }

    /// Returns the normal at a point of a matte body's or a metal's face, with the slopes of its image; `flat` is the face's own.
    pub(super) fn normal(&self, place: Place, flat: DVec3, point: DVec3, paint: Option<&Paint>) -> DVec3 {
        let matte = self.bodies.get(place.body).and_then(Option::as_ref);
        let normal = matte.and_then(|matte| matte.faces.get(place.face)).map_or(flat, |face| face.normal(point, flat));
        paint.map_or(normal, |paint| paint.bent(place, point, normal))
    }

    /// Returns the irradiance of each light at a point, perpendicular to its direction.
    pub(super) fn arrivals(&self, point: DVec3) -> impl Iterator<Item = light::Arrival> {
        self.lights.iter().map(move |light| light.arrival(point))
    }

    /// Returns the radiance that the matte share of a body's surface adds.
    pub(super) fn sent_in_part(
        &self,
        (place, Painted { color, clear, metallic, .. }): (Place, Painted),
        flat: DVec3,
        point: DVec3,
        paint: Option<&Paint>,
    ) -> DVec3 {
        let matte = self.bodies.get(place.body).and_then(Option::as_ref);
        matte.map_or(DVec3::ZERO, |matte| {
            // Of a clear body the light has taken its colour already.
            let color = if matte.is_opaque { color } else { DVec3::ONE };
            (1.0 - clear) * (1.0 - metallic) * color * self.sent_by(matte, place, flat, point, paint)
        })
    }

    fn sent_by(&self, matte: &Matte, place: Place, flat: DVec3, point: DVec3, paint: Option<&Paint>) -> DVec3 {
        let normal = self.normal(place, flat, point, paint);
        let irradiance = harmonics::irradiance(&self.around, normal) + light::irradiance(&self.lights, point, normal);
        matte.reflectance * irradiance
    }
}

/// Whether a surface is matte, for a share of the light at least, somewhere.
fn is_matte(object: &Object) -> bool {
    let material = &object.material;
    if material.is_opaque() { material.covered_share() > 0.0 } else { is_partly_clear(object) }
}

impl Matte {
    fn new(object: &Object) -> Self {
        let material = &object.material;
        let color = if material.is_clear() { DVec3::ONE } else { material.base_color.as_dvec3() };
        let is_flat = material.is_clear() && !material.is_smooth(&object.mesh);
        let faces = if is_flat { Vec::new() } else { faces(&object.mesh) };
        let is_opaque = material.is_opaque();
        Self {
            is_whole: is_opaque && material.covers_all() && !material.is_metal(),
            is_opaque,
            reflectance: color / PI,
            faces,
        }
    }
}
