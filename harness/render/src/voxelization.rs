//! The recipe `voxelization`: a mesh on the device made voxels on the device, in every frame anew.

use crate::frame::{BindGroupId, Buffer, Builder, Executor, Frame, Pass, PipelineId, Workgroups};
use crate::record::Record;
use crate::shader::ShaderError;
use crate::voxel_grid::VoxelGrid;
use lapidary_gpu::GpuError;
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
#[derive(Clone, Debug)]
pub struct Voxelizer {
    cells: u32,
    vertices: u64,
    triangles: u64,
    /// Of each vertex, of each triangle, of those over many columns, of each row.
    kernels: [PipelineId; 4],
    grid: Buffer,
    beyond: Buffer,
    large: Buffer,
    corners: Buffer,
    /// A bit for each voxel that is filled: [`VoxelGrid::words_per_row`] words a row.
    pub matter: Buffer,
    /// The same for the voxels that the surface touches, where these are set too.
    pub surface: Option<Buffer>,
    /// Three counts, in the order of [`Status`].
    pub status: Buffer,
}

impl Voxelizer {
    /// For meshes of as many vertices and triangles as `mesh`, with the effects by the names of the recipe's overrides.
    ///
    /// # Errors
    /// Where the recipe is not valid.
    ///
    /// # Panics
    /// For more than [`MOST_TRIANGLES`].
    pub fn new(
        builder: &mut Builder<'_>,
        grid: VoxelGrid,
        mesh: &Mesh,
        effects: &[(&str, f64)],
    ) -> Result<Self, ShaderError> {
        let (vertices, triangles) = (mesh.positions.len() as u64, mesh.triangle_count() as u64);
        assert!(triangles <= MOST_TRIANGLES.into(), "{triangles} triangles");
        let source = lapidary_wgsl::recipe_source(RECIPE);
        let mut kernel = |entry| builder.compute_pipeline(RECIPE, &source, entry, effects);
        let kernels = [
            kernel("voxelization_vertices")?,
            kernel("voxelization_triangles")?,
            kernel("voxelization_large")?,
            kernel("voxelization_finish")?,
        ];
        let columns = u64::from(grid.cells) * u64::from(grid.cells);
        let bits = 4 * columns * u64::from(grid.words_per_row());
        let holds_surface = kernels.iter().any(|kernel| builder.binds(*kernel, 0, 4));
        let record = grid.fill(Record::new("VoxelizationGrid"));
        use wgpu::BufferUsages as Usage;
        let grid_buffer = builder.uniform("grid", record);
        let mut storage = |what, size| builder.buffer(what, size, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC);
        Ok(Self {
            cells: grid.cells,
            vertices,
            triangles,
            kernels,
            grid: grid_buffer,
            beyond: storage("columns crossed beyond", columns.div_ceil(32) * 4),
            // A list of none still has a place.
            large: storage("large triangles", 4 + 4 * triangles.max(1)),
            corners: storage("vertices in the grid", 12 * vertices.max(1)),
            matter: storage("matter", bits),
            surface: holds_surface.then(|| storage("surface voxels", bits)),
            status: storage("voxel counts", STATUS_BYTES),
        })
    }

    /// Makes voxels of the mesh as it is then: `positions` holds three floats a vertex, `indices` three words a triangle, all of the buffer.
    pub fn encode(&self, builder: &mut Builder<'_>, positions: Buffer, indices: Buffer) {
        for buffer in [self.matter, self.beyond, self.status].into_iter().chain(self.surface) {
            builder.clear(buffer);
        }
        // What the list held does not matter, only how much.
        builder.pass(Pass::Clear { buffer: self.large, bytes: 4 });
        if self.triangles == 0 {
            return;
        }
        let resources = [
            (0, self.grid.into()),
            (1, positions.into()),
            (2, indices.into()),
            (3, self.matter.into()),
            (5, self.beyond.into()),
            (6, self.large.into()),
            (7, self.status.into()),
            (8, self.corners.into()),
        ];
        let surface = self.surface.map(|surface| (4, surface.into()));
        let resources: Vec<_> = resources.into_iter().chain(surface).collect();
        let rows = self.cells * self.cells;
        let groups = |threads: u64| threads.div_ceil(WORKGROUP.into()).min(MOST_WORKGROUPS.into()) as u32;
        let workgroups = [groups(self.vertices), groups(self.triangles), LARGE_GROUPS, groups(rows.into())];
        let dispatch = |(kernel, workgroups): (PipelineId, u32)| {
            let group: Option<BindGroupId> = builder.bind(kernel, 0, &resources);
            builder.dispatch(kernel, vec![group], Workgroups::Count([workgroups, 1, 1]))
        };
        let dispatches = self.kernels.into_iter().zip(workgroups).map(dispatch).collect();
        builder.compute(RECIPE, dispatches, 1);
    }

    /// Bytes of its buffers.
    #[must_use]
    pub fn bytes(&self, frame: &Frame) -> u64 {
        let buffers = [self.grid, self.beyond, self.large, self.corners, self.matter, self.status];
        buffers.into_iter().chain(self.surface).map(|buffer| frame.buffer(buffer).bytes()).sum()
    }

    /// The counts of the last frame that was submitted. It waits for the device.
    ///
    /// # Errors
    /// Where the device does.
    pub fn status(&self, executor: &Executor<'_>) -> Result<Status, GpuError> {
        let words = executor.words(self.status)?;
        Ok(Status { solid: words[0], surface: words[1], odd_columns: words[2] })
    }
}
