// voxelize: a mesh that changes from frame to frame, as bits of a grid: solid inside, and nothing of its surface lost.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Schwarz and Seidel, "Fast Parallel Surface and Solid Voxelization on GPUs", SIGGRAPH Asia
//   2010.
// requires: voxelization
// parts: mesh
//
// In each frame the host sets `matter`, `surface`, `beyond`, `large` and `status` to 0, then runs:
// 1. `voxelize_vertices`, a thread for each vertex, or fewer. It converts each vertex to grid
//    coordinates once, so that triangles that share a vertex get the same position to the last bit.
// 2. `voxelize_triangles`, a thread for each triangle. Where a triangle crosses a column, the
//    bit of the first voxel behind it flips; the voxels that it touches are set in `surface`.
//    Triangles over many columns are put on a list.
// 3. `voxelize_large`, any number of workgroups, which share the triangles of that list.
// 4. `voxelize_finish`, a thread for each row along x. Each bit that is set flips all bits
//    behind it. A row whose column was crossed an odd number of times belongs to an open mesh: it
//    is counted and not filled, so that no streak runs through the grid.
// A voxel is filled if its centre is inside or if the surface touches it.
//
// No position makes it write outside its buffers. The parts of a mesh outside the grid are cut off;
// a body that begins before the grid is solid from the first voxel on.

// Also fills the voxels that the surface touches, so that parts thinner than a voxel and bodies the
// size of a voxel are kept. If off, only voxels whose centre is inside are filled; their number is
// proportional to the volume.
override EFFECT_SURFACE: bool = true;

// The number of columns above which a triangle is shared among threads.
override VOXELIZE_LARGE: u32 = 64u;
const VOXELIZE_WORKGROUP: u32 = 64u;

struct VoxelizeList {
    count: atomic<u32>,
    triangles: array<u32>,
}

struct VoxelizeStatus {
    // Voxels whose centre is inside.
    solid: atomic<u32>,
    // Voxels that the surface touches.
    surface: atomic<u32>,
    // Columns that the mesh crosses an odd number of times.
    odd_columns: atomic<u32>,
}

@group(0) @binding(0) var<uniform> grid: VoxelizationGrid;
@group(0) @binding(1) var<storage, read> positions: array<f32>;
@group(0) @binding(2) var<storage, read> indices: array<u32>;
// Voxels along x, 32 per word, from the least bit on. Each row starts at a new word.
@group(0) @binding(3) var<storage, read_write> matter: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> surface: array<atomic<u32>>;
// A bit for each column, set if the column is crossed an odd number of times behind its last
// centre.
@group(0) @binding(5) var<storage, read_write> beyond: array<atomic<u32>>;
@group(0) @binding(6) var<storage, read_write> large: VoxelizeList;
@group(0) @binding(7) var<storage, read_write> status: VoxelizeStatus;
// The vertices in grid coordinates, three numbers each, as many as in `positions`. No pass binds
// more than six of the storage buffers.
@group(0) @binding(8) var<storage, read_write> corners: array<f32>;

// A triangle in grid coordinates, and the columns that it may touch.
struct VoxelizeTriangle {
    a: vec3f,
    b: vec3f,
    c: vec3f,
    // The first column and the number of columns, in y and z.
    lower: vec2u,
    size: vec2u,
}

fn voxelize_words() -> u32 {
    return (grid.cells + 31u) / 32u;
}

fn voxelize_corner(vertex: u32) -> vec3f {
    return vec3f(corners[3u * vertex], corners[3u * vertex + 1u], corners[3u * vertex + 2u]);
}

fn voxelize_load(triangle: u32) -> VoxelizeTriangle {
    let a = voxelize_corner(indices[3u * triangle]);
    let b = voxelize_corner(indices[3u * triangle + 1u]);
    let c = voxelize_corner(indices[3u * triangle + 2u]);
    let margin = voxelization_margin(a, b, c);
    let low = min(a, min(b, c)) - margin;
    let high = max(a, max(b, c)) + margin;
    let y = voxelization_range(low.y, high.y, grid.cells);
    let z = voxelization_range(low.z, high.z, grid.cells);
    return VoxelizeTriangle(a, b, c, vec2u(y.x, z.x), vec2u(y.y - y.x, z.y - z.x));
}

