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

/// Least share of a surface that is a metal's from which on all of it counts as metal here; below, all is matte.
const METALLIC: f32 = 0.5;

/// The hierarchy in a frame.
#[derive(Clone, Copy)]
pub(crate) struct Beside {
    pub(crate) nodes: Buffer,
    pub(crate) corners: Buffer,
}

impl Beside {
    /// Adds the bodies to the frame, lit by the scene's lights and an environment of these harmonics, without shadows, by
    /// Lambert's law; metals as such, if `metals`.
    ///
    /// # Errors
    /// If they are beyond the limits that every device offers.
    pub(crate) fn new(
        builder: &mut Builder<'_>,
        scene: &Scene,
        around: &[DVec3; harmonics::COUNT],
        metals: bool,
    ) -> Result<Self, RenderError> {
        let (mut positions, mut sent, mut indices) = (Vec::new(), Vec::new(), Vec::new());
        // By corners.
        let mut of_metal = Vec::new();
        for object in scene.beside_stones().filter(|object| object.material.covered_share() > 0.0) {
            let color = thickness::color(&object.material, &object.mesh.colors);
            let metal = (metals && object.material.is_metal() && object.material.metallic >= METALLIC)
                .then(|| packed_metal(color, object.material.roughness));
            let color = color.as_dvec3() / PI;
            for corners in triangles(&object.mesh) {
                for (position, normal) in corners {
                    let by_lights = light::irradiance(&scene.lights, position.as_dvec3(), normal.as_dvec3());
                    let irradiance = harmonics::irradiance(around, normal.as_dvec3()) + by_lights;
                    positions.push(position);
                    // A metal's is not read.
                    let share = f64::from(u8::from(metal.is_none()));
                    sent.push((share * color * irradiance).min(DVec3::splat(MOST_SENT)).as_vec3());
                    of_metal.push(metal);
                }
                let last = positions.len() as u32;
                // From inside, as a ray meets them that leaves a solid.
                indices.extend([last - 3, last - 1, last - 2]);
            }
        }
        // A corner beside a lamp would leave too few steps to all others.
        let mean = sent.iter().map(|sent| sent.as_dvec3()).sum::<DVec3>()
            / of_metal.iter().filter(|metal| metal.is_none()).count().max(1) as f64;
        let largest = sent.iter().copied().fold(Vec3::ZERO, Vec3::max).min((MOST_OF_MEAN * mean).as_vec3());
        let largest = largest.max(Vec3::splat(f32::MIN_POSITIVE));
        let bvh = Bvh::build(&positions, &indices);
        let mut corners = bvh.corners.clone();
        for (corner, index) in corners.iter_mut().zip(&bvh.indices) {
            let matte = || packed((sent[*index as usize] / largest).min(Vec3::ONE));
            corner.w = of_metal[*index as usize].unwrap_or_else(matte);
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

/// Packs a metal as the part reads it: -1 minus a whole number below 2^24.
fn packed_metal(color: Vec3, roughness: f32) -> f32 {
    let [red, green, blue] = (127.0 * color.clamp(Vec3::ZERO, Vec3::ONE).map(f32::sqrt)).round().to_array();
    -1.0 - (red + 128.0 * green + 16384.0 * blue + 2_097_152.0 * (7.0 * roughness).round())
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
