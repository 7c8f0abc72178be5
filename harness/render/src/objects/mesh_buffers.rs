//! Meshes in a frame, as the recipes for bodies read them.

use crate::error::RenderError;
use crate::frame::{Buffer, Builder};
use lapidary_scene::Object;
use std::cell::RefCell;
use std::collections::HashMap;

/// Returns how many vertices draw a mesh of these `indices`, whose `parts` are storage buffers.
///
/// # Errors
/// If one of the parts is beyond the limits that every device offers.
pub(crate) fn vertices<'a>(
    object: &Object,
    indices: &[u32],
    parts: impl IntoIterator<Item = &'a [u8]>,
) -> Result<u32, RenderError> {
    let what = || format!("mesh `{}`", object.name);
    for part in parts {
        RenderError::unless_bound(part.len() as u64, what)?;
    }
    u32::try_from(indices.len()).map_err(|_| RenderError::too_large(size_of_val(indices) as u64, what()))
}

/// A mesh's positions and indices: all that keeps light from others.
#[derive(Clone, Copy)]
pub(crate) struct ShapeBuffers {
    /// Three floats per vertex.
    pub(crate) positions: Buffer,
    /// Three words per triangle.
    pub(crate) indices: Buffer,
    /// Number of vertices that draw it.
    pub(crate) vertices: u32,
}

impl ShapeBuffers {
    /// Adds the mesh of the current object.
    ///
    /// # Errors
    /// If one of its parts is beyond the limits that every device offers.
    pub(crate) fn of(builder: &mut Builder<'_>, object: &Object) -> Result<Self, RenderError> {
        let mesh = &object.mesh;
        let parts: [(&str, &[u8]); 2] =
            [("positions", bytemuck::cast_slice(&mesh.positions)), ("indices", bytemuck::cast_slice(&mesh.indices))];
        let vertices = vertices(object, &mesh.indices, parts.map(|(_, contents)| contents))?;
        let [positions, indices] = parts.map(|(what, contents)| builder.storage(what, contents));
        Ok(Self { positions, indices, vertices })
    }
}

/// The positions and indices of bodies, each added to the frame once, for whoever asks first.
#[derive(Default)]
pub(crate) struct Shapes(RefCell<HashMap<String, ShapeBuffers>>);

impl Shapes {
    /// Returns the buffers of a body with this unique name.
    ///
    /// # Errors
    /// If one of its parts is beyond the limits that every device offers.
    pub(crate) fn of(
        &self,
        builder: &mut Builder<'_>,
        name: &str,
        object: &Object,
    ) -> Result<ShapeBuffers, RenderError> {
        if let Some(known) = self.0.borrow().get(name) {
            return Ok(*known);
        }
        let made = builder.of_object(name, |builder| ShapeBuffers::of(builder, object))?;
        self.0.borrow_mut().insert(name.to_owned(), made);
        Ok(made)
    }
}

/// A mesh's positions, indices and normals.
#[derive(Clone, Copy)]
pub(crate) struct MeshBuffers {
    pub(crate) shape: ShapeBuffers,
    /// Three floats per vertex.
    pub(crate) normals: Buffer,
}

impl MeshBuffers {
    /// Adds the normals of the current object to its shape.
    ///
    /// # Errors
    /// If there are more normals than every device takes.
    pub(crate) fn of(builder: &mut Builder<'_>, shape: ShapeBuffers, object: &Object) -> Result<Self, RenderError> {
        let normals = bytemuck::cast_slice(&object.mesh.normals);
        vertices(object, &object.mesh.indices, [normals])?;
        Ok(Self { shape, normals: builder.storage("normals", normals) })
    }
}
