//! The recipe `diffusion_solve`: grids, each half as fine as the one before, and the cycles over them.

use super::cells::Cells;
use super::tiles::{self, TILE, Tiles};
use crate::frame::record::Record;
use crate::frame::shader::ShaderError;
use crate::frame::{BindGroupId, Bound, Buffer, Builder, Dispatch, Frame, Pass, PipelineId, Workgroups};
use crate::settings::DiffusionOptions;
use crate::volume::voxel_grid::VoxelGrid;
use glam::Vec3;

const RECIPE: &str = "diffusion_solve";
/// Invocations of a workgroup of the pass over all tiles.
const GROUP: u32 = 64;
/// Sweeps over both colours before and after each correction.
const SWEEPS: usize = 2;

/// One grid's buffers.
struct Level {
    cells: u32,
    /// Tiles that hold matter.
    tiles: Tiles,
    faces: Buffer,
    reactions: Buffer,
    fluence: Buffer,
    right: Buffer,
    /// The struct `DiffusionLevel` for either colour.
    records: [Buffer; 2],
    /// The count of tiles while cycles are still needed, as arguments of an indirect dispatch.
    open: Option<Buffer>,
}

/// All grids of a body, and the passes that solve its equations.
pub(super) struct Levels {
    levels: Vec<Level>,
    options: DiffusionOptions,
    /// Fluence, depth and volume of each voxel, for shading: eight bytes.
    pub(super) packed: Buffer,
    /// Makes and lists the coarser levels.
    coarsen: Vec<Dispatch>,
    /// The cycle from no light at all: sweeps on the coarser grids alone, on the way up.
    first: Vec<Dispatch>,
    cycle: Vec<Dispatch>,
    /// What comes before a further cycle, and that cycle, unless enough is solved; nothing if the cycles' number is fixed.
    further: Vec<Dispatch>,
    /// Sums over the finest level of squares of residuals and right sides, and the pass that leaves them; `None` if
    /// nobody asks.
    residual: Option<(Buffer, Dispatch)>,
    pack: Dispatch,
}

