// diffusion_solve: the fluence in a body's cells, by multigrid: sweeps in two colours, corrections by coarser grids.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Trottenberg, Oosterlee and Schueller, "Multigrid", 2001, sections 2 and 5; Stam, "Multiple
//   Scattering as a Diffusion Process", 1995, for light; Braess, "Towards Algebraic Multigrid for
//   Elliptic Problems of Second Order", Computing 55 (1995), for the factor of coarse faces.
// requires: diffusion
// parts: diffusion_nodes, diffusion_packed, tiles
//
// Levels are numbered from the finest. Each has its own buffers, and half the cells along each edge,
// rounded up. The coarsest has at most four along each edge, a single tile.
// Once the recipe diffusion_cells has made the finest level's equations and listed its tiles, and `faces` and
// `reactions` of the others are cleared, with `workgroups` as (0, 1, 1):
// 1. From the finest level to the last but one `diffusion_solve_coarsen`, which makes the next level's equations,
//    and on that level `diffusion_solve_list`, one invocation per tile of 4 x 4 x 4 cells. All else is dispatched
//    indirectly, by the count of the level's tiles.
// 2. Cycles: on each level from the finest, `diffusion_solve_sweep` twice for each colour, then
//    `diffusion_solve_restrict` to the next level; on the coarsest `diffusion_solve_coarsest`, one workgroup;
//    back up, `diffusion_solve_prolong` to the next finer level, and sweeps in the colours' reverse order.
//    From no light at all, with the finest `fluence` cleared, a first cycle sweeps on the way up alone, and not on
//    the finest level.
// 3. More cycles, dispatched by copies of the counts. Before each, with `residuals` cleared before the first,
//    `diffusion_solve_residual` on the finest level, and on each level `diffusion_solve_stop`, one workgroup, with
//    the copy as `workgroups`: once enough of the equations is solved, it sets the count to 0, and nothing more
//    is done. The finest level's residual is also what a host may read.
// 4. `diffusion_solve_pack`, with `packed` cleared before, for the recipe that shades.
// With the flux limiter conductances of the finest level are limited by the fluence as it is: in
// `diffusion_solve_sweep`, `diffusion_solve_restrict`, `diffusion_solve_residual` and, at the start of each
// cycle, the first one too, `diffusion_solve_coarsen`, whose conductances are then made anew from level to
// level. They read `nodes` and `level.extinction`.

// The factor of a coarse face, of the sum of the faces that it joins: a correction that is constant
// within each coarse cell has slopes twice as steep as one that is linear.
const DIFFUSION_COARSE: f32 = 0.5f;
// Turns on the coarsest level, each of a correction of the mean and of a sweep over both colours. Four cells in
// a row keep a third of an error that is linear along it.
const DIFFUSION_TURNS: u32 = 6u;

// Conductances are limited by the fluence: the flux limiter, on the finest level.
override DIFFUSION_LIMITED: bool = false;

// What may be left of the equations, as a share of their right side.
override DIFFUSION_ENOUGH: f32 = 0.001f;

struct DiffusionLevel {
    // Cells along an edge.
    cells: u32,
    // The colour of the sweep: the parity of x + y + z.
    color: u32,
    // Extinction per voxel spacing where the density is 1, in each channel, for the flux limiter.
    extinction: vec3f,
}

@group(0) @binding(0) var<uniform> level: DiffusionLevel;
// Tiles that hold matter.
@group(0) @binding(1) var<storage, read_write> tiles: array<u32>;
@group(0) @binding(2) var<storage, read_write> workgroups: array<atomic<u32>, 3>;
@group(0) @binding(3) var<storage, read_write> faces: array<f32>;
@group(0) @binding(4) var<storage, read_write> reactions: array<vec4f>;
// Fluence and the equations' right side in each channel; the fourth number is not used.
@group(0) @binding(5) var<storage, read_write> fluence: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> right: array<vec4f>;
// Of the next coarser level.
@group(1) @binding(0) var<storage, read_write> coarser_faces: array<f32>;
@group(1) @binding(1) var<storage, read_write> coarser_reactions: array<vec4f>;
@group(1) @binding(2) var<storage, read_write> coarser_fluence: array<vec4f>;
@group(1) @binding(3) var<storage, read_write> coarser_right: array<vec4f>;
// Words of the part diffusion_nodes, and those of the part diffusion_packed.
@group(1) @binding(4) var<storage, read> nodes: array<u32>;
@group(1) @binding(5) var<storage, read_write> packed: array<vec2u>;
// For each listed tile, sums over its cells of squares in each channel: of what is left of the equations, and of
// their right side.
@group(1) @binding(6) var<storage, read_write> residuals: array<array<vec4f, 2>>;

