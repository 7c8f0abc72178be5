//! The bodies of a scene by their bounds and by what they send, as the part `bodies` reads them.

use crate::frame::record::Record;
use glam::{DVec3, Vec3, Vec4};
use lapidary_bounds_trace::{self as bounds_trace, BOUNDS_TRACE_NONE};
use lapidary_environment as environment;
use lapidary_plan::MOST_BODIES;
use lapidary_scene::mesh_diagnosis::open_edges;
use lapidary_scene::{Bounds, Object, Scene, harmonics};
use std::f64::consts::PI;

/// Binding of the part `bodies` in group 0.
pub(crate) const BINDING: u32 = 9;

/// Number of harmonics of degrees 0 to 2.
const HARMONICS: usize = 9;

/// Least extent of a body in units of length.
const LEAST: f32 = 1e-18;

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

/// Returns all bodies but clear stones, or the largest of them, under an environment of these harmonics.
///
/// Of a stone, bounds and a mean colour say too little: with them, rays that meet another stone come out
/// worse than with the environment behind it (docs/gem.md).
pub(crate) fn all(scene: &Scene, around: &[DVec3; harmonics::COUNT]) -> Vec<Body> {
    let bounds = |object: &Object| Bounds::of(object.mesh.positions.iter().copied());
    let size = |bounds: &Bounds| (bounds.max - bounds.min).length();
    let met = scene.beside_stones().map(|object| (object, bounds(object)));
    // Of a body without extent, no ray could meet the bounds.
    let mut met: Vec<(&Object, Bounds)> = met.filter(|(_, bounds)| size(bounds) > LEAST).collect();
    met.sort_by(|(_, one), (_, other)| size(other).total_cmp(&size(one)));
    met.truncate(MOST_BODIES);
    met.into_iter().map(|(object, bounds)| Body::of(object, bounds, scene, around)).collect()
}

