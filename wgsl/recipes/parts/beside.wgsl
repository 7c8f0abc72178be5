// beside: what a ray that leaves a stone meets among the triangles of bodies that are not clear.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the module bvh_trace.
//
// A recipe adds: the modules bvh_trace and proxy_geometry, the part trace_nearest, which reads what is bound here, and
// the part metal.

// Rays that leave meet the triangles of bodies that are not clear. Called for by a body around the stone.
override EFFECT_AROUND: bool = false;
// Rays inside meet the triangles of bodies that are not clear and reach into the stone. Called for by a body that
// shares space with it, with EFFECT_AROUND.
override EFFECT_NESTED: bool = false;

//+around {
// The root is first.
@group(0) @binding(17) var<storage, read> nodes: array<BvhTraceNode>;
// Three per triangle, clockwise from outside, in the order of the leaves: a ray from outside then leaves
// through them. w is the radiance that the surface sends there, of any direction: shares of the largest, as roots
// in steps of 1/255, red + 256 green + 65536 blue. The largest follows the last triangle. Of a metal w is -1 minus its
// colour as roots in steps of 1/127, red + 128 green + 16384 blue, and 2097152 times its roughness in steps of 1/7.
@group(0) @binding(18) var<storage, read> corners: array<vec4f>;

fn beside_share(packed: f32) -> vec3f {
    let number = u32(packed);
    let roots = vec3f((vec3u(number) >> vec3u(0u, 8u, 16u)) & vec3u(255u)) / 255.0f;
    return roots * roots;
}

// Radiance that a metal's triangle sends against a ray: the environment, by the triangle's plane, without the lights.
fn beside_metal(first: u32, direction: vec3f) -> vec3f {
    let number = u32(-1.0f - corners[first].w);
    let roots = vec3f((vec3u(number) >> vec3u(0u, 7u, 14u)) & vec3u(127u)) / 127.0f;
    let roughness = f32(number >> 21u) / 7.0f;
    let plane = proxy_geometry_face_normal(corners[first].xyz, corners[first + 1u].xyz, corners[first + 2u].xyz);
    let normal = select(plane, -plane, dot(plane, direction) > 0.0f);
    let metal = metal_seen(roots * roots, roughness * roughness, -dot(normal, direction));
    return metal.reflectance * metal_surroundings(reflect(direction, normal), metal.alpha);
}

// Radiance that arrives along a ray from what it meets within a distance, and how far that is; below 0 if it meets
// nothing.
fn beside_met(position: vec3f, direction: vec3f, within: f32) -> vec4f {
    let hit = trace_nearest(position, direction, BVH_TRACE_NONE, within);
    if (hit.triangle == BVH_TRACE_NONE) {
        return vec4f(0.0f, 0.0f, 0.0f, -1.0f);
    }
    let first = 3u * hit.triangle;
    if (EFFECT_METAL) {
        if (corners[first].w < 0.0f) {
            return vec4f(beside_metal(first, direction), hit.distance);
        }
    }
    let share = (1.0f - hit.barycentrics.x - hit.barycentrics.y) * beside_share(corners[first].w)
        + hit.barycentrics.x * beside_share(corners[first + 1u].w)
        + hit.barycentrics.y * beside_share(corners[first + 2u].w);
    return vec4f(corners[arrayLength(&corners) - 1u].rgb * share, hit.distance);
}
//+around }
