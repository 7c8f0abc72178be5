//! A solver's pipelines, its buffers, and the passes that it records.

use crate::frame::record::Record;
use crate::frame::shader::ShaderError;
use crate::frame::{Bound, Buffer, Builder, Frame, Pass, PipelineId, Workgroups};
use crate::volume::voxel_grid::VoxelGrid;
use lapidary_optical_path::{self as mirror, OPTICAL_PATH_UNREACHED};
use lapidary_scene::solver::Method;

/// Voxels along an edge of a solver's tile.
const TILE: u32 = 4;
/// Invocations of a workgroup that runs over tiles.
const GROUP: u32 = 32;
/// Voxels along two edges of a workgroup that runs over voxels.
const SWEEP_GROUP: u32 = 8;
/// Size of the struct `OpticalPathProgress` in words.
const PROGRESS_WORDS: u64 = 7;

/// Returns the recipe that contains the method's passes.
fn recipe(method: Method) -> &'static str {
    if method.is_tiled() { "optical_path_tiles" } else { "optical_path_sweep" }
}

/// How a body is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Solve {
    /// The method.
    pub method: Method,
    /// Whether bodies have a density per voxel.
    pub heterogeneous: bool,
    /// Maximum number of passes; ping-pong rounds it up to an even number. `None` allows as many as
    /// any body needs whose paths of least cost do not wind.
    pub most_passes: Option<u32>,
}

/// Solves bodies in one grid by one method, one channel at a time. The host reads nothing back.
#[derive(Debug)]
pub struct Solver {
    grid: VoxelGrid,
    solve: Solve,
    begin: PipelineId,
    next: PipelineId,
    pass: PipelineId,
    fresh: Buffer,
    progress: Buffer,
    workgroups: Buffer,
    /// Buffers from binding 6 on, of this solver alone.
    scratch: Vec<Buffer>,
}

/// Buffers and values that a solve reads and writes.
#[derive(Clone, Copy, Debug)]
pub struct Solved {
    /// One bit per voxel, in rows as described at [`VoxelGrid::words_per_row`].
    pub matter: Buffer,
    /// One f32 per voxel, at least 0; `None` unless the solver is heterogeneous.
    pub density: Option<Buffer>,
    /// The seeds as f32, unreached elsewhere; after the passes, the costs.
    pub cost: Buffer,
    /// Extinction in the inverse of the unit of the grid's spacing, at least 0.
    pub extinction: f32,
    /// How far the solve got, for [`Status::read`](super::Status::read): a buffer from [`Solver::kept`].
    pub kept: Buffer,
}

impl Solver {
    /// Compiles the pipelines that the method needs for a grid.
    ///
    /// # Errors
    /// If the recipe is not valid.
    pub fn new(builder: &mut Builder<'_>, grid: VoxelGrid, solve: Solve) -> Result<Self, ShaderError> {
        Self::of_source(builder, grid, solve, &lapidary_wgsl::recipe_source(recipe(solve.method)))
    }

    /// Like [`Solver::new`], from another text of the method's recipe.
    ///
    /// # Errors
    /// If the text is not valid.
    pub fn of_source(
        builder: &mut Builder<'_>,
        grid: VoxelGrid,
        solve: Solve,
        source: &str,
    ) -> Result<Self, ShaderError> {
        let method = solve.method;
        let recipe = recipe(method);
        let flag = |value| f64::from(u8::from(value));
        let constants = [
            ("OPTICAL_PATH_STENCIL", f64::from(method.stencil().neighbours())),
            ("EFFECT_EXTINCTION_PER_VOXEL", flag(solve.heterogeneous)),
            ("OPTICAL_PATH_GODUNOV", flag(method == Method::Godunov)),
            ("OPTICAL_PATH_PAPER", flag(method == Method::Paper)),
        ];
        let pass = match method {
            Method::Paper => "push",
            Method::PingPong(_) => "pull",
            Method::Tiled(_) | Method::Godunov => "update",
        };
        let mut kernel =
            |entry: &str| builder.compute_pipeline(recipe, source, &format!("{recipe}_{entry}"), &constants);
        let [begin, next, pass] = [kernel("begin")?, kernel("next")?, kernel(pass)?];
        let tiles = u64::from(grid.cells / TILE).pow(3);
        let voxels = grid.count() as u64;
        let sizes = if method.is_tiled() {
            vec![("matter of tiles", 8 * tiles), ("listed tiles", 4 * tiles), ("lists of tiles", 8 * tiles)]
        } else {
            vec![("work", 4 * voxels)]
        };
        use wgpu::BufferUsages as Usage;
        let unreached = mirror::encode(OPTICAL_PATH_UNREACHED);
        let fresh: Vec<u8> = bytemuck::cast_slice(&[0, 0, 0, 0, 0, unreached, unreached]).to_vec();
        let fresh = builder.filled("fresh progress", fresh, Usage::COPY_SRC);
        let usage = Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC;
        let progress = builder.buffer("progress", 4 * PROGRESS_WORDS, usage);
        let workgroups = builder.buffer("workgroups", 12, Usage::STORAGE | Usage::INDIRECT);
        let scratch = sizes.iter().map(|(what, size)| builder.buffer(what, *size, Usage::STORAGE)).collect();
        Ok(Self { grid, solve, begin, next, pass, fresh, progress, workgroups, scratch })
    }

