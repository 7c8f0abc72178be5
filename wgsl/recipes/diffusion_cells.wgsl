// diffusion_cells: a body as cells for diffusion: volume, faces, and the surface, from finer voxels and from the mesh.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: own; cut cells as in Johansen and Colella, "A Cartesian Grid Embedded Boundary Method for
//   Poisson's Equation on Irregular Domains", J. Comput. Phys. 147 (1998), with two-point fluxes.
// requires: cdrf, diffusion, environment, voxelization
// parts: mesh, harmonics, diffusion_nodes, tiles
//
// Clear `filled`, `surfaces`, `entering`, `nodes`, `faces`, `reactions` and the count of `large`; what holds no
// matter stays so.
// After the recipe voxelize has filled a grid of twice the cells along each edge:
// 1. `diffusion_cells_fill`, one workgroup of 64 per row of words: (words, cells, cells) / 64.
// 2. `diffusion_cells_list`, one invocation per tile of 4 x 4 x 4 voxels; `workgroups` begins as (0, 1, 1).
// 3. `diffusion_cells_surface`, one invocation per triangle; `diffusion_cells_large`, any number of
//    workgroups.
// 4. `diffusion_cells_finish`, one workgroup per listed tile, dispatched indirectly by `workgroups`.

// The density varies from voxel to voxel. Called for by extras.lapidary.veins, or by a grid of
// densities.
override EFFECT_EXTINCTION_PER_VOXEL: bool = false;

// Light from all around that enters through the surface. Called for by an environment.
override EFFECT_ENVIRONMENT: bool = true;

// The number of pieces above which a triangle is shared among invocations.
override DIFFUSION_LARGE: u32 = 256u;

const DIFFUSION_GROUP: u32 = 64u;
// An area of one voxel's face, as a number of units: areas are added up in whole numbers, so that
// their order makes no difference.
const DIFFUSION_AREA: f32 = 16777216.0f;

struct DiffusionCells {
    grid: VoxelizationGrid,
    // Milne's length in voxel spacings where the density is 1, in each channel.
    milne: vec3f,
    // 3 times absorption times extinction, times the squared spacing, in each channel.
    absorption: vec3f,
    // The irradiance that counts as 1.
    largest: vec3f,
    // Fluence outside for an irradiance of 1, in a medium of the body's index: 4 index^2.
    outside: f32,
}

struct DiffusionList {
    count: atomic<u32>,
    triangles: array<u32>,
}

@group(0) @binding(0) var<uniform> cells: DiffusionCells;
@group(0) @binding(1) var<storage, read> positions: array<f32>;
@group(0) @binding(2) var<storage, read> indices: array<u32>;
// Binding 3 belongs to the part harmonics.
// Tiles that hold matter.
@group(0) @binding(4) var<storage, read_write> tiles: array<u32>;
// The filled eighths of each voxel.
@group(0) @binding(5) var<storage, read_write> filled: array<u32>;
// Two words for each voxel: the surface's area; and by how much its distance from the node, in voxel spacings,
// falls short of the largest, as bits.
@group(0) @binding(6) var<storage, read_write> surfaces: array<atomic<u32>>;
@group(0) @binding(7) var<storage, read_write> workgroups: array<atomic<u32>, 3>;
@group(0) @binding(8) var<storage, read_write> large: DiffusionList;
// Words of the part diffusion_nodes.
@group(0) @binding(9) var<storage, read_write> nodes: array<u32>;
// Conductances to the next voxel along x, y and z: three numbers for each voxel.
@group(0) @binding(10) var<storage, read_write> faces: array<f32>;
// What a voxel loses through the surface and by absorption in each channel; and its filled volume.
@group(0) @binding(11) var<storage, read_write> reactions: array<vec4f>;
@group(0) @binding(12) var<storage, read> density: array<f32>;
// The grid of half the spacing, a bit for each voxel, in rows along x.
@group(0) @binding(13) var<storage, read> fine: array<u32>;
// What enters each voxel of the light from all around, as the right side of the equations: three numbers for
// each, as bits.
@group(0) @binding(14) var<storage, read_write> entering: array<atomic<u32>>;

fn diffusion_index(voxel: vec3u) -> u32 {
    return voxel.x + cells.grid.cells * (voxel.y + cells.grid.cells * voxel.z);
}

