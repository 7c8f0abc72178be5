// optical_path_tiles: least optical depths, only where they still change: a list of tiles of 4 x 4 x 4 voxels.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Jeong and Whitaker, "A Fast Iterative Method for Eikonal Equations", SIAM J. Sci. Comput.
//   30 (2008), the block-based variant.
// requires: optical_path
// parts: matter, optical_path_grid
//
// 1. `optical_path_tiles_begin`, one invocation per tile.
// 2. For each allowed pass: `optical_path_tiles_next`, one workgroup, then
//    `optical_path_tiles_update`, dispatched indirectly with the arguments that the former has
//    written: one invocation per listed tile. Once no tile is listed, the passes have no
//    workgroups.
//
// An invocation holds its tile and the voxels around it in registers, so that nothing waits. It
// lists the tiles that its changes may lower, and its own tile if that is not done. A tile may read
// a neighbour's costs before or after these change in the same pass; in the next pass it reads them
// again.

// Computes costs by the Eikonal equation instead of along edges.
override OPTICAL_PATH_GODUNOV: bool = false;

// Rounds over a tile per pass.
const OPTICAL_PATH_ROUNDS: u32 = 2u;
// Invocations per workgroup.
const OPTICAL_PATH_GROUP: u32 = 32u;
// Tolerance of Godunov's costs, absolute for costs up to 1 and relative above. A smaller decrease
// does not count as a change: in f32 these costs never settle by themselves.
const OPTICAL_PATH_TOLERANCE: f32 = 1e-5f;

// 64 bits of matter per tile.
@group(0) @binding(6) var<storage, read_write> tile_matter: array<vec2u>;
// The last pass for which each tile was listed, plus 1; 0 for never.
@group(0) @binding(7) var<storage, read_write> tile_listed: array<atomic<u32>>;
// Two lists, one after the other: for passes with even and with odd numbers.
@group(0) @binding(8) var<storage, read_write> lists: array<u32>;

// Four voxels along x, with the voxels before and after them.
struct OpticalPathRow {
    before: f32,
    inner: vec4f,
    after: f32,
}

// Six rows along y.
alias OpticalPathPlane = array<OpticalPathRow, 6>;
// A row in the middle and the eight rows around it: y within z.
alias OpticalPathNine = array<OpticalPathRow, 9>;

fn optical_path_tiles_side() -> u32 {
    return grid.cells / 4u;
}

fn optical_path_tile_corner(tile: u32) -> vec3u {
    let side = optical_path_tiles_side();
    return 4u * vec3u(tile % side, tile / side % side, tile / side / side);
}

// Lists a tile for the pass with the number `pass_number`, at most once.
fn optical_path_list(tile: u32, pass_number: u32) {
    if atomicExchange(&tile_listed[tile], pass_number + 1u) != pass_number + 1u {
        let parity = pass_number & 1u;
        let side = optical_path_tiles_side();
        lists[parity * side * side * side + atomicAdd(&progress.listed[parity], 1u)] = tile;
    }
}

// Finds the matter of each tile, and lists those that hold a seed.
@compute @workgroup_size(OPTICAL_PATH_GROUP)
fn optical_path_tiles_begin(@builtin(global_invocation_id) invocation: vec3u) {
    let side = optical_path_tiles_side();
    let tile = invocation.x;
    if tile >= side * side * side {
        return;
    }
    let corner = optical_path_tile_corner(tile);
    let unreached = optical_path_encode(OPTICAL_PATH_UNREACHED);
    var bits = vec2u(0u);
    var least = unreached;
    for (var row = 0u; row < 16u; row++) {
        let first = corner + vec3u(0u, row & 3u, row >> 2u);
        // A row of a tile never spans two words.
        let word = matter_word(grid.cells, first);
        let four = (word >> (first.x & 31u)) & 15u;
        bits[row >> 3u] |= four << (4u * (row & 7u));
        for (var x = 0u; x < 4u; x++) {
            let index = optical_path_voxel(first) + x;
            let seed = optical_path_encode(bitcast<f32>(atomicLoad(&costs[index])));
            let cost = select(unreached, seed, ((four >> x) & 1u) == 1u);
            atomicStore(&costs[index], cost);
            least = min(least, cost);
        }
    }
    tile_matter[tile] = bits;
    atomicStore(&tile_listed[tile], 0u);
    if least < unreached {
        optical_path_list(tile, 0u);
        atomicMin(&progress.least[0u], least);
    }
}