impl Levels {
    /// Creates the pipelines and buffers. `limited` is the extinction per voxel spacing, if a flux limiter is asked for.
    pub(super) fn new(
        builder: &mut Builder<'_>,
        grid: VoxelGrid,
        cells: &Cells,
        limited: Option<Vec3>,
        options: DiffusionOptions,
    ) -> Result<Self, ShaderError> {
        use wgpu::BufferUsages as Usage;
        let mut sides = vec![grid.cells];
        while let Some(side) = sides.last().copied().filter(|side| *side > TILE) {
            sides.push(side.div_ceil(2));
        }
        let is_open = options.most_cycles > options.cycles;
        let made: Vec<Level> =
            (0..sides.len()).map(|number| level(builder, (&sides, number), cells, limited, is_open)).collect();
        let packed = builder.buffer("fluence to look up", 8 * grid.count() as u64, Usage::STORAGE | Usage::COPY_DST);
        let source = lapidary_wgsl::recipe_source(RECIPE);
        let mut kernel = |entry: &str, limited: bool| {
            let constants = [("DIFFUSION_LIMITED", f64::from(u8::from(limited)))];
            builder.compute_pipeline(RECIPE, &source, &format!("{RECIPE}_{entry}"), &constants)
        };
        let is_limited = limited.is_some();
        let kernels = Kernels {
            coarsen: [kernel("coarsen", is_limited)?, kernel("coarsen", false)?],
            list: kernel("list", false)?,
            sweep: [kernel("sweep", is_limited)?, kernel("sweep", false)?],
            coarsest: kernel("coarsest", false)?,
            restrict: [kernel("restrict", is_limited)?, kernel("restrict", false)?],
            prolong: kernel("prolong", false)?,
            pack: kernel("pack", false)?,
        };
        let residual_kernel = if options.residual || is_open { Some(kernel("residual", is_limited)?) } else { None };
        let stop = if is_open { Some(kernel("stop", false)?) } else { None };
        let of_level = |kernels: [PipelineId; 2], number: usize| kernels[number.min(1)];
        // What the flux limiter reads.
        let nodes = (4, cells.nodes.into());
        let last = made.len() - 1;
        let mut coarsen = Vec::new();
        let mut again = Vec::new();
        for (number, (level, coarser)) in made.iter().zip(&made[1..]).enumerate() {
            let equations = [(0, coarser.faces.into()), (1, coarser.reactions.into()), nodes];
            coarsen.push(level.pass_over_tiles(builder, kernels.coarsen[1], 0, &equations));
            coarsen.push(coarser.pass_over_all(builder, kernels.list, tiles::count(coarser.cells)));
            if is_limited {
                again.push(level.pass_over_tiles(builder, of_level(kernels.coarsen, number), 0, &equations));
            }
        }
        let sweeps =
            |builder: &mut Builder<'_>, cycle: &mut Vec<Dispatch>, number: usize, colors: [usize; 2], count| {
                let kernel = of_level(kernels.sweep, number);
                for _ in 0..count {
                    cycle.extend(colors.map(|color| made[number].pass_over_tiles(builder, kernel, color, &[nodes])));
                }
            };
        let cycle_of = |builder: &mut Builder<'_>, is_first: bool| {
            // Also of no light at all, of which nothing is limited: the last frame has left its own.
            let mut cycle = again.clone();
            for number in 0..last {
                let (level, coarser) = (&made[number], &made[number + 1]);
                sweeps(builder, &mut cycle, number, [0, 1], if is_first { 0 } else { SWEEPS });
                let coarser = [(2, coarser.fluence.into()), (3, coarser.right.into()), nodes];
                cycle.push(level.pass_over_tiles(builder, of_level(kernels.restrict, number), 0, &coarser));
            }
            cycle.push(made[last].pass_over_tiles(builder, kernels.coarsest, 0, &[]));
            for number in (0..last).rev() {
                let (level, coarser) = (&made[number], &made[number + 1]);
                cycle.push(level.pass_over_tiles(builder, kernels.prolong, 0, &[(2, coarser.fluence.into())]));
                sweeps(builder, &mut cycle, number, [1, 0], if is_first && number == 0 { 0 } else { SWEEPS });
            }
            cycle
        };
        let first = cycle_of(builder, true);
        let cycle = cycle_of(builder, false);
        let packing = [(4, cells.nodes.into()), (5, packed.into())];
        let pack = made[0].pass_over_tiles(builder, kernels.pack, 0, &packing);
        let mut residual = None;
        if let Some(kernel) = residual_kernel {
            let usage = Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC;
            let sums = builder.buffer("residuals", 32 * u64::from(tiles::count(grid.cells)), usage);
            residual = Some((sums, made[0].pass_over_tiles(builder, kernel, 0, &[(6, sums.into()), nodes])));
        }
        let mut further = Vec::new();
        if let (Some(stop), Some((sums, measured))) = (stop, &residual) {
            let opened = |dispatch: &Dispatch| {
                let of_level = |level: &&Level| dispatch.workgroups == level.tiles.dispatched();
                let open = made.iter().find(of_level).and_then(|level| level.open).map(Workgroups::Indirect);
                Dispatch { workgroups: open.unwrap_or(dispatch.workgroups), ..dispatch.clone() }
            };
            further.push(opened(measured));
            for open in made.iter().filter_map(|level| level.open) {
                let groups =
                    vec![builder.bind(stop, 0, &[(2, open.into())]), builder.bind(stop, 1, &[(6, (*sums).into())])];
                further.push(builder.dispatch(stop, groups, Workgroups::Count([1, 1, 1])));
            }
            further.extend(cycle.iter().map(opened));
        }
        Ok(Self { levels: made, residual, options, packed, coarsen, first, cycle, further, pack })
    }

    /// The right side of the finest level's equations: four f32 for each voxel.
    pub(super) fn right(&self) -> Buffer {
        self.levels[0].right
    }

    /// Largest number of cycles of a frame.
    pub(super) fn cycles(&self) -> u32 {
        self.options.most_cycles.max(self.options.cycles)
    }

    /// The fluence of the finest level: four f32 for each voxel.
    pub(super) fn fluence(&self) -> Buffer {
        self.levels[0].fluence
    }

    /// Encodes the coarser levels' equations, which depend on the body alone.
    pub(super) fn encode_equations(&self, builder: &mut Builder<'_>) {
        for level in &self.levels[1..] {
            level.tiles.encode_none(builder);
            builder.clear(level.faces);
            builder.clear(level.reactions);
        }
        builder.compute(RECIPE, self.coarsen.clone(), 1);
    }

    /// Encodes the solve.
    pub(super) fn encode(&self, builder: &mut Builder<'_>) {
        if !self.options.warm {
            builder.clear(self.levels[0].fluence);
        }
        builder.clear(self.packed);
        if !self.options.warm {
            builder.compute(RECIPE, self.first.clone(), 1);
        }
        builder.compute(RECIPE, self.cycle.clone(), self.options.cycles);
        if let Some((sums, _)) = &self.residual {
            builder.clear(*sums);
        }
        if !self.further.is_empty() {
            for level in &self.levels {
                if let Some(to) = level.open {
                    builder.pass(Pass::Copy { from: level.tiles.workgroups, to, bytes: 12 });
                }
            }
            builder.compute(RECIPE, self.further.clone(), self.options.most_cycles - self.options.cycles);
        }
        if let Some((_, measured)) = self.residual.as_ref().filter(|_| self.options.residual) {
            builder.compute(RECIPE, vec![measured.clone()], 1);
        }
        builder.compute(RECIPE, vec![self.pack.clone()], 1);
    }

    /// The sums of which the residual is made; `None` unless the options ask for it.
    pub(super) fn residual_sums(&self) -> Option<Buffer> {
        self.residual.as_ref().filter(|_| self.options.residual).map(|(sums, _)| *sums)
    }

    /// Size of the buffers in bytes, except those of the finest level's cells.
    pub(super) fn bytes(&self, frame: &Frame) -> u64 {
        let of_level = |(number, level): (usize, &Level)| {
            let of_cells = [level.faces, level.reactions].into_iter().chain(level.tiles.buffers());
            let of_cells = if number == 0 { 0 } else { frame.bytes_of(of_cells) };
            frame.bytes_of([level.fluence, level.right].into_iter().chain(level.open)) + of_cells
        };
        let sums = self.residual.as_ref().map(|(sums, _)| *sums);
        frame.bytes_of([self.packed].into_iter().chain(sums))
            + self.levels.iter().enumerate().map(of_level).sum::<u64>()
    }
}