// A word of a row of the finer grid, 0 beyond its end.
fn diffusion_fine(word: u32, row: vec2u) -> u32 {
    let words = (2u * cells.grid.cells + 31u) / 32u;
    return select(0u, fine[min(word, words - 1u) + words * (row.x + 2u * cells.grid.cells * row.y)], word < words);
}

@compute @workgroup_size(DIFFUSION_GROUP)
fn diffusion_cells_fill(@builtin(global_invocation_id) invocation: vec3u) {
    let count = cells.grid.cells;
    let words = (count + 31u) / 32u;
    let row = vec2u(invocation.x / words % count, invocation.x / words / count);
    if (row.y >= count) {
        return;
    }
    let word = invocation.x % words;
    for (var half = 0u; half < 2u; half++) {
        let lower_near = diffusion_fine(2u * word + half, 2u * row);
        let upper_near = diffusion_fine(2u * word + half, 2u * row + vec2u(1u, 0u));
        let lower_far = diffusion_fine(2u * word + half, 2u * row + vec2u(0u, 1u));
        let upper_far = diffusion_fine(2u * word + half, 2u * row + 1u);
        if ((lower_near | upper_near | lower_far | upper_far) == 0u) {
            continue;
        }
        for (var place = 0u; place < 16u; place++) {
            let x = 32u * word + 16u * half + place;
            if (x >= count) {
                break;
            }
            let shift = 2u * place;
            let near = ((lower_near >> shift) & 3u) | (((upper_near >> shift) & 3u) << 2u);
            let far = ((lower_far >> shift) & 3u) | (((upper_far >> shift) & 3u) << 2u);
            let parts = near | (far << 4u);
            if (parts != 0u) {
                filled[diffusion_index(vec3u(x, row))] = parts;
            }
        }
    }
}

@compute @workgroup_size(DIFFUSION_GROUP)
fn diffusion_cells_list(@builtin(global_invocation_id) invocation: vec3u) {
    let side = (cells.grid.cells + 3u) / 4u;
    if (invocation.x >= side * side * side) {
        return;
    }
    let corner = tile_corner(invocation.x, cells.grid.cells);
    let end = min(corner + 4u, vec3u(cells.grid.cells));
    for (var z = corner.z; z < end.z; z++) {
        for (var y = corner.y; y < end.y; y++) {
            for (var x = corner.x; x < end.x; x++) {
                if (filled[diffusion_index(vec3u(x, y, z))] != 0u) {
                    tiles[atomicAdd(&workgroups[0], 1u)] = invocation.x;
                    return;
                }
            }
        }
    }
}

// A triangle in voxel spacings from the grid's corner, and the number of pieces along each edge.
struct DiffusionTriangle {
    a: vec3f,
    b: vec3f,
    c: vec3f,
    // The unit normal.
    normal: vec3f,
    area: f32,
    pieces: u32,
}

fn diffusion_triangle(triangle: u32) -> DiffusionTriangle {
    let a = voxelization_local(cells.grid, mesh_position(indices[3u * triangle]));
    let b = voxelization_local(cells.grid, mesh_position(indices[3u * triangle + 1u]));
    let c = voxelization_local(cells.grid, mesh_position(indices[3u * triangle + 2u]));
    let across = cross(b - a, c - a);
    let twice = length(across);
    let longest = sqrt(max(dot(b - a, b - a), max(dot(c - b, c - b), dot(a - c, a - c))));
    let normal = select(vec3f(0.0f), across / max(twice, 1e-30f), twice > 0.0f);
    let pieces = u32(clamp(ceil(2.0f * longest), 1.0f, 1024.0f));
    return DiffusionTriangle(a, b, c, normal, 0.5f * twice, pieces);
}

// The squared distance of a point from an edge.
fn diffusion_from_edge(point: vec3f, start: vec3f, end: vec3f) -> f32 {
    let edge = end - start;
    let share = clamp(dot(point - start, edge) / max(dot(edge, edge), 1e-30f), 0.0f, 1.0f);
    let way = point - start - share * edge;
    return dot(way, way);
}

