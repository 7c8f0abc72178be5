// optical_path_sweep: least optical depths over all voxels, every voxel in every pass.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Ozawa, Okamoto and Morishima, "Real-time rendering of translucent material using Dynamic
//   Programming", section 2.
// requires: optical_path
// parts: matter, optical_path_grid
// compares: optical_path
//
// 1. Dispatch `optical_path_sweep_begin`.
// 2. For each pass of the budget, dispatch `optical_path_sweep_next` with one workgroup, then one of
//    these with the indirect arguments that it has written.
//    - `optical_path_sweep_pull`, with `costs` and `work` exchanged in every second pass, for an
//      even number of passes: every voxel takes the least that its neighbours offer.
//    - `optical_path_sweep_push`, the paper's method: every voxel that was written in the last pass
//      offers its value to its six neighbours.
//    After the first pass that changes nothing, the remaining passes have no workgroups.

// Pull: the new `costs` of this pass. Push: the number of the pass in which the voxel's cost is to
// be offered.
@group(0) @binding(6) var<storage, read_write> work: array<atomic<u32>>;

// Solves by the paper's method.
override OPTICAL_PATH_PAPER: bool = false;

@compute @workgroup_size(8, 8, 1)
fn optical_path_sweep_begin(@builtin(global_invocation_id) voxel: vec3u) {
    let index = optical_path_voxel(voxel);
    let cost = optical_path_seeded(voxel);
    let reached = optical_path_decode(cost) < OPTICAL_PATH_UNREACHED;
    atomicStore(&costs[index], cost);
    if OPTICAL_PATH_PAPER {
        atomicStore(&work[index], select(0u, 1u, reached));
    } else {
        atomicStore(&work[index], cost);
    }
    if reached {
        atomicAdd(&progress.listed[0u], 1u);
        atomicMin(&progress.least[0u], cost);
    }
}

@compute @workgroup_size(1)
fn optical_path_sweep_next() {
    let some = optical_path_next() > 0u;
    let side = select(0u, grid.cells / 8u, some);
    workgroups[0] = side;
    workgroups[1] = side;
    workgroups[2] = select(0u, grid.cells, some);
}

// Counts a voxel whose cost was lowered in this pass.
fn optical_path_lowered(cost: u32) {
    let next = progress.step & 1u;
    atomicAdd(&progress.listed[next], 1u);
    atomicMin(&progress.least[next], cost);
}

@compute @workgroup_size(8, 8, 1)
fn optical_path_sweep_pull(@builtin(global_invocation_id) voxel: vec3u) {
    if !matter_is_at(grid.cells, voxel) {
        return;
    }
    let index = optical_path_voxel(voxel);
    let before = optical_path_decode(atomicLoad(&costs[index]));
    let extinction = optical_path_extinction(index);
    var cost = before;
    for (var z = -1i; z <= 1i; z++) {
        for (var y = -1i; y <= 1i; y++) {
            for (var x = -1i; x <= 1i; x++) {
                // 1, 2 or 3 axes: the square of the edge's length in voxels.
                let axes = u32(abs(x) + abs(y) + abs(z));
                let place = vec3u(vec3i(voxel) + vec3i(x, y, z));
                let in_stencil = axes == 1u
                    || (axes == 2u && OPTICAL_PATH_STENCIL >= 18u)
                    || (axes == 3u && OPTICAL_PATH_STENCIL == 26u);
                // Coordinates below 0 wrap round to large ones.
                if in_stencil && all(place < vec3u(grid.cells)) {
                    let neighbour = optical_path_voxel(place);
                    let length = grid.spacing * select(select(1.7320508f, 1.4142135f, axes == 2u), 1.0f, axes == 1u);
                    let edge = optical_path_edge(extinction, optical_path_extinction(neighbour), length);
                    cost = optical_path_relax(cost, optical_path_decode(atomicLoad(&costs[neighbour])), edge);
                }
            }
        }
    }
    atomicStore(&work[index], optical_path_encode(cost));
    if cost < before {
        optical_path_lowered(optical_path_encode(cost));
    }
}

@compute @workgroup_size(8, 8, 1)
fn optical_path_sweep_push(@builtin(global_invocation_id) voxel: vec3u) {
    let index = optical_path_voxel(voxel);
    if atomicLoad(&work[index]) != progress.step {
        return;
    }
    let cost = optical_path_decode(atomicLoad(&costs[index]));
    let extinction = optical_path_extinction(index);
    for (var side = 0u; side < 6u; side++) {
        var offset = vec3i(0i);
        offset[side >> 1u] = select(-1i, 1i, (side & 1u) == 1u);
        let place = vec3u(vec3i(voxel) + offset);
        if all(place < vec3u(grid.cells)) && matter_is_at(grid.cells, place) {
            let neighbour = optical_path_voxel(place);
            let edge = optical_path_edge_paper(extinction, optical_path_extinction(neighbour));
            let offered = optical_path_encode(optical_path_relax(OPTICAL_PATH_UNREACHED, cost, edge));
            if offered < atomicMin(&costs[neighbour], offered) {
                // A voxel written twice in a pass is listed once for the next.
                if atomicExchange(&work[neighbour], progress.step + 1u) != progress.step + 1u {
                    atomicAdd(&progress.listed[progress.step & 1u], 1u);
                }
                atomicMin(&progress.least[progress.step & 1u], offered);
            }
        }
    }
}
