// convex_trace: forms found elsewhere, kept to show where they fail. They follow the module and use its names.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0

// convex_trace_step in its usual form, with an epsilon to avoid hitting the face that the ray has just left.
// Returns: this plane's ConvexTraceHit if the ray meets it at a shorter distance than `hit` and beyond 1e-4,
//   otherwise `hit`.
// Units: lengths are in units of the length of the ray's direction.
// Domain: stones of size 1 around the origin, with the next plane farther than 1e-4 and the ray not nearly
//   parallel to it.
// Outside: misses facets beside edges, all facets of small stones and those that the ray starts outside of by
//   rounding; meets the face that was left again, far away, at grazing incidence.
// Accuracy: naive
fn convex_trace_step_naive(
    hit: ConvexTraceHit, position: vec3f, direction: vec3f, plane: vec4f, face: u32
) -> ConvexTraceHit {
    let distance = (plane.w - dot(plane.xyz, position)) / dot(plane.xyz, direction);
    if (distance > 1e-4f && distance < hit.distance) {
        return ConvexTraceHit(distance, face);
    }
    return hit;
}

// The point along the ray, not corrected for rounding.
// Returns: position + distance direction.
// Units: lengths.
// Domain: the same as for convex_trace_step_naive, with `distance` the distance to the plane and
//   all lengths of similar size.
// Outside: off the plane by units in the last place of the largest of position and distance.
// Accuracy: naive
fn convex_trace_point_naive(position: vec3f, direction: vec3f, distance: f32) -> vec3f {
    return position + distance * direction;
}
