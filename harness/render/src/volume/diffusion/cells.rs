//! The recipe `diffusion_cells`: a body as cells, from voxels of half the spacing and from its mesh.

use super::matter::Matter;
use super::tiles::{self, Tiles};
use crate::frame::record::Record;
use crate::frame::shader::ShaderError;
use crate::frame::{Bound, Buffer, Builder, Dispatch, Frame, Pass, Workgroups};
use crate::objects::mesh_buffers::ShapeBuffers;
use crate::volume::voxel_grid::VoxelGrid;
use crate::volume::voxelization::Voxelizer;
use glam::Vec3;
use lapidary_plan::Effect;
use lapidary_scene::{Material, Mesh};

const RECIPE: &str = "diffusion_cells";
/// Invocations of a workgroup.
const GROUP: u32 = 64;
/// Upper limit of a cell's loss by absorption, so that sums over cells stay finite.
const MOST_ABSORBED: f32 = 1e12;
/// Workgroups that share the large triangles.
const LARGE_GROUPS: u32 = 32;

/// Pipelines and buffers for a body's cells.
pub(super) struct Cells {
    pub(super) voxelizer: Voxelizer,
    mesh: ShapeBuffers,
    /// Which eighths of each voxel are filled, and the node's depth: a word for each voxel.
    pub(super) nodes: Buffer,
    /// Conductances to the next voxels: three f32 for each voxel.
    pub(super) faces: Buffer,
    /// Losses in each channel, and the filled volume: four f32 for each voxel.
    pub(super) reactions: Buffer,
    /// What the light from all around adds to the right side: three f32 for each voxel; `None` if none
    /// enters.
    pub(super) entering: Option<Buffer>,
    /// Tiles that hold matter.
    pub(super) tiles: Tiles,
    large: Buffer,
    /// Buffers that begin as 0 in each frame.
    cleared: Vec<Buffer>,
    /// Buffers that only this recipe reads.
    scratch: Vec<Buffer>,
    dispatches: Vec<Dispatch>,
}

/// What a body is made of, and the light around it.
#[derive(Clone, Copy)]
pub(super) struct Body<'a> {
    pub(super) matter: Matter,
    pub(super) material: &'a Material,
    /// Irradiance that counts as 1, for each channel.
    pub(super) largest: Vec3,
    /// The environment's harmonics; `None` if it is left out.
    pub(super) harmonics: Option<Buffer>,
}