// Makes the list of the next pass the one that is taken up, and writes how many workgroups it needs.
@compute @workgroup_size(1)
fn optical_path_tiles_next() {
    workgroups[0] = (optical_path_next() + OPTICAL_PATH_GROUP - 1u) / OPTICAL_PATH_GROUP;
    workgroups[1] = 1u;
    workgroups[2] = 1u;
}

fn optical_path_cost(inside: bool, index: u32) -> f32 {
    return select(OPTICAL_PATH_UNREACHED, optical_path_decode(atomicLoad(&costs[select(0u, index, inside)])), inside);
}

// A row of the tile at `corner`, extended by one voxel on every side: y and z run from 0 to 5.
fn optical_path_row(corner: vec3u, y: u32, z: u32) -> OpticalPathRow {
    let place = corner.yz + vec2u(y, z) - 1u;
    // Values below 0 wrap around.
    let inside = all(place < vec2u(grid.cells));
    let index = optical_path_voxel(vec3u(corner.x, place));
    return OpticalPathRow(
        optical_path_cost(inside && corner.x > 0u, index - 1u),
        vec4f(
            optical_path_cost(inside, index),
            optical_path_cost(inside, index + 1u),
            optical_path_cost(inside, index + 2u),
            optical_path_cost(inside, index + 3u),
        ),
        optical_path_cost(inside && corner.x + 4u < grid.cells, index + 4u),
    );
}

fn optical_path_plane(corner: vec3u, z: u32) -> OpticalPathPlane {
    return OpticalPathPlane(
        optical_path_row(corner, 0u, z),
        optical_path_row(corner, 1u, z),
        optical_path_row(corner, 2u, z),
        optical_path_row(corner, 3u, z),
        optical_path_row(corner, 4u, z),
        optical_path_row(corner, 5u, z),
    );
}

// The same for extinctions instead of costs.
fn optical_path_row_extinctions(corner: vec3u, y: u32, z: u32) -> OpticalPathRow {
    let place = min(max(corner.yz + vec2u(y, z), vec2u(1u)) - 1u, vec2u(grid.cells - 1u));
    let index = optical_path_voxel(vec3u(corner.x, place));
    return OpticalPathRow(
        optical_path_extinction(index - min(corner.x, 1u)),
        vec4f(
            optical_path_extinction(index),
            optical_path_extinction(index + 1u),
            optical_path_extinction(index + 2u),
            optical_path_extinction(index + 3u),
        ),
        optical_path_extinction(index + select(3u, 4u, corner.x + 4u < grid.cells)),
    );
}

fn optical_path_plane_extinctions(corner: vec3u, z: u32) -> OpticalPathPlane {
    return OpticalPathPlane(
        optical_path_row_extinctions(corner, 0u, z),
        optical_path_row_extinctions(corner, 1u, z),
        optical_path_row_extinctions(corner, 2u, z),
        optical_path_row_extinctions(corner, 3u, z),
        optical_path_row_extinctions(corner, 4u, z),
        optical_path_row_extinctions(corner, 5u, z),
    );
}

fn optical_path_relax_four(cost: vec4f, neighbour: vec4f, edge: vec4f) -> vec4f {
    return vec4f(
        optical_path_relax(cost.x, neighbour.x, edge.x),
        optical_path_relax(cost.y, neighbour.y, edge.y),
        optical_path_relax(cost.z, neighbour.z, edge.z),
        optical_path_relax(cost.w, neighbour.w, edge.w),
    );
}

fn optical_path_edge_four(extinction: vec4f, neighbour: vec4f, length: f32) -> vec4f {
    return vec4f(
        optical_path_edge(extinction.x, neighbour.x, length),
        optical_path_edge(extinction.y, neighbour.y, length),
        optical_path_edge(extinction.z, neighbour.z, length),
        optical_path_edge(extinction.w, neighbour.w, length),
    );
}

fn optical_path_before(row: OpticalPathRow) -> vec4f {
    return vec4f(row.before, row.inner.xyz);
}

fn optical_path_after(row: OpticalPathRow) -> vec4f {
    return vec4f(row.inner.yzw, row.after);
}

// The smaller of the neighbours before and after.
fn optical_path_beside(row: OpticalPathRow) -> vec4f {
    return min(optical_path_before(row), optical_path_after(row));
}