impl Body {
    fn of(object: &Object, bounds: Bounds, scene: &Scene, around: &[DVec3; harmonics::COUNT]) -> Self {
        let (centre, half) = (bounds.centre(), 0.5 * (bounds.max - bounds.min));
        // Bounds without thickness still face somewhere.
        let half = half.max(Vec3::splat(1e-4 * half.max_element()));
        let scale = half.recip();
        let bounds_from_world = std::array::from_fn(|axis| {
            let mut row = Vec4::ZERO;
            row[axis] = scale[axis];
            row.w = -centre[axis] * scale[axis];
            row
        });
        let volume = 8.0 * half.as_dvec3().element_product();
        // An open mesh has no volume.
        let fills = object.mesh.volume_and_area().0.abs() / volume;
        let is_ball = fills < BOX && open_edges(&object.mesh) == 0;
        let radiance = matte(object, scene, around).map(|coefficient| coefficient.as_vec3());
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
/// without shadows, by Lambert's law. What arrives from a light is the mean over the surface.
fn matte(object: &Object, scene: &Scene, around: &[DVec3; harmonics::COUNT]) -> [DVec3; HARMONICS] {
    let (mut area, mut arriving) = (0.0, [DVec3::ZERO; harmonics::COUNT]);
    if !scene.lights.is_empty() {
        for [a, b, c] in object.mesh.triangles().map(|corners| corners.map(|corner| corner.as_dvec3())) {
            let triangle_area = 0.5 * (b - a).cross(c - a).length();
            area += triangle_area;
            for arrival in scene.lights.iter().map(|light| light.arrival((a + b + c) / 3.0)) {
                for (sum, value) in arriving.iter_mut().zip(harmonics::basis(arrival.direction)) {
                    *sum += triangle_area * value * arrival.irradiance;
                }
            }
        }
    }
    let share = if area > 0.0 { area.recip() } else { 0.0 };
    let albedo = lapidary_plan::thickness::color(&object.material, &object.mesh.colors).as_dvec3() / PI;
    let weights: Vec<f64> = harmonics::weights().collect();
    std::array::from_fn(|place| weights[place] * albedo * (around[place] + share * arriving[place]))
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

#[cfg(test)]
mod tests {
    use super::super::environment::around;
    use super::*;
    use crate::settings::Settings;
    use lapidary_plan::{Effect, Effects};
    use lapidary_scene::surfaces::{rounded_box, sphere};
    use lapidary_scene::{Light, Material, Mesh};

    /// Returns a stone and another body of this mesh.
    fn beside(mesh: Mesh) -> Scene {
        let mut scene = Scene::named("octahedron").expect("built in");
        scene.objects.push(Object::new("other", mesh, Material::standard()));
        scene
    }

    /// Returns what is met in the studio.
    fn met(scene: &Scene) -> Vec<Body> {
        all(scene, &around(&Settings::of_size(8, 8)))
    }

    fn body(mesh: Mesh) -> Body {
        let mut all = met(&beside(mesh));
        assert_eq!(all.len(), 1);
        all.remove(0)
    }

    fn floor(height: f32) -> Mesh {
        let corner = |x: f32, z: f32| Vec3::new(x, height, z);
        let positions = vec![corner(-2.0, -2.0), corner(-2.0, 2.0), corner(2.0, 2.0), corner(2.0, -2.0)];
        Mesh::with_shared_normals(positions, vec![0, 1, 2, 0, 2, 3], lapidary_scene::Averaging::default())
    }

    fn block() -> Mesh {
        rounded_box(DVec3::new(1.0, 0.5, 2.0), 0.05, 2)
    }

    #[test]
    fn a_ball_is_an_ellipsoid_and_all_that_is_open_or_full_is_a_box() {
        assert!(body(sphere(1.0, 24)).is_ball);
        assert!(!body(block()).is_ball);
        for height in [-3.0, -1e-3, 0.0, 1e-3, 3.0] {
            assert!(!body(floor(height)).is_ball, "{height}");
        }
        let mut inverted = block();
        inverted.indices.chunks_exact_mut(3).for_each(|corners| corners.swap(0, 1));
        assert!(!body(inverted).is_ball);
    }

    /// The corners of the bounds are those of the cube, also of bounds without height.
    #[test]
    fn bounds_fit_their_body() {
        for mesh in [block(), sphere(3.0, 24), floor(0.7)] {
            let bounds = Bounds::of(mesh.positions.iter().copied());
            let body = body(mesh);
            for corner in [bounds.min, bounds.max] {
                let place = body.point(corner);
                assert!(place.is_finite() && (place.abs() - 1.0).max_element() < 1e-5, "{place}");
            }
        }
    }

    #[test]
    fn what_has_no_extent_is_no_body() {
        let point = Mesh::with_shared_normals(vec![Vec3::ONE; 3], vec![0, 1, 2], lapidary_scene::Averaging::default());
        assert!(met(&beside(point)).is_empty());
        let octahedron = Scene::named("octahedron").expect("built in");
        assert!(met(&octahedron).is_empty());
    }

    #[test]
    fn the_largest_are_met() {
        let mut scene = beside(block());
        for number in 0..2 * MOST_BODIES {
            let ball = sphere(0.1 + 0.1 * number as f64, 8);
            scene.objects.push(Object::new("ball", ball, Material::standard()));
        }
        let met = met(&scene);
        assert_eq!(met.len(), MOST_BODIES);
        // Scales of 1 / 3.2 and so on.
        assert!(met.iter().all(|body| body.bounds_from_world[0].x < 1.0));
    }

    /// In the dark nothing is sent, and from a lamp in its midst a ring sends what arrives at the ring.
    #[test]
    fn light_arrives_at_the_surface() {
        let dark = Settings { without: Effects::of(&[Effect::Environment]), ..Settings::of_size(8, 8) };
        let ring = lapidary_scene::surfaces::torus(2.0, 0.1, 64, 16);
        let sent = |scene: &Scene| all(scene, &around(&dark)).remove(0).radiance[0];
        let mut scene = beside(ring);
        assert_eq!(sent(&scene), Vec3::ZERO);
        scene.lights = vec![Light::Point { position: Vec3::ZERO, intensity: Vec3::ONE }];
        // The constant harmonic: 1 / (2 sqrt π), times π albedo / π, times 1 / r².
        let expected = 0.5 / std::f32::consts::PI.sqrt() * 0.25;
        assert!((sent(&scene) / expected - 1.0).abs().max_element() < 0.02, "{}", sent(&scene));
    }
}
