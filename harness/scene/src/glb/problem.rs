//! What glTF cannot say of a body.

use crate::{Density, Material, Mesh};

/// Returns the first problem that keeps an object from being written as glTF, or `None`.
pub(super) fn of(mesh: &Mesh, material: &Material) -> Option<&'static str> {
    let vertices = mesh.positions.len();
    let in_range = |&index: &u32| (index as usize) < vertices;
    if mesh.indices.is_empty() {
        Some("it has no triangles; remove the object")
    } else if !mesh.indices.len().is_multiple_of(3) {
        Some("its number of indices is not a multiple of three; complete the last triangle")
    } else if mesh.normals.len() != vertices {
        Some("it has not one normal for each position; compute them again")
    } else if !mesh.uvs.is_empty() && mesh.uvs.len() != vertices {
        Some("it has neither one pair of texture coordinates for each position nor none; compute them again")
    } else if !mesh.indices.iter().chain(&mesh.halo).all(in_range) {
        Some("an index is past its last vertex; mend the triangles")
    } else if !mesh.positions.iter().chain(&mesh.normals).all(|v| v.is_finite()) {
        Some("a position or normal is not finite; mend or remove the vertex")
    } else if !mesh.uvs.iter().all(|uv| uv.is_finite()) {
        Some("a texture coordinate is not finite; mend it")
    } else if !mesh.colors.is_empty() && mesh.colors.len() != vertices {
        Some("it has neither one colour for each position nor none; compute them again")
    } else if !mesh.colors.iter().flat_map(|color| color.to_array()).all(|part| (0.0..=1.0).contains(&part)) {
        Some("a vertex colour has a part outside 0 to 1; mend it")
    } else if mesh.uvs.is_empty() && material.textures().count() > 0 {
        Some("its material has textures, but the mesh no texture coordinates; give it some or remove the textures")
    } else if material.medium.as_ref().is_some_and(|medium| matches!(medium.density, Density::Grid(_))) {
        Some("its density is a grid, which a file has no place for; make it uniform or veined")
    } else {
        material.problem()
    }
}
