// cdrf_table: the lookup table of the curvature-dependent reflectance, baked texel by texel.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Kubo, Dobashi and Morishima, "Real-time Rendering of Translucent Materials using
//   Curvature-Dependent Reflectance Function": the lookup table.
// requires: cdrf
//
// The host converts the texels to the texture's format when it uploads them. An odd width puts a
// column on the terminator.

struct CdrfTableBake {
    // Size of the table: columns are cosines from -1 to 1, rows are sigma / (1 + sigma) from 0 to
    // 1.
    size: vec2u,
    // sigma0 of each channel as a share of the largest.
    tint: vec3f,
}

@group(0) @binding(0) var<uniform> bake: CdrfTableBake;
// Texels row by row; alpha is 1.
@group(0) @binding(1) var<storage, read_write> texels: array<vec4f>;

@compute @workgroup_size(8, 8)
fn cdrf_table_bake(@builtin(global_invocation_id) invocation: vec3u) {
    if (all(invocation.xy < bake.size)) {
        let reflectance = cdrf_table_texel(invocation.xy, bake.size, bake.tint);
        texels[invocation.y * bake.size.x + invocation.x] = vec4f(reflectance, 1.0f);
    }
}
