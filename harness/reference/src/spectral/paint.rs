//! What the images of a body's material and the colours of its vertices hold at a point.

use super::face::{Face, faces};
use super::hit::Place;
use glam::{DVec3, Vec2, Vec3, Vec4};
use lapidary_scene::{Material, Object, TextureSlot};

/// The images of a body, and the colours of its vertices.
pub(super) struct Paint {
    material: Material,
    /// Numbered like the body's triangles.
    faces: Vec<Face>,
    /// At the corners of each face; empty without texture coordinates.
    uvs: Vec<[Vec2; 3]>,
    /// The same; empty without colours.
    colors: Vec<[Vec3; 3]>,
}

/// What they hold at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Painted {
    /// Factor of the base colour, linear RGB.
    pub(super) color: DVec3,
    /// Share of the light that comes from outside, and is not reflected, that enters; of an opaque body, the share that it does
    /// not cover.
    pub(super) clear: f64,
    /// Share of an opaque body's surface that is a metal's.
    pub(super) metallic: f64,
    /// Width of the slopes of a metal's facets.
    pub(super) metal_alpha: f64,
}

impl Painted {
    /// What a body without images has everywhere.
    pub(super) fn of(material: &Material) -> Self {
        let clear = if material.is_opaque() { 1.0 - material.covered_share() } else { material.clear_share() };
        let metallic = if material.is_metal() { f64::from(material.metallic) } else { 0.0 };
        let metal_alpha = f64::from(material.roughness * material.roughness);
        Self { color: DVec3::ONE, clear: f64::from(clear), metallic, metal_alpha }
    }
}

/// Whether a share of the light does not enter a clear body, or passes an opaque one, somewhere.
pub(super) fn is_partly_clear(Object { mesh, material, .. }: &Object) -> bool {
    let by_image = !mesh.uvs.is_empty() && material.effective(TextureSlot::Transmission).is_some();
    if material.is_opaque() { !material.covers_all() } else { material.clear_share() < 1.0 || by_image }
}

impl Paint {
    /// Returns `None` for a body that is the same all over.
    pub(super) fn of(object: &Object) -> Option<Self> {
        let Object { mesh, material, .. } = object;
        let has_images = !mesh.uvs.is_empty() && material.textures().any(|(slot, _)| material.calls_for(slot));
        if !has_images && mesh.colors.is_empty() {
            return None;
        }
        let mesh = mesh.without_folds();
        let corners = || mesh.indices.chunks_exact(3).map(|corners| [0, 1, 2].map(|corner| corners[corner] as usize));
        let uvs = corners().filter(|_| has_images).map(|corners| corners.map(|vertex| mesh.uvs[vertex])).collect();
        let colors = corners().filter(|_| !mesh.colors.is_empty());
        let colors = colors.map(|corners| corners.map(|vertex| mesh.colors[vertex])).collect();
        Some(Self { material: material.clone(), faces: faces(&mesh), uvs, colors })
    }

    /// Returns a texture's value at a point of a face; 1 in all channels if there is none.
    fn texel(&self, slot: TextureSlot, face: usize, weights: DVec3) -> Option<Vec4> {
        let [a, b, c] = self.uvs.get(face)?.map(|uv| uv.as_dvec2());
        let uv = weights.x * a + weights.y * b + weights.z * c;
        Some(self.material.effective(slot)?.at(uv.as_vec2()))
    }

    /// Returns what the body has at a point of a face.
    pub(super) fn at(&self, Place { face, .. }: Place, point: DVec3) -> Painted {
        let mut painted = Painted::of(&self.material);
        let Some(weights) = self.faces.get(face).map(|face| face.weights(point)) else { return painted };
        if let Some([a, b, c]) = self.colors.get(face).map(|colors| colors.map(|color| color.as_dvec3())) {
            painted.color *= weights.x * a + weights.y * b + weights.z * c;
        }
        if let Some(texel) = self.texel(TextureSlot::BaseColor, face, weights) {
            painted.color *= texel.truncate().as_dvec3();
            if let Some(coverage) = self.material.coverage.filter(|_| self.material.is_opaque()) {
                let here = lapidary_scene::Coverage { share: coverage.share * texel.w, ..coverage };
                painted.clear = f64::from(1.0 - here.without_image());
            }
        }
        if let Some(texel) = self.texel(TextureSlot::MetallicRoughness, face, weights) {
            painted.metal_alpha *= f64::from(texel.y * texel.y);
            painted.metallic *= f64::from(texel.z);
        }
        if let Some(texel) = self.texel(TextureSlot::Transmission, face, weights).filter(|_| self.material.is_clear()) {
            painted.clear *= f64::from(texel.x);
        }
        painted
    }

    /// Returns an outward unit normal at a point of a face, with the slopes of the body's image there.
    pub(super) fn bent(&self, Place { face, .. }: Place, point: DVec3, normal: DVec3) -> DVec3 {
        let Some(of_face) = self.faces.get(face) else { return normal };
        let Some(texel) = self.texel(TextureSlot::Normal, face, of_face.weights(point)) else { return normal };
        let Some(texture) = self.material.effective(TextureSlot::Normal) else { return normal };
        let scale = f64::from(self.material.normal_scale);
        let tilt = (2.0 * texel.truncate().as_dvec3() - 1.0) * DVec3::new(scale, scale, 1.0);
        let tilt = tilt.try_normalize().unwrap_or(DVec3::Z);
        let linear = texture.transform.affine().matrix2.as_dmat2();
        let [a, b, c] = self.uvs[face].map(|uv| uv.as_dvec2());
        let (to_b, to_c) = (linear * (b - a), linear * (c - a));
        let [first, second] = of_face.edges();
        // The gradients of u and v over the surface.
        let (toward_first, toward_second) = (second.cross(normal), normal.cross(first));
        let turn = first.dot(toward_first).signum();
        let along = |first: f64, second: f64| {
            (turn * (toward_first * first + toward_second * second)).try_normalize().unwrap_or_default()
        };
        let (u, v) = (along(to_b.x, to_c.x), along(to_b.y, to_c.y));
        (tilt.x * u - tilt.y * v + tilt.z.abs().max(1e-3) * normal).normalize()
    }
}