fn diffusion_index(cell: vec3u, cells: u32) -> u32 {
    return cell.x + cells * (cell.y + cells * cell.z);
}

// A face's conductances in each channel with the flux limiter: between a cell and the next one along an axis.
fn diffusion_limited(conductance: f32, lower: u32, upper: u32, axis: u32) -> vec3f {
    // A conductance is the open share over the optical distance.
    let thickness = level.extinction * (diffusion_open(nodes[lower] & 255u, nodes[upper], axis) / conductance);
    let one = fluence[lower];
    let other = fluence[upper];
    return conductance * vec3f(
        diffusion_limit(one.x, other.x, thickness.x),
        diffusion_limit(one.y, other.y, thickness.y),
        diffusion_limit(one.z, other.z, thickness.z),
    );
}

// What a face adds to the coarser face that it is part of, which all channels share: with the flux limiter the largest
// of theirs, so that no correction overshoots.
fn diffusion_joined(lower: u32, axis: u32) -> f32 {
    let conductance = faces[3u * lower + axis];
    if (DIFFUSION_LIMITED && conductance > 0.0f) {
        let stride = select(select(level.cells * level.cells, level.cells, axis == 1u), 1u, axis == 0u);
        let each = diffusion_limited(conductance, lower, lower + stride, axis);
        return max(each.x, max(each.y, each.z));
    }
    return conductance;
}

// Makes the coarser level's equations. A workgroup is a tile, and each of its lanes a coarse cell.
@compute @workgroup_size(8)
fn diffusion_solve_coarsen(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let corner = tile_corner(tiles[group.x], level.cells) + 2u * vec3u(lane & 1u, (lane >> 1u) & 1u, lane >> 2u);
    if (any(corner >= vec3u(level.cells))) {
        return;
    }
    var reaction = vec4f(0.0f);
    var conductances = vec3f(0.0f);
    for (var part = 0u; part < 8u; part++) {
        let step = vec3u(part & 1u, (part >> 1u) & 1u, part >> 2u);
        if (any(corner + step >= vec3u(level.cells))) {
            continue;
        }
        let child = diffusion_index(corner + step, level.cells);
        reaction += reactions[child];
        for (var axis = 0u; axis < 3u; axis++) {
            if (step[axis] == 1u) {
                conductances[axis] += diffusion_joined(child, axis);
            }
        }
    }
    let parent = diffusion_index(corner / 2u, (level.cells + 1u) / 2u);
    coarser_reactions[parent] = reaction;
    for (var axis = 0u; axis < 3u; axis++) {
        coarser_faces[3u * parent + axis] = DIFFUSION_COARSE * conductances[axis];
    }
}

@compute @workgroup_size(64)
fn diffusion_solve_list(@builtin(global_invocation_id) invocation: vec3u) {
    let side = (level.cells + 3u) / 4u;
    if (invocation.x >= side * side * side) {
        return;
    }
    let corner = tile_corner(invocation.x, level.cells);
    let end = min(corner + 4u, vec3u(level.cells));
    for (var z = corner.z; z < end.z; z++) {
        for (var y = corner.y; y < end.y; y++) {
            for (var x = corner.x; x < end.x; x++) {
                if (reactions[diffusion_index(vec3u(x, y, z), level.cells)].w > 0.0f) {
                    tiles[atomicAdd(&workgroups[0], 1u)] = invocation.x;
                    return;
                }
            }
        }
    }
}

// Sums over a cell's faces: the fluence beyond each, times its conductance; and the conductances.
struct DiffusionFaces {
    inflow: vec3f,
    conductances: vec3f,
}

