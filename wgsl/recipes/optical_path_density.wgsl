// optical_path_density: how dense a body is in each of its voxels, from procedural veins or from a texture.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own; the veins are the module veins'.
// requires: veins, voxelization
// parts: matter, tiles
//
// Dispatch with (1, cells, cells) workgroups after the recipe voxelize, and before the seeds. For
// diffusion, dispatch optical_path_density_listed between diffusion_cells_list and diffusion_cells_finish, a
// workgroup for each tile that holds matter.

// Densities from a 3D texture instead of from veins. Called for by a grid of densities.
override DENSITY_FROM_TEXTURE: bool = false;

struct OpticalPathBox {
    // The corners of the texture's box, in world units.
    least: vec3f,
    greatest: vec3f,
}

@group(0) @binding(0) var<uniform> grid: VoxelizationGrid;
@group(0) @binding(1) var<storage, read> matter: array<u32>;
@group(0) @binding(2) var<storage, read_write> density: array<f32>;
@group(0) @binding(3) var<uniform> pattern: VeinsPattern;
@group(0) @binding(4) var densities: texture_3d<f32>;
@group(0) @binding(5) var<uniform> extent: OpticalPathBox;
// Tiles of 4 x 4 x 4 voxels.
@group(0) @binding(6) var<storage, read> tiles: array<u32>;

fn optical_path_texel(texel: vec3u) -> f32 {
    return textureLoad(densities, texel, 0).x;
}

// The density at a position, interpolated linearly between texel centres. The interpolation is done
// by hand because 32-bit float textures need not be filterable. Outside the texel centres the
// nearest value counts.
fn optical_path_sampled(position: vec3f) -> f32 {
    let size = textureDimensions(densities);
    let place = (position - extent.least) / (extent.greatest - extent.least) * vec3f(size) - 0.5f;
    let inside = clamp(place, vec3f(0.0f), vec3f(size) - 1.0f);
    let lower = vec3u(inside);
    let upper = min(lower + 1u, size - 1u);
    let weight = inside - vec3f(lower);
    let near = mix(
        mix(optical_path_texel(lower), optical_path_texel(vec3u(upper.x, lower.yz)), weight.x),
        mix(
            optical_path_texel(vec3u(lower.x, upper.y, lower.z)),
            optical_path_texel(vec3u(upper.xy, lower.z)),
            weight.x
        ),
        weight.y,
    );
    let far = mix(
        mix(
            optical_path_texel(vec3u(lower.xy, upper.z)),
            optical_path_texel(vec3u(upper.x, lower.y, upper.z)),
            weight.x
        ),
        mix(optical_path_texel(vec3u(lower.x, upper.yz)), optical_path_texel(upper), weight.x),
        weight.y,
    );
    return mix(near, far, weight.z);
}

// Whether there is matter in or next to a voxel, where shading interpolates. Only the same word of
// the nine rows around it is read, not the next word; a voxel at either end of a word always counts
// as near matter.
fn optical_path_near_matter(voxel: vec3u) -> bool {
    let lower = max(voxel.yz, vec2u(1u)) - 1u;
    let upper = min(voxel.yz + 1u, vec2u(grid.cells - 1u));
    var bits = 0u;
    for (var z = lower.y; z <= upper.y; z++) {
        for (var y = lower.x; y <= upper.x; y++) {
            bits |= matter_word(grid.cells, vec3u(voxel.x, y, z));
        }
    }
    let place = voxel.x % 32u;
    return place == 0u || place == 31u || ((bits >> (max(place, 1u) - 1u)) & 7u) != 0u;
}

fn optical_path_fill(voxel: vec3u) {
    let centre = voxelization_centre(grid, voxel);
    var found = 0.0f;
    if (DENSITY_FROM_TEXTURE) {
        found = optical_path_sampled(centre);
    } else {
        found = veins_density(centre, pattern);
    }
    density[voxelization_index(grid, voxel)] = found;
}

@compute @workgroup_size(64)
fn optical_path_density(@builtin(local_invocation_index) invocation: u32, @builtin(workgroup_id) row: vec3u) {
    for (var x = invocation; x < grid.cells; x += 64u) {
        if (optical_path_near_matter(vec3u(x, row.yz))) {
            optical_path_fill(vec3u(x, row.yz));
        }
    }
}

@compute @workgroup_size(64)
fn optical_path_density_listed(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) group: vec3u) {
    let voxel = tile_corner(tiles[group.x], grid.cells) + tile_cell(lane);
    if (all(voxel < vec3u(grid.cells))) {
        optical_path_fill(voxel);
    }
}
