//! Optical paths through a body, solved only in tiles that hold matter and may change, compared
//! with solvers that process more tiles.

use lapidary_gpu::Gpu;
use lapidary_ladders::{CostError, Report, Row};
use lapidary_optical_path::OPTICAL_PATH_UNREACHED;
use lapidary_render::RenderError;
use lapidary_render::solver::{LoneSolver, Solve};
use lapidary_render::voxel_grid::VoxelGrid;
use lapidary_render::voxelization;
use lapidary_scene::solver::{Method, Stencil};
use lapidary_scene::{Bounds, Scene};
use std::time::Instant;

/// The scene whose body is solved.
const SCENE: &str = "bunny";
/// Voxels along an edge of each grid.
const CELLS: [u32; 3] = [32, 64, 128];
/// The graph's costs are bit-identical, whatever the order of the search.
const METHOD: Method = Method::Tiled(Stencil::Corners);
/// Optical depth across the grid; light comes from one side.
const DEPTH: f32 = 8.0;
/// Voxels along an edge of a tile.
const TILE: u32 = 4;

const ALL_TILES: &str = "optical_path_tiles_side() * optical_path_tiles_side() * optical_path_tiles_side()";

/// A replacement in the recipe's source: the original text and the new one.
type Change = (&'static str, String);

/// Returns the ways to choose the tiles to process: name and changes to the recipe's source.
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

/// Returns seeds of cost 0 at the first voxel of matter in each row along x, and the fraction of
/// tiles that hold matter.
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

/// Solves once from the seeds and returns the time in milliseconds.
fn solve(gpu: &Gpu, solver: &LoneSolver<'_>, seeds: &[f32]) -> Result<f64, RenderError> {
    let wait =
        || gpu.guarded("solving by tiles", |device| device.poll(wgpu::PollType::wait_indefinitely())).map(Result::ok);
    solver.set_seeds(seeds)?;
    gpu.queue.submit([]);
    wait()?;
    let start = Instant::now();
    solver.run()?;
    wait()?;
    Ok(start.elapsed().as_secs_f64() * 1e3)
}

/// Adds every grid in every way, round by round: the fraction of the grid's tiles that hold matter,
/// the passes that had work to do, the updates of tiles, where a tile counts each time it is
/// processed, and the voxels whose cost is not bit-identical to the first way's.
pub(super) fn measure(
    gpu: &Gpu,
    rounds: u32,
    report: &mut Report,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<(), CostError> {
    let scene = Scene::named(SCENE)?;
    let mesh = &scene.objects[0].mesh;
    let plain = lapidary_wgsl::recipe_source("optical_path_tiles");
    for (done, cells) in (1..).zip(CELLS) {
        let grid = VoxelGrid::about(Bounds::of(mesh.positions.iter().copied()), cells);
        let matter = voxelization::matter(gpu, grid, mesh, &[]).map_err(RenderError::from)?;
        let (seeds, with_matter) = seeded(&matter, grid);
        let extinction = DEPTH / (grid.spacing * cells as f32);
        let mut solvers = Vec::new();
        for (_, changes) in ways() {
            let source = changes.iter().fold(plain.clone(), |source, (right, cut)| source.replace(right, cut));
            let solve = Solve { method: METHOD, heterogeneous: false, most_passes: None };
            let solver = LoneSolver::new(gpu, grid, solve, extinction, Some(&source)).map_err(RenderError::from)?;
            solver.set_body(&matter, &[]).map_err(lapidary_render::RenderError::from)?;
            solvers.push(solver);
        }
        let tiles = u64::from(cells / TILE).pow(3);
        let mut first: Option<Vec<f32>> = None;
        let mut counts = Vec::new();
        let mut times = Vec::new();
        for ((_, changes), solver) in ways().iter().zip(&solvers) {
            times.push(solve(gpu, solver, &seeds)?);
            let status = solver.status().map_err(RenderError::from)?;
            let costs = solver.costs().map_err(RenderError::from)?;
            let first = first.get_or_insert_with(|| costs.clone());
            let differing = first.iter().zip(&costs).filter(|(one, other)| one.to_bits() != other.to_bits()).count();
            // The solver counts listed tiles, but this variant ignores the list.
            let takes_all = changes.len() > 1;
            let updates = if takes_all { tiles * u64::from(status.passes) } else { u64::from(status.updates) };
            counts.push([
                ("with matter", with_matter),
                ("passes", status.passes.into()),
                ("updates", updates as f64),
                ("differing", differing as f64),
            ]);
        }
        for _ in 0..rounds {
            for (solver, ms) in solvers.iter().zip(&mut times) {
                *ms = ms.min(solve(gpu, solver, &seeds)?);
            }
        }
        for (((way, _), counts), ms) in ways().iter().zip(counts).zip(times) {
            let rung = format!("{METHOD}-{cells}, {way}");
            report
                .rows
                .extend(counts.map(|(measure, value)| Row::new(&rung, SCENE, measure, value, "").timed(Some(ms))));
        }
        progress(done, CELLS.len() as u64);
    }
    Ok(())
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
