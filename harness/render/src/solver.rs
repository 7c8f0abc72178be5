//! A solver's pipelines, its buffers, and the passes that it records.

use crate::compute::Kernel;
use crate::device::uniform;
use crate::record::Record;
use crate::shader::ShaderError;
use crate::voxel_grid::VoxelGrid;
use lapidary_gpu::{Encoder, Gpu};
use lapidary_optical_path::{self as mirror, OPTICAL_PATH_UNREACHED};
use lapidary_scene::solver::Method;

/// Voxels along an edge of a solver's tile.
const TILE: u32 = 4;
/// Invocations of a workgroup over tiles.
const GROUP: u32 = 32;
/// Voxels along two edges of a workgroup over voxels.
const SWEEP_GROUP: u32 = 8;
/// The struct `OpticalPathProgress`, in words.
const PROGRESS_WORDS: u64 = 7;

/// What the method's passes are written in.
fn recipe(method: Method) -> &'static str {
    if method.is_tiled() { "optical_path_tiles" } else { "optical_path_sweep" }
}

/// How far a solve came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// Passes in which anything was left to do.
    pub passes: u32,
    /// Tiles, or for untiled solvers voxels, that these took up; a tile as often as it was taken up.
    pub updates: u32,
    /// Tiles or voxels that another pass would take up: 0 where the costs are final.
    pub active: u32,
    /// Every cost up to this one is final. Where the solve ended early, the luminance of the others may be off by at most e to the minus this.
    pub least: f32,
}

impl Status {
    /// The most that any luminance may be off by for the passes that were not granted.
    #[must_use]
    pub fn luminance_bound(&self) -> f32 {
        if self.active == 0 { 0.0 } else { mirror::luminance(self.least) }
    }
}

/// Solves bodies in one grid by one method, one channel at a time. The host reads nothing back.
#[derive(Debug)]
pub struct Solver<'gpu> {
    gpu: &'gpu Gpu,
    grid: VoxelGrid,
    method: Method,
    heterogeneous: bool,
    most_passes: u32,
    begin: Kernel,
    next: Kernel,
    pass: Kernel,
    fresh: wgpu::Buffer,
    progress: wgpu::Buffer,
    workgroups: wgpu::Buffer,
    /// From binding 6 on.
    own: Vec<wgpu::Buffer>,
}

impl<'gpu> Solver<'gpu> {
    /// Compiles what the method needs for a grid. `heterogeneous` is for bodies with a density by voxel. At most `most_passes` passes are recorded;
    /// by default as many as any body needs whose paths of least cost do not wind.
    ///
    /// # Errors
    /// Where the device refuses a recipe or the memory.
    pub fn new(
        gpu: &'gpu Gpu,
        grid: VoxelGrid,
        method: Method,
        heterogeneous: bool,
        most_passes: Option<u32>,
    ) -> Result<Self, ShaderError> {
        let source = lapidary_wgsl::recipe_source(recipe(method));
        Self::of_source(gpu, grid, method, heterogeneous, most_passes, &source)
    }

