//! Bounds on what a file can make the loader allocate.

use crate::Texels;

use super::error::GltfError;
use super::limits::{MAX_IMAGE_BYTES, MAX_OBJECTS, MAX_SCENE_BYTES, MAX_TRIANGLES};

/// Memory for an object, its mesh excluded: the struct itself, two names of at most 65 characters,
/// and six allocations.
const OBJECT_BYTES: u64 = 1024;

/// Remaining allowance for the meshes of a scene. Checked before memory is allocated.
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

    /// Reserves the memory for `objects` objects together, before they are built. A vertex takes
    /// `vertex_bytes`.
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
        // No overflow: by now all numbers are within the bounds above.
        let bytes = vertices * vertex_bytes as u64 + triangles * 3 * 4 + objects * OBJECT_BYTES;
        self.bytes = self.bytes.checked_sub(bytes).ok_or(GltfError::TooMuchMemory)?;
        Ok(())
    }

    /// Counts a primitive that is not drawn: it takes time, and a small file may refer to it very
    /// often.
    pub(super) fn pass_over(&mut self) -> Result<(), GltfError> {
        self.passed_over = self.passed_over.checked_sub(1).ok_or(GltfError::TooManyObjects)?;
        Ok(())
    }
}

/// Remaining allowance for the decoded images of a scene. Checked before an image is decoded.
#[derive(Debug)]
pub(super) struct ImageBudget {
    bytes: u64,
}

impl ImageBudget {
    pub(super) fn new() -> Self {
        Self { bytes: MAX_IMAGE_BYTES }
    }

    /// Reserves the memory for an image of this size.
    pub(super) fn take(&mut self, [width, height]: [u32; 2]) -> Result<(), String> {
        let side = Texels::LARGEST_SIDE;
        if width > side || height > side {
            return Err(format!(
                "it has {width} x {height} texels, but at most {side} on a side are read; scale it down"
            ));
        }
        let bytes = Texels::byte_size(width, height);
        self.bytes = self.bytes.checked_sub(bytes).ok_or_else(|| {
            let mib = |bytes: u64| bytes.div_ceil(1 << 20);
            format!(
                "its {width} x {height} texels and the images before it take {} MiB, but at most {} MiB are read; scale \
                 them down",
                mib(MAX_IMAGE_BYTES - self.bytes + bytes),
                mib(MAX_IMAGE_BYTES)
            )
        })?;
        Ok(())
    }
}