// The squared distance of a point from a triangle.
fn diffusion_from_triangle(point: vec3f, triangle: DiffusionTriangle) -> f32 {
    let a = triangle.a;
    let b = triangle.b;
    let c = triangle.c;
    let n = triangle.normal;
    let sides = vec3f(
        dot(cross(b - a, point - a), n),
        dot(cross(c - b, point - b), n),
        dot(cross(a - c, point - c), n),
    );
    if (triangle.area > 0.0f && all(sides >= vec3f(0.0f))) {
        let height = dot(point - a, n);
        return height * height;
    }
    return min(
        diffusion_from_edge(point, a, b), min(diffusion_from_edge(point, b, c), diffusion_from_edge(point, c, a))
    );
}

// Irradiance from all around on a surface that nothing hides, of which `largest` counts as 1.
fn diffusion_arriving(normal: vec3f) -> vec3f {
    let weights = cdrf_harmonic_weights(0.0f);
    let irradiance = harmonics_irradiance(harmonics_around(normal), weights, weights, weights);
    return min(irradiance / cells.largest, vec3f(1.0f));
}

// Adds every `step`th piece of a triangle, starting with the one numbered `first`.
fn diffusion_add(triangle: DiffusionTriangle, first: u32, step: u32) {
    let side = triangle.pieces;
    let share = triangle.area / f32(side * side) * DIFFUSION_AREA;
    let area = u32(share + 0.5f);
    //+environment {
    var arriving = vec3u(0u);
    if (EFFECT_ENVIRONMENT) {
        arriving = vec3u(share * diffusion_arriving(triangle.normal) + 0.5f);
    }
    //+environment }
    let last = cells.grid.cells - 1u;
    for (var piece = first; piece < side * side; piece += step) {
        // Rows of 1, 3, 5 ... pieces, from the corner a on.
        var row = u32(sqrt(f32(piece)));
        row -= select(0u, 1u, row * row > piece);
        row += select(0u, 1u, (row + 1u) * (row + 1u) <= piece);
        let place = piece - row * row;
        let third = select(1.0f, 2.0f, (place & 1u) == 0u) / 3.0f;
        // Shares of the edges from a to b and from b to c, in pieces.
        let along = f32(row) + third;
        let across = f32(place / 2u) + select(2.0f, 1.0f, (place & 1u) == 0u) / 3.0f;
        let position = triangle.a
            + (along * (triangle.b - triangle.a) + across * (triangle.c - triangle.b)) / f32(side);
        let voxel = vec3u(clamp(position, vec3f(0.0f), vec3f(f32(last))));
        var holder = voxel;
        if (filled[diffusion_index(holder)] == 0u) {
            // The surface passes a voxel of which no eighth is filled: the matter lies behind it.
            holder = vec3u(clamp(position - 0.5f * triangle.normal, vec3f(0.0f), vec3f(f32(last))));
        }
        atomicAdd(&surfaces[2u * diffusion_index(holder)], area);
        if (EFFECT_ENVIRONMENT) {
            for (var channel = 0u; channel < 3u; channel++) {
                atomicAdd(&entering[3u * diffusion_index(holder) + channel], arriving[channel]);
            }
        }
        let corner = vec3i(floor(position - 0.5f));
        for (var neighbour = 0u; neighbour < 8u; neighbour++) {
            // Values below 0 wrap around.
            let near = vec3u(corner + vec3i(i32(neighbour & 1u), i32((neighbour >> 1u) & 1u), i32(neighbour >> 2u)));
            if (any(near > vec3u(last))) {
                continue;
            }
            let index = diffusion_index(near);
            let parts = filled[index];
            if (parts == 0u) {
                continue;
            }
            let node = vec3f(near) + 0.5f + diffusion_centroid(parts);
            let depth = sqrt(diffusion_from_triangle(node, triangle));
            let close = bitcast<u32>(max(DIFFUSION_NODE_DEPTH - depth, 0.0f));
            // Reading first avoids most of the atomic writes, which are expensive.
            if (close > atomicLoad(&surfaces[2u * index + 1u])) {
                atomicMax(&surfaces[2u * index + 1u], close);
            }
        }
    }
}

