// trace: rays from inside closed meshes, each to the nearest triangle that it leaves through, one invocation a ray.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: the part trace_nearest, which other recipes share.
// requires: bvh_trace
// parts: trace_nearest
//
// A shader that traces rays itself uses this part and the bindings of group 0.

// The root is first. At least one node.
@group(0) @binding(0) var<storage, read> nodes: array<BvhTraceNode>;
// Three per triangle, counter-clockwise from outside, in the order of the leaves; w is not read. A
// triangle's number is its position here.
@group(0) @binding(1) var<storage, read> corners: array<vec4f>;

struct TraceQuery {
    origin: vec3f,
    // The triangle that the ray has just left; BVH_TRACE_NONE if the ray starts inside.
    left: u32,
    direction: vec3f,
}

@group(1) @binding(0) var<storage, read> queries: array<TraceQuery>;
@group(1) @binding(1) var<storage, read_write> hits: array<BvhTraceHit>;

@compute @workgroup_size(64)
fn trace_rays(@builtin(global_invocation_id) invocation: vec3u) {
    if (invocation.x < arrayLength(&queries)) {
        let query = queries[invocation.x];
        hits[invocation.x] = trace_nearest(query.origin, query.direction, query.left, TRACE_FAR);
    }
}
