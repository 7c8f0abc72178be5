//! The bound on what a file can make the loader allocate.

use super::error::GltfError;
use super::{MAX_EXPANSION, MAX_TRIANGLES};

/// What an object takes besides its mesh: its own size, two names of at most 65 characters, and six
/// allocations.
const OBJECT_BYTES: u64 = 1024;

/// What the meshes of a scene may still take. Asked before memory is taken.
#[derive(Debug)]
pub(super) struct Budget {
    file_bytes: u64,
    bytes: u64,
    triangles: u64,
    vertices: u64,
}

impl Budget {
    pub(super) fn new(file_bytes: u64) -> Self {
        Self {
            file_bytes,
            bytes: file_bytes.saturating_mul(MAX_EXPANSION),
            triangles: MAX_TRIANGLES,
            vertices: 3 * MAX_TRIANGLES,
        }
    }

    /// Takes what one object needs, before it is made. A vertex takes `vertex_bytes`.
    pub(super) fn take(&mut self, vertices: u64, vertex_bytes: usize, triangles: u64) -> Result<(), GltfError> {
        let left = self.triangles.checked_sub(triangles);
        self.triangles = left.ok_or(GltfError::TooManyTriangles)?;
        let left = self.vertices.checked_sub(vertices);
        self.vertices = left.ok_or(GltfError::TooManyTriangles)?;
        // No overflow: both numbers are within the bounds above by now.
        let bytes = vertices * vertex_bytes as u64 + triangles * 3 * 4 + OBJECT_BYTES;
        let left = self.bytes.checked_sub(bytes);
        self.bytes = left.ok_or(GltfError::Expansion { file_bytes: self.file_bytes })?;
        Ok(())
    }
}