impl Cells {
    /// Creates the pipelines and buffers; `constants` are values of the recipe's overrides.
    pub(super) fn new(
        builder: &mut Builder<'_>,
        grid: VoxelGrid,
        (shape, mesh): (&Mesh, &ShapeBuffers),
        constants: &[(&str, f64)],
        Body { matter, material, largest, harmonics }: Body<'_>,
        (tiles, density): (Tiles, Option<Buffer>),
    ) -> Result<Self, ShaderError> {
        let fine = VoxelGrid { cells: 2 * grid.cells, spacing: 0.5 * grid.spacing, ..grid };
        let voxelizer = Voxelizer::new(builder, fine, shape, constants)?;
        let source = lapidary_wgsl::recipe_source(RECIPE);
        let mut kernel =
            |entry: &str| builder.compute_pipeline(RECIPE, &source, &format!("{RECIPE}_{entry}"), constants);
        let kernels = [kernel("fill")?, kernel("list")?, kernel("surface")?, kernel("large")?, kernel("finish")?];
        use wgpu::BufferUsages as Usage;
        let (voxels, triangles) = (grid.count() as u64, shape.triangle_count() as u64);
        let mut storage = |what, bytes| builder.buffer(what, bytes, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC);
        let filled = storage("filled eighths", 4 * voxels);
        let surfaces = storage("surfaces in voxels", 8 * voxels);
        let large = storage("large triangles of cells", 4 + 4 * triangles.max(1));
        let nodes = storage("nodes", 4 * voxels);
        let faces = storage("conductances", 12 * voxels);
        let reactions = storage("losses", 16 * voxels);
        let name = Effect::Environment.override_name();
        let is_lit = constants.iter().any(|(constant, value)| *constant == name && *value != 0.0);
        let harmonics = harmonics.filter(|_| is_lit);
        let entering = harmonics.map(|_| storage("light that enters", 12 * voxels));
        let absorption = material.medium.as_ref().map_or(Vec3::ZERO, |medium| {
            let absorbed = 3.0 * (grid.spacing * medium.absorption) * (grid.spacing * medium.transport_extinction());
            absorbed.min(Vec3::splat(MOST_ABSORBED))
        });
        let record = Record::new("DiffusionCells").within("grid", |record| grid.fill(record));
        let record = record.with("milne", matter.milne()).with("absorption", absorption);
        let record = record.with("largest", unit(largest)).with("outside", 4.0 * matter.index * matter.index);
        let record = builder.uniform("cells", record);
        let bound = [
            (0, record),
            (1, mesh.positions),
            (2, mesh.indices),
            (4, tiles.list),
            (5, filled),
            (6, surfaces),
            (7, tiles.workgroups),
            (8, large),
            (9, nodes),
            (10, faces),
            (11, reactions),
            (13, voxelizer.matter),
        ];
        let of_choice = [(3, harmonics), (12, density), (14, entering)];
        let of_choice = of_choice.into_iter().filter_map(|(binding, buffer)| Some((binding, buffer?)));
        let resources: Vec<(u32, Bound)> =
            bound.into_iter().chain(of_choice).map(|(binding, buffer)| (binding, buffer.into())).collect();
        let words = grid.words_per_row() * grid.cells * grid.cells;
        let counts = [words, tiles::count(grid.cells), triangles as u32, LARGE_GROUPS * GROUP];
        let counts = counts.map(|count| Workgroups::Count([count.div_ceil(GROUP), 1, 1]));
        let dispatch = |(kernel, workgroups)| {
            let group = builder.bind(kernel, 0, &resources);
            builder.dispatch(kernel, vec![group], workgroups)
        };
        let dispatches =
            kernels.into_iter().zip(counts.into_iter().chain([tiles.dispatched()])).map(dispatch).collect();
        let cleared = [filled, surfaces, nodes, faces, reactions].into_iter().chain(entering).collect();
        let scratch = [filled, surfaces, large].into_iter().chain(tiles.buffers()).chain(entering).collect();
        Ok(Self {
            voxelizer,
            mesh: *mesh,
            nodes,
            faces,
            reactions,
            entering,
            tiles,
            large,
            cleared,
            scratch,
            dispatches,
        })
    }

    /// Encodes the voxels, and which tiles hold matter.
    pub(super) fn encode_voxels(&self, builder: &mut Builder<'_>) {
        for buffer in &self.cleared {
            builder.clear(*buffer);
        }
        self.voxelizer.encode(builder, self.mesh.positions, self.mesh.indices);
        self.tiles.encode_none(builder);
        builder.compute(RECIPE, self.dispatches[..2].to_vec(), 1);
    }

    /// Encodes the rest, once the densities are known.
    pub(super) fn encode(&self, builder: &mut Builder<'_>) {
        // Only the list's length must be reset, not its contents.
        builder.pass(Pass::Clear { buffer: self.large, bytes: 4 });
        builder.compute(RECIPE, self.dispatches[2..].to_vec(), 1);
    }

    /// Size of the buffers in bytes.
    pub(super) fn bytes(&self, frame: &Frame) -> u64 {
        let shared = [self.nodes, self.faces, self.reactions];
        self.voxelizer.bytes(frame) + frame.bytes_of(shared) + frame.bytes_of(self.scratch.iter().copied())
    }
}

/// Returns the irradiance that counts as 1 so that shares of it are finite.
pub(super) fn unit(largest: Vec3) -> Vec3 {
    largest.max(Vec3::splat(f32::MIN_POSITIVE))
}