// Costs after the offers of neighbours with other extinctions, along edges of one length.
fn optical_path_offered(cost: vec4f, extinction: vec4f, neighbours: vec4f, extinctions: vec4f, length: f32) -> vec4f {
    return optical_path_relax_four(cost, neighbours, optical_path_edge_four(extinction, extinctions, length));
}

// The same for neighbours in a row that shares faces with this one.
fn optical_path_from_beside(cost: vec4f, extinction: vec4f, row: OpticalPathRow, others: OpticalPathRow) -> vec4f {
    let slant = grid.spacing * 1.4142135f;
    var least = optical_path_offered(cost, extinction, row.inner, others.inner, grid.spacing);
    if OPTICAL_PATH_STENCIL >= 18u {
        least = optical_path_offered(least, extinction, optical_path_before(row), optical_path_before(others), slant);
        least = optical_path_offered(least, extinction, optical_path_after(row), optical_path_after(others), slant);
    }
    return least;
}

// The same for neighbours in a row that shares edges with this one.
fn optical_path_from_across(cost: vec4f, extinction: vec4f, row: OpticalPathRow, others: OpticalPathRow) -> vec4f {
    let slant = grid.spacing * 1.7320508f;
    var least = optical_path_offered(cost, extinction, row.inner, others.inner, grid.spacing * 1.4142135f);
    if OPTICAL_PATH_STENCIL == 26u {
        least = optical_path_offered(least, extinction, optical_path_before(row), optical_path_before(others), slant);
        least = optical_path_offered(least, extinction, optical_path_after(row), optical_path_after(others), slant);
    }
    return least;
}

// Relaxes a row once, from itself and the eight rows around it: the next costs of its four voxels.
fn optical_path_relaxed(rows: OpticalPathNine, extinctions: OpticalPathNine, bits: u32) -> vec4f {
    let row = rows[4];
    var cost = row.inner;
    if OPTICAL_PATH_GODUNOV {
        let x = optical_path_beside(row);
        let y = min(rows[3].inner, rows[5].inner);
        let z = min(rows[1].inner, rows[7].inner);
        let slowness = grid.spacing * extinctions[4].inner;
        cost = min(cost, vec4f(
            optical_path_godunov(vec3f(x.x, y.x, z.x), slowness.x),
            optical_path_godunov(vec3f(x.y, y.y, z.y), slowness.y),
            optical_path_godunov(vec3f(x.z, y.z, z.z), slowness.z),
            optical_path_godunov(vec3f(x.w, y.w, z.w), slowness.w),
        ));
    //+extinction_per_voxel {
    } else if EFFECT_EXTINCTION_PER_VOXEL {
        let own = extinctions[4].inner;
        cost = optical_path_offered(
            cost, own, optical_path_before(row), optical_path_before(extinctions[4]), grid.spacing
        );
        cost = optical_path_offered(
            cost, own, optical_path_after(row), optical_path_after(extinctions[4]), grid.spacing
        );
        cost = optical_path_from_beside(cost, own, rows[3], extinctions[3]);
        cost = optical_path_from_beside(cost, own, rows[5], extinctions[5]);
        cost = optical_path_from_beside(cost, own, rows[1], extinctions[1]);
        cost = optical_path_from_beside(cost, own, rows[7], extinctions[7]);
        if OPTICAL_PATH_STENCIL >= 18u {
            cost = optical_path_from_across(cost, own, rows[0], extinctions[0]);
            cost = optical_path_from_across(cost, own, rows[2], extinctions[2]);
            cost = optical_path_from_across(cost, own, rows[6], extinctions[6]);
            cost = optical_path_from_across(cost, own, rows[8], extinctions[8]);
        }
    //+extinction_per_voxel }
    } else {
        // Edges of one length cost the same, so the neighbour with the smallest cost offers the
        // most.
        let sigma = grid.extinction;
        let near = min(
            optical_path_beside(row),
            min(min(rows[3].inner, rows[5].inner), min(rows[1].inner, rows[7].inner)),
        );
        cost = optical_path_relax_four(cost, near, vec4f(optical_path_edge(sigma, sigma, grid.spacing)));
        if OPTICAL_PATH_STENCIL >= 18u {
            let beside = min(
                min(optical_path_beside(rows[3]), optical_path_beside(rows[5])),
                min(optical_path_beside(rows[1]), optical_path_beside(rows[7])),
            );
            let across = min(min(rows[0].inner, rows[2].inner), min(rows[6].inner, rows[8].inner));
            let edge = optical_path_edge(sigma, sigma, grid.spacing * 1.4142135f);
            cost = optical_path_relax_four(cost, min(beside, across), vec4f(edge));
        }
        if OPTICAL_PATH_STENCIL == 26u {
            let corners = min(
                min(optical_path_beside(rows[0]), optical_path_beside(rows[2])),
                min(optical_path_beside(rows[6]), optical_path_beside(rows[8])),
            );
            let edge = optical_path_edge(sigma, sigma, grid.spacing * 1.7320508f);
            cost = optical_path_relax_four(cost, corners, vec4f(edge));
        }
    }
    let is_matter = (vec4u(bits) & vec4u(1u, 2u, 4u, 8u)) != vec4u(0u);
    return select(vec4f(OPTICAL_PATH_UNREACHED), cost, is_matter);
}