/// The recipe's pipelines.
struct Kernels {
    coarsen: [PipelineId; 2],
    list: PipelineId,
    /// Of the finest level, and of the others.
    sweep: [PipelineId; 2],
    coarsest: PipelineId,
    restrict: [PipelineId; 2],
    prolong: PipelineId,
    pack: PipelineId,
}

/// Creates the buffers of the level with this number; the finest has the equations of `cells`.
fn level(
    builder: &mut Builder<'_>,
    (sides, number): (&[u32], usize),
    cells: &Cells,
    limited: Option<Vec3>,
    is_open: bool,
) -> Level {
    use wgpu::BufferUsages as Usage;
    let side = sides[number];
    let voxels = u64::from(side).pow(3);
    // Read by the flux limiter alone.
    let extinction = limited.unwrap_or_default();
    let record = |color: u32| {
        Record::new("DiffusionLevel").with("cells", side).with("color", color).with("extinction", extinction)
    };
    let records = [0, 1].map(|color| builder.uniform("level", record(color)));
    let mut storage = |what: &str, bytes: u64| {
        builder.buffer(&format!("{what} of level {number}"), bytes, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC)
    };
    let fluence = storage("fluence", 16 * voxels);
    let right = storage("right side", 16 * voxels);
    let (faces, reactions, tiles) = if number == 0 {
        (cells.faces, cells.reactions, cells.tiles)
    } else {
        let [faces, reactions] =
            [("conductances", 12), ("losses", 16)].map(|(what, bytes)| storage(what, bytes * voxels));
        (faces, reactions, Tiles::new(builder, side, number))
    };
    let usage = Usage::STORAGE | Usage::COPY_DST | Usage::INDIRECT;
    let name = format!("tiles left to solve of level {number}");
    let open = is_open.then(|| builder.buffer(&name, 12, usage));
    Level { cells: side, tiles, faces, reactions, fluence, right, records, open }
}

impl Level {
    fn groups(
        &self,
        builder: &mut Builder<'_>,
        kernel: PipelineId,
        color: usize,
        others: &[(u32, Bound)],
    ) -> Vec<Option<BindGroupId>> {
        let of_level = [
            self.records[color],
            self.tiles.list,
            self.tiles.workgroups,
            self.faces,
            self.reactions,
            self.fluence,
            self.right,
        ];
        let of_level: Vec<(u32, Bound)> = (0..).zip(of_level.map(Bound::from)).collect();
        vec![builder.bind(kernel, 0, &of_level), builder.bind(kernel, 1, others)]
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
        builder.dispatch(kernel, groups, self.tiles.dispatched())
    }

    /// Returns a pass with `count` invocations.
    fn pass_over_all(&self, builder: &mut Builder<'_>, kernel: PipelineId, count: u32) -> Dispatch {
        let groups = self.groups(builder, kernel, 0, &[]);
        builder.dispatch(kernel, groups, Workgroups::Count([count.div_ceil(GROUP), 1, 1]))
    }
}
