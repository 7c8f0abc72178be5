//! A solver by itself.

use super::passes::{Solve, Solved, Solver};
use super::status::Status;
use crate::frame::shader::ShaderError;
use crate::frame::{Builder, Executor};
use crate::volume::voxel_grid::VoxelGrid;
use lapidary_gpu::{Gpu, GpuError};

/// A solver in a frame of its own, for bodies that are uploaded one after another.
#[derive(Debug)]
pub struct LoneSolver<'gpu> {
    executor: Executor<'gpu>,
    solved: Solved,
}

impl<'gpu> LoneSolver<'gpu> {
    /// Creates a solver for bodies of this extinction; `source` is another text of the method's
    /// recipe, if any.
    ///
    /// # Errors
    /// If the device refuses the text or the memory.
    pub fn new(
        gpu: &'gpu Gpu,
        grid: VoxelGrid,
        solve: Solve,
        extinction: f32,
        source: Option<&str>,
    ) -> Result<Self, ShaderError> {
        let mut builder = Builder::new(Some(gpu));
        let solver = match source {
            Some(source) => Solver::of_source(&mut builder, grid, solve, source)?,
            None => Solver::new(&mut builder, grid, solve)?,
        };
        use wgpu::BufferUsages as Usage;
        let mut buffer = |what: &str, words: u64| {
            builder.buffer(what, 4 * words, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC)
        };
        let (rows, voxels) = (u64::from(grid.cells) * u64::from(grid.cells), grid.count() as u64);
        let matter = buffer("matter", rows * u64::from(grid.words_per_row()));
        let density = solve.heterogeneous.then(|| buffer("densities", voxels));
        let cost = buffer("costs", voxels);
        let solved = Solved { matter, density, cost, extinction, kept: Solver::kept(&mut builder) };
        solver.encode(&mut builder, &solved);
        Ok(Self { executor: Executor::new(gpu, builder.finish())?, solved })
    }

    /// Sets the body: one bit per voxel and, if the solver is heterogeneous, one density per voxel.
    ///
    /// # Errors
    /// If a list does not have the grid's length.
    pub fn set_body(&self, matter: &[u32], density: &[f32]) -> Result<(), GpuError> {
        self.executor.write_buffer(self.solved.matter, bytemuck::cast_slice(matter))?;
        match self.solved.density {
            Some(buffer) => self.executor.write_buffer(buffer, bytemuck::cast_slice(density)),
            None => Ok(()),
        }
    }

    /// Sets the seeds: one cost per voxel, unreached where there is no seed.
    ///
    /// # Errors
    /// If the list does not have the grid's length.
    pub fn set_seeds(&self, seeds: &[f32]) -> Result<(), GpuError> {
        self.executor.write_buffer(self.solved.cost, bytemuck::cast_slice(seeds))
    }

    /// Solves from the seeds, without waiting.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn run(&self) -> Result<(), GpuError> {
        self.executor.run(|_, _| {})
    }

    /// Returns the current costs. Waits for them.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn costs(&self) -> Result<Vec<f32>, GpuError> {
        Ok(self.executor.words(self.solved.cost)?.into_iter().map(f32::from_bits).collect())
    }

    /// Returns how far the last solve got. Waits for it.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn status(&self) -> Result<Status, GpuError> {
        Status::read(&self.executor, self.solved.kept)
    }
}
