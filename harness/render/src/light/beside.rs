//! The triangles of a scene's bodies that are not clear and what they send, as the part `beside` reads them.

use crate::error::RenderError;
use crate::frame::{Buffer, Builder};
use glam::{DVec3, Vec3};
use lapidary_plan::thickness;
use lapidary_scene::{Bvh, Mesh, Scene, harmonics, light};
use std::f64::consts::PI;

/// Bindings in group 0: the nodes, and the corners.
pub(crate) const BINDINGS: [u32; 2] = [17, 18];

/// Largest radiance that a corner sends.
const MOST_SENT: f64 = 1e30;
/// The same as a multiple of the mean over all corners: what sends more is cut.
const MOST_OF_MEAN: f64 = 64.0;

/// The hierarchy in a frame.
#[derive(Clone, Copy)]
pub(crate) struct Beside {
    pub(crate) nodes: Buffer,
    pub(crate) corners: Buffer,
}

impl Beside {
    /// Adds the bodies to the frame, lit by the scene's lights and an environment of these harmonics, without shadows, by
    /// Lambert's law.
    ///
    /// # Errors
    /// If they are beyond the limits that every device offers.
    pub(crate) fn new(
        builder: &mut Builder<'_>,
        scene: &Scene,
        around: &[DVec3; harmonics::COUNT],
    ) -> Result<Self, RenderError> {
        let (mut positions, mut sent, mut indices) = (Vec::new(), Vec::new(), Vec::new());
        for object in scene.beside_stones().filter(|object| object.material.covered_share() > 0.0) {
            let color = thickness::color(&object.material, &object.mesh.colors).as_dvec3() / PI;
            for corners in triangles(&object.mesh) {
                for (position, normal) in corners {
                    let by_lights = light::irradiance(&scene.lights, position.as_dvec3(), normal.as_dvec3());
                    let irradiance = harmonics::irradiance(around, normal.as_dvec3()) + by_lights;
                    positions.push(position);
                    sent.push((color * irradiance).min(DVec3::splat(MOST_SENT)).as_vec3());
                }
                let last = positions.len() as u32;
                // From inside, as a ray meets them that leaves a solid.
                indices.extend([last - 3, last - 1, last - 2]);
            }
        }
        // A corner beside a lamp would leave too few steps to all others.
        let mean = sent.iter().map(|sent| sent.as_dvec3()).sum::<DVec3>() / sent.len().max(1) as f64;
        let largest = sent.iter().copied().fold(Vec3::ZERO, Vec3::max).min((MOST_OF_MEAN * mean).as_vec3());
        let largest = largest.max(Vec3::splat(f32::MIN_POSITIVE));
        let bvh = Bvh::build(&positions, &indices);
        let mut corners = bvh.corners.clone();
        for (corner, index) in corners.iter_mut().zip(&bvh.indices) {
            corner.w = packed((sent[*index as usize] / largest).min(Vec3::ONE));
        }
        corners.push(largest.extend(0.0));
        RenderError::unless_bound(size_of_val(&corners[..]) as u64, || "the triangles beside stones".to_owned())?;
        let words = bvh.words();
        Ok(builder.of_object("", |builder| Self {
            nodes: builder.storage("nodes beside", bytemuck::cast_slice(&words)),
            corners: builder.storage("corners beside", bytemuck::cast_slice(&corners)),
        }))
    }
}

/// Packs shares of 0 to 1 as the part reads them: a whole number below 2^24.
fn packed(share: Vec3) -> f32 {
    let [red, green, blue] = (255.0 * share.map(f32::sqrt)).round().to_array();
    red + 256.0 * green + 65536.0 * blue
}

/// Returns the positions and normals of each triangle's corners.
fn triangles(mesh: &Mesh) -> impl Iterator<Item = [(Vec3, Vec3); 3]> {
    mesh.indices.chunks_exact(3).map(|triangle| {
        let [a, b, c] = [0, 1, 2].map(|corner| mesh.positions[triangle[corner] as usize]);
        let flat = (b - a).cross(c - a).normalize_or_zero();
        let normal = |index: u32| mesh.normals.get(index as usize).map_or(flat, |normal| normal.normalize_or(flat));
        [(a, normal(triangle[0])), (b, normal(triangle[1])), (c, normal(triangle[2]))]
    })
}
