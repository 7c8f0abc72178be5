//! Ways through a body, sought only in tiles that hold matter and may change, beside solvers that take up more.

use crate::cost::CostError;
use lapidary_gpu::{Encoder, Gpu};
use lapidary_optical_path::OPTICAL_PATH_UNREACHED;
use lapidary_render::RenderError;
use lapidary_render::solver::Solver;
use lapidary_render::voxel_grid::VoxelGrid;
use lapidary_render::voxelization::Voxelizer;
use lapidary_scene::solver::{Method, Stencil};
use lapidary_scene::{Bounds, Mesh, Scene};
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// The body.
const SCENE: &str = "bunny";
/// Voxels along an edge of the grids.
const CELLS: [u32; 3] = [32, 64, 128];
/// Costs of the graph are the same to the bit however they are found.
const METHOD: Method = Method::Tiled(Stencil::Corners);
/// Of light from one side, across the grid.
const DEPTH: f32 = 8.0;
/// Voxels along an edge of a tile.
const TILE: u32 = 4;

const ALL_TILES: &str = "optical_path_tiles_side() * optical_path_tiles_side() * optical_path_tiles_side()";

/// What is put in place of what in the recipe's text.
type Change = (&'static str, String);

/// Which tiles are taken up: what it is called, and how the recipe's text changes for it.
fn ways() -> [(&'static str, Vec<Change>); 3] {
    [
        ("tiles with matter that may change", Vec::new()),
        ("tiles that may change", vec![("            if (its.x | its.y) != 0u {", "            if true {".to_owned())]),
        (
            "all tiles",
            vec![
                (
                    "    workgroups[0] = (optical_path_next() + OPTICAL_PATH_GROUP - 1u) / OPTICAL_PATH_GROUP;",
                    format!(
                        "    workgroups[0] = select(0u, ({ALL_TILES} + OPTICAL_PATH_GROUP - 1u) / OPTICAL_PATH_GROUP, \
                         optical_path_next() > 0u);"
                    ),
                ),
                (
                    "    if invocation.x >= atomicLoad(&progress.listed[current]) {",
                    format!("    if invocation.x >= {ALL_TILES} {{"),
                ),
                (
                    "    let tile = lists[current * side * side * side + invocation.x];",
                    "    let tile = invocation.x;".to_owned(),
                ),
            ],
        ),
    ]
}

/// One way to choose tiles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TileWay {
    /// Which tiles are taken up.
    pub way: String,
    /// The least of the rounds, in milliseconds for a whole solve.
    pub ms: f64,
    /// Passes in which anything was left to do.
    pub passes: u32,
    /// Tiles that were taken up, one as often as it was.
    pub updates: u64,
    /// Voxels whose costs have other bits than the first way's.
    pub differing: u32,
}

/// A grid, solved in each way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tiles {
    /// The scene whose body it is.
    pub scene: String,
    /// The solver's name.
    pub method: String,
    /// Voxels along an edge.
    pub cells: u32,
    /// Share of the grid's tiles that hold matter.
    pub with_matter: f64,
    /// From restraint to none.
    pub ways: Vec<TileWay>,
}

/// The body's voxels and the seeds of light along x, on the device.
struct Body {
    matter: wgpu::Buffer,
    seeds: wgpu::Buffer,
    cost: wgpu::Buffer,
    with_matter: f64,
}

impl Body {
    fn new(gpu: &Gpu, mesh: &Mesh, grid: VoxelGrid) -> Result<Self, RenderError> {
        let voxelizer = Voxelizer::new(gpu, grid, mesh, &[])?;
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let storage = |contents: &[u8]| {
            gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("a body's mesh"),
                contents,
                usage: wgpu::BufferUsages::STORAGE,
            })
        };
        let [positions, indices] =
            [bytemuck::cast_slice(&mesh.positions), bytemuck::cast_slice(&mesh.indices)].map(storage);
        voxelizer.encode(&mut encoder, &positions, &indices)?;
        gpu.queue.submit([encoder.finish()]);
        let words = gpu.words(&voxelizer.matter)?;
        let (seeds, with_matter) = seeded(&words, grid);
        let (seeds, cost) = gpu.guarded("allocating a body's costs", |device| {
            use wgpu::BufferUsages as Usage;
            let usage = Usage::STORAGE | Usage::COPY_SRC | Usage::COPY_DST;
            let contents = bytemuck::cast_slice(&seeds);
            let buffer = || {
                let descriptor = wgpu::util::BufferInitDescriptor { label: Some("a body's costs"), contents, usage };
                device.create_buffer_init(&descriptor)
            };
            (buffer(), buffer())
        })?;
        Ok(Self { matter: voxelizer.matter, seeds, cost, with_matter })
    }
}

