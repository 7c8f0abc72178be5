//! The recipe `voxelization`: a mesh on the device made voxels on the device, in every frame anew.

use crate::cookbook;
use crate::dispatch::{self, DispatchError};
use crate::gpu::Gpu;
use crate::voxel_grid::VoxelGrid;
use lapidary_voxelization::VoxelizationGrid;
use std::borrow::Cow;

/// The recipe's name.
const RECIPE: &str = "voxelization";
/// Invocations of a workgroup.
const WORKGROUP: u32 = 64;
/// Workgroups that share the triangles over many columns.
const LARGE_GROUPS: u32 = 64;
/// The most triangles: as many workgroups as may stand in a line.
pub const MOST_TRIANGLES: u32 = 65_535 * WORKGROUP;
/// Bytes of the counts.
const STATUS_BYTES: u64 = 12;

/// What the last frame counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status {
    /// Voxels whose centre is inside.
    pub solid: u32,
    /// Voxels that the surface touches, whether their centre is inside or not.
    pub surface: u32,
    /// Columns along x that the mesh crosses an odd number of times: none where it is closed. They are not filled.
    pub odd_columns: u32,
}

impl From<VoxelGrid> for VoxelizationGrid {
    fn from(grid: VoxelGrid) -> Self {
        Self { origin: grid.origin, spacing: grid.spacing, cells: grid.cells }
    }
}

/// Pipelines and buffers for meshes of up to so many triangles in a grid of one size.
#[derive(Debug)]
pub struct Voxelizer<'gpu> {
    gpu: &'gpu Gpu,
    cells: u32,
    most_triangles: u32,
    layout: wgpu::BindGroupLayout,
    /// Of each triangle, of those over many columns, of each row.
    pipelines: [wgpu::ComputePipeline; 3],
    grid: wgpu::Buffer,
    beyond: wgpu::Buffer,
    large: wgpu::Buffer,
    /// A bit for each voxel that is filled: [`VoxelGrid::words_per_row`] words a row.
    pub matter: wgpu::Buffer,
    /// The same for the voxels that the surface touches.
    pub surface: wgpu::Buffer,
    /// Three counts, in the order of [`Status`].
    pub status: wgpu::Buffer,
}

impl<'gpu> Voxelizer<'gpu> {
    /// For meshes of up to `most_triangles`, with the effects by the names of the recipe's overrides.
    ///
    /// # Errors
    /// Where the device refuses the recipe or the memory.
    ///
    /// # Panics
    /// For more than [`MOST_TRIANGLES`].
    pub fn new(
        gpu: &'gpu Gpu,
        grid: VoxelGrid,
        most_triangles: u32,
        effects: &[(&str, f64)],
    ) -> Result<Self, DispatchError> {
        assert!(most_triangles <= MOST_TRIANGLES, "{most_triangles} triangles");
        let (module, _) = dispatch::parse(&cookbook::recipe_source(RECIPE), &format!("recipe {RECIPE}"))?;
        let constants = dispatch::declared(&module, effects);
        let columns = u64::from(grid.cells) * u64::from(grid.cells);
        let bits = 4 * columns * u64::from(grid.words_per_row());
        let voxelizer = gpu.guarded(&format!("compiling recipe `{RECIPE}`"), |device| {
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(RECIPE),
                source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
            });
            let layout = layout(device);
            let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(RECIPE),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            });
            let pipelines = ["voxelization_triangles", "voxelization_large", "voxelization_finish"].map(|entry| {
                device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some(entry),
                    layout: Some(&pipeline_layout),
                    module: &module,
                    entry_point: Some(entry),
                    compilation_options: wgpu::PipelineCompilationOptions {
                        constants: &constants,
                        ..Default::default()
                    },
                    cache: None,
                })
            });
            use wgpu::BufferUsages as Usage;
            let buffer = |size, usage| {
                let descriptor = wgpu::BufferDescriptor { label: Some(RECIPE), size, usage, mapped_at_creation: false };
                device.create_buffer(&descriptor)
            };
            let storage = |size| buffer(size, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC);
            Self {
                gpu,
                cells: grid.cells,
                most_triangles,
                layout,
                pipelines,
                grid: buffer(32, Usage::UNIFORM | Usage::COPY_DST),
                beyond: storage(columns.div_ceil(32) * 4),
                // A list of none still has a place.
                large: storage(4 + 4 * u64::from(most_triangles.max(1))),
                matter: storage(bits),
                surface: storage(bits),
                status: storage(STATUS_BYTES),
            }
        })?;
        gpu.queue.write_buffer(&voxelizer.grid, 0, bytemuck::cast_slice(&grid.words()));
        Ok(voxelizer)
    }

    /// Makes voxels of the mesh as it is then: `positions` holds three floats a vertex, `indices` three words a triangle, all of the buffer.
    ///
    /// # Errors
    /// Where the device refuses the buffers.
    ///
    /// # Panics
    /// Where there are more triangles than this was made for.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        positions: &wgpu::Buffer,
        indices: &wgpu::Buffer,
    ) -> Result<(), DispatchError> {
        let triangles = indices.size() / 12;
        assert!(triangles <= u64::from(self.most_triangles), "{triangles} triangles");
        for buffer in [&self.matter, &self.surface, &self.beyond, &self.status] {
            encoder.clear_buffer(buffer, 0, None);
        }
        // What the list held does not matter, only how much.
        encoder.clear_buffer(&self.large, 0, Some(4));
        if triangles == 0 {
            return Ok(());
        }
        self.gpu.guarded("making voxels of a mesh", |device| {
            let [grid, matter] = [&self.grid, &self.matter];
            let buffers = [grid, positions, indices, matter, &self.surface, &self.beyond, &self.large, &self.status];
            let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
                .zip(buffers)
                .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                .collect();
            let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(RECIPE),
                layout: &self.layout,
                entries: &entries,
            });
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            let rows = self.cells * self.cells;
            let workgroups = [(triangles as u32).div_ceil(WORKGROUP), LARGE_GROUPS, rows.div_ceil(WORKGROUP)];
            for (pipeline, workgroups) in self.pipelines.iter().zip(workgroups) {
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, &group, &[]);
                pass.dispatch_workgroups(workgroups, 1, 1);
            }
        })?;
        Ok(())
    }

    /// Bytes of its buffers.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let buffers = [&self.grid, &self.beyond, &self.large, &self.matter, &self.surface, &self.status];
        buffers.into_iter().map(wgpu::Buffer::size).sum()
    }

    /// The counts of the last frame that was submitted. It waits for the device.
    ///
    /// # Errors
    /// Where the device does.
    pub fn status(&self) -> Result<Status, DispatchError> {
        let words = self.gpu.words(&self.status)?;
        Ok(Status { solid: words[0], surface: words[1], odd_columns: words[2] })
    }
}

/// One for all three kernels, so that one bind group serves them.
fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding: u32| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: match binding {
                0 => wgpu::BufferBindingType::Uniform,
                1 | 2 => wgpu::BufferBindingType::Storage { read_only: true },
                _ => wgpu::BufferBindingType::Storage { read_only: false },
            },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    let entries: Vec<wgpu::BindGroupLayoutEntry> = (0..8).map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(RECIPE), entries: &entries })
}