// Relaxes the four inner rows of a plane one after the other, each from the updated row before it;
// `low`, `same` and `high` hold extinctions.
fn optical_path_rising(
    below: OpticalPathPlane,
    own: OpticalPathPlane,
    above: OpticalPathPlane,
    low: OpticalPathPlane,
    same: OpticalPathPlane,
    high: OpticalPathPlane,
    bits: u32
) -> OpticalPathPlane {
    var plane = own;
    plane[1].inner = optical_path_relaxed(
        OpticalPathNine(below[0], below[1], below[2], plane[0], plane[1], plane[2], above[0], above[1], above[2]),
        OpticalPathNine(low[0], low[1], low[2], same[0], same[1], same[2], high[0], high[1], high[2]),
        bits,
    );
    plane[2].inner = optical_path_relaxed(
        OpticalPathNine(below[1], below[2], below[3], plane[1], plane[2], plane[3], above[1], above[2], above[3]),
        OpticalPathNine(low[1], low[2], low[3], same[1], same[2], same[3], high[1], high[2], high[3]),
        bits >> 4u,
    );
    plane[3].inner = optical_path_relaxed(
        OpticalPathNine(below[2], below[3], below[4], plane[2], plane[3], plane[4], above[2], above[3], above[4]),
        OpticalPathNine(low[2], low[3], low[4], same[2], same[3], same[4], high[2], high[3], high[4]),
        bits >> 8u,
    );
    plane[4].inner = optical_path_relaxed(
        OpticalPathNine(below[3], below[4], below[5], plane[3], plane[4], plane[5], above[3], above[4], above[5]),
        OpticalPathNine(low[3], low[4], low[5], same[3], same[4], same[5], high[3], high[4], high[5]),
        bits >> 12u,
    );
    return plane;
}

// The same, from the last row to the first.
fn optical_path_falling(
    below: OpticalPathPlane,
    own: OpticalPathPlane,
    above: OpticalPathPlane,
    low: OpticalPathPlane,
    same: OpticalPathPlane,
    high: OpticalPathPlane,
    bits: u32
) -> OpticalPathPlane {
    var plane = own;
    plane[4].inner = optical_path_relaxed(
        OpticalPathNine(below[3], below[4], below[5], plane[3], plane[4], plane[5], above[3], above[4], above[5]),
        OpticalPathNine(low[3], low[4], low[5], same[3], same[4], same[5], high[3], high[4], high[5]),
        bits >> 12u,
    );
    plane[3].inner = optical_path_relaxed(
        OpticalPathNine(below[2], below[3], below[4], plane[2], plane[3], plane[4], above[2], above[3], above[4]),
        OpticalPathNine(low[2], low[3], low[4], same[2], same[3], same[4], high[2], high[3], high[4]),
        bits >> 8u,
    );
    plane[2].inner = optical_path_relaxed(
        OpticalPathNine(below[1], below[2], below[3], plane[1], plane[2], plane[3], above[1], above[2], above[3]),
        OpticalPathNine(low[1], low[2], low[3], same[1], same[2], same[3], high[1], high[2], high[3]),
        bits >> 4u,
    );
    plane[1].inner = optical_path_relaxed(
        OpticalPathNine(below[0], below[1], below[2], plane[0], plane[1], plane[2], above[0], above[1], above[2]),
        OpticalPathNine(low[0], low[1], low[2], same[0], same[1], same[2], high[0], high[1], high[2]),
        bits,
    );
    return plane;
}

