//! Triangles with normals at their corners.

use glam::DVec3;
use lapidary_scene::Mesh;

/// A triangle.
pub(super) struct Face {
    corners: [DVec3; 3],
    /// Normals at the corners; 0 where the mesh has none.
    normals: [DVec3; 3],
}

/// Returns the faces of a mesh in the order in which its triangles are met.
pub(super) fn faces(mesh: &Mesh) -> Vec<Face> {
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
    pub(super) fn normal(&self, point: DVec3, flat: DVec3) -> DVec3 {
        let [a, b, c] = self.corners;
        let across = (b - a).cross(c - a);
        // The area opposite to a corner is the corner's weight, here with a common factor.
        let weight = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(across);
        let weights = [weight(b, c), weight(c, a), weight(a, b)];
        let sum: DVec3 = self.normals.iter().zip(weights).map(|(normal, weight)| weight * *normal).sum();
        sum.normalize_or(flat)
    }
}
