// optical_path_grid: a body's voxels, their costs, and how far a solver has come.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own.
//
// A recipe adds: the part matter; what it does in a pass, from which voxels or tiles, and where the workgroups of its next pass come from.

// Neighbours of a voxel that edges lead to: 6, 18 or 26.
override OPTICAL_PATH_STENCIL: u32 = 26u;
// A material whose extinction varies within it: then each voxel has a density, by which the extinction is multiplied.
override EFFECT_EXTINCTION_PER_VOXEL: bool = false;  //+extinction_per_voxel

struct OpticalPathGrid {
    // Voxels along an edge of the cube: a multiple of 8, at most 256. Voxel (x, y, z) has the number x + cells (y + cells z).
    cells: u32,
    // In the inverse of the spacing's unit, at least 0.
    extinction: f32,
    // A voxel's edge.
    spacing: f32,
}

// What the device keeps of a solve; the host clears it to 0 but for `least`, which begins as unreached.
struct OpticalPathProgress {
    // Passes begun.
    step: u32,
    // Passes in which anything was left to do.
    passes: u32,
    // Tiles or voxels that these took up.
    updates: u32,
    // Tiles or voxels that the next pass, by its number's parity, is to take up.
    listed: array<atomic<u32>, 2>,
    // The least cost that passes on from them, encoded: no cost up to it will change any more.
    least: array<atomic<u32>, 2>,
}

@group(0) @binding(0) var<uniform> grid: OpticalPathGrid;
@group(0) @binding(1) var<storage, read> matter: array<u32>;
// Before a solve the seeds, unreached elsewhere; then the costs. Encoded, so that passes may read what others write.
@group(0) @binding(2) var<storage, read_write> costs: array<atomic<u32>>;
@group(0) @binding(3) var<storage, read_write> progress: OpticalPathProgress;
// Of the next indirect dispatch.
@group(0) @binding(4) var<storage, read_write> workgroups: array<u32, 3>;
// At least 0, by voxel.
@group(0) @binding(5) var<storage, read> density: array<f32>;  //+extinction_per_voxel

fn optical_path_voxel(voxel: vec3u) -> u32 {
    return voxel.x + grid.cells * (voxel.y + grid.cells * voxel.z);
}

fn optical_path_extinction(index: u32) -> f32 {
    if EFFECT_EXTINCTION_PER_VOXEL {  //+extinction_per_voxel
        return grid.extinction * density[index];  //+extinction_per_voxel
    }  //+extinction_per_voxel
    return grid.extinction;
}

// What the solve begins from: nothing but costs, and those in matter alone.
fn optical_path_seeded(voxel: vec3u) -> u32 {
    let cost = optical_path_encode(bitcast<f32>(atomicLoad(&costs[optical_path_voxel(voxel)])));
    return select(optical_path_encode(OPTICAL_PATH_UNREACHED), cost, matter_is_at(grid.cells, voxel));
}

// Begins a pass. Returns: how many tiles or voxels it is to take up.
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