// One bit for each of the plane's sixteen voxels, set if its cost has changed.
fn optical_path_changed(before: OpticalPathPlane, after: OpticalPathPlane) -> u32 {
    return optical_path_changed_four(before[1].inner, after[1].inner)
        | (optical_path_changed_four(before[2].inner, after[2].inner) << 4u)
        | (optical_path_changed_four(before[3].inner, after[3].inner) << 8u)
        | (optical_path_changed_four(before[4].inner, after[4].inner) << 12u);
}

fn optical_path_changed_four(before: vec4f, after: vec4f) -> u32 {
    var changed = after < before;
    if OPTICAL_PATH_GODUNOV {
        changed = before - after > OPTICAL_PATH_TOLERANCE * max(vec4f(1.0f), before);
    }
    let bits = select(vec4u(0u), vec4u(1u, 2u, 4u, 8u), changed);
    return bits.x | bits.y | bits.z | bits.w;
}

// The plane before a pass. The first pass compares with unreached, so that the seeds count as
// changes.
fn optical_path_before_seeds(plane: OpticalPathPlane, is_first: bool) -> OpticalPathPlane {
    var before = plane;
    let unreached = vec4f(OPTICAL_PATH_UNREACHED);
    before[1].inner = select(plane[1].inner, unreached, is_first);
    before[2].inner = select(plane[2].inner, unreached, is_first);
    before[3].inner = select(plane[3].inner, unreached, is_first);
    before[4].inner = select(plane[4].inner, unreached, is_first);
    return before;
}

// The smallest of a plane's inner costs whose bit is set.
fn optical_path_least(plane: OpticalPathPlane, bits: u32) -> f32 {
    let four = min(
        min(optical_path_where(plane[1].inner, bits), optical_path_where(plane[2].inner, bits >> 4u)),
        min(optical_path_where(plane[3].inner, bits >> 8u), optical_path_where(plane[4].inner, bits >> 12u)),
    );
    return min(min(four.x, four.y), min(four.z, four.w));
}

fn optical_path_where(cost: vec4f, bits: u32) -> vec4f {
    return select(vec4f(OPTICAL_PATH_UNREACHED), cost, (vec4u(bits) & vec4u(1u, 2u, 4u, 8u)) != vec4u(0u));
}

fn optical_path_store_row(corner: vec3u, y: u32, z: u32, row: vec4f) {
    let index = optical_path_voxel(corner + vec3u(0u, y, z));
    atomicStore(&costs[index], optical_path_encode(row.x));
    atomicStore(&costs[index + 1u], optical_path_encode(row.y));
    atomicStore(&costs[index + 2u], optical_path_encode(row.z));
    atomicStore(&costs[index + 3u], optical_path_encode(row.w));
}

fn optical_path_store(corner: vec3u, z: u32, plane: OpticalPathPlane) {
    optical_path_store_row(corner, 0u, z, plane[1].inner);
    optical_path_store_row(corner, 1u, z, plane[2].inner);
    optical_path_store_row(corner, 2u, z, plane[3].inner);
    optical_path_store_row(corner, 3u, z, plane[4].inner);
}

// The tiles around a tile that see a voxel whose bit is set: one bit for each of 3 x 3 x 3, x
// first.
fn optical_path_affected(bits: vec2u) -> u32 {
    var affected = 0u;
    for (var place = 0u; place < 27u; place++) {
        let x = place % 3u;
        let y = place / 3u % 3u;
        let z = place / 9u;
        let axes = u32(x != 1u) + u32(y != 1u) + u32(z != 1u);
        let column = select(select(0x88888888u, 0xffffffffu, x == 1u), 0x11111111u, x == 0u);
        let row = select(select(0xf000f000u, 0xffffffffu, y == 1u), 0x000f000fu, y == 0u);
        let first = select(select(0u, 0xffffffffu, z == 1u), 0x0000ffffu, z == 0u);
        let second = select(select(0xffff0000u, 0xffffffffu, z == 1u), 0u, z == 0u);
        let touching = ((bits.x & first) | (bits.y & second)) & column & row;
        let in_stencil = axes == 1u || (!OPTICAL_PATH_GODUNOV
            && ((axes == 2u && OPTICAL_PATH_STENCIL >= 18u) || (axes == 3u && OPTICAL_PATH_STENCIL == 26u)));
        affected |= select(0u, 1u << place, touching != 0u && in_stencil);
    }
    return affected;
}

