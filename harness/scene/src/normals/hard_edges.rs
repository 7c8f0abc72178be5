//! Meshes with hard edges, and the soft normals that they get.

use std::borrow::Cow;

use glam::Vec3;

use super::{Averaging, shared_normals, weld};
use crate::Mesh;

/// Cosine of the largest angle, 1°, between two normals at one position that count as the same.
/// Exporters that split vertices along texture seams write the same normal twice, up to rounding.
const SAME_NORMAL: f32 = 0.999_848;

/// Whether normals at one position differ, as in flat shading.
#[must_use]
pub fn has_hard_edges(mesh: &Mesh) -> bool {
    let (welded, count) = weld(&mesh.positions);
    let mut first: Vec<Option<Vec3>> = vec![None; count];
    mesh.indices.iter().chain(&mesh.halo).any(|&vertex| {
        let vertex = vertex as usize;
        let (Some(&place), Some(&normal)) = (welded.get(vertex), mesh.normals.get(vertex)) else { return false };
        first[place].get_or_insert(normal).dot(normal) < SAME_NORMAL
    })
}

/// Returns one normal for each position: the mesh's own, or, if it has hard edges, the
/// angle-weighted mean of its triangles' normals.
#[must_use]
pub fn soft_normals(mesh: &Mesh) -> Cow<'_, [Vec3]> {
    if has_hard_edges(mesh) {
        return shared_normals(&mesh.positions, &mesh.indices, Averaging::Angle).into();
    }
    Cow::Borrowed(&mesh.normals)
}

#[cfg(test)]
mod tests {
    use super::super::tests::cube;
    use super::*;

    #[test]
    fn hard_edges_are_found_and_softened() {
        let (positions, indices) = cube();
        let soft = Mesh::with_shared_normals(positions, indices, Averaging::Angle);
        let corners: Vec<Vec3> = soft.indices.iter().map(|&k| soft.positions[k as usize]).collect();
        let normals = corners.chunks_exact(3).flat_map(|t| [(t[1] - t[0]).cross(t[2] - t[0]).normalize(); 3]).collect();
        let order = (0..corners.len() as u32).collect();
        let hard = Mesh { positions: corners, normals, indices: order, ..Mesh::default() };
        assert!(has_hard_edges(&hard) && !has_hard_edges(&soft));
        for (softened, &index) in soft_normals(&hard).iter().zip(&soft.indices) {
            assert_eq!(*softened, soft.normals[index as usize]);
        }
        assert!(matches!(soft_normals(&soft), Cow::Borrowed(_)));
        // The built-ins' own averages stay unchanged, including those not weighted by angle and
        // seams that differ by rounding.
        for name in ["brilliant_plain", "brilliant_area", "prism_chain", "skin"] {
            assert!(!has_hard_edges(&crate::Scene::named(name).unwrap().objects[0].mesh), "{name}");
        }
    }
}