@compute @workgroup_size(DIFFUSION_GROUP)
fn diffusion_cells_surface(@builtin(global_invocation_id) invocation: vec3u) {
    if (invocation.x >= arrayLength(&indices) / 3u) {
        return;
    }
    let triangle = diffusion_triangle(invocation.x);
    if (triangle.pieces * triangle.pieces > DIFFUSION_LARGE) {
        large.triangles[atomicAdd(&large.count, 1u)] = invocation.x;
    } else {
        diffusion_add(triangle, 0u, 1u);
    }
}

@compute @workgroup_size(DIFFUSION_GROUP)
fn diffusion_cells_large(@builtin(global_invocation_id) invocation: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let count = atomicLoad(&large.count);
    for (var place = 0u; place < count; place++) {
        diffusion_add(diffusion_triangle(large.triangles[place]), invocation.x, groups.x * DIFFUSION_GROUP);
    }
}

fn diffusion_density(index: u32) -> f32 {
    if (EFFECT_EXTINCTION_PER_VOXEL) {
        return density[index];
    }
    return 1.0f;
}

// The distance from the surface of the triangles next to a voxel's node.
fn diffusion_surface_distance(index: u32) -> f32 {
    return DIFFUSION_NODE_DEPTH - bitcast<f32>(atomicLoad(&surfaces[2u * index + 1u]));
}

// The node's distance from the surface. If no triangle lies next to the voxel, by way of its
// neighbours.
fn diffusion_node_depth(voxel: vec3u, parts: u32) -> f32 {
    var depth = diffusion_surface_distance(diffusion_index(voxel));
    if (depth < DIFFUSION_NODE_DEPTH) {
        return depth;
    }
    let last = cells.grid.cells - 1u;
    let centroid = diffusion_centroid(parts);
    for (var neighbour = 0u; neighbour < 27u; neighbour++) {
        let step = vec3u(neighbour % 3u, (neighbour / 3u) % 3u, neighbour / 9u);
        let near = voxel + step - 1u;
        if (any(near > vec3u(last))) {
            continue;
        }
        let index = diffusion_index(near);
        if (filled[index] != 0u) {
            let way = vec3f(step) - 1.0f + diffusion_centroid(filled[index]) - centroid;
            depth = min(depth, diffusion_surface_distance(index) + length(way));
        }
    }
    return depth;
}

@compute @workgroup_size(DIFFUSION_GROUP)
fn diffusion_cells_finish(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let count = cells.grid.cells;
    let voxel = tile_corner(tiles[group.x], count) + tile_cell(lane);
    if (any(voxel >= vec3u(count))) {
        return;
    }
    let index = diffusion_index(voxel);
    let parts = filled[index];
    if (parts == 0u) {
        return;
    }
    let own = diffusion_density(index);
    let centroid = diffusion_centroid(parts);
    for (var axis = 0u; axis < 3u; axis++) {
        var next = voxel;
        next[axis] += 1u;
        var conductance = 0.0f;
        if (next[axis] < count) {
            let beyond = filled[diffusion_index(next)];
            let open = diffusion_open(parts, beyond, axis);
            if (open > 0.0f) {
                let distance = 1.0f + diffusion_centroid(beyond)[axis] - centroid[axis];
                conductance = diffusion_face(open, distance, vec2f(own, diffusion_density(diffusion_index(next))));
            }
        }
        faces[3u * index + axis] = conductance;
    }
    let depth = diffusion_node_depth(voxel, parts);
    let area = f32(atomicLoad(&surfaces[2u * index])) / DIFFUSION_AREA;
    let volume = diffusion_volume(parts);
    let through = vec3f(
        diffusion_surface(area, depth, own, cells.milne.x),
        diffusion_surface(area, depth, own, cells.milne.y),
        diffusion_surface(area, depth, own, cells.milne.z),
    );
    reactions[index] = vec4f(through + cells.absorption * own * volume, volume);
    if (EFFECT_ENVIRONMENT) {
        for (var channel = 0u; channel < 3u; channel++) {
            // The area times the irradiance. Light enters where it leaves, by the same conductance.
            let arrived = f32(atomicLoad(&entering[3u * index + channel])) / DIFFUSION_AREA;
            let load = cells.outside * diffusion_surface(arrived, depth, own, cells.milne[channel]);
            atomicStore(&entering[3u * index + channel], bitcast<u32>(load));
        }
    }
    nodes[index] = diffusion_word(parts, depth);
}
