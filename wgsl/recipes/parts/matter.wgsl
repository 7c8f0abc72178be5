// matter: which voxels of a grid are filled, a bit for each, as the recipe voxelize leaves them.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own.
//
// A recipe adds: the binding `matter`, array<u32>. Each row along x begins with a word of its own,
// with the smallest x in the lowest bit; row (y, z) has the number y + cells z.

// The word that holds a voxel's bit, in a grid of `cells` voxels along each edge.
fn matter_word(cells: u32, voxel: vec3u) -> u32 {
    let words_per_row = (cells + 31u) / 32u;
    return matter[words_per_row * (voxel.y + cells * voxel.z) + voxel.x / 32u];
}

fn matter_is_at(cells: u32, voxel: vec3u) -> bool {
    return ((matter_word(cells, voxel) >> (voxel.x % 32u)) & 1u) != 0u;
}
