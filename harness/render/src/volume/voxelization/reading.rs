//! Voxels and their counts, read back from the device.

use super::voxelizer::Voxelizer;
use crate::frame::shader::ShaderError;
use crate::frame::{Builder, Executor};
use crate::volume::voxel_grid::VoxelGrid;
use lapidary_gpu::{Gpu, GpuError};
use lapidary_plan::Note;
use lapidary_scene::Mesh;

/// The counts of the last frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status {
    /// Voxels whose centre is inside.
    pub solid: u32,
    /// Voxels that the surface touches, whether or not their centre is inside.
    pub surface: u32,
    /// Columns along x that the mesh crosses an odd number of times: none if it is closed. They are
    /// not filled.
    pub odd_columns: u32,
}

impl Voxelizer {
    /// Returns the note on a mesh that is open, by the counts of the last frame; `object` is its name.
    /// Waits for the device.
    ///
    /// # Errors
    /// If reading from the device fails.
    pub fn note(&self, executor: &Executor<'_>, object: &str) -> Result<Option<Note>, GpuError> {
        let odd_columns = self.status(executor)?.odd_columns;
        let columns = self.cells * self.cells;
        Ok((odd_columns > 0).then(|| Note::Open { object: object.to_owned(), odd_columns, columns }))
    }

    /// Returns the counts of the last frame that was submitted. Waits for the device.
    ///
    /// # Errors
    /// If reading from the device fails.
    pub fn status(&self, executor: &Executor<'_>) -> Result<Status, GpuError> {
        let words = executor.words(self.status)?;
        Ok(Status { solid: words[0], surface: words[1], odd_columns: words[2] })
    }
}

/// Returns the words of the voxels that a mesh fills, computed in a frame of its own.
///
/// # Errors
/// If the recipe is invalid or the device rejects it.
pub fn matter(gpu: &Gpu, grid: VoxelGrid, mesh: &Mesh, effects: &[(&str, f64)]) -> Result<Vec<u32>, ShaderError> {
    let mut builder = Builder::new(Some(gpu));
    let voxelizer = Voxelizer::new(&mut builder, grid, mesh, effects)?;
    let positions = builder.storage("positions", bytemuck::cast_slice(&mesh.positions));
    let indices = builder.storage("indices", bytemuck::cast_slice(&mesh.indices));
    voxelizer.encode(&mut builder, positions, indices);
    let executor = Executor::new(gpu, builder.finish())?;
    executor.run(|_, _| {})?;
    Ok(executor.words(voxelizer.matter)?)
}
