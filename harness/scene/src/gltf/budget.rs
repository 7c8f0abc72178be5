//! The bound on what a file can make the loader allocate.

use super::error::GltfError;
use super::{MAX_OBJECTS, MAX_SCENE_BYTES, MAX_TRIANGLES};

/// What an object takes besides its mesh: its own size, two names of at most 65 characters, and six
/// allocations.
const OBJECT_BYTES: u64 = 1024;

/// What the meshes of a scene may still take. Asked before memory is taken.
#[derive(Debug)]
pub(super) struct Budget {
    bytes: u64,
    triangles: u64,
    vertices: u64,
    objects: u64,
    passed_over: u64,
}

impl Budget {
    pub(super) fn new() -> Self {
        Self {
            bytes: MAX_SCENE_BYTES,
            triangles: MAX_TRIANGLES,
            vertices: 3 * MAX_TRIANGLES,
            objects: MAX_OBJECTS,
            passed_over: MAX_TRIANGLES,
        }
    }

    /// Takes what `objects` objects need together, before they are made. A vertex takes `vertex_bytes`.
    pub(super) fn take(
        &mut self,
        objects: u64,
        vertices: u64,
        vertex_bytes: usize,
        triangles: u64,
    ) -> Result<(), GltfError> {
        self.triangles = self.triangles.checked_sub(triangles).ok_or(GltfError::TooManyTriangles)?;
        self.vertices = self.vertices.checked_sub(vertices).ok_or(GltfError::TooManyTriangles)?;
        self.objects = self.objects.checked_sub(objects).ok_or(GltfError::TooManyObjects)?;
        // No overflow: all numbers are within the bounds above by now.
        let bytes = vertices * vertex_bytes as u64 + triangles * 3 * 4 + objects * OBJECT_BYTES;
        self.bytes = self.bytes.checked_sub(bytes).ok_or(GltfError::TooMuchMemory)?;
        Ok(())
    }

    /// Counts a primitive that is not drawn: it takes time, and a small file may show it very often.
    pub(super) fn pass_over(&mut self) -> Result<(), GltfError> {
        self.passed_over = self.passed_over.checked_sub(1).ok_or(GltfError::TooManyObjects)?;
        Ok(())
    }
}