    /// Returns as many passes as a path takes through the cube from corner to corner across faces,
    /// by tiles or voxels, and back and forth once or twice more.
    fn default_passes(method: Method, cells: u32) -> u32 {
        if method.is_tiled() { 2 * cells } else { 8 * cells }
    }

    /// Creates a buffer for how far a solve got.
    pub fn kept(builder: &mut Builder<'_>) -> Buffer {
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        builder.buffer("kept progress", 4 * PROGRESS_WORDS, usage)
    }

    /// Encodes a solve as the next passes.
    ///
    /// # Panics
    /// If the solver is heterogeneous and there is no density.
    pub fn encode(&self, builder: &mut Builder<'_>, solved: &Solved) {
        let Solve { method, heterogeneous, most_passes } = self.solve;
        assert!(solved.density.is_some() || !heterogeneous, "a heterogeneous body has a density");
        let cells = self.grid.cells;
        let whole = [cells / SWEEP_GROUP, cells / SWEEP_GROUP, cells];
        let begin = if method.is_tiled() { [(cells / TILE).pow(3).div_ceil(GROUP), 1, 1] } else { whole };
        let grid = Record::new("OpticalPathGrid").with("cells", cells).with("extinction", solved.extinction);
        let uniform = builder.uniform("solve", grid.with("spacing", self.grid.spacing));
        let mut resources: Vec<(u32, Bound)> =
            (0..).zip([uniform, solved.matter, solved.cost, self.progress, self.workgroups].map(Bound::from)).collect();
        resources.extend(solved.density.map(|density| (5, density.into())));
        resources.extend((6..).zip(self.scratch.iter().copied().map(Bound::from)));
        let [begin_group, next_group, pass_group] =
            [self.begin, self.next, self.pass].map(|kernel| vec![builder.bind(kernel, 0, &resources)]);
        let next = builder.dispatch(self.next, next_group, Workgroups::Count([1, 1, 1]));
        let indirect = Workgroups::Indirect(self.workgroups);
        let mut turns = vec![next.clone(), builder.dispatch(self.pass, pass_group, indirect)];
        let mut passes = most_passes.unwrap_or_else(|| Self::default_passes(method, cells));
        if matches!(method, Method::PingPong(_)) {
            // The pass back. Whichever of the two comes last, the costs are in their buffer.
            let exchanged: Vec<(u32, Bound)> = resources
                .iter()
                .map(|(binding, resource)| (if [2, 6].contains(binding) { 8 - binding } else { *binding }, *resource))
                .collect();
            let group = vec![builder.bind(self.pass, 0, &exchanged)];
            turns.extend([next, builder.dispatch(self.pass, group, indirect)]);
            passes = passes.div_ceil(2);
        }
        builder.pass(Pass::Copy { from: self.fresh, to: self.progress, bytes: 4 * PROGRESS_WORDS });
        let begin = builder.dispatch(self.begin, begin_group, Workgroups::Count(begin));
        builder.compute("solve", vec![begin], 1);
        builder.compute("solve", turns, passes);
        builder.pass(Pass::Copy { from: self.progress, to: solved.kept, bytes: 4 * PROGRESS_WORDS });
    }

    /// Size of the scratch buffers in bytes, cost buffers excluded.
    #[must_use]
    pub fn bytes(&self, frame: &Frame) -> u64 {
        let shared = [self.fresh, self.progress, self.workgroups];
        frame.bytes_of(shared.into_iter().chain(self.scratch.iter().copied()))
    }
}
