// diffusion_nodes: what a voxel holds of a body: which of its eight parts are filled, where their
//   centroid is, and how deep it lies.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own.
//
// A recipe adds: nothing. The recipe diffusion_cells leaves a word for each voxel: a bit for each
// eighth, x + 2 y + 4 z, and above them the depth.

// The largest depth that a word holds, in voxel spacings.
const DIFFUSION_NODE_DEPTH: f32 = 3.0f;

// The filled share of a voxel.
fn diffusion_volume(word: u32) -> f32 {
    return 0.125f * f32(countOneBits(word & 255u));
}

// The distance of the node from the surface, in voxel spacings.
fn diffusion_depth(word: u32) -> f32 {
    return f32(word >> 8u) * (DIFFUSION_NODE_DEPTH / 16777215.0f);
}

fn diffusion_word(parts: u32, depth: f32) -> u32 {
    return parts | (u32(clamp(depth / DIFFUSION_NODE_DEPTH, 0.0f, 1.0f) * 16777215.0f) << 8u);
}

// The share of the face between two voxels that is open: eighths of the lower one that meet filled ones of the upper,
// along an axis.
fn diffusion_open(lower: u32, upper: u32, axis: u32) -> f32 {
    let mask = select(select(0x0fu, 0x33u, axis == 1u), 0x55u, axis == 0u);
    return 0.25f * f32(countOneBits((lower >> (1u << axis)) & upper & mask));
}

// The centroid of the filled eighths from the voxel's centre, in voxel spacings.
fn diffusion_centroid(word: u32) -> vec3f {
    let all = max(f32(countOneBits(word & 255u)), 1.0f);
    let upper = vec3f(
        f32(countOneBits(word & 0xaau)),
        f32(countOneBits(word & 0xccu)),
        f32(countOneBits(word & 0xf0u))
    );
    return 0.5f * upper / all - 0.25f;
}
