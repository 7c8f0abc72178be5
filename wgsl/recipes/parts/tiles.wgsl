// tiles: blocks of 4 x 4 x 4 cells of a grid, numbered along x, y and z.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own.
//
// A recipe adds: nothing.

// The least cell of a tile, in a grid of `cells` along each edge.
fn tile_corner(tile: u32, cells: u32) -> vec3u {
    let side = (cells + 3u) / 4u;
    return 4u * vec3u(tile % side, tile / side % side, tile / side / side);
}

// The place in its tile of the cell that is one of 64 lanes'.
fn tile_cell(lane: u32) -> vec3u {
    return vec3u(lane & 3u, (lane >> 2u) & 3u, lane >> 4u);
}
