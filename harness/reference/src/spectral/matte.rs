//! Matte bodies: opaque, and of the same radiance seen from all sides.

use super::hit::{Hit, Place};
use glam::DVec3;
use lapidary_scene::harmonics::{self, COUNT};
use lapidary_scene::{Environment, Light, Mesh, Object, Scene};
use std::f64::consts::PI;

/// The matte bodies of a scene and the light on them. The default has none.
///
/// Nothing casts a shadow. The environment counts by its harmonics, as in the recipe
/// `cdrf_shading`, which follow a small bright light only roughly.
#[derive(Default)]
pub(super) struct Mattes {
    /// One entry for each body of the scene, `None` for a clear one; empty if no body is matte.
    bodies: Vec<Option<Matte>>,
    /// Coefficients of the environment's harmonics; 0 if it does not count.
    around: [DVec3; COUNT],
    lights: Vec<Light>,
}

struct Matte {
    /// Factor from irradiance to radiance: the base colour / π.
    reflectance: DVec3,
    /// Numbered like the body's triangles.
    faces: Vec<Face>,
}

struct Face {
    corners: [DVec3; 3],
    /// Normals at the corners; 0 where the mesh has none.
    normals: [DVec3; 3],
}

impl Mattes {
    /// Takes the opaque bodies of `scene` as matte, lit by its lights and `environment`.
    pub(super) fn new(scene: &Scene, environment: Option<&Environment>) -> Self {
        let is_matte = |object: &Object| object.material.is_opaque();
        if !scene.objects.iter().any(is_matte) {
            return Self::default();
        }
        Self {
            bodies: scene.objects.iter().map(|object| is_matte(object).then(|| Matte::new(object))).collect(),
            around: environment.map(harmonics::project).unwrap_or_default(),
            lights: scene.lights.clone(),
        }
    }

    /// Whether this body is matte.
    pub(super) fn has(&self, body: usize) -> bool {
        matches!(self.bodies.get(body), Some(Some(_)))
    }

    /// Returns the radiance that a matte body sends from `hit`, which lies at `point`; `None` if
    /// the body is clear.
    pub(super) fn sent(&self, hit: &Hit, point: DVec3) -> Option<DVec3> {
        let Place { body, face } = hit.place;
        let matte = self.bodies.get(body)?.as_ref()?;
        let normal = matte.faces.get(face).map_or(hit.normal, |face| face.normal(point, hit.normal));
        let lights = self.lights.iter().map(|light| {
            let arrival = light.arrival(point);
            arrival.direction.dot(normal).max(0.0) * arrival.irradiance
        });
        Some(matte.reflectance * (harmonics::irradiance(&self.around, normal) + lights.sum::<DVec3>()))
    }
}

impl Matte {
    fn new(object: &Object) -> Self {
        Self { reflectance: object.material.base_color.as_dvec3() / PI, faces: faces(&object.mesh) }
    }
}

/// Returns the faces of a mesh in the order in which its triangles are met.
fn faces(mesh: &Mesh) -> Vec<Face> {
    let mesh = mesh.without_folds();
    let face = |triangle: &[u32]| {
        let corner = |k: usize| mesh.positions.get(triangle[k] as usize).map(|position| position.as_dvec3());
        let normal = |k: usize| mesh.normals.get(triangle[k] as usize).map_or(DVec3::ZERO, |normal| normal.as_dvec3());
        Some(Face { corners: [corner(0)?, corner(1)?, corner(2)?], normals: [0, 1, 2].map(normal) })
    };
    mesh.indices.chunks_exact(3).filter_map(face).collect()
}

impl Face {
    /// Returns the unit normal at a point of the face, interpolated between the corners; `flat` if
    /// the normals there cancel each other.
    fn normal(&self, point: DVec3, flat: DVec3) -> DVec3 {
        let [a, b, c] = self.corners;
        let across = (b - a).cross(c - a);
        // The area opposite to a corner is the corner's weight, here with a common factor.
        let weight = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(across);
        let weights = [weight(b, c), weight(c, a), weight(a, b)];
        let sum: DVec3 = self.normals.iter().zip(weights).map(|(normal, weight)| weight * *normal).sum();
        sum.normalize_or(flat)
    }
}
