// optical_path_seed: where light enters a body: lit texels of the lights' maps put costs into the voxels about them.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Ozawa, Okamoto and Morishima, "Real-time rendering of translucent material using Dynamic
//   Programming", section 3.1.
// requires: optical_path, reflective_shadow_map, voxelization
// parts: lights, light_views, matter
//
// Dispatch optical_path_clear with (1, cells, cells) workgroups, then optical_path_seed_texel with
// an invocation for each texel of each map. Process one channel at a time: costs are those of red,
// green or blue.

// The extinction varies from voxel to voxel. Called for by extras.lapidary.veins, or by a grid of
// densities.
override EFFECT_EXTINCTION_PER_VOXEL: bool = false;

struct OpticalPathSeeding {
    grid: VoxelizationGrid,
    // Extinction per unit of length in this channel, where the density is 1.
    extinction: f32,
    // The irradiance whose cost is 0: at least the greatest that arrives anywhere.
    largest: f32,
    // The channel: 0 red, 1 green, 2 blue.
    channel: u32,
}

@group(0) @binding(0) var<uniform> seeding: OpticalPathSeeding;
// Bindings 2, 4 and 5 belong to the parts.
@group(1) @binding(0) var<storage, read_write> costs: array<atomic<u32>>;
@group(1) @binding(1) var<storage, read> matter: array<u32>;
@group(1) @binding(2) var<storage, read> density: array<f32>;

// Sets all voxels to unreached.
@compute @workgroup_size(64)
fn optical_path_clear(@builtin(local_invocation_index) invocation: u32, @builtin(workgroup_id) row: vec3u) {
    for (var x = invocation; x < seeding.grid.cells; x += 64u) {
        let voxel = voxelization_index(seeding.grid, vec3u(x, row.yz));
        atomicStore(&costs[voxel], optical_path_encode(OPTICAL_PATH_UNREACHED));
    }
}

@compute @workgroup_size(8, 8)
fn optical_path_seed_texel(@builtin(global_invocation_id) texel: vec3u) {
    if (any(texel.xy >= textureDimensions(maps))) {
        return;
    }
    let seen = textureLoad(maps, texel.xy, texel.z, 0);
    if (seen.w <= 0.0f) {
        return;
    }
    // The map also shows other bodies.
    let inside = voxelization_local(seeding.grid, seen.xyz);
    if (any(inside < vec3f(0.0f)) || any(inside > vec3f(f32(seeding.grid.cells)))) {
        return;
    }
    let voxel = voxelization_voxel(seeding.grid, seen.xyz);
    if (!matter_is_at(seeding.grid.cells, voxel)) {
        return;
    }
    let arrival = light_arrival(lights[views[texel.z].light], seen.xyz);
    let share = arrival.irradiance[seeding.channel] * seen.w / seeding.largest;
    let own = optical_path_extinction_at(voxel);  //+extinction_per_voxel
    let last = vec3i(i32(seeding.grid.cells) - 1i);
    // Solvers have their largest errors where a front begins, so all voxels around the texel start
    // with their true distances from it.
    for (var index = 0i; index < 27i; index++) {
        let step = vec3i(index % 3i, (index / 3i) % 3i, index / 9i) - 1i;
        let place = vec3i(voxel) + step;
        if (any(place < vec3i(0i)) || any(place > last)) {
            continue;
        }
        let near = vec3u(place);
        if (!matter_is_at(seeding.grid.cells, near)) {
            continue;
        }
        var extinction = seeding.extinction;
        if (EFFECT_EXTINCTION_PER_VOXEL) {
            extinction = 0.5f * (own + optical_path_extinction_at(near));
        }
        let offset = distance(seen.xyz, voxelization_centre(seeding.grid, near));
        let cost = optical_path_encode(optical_path_seed(share, extinction, offset));
        let node = voxelization_index(seeding.grid, near);
        // Reading first avoids most of the atomic writes, which are expensive.
        if (cost < atomicLoad(&costs[node])) {
            atomicMin(&costs[node], cost);
        }
    }
}

fn optical_path_extinction_at(voxel: vec3u) -> f32 {
    return seeding.extinction * density[voxelization_index(seeding.grid, voxel)];
}
