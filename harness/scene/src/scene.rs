//! A scene: bodies, lights and a camera.

use crate::camera::direction;
use crate::object::vertices;
use crate::{Bounds, BuiltInEnvironment, Camera, Lacking, Light, Object};

/// Bodies, lights and a camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Name of the built-in scene, of the glTF scene, or of the file.
    pub name: String,
    /// Bodies, in the file's order.
    pub objects: Vec<Object>,
    /// Lights other than the environment.
    pub lights: Vec<Light>,
    /// Radii of the lights, by their numbers, as far as they are given: [`Scene::light_radius`].
    pub light_radii: Vec<Option<f32>>,
    /// Light from far away, unless another is asked for.
    pub environment: BuiltInEnvironment,
    /// Camera that looks at the bodies.
    pub camera: Camera,
    /// Features that the file asks for and this renderer does not draw, each listed once.
    pub lacking: Lacking,
}

/// Half the angle under which the sun is seen from the earth, in radians.
const SUN: f32 = 0.00465;
/// Radius of a lamp of which none is given, as a share of its distance from the middle of the scene.
const LAMP: f32 = 0.02;

impl Scene {
    /// Returns the radius of a light's disc: of a lamp in units of length, of a sun the sine of the angle that it takes up.
    /// If none is given, that of the sun, and for a lamp a fiftieth of its distance from the middle of the bodies.
    #[must_use]
    pub fn light_radius(&self, number: usize) -> f32 {
        if let Some(given) = self.light_radii.get(number).copied().flatten() {
            return given;
        }
        match self.lights.get(number) {
            Some(Light::Point { position, .. } | Light::Spot { position, .. }) => {
                (LAMP * position.distance(self.bounds().centre())).max(f32::MIN_POSITIVE)
            }
            Some(Light::Directional { .. }) | None => SUN,
        }
    }

    /// Returns the box around all vertices, of zero size at the origin if there are none.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds::of(vertices(&self.objects))
    }

    /// Returns the same bodies seen from `polar` degrees off the vertical and `azimuth` degrees
    /// from +z towards +x, with a newly framed camera.
    #[must_use]
    pub fn seen_from(&self, polar: f32, azimuth: f32) -> Self {
        let camera = Camera::framing(vertices(&self.objects), direction(polar, azimuth), self.camera.vertical_fov);
        Self { camera, ..self.clone() }
    }

    /// Returns the bodies that light may meet when it leaves a clear stone: those with triangles that are
    /// no clear stones themselves.
    pub fn beside_stones(&self) -> impl Iterator<Item = &Object> {
        self.objects.iter().filter(|object| !object.material.is_clear() && !object.mesh.indices.is_empty())
    }

    /// Returns the number of triangles in all bodies.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        let counts = self.objects.iter().map(|o| o.mesh.triangle_count());
        counts.sum()
    }
}