/// Seeds of cost 0 at the first voxel of matter in each row along x, and the share of tiles that hold matter.
fn seeded(words: &[u32], grid: VoxelGrid) -> (Vec<f32>, f64) {
    let mut seeds = vec![OPTICAL_PATH_UNREACHED; grid.count()];
    let side = grid.cells / TILE;
    let mut held = vec![false; (side as usize).pow(3)];
    let rows = (0..grid.cells).flat_map(|z| (0..grid.cells).map(move |y| (y, z)));
    for ((y, z), row) in rows.zip(words.chunks_exact(grid.words_per_row() as usize)) {
        let mut is_first = true;
        for x in (0..grid.cells).filter(|x| row[(x / u32::BITS) as usize] >> (x % u32::BITS) & 1 == 1) {
            if is_first {
                seeds[grid.index(glam::UVec3::new(x, y, z))] = 0.0;
            }
            is_first = false;
            held[(x / TILE + side * (y / TILE + side * (z / TILE))) as usize] = true;
        }
    }
    let count = held.iter().filter(|held| **held).count();
    (seeds, count as f64 / held.len() as f64)
}

/// One solve from the seeds, and its time in milliseconds.
fn solve(gpu: &Gpu, solver: &Solver<'_>, body: &Body, extinction: f32) -> Result<f64, RenderError> {
    let encoder = || gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let submit_and_wait = |encoder: Encoder| {
        gpu.guarded("solving by tiles", |device| {
            gpu.queue.submit([encoder.finish()]);
            device.poll(wgpu::PollType::wait_indefinitely())
        })
    };
    let mut before = encoder();
    before.copy_buffer_to_buffer(&body.seeds, 0, &body.cost, 0, body.seeds.size());
    submit_and_wait(before)?.ok();
    let start = Instant::now();
    let mut solving = encoder();
    solver.encode(&mut solving, &body.matter, None, &body.cost, extinction)?;
    submit_and_wait(solving)?.ok();
    Ok(start.elapsed().as_secs_f64() * 1e3)
}

/// Every grid in every way, round by round.
pub(super) fn measure(gpu: &Gpu, rounds: u32, progress: &mut dyn FnMut(u64, u64)) -> Result<Vec<Tiles>, CostError> {
    let scene = Scene::named(SCENE)?;
    let mesh = &scene.objects[0].mesh;
    let plain = lapidary_wgsl::recipe_source("optical_path_tiles");
    let mut found = Vec::new();
    for (done, cells) in (1..).zip(CELLS) {
        let grid = VoxelGrid::about(Bounds::of(mesh.positions.iter().copied()), cells);
        let body = Body::new(gpu, mesh, grid)?;
        let extinction = DEPTH / (grid.spacing * cells as f32);
        let mut solvers = Vec::new();
        for (_, changes) in ways() {
            let source = changes.iter().fold(plain.clone(), |source, (right, cut)| source.replace(right, cut));
            let solver = Solver::of_source(gpu, grid, METHOD, false, None, &source).map_err(RenderError::from)?;
            solvers.push(solver);
        }
        let tiles = u64::from(cells / TILE).pow(3);
        let mut ways: Vec<TileWay> = Vec::new();
        let mut first: Option<Vec<u32>> = None;
        for ((way, changes), solver) in self::ways().iter().zip(&solvers) {
            let ms = solve(gpu, solver, &body, extinction)?;
            let status = solver.status().map_err(RenderError::from)?;
            let costs = gpu.words(&body.cost).map_err(RenderError::from)?;
            let first = first.get_or_insert_with(|| costs.clone());
            let differing = first.iter().zip(&costs).filter(|(one, other)| one != other).count() as u32;
            // The solver counts what is listed, which these do not go by.
            let takes_all = changes.len() > 1;
            let updates = if takes_all { tiles * u64::from(status.passes) } else { u64::from(status.updates) };
            ways.push(TileWay { way: (*way).to_owned(), ms, passes: status.passes, updates, differing });
        }
        for _ in 0..rounds {
            for (solver, way) in solvers.iter().zip(&mut ways) {
                way.ms = way.ms.min(solve(gpu, solver, &body, extinction)?);
            }
        }
        let (scene, method, with_matter) = (SCENE.to_owned(), METHOD.to_string(), body.with_matter);
        found.push(Tiles { scene, method, cells, with_matter, ways });
        progress(done, CELLS.len() as u64);
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_change_finds_its_text_once() {
        let source = lapidary_wgsl::recipe_source("optical_path_tiles");
        for (way, changes) in ways() {
            for (right, _) in changes {
                assert_eq!(source.matches(right).count(), 1, "{way}: {right}");
            }
        }
    }
}
