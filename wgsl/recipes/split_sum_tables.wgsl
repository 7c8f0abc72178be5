// split_sum_tables: what a rough metal needs beforehand: the environment blurred by roughness, and its reflectance.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the module split_sum; Krivanek and Colbert, "Real-time Shading with Filtered Importance Sampling", 2008.
// requires: environment, microfacet, random_walk, split_sum
//
// `split_sum_tables_environment` for each level of the blurred environment but the first, which is the environment
// itself, and `split_sum_tables_reflectance` once: a workgroup for each 8 x 8 texels.

struct SplitSumTables {
    // Columns and rows of what is baked.
    size: vec2u,
    // Columns and rows of the first level of `radiance`.
    first: vec2u,
    // Number of its levels, each half as wide and half as high as the one before.
    levels: u32,
    // Number of facets or directions for each texel.
    count: u32,
    // Slope of the facets for which the environment is blurred.
    alpha: f32,
}

@group(0) @binding(0) var<uniform> bake: SplitSumTables;
// The environment by direction, linear RGB, row by row, and the means of 2 x 2 texels, level by level.
@group(0) @binding(1) var<storage, read> radiance: array<vec4f>;
// Row by row.
@group(0) @binding(2) var<storage, read_write> texels: array<vec4f>;

// The mean over the facets that the eye sees, in x and y.
@compute @workgroup_size(8, 8)
fn split_sum_tables_reflectance(@builtin(global_invocation_id) invocation: vec3u) {
    if (all(invocation.xy < bake.size)) {
        let place = split_sum_texel(invocation.xy, bake.size);
        let cosine = place.x;
        let toward_eye = vec3f(sqrt((1.0f - cosine) * (1.0f + cosine)), 0.0f, cosine);
        var sum = vec2f(0.0f);
        for (var index = 0u; index < bake.count; index++) {
            let point = split_sum_point(index, bake.count);
            let facet = microfacet_facet(
                vec3f(0.0f, 0.0f, 1.0f), toward_eye, place.y, point.x, random_walk_azimuth(point.y)
            );
            let facing = dot(facet, toward_eye);
            sum += split_sum_albedo(facing, 2.0f * facing * facet.z - cosine, cosine, place.y);
        }
        texels[invocation.y * bake.size.x + invocation.x] = vec4f(sum / f32(bake.count), 0.0f, 1.0f);
    }
}

// Radiance of a level of the environment at a place of the map.
fn split_sum_tables_texel(uv: vec2f, level: u32) -> vec3f {
    var size = bake.first;
    var start = 0u;
    for (var above = 0u; above < level; above++) {
        start += size.x * size.y;
        size = max(size >> vec2u(1u), vec2u(1u));
    }
    let around = environment_texels(uv, size);
    let upper_row = start + around.lower.y * size.x;
    let lower_row = start + around.upper.y * size.x;
    let columns = vec2u(around.lower.x, around.upper.x);
    let upper = mix(radiance[upper_row + columns.x].rgb, radiance[upper_row + columns.y].rgb, around.weight.x);
    let lower = mix(radiance[lower_row + columns.x].rgb, radiance[lower_row + columns.y].rgb, around.weight.x);
    return mix(upper, lower, around.weight.y);
}

// The mean over the lobe of an eye that looks along the normal.
@compute @workgroup_size(8, 8)
fn split_sum_tables_environment(@builtin(global_invocation_id) invocation: vec3u) {
    if (all(invocation.xy < bake.size)) {
        let axis = environment_direction_from_uv((vec2f(invocation.xy) + 0.5f) / vec2f(bake.size));
        // Solid angle of a texel of the first level, at the horizon.
        let texel = 19.739209f / (f32(bake.first.x) * f32(bake.first.y));
        var sum = vec3f(0.0f);
        var weight = 0.0f;
        for (var index = 0u; index < bake.count; index++) {
            let point = split_sum_point(index, bake.count);
            let lobe = split_sum_lobe(axis, bake.alpha, point.x, random_walk_azimuth(point.y));
            let level = clamp(
                0.5f * log2(lobe.solid_angle / (f32(bake.count) * texel)), 0.0f, f32(bake.levels) - 1.0f
            );
            let uv = environment_uv_from_direction(lobe.toward);
            let sharp = u32(level);
            let met = mix(
                split_sum_tables_texel(uv, sharp),
                split_sum_tables_texel(uv, min(sharp + 1u, bake.levels - 1u)),
                level - f32(sharp),
            );
            sum += lobe.weight * met;
            weight += lobe.weight;
        }
        texels[invocation.y * bake.size.x + invocation.x] = vec4f(sum / max(weight, 1e-20f), 1.0f);
    }
}