// Processes every `step`th of a triangle's columns, starting with the one numbered `first`.
fn voxelize_walk(triangle: VoxelizeTriangle, first: u32, step: u32) {
    let a = triangle.a;
    let b = triangle.b;
    let c = triangle.c;
    for (var number = first; number < triangle.size.x * triangle.size.y; number += step) {
        let place = triangle.lower + vec2u(number % triangle.size.x, number / triangle.size.x);
        let row = place.x + grid.cells * place.y;
        let column = voxelization_column(a, b, c, vec2f(place) + 0.5f);
        if column.inside {
            let x = voxelization_first(column.depth, grid.cells);
            if x < grid.cells {
                atomicXor(&matter[row * voxelize_words() + x / 32u], 1u << (x % 32u));
            } else {
                atomicXor(&beyond[row / 32u], 1u << (row % 32u));
            }
        }
        if EFFECT_SURFACE {
            let span = voxelization_span(a, b, c, vec2f(place));
            let range = voxelization_range(span.x, span.y, grid.cells);
            var bits = 0u;
            for (var x = range.x; x < range.y; x++) {
                if voxelization_overlaps(a, b, c, vec3f(f32(x), vec2f(place))) {
                    bits |= 1u << (x % 32u);
                }
                if bits != 0u && (x % 32u == 31u || x + 1u == range.y) {
                    atomicOr(&surface[row * voxelize_words() + x / 32u], bits);
                    bits = 0u;
                }
            }
        }
    }
}

@compute @workgroup_size(VOXELIZE_WORKGROUP)
fn voxelize_vertices(@builtin(global_invocation_id) invocation: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var vertex = invocation.x; vertex < arrayLength(&positions) / 3u; vertex += groups.x * VOXELIZE_WORKGROUP) {
        let corner = voxelization_local(grid, mesh_position(vertex));
        corners[3u * vertex] = corner.x;
        corners[3u * vertex + 1u] = corner.y;
        corners[3u * vertex + 2u] = corner.z;
    }
}

@compute @workgroup_size(VOXELIZE_WORKGROUP)
fn voxelize_triangles(@builtin(global_invocation_id) invocation: vec3u) {
    if invocation.x >= arrayLength(&indices) / 3u {
        return;
    }
    let triangle = voxelize_load(invocation.x);
    if triangle.size.x * triangle.size.y > VOXELIZE_LARGE {
        large.triangles[atomicAdd(&large.count, 1u)] = invocation.x;
    } else {
        voxelize_walk(triangle, 0u, 1u);
    }
}

// The workgroups are divided evenly among the triangles; if there are more triangles than
// workgroups, each workgroup takes several in turn.
@compute @workgroup_size(VOXELIZE_WORKGROUP)
fn voxelize_large(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let count = atomicLoad(&large.count);
    let together = max(groups.x / max(count, 1u), 1u);
    for (var place = group.x / together; place < count; place += groups.x / together) {
        let triangle = voxelize_load(large.triangles[place]);
        let first = (group.x % together) * VOXELIZE_WORKGROUP + lane;
        voxelize_walk(triangle, first, together * VOXELIZE_WORKGROUP);
    }
}

@compute @workgroup_size(VOXELIZE_WORKGROUP)
fn voxelize_finish(@builtin(global_invocation_id) invocation: vec3u) {
    let row = invocation.x;
    if row >= grid.cells * grid.cells {
        return;
    }
    let words = voxelize_words();
    var crossings = (atomicLoad(&beyond[row / 32u]) >> (row % 32u)) & 1u;
    for (var word = 0u; word < words; word++) {
        crossings += countOneBits(atomicLoad(&matter[row * words + word]));
    }
    let odd = crossings % 2u == 1u;
    var inside = 0u;
    var solid = 0u;
    var touched = 0u;  //+surface
    for (var word = 0u; word < words; word++) {
        let within = select(0xffffffffu, (1u << (grid.cells % 32u)) - 1u, word + 1u == words && grid.cells % 32u != 0u);
        let all = voxelization_prefix(atomicLoad(&matter[row * words + word])) ^ inside;
        inside = select(0u, 0xffffffffu, all >> 31u == 1u);
        let filled = select(all & within, 0u, odd);
        var found = filled;
        if EFFECT_SURFACE {
            let skin = atomicLoad(&surface[row * words + word]);
            found |= skin;
            touched += countOneBits(skin);
        }
        atomicStore(&matter[row * words + word], found);
        solid += countOneBits(filled);
    }
    if solid > 0u {
        atomicAdd(&status.solid, solid);
    }
    if EFFECT_SURFACE && touched > 0u {
        atomicAdd(&status.surface, touched);
    }
    if odd {
        atomicAdd(&status.odd_columns, 1u);
    }
}
