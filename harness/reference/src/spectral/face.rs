//! Triangles with normals at their corners.

use glam::{DVec2, DVec3};
use lapidary_curved_triangle::oracle::{self as curved_triangle, CurvedTriangle};
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
        self.mean(self.weights(point)).normalize_or(flat)
    }

    /// Returns where a ray that meets the face at `point` meets the curved surface that the normals at the corners
    /// describe, and the outward unit normal there.
    pub(super) fn curved(&self, point: DVec3, direction: DVec3, flat: DVec3) -> (DVec3, DVec3) {
        let ([a, b, c], [normal_a, normal_b, normal_c]) = (self.corners, self.normals);
        let triangle = CurvedTriangle { a, b, c, normal_a, normal_b, normal_c };
        let weights = self.weights(point);
        let met = curved_triangle::meet(triangle, DVec2::new(weights.y, weights.z), point, direction, flat);
        (met.position, met.normal)
    }

    /// Returns the weights of the corners at a point above or below the face, which add up to 1.
    pub(super) fn weights(&self, point: DVec3) -> DVec3 {
        let [a, b, c] = self.corners;
        let across = (b - a).cross(c - a);
        // The area opposite to a corner is the corner's weight.
        let weight = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(across) / across.length_squared();
        DVec3::new(weight(b, c), weight(c, a), weight(a, b))
    }

    /// Returns the edges from the first corner to the others.
    pub(super) fn edges(&self) -> [DVec3; 2] {
        let [a, b, c] = self.corners;
        [b - a, c - a]
    }

    fn mean(&self, weights: DVec3) -> DVec3 {
        self.normals.iter().zip(weights.to_array()).map(|(normal, weight)| weight * *normal).sum()
    }
}
