//! Meshes in a frame, as the recipes for bodies read them.

use super::RenderError;
use crate::frame::{Buffer, Builder};
use lapidary_scene::Object;

/// Returns how many vertices draw a mesh of these `indices`, whose `parts` are storage buffers.
///
/// # Errors
/// If one of the parts is beyond the limits that every device offers.
pub(super) fn vertices<'a>(
    object: &Object,
    indices: &[u32],
    parts: impl IntoIterator<Item = &'a [u8]>,
) -> Result<u32, RenderError> {
    let limits = wgpu::Limits::default();
    let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    let too_large = |bytes: u64| RenderError::TooLarge { what: format!("mesh `{}`", object.name), bytes, limit };
    if let Some(bytes) = parts.into_iter().map(|part| part.len() as u64).find(|bytes| *bytes > limit) {
        return Err(too_large(bytes));
    }
    u32::try_from(indices.len()).map_err(|_| too_large(size_of_val(indices) as u64))
}

/// A mesh's positions, indices and normals.
#[derive(Clone, Copy)]
pub(super) struct MeshBuffers {
    /// Three floats per vertex.
    pub(super) positions: Buffer,
    /// Three words per triangle.
    pub(super) indices: Buffer,
    /// Three floats per vertex.
    pub(super) normals: Buffer,
    /// Number of vertices that draw it.
    pub(super) vertices: u32,
}

impl MeshBuffers {
    /// Adds the mesh of the current object.
    ///
    /// # Errors
    /// If one of its parts is beyond the limits that every device offers.
    pub(super) fn of(builder: &mut Builder<'_>, object: &Object) -> Result<Self, RenderError> {
        let mesh = &object.mesh;
        let parts: [(&str, &[u8]); 3] = [
            ("positions", bytemuck::cast_slice(&mesh.positions)),
            ("indices", bytemuck::cast_slice(&mesh.indices)),
            ("normals", bytemuck::cast_slice(&mesh.normals)),
        ];
        let vertices = vertices(object, &mesh.indices, parts.map(|(_, contents)| contents))?;
        let [positions, indices, normals] = parts.map(|(what, contents)| builder.storage(what, contents));
        Ok(Self { positions, indices, normals, vertices })
    }
}