fn diffusion_across(cell: vec3u, index: u32) -> DiffusionFaces {
    var inflow = vec3f(0.0f);
    // Of all channels alike, and of each.
    var alike = 0.0f;
    var each = vec3f(0.0f);
    var stride = 1u;
    for (var axis = 0u; axis < 3u; axis++) {
        let above = faces[3u * index + axis];
        if (above > 0.0f) {
            if (DIFFUSION_LIMITED) {
                let limited = diffusion_limited(above, index, index + stride, axis);
                inflow += limited * fluence[index + stride].xyz;
                each += limited;
            } else {
                inflow += above * fluence[index + stride].xyz;
                alike += above;
            }
        }
        if (cell[axis] > 0u) {
            let below = faces[3u * (index - stride) + axis];
            if (below > 0.0f) {
                if (DIFFUSION_LIMITED) {
                    let limited = diffusion_limited(below, index - stride, index, axis);
                    inflow += limited * fluence[index - stride].xyz;
                    each += limited;
                } else {
                    inflow += below * fluence[index - stride].xyz;
                    alike += below;
                }
            }
        }
        stride *= level.cells;
    }
    return DiffusionFaces(inflow, each + alike);
}

// The place in a tile of one of the 32 cells of a colour.
fn diffusion_colored(lane: u32, color: u32) -> vec3u {
    let y = (lane >> 1u) & 3u;
    let z = lane >> 3u;
    return vec3u(2u * (lane & 1u) + ((y + z + color) & 1u), y, z);
}

// Solves a cell's equations for its neighbours as they are.
fn diffusion_relax_cell(cell: vec3u) {
    if (any(cell >= vec3u(level.cells))) {
        return;
    }
    let index = diffusion_index(cell, level.cells);
    let reaction = reactions[index];
    if (reaction.w <= 0.0f) {
        return;
    }
    let across = diffusion_across(cell, index);
    let load = right[index];
    fluence[index] = vec4f(
        diffusion_relax(load.x, across.inflow.x, across.conductances.x, reaction.x),
        diffusion_relax(load.y, across.inflow.y, across.conductances.y, reaction.y),
        diffusion_relax(load.z, across.inflow.z, across.conductances.z, reaction.z),
        0.0f,
    );
}

@compute @workgroup_size(32)
fn diffusion_solve_sweep(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    diffusion_relax_cell(tile_corner(tiles[group.x], level.cells) + diffusion_colored(lane, level.color));
}

// The residual of a cell's equations.
fn diffusion_residual(cell: vec3u, index: u32) -> vec3f {
    let across = diffusion_across(cell, index);
    return right[index].xyz + across.inflow - (across.conductances + reactions[index].xyz) * fluence[index].xyz;
}

// What each lane's two cells leave of their equations, and what they lose for a fluence of 1.
var<workgroup> lefts: array<vec3f, 32>;
var<workgroup> losses: array<vec3f, 32>;

@compute @workgroup_size(32)
fn diffusion_solve_coarsest(@builtin(local_invocation_index) lane: u32) {
    for (var turn = 0u; turn < DIFFUSION_TURNS; turn++) {
        var left = vec3f(0.0f);
        var loss = vec3f(0.0f);
        for (var color = 0u; color < 2u; color++) {
            let cell = diffusion_colored(lane, color);
            let index = diffusion_index(min(cell, vec3u(level.cells - 1u)), level.cells);
            if (all(cell < vec3u(level.cells)) && reactions[index].w > 0.0f) {
                left += diffusion_residual(cell, index);
                loss += reactions[index].xyz;
            }
        }
        lefts[lane] = left;
        losses[lane] = loss;
        workgroupBarrier();
        // Nobody changes the fluence before all have read it.
        storageBarrier();
        left = vec3f(0.0f);
        loss = vec3f(0.0f);
        for (var other = 0u; other < 32u; other++) {
            left += lefts[other];
            loss += losses[other];
        }
        let mean = vec3f(
            diffusion_relax(left.x, 0.0f, 0.0f, loss.x),
            diffusion_relax(left.y, 0.0f, 0.0f, loss.y),
            diffusion_relax(left.z, 0.0f, 0.0f, loss.z),
        );
        for (var color = 0u; color < 2u; color++) {
            let cell = diffusion_colored(lane, color);
            let index = diffusion_index(min(cell, vec3u(level.cells - 1u)), level.cells);
            if (all(cell < vec3u(level.cells)) && reactions[index].w > 0.0f) {
                fluence[index] += vec4f(mean, 0.0f);
            }
        }
        storageBarrier();
        for (var color = 0u; color < 2u; color++) {
            diffusion_relax_cell(diffusion_colored(lane, color));
            storageBarrier();
        }
        // Nor the sums.
        workgroupBarrier();
    }
}

