// optical_path_grid: a body's voxels, their costs, and how far a solver has come.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own.
//
// A recipe adds: the part matter; the work of a pass, and its voxels or tiles; and the source of
// the workgroup counts of its next pass.

// Number of neighbours that edges connect a voxel to: 6, 18 or 26.
override OPTICAL_PATH_STENCIL: u32 = 26u;
// Extinction varies within the material: each voxel has a density that multiplies the extinction.
override EFFECT_EXTINCTION_PER_VOXEL: bool = false;

struct OpticalPathGrid {
    // Voxels along an edge of the cube: a multiple of 8, at most 256. Voxel (x, y, z) has the
    // number x + cells (y + cells z).
    cells: u32,
    // Extinction in the inverse of the spacing's unit, at least 0.
    extinction: f32,
    // Edge length of a voxel.
    spacing: f32,
}

// The device's record of a solve. The host clears it to 0, except for `least`, which begins as
// unreached.
struct OpticalPathProgress {
    // Number of passes begun.
    step: u32,
    // Number of passes that had anything left to do.
    passes: u32,
    // Number of tiles or voxels that these passes processed.
    updates: u32,
    // Number of tiles or voxels that the next pass is to process, indexed by the parity of its
    // number.
    listed: array<atomic<u32>, 2>,
    // The smallest cost that these tiles or voxels pass on, encoded: no cost up to it will change
    // any more.
    least: array<atomic<u32>, 2>,
}

@group(0) @binding(0) var<uniform> grid: OpticalPathGrid;
@group(0) @binding(1) var<storage, read> matter: array<u32>;
// Before a solve, the seeds, and unreached elsewhere; after it, the costs. Encoded, so that a pass
// may read values while they are written.
@group(0) @binding(2) var<storage, read_write> costs: array<atomic<u32>>;
@group(0) @binding(3) var<storage, read_write> progress: OpticalPathProgress;
// Workgroup counts of the next indirect dispatch.
@group(0) @binding(4) var<storage, read_write> workgroups: array<u32, 3>;
// Density of each voxel, at least 0.
@group(0) @binding(5) var<storage, read> density: array<f32>;

fn optical_path_voxel(voxel: vec3u) -> u32 {
    return voxel.x + grid.cells * (voxel.y + grid.cells * voxel.z);
}

fn optical_path_extinction(index: u32) -> f32 {
    if EFFECT_EXTINCTION_PER_VOXEL {
        return grid.extinction * density[index];
    }
    return grid.extinction;
}

// Cost of a voxel at the start of a solve, encoded: always a valid cost, and unreached outside
// matter.
fn optical_path_seeded(voxel: vec3u) -> u32 {
    let cost = optical_path_encode(bitcast<f32>(atomicLoad(&costs[optical_path_voxel(voxel)])));
    return select(optical_path_encode(OPTICAL_PATH_UNREACHED), cost, matter_is_at(grid.cells, voxel));
}

// Begins a pass and returns the number of tiles or voxels that it is to process.
fn optical_path_next() -> u32 {
    let current = progress.step & 1u;
    let count = atomicLoad(&progress.listed[current]);
    progress.step += 1u;
    progress.updates += count;
    if count > 0u {
        progress.passes = progress.step;
    }
    atomicStore(&progress.listed[1u - current], 0u);
    atomicStore(&progress.least[1u - current], optical_path_encode(OPTICAL_PATH_UNREACHED));
    return count;
}
