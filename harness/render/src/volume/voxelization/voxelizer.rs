//! The recipe `voxelize`: its pipelines, buffers and passes.

use crate::frame::record::Record;
use crate::frame::shader::ShaderError;
use crate::frame::{BindGroupId, Buffer, Builder, Frame, Pass, PipelineId, Workgroups};
use crate::volume::voxel_grid::VoxelGrid;
use lapidary_scene::Mesh;
use lapidary_voxelization::VoxelizationGrid;

/// Name of the recipe.
const RECIPE: &str = "voxelize";
/// Invocations of a workgroup.
const WORKGROUP: u32 = 64;
/// Workgroups that share the triangles over many columns.
const LARGE_GROUPS: u32 = 64;
/// Maximum number of workgroups in one dimension.
const MOST_WORKGROUPS: u32 = 65_535;
/// Maximum number of triangles: one thread each.
pub const MOST_TRIANGLES: u32 = MOST_WORKGROUPS * WORKGROUP;
/// Size of the counts in bytes.
const STATUS_BYTES: u64 = 12;

impl From<VoxelGrid> for VoxelizationGrid {
    fn from(grid: VoxelGrid) -> Self {
        Self { origin: grid.origin, spacing: grid.spacing, cells: grid.cells }
    }
}

/// Pipelines and buffers for a mesh that may move, in a grid of one size.
#[derive(Clone, Debug)]
pub struct Voxelizer {
    pub(super) cells: u32,
    vertices: u64,
    triangles: u64,
    /// Pipelines over the vertices, the triangles, the triangles over many columns, and the rows.
    kernels: [PipelineId; 4],
    grid: Buffer,
    beyond: Buffer,
    large: Buffer,
    corners: Buffer,
    /// One bit per voxel, set if it is filled: [`VoxelGrid::words_per_row`] words per row.
    pub matter: Buffer,
    /// One bit per voxel, set if the surface touches it; `None` if the effects leave these voxels
    /// out.
    pub surface: Option<Buffer>,
    /// Three counts, in the order of [`Status`](super::Status).
    pub status: Buffer,
}

impl Voxelizer {
    /// Creates the pipelines and buffers for meshes with as many vertices and triangles as `mesh`;
    /// `effects` are values for the recipe's overrides, by name.
    ///
    /// # Errors
    /// If the recipe is not valid.
    ///
    /// # Panics
    /// If the mesh has more than [`MOST_TRIANGLES`].
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
            kernel("voxelize_vertices")?,
            kernel("voxelize_triangles")?,
            kernel("voxelize_large")?,
            kernel("voxelize_finish")?,
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
            // Even an empty list has one entry.
            large: storage("large triangles", 4 + 4 * triangles.max(1)),
            corners: storage("vertices in the grid", 12 * vertices.max(1)),
            matter: storage("matter", bits),
            surface: holds_surface.then(|| storage("surface voxels", bits)),
            status: storage("voxel counts", STATUS_BYTES),
        })
    }

    /// Voxelizes the mesh as it is when the frame runs: the whole of `positions` is read as three
    /// floats per vertex, the whole of `indices` as three words per triangle.
    pub fn encode(&self, builder: &mut Builder<'_>, positions: Buffer, indices: Buffer) {
        for buffer in [self.matter, self.beyond, self.status].into_iter().chain(self.surface) {
            builder.clear(buffer);
        }
        // Only the list's length must be reset, not its contents.
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

    /// Size of the buffers in bytes.
    #[must_use]
    pub fn bytes(&self, frame: &Frame) -> u64 {
        let buffers = [self.grid, self.beyond, self.large, self.corners, self.matter, self.status];
        frame.bytes_of(buffers.into_iter().chain(self.surface))
    }
}
