//! The recipe `voxelization`: a mesh on the device made voxels on the device, in every frame anew.

use crate::compute::Kernel;
use crate::shader::ShaderError;
use crate::voxel_grid::VoxelGrid;
use lapidary_gpu::{Encoder, Gpu};
use lapidary_scene::Mesh;
use lapidary_voxelization::VoxelizationGrid;

/// The recipe's name.
const RECIPE: &str = "voxelization";
/// Invocations of a workgroup.
const WORKGROUP: u32 = 64;
/// Workgroups that share the triangles over many columns.
const LARGE_GROUPS: u32 = 64;
/// The most workgroups that may stand in a line.
const MOST_WORKGROUPS: u32 = 65_535;
/// The most triangles: a thread each.
pub const MOST_TRIANGLES: u32 = MOST_WORKGROUPS * WORKGROUP;
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

/// Pipelines and buffers for a mesh that may move, in a grid of one size.
#[derive(Debug)]
pub struct Voxelizer<'gpu> {
    gpu: &'gpu Gpu,
    cells: u32,
    most_triangles: u64,
    /// Of each vertex, of each triangle, of those over many columns, of each row.
    kernels: [Kernel; 4],
    grid: wgpu::Buffer,
    beyond: wgpu::Buffer,
    large: wgpu::Buffer,
    corners: wgpu::Buffer,
    /// A bit for each voxel that is filled: [`VoxelGrid::words_per_row`] words a row.
    pub matter: wgpu::Buffer,
    /// The same for the voxels that the surface touches, where these are set too.
    pub surface: Option<wgpu::Buffer>,
    /// Three counts, in the order of [`Status`].
    pub status: wgpu::Buffer,
}

impl<'gpu> Voxelizer<'gpu> {
    /// For meshes of up to as many vertices and triangles as `mesh`, with the effects by the names of the recipe's overrides.
    ///
    /// # Errors
    /// Where the device refuses the recipe or the memory.
    ///
    /// # Panics
    /// For more than [`MOST_TRIANGLES`].
    pub fn new(gpu: &'gpu Gpu, grid: VoxelGrid, mesh: &Mesh, effects: &[(&str, f64)]) -> Result<Self, ShaderError> {
        let (vertices, triangles) = (mesh.positions.len(), mesh.triangle_count());
        assert!(triangles <= MOST_TRIANGLES as usize, "{triangles} triangles");
        let source = lapidary_wgsl::recipe_source(RECIPE);
        let kernel = |entry| Kernel::new(gpu, RECIPE, &source, entry, effects);
        let kernels = [
            kernel("voxelization_vertices")?,
            kernel("voxelization_triangles")?,
            kernel("voxelization_large")?,
            kernel("voxelization_finish")?,
        ];
        let columns = u64::from(grid.cells) * u64::from(grid.cells);
        let bits = 4 * columns * u64::from(grid.words_per_row());
        let holds_surface = kernels.iter().any(|kernel| kernel.binds(0, 4));
        let voxelizer = gpu.guarded("allocating voxels", |device| {
            use wgpu::BufferUsages as Usage;
            let buffer = |what, size, usage| {
                let descriptor = wgpu::BufferDescriptor { label: Some(what), size, usage, mapped_at_creation: false };
                device.create_buffer(&descriptor)
            };
            let storage = |what, size| buffer(what, size, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC);
            Self {
                gpu,
                cells: grid.cells,
                most_triangles: triangles as u64,
                kernels,
                grid: buffer("grid", 32, Usage::UNIFORM | Usage::COPY_DST),
                beyond: storage("columns crossed beyond", columns.div_ceil(32) * 4),
                // A list of none still has a place.
                large: storage("large triangles", 4 + 4 * triangles.max(1) as u64),
                corners: storage("vertices in the grid", 12 * vertices.max(1) as u64),
                matter: storage("matter", bits),
                surface: holds_surface.then(|| storage("surface voxels", bits)),
                status: storage("voxel counts", STATUS_BYTES),
            }
        })?;
        gpu.queue.write_buffer(&voxelizer.grid, 0, &grid.bytes());
        Ok(voxelizer)
    }

    /// Makes voxels of the mesh as it is then: `positions` holds three floats a vertex, `indices` three words a triangle, all of the buffer.
    ///
    /// # Errors
    /// Where the device refuses the buffers.
    ///
    /// # Panics
    /// Where there are more vertices or triangles than this was made for.
    pub fn encode(
        &self,
        encoder: &mut Encoder,
        positions: &wgpu::Buffer,
        indices: &wgpu::Buffer,
    ) -> Result<(), ShaderError> {
        let [vertices, triangles] = [positions, indices].map(|buffer| buffer.size() / 12);
        assert!(triangles <= self.most_triangles, "{triangles} triangles");
        assert!(positions.size() <= self.corners.size(), "{vertices} vertices");
        for buffer in [&self.matter, &self.beyond, &self.status].into_iter().chain(&self.surface) {
            encoder.clear_buffer(buffer, 0, None);
        }
        // What the list held does not matter, only how much.
        encoder.clear_buffer(&self.large, 0, Some(4));
        if triangles == 0 {
            return Ok(());
        }
        self.gpu.guarded("making voxels of a mesh", |device| {
            let surface = self.surface.as_ref().map(|surface| (4, surface));
            let buffers = [
                (0, &self.grid),
                (1, positions),
                (2, indices),
                (3, &self.matter),
                (5, &self.beyond),
                (6, &self.large),
                (7, &self.status),
                (8, &self.corners),
            ];
            let resources: Vec<_> = buffers
                .into_iter()
                .chain(surface)
                .map(|(binding, buffer)| (binding, buffer.as_entire_binding()))
                .collect();
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(RECIPE),
                ..wgpu::ComputePassDescriptor::default()
            });
            let rows = self.cells * self.cells;
            let groups = |threads: u64| threads.div_ceil(WORKGROUP.into()).min(MOST_WORKGROUPS.into()) as u32;
            let workgroups = [groups(vertices), groups(triangles), LARGE_GROUPS, groups(rows.into())];
            for (kernel, workgroups) in self.kernels.iter().zip(workgroups) {
                pass.set_pipeline(&kernel.pipeline);
                pass.set_bind_group(0, kernel.bind(device, 0, &resources).as_ref());
                pass.dispatch_workgroups(workgroups, 1, 1);
            }
        })?;
        Ok(())
    }

    /// Bytes of its buffers.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let buffers = [&self.grid, &self.beyond, &self.large, &self.corners, &self.matter, &self.status];
        buffers.into_iter().chain(&self.surface).map(wgpu::Buffer::size).sum()
    }

    /// The counts of the last frame that was submitted. It waits for the device.
    ///
    /// # Errors
    /// Where the device does.
    pub fn status(&self) -> Result<Status, ShaderError> {
        let words = self.gpu.words(&self.status)?;
        Ok(Status { solid: words[0], surface: words[1], odd_columns: words[2] })
    }
}