// Adds up this level's residuals as the coarser level's right side, whose fluence begins as 0. A
// workgroup is a tile, and each of its lanes a coarse cell.
@compute @workgroup_size(8)
fn diffusion_solve_restrict(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let corner = tile_corner(tiles[group.x], level.cells) + 2u * vec3u(lane & 1u, (lane >> 1u) & 1u, lane >> 2u);
    if (any(corner >= vec3u(level.cells))) {
        return;
    }
    var left = vec3f(0.0f);
    for (var part = 0u; part < 8u; part++) {
        let cell = corner + vec3u(part & 1u, (part >> 1u) & 1u, part >> 2u);
        if (any(cell >= vec3u(level.cells))) {
            continue;
        }
        let index = diffusion_index(cell, level.cells);
        if (reactions[index].w > 0.0f) {
            left += diffusion_residual(cell, index);
        }
    }
    let parent = diffusion_index(corner / 2u, (level.cells + 1u) / 2u);
    coarser_right[parent] = vec4f(left, 0.0f);
    coarser_fluence[parent] = vec4f(0.0f);
}

// Adds the coarser level's correction.
@compute @workgroup_size(64)
fn diffusion_solve_prolong(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let cell = tile_corner(tiles[group.x], level.cells) + tile_cell(lane);
    if (any(cell >= vec3u(level.cells))) {
        return;
    }
    let index = diffusion_index(cell, level.cells);
    let parent = diffusion_index(cell / 2u, (level.cells + 1u) / 2u);
    if (reactions[index].w > 0.0f) {
        fluence[index] += coarser_fluence[parent];
    }
}

var<workgroup> squares: array<array<vec3f, 2>, 64>;

@compute @workgroup_size(64)
fn diffusion_solve_residual(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let cell = tile_corner(tiles[group.x], level.cells) + tile_cell(lane);
    let index = diffusion_index(min(cell, vec3u(level.cells - 1u)), level.cells);
    squares[lane] = array<vec3f, 2>(vec3f(0.0f), vec3f(0.0f));
    if (all(cell < vec3u(level.cells)) && reactions[index].w > 0.0f) {
        let left = diffusion_residual(cell, index);
        let load = right[index].xyz;
        squares[lane] = array<vec3f, 2>(left * left, load * load);
    }
    workgroupBarrier();
    if (lane > 0u) {
        return;
    }
    for (var number = 0u; number < 2u; number++) {
        var sum = vec3f(0.0f);
        for (var other = 0u; other < 64u; other++) {
            sum += squares[other][number];
        }
        residuals[group.x][number] = vec4f(sum, 0.0f);
    }
}

@compute @workgroup_size(64)
fn diffusion_solve_stop(@builtin(local_invocation_index) lane: u32) {
    var left = vec3f(0.0f);
    var load = vec3f(0.0f);
    for (var tile = lane; tile < arrayLength(&residuals); tile += 64u) {
        left += residuals[tile][0].xyz;
        load += residuals[tile][1].xyz;
    }
    squares[lane] = array<vec3f, 2>(left, load);
    workgroupBarrier();
    if (lane > 0u) {
        return;
    }
    for (var other = 1u; other < 64u; other++) {
        left += squares[other][0];
        load += squares[other][1];
    }
    if (all(left <= DIFFUSION_ENOUGH * DIFFUSION_ENOUGH * load)) {
        atomicStore(&workgroups[0], 0u);
    }
}

@compute @workgroup_size(64)
fn diffusion_solve_pack(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let cell = tile_corner(tiles[group.x], level.cells) + tile_cell(lane);
    if (any(cell >= vec3u(level.cells))) {
        return;
    }
    let index = diffusion_index(cell, level.cells);
    packed[index] = diffusion_pack(fluence[index].xyz, nodes[index]);
}