// Lowers the costs in a listed tile, and lists the tiles that its changes may lower.
@compute @workgroup_size(OPTICAL_PATH_GROUP)
fn optical_path_tiles_update(@builtin(global_invocation_id) invocation: vec3u) {
    let next = progress.step;
    let current = (next - 1u) & 1u;
    if invocation.x >= atomicLoad(&progress.listed[current]) {
        return;
    }
    let side = optical_path_tiles_side();
    let tile = lists[current * side * side * side + invocation.x];
    let corner = optical_path_tile_corner(tile);
    let bits = tile_matter[tile];
    let first = optical_path_plane(corner, 0u);
    var a = optical_path_plane(corner, 1u);
    var b = optical_path_plane(corner, 2u);
    var c = optical_path_plane(corner, 3u);
    var d = optical_path_plane(corner, 4u);
    let last = optical_path_plane(corner, 5u);
    let s_first = optical_path_plane_extinctions(corner, 0u);
    let s_a = optical_path_plane_extinctions(corner, 1u);
    let s_b = optical_path_plane_extinctions(corner, 2u);
    let s_c = optical_path_plane_extinctions(corner, 3u);
    let s_d = optical_path_plane_extinctions(corner, 4u);
    let s_last = optical_path_plane_extinctions(corner, 5u);
    let is_first = next == 1u;
    let a_before = optical_path_before_seeds(a, is_first);
    let b_before = optical_path_before_seeds(b, is_first);
    let c_before = optical_path_before_seeds(c, is_first);
    let d_before = optical_path_before_seeds(d, is_first);
    var moving = vec2u(0u);
    for (var round = 0u; round < OPTICAL_PATH_ROUNDS; round++) {
        let a_round = a;
        let b_round = b;
        let c_round = c;
        let d_round = d;
        a = optical_path_rising(first, a, b, s_first, s_a, s_b, bits.x);
        b = optical_path_rising(a, b, c, s_a, s_b, s_c, bits.x >> 16u);
        c = optical_path_rising(b, c, d, s_b, s_c, s_d, bits.y);
        d = optical_path_rising(c, d, last, s_c, s_d, s_last, bits.y >> 16u);
        d = optical_path_falling(c, d, last, s_c, s_d, s_last, bits.y >> 16u);
        c = optical_path_falling(b, c, d, s_b, s_c, s_d, bits.y);
        b = optical_path_falling(a, b, c, s_a, s_b, s_c, bits.x >> 16u);
        a = optical_path_falling(first, a, b, s_first, s_a, s_b, bits.x);
        moving = vec2u(
            optical_path_changed(a_round, a) | (optical_path_changed(b_round, b) << 16u),
            optical_path_changed(c_round, c) | (optical_path_changed(d_round, d) << 16u),
        );
    }
    let changed = vec2u(
        optical_path_changed(a_before, a) | (optical_path_changed(b_before, b) << 16u),
        optical_path_changed(c_before, c) | (optical_path_changed(d_before, d) << 16u),
    );
    if (changed.x | changed.y) == 0u {
        return;
    }
    optical_path_store(corner, 0u, a);
    optical_path_store(corner, 1u, b);
    optical_path_store(corner, 2u, c);
    optical_path_store(corner, 3u, d);
    let least = min(
        min(optical_path_least(a, changed.x), optical_path_least(b, changed.x >> 16u)),
        min(optical_path_least(c, changed.y), optical_path_least(d, changed.y >> 16u)),
    );
    var affected = optical_path_affected(changed);
    // The tile itself, if the last round still changed something.
    affected = select(affected & ~(1u << 13u), affected | (1u << 13u), (moving.x | moving.y) != 0u);
    var some = false;
    while affected != 0u {
        let place = firstTrailingBit(affected);
        affected &= affected - 1u;
        let there = corner / 4u + vec3u(place % 3u, place / 3u % 3u, place / 9u) - 1u;
        // Values below 0 wrap around.
        if all(there < vec3u(side)) {
            let neighbour = there.x + side * (there.y + side * there.z);
            let its = tile_matter[neighbour];
            if (its.x | its.y) != 0u {
                optical_path_list(neighbour, next);
                some = true;
            }
        }
    }
    if some {
        atomicMin(&progress.least[next & 1u], optical_path_encode(least));
    }
}
