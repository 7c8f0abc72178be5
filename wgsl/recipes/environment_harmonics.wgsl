// environment_harmonics: a changing environment map, projected to the spherical harmonics that light matte surfaces.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps",
//   2001; to degree 4.
// requires: environment
//
// 1. `environment_harmonics_rows`, max(512, height) workgroups for a map of this height.
// 2. `environment_harmonics_sum`, 18 workgroups.
//
// The map is of any size, linear, finite and not negative; row 0 is the zenith. The result is what
// the part harmonics binds as a uniform: a host binds the same buffer there, or copies it.
//
// Every texel counts with its solid angle. Sums are taken in a fixed order, without atomics, so that
// a device gives the same bits for the same map.

// The map is sampled at this many columns and rows or more. Recipes interpolate a map linearly, and
// between the texels of a small one there is light as well.
const ENVIRONMENT_HARMONICS_LEAST: vec2u = vec2u(512u, 256u);
// One coefficient of degree 0, three of degree 1, five of degree 2, nine of degree 4.
const ENVIRONMENT_HARMONICS_COUNT: u32 = 18u;
// Invocations per workgroup.
const ENVIRONMENT_HARMONICS_GROUP: u32 = 32u;

// 32-bit float textures need not be filterable.
@group(0) @binding(0) var environment_map: texture_2d<f32>;
// Sums of each row: 288 bytes for each workgroup of the first pass.
@group(0) @binding(1) var<storage, read_write> row_sums: array<array<vec4f, ENVIRONMENT_HARMONICS_COUNT>>;
// The coefficients, linear RGB: 288 bytes, laid out as the uniform that cdrf_shading binds.
@group(0) @binding(2) var<storage, read_write> harmonics: array<vec4f, ENVIRONMENT_HARMONICS_COUNT>;

// Each invocation's part of a row.
var<workgroup> row_parts: array<array<vec3f, ENVIRONMENT_HARMONICS_COUNT>, ENVIRONMENT_HARMONICS_GROUP>;
// Each invocation's part of a coefficient.
var<workgroup> parts: array<vec3f, ENVIRONMENT_HARMONICS_GROUP>;

// Number of samples along each side of a texel.
fn environment_harmonics_fineness(size: vec2u) -> vec2u {
    return (ENVIRONMENT_HARMONICS_LEAST + size - 1u) / size;
}

// Radiance at a sample: of the texel itself, or interpolated as the recipes do.
fn environment_harmonics_radiance(cell: vec2u, size: vec2u, fineness: vec2u) -> vec3f {
    if (all(fineness == vec2u(1u))) {
        return textureLoad(environment_map, cell, 0).rgb;
    }
    // From the middle of the texel before the first, in halves of a sample: whole numbers, which are
    // exact at any size.
    let place = 2u * cell + 1u + fineness;
    let upper = place / (2u * fineness);
    let weight = vec2f(place % (2u * fineness)) / vec2f(2u * fineness);
    let columns = vec2u(upper.x + size.x - 1u, upper.x) % size.x;
    let rows = vec2u(max(upper.y, 1u) - 1u, min(upper.y, size.y - 1u));
    let above = mix(
        textureLoad(environment_map, vec2u(columns.x, rows.x), 0).rgb,
        textureLoad(environment_map, vec2u(columns.y, rows.x), 0).rgb,
        weight.x,
    );
    let below = mix(
        textureLoad(environment_map, vec2u(columns.x, rows.y), 0).rgb,
        textureLoad(environment_map, vec2u(columns.y, rows.y), 0).rgb,
        weight.x,
    );
    return mix(above, below, weight.y);
}

// Solid angle of a sample between two meridians and the parallels of its row's edges, in steradians:
// the azimuth times the difference of the cosines. As a product of sines the difference keeps its
// digits.
fn environment_harmonics_solid_angle(row: u32, grid: vec2u) -> f32 {
    let size = vec2f(grid);
    let middle = (f32(row) + 0.5f) / size.y;
    return 12.566371f / size.x * environment_sine(0.5f * middle) * environment_sine(0.25f / size.y);
}

// A workgroup sums a row of samples.
@compute @workgroup_size(ENVIRONMENT_HARMONICS_GROUP)
fn environment_harmonics_rows(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let size = textureDimensions(environment_map);
    let fineness = environment_harmonics_fineness(size);
    let grid = fineness * size;
    let row = group.x;
    if (row >= grid.y) {
        return;
    }
    let solid_angle = environment_harmonics_solid_angle(row, grid);
    // Written out: compilers keep an array in registers if every index is a constant.
    var sums: array<vec3f, ENVIRONMENT_HARMONICS_COUNT>;
    for (var column = lane; column < grid.x; column += ENVIRONMENT_HARMONICS_GROUP) {
        let cell = vec2u(column, row);
        let basis = environment_harmonics(environment_direction_from_uv((vec2f(cell) + 0.5f) / vec2f(grid)));
        let arriving = solid_angle * environment_harmonics_radiance(cell, size, fineness);
        sums[0] += basis.zeroth * arriving;
        sums[1] += basis.first[0] * arriving;
        sums[2] += basis.first[1] * arriving;
        sums[3] += basis.first[2] * arriving;
        sums[4] += basis.second[0] * arriving;
        sums[5] += basis.second[1] * arriving;
        sums[6] += basis.second[2] * arriving;
        sums[7] += basis.second[3] * arriving;
        sums[8] += basis.second[4] * arriving;
        sums[9] += basis.fourth[0] * arriving;
        sums[10] += basis.fourth[1] * arriving;
        sums[11] += basis.fourth[2] * arriving;
        sums[12] += basis.fourth[3] * arriving;
        sums[13] += basis.fourth[4] * arriving;
        sums[14] += basis.fourth[5] * arriving;
        sums[15] += basis.fourth[6] * arriving;
        sums[16] += basis.fourth[7] * arriving;
        sums[17] += basis.fourth[8] * arriving;
    }
    row_parts[lane] = sums;
    workgroupBarrier();
    if (lane < ENVIRONMENT_HARMONICS_COUNT) {
        var sum = vec3f(0.0f);
        for (var other = 0u; other < ENVIRONMENT_HARMONICS_GROUP; other++) {
            sum += row_parts[other][lane];
        }
        row_sums[row][lane] = vec4f(sum, 0.0f);
    }
}

// A workgroup sums a coefficient over all rows.
@compute @workgroup_size(ENVIRONMENT_HARMONICS_GROUP)
fn environment_harmonics_sum(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let size = textureDimensions(environment_map);
    let rows = environment_harmonics_fineness(size).y * size.y;
    var sum = vec3f(0.0f);
    for (var row = lane; row < rows; row += ENVIRONMENT_HARMONICS_GROUP) {
        sum += row_sums[row][group.x].rgb;
    }
    parts[lane] = sum;
    workgroupBarrier();
    if (lane == 0u) {
        var total = vec3f(0.0f);
        for (var other = 0u; other < ENVIRONMENT_HARMONICS_GROUP; other++) {
            total += parts[other];
        }
        harmonics[group.x] = vec4f(total, 0.0f);
    }
}
