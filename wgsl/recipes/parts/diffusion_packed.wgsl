// diffusion_packed: a voxel's fluence, depth and filled volume in 64 bits, as shading looks them up.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own.
//
// A recipe adds: the part diffusion_nodes, of whose words the depth and the volume come.

// The largest fluence that is held, as a share of the largest irradiance. What is held is the fourth
// root: 16 bits keep a fluence of 1 to 2e-4 of itself, and one of 1e-6 to 8e-3.
const DIFFUSION_BRIGHTEST: f32 = 256.0f;

fn diffusion_pack(fluence: vec3f, word: u32) -> vec2u {
    let root = sqrt(sqrt(clamp(fluence / DIFFUSION_BRIGHTEST, vec3f(0.0f), vec3f(1.0f))));
    let depth = u32(diffusion_depth(word) / DIFFUSION_NODE_DEPTH * 4095.0f + 0.5f);
    let matter = (depth << 4u) | countOneBits(word & 255u);
    return vec2u(pack2x16unorm(root.xy), pack2x16unorm(vec2f(root.z, 0.0f)) | (matter << 16u));
}

fn diffusion_packed_fluence(word: vec2u) -> vec3f {
    let root = vec3f(unpack2x16unorm(word.x), unpack2x16unorm(word.y).x);
    let square = root * root;
    return DIFFUSION_BRIGHTEST * square * square;
}

fn diffusion_packed_volume(word: vec2u) -> f32 {
    return 0.125f * f32((word.y >> 16u) & 15u);
}

fn diffusion_packed_depth(word: vec2u) -> f32 {
    return f32(word.y >> 20u) * (DIFFUSION_NODE_DEPTH / 4095.0f);
}