    /// The same of another text of the method's recipe.
    ///
    /// # Errors
    /// Where the device refuses the text or the memory.
    pub fn of_source(
        gpu: &'gpu Gpu,
        grid: VoxelGrid,
        method: Method,
        heterogeneous: bool,
        most_passes: Option<u32>,
        source: &str,
    ) -> Result<Self, ShaderError> {
        let recipe = recipe(method);
        let flag = |value| f64::from(u8::from(value));
        let constants = [
            ("OPTICAL_PATH_STENCIL", f64::from(method.stencil().neighbours())),
            ("EFFECT_EXTINCTION_PER_VOXEL", flag(heterogeneous)),
            ("OPTICAL_PATH_GODUNOV", flag(method == Method::Godunov)),
            ("OPTICAL_PATH_PAPER", flag(method == Method::Paper)),
        ];
        let pass = match method {
            Method::Paper => "push",
            Method::PingPong(_) => "pull",
            Method::Tiled(_) | Method::Godunov => "update",
        };
        let kernel = |entry: &str| Kernel::new(gpu, recipe, source, &format!("{recipe}_{entry}"), &constants);
        let [begin, next, pass] = [kernel("begin")?, kernel("next")?, kernel(pass)?];
        let tiles = u64::from(grid.cells / TILE).pow(3);
        let voxels = grid.count() as u64;
        let sizes = if method.is_tiled() {
            vec![("matter of tiles", 8 * tiles), ("listed tiles", 4 * tiles), ("lists of tiles", 8 * tiles)]
        } else {
            vec![("work", 4 * voxels)]
        };
        let (fresh, progress, workgroups, own) = gpu.guarded("allocating a solver's buffers", |device| {
            use wgpu::BufferUsages as Usage;
            let buffer = |what, size, usage| {
                let descriptor = wgpu::BufferDescriptor { label: Some(what), size, usage, mapped_at_creation: false };
                device.create_buffer(&descriptor)
            };
            let unreached = mirror::encode(OPTICAL_PATH_UNREACHED);
            let fresh = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("fresh progress"),
                contents: bytemuck::cast_slice(&[0, 0, 0, 0, 0, unreached, unreached]),
                usage: Usage::COPY_SRC,
            });
            let progress = buffer("progress", 4 * PROGRESS_WORDS, Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC);
            let workgroups = buffer("workgroups", 12, Usage::STORAGE | Usage::INDIRECT);
            let own = sizes.iter().map(|(what, size)| buffer(what, *size, Usage::STORAGE)).collect();
            (fresh, progress, workgroups, own)
        })?;
        let most_passes = most_passes.unwrap_or_else(|| Self::default_passes(method, grid.cells));
        Ok(Self { gpu, grid, method, heterogeneous, most_passes, begin, next, pass, fresh, progress, workgroups, own })
    }

    /// As many passes as a path takes through the cube from corner to corner by faces, tiles or voxels, and back and forth once or twice more.
    fn default_passes(method: Method, cells: u32) -> u32 {
        if method.is_tiled() { 2 * cells } else { 8 * cells }
    }

    /// Records a solve. `matter` holds a bit for each voxel, in rows as [`VoxelGrid::words_per_row`] says; `density`, where the solver is heterogeneous, an
    /// f32 for each, at least 0; `cost` the seeds as f32, unreached elsewhere, and after the passes the costs. `extinction` is in the inverse of the unit
    /// of the grid's spacing, at least 0.
    ///
    /// # Errors
    /// Where the device refuses a buffer.
    ///
    /// # Panics
    /// Where the solver is heterogeneous and there is no density.
    pub fn encode(
        &self,
        encoder: &mut Encoder,
        matter: &wgpu::Buffer,
        density: Option<&wgpu::Buffer>,
        cost: &wgpu::Buffer,
        extinction: f32,
    ) -> Result<(), ShaderError> {
        assert!(density.is_some() || !self.heterogeneous, "a heterogeneous body has a density");
        let cells = self.grid.cells;
        let whole = [cells / SWEEP_GROUP, cells / SWEEP_GROUP, cells];
        let begin = if self.method.is_tiled() { [(cells / TILE).pow(3).div_ceil(GROUP), 1, 1] } else { whole };
        self.gpu.guarded("recording a solve", |device| {
            let grid = Record::new("OpticalPathGrid").with("cells", cells).with("extinction", extinction);
            let grid = grid.with("spacing", self.grid.spacing).bytes();
            let uniform = uniform(device, "solve", &grid);
            let mut buffers = vec![(0, &uniform), (1, matter), (2, cost), (3, &self.progress), (4, &self.workgroups)];
            buffers.extend(density.map(|density| (5, density)));
            buffers.extend((6..).zip(&self.own));
            let bind = |kernel: &Kernel, buffers: &[(u32, &wgpu::Buffer)]| {
                let resources: Vec<_> =
                    buffers.iter().map(|(place, buffer)| (*place, buffer.as_entire_binding())).collect();
                kernel.bind(device, 0, &resources)
            };
            let groups = [&self.begin, &self.next, &self.pass].map(|kernel| bind(kernel, &buffers));
            // Of ping-pong, the passes back.
            let exchanged = matches!(self.method, Method::PingPong(_)).then(|| {
                let exchanged: Vec<(u32, &wgpu::Buffer)> = buffers
                    .iter()
                    .map(|(binding, buffer)| (if [2, 6].contains(binding) { 8 - binding } else { *binding }, *buffer))
                    .collect();
                bind(&self.pass, &exchanged)
            });
            // Whichever way they end, the costs are where they belong.
            let passes = if exchanged.is_some() { self.most_passes.next_multiple_of(2) } else { self.most_passes };
            encoder.copy_buffer_to_buffer(&self.fresh, 0, &self.progress, 0, 4 * PROGRESS_WORDS);
            let mut recorder = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("solve"),
                ..wgpu::ComputePassDescriptor::default()
            });
            recorder.set_pipeline(&self.begin.pipeline);
            recorder.set_bind_group(0, groups[0].as_ref());
            recorder.dispatch_workgroups(begin[0], begin[1], begin[2]);
            for pass in 0..passes {
                recorder.set_pipeline(&self.next.pipeline);
                recorder.set_bind_group(0, groups[1].as_ref());
                recorder.dispatch_workgroups(1, 1, 1);
                recorder.set_pipeline(&self.pass.pipeline);
                let group = exchanged.as_ref().filter(|_| pass % 2 == 1).unwrap_or(&groups[2]);
                recorder.set_bind_group(0, group.as_ref());
                recorder.dispatch_workgroups_indirect(&self.workgroups, 0);
            }
        })?;
        Ok(())
    }

    /// Bytes of its own buffers, which the costs are none of.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let shared = [&self.fresh, &self.progress, &self.workgroups];
        shared.into_iter().chain(&self.own).map(wgpu::Buffer::size).sum()
    }

    /// How far the last submitted solve came. Waits for it: not for every frame.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn status(&self) -> Result<Status, ShaderError> {
        let kept = self.kept_status()?;
        self.gpu.guarded("reading a solve's status", |device| {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            self.keep_status(&mut encoder, &kept);
            self.gpu.queue.submit([encoder.finish()]);
        })?;
        self.status_of(&kept)
    }

    /// A buffer for [`Solver::keep_status`].
    ///
    /// # Errors
    /// Where the device refuses the memory.
    pub fn kept_status(&self) -> Result<wgpu::Buffer, ShaderError> {
        Ok(self.gpu.guarded("allocating a solve's status", |device| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("kept progress"),
                size: 4 * PROGRESS_WORDS,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            })
        })?)
    }

    /// Records that how far the solve before came is kept, though others follow. Nothing waits.
    pub fn keep_status(&self, encoder: &mut Encoder, kept: &wgpu::Buffer) {
        encoder.copy_buffer_to_buffer(&self.progress, 0, kept, 0, 4 * PROGRESS_WORDS);
    }

    /// What was kept by the last submission. Waits for it: not for every frame.
    ///
    /// # Errors
    /// Where the device is lost.
    pub fn status_of(&self, kept: &wgpu::Buffer) -> Result<Status, ShaderError> {
        Ok(self.gpu.read_back(kept, 4 * PROGRESS_WORDS, |bytes| {
            let words: &[u32] = bytemuck::cast_slice(bytes);
            let parity = (words[0] & 1) as usize;
            let least = mirror::decode(words[5 + parity]);
            Status { passes: words[1], updates: words[2], active: words[3 + parity], least }
        })?)
    }
}
