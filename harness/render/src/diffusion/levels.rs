//! The recipe `diffusion_solve`: grids, each half as fine as the one before, and the cycles over them.

use super::cells::Cells;
use crate::frame::{Bound, Buffer, Builder, Dispatch, Frame, Pass, PipelineId, Workgroups};
use crate::record::Record;
use crate::settings::DiffusionOptions;
use crate::shader::ShaderError;
use crate::voxel_grid::VoxelGrid;

const RECIPE: &str = "diffusion_solve";
/// Invocations of a workgroup of passes over all cells or tiles.
const GROUP: u32 = 64;
/// Cells along an edge of a tile.
const TILE: u32 = 4;
/// Sweeps over both colours before and after each correction.
const SWEEPS: usize = 2;

/// One grid's buffers.
struct Level {
    cells: u32,
    /// Tiles that hold matter, and their count as arguments of an indirect dispatch.
    tiles: Buffer,
    workgroups: Buffer,
    faces: Buffer,
    reactions: Buffer,
    fluence: Buffer,
    right: Buffer,
    /// The struct `DiffusionLevel` for either colour.
    records: [Buffer; 2],
}

/// All grids of a body, and the passes that solve its equations.
pub(super) struct Levels {
    levels: Vec<Level>,
    options: DiffusionOptions,
    /// What `workgroups` begins as.
    fresh: Buffer,
    /// Fluence, depth and volume of each voxel, for shading: eight bytes.
    pub(super) packed: Buffer,
    coarsen: Vec<Dispatch>,
    list: Vec<Dispatch>,
    /// The cycle from no light at all: on the coarser grids alone.
    first: Vec<Dispatch>,
    cycle: Vec<Dispatch>,
    pack: Dispatch,
}

impl Levels {
    /// Creates the pipelines and buffers.
    pub(super) fn new(
        builder: &mut Builder<'_>,
        grid: VoxelGrid,
        cells: &Cells,
        options: DiffusionOptions,
    ) -> Result<Self, ShaderError> {
        use wgpu::BufferUsages as Usage;
        let mut sides = vec![grid.cells];
        while let Some(side) = sides.last().copied().filter(|side| *side > 1) {
            sides.push(side.div_ceil(2));
        }
        let made: Vec<Level> = (0..sides.len()).map(|number| level(builder, &sides, number, cells)).collect();
        let fresh = bytemuck::cast_slice(&[0u32, 1, 1]).to_vec();
        let fresh = builder.filled("no tiles", fresh, Usage::COPY_SRC);
        let packed = builder.buffer("fluence to look up", 8 * grid.count() as u64, Usage::STORAGE | Usage::COPY_DST);
        let source = lapidary_wgsl::recipe_source(RECIPE);
        let mut kernel = |entry: &str| builder.compute_pipeline(RECIPE, &source, &format!("{RECIPE}_{entry}"), &[]);
        let kernels = Kernels {
            coarsen: kernel("coarsen")?,
            list: kernel("list")?,
            sweep: kernel("sweep")?,
            restrict: kernel("restrict")?,
            prolong: kernel("prolong")?,
            pack: kernel("pack")?,
        };
        let last = made.len() - 1;
        let coarsen = (1..=last).map(|number| {
            let finer = [(0, made[number - 1].faces.into()), (1, made[number - 1].reactions.into())];
            made[number].pass_over_all(builder, kernels.coarsen, &finer, made[number].cells.pow(3))
        });
        let coarsen = coarsen.collect();
        let list =
            made.iter().map(|level| level.pass_over_all(builder, kernels.list, &[], level.cells.div_ceil(TILE).pow(3)));
        let list = list.collect();
        let sweeps =
            |builder: &mut Builder<'_>, cycle: &mut Vec<Dispatch>, level: &Level, colors: [usize; 2], count| {
                for _ in 0..count {
                    cycle.extend(colors.map(|color| level.pass_over_tiles(builder, kernels.sweep, color, &[])));
                }
            };
        let cycle_of = |builder: &mut Builder<'_>, finest: usize| {
            let mut cycle = Vec::new();
            let count = |number| if number == 0 { finest } else { SWEEPS };
            for number in 0..last {
                let (level, coarser) = (&made[number], &made[number + 1]);
                sweeps(builder, &mut cycle, level, [0, 1], count(number));
                let coarser = [(2, coarser.fluence.into()), (3, coarser.right.into())];
                cycle.push(level.pass_over_tiles(builder, kernels.restrict, 0, &coarser));
            }
            // The coarsest level's one cell.
            sweeps(builder, &mut cycle, &made[last], [0, 1], 1);
            for number in (0..last).rev() {
                let (level, coarser) = (&made[number], &made[number + 1]);
                cycle.push(level.pass_over_tiles(builder, kernels.prolong, 0, &[(2, coarser.fluence.into())]));
                sweeps(builder, &mut cycle, level, [1, 0], count(number));
            }
            cycle
        };
        let first = cycle_of(builder, 0);
        let cycle = cycle_of(builder, SWEEPS);
        let packing = [(4, cells.nodes.into()), (5, packed.into())];
        let pack = made[0].pass_over_tiles(builder, kernels.pack, 0, &packing);
        Ok(Self { levels: made, options, fresh, packed, coarsen, list, first, cycle, pack })
    }

    /// The right side of the finest level's equations: four f32 for each voxel.
    pub(super) fn right(&self) -> Buffer {
        self.levels[0].right
    }

    /// The fluence of the finest level: four f32 for each voxel.
    #[cfg(test)]
    pub(super) fn fluence(&self) -> Buffer {
        self.levels[0].fluence
    }

    /// Encodes the solve.
    pub(super) fn encode(&self, builder: &mut Builder<'_>) {
        for level in &self.levels {
            builder.pass(Pass::Copy { from: self.fresh, to: level.workgroups, bytes: 12 });
        }
        if !self.options.warm {
            builder.clear(self.levels[0].fluence);
        }
        builder.clear(self.packed);
        builder.compute(RECIPE, self.coarsen.iter().chain(&self.list).cloned().collect(), 1);
        if !self.options.warm {
            builder.compute(RECIPE, self.first.clone(), 1);
        }
        builder.compute(RECIPE, self.cycle.clone(), self.options.cycles);
        builder.compute(RECIPE, vec![self.pack.clone()], 1);
    }

    /// Size of the buffers in bytes, except those of the finest level's cells.
    pub(super) fn bytes(&self, frame: &Frame) -> u64 {
        let of = |(number, level): (usize, &Level)| {
            let shared = [level.tiles, level.workgroups, level.fluence, level.right];
            let equations = if number == 0 { 0 } else { frame.bytes_of([level.faces, level.reactions]) };
            frame.bytes_of(shared) + equations
        };
        frame.bytes_of([self.fresh, self.packed]) + self.levels.iter().enumerate().map(of).sum::<u64>()
    }
}

/// The recipe's pipelines.
struct Kernels {
    coarsen: PipelineId,
    list: PipelineId,
    sweep: PipelineId,
    restrict: PipelineId,
    prolong: PipelineId,
    pack: PipelineId,
}

/// Creates the buffers of the level with this number; the finest has the equations of `cells`.
fn level(builder: &mut Builder<'_>, sides: &[u32], number: usize, cells: &Cells) -> Level {
    use wgpu::BufferUsages as Usage;
    let (side, finer) = (sides[number], if number == 0 { 0 } else { sides[number - 1] });
    let voxels = u64::from(side).pow(3);
    let record =
        |color: u32| Record::new("DiffusionLevel").with("cells", side).with("finer_cells", finer).with("color", color);
    let records = [0, 1].map(|color| builder.uniform("level", record(color)));
    let mut storage = |what: &str, bytes: u64| {
        builder.buffer(&format!("{what} of level {number}"), bytes, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC)
    };
    let tiles = storage("tiles", 4 * u64::from(side.div_ceil(TILE)).pow(3));
    let fluence = storage("fluence", 16 * voxels);
    let right = storage("right side", 16 * voxels);
    let (faces, reactions) = if number == 0 {
        (cells.faces, cells.reactions)
    } else {
        (storage("conductances", 12 * voxels), storage("losses", 16 * voxels))
    };
    let workgroups = builder.buffer(
        &format!("tile count of level {number}"),
        12,
        Usage::STORAGE | Usage::INDIRECT | Usage::COPY_DST | Usage::COPY_SRC,
    );
    Level { cells: side, tiles, workgroups, faces, reactions, fluence, right, records }
}

impl Level {
    fn groups(
        &self,
        builder: &mut Builder<'_>,
        kernel: PipelineId,
        color: usize,
        others: &[(u32, Bound)],
    ) -> Vec<Option<crate::frame::BindGroupId>> {
        let own =
            [self.records[color], self.tiles, self.workgroups, self.faces, self.reactions, self.fluence, self.right];
        let own: Vec<(u32, Bound)> = (0..).zip(own.map(Bound::from)).collect();
        vec![builder.bind(kernel, 0, &own), builder.bind(kernel, 1, others)]
    }

    /// Returns a pass with a workgroup for each tile that holds matter.
    fn pass_over_tiles(
        &self,
        builder: &mut Builder<'_>,
        kernel: PipelineId,
        color: usize,
        others: &[(u32, Bound)],
    ) -> Dispatch {
        let groups = self.groups(builder, kernel, color, others);
        builder.dispatch(kernel, groups, Workgroups::Indirect(self.workgroups))
    }

    /// Returns a pass with `count` invocations.
    fn pass_over_all(
        &self,
        builder: &mut Builder<'_>,
        kernel: PipelineId,
        others: &[(u32, Bound)],
        count: u32,
    ) -> Dispatch {
        let groups = self.groups(builder, kernel, 0, others);
        builder.dispatch(kernel, groups, Workgroups::Count([count.div_ceil(GROUP), 1, 1]))
    }
}
